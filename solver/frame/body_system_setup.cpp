// What a BodySystem consists of.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/frame/body_system.h"
#include "solver/math/ranges.h"

namespace topple {

BodySystem::BodySystem(const Model& whole, int body) : BodySystem(whole, std::vector<int>{body}, {}) {}

BodySystem::BodySystem(const Model& whole, std::vector<int> which, std::vector<ElementPair> pairs,
                       std::vector<int> rigid_bodies)
    : model(whole),
      bodies(std::move(which)),
      candidate_pairs(std::move(pairs)),
      index(bodies.front()),
      first(whole.bodies[index].first_node),
      count(0),
      size(0),
      mass(0),
      lu(0, {}),
      yields(false),
      beams_(model, {}, lu) {
  add_nodes(rigid_bodies);
  for (const int b : bodies) {
    const Body& body = model.bodies[b];
    mass += body.mass;
    contact_mass_.push_back(body.mass / std::max(1, body.contact_point_count));
  }
  add_elements();
  add_member_pairs();
  std::vector<std::pair<int, int>> couplings;
  for (const OwnElement& own : own_elements) couplings.emplace_back(own.i, own.j);
  for (const MemberPair& pair : member_pairs_)
    for (int i = 0; i < pair.nodes(); ++i)
      for (int j = 0; j < i; ++j)
        if (const int a = moves_with_[pair.node[i]], b = moves_with_[pair.node[j]]; a != b)
          couplings.emplace_back(a, b);
  add_own_anchors();
  for (const OwnAnchor& one : anchors)
    if (one.other.node >= 0) couplings.emplace_back(one.own.node, one.other.node);
  lu = BlockLu(count, couplings);
  add_node_packs();
  add_point_packs();
  beams_ = BeamPacks(model, own_elements, lu);
  node_force_.resize(count);
  add_what_bears_on_nodes();
}

// Of a rigid body the motion is a node of its own, and those of the model are held to it.
void BodySystem::add_nodes(const std::vector<int>& rigid_bodies) {
  for (const int b : bodies) {
    const Body& body = model.bodies[b];
    for (int i = body.first_node; i < body.first_node + body.node_count; ++i) {
      node.push_back(i);
      size = std::max(size, (model.node_position[i] - body.centre_of_gravity).norm());
    }
  }
  const auto add_held = [this](int part) {
    for (const int i : nodes_of(model, part))
      if (local(i) < 0) node.push_back(i);
  };
  for (const ElementPair& pair : candidate_pairs)
    for (const int e : {pair.a, pair.b}) {
      add_held(e);
      if (rigid_bodies.empty() || panel_of(model, e) != nullptr) continue;  // which touch whole members
      const Member& member = model.members[model.elements[e].member];
      add_held(member.first_element);
      add_held(member.first_element + member.element_count - 1);
    }
  count = static_cast<int>(node.size() + rigid_bodies.size());
  fixed.assign(count, 0u);
  for (const Support& support : model.supports)
    if (const int i = local(support.node); i >= 0) fixed[i] |= support.fixed;
  for (int i = 0; i < static_cast<int>(node.size()); ++i) {
    moves_with_.push_back(i);
    node_mass.push_back(model.node_mass[node[i]]);
    node_inertia.push_back(model.node_inertia[node[i]]);
  }
  for (const int b : rigid_bodies) {
    const Body& body = model.bodies[b];
    const RigidInSystem one{b, static_cast<int>(node.size()), local(body.first_node), body.node_count};
    for (int i = one.first; i < one.first + one.count; ++i) {
      moves_with_[i] = one.own;
      node_mass[i] = 0;
      node_inertia[i].setZero();
      fixed[i] = 63u;
    }
    rigid.push_back(one);
    node.push_back(body.first_node);
    moves_with_.push_back(one.own);
    node_mass.push_back(body.mass);
    node_inertia.push_back(body.inertia);
  }
  force.resize(count);
  moment.resize(count);
}

void BodySystem::add_elements() {
  for (const int b : bodies) {
    if (is_rigid(b)) continue;
    const Body& body = model.bodies[b];
    for (int e = body.first_element; e < body.first_element + body.element_count; ++e) {
      const Element& element = model.elements[e];
      own_elements.push_back({e, local(element.node[0]), local(element.node[1])});
      yields = yields || std::isfinite(element.capacity[0]);
    }
  }
  elements.resize(own_elements.size());
  remembers = yields;
}

void BodySystem::add_member_pairs() {
  const auto is_own = [this](int body) { return ranges::find(bodies, body) != bodies.end(); };
  const auto is_frame = [&](int body) { return is_own(body) && !is_rigid(body); };
  member_pairs_ = topple::member_pairs(
      model, candidate_pairs,
      {.by_elements = [&](int body, int other) { return is_frame(is_own(body) ? body : other); },
       .number = [this](int global) { return local(global); },
       .inverse_mass =
           [&](int body) {
             const auto own = ranges::find(bodies, body);
             return own == bodies.end() ? 0 : 1 / contact_mass_[own - bodies.begin()];
           }});
}

void BodySystem::add_node_packs() {
  const auto add = [this](const std::vector<int>& which, bool whole_bodies) {
    const int last = static_cast<int>(which.size()) - 1;
    for (int i = 0; i <= last; i += 4) {
      NodePack pack;
      pack.rigid = whole_bodies;
      for (int k = 0; k < 4; ++k) {
        const bool real = i + k <= last;
        const int own = which[std::min(i + k, last)];
        pack.node[k] = own;
        pack.diagonal[k] = lu.index(own, own);
        pack.real.set(k, real);
        pack.mass.set(k, real ? node_mass[own] : 0);
        pack.inverse_mass.set(k, 1 / node_mass[own]);
        set_lane(pack.inertia, k, real ? node_inertia[own] : Mat3::Zero());
        set_lane(pack.inverse_inertia, k, node_inertia[own].inverse());
      }
      node_packs.push_back(pack);
    }
  };
  std::vector<int> of_frames, of_rigid;
  for (int i = 0; i < count; ++i)
    if (moves_with_[i] == i) (i < count - std::ssize(rigid) ? of_frames : of_rigid).push_back(i);
  add(of_frames, false);
  add(of_rigid, true);
}

void BodySystem::add_point_packs() {
  int before = 0;
  for (int b = 0; b < static_cast<int>(bodies.size()); ++b) {
    const Body& body = model.bodies[bodies[b]];
    const int end = body.first_contact_point + body.contact_point_count;
    for (int p = body.first_contact_point; p < end; p += 4) {
      PointPack pack{{}, p, std::min(4, end - p), b, static_cast<int>(reaches_.size())};
      for (int k = 0; k < 4; ++k)
        pack.node[k] = before + model.contact_points[std::min(p + k, end - 1)].node - body.first_node;
      for (const Plane& plane : model.planes) {
        PlaneReach reach;
        for (int k = 0; k < 4; ++k) {
          const ContactPoint& point = model.contact_points[std::min(p + k, end - 1)];
          const double L = contact_length(point, plane);
          reach.place.set(k, plane.normal.dot(plane.point) + L - contact_width(point, plane) / 2);
          reach.L.set(k, L);
        }
        reaches_.push_back(reach);
      }
      point_packs_.push_back(pack);
    }
    before += body.node_count;
  }
}

void BodySystem::add_what_bears_on_nodes() {
  for (const Load& load : model.loads)
    if (ranges::find(bodies, model.node_body[load.node]) != bodies.end())
      loads.push_back({&load, local(load.node)});
}

// Those with an end on a body of the system; that is the first one.
void BodySystem::add_own_anchors() {
  for (int k = 0; k < static_cast<int>(model.anchors.size()); ++k) {
    const Anchor& anchor = model.anchors[k];
    OwnAnchor one{k, end_of_anchor(anchor.own()), end_of_anchor(anchor.other), {}};
    if (one.own.node < 0) std::swap(one.own, one.other);
    if (one.own.node >= 0) anchors.push_back(one);
  }
}

BodySystem::EndOfAnchor BodySystem::end_of_anchor(const AnchorEnd& end) const {
  if (ranges::find(bodies, end.body) == bodies.end()) return {};
  const int node_of = local(end.node), own = moves_with_[node_of];
  if (own == node_of) return {own, end.arm};
  return {own, end.arm + model.node_position[end.node] - model.bodies[end.body].centre_of_gravity};
}

}  // namespace topple
