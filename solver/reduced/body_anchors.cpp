#include "solver/reduced/body_anchors.h"

#include <algorithm>
#include <limits>

#include "solver/math/rotation.h"
#include "solver/reduced/elastic_basis.h"

namespace topple {
namespace {

bool in_place(const BodyAnchors::Tie& tie) {
  return tie.state.hold == AnchorHold::in_place;
}

bool is_pull(const BodyAnchors::Tie& tie) {
  return tie.index < 0;
}

// Of a pull, whose force is its own.
const Anchor& no_spring() {
  static const Anchor none{{},
                           0,
                           0,
                           Vec3::Zero(),
                           Vec3::Zero(),
                           {},
                           Anchor::Type::bracket,
                           0,
                           std::numeric_limits<double>::infinity(),
                           0};
  return none;
}

// Of the attached point from the centre of gravity, floor's axes.
Vec3 arm_of(const BodyAnchors::Tie& tie, const BodyState& s) {
  Vec3 arm = tie.place;
  for (std::size_t k = 0; s.level == ModelLevel::elastic && k < tie.shape.size(); ++k)
    arm += s.amplitude[static_cast<Eigen::Index>(k)] * tie.shape[k];
  return s.rotation * arm;
}

}  // namespace

BodyAnchors::BodyAnchors(const Model& model, int index)
    : model_(model),
      body_(index),
      mass_(model.bodies[index].mass),
      inverse_moment_(model.bodies[index].inertia.inverse().trace()) {
  for (int k = 0; k < static_cast<int>(model.anchors.size()); ++k) {
    const Anchor& anchor = model.anchors[k];
    if (anchor.body != index || anchor.other.body >= 0) continue;  // BodyTies has those
    ties_.push_back(tie_of(anchor, k, anchor.own()));
  }
}

BodyAnchors::Tie BodyAnchors::tie_of(const Anchor& anchor, int index, const AnchorEnd& end) const {
  const Body& body = model_.bodies[body_];
  Tie tie;
  tie.anchor = &anchor;
  tie.index = index;
  tie.node = end.node - body.first_node;
  tie.place = model_.node_position[end.node] - body.centre_of_gravity + end.arm;
  tie.arm = tie.place;
  for (int mode = 0; body.elastic && mode < body.elastic->modes; ++mode)
    tie.shape.push_back(anchor_shape(model_, end, mode));
  return tie;
}

void BodyAnchors::remember(std::span<const AnchorState> all) {
  for (Tie& tie : ties_)
    if (!is_pull(tie)) tie.state = all[tie.index];
}

void BodyAnchors::take(std::span<const PulledNode> pulls) {
  while (!ties_.empty() && is_pull(ties_.back())) ties_.pop_back();
  for (const PulledNode& pull : pulls) {
    if (model_.node_body[pull.node] != body_) continue;
    ties_.push_back(tie_of(no_spring(), -1, {body_, pull.node, Vec3::Zero()}));
    ties_.back().now.force = pull.force;
  }
}

void BodyAnchors::find(const BodyState& s) {
  for (Tie& tie : ties_) {
    tie.arm = arm_of(tie, s);
    if (!is_pull(tie)) tie.now = anchor_force(*tie.anchor, tie.state, s.position + tie.arm);
  }
}

double BodyAnchors::pull_work(std::span<const PulledNode> start, std::span<const PulledNode> end,
                              const BodyState& before, const BodyState& s) const {
  double work = 0;
  auto tie = std::find_if(ties_.begin(), ties_.end(), is_pull);
  for (std::size_t k = 0; k < end.size() && tie != ties_.end(); ++k) {
    if (model_.node_body[end[k].node] != body_) continue;
    const Vec3 travel = s.position + arm_of(*tie, s) - before.position - arm_of(*tie, before);
    work += 0.5 * (start[k].force + end[k].force).dot(travel);
    ++tie;
  }
  return work;
}

bool BodyAnchors::any() const {
  return std::any_of(ties_.begin(), ties_.end(), in_place);
}

bool BodyAnchors::holds() const {
  return std::any_of(ties_.begin(), ties_.end(),
                     [](const Tie& tie) { return !is_pull(tie) && in_place(tie); });
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
        anchor_slope(anchor_tangent(*tie.anchor, tie.state, s.position + tie.arm), tie.arm, tie.now.force);
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
    const Mat3 tangent = anchor_tangent(*tie.anchor, tie.state, s.position + tie.arm);
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
    if (in_place(tie)) sum += tie.anchor->stiffness;
  return sum;
}

double BodyAnchors::stiffest() const {
  double sum = 0;
  for (const Tie& tie : ties_) {
    if (!in_place(tie)) continue;
    double inverse_mass = 1 / mass_ + tie.place.squaredNorm() * inverse_moment_;
    for (const Vec3& shape : tie.shape) inverse_mass += shape.squaredNorm();
    sum += tie.anchor->stiffness * inverse_mass;
  }
  return sum;
}

std::uint64_t BodyAnchors::hash() const {
  std::uint64_t hash = 0;
  for (const Tie& tie : ties_)
    if (!is_pull(tie)) hash = 31 * hash + (in_place(tie) ? 1 : 0);
  return hash;
}

}  // namespace topple
