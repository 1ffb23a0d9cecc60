#include "solver/body/candidates.h"

#include <algorithm>
#include <utility>

#include "solver/body/model_level.h"
#include "solver/math/ranges.h"

namespace topple {
namespace {

constexpr double k_margin = 0.05;  // m, around surfaces: how far bodies come before they are looked for again

}  // namespace

// All bodies still, where they are at `state`.
void Approach::start(const Model& model, const State& state) {
  const int count = static_cast<int>(model.bodies.size());
  motions_.clear();
  for (int b = 0; b < count; ++b) {
    const Body& body = model.bodies[b];
    Motion& motion = motions_.emplace_back(Motion{
        .rigid = {.centre = state.bodies[b].position, .reach = body.reach}, .half_width = body.width / 2});
    if (state.bodies[b].level != ModelLevel::frame) continue;
    for (int i = body.first_node; i < body.first_node + body.node_count; ++i)
      motion.box.extend(state.position[i]);
    motion.rigid = {.centre = motion.box.center(), .reach = motion.box.sizes().norm() / 2};
  }
  for (int b = static_cast<int>(order_.size()); b < count; ++b) order_.push_back(b);
}

const Eigen::AlignedBox3d& Approach::box(const Model& model, const State& state, int body) {
  Eigen::AlignedBox3d& box = motions_[body].box;
  if (!box.isEmpty()) return box;
  const BodyState& s = state.bodies[body];
  const Eigen::AlignedBox3d& own = model.bodies[body].box;
  const Mat3 r = s.rotation.toRotationMatrix();
  const Vec3 middle = s.position + r * own.center(), half = r.cwiseAbs() * own.sizes() / 2;
  return box = {middle - half, middle + half};
}

// Of motions_ from `state`.
double Approach::greatest(const Model& model, const State& state, double margin) {
  for (Motion& motion : motions_) {
    motion.way = motion.rigid.way();
    motion.radius = motion.rigid.reach + motion.half_width + motion.way + motion.more;
  }
  // they are almost in order since the last time
  for (std::size_t k = 1; k < order_.size(); ++k)
    for (std::size_t j = k; j > 0 && motions_[order_[j]].first() < motions_[order_[j - 1]].first(); --j)
      std::swap(order_[j], order_[j - 1]);
  double greatest = 0;
  for (auto one = order_.begin(); one != order_.end(); ++one) {
    const Motion& a = motions_[*one];
    const double last = a.rigid.centre.x() + a.radius + margin;
    for (auto other = one + 1; other != order_.end() && motions_[*other].first() <= last; ++other) {
      const Motion& b = motions_[*other];
      if ((a.rigid.centre - b.rigid.centre).norm() > a.radius + b.radius + margin) continue;
      // cheap bounds first
      const double most = a.way + b.way + a.more + b.more, near = margin + a.half_width + b.half_width;
      if (!(most > greatest)) continue;
      const double apart = box(model, state, *one).exteriorDistance(box(model, state, *other));
      if (apart > near + most) continue;
      const double closer = approach(a.rigid, b.rigid) + a.more + b.more;
      if (closer > greatest && apart <= near + closer) greatest = closer;
    }
  }
  return greatest;
}

double Approach::likely(const Model& model, const State& state, double h) {
  start(model, state);
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    const Body& body = model.bodies[b];
    Motion& motion = motions_[b];
    if (const BodyState& s = state.bodies[b]; s.level != ModelLevel::frame) {
      const Vec3 half_turn = h / 2 * (s.rotation * s.angular_velocity);
      motion.rigid.shift = h * s.velocity;
      motion.rigid.turn = Quat(1, half_turn.x(), half_turn.y(), half_turn.z()).normalized();
      motion.more = h * h / 2 * s.force.norm() / body.mass;
      continue;
    }
    for (int i = body.first_node; i < body.first_node + body.node_count; ++i)
      motion.more =
          std::max(motion.more, h * state.velocity[i].norm() + h * h / 2 * state.acceleration[i].norm());
  }
  return greatest(model, state, state.candidate_margin);
}

double Approach::greatest(const Model& model, const State& from, const State& to, double margin) {
  start(model, from);
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    const Body& body = model.bodies[b];
    Motion& motion = motions_[b];
    const BodyState &s = from.bodies[b], &e = to.bodies[b];
    if (s.level != ModelLevel::frame && e.level != ModelLevel::frame) {
      motion.rigid.shift = e.position - s.position;
      motion.rigid.turn = e.rotation * s.rotation.conjugate();
    } else if (s.level == e.level) {  // where it changes nothing moves far
      for (int i = body.first_node; i < body.first_node + body.node_count; ++i)
        motion.more = std::max(motion.more, (to.position[i] - from.position[i]).norm());
    }
  }
  return greatest(model, from, margin);
}

void update_candidates(const Model& model, NearSearch& search, State& state, double approach) {
  if (model.bodies.size() < 2 || state.candidate_margin > approach) return;
  place_nodes(model, state);
  state.candidate_margin = std::max(k_margin, 2 * approach);
  const std::vector<ElementPair>& found = search.find(state.position, state.candidate_margin);
  if (!ranges::equal(state.candidate_pairs, found)) state.candidate_pairs = found;
}

}  // namespace topple
