#include "solver/reduced/body_ties.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/math/ranges.h"
#include "solver/math/rotation.h"
#include "solver/reduced/elastic_basis.h"
#include "solver/state/step_limits.h"

namespace topple {

BodyTies::BodyTies(const Model& model, const std::vector<int>& bodies) : model_(model) {
  for (int k = 0; k < static_cast<int>(model.anchors.size()); ++k) {
    const Anchor& anchor = model.anchors[k];
    Tie tie{k, {}, {}};
    int found = 0;
    for (const AnchorEnd& of : {anchor.own(), anchor.other}) {
      const auto own = ranges::find(bodies, of.body);
      if (of.body < 0 || own == bodies.end()) break;
      const Body& body = model.bodies[of.body];
      End& end = tie.end[found++];
      end.body = static_cast<int>(own - bodies.begin());
      end.node = of.node;
      end.place = model.node_position[of.node] - body.centre_of_gravity + of.arm;
      end.mass = body.mass;
      end.arm = end.at = Vec3::Zero();
      for (int mode = 0; body.elastic && mode < body.elastic->modes; ++mode)
        end.shape.push_back(anchor_shape(model, of, mode));
      end.turned = end.shape;
    }
    if (found == 2) ties_.push_back(std::move(tie));
  }
}

void BodyTies::remember(std::span<const AnchorState> all) {
  for (Tie& tie : ties_) tie.state = all[tie.index];
}

void BodyTies::place(int body, const BodyState& pose, const PackMat3& r) {
  for (Tie& tie : ties_)
    for (End& end : tie.end) {
      if (end.body != body) continue;
      end.modes = traits(pose.level).has_modes ? static_cast<int>(end.shape.size()) : 0;
      end.arm = unpacked(r * packed(end.place));
      for (int k = 0; k < end.modes; ++k) {
        end.turned[k] = unpacked(r * packed(end.shape[k]));
        end.arm += pose.amplitude[k] * end.turned[k];
      }
      end.at = pose.position + end.arm;
    }
}

double BodyTies::energy() const {
  double sum = 0;
  for (const Tie& tie : ties_) sum += now(tie).energy;
  return sum;
}

void BodyTies::add_loads(std::vector<BodyVelocity>& loads) const {
  for (const Tie& tie : ties_) {
    Vec3 force = now(tie).force;
    for (const End& end : tie.end) {
      BodyVelocity& load = loads[end.body];
      load.linear = load.linear + packed(force);
      load.angular = load.angular + packed(Vec3(end.arm.cross(force)));
      for (int k = 0; k < end.modes; ++k) load.rate[k] += end.turned[k].dot(force);
      force = -force;
    }
  }
}

// What the turn of an end's arm and modes with the body, and the arm's change by the modes, take off the
// block of groups i and j.
void BodyTies::add_turning(const End& end, int i, int j, const Vec3& force, Mat6& block) {
  if (i == 0 && j == 0) block.bottomRightCorner<3, 3>() -= skew(force) * skew(end.arm);
  if ((i == 0) == (j == 0)) return;
  const int first = 6 * (std::max(i, j) - 1);
  for (int k = 0; k < 6 && first + k < end.modes; ++k) {
    const Vec3 turning = end.turned[first + k].cross(force);
    if (i == 0)
      block.block<3, 1>(3, k) -= turning;
    else
      block.block<1, 3>(k, 3) -= turning.transpose();
  }
}

void BodyTies::each_block(const AddBlock& add) const {
  using Columns = Eigen::Matrix<double, 3, 6>;
  const auto columns = [](const End& end, int group) {
    Columns j = Columns::Zero();
    if (group == 0) {
      j.leftCols<3>().setIdentity();
      j.rightCols<3>() = -skew(end.arm);
    }
    for (int k = 0; group > 0 && k < 6 && 6 * (group - 1) + k < end.modes; ++k)
      j.col(k) = end.turned[6 * (group - 1) + k];
    return j;
  };
  const auto groups = [](const End& end) { return 1 + (end.modes + 5) / 6; };
  for (const Tie& tie : ties_) {
    if (tie.state.hold != AnchorHold::in_place) continue;
    const Mat3 tangent = anchor_tangent(anchor(tie), tie.state, tie.end[0].at, tie.end[1].at);
    const Vec3 force = now(tie).force;
    for (int a = 0; a < 2; ++a)
      for (int b = 0; b < 2; ++b) {
        const End &row = tie.end[a], &column = tie.end[b];
        const double sign = a == b ? -1 : 1;
        for (int i = 0; i < groups(row); ++i)
          for (int j = 0; j < groups(column); ++j) {
            Mat6 block = sign * columns(row, i).transpose() * tangent * columns(column, j);
            if (a == b) add_turning(row, i, j, a == 0 ? force : Vec3(-force), block);
            add(row.body, i, column.body, j, block, Mat6::Zero());
          }
      }
  }
}

double BodyTies::greatest_stiffness() const {
  double sum = 0;
  for (const Tie& tie : ties_)
    if (tie.state.hold == AnchorHold::in_place) sum += anchor(tie).stiffness;
  return sum;
}

double BodyTies::first_substep() const {
  double least = std::numeric_limits<double>::infinity();
  for (const Tie& tie : ties_) {
    if (tie.state.hold != AnchorHold::in_place) continue;
    const double mass = std::min(tie.end[0].mass, tie.end[1].mass) / 2;  // of the two together, or less
    least = std::min(least, k_resolved_bounce * std::sqrt(mass / anchor(tie).stiffness));
  }
  return least;
}

}  // namespace topple
