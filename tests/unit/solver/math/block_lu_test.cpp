#include "solver/math/block_lu.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

struct Problem {
  int nodes;
  std::vector<std::pair<int, int>> edges;
  Eigen::MatrixXd dense;
};

// Unsymmetric values on a symmetric pattern; blocks on the diagonal dominate, as inertia does in a step.
Problem random_problem(std::mt19937& rng, int nodes, int extra) {
  Problem p{nodes, {}, Eigen::MatrixXd::Zero(6 * nodes, 6 * nodes)};
  std::uniform_real_distribution<double> u(-1, 1);
  const auto block = [&](int i, int j, double diagonal) {
    for (int r = 0; r < 6; ++r)
      for (int c = 0; c < 6; ++c) p.dense(6 * i + r, 6 * j + c) += u(rng) + (r == c ? diagonal : 0);
  };
  for (int i = 0; i < nodes; ++i) block(i, i, 12);
  std::uniform_int_distribution<int> any(0, nodes - 1);
  const auto couple = [&](int i, int j) {
    if (i == j) return;
    p.edges.emplace_back(i, j);
    block(i, j, 0);
    block(j, i, 0);
  };
  for (int i = 1; i < nodes; ++i) couple(i, std::uniform_int_distribution<int>(0, i - 1)(rng));
  for (int k = 0; k < extra; ++k) couple(any(rng), any(rng));
  return p;
}

BlockLu filled(const Problem& p) {
  BlockLu lu(p.nodes, p.edges);
  lu.set_zero();
  for (int i = 0; i < p.nodes; ++i) lu.add(i, i, Mat6(p.dense.block<6, 6>(6 * i, 6 * i)));
  std::vector<std::pair<int, int>> done;
  for (auto [i, j] : p.edges) {
    const std::pair<int, int> key = std::minmax(i, j);
    if (std::find(done.begin(), done.end(), key) != done.end()) continue;
    done.push_back(key);
    lu.add(i, j, Mat6(p.dense.block<6, 6>(6 * i, 6 * j)));
    lu.add(j, i, Mat6(p.dense.block<6, 6>(6 * j, 6 * i)));
  }
  return lu;
}

TEST(BlockLu, solves_as_a_dense_factorisation_does) {
  std::mt19937 rng(21);
  for (int nodes : {1, 2, 3, 7, 20, 45})
    for (int trial = 0; trial < 5; ++trial) {
      SCOPED_TRACE(testing::Message() << nodes << " nodes, trial " << trial);
      const Problem p = random_problem(rng, nodes, nodes / 2);
      BlockLu lu = filled(p);
      ASSERT_EQ(lu.factor(), -1);
      Eigen::VectorXd b = Eigen::VectorXd::Random(6 * nodes);
      const Eigen::VectorXd exact = p.dense.partialPivLu().solve(b);
      lu.solve(b.data());
      // no pivoting between blocks: growth of a few over the condition of about 10
      EXPECT_LT((b - exact).norm(), 1e-12 * exact.norm());
    }
}

TEST(BlockLu, one_factorisation_serves_many_right_hand_sides_and_can_be_refilled) {
  std::mt19937 rng(22);
  const Problem p = random_problem(rng, 12, 5);
  BlockLu lu = filled(p);
  ASSERT_EQ(lu.factor(), -1);
  Eigen::VectorXd first = Eigen::VectorXd::Ones(72), again = first;
  lu.solve(first.data());
  lu.solve(again.data());
  EXPECT_EQ(first, again);
  lu.set_zero();
  for (int i = 0; i < 12; ++i) lu.add(i, i, Mat6(2 * Mat6::Identity()));
  ASSERT_EQ(lu.factor(), -1);
  Eigen::VectorXd b = Eigen::VectorXd::Ones(72);
  lu.solve(b.data());
  EXPECT_EQ(b, Eigen::VectorXd(Eigen::VectorXd::Constant(72, 0.5)));
}

TEST(BlockLu, fixed_directions_take_the_value_of_the_right_hand_side) {
  std::mt19937 rng(23);
  for (int trial = 0; trial < 10; ++trial) {
    SCOPED_TRACE(trial);
    const Problem p = random_problem(rng, 9, 4);
    BlockLu lu = filled(p);
    Eigen::MatrixXd dense = p.dense;
    for (int k = 0; k < 9; ++k) {
      const int node = std::uniform_int_distribution<int>(0, 8)(rng);
      const int direction = std::uniform_int_distribution<int>(0, 5)(rng);
      lu.fix(node, direction);
      dense.row(6 * node + direction).setZero();
      dense(6 * node + direction, 6 * node + direction) = 1;
    }
    ASSERT_EQ(lu.factor(), -1);
    Eigen::VectorXd b = Eigen::VectorXd::Random(54);
    const Eigen::VectorXd exact = dense.partialPivLu().solve(b);
    lu.solve(b.data());
    EXPECT_LT((b - exact).norm(), 1e-12 * exact.norm());
  }
}

TEST(BlockLu, names_the_node_whose_block_is_singular) {
  std::mt19937 rng(24);
  Problem p = random_problem(rng, 8, 3);
  for (int bad : {0, 3, 7}) {
    Problem q = p;
    // a node that couples to nothing and has an empty row
    q.dense.block(6 * bad, 0, 6, 48).setZero();
    q.dense.block(0, 6 * bad, 48, 6).setZero();
    q.dense.block<6, 6>(6 * bad, 6 * bad).diagonal() << 1, 1, 0, 1, 1, 1;
    EXPECT_EQ(filled(q).factor(), bad);
  }
}

TEST(BlockLu, reports_a_block_with_dependent_rows) {
  BlockLu lu(1, {});
  lu.set_zero();
  Mat6 block = Mat6::Identity();
  block.row(4) = block.row(2);
  lu.add(0, 0, block);
  EXPECT_EQ(lu.factor(), 0);
}

TEST(BlockLu, reports_nan_as_singular) {
  BlockLu lu(2, {{0, 1}});
  lu.set_zero();
  lu.add(0, 0, Mat6(Mat6::Identity()));
  lu.add(1, 1, Mat6(Mat6::Constant(std::nan(""))));
  EXPECT_NE(lu.factor(), -1);
}

}  // namespace
}  // namespace topple::test
