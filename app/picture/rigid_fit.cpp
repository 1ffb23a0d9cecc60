#include "app/picture/rigid_fit.h"

#include <Eigen/LU>
#include <Eigen/SVD>

#include <algorithm>
#include <numeric>

#include "app/picture/row.h"
#include "solver/math/rotation.h"

namespace topple::app {
namespace {

/// Piece of each node: what whole elements join. Returns how many there are.
int find_pieces(const Model& model, const io::FrameRow& row, std::vector<int>& piece) {
  int count = 0;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    const auto codes = row.hinge.begin() + body.first_element;
    if (std::find(codes, codes + body.element_count, k_broken) == codes + body.element_count) {
      std::fill_n(piece.begin() + body.first_node, body.node_count, count++);
      continue;
    }
    std::vector<int> joined(static_cast<std::size_t>(body.node_count));  // a node of the same piece, from 0
    std::iota(joined.begin(), joined.end(), 0);
    const auto root = [&](int i) {
      while (joined[i] != i) i = joined[i] = joined[joined[i]];
      return i;
    };
    for (int e = body.first_element; e < body.first_element + body.element_count; ++e)
      if (row.hinge[e] != k_broken)
        joined[root(model.elements[e].node[0] - body.first_node)] =
            root(model.elements[e].node[1] - body.first_node);
    std::vector<int> number(joined.size(), -1);
    for (int i = 0; i < body.node_count; ++i) {
      int& of_root = number[root(i)];
      if (of_root < 0) of_root = count++;
      piece[body.first_node + i] = of_root;
    }
  }
  return count;
}

/// No rigid motion satisfies the supports of these pieces.
std::vector<bool> held_pieces(const Model& model, const std::vector<int>& piece, int count) {
  std::vector<bool> held(count, false);
  std::vector<Eigen::MatrixXd> constraints(count, Eigen::MatrixXd(0, 6));
  for (const Support& support : model.supports) {
    Eigen::MatrixXd& rows = constraints[piece[support.node]];
    for (unsigned k = 0; k < 6; ++k) {
      if (!(support.fixed >> k & 1)) continue;
      const Vec3 axis = Vec3::Unit(k % 3);
      rows.conservativeResize(rows.rows() + 1, 6);
      rows.bottomRows(1) << (k < 3 ? axis : Vec3::Zero()).transpose(),
          (k < 3 ? model.node_position[support.node].cross(axis) : axis).transpose();
    }
  }
  for (int p = 0; p < count; ++p)
    held[p] = constraints[p].rows() >= 6 && Eigen::FullPivLU<Eigen::MatrixXd>(constraints[p]).rank() == 6;
  return held;
}

}  // namespace

RigidFit rigid_fit(const Model& model, const io::FrameRow& row) {
  RigidFit fit;
  fit.piece.resize(model.node_position.size());
  const int count = find_pieces(model, row, fit.piece);
  const std::vector<bool> held = held_pieces(model, fit.piece, count);
  struct Sums {
    double mass = 0, square = 0;
    Vec3 from = Vec3::Zero(), to = Vec3::Zero();
    Mat3 turn = Mat3::Zero(), nodes = Mat3::Zero();
  };
  std::vector<Sums> sums(count);
  constexpr double k_massless = 1e-12;  // kg: nodes without mass, as of statics, count alike
  const auto weight = [&](int i) { return model.node_mass[i] + k_massless; };
  for (int i = 0; i < model.node_total(); ++i) {
    Sums& s = sums[fit.piece[i]];
    s.mass += weight(i);
    s.from += weight(i) * model.node_position[i];
    s.to += weight(i) * position(row, i);
  }
  for (Sums& s : sums) s.from /= s.mass, s.to /= s.mass;
  for (int i = 0; i < model.node_total(); ++i) {
    Sums& s = sums[fit.piece[i]];
    const Vec3 arm = model.node_position[i] - s.from;
    s.square += weight(i) * arm.squaredNorm();
    s.turn += weight(i) * (position(row, i) - s.to) * arm.transpose();
    s.nodes += weight(i) * rotation(row, i).toRotationMatrix();
  }
  fit.motion.assign(count, Eigen::Isometry3d::Identity());
  for (int p = 0; p < count; ++p) {
    if (held[p]) continue;
    const Sums& s = sums[p];
    // The nodes' own rotations decide what places leave open: the turn of a line about itself.
    constexpr double k_node_share = 1e-9;
    const double share = s.square > 0 ? k_node_share * s.square / s.mass : 1;
    const Eigen::JacobiSVD<Mat3> svd(s.turn + share * s.nodes, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Mat3 u = svd.matrixU();
    if (u.determinant() * svd.matrixV().determinant() < 0) u.col(2) = -u.col(2);
    fit.motion[p].linear() = u * svd.matrixV().transpose();
    fit.motion[p].translation() = s.to - fit.motion[p].linear() * s.from;
  }
  return fit;
}

Vec3 displacement(const Model& model, const io::FrameRow& row, const RigidFit& fit, int node) {
  return position(row, node) - fit.of(node) * model.node_position[node];
}

void exaggerate(const Model& model, const RigidFit& fit, double factor, io::FrameRow& row) {
  if (factor == 1) return;
  for (int i = 0; i < model.node_total(); ++i) {
    const Vec3 x = position(row, i) + (factor - 1) * displacement(model, row, fit, i);
    const Quat rigid(fit.of(i).linear());
    const Vec3 turn = log_quaternion(rigid.conjugate() * rotation(row, i));
    const double angle = turn.norm();
    const double most = angle > 0 ? std::max(k_pi / 2 / angle, 1.) : 1;
    const Quat q = rigid * exp_quaternion(std::min(factor, most) * turn);
    const double parts[4] = {q.w(), q.x(), q.y(), q.z()};
    for (int k = 0; k < 3; ++k) row.position[3 * i + k] = static_cast<float>(x[k]);
    for (int k = 0; k < 4; ++k) row.rotation[4 * i + k] = static_cast<float>(parts[k]);
  }
}

}  // namespace topple::app
