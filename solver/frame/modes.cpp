#include "solver/frame/modes.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "solver/element/beam.h"
#include "solver/frame/body_system.h"
#include "solver/frame/start_vector.h"
#include "solver/math/block_lu.h"
#include "solver/math/rotation.h"

namespace topple {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int k_blocks = 8;  // Krylov blocks between two restarts
constexpr int k_guard = 4;   // vectors beyond those asked for
constexpr int k_most_restarts = 40;
constexpr double k_converged = 1e-9;   // relative change of w^2 + shift between restarts
constexpr double k_no_strain = 1e-12;  // of the sum of sizes of its terms: strain that rounding may be

// K and M of one body in six numbers per node; fixed directions stay zero.
class Pencil {
 public:
  Pencil(const Model& model, int body) : s_(model, body), tangents_(model.bodies[body].element_count) {
    const Body& b = model.bodies[body];
    for (int e = 0; e < b.element_count; ++e)
      tangents_[e] = beam_stiffness(model, model.elements[b.first_element + e]);
    for (int i = 0; i < s_.count; ++i)
      for (int k = 0; k < 6; ++k)
        if (!s_.is_fixed(i, k)) free_.push_back(6 * i + k);
  }

  const BodySystem& system() const { return s_; }
  int rows() const { return 6 * s_.count; }
  int unknowns() const { return static_cast<int>(free_.size()); }
  const std::vector<int>& free() const { return free_; }

  bool has_mass() const {
    for (int i = 0; i < s_.count; ++i) {
      const Mat3& j = s_.model.node_inertia[s_.first + i];
      if (!(s_.model.node_mass[s_.first + i] > 0) || j.llt().info() != Eigen::Success) return false;
    }
    return true;
  }

  MatrixXd mass(const MatrixXd& v) const {
    MatrixXd out(v.rows(), v.cols());
    for (int i = 0; i < s_.count; ++i) {
      out.middleRows<3>(6 * i) = s_.model.node_mass[s_.first + i] * v.middleRows<3>(6 * i);
      out.middleRows<3>(6 * i + 3) = s_.model.node_inertia[s_.first + i] * v.middleRows<3>(6 * i + 3);
    }
    return clear_fixed(std::move(out));
  }

  MatrixXd stiffness(const MatrixXd& v) const {
    MatrixXd out = MatrixXd::Zero(v.rows(), v.cols());
    each_element([&](int i, int j, const Mat12& k) {
      MatrixXd u(12, v.cols());
      u << v.middleRows<6>(6 * i), v.middleRows<6>(6 * j);
      const MatrixXd f = k * u;
      out.middleRows<6>(6 * i) += f.topRows<6>();
      out.middleRows<6>(6 * j) += f.bottomRows<6>();
    });
    return clear_fixed(std::move(out));
  }

  // v K v as the sum of the sizes of its terms.
  double terms_of_strain(const VectorXd& v) const {
    double sum = 0;
    each_element([&](int i, int j, const Mat12& k) {
      Eigen::Matrix<double, 12, 1> u;
      u << v.segment<6>(6 * i), v.segment<6>(6 * j);
      sum += u.cwiseAbs().dot(k.cwiseAbs() * u.cwiseAbs());
    });
    return sum;
  }

  // About the highest w^2: the greatest of a single direction.
  double highest() const {
    VectorXd diagonal = VectorXd::Zero(rows());
    each_element([&](int i, int j, const Mat12& k) {
      diagonal.segment<6>(6 * i) += k.diagonal().head<6>();
      diagonal.segment<6>(6 * j) += k.diagonal().tail<6>();
    });
    double greatest = 0;
    for (const int f : free_) {
      const int node = s_.first + f / 6, k = f % 6;
      const double m = k < 3 ? s_.model.node_mass[node] : s_.model.node_inertia[node](k - 3, k - 3);
      greatest = std::max(greatest, diagonal[f] / m);
    }
    return greatest;
  }

  // Factors K + shift M.
  void factor(double shift) {
    s_.lu.set_zero();
    each_element([&](int i, int j, const Mat12& k) {
      s_.lu.add(i, i, k.block<6, 6>(0, 0));
      s_.lu.add(i, j, k.block<6, 6>(0, 6));
      s_.lu.add(j, i, k.block<6, 6>(6, 0));
      s_.lu.add(j, j, k.block<6, 6>(6, 6));
    });
    for (int i = 0; i < s_.count; ++i) {
      Mat6 block = Mat6::Zero();
      block.diagonal().head<3>().setConstant(shift * s_.model.node_mass[s_.first + i]);
      block.bottomRightCorner<3, 3>() = shift * s_.model.node_inertia[s_.first + i];
      s_.lu.add(i, i, block);
      for (int k = 0; k < 6; ++k)
        if (s_.is_fixed(i, k)) s_.lu.fix(i, k);
    }
    s_.lu.factor();
  }
  MatrixXd solve(MatrixXd b) const {
    for (int c = 0; c < b.cols(); ++c) s_.lu.solve(b.col(c).data());
    return b;
  }

  MatrixXd clear_fixed(MatrixXd v) const {
    for (int i = 0; i < s_.count; ++i)
      for (int k = 0; k < 6; ++k)
        if (s_.is_fixed(i, k)) v.row(6 * i + k).setZero();
    return v;
  }

 private:
  template <class F>
  void each_element(F f) const {
    const Body& b = s_.model.bodies[s_.index];
    for (int e = 0; e < b.element_count; ++e) {
      const Element& element = s_.model.elements[b.first_element + e];
      f(element.node[0] - s_.first, element.node[1] - s_.first, tangents_[e]);
    }
  }

  BodySystem s_;
  std::vector<Mat12> tangents_;
  std::vector<int> free_;
};

// Makes the columns of v orthonormal in M and to `base`; drops those that depend on the others.
MatrixXd orthonormal(const Pencil& p, const MatrixXd& base, MatrixXd v) {
  const MatrixXd base_mass = p.mass(base);
  MatrixXd out(v.rows(), v.cols());
  int kept = 0;
  for (int c = 0; c < v.cols(); ++c) {
    VectorXd x = v.col(c);
    const double before = std::sqrt(x.dot(VectorXd(p.mass(x))));
    for (int pass = 0; pass < 2; ++pass) {
      x -= base * (base_mass.transpose() * x);
      if (kept > 0) x -= out.leftCols(kept) * (out.leftCols(kept).transpose() * p.mass(x));
    }
    const double after = std::sqrt(x.dot(VectorXd(p.mass(x))));
    if (after > 1e-10 * before) out.col(kept++) = x / after;
  }
  return out.leftCols(kept);
}

// Rigid motions that move no fixed direction, orthonormal in M.
MatrixXd rigid_motions(const Pencil& p) {
  const BodySystem& s = p.system();
  const Vec3& centre = s.model.bodies[s.index].centre_of_gravity;
  MatrixXd motion = MatrixXd::Zero(p.rows(), 6);
  for (int i = 0; i < s.count; ++i) {
    motion.block<3, 3>(6 * i, 0).setIdentity();
    motion.block<3, 3>(6 * i, 3) = -skew((s.model.node_position[s.first + i] - centre) / s.size);
    motion.block<3, 3>(6 * i + 3, 3) = Mat3::Identity() / s.size;
  }
  MatrixXd held = motion - p.clear_fixed(motion);
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> solver(held.transpose() * held);
  int free = 0;
  while (free < 6 && solver.eigenvalues()[free] < 1e-12) ++free;
  return orthonormal(p, MatrixXd(p.rows(), 0), p.clear_fixed(motion * solver.eigenvectors().leftCols(free)));
}

struct Pairs {
  VectorXd value;
  MatrixXd vector;
};

// Rayleigh and Ritz on an M-orthonormal basis.
Pairs ritz(const Pencil& p, const MatrixXd& basis, int count) {
  const MatrixXd projected = basis.transpose() * p.stiffness(basis);
  Eigen::SelfAdjointEigenSolver<MatrixXd> solver((projected + projected.transpose()) / 2);
  const int n = std::min<int>(count, static_cast<int>(basis.cols()));
  return {solver.eigenvalues().head(n), basis * solver.eigenvectors().leftCols(n)};
}

// The lowest pairs with strain.
Pairs elastic_pairs(Pencil& p, const MatrixXd& rigid, int count) {
  const int left = p.unknowns() - static_cast<int>(rigid.cols());
  if (count + k_guard >= left / 2) {  // a small body: every vector at once
    MatrixXd all = MatrixXd::Zero(p.rows(), p.unknowns());
    for (int c = 0; c < p.unknowns(); ++c) all(p.free()[c], c) = 1;
    return ritz(p, orthonormal(p, rigid, std::move(all)), std::min(count, left));
  }
  double shift = 1e-9 * p.highest();
  MatrixXd start(p.rows(), count + k_guard);
  for (int c = 0; c < start.cols(); ++c)
    for (int r = 0; r < p.rows(); ++r) start(r, c) = start_entry(r, c);
  start = p.clear_fixed(std::move(start));
  Pairs found;
  for (int restart = 0; restart < k_most_restarts; ++restart) {
    p.factor(shift);
    MatrixXd basis = orthonormal(p, rigid, std::move(start)), block = basis;
    for (int k = 1; k < k_blocks && basis.cols() < left; ++k) {
      MatrixXd known(p.rows(), rigid.cols() + basis.cols());
      known << rigid, basis;
      // rounding on fixed directions has no mass: it would grow unseen
      block = orthonormal(p, known, p.clear_fixed(p.solve(p.mass(block))));
      if (block.cols() == 0) break;
      known.resize(p.rows(), basis.cols() + block.cols());
      known << basis, block;
      basis = std::move(known);
    }
    const VectorXd before = found.value;
    found = ritz(p, basis, count + k_guard);
    const auto settled = [&](int k) {
      return std::abs(found.value[k] - before[k]) < k_converged * (found.value[k] + shift);
    };
    bool done = before.size() > 0;
    for (int k = 0; done && k < count; ++k) done = settled(k);
    if (done) break;
    start = found.vector;
    shift = std::max(shift, found.value[0]);
  }
  found.value.conservativeResize(count);
  found.vector.conservativeResize(Eigen::NoChange, count);
  return found;
}

Mode mode(const Pencil& p, double value, const VectorXd& v, bool rigid) {
  const BodySystem& s = p.system();
  Mode out;
  out.rigid = rigid;
  out.frequency = rigid ? 0 : std::sqrt(value) / (2 * k_pi);
  const VectorXd momentum = p.mass(v);
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < s.count; ++i) {
    out.displacement.push_back(v.segment<3>(6 * i));
    out.rotation.push_back(v.segment<3>(6 * i + 3));
    sum += momentum.segment<3>(6 * i);
  }
  out.effective_mass = sum.cwiseAbs2();
  return out;
}

}  // namespace

std::vector<Mode> natural_modes(const Model& model, int body, int count) {
  Pencil p(model, body);
  std::vector<Mode> modes;
  if (!p.has_mass()) return modes;
  count = std::min(count, p.unknowns());
  const MatrixXd rigid = rigid_motions(p);
  for (int c = 0; c < std::min<int>(count, static_cast<int>(rigid.cols())); ++c)
    modes.push_back(mode(p, 0, rigid.col(c), true));
  if (count <= rigid.cols()) return modes;
  const Pairs pairs = elastic_pairs(p, rigid, count - static_cast<int>(rigid.cols()));
  for (int c = 0; c < pairs.value.size(); ++c) {
    const VectorXd shape = pairs.vector.col(c);
    modes.push_back(mode(p, pairs.value[c], shape, pairs.value[c] < k_no_strain * p.terms_of_strain(shape)));
  }
  return modes;
}

}  // namespace topple
