// Collapse loads of frames in whose joints members of one strength meet, against linear programming on the
// static theorem of plastic theory.
#include <gtest/gtest.h>

#include <map>

#include "solver/run/run.h"
#include "unit/solver/plastic_statics.h"
#include "unit/solver/simplex.h"

namespace topple::test {
namespace {

constexpr double k_weak = 1e5, k_moment = 1.25e-4 * k_weak;
constexpr unsigned k_pinned = 0b101111;  // turns in the plane

/// A plane frame and the plastic moment of each of its members, over k_moment.
struct StrengthFrame {
  PlaneFrame frame;
  std::vector<double> strength;

  Model build() const {
    Model model = frame.build(pure_bending_section(), weak_steel(k_weak));
    for (Element& element : model.elements)
      element.capacity[2] = strength[static_cast<std::size_t>(element.member)] * k_moment;
    return model;
  }
};

/// Greatest load factor under which some end moments within the plastic ones, and normal forces, balance the
/// loads at every node. Variables: per member N+, N-, and M + Mp and its slack at each end, then the factor.
double limit_of_equilibrium(const StrengthFrame& of) {
  const auto& nodes = of.frame.nodes;
  const auto& members = of.frame.members;
  const auto at = [](std::size_t value) { return static_cast<Eigen::Index>(value); };
  const Eigen::Index per = 6, columns = at(per * members.size() + 1), ends = at(2 * members.size());
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(at(3 * nodes.size()) + ends, columns);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(a.rows());
  for (std::size_t m = 0; m < members.size(); ++m) {
    const auto [i, j] = members[m];
    const Vec3 span = nodes[static_cast<std::size_t>(j)] - nodes[static_cast<std::size_t>(i)];
    const double length = span.norm(), c = span.x() / length, s = span.z() / length;
    const Eigen::Index n = per * at(m), row_i = 3 * i, row_j = 3 * j;
    const double mp = of.strength[m] * k_moment;
    const auto add = [&](Eigen::Index row, Eigen::Index column, double factor) { a(row, column) += factor; };
    for (const auto& [column, sign] : {std::pair(n, 1.), std::pair(n + 1, -1.)}) {  // tension on its nodes
      add(row_i, column, sign * c), add(row_i + 1, column, sign * s);
      add(row_j, column, -sign * c), add(row_j + 1, column, -sign * s);
    }
    for (int end = 0; end < 2; ++end) {
      // a moment M on the end's node; the shear of both, (M1 + M2)/L, turns the member back
      const Eigen::Index column = n + 2 + 2 * end, slack = column + 1,
                         bound = at(3 * nodes.size()) + 2 * at(m) + end;
      const double v = 1 / length;
      const auto each = [&](Eigen::Index row, double factor) {
        add(row, column, factor);
        b[row] += factor * mp;
      };
      each(end == 0 ? row_i + 2 : row_j + 2, -1);
      each(row_i, -v * s), each(row_i + 1, v * c);
      each(row_j, v * s), each(row_j + 1, -v * c);
      a(bound, column) = a(bound, slack) = 1;
      b[bound] = 2 * mp;
    }
  }
  for (const Load& load : of.frame.loads) {
    a(3 * load.node, columns - 1) += load.force.x();
    a(3 * load.node + 1, columns - 1) += load.force.z();
  }
  std::vector<Eigen::Index> kept;
  std::map<int, unsigned> held;
  for (const Support& support : of.frame.supports) held[support.node] |= support.fixed;
  for (Eigen::Index row = 0; row < a.rows(); ++row) {
    const bool joint = row < at(3 * nodes.size());
    constexpr unsigned k_bits[] = {1u << 0, 1u << 2, 1u << 4};  // x, z, the turn about y
    if (!joint || !(held[static_cast<int>(row / 3)] & k_bits[row % 3])) kept.push_back(row);
  }
  Eigen::VectorXd gain = Eigen::VectorXd::Zero(columns);
  gain[columns - 1] = 1;
  return greatest(a(kept, Eigen::all), b(kept), gain).value_or(-1);
}

/// Greatest load factor of a path by arc length; displacements stay at 1e-5 of the size.
double collapse(const StrengthFrame& of) {
  topple::Setup setup;
  setup.model = of.build();
  setup.starts.resize(1);
  setup.parameters.gravity.setZero();
  constexpr int k_steps = 500;
  constexpr double k_step = k_moment / (205e9 * 5e-6) / 10;
  setup.run = {
      .analysis = Analysis::statics,
      .statics = {.load_steps = k_steps, .control = PathControl{.to = k_steps * k_step, .arc_length = true}},
      .settle = false};
  topple::Run run(setup);
  double greatest = 0;
  while (!run.over()) {
    run.advance();
    greatest = std::max(greatest, run.state().load_factor);
    for (std::size_t e = 0; e < setup.model.elements.size(); ++e) {
      const Element& element = setup.model.elements[e];
      const auto [i, j] = element.node;
      const State& now = run.state();
      const SectionForces forces = section_forces(
          element,
          elastic_strain(now.elements[e], beam_strain(element, beam_ends(now.position[i], now.rotation[i],
                                                                         now.position[j], now.rotation[j]))));
      for (const double xi : {-1., 1.})
        EXPECT_LT(yield_function(element, forces_along(forces, element.length, element.s, xi)), 1e-9);
    }
  }
  EXPECT_TRUE(run.status().ok()) << run.status().message(setup.model);
  return greatest;
}

// Two hinges of equal strength in each corner; with V = H two mechanisms coincide. Combined: H h + V l/2 =
// 4 Mp. The frame's sway is 1e-5 of its height.
TEST(CollapseLoad, pinned_portal_of_one_section_comes_to_that_of_plastic_theory) {
  constexpr double k_height = 2, k_span = 4;
  for (const double share : {2., 1.5, 1.}) {
    StrengthFrame portal{
        {.nodes = {{0, 0, 0}, {0, 0, k_height}, {2, 0, k_height}, {k_span, 0, k_height}, {k_span, 0, 0}},
         .members = {{0, 1}, {1, 2}, {2, 3}, {3, 4}},
         .supports = {{0, k_pinned}, {4, k_pinned}},
         .loads = {{1, {k_moment, 0, 0}, Vec3::Zero(), {}},
                   {2, {0, 0, -share * k_moment}, Vec3::Zero(), {}}}},
        {1, 1, 1, 1}};
    const double exact = 4 / (k_height + share * k_span / 2);
    EXPECT_NEAR(limit_of_equilibrium(portal), exact, 1e-9);
    EXPECT_NEAR(collapse(portal) / exact, 1, 1e-4) << share;
  }
}

double between(std::mt19937& rng, double least, double most) {
  return std::uniform_real_distribution<double>(least, most)(rng);
}

/// One or two storeys; beams have a node in the middle, where they are loaded.
StrengthFrame random_frame(std::mt19937& rng, int storeys) {
  StrengthFrame of;
  const double span = between(rng, 3, 6);
  const double strengths[] = {1, 1, 2};  // often the same on both sides of a joint
  const auto strength = [&] { return strengths[std::uniform_int_distribution<int>(0, 2)(rng)]; };
  double height = 0;
  of.frame.nodes = {{0, 0, 0}, {span, 0, 0}};
  const unsigned foot = between(rng, 0, 1) < 0.5 ? k_pinned : k_clamped;
  of.frame.supports = {{0, foot}, {1, foot}};
  int left = 0, right = 1;
  for (int storey = 0; storey < storeys; ++storey) {
    height += between(rng, 2.5, 4);
    const int first = static_cast<int>(of.frame.nodes.size());
    for (const double x : {0., span / 2, span}) of.frame.nodes.emplace_back(x, 0, height);
    const double column = strength(), beam = strength();
    for (const auto& [i, j, mp] :
         {std::tuple(left, first, column), std::tuple(first, first + 1, beam),
          std::tuple(first + 1, first + 2, beam), std::tuple(first + 2, right, column)}) {
      of.frame.members.emplace_back(i, j);
      of.strength.push_back(mp);
    }
    of.frame.loads.push_back({first, {k_moment * between(rng, 0.1, 1), 0, 0}, Vec3::Zero(), {}});
    of.frame.loads.push_back({first + 1, {0, 0, -k_moment * between(rng, 0.1, 2)}, Vec3::Zero(), {}});
    left = first, right = first + 2;
  }
  return of;
}

// Displacements are small, but the factor only comes to the last hinge as steps end: 0.1 %.
TEST(CollapseLoad, random_frames_come_to_what_linear_programming_finds) {
  std::mt19937 rng(39);
  for (int sample = 0; sample < 20; ++sample) {
    const StrengthFrame of = random_frame(rng, 1 + sample % 2);
    const double exact = limit_of_equilibrium(of);
    ASSERT_GT(exact, 0) << sample;
    EXPECT_NEAR(collapse(of) / exact, 1, 1e-3) << sample;
  }
}

}  // namespace
}  // namespace topple::test
