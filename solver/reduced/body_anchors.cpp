#include "solver/reduced/body_anchors.h"

#include <algorithm>

#include "solver/math/rotation.h"
#include "solver/reduced/elastic_basis.h"

namespace topple {
namespace {

bool in_place(const BodyAnchors::Tie& tie) {
  return tie.state.hold == AnchorHold::in_place;
}

}  // namespace

BodyAnchors::BodyAnchors(const Model& model, int index)
    : model_(model),
      mass_(model.bodies[index].mass),
      inverse_moment_(model.bodies[index].inertia.inverse().trace()) {
  const Body& body = model.bodies[index];
  for (int k = 0; k < static_cast<int>(model.anchors.size()); ++k) {
    const Anchor& anchor = model.anchors[k];
    if (anchor.body != index || anchor.other.body >= 0) continue;  // BodyTies has those
    Tie tie;
    tie.index = k;
    tie.node = anchor.node - body.first_node;
    tie.place = model.node_position[anchor.node] - body.centre_of_gravity + anchor.arm;
    tie.arm = tie.place;
    for (int mode = 0; body.elastic && mode < body.elastic->modes; ++mode)
      tie.shape.push_back(anchor_shape(model, anchor.own(), mode));
    ties_.push_back(tie);
  }
}

void BodyAnchors::remember(std::span<const AnchorState> all) {
  for (Tie& tie : ties_) tie.state = all[tie.index];
}

void BodyAnchors::find(const BodyState& s) {
  for (Tie& tie : ties_) {
    tie.arm = tie.place;
    for (std::size_t k = 0; s.level == ModelLevel::elastic && k < tie.shape.size(); ++k)
      tie.arm += s.amplitude[static_cast<Eigen::Index>(k)] * tie.shape[k];
    tie.arm = s.rotation * tie.arm;
    tie.now = anchor_force(anchor(tie), tie.state, s.position + tie.arm);
  }
}

bool BodyAnchors::any() const {
  return std::any_of(ties_.begin(), ties_.end(), in_place);
}

Vec3 BodyAnchors::force() const {
  Vec3 sum = Vec3::Zero();
  for (const Tie& tie : ties_) sum += tie.now.force;
  return sum;
}

Vec3 BodyAnchors::moment() const {
  Vec3 sum = Vec3::Zero();
  for (const Tie& tie : ties_) sum += tie.arm.cross(tie.now.force);
  return sum;
}

double BodyAnchors::energy() const {
  double sum = 0;
  for (const Tie& tie : ties_) sum += tie.now.energy;
  return sum;
}

void BodyAnchors::modal_loads(const BodyState& s, int modes, Amplitudes& load) const {
  for (const Tie& tie : ties_) {
    const Vec3 force = s.rotation.conjugate() * tie.now.force;
    for (int k = 0; k < modes; ++k) load[k] += tie.shape[k].dot(force);
  }
}

void BodyAnchors::add_slope(const BodyState& s, double gamma_dt, ContactSlope& slope) const {
  for (const Tie& tie : ties_) {
    const Mat6 by_place =
        gamma_dt *
        anchor_slope(anchor_tangent(anchor(tie), tie.state, s.position + tie.arm), tie.arm, tie.now.force);
    const auto block = [&](int row, int column) { return packed(Mat3(by_place.block<3, 3>(row, column))); };
    slope.force_linear = slope.force_linear + block(0, 0);
    slope.force_angular = slope.force_angular + block(0, 3);
    slope.moment_linear = slope.moment_linear + block(3, 0);
    slope.moment_angular = slope.moment_angular + block(3, 3);
  }
}

void BodyAnchors::add_stiffness(const BodyState& s, int modes, Eigen::MatrixXd& stiffness) const {
  const Mat3 r = s.rotation.toRotationMatrix();
  for (const Tie& tie : ties_) {
    const Mat3 tangent = anchor_tangent(anchor(tie), tie.state, s.position + tie.arm);
    Eigen::MatrixXd j(3, 6 + modes);
    j.leftCols<3>().setIdentity();
    j.middleCols<3>(3) = -skew(tie.arm);
    for (int k = 0; k < modes; ++k) j.block<3, 1>(0, 6 + k) = r * tie.shape[k];
    stiffness -= j.transpose() * tangent * j;
    stiffness.block<3, 3>(3, 3) -= skew(tie.now.force) * skew(tie.arm);
  }
}

double BodyAnchors::greatest_stiffness() const {
  double sum = 0;
  for (const Tie& tie : ties_)
    if (in_place(tie)) sum += anchor(tie).stiffness;
  return sum;
}

double BodyAnchors::stiffest() const {
  double sum = 0;
  for (const Tie& tie : ties_) {
    if (!in_place(tie)) continue;
    double inverse_mass = 1 / mass_ + tie.place.squaredNorm() * inverse_moment_;
    for (const Vec3& shape : tie.shape) inverse_mass += shape.squaredNorm();
    sum += anchor(tie).stiffness * inverse_mass;
  }
  return sum;
}

std::uint64_t BodyAnchors::hash() const {
  std::uint64_t hash = 0;
  for (const Tie& tie : ties_) hash = 31 * hash + (in_place(tie) ? 1 : 0);
  return hash;
}

}  // namespace topple
