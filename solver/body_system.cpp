#include "solver/body_system.h"

#include <algorithm>
#include <cmath>

#include "solver/beam.h"
#include "solver/excitation.h"

namespace topple {
namespace {

std::vector<std::pair<int, int>> couplings(const Model& model, const Body& body) {
  std::vector<std::pair<int, int>> edges;
  for (int e = body.first_element; e < body.first_element + body.element_count; ++e)
    edges.emplace_back(model.elements[e].node[0] - body.first_node,
                       model.elements[e].node[1] - body.first_node);
  return edges;
}

}  // namespace

double load_factor(const Load& load, double t) {
  const auto& h = load.history;
  if (h.empty()) return 1;
  if (t <= h.front().first) return h.front().second;
  for (std::size_t i = 1; i < h.size(); ++i)
    if (t < h[i].first)
      return h[i - 1].second +
             (h[i].second - h[i - 1].second) * (t - h[i - 1].first) / (h[i].first - h[i - 1].first);
  return h.back().second;
}

void BodyMotion::resize(int nodes) {
  position.resize(nodes);
  velocity.resize(nodes);
  rotation.resize(nodes);
  angular_velocity.resize(nodes);
}

BodySystem::BodySystem(const Model& whole, int body)
    : model(whole),
      index(body),
      first(whole.bodies[body].first_node),
      count(whole.bodies[body].node_count),
      size(0),
      contact_mass(whole.bodies[body].mass / std::max(1, whole.bodies[body].contact_point_count)),
      fixed(count, 0u),
      force(count),
      moment(count),
      lu(count, couplings(whole, whole.bodies[body])),
      yields(false) {
  for (int i = 0; i < count; ++i)
    size = std::max(size, (model.node_position[first + i] - model.bodies[body].centre_of_gravity).norm());
  for (const Support& support : model.supports)
    if (model.node_body[support.node] == body) fixed[support.node - first] |= support.fixed;
  for (const Load& load : model.loads)
    if (model.node_body[load.node] == body) loads_.push_back(&load);
  const Body& own = model.bodies[body];
  for (int k = 0; k < own.element_count; ++k) {
    const Element& element = model.elements[own.first_element + k];
    elements.emplace_back();
    yields = yields || std::isfinite(element.capacity[0]);
  }
  if (yields) {
    joints.resize(count);
    for (int k = 0; k < own.element_count; ++k)
      for (int end = 0; end < 2; ++end)
        joints[model.elements[own.first_element + k].node[end] - first].emplace_back(k, end);
  }
  pairs.reserve(static_cast<std::size_t>(model.bodies[body].contact_point_count) * model.planes.size());
}

void BodySystem::add_applied(const Parameters& parameters, double t) {
  const Vec3 field = parameters.gravity - floor_acceleration(parameters.shakes, t);
  for (int i = 0; i < count; ++i) {
    force[i] = model.node_mass[first + i] * field;
    moment[i].setZero();
  }
  for (const Load* load : loads_) {
    const double factor = loads_grow && load->history.empty() ? t : load_factor(*load, t);
    force[load->node - first] += factor * load->force;
    moment[load->node - first] += factor * load->moment;
  }
}

void BodySystem::find_contacts(const ContactLaw& law, const BodyMotion& motion,
                               std::span<const Vec3> stick_start, std::span<const Vec3> start,
                               std::vector<TouchingPair>& found) const {
  found.clear();
  const Body& body = model.bodies[index];
  const int planes = static_cast<int>(model.planes.size());
  for (int p = body.first_contact_point; p < body.first_contact_point + body.contact_point_count; ++p) {
    const ContactPoint& point = model.contact_points[p];
    const int i = point.node - first;
    for (int k = 0; k < planes; ++k) {
      const Plane& plane = model.planes[k];
      const double width = plane.width > 0 ? plane.width : point.width;
      const double L = (point.width + width) / 2;
      const double l = plane.normal.dot(motion.position[i] - plane.point) + width / 2;
      const double depth = 1 - l / L;
      if (!(depth > 0)) continue;
      const Vec3 stick =
          stick_start[static_cast<std::size_t>(p) * planes + k] + motion.position[i] - start[i];
      const ContactInput input{plane.normal, depth, L, motion.velocity[i], stick, contact_mass};
      found.push_back({p, k, depth, L, contact_force(law, input)});
    }
  }
}

template <bool with_tangent>
void BodySystem::add_contacts(const ContactLaw& law, const BodyMotion& motion,
                              std::span<const Vec3> stick_start, std::span<const Vec3> start,
                              double velocity_factor) {
  find_contacts(law, motion, stick_start, start, pairs);
  const int planes = static_cast<int>(model.planes.size());
  for (const TouchingPair& pair : pairs) {
    const int i = model.contact_points[pair.point].node - first;
    force[i] += pair.out.force;
    if constexpr (with_tangent) {
      const Vec3 stick = stick_start[static_cast<std::size_t>(pair.point) * planes + pair.plane] +
                         motion.position[i] - start[i];
      const ContactInput input{
          model.planes[pair.plane].normal, pair.depth, pair.L, motion.velocity[i], stick, contact_mass};
      Mat3 by_position, by_velocity;
      contact_force(law, input, by_position, by_velocity);
      Mat6 block = Mat6::Zero();
      block.topLeftCorner<3, 3>() = -by_position - velocity_factor * by_velocity;
      lu.add(i, i, block);
    }
  }
}

void BodySystem::evaluate(const Parameters& parameters, double t, const BodyMotion& motion,
                          std::span<const Vec3> stick_start, std::span<const Vec3> start) {
  add_applied(parameters, t);
  const Body& body = model.bodies[index];
  for (int e = body.first_element; e < body.first_element + body.element_count; ++e) {
    const Element& element = model.elements[e];
    const int i = element.node[0] - first, j = element.node[1] - first;
    const BeamGradient g = beam_gradient(
        element, elements[e - body.first_element],
        beam_ends(element, motion.position[i], motion.rotation[i], motion.position[j], motion.rotation[j]));
    force[i] -= g.force1;
    moment[i] -= g.moment1;
    force[j] -= g.force2;
    moment[j] -= g.moment2;
  }
  add_contacts<false>(contact_law(parameters, t), motion, stick_start, start, 0);
}

void BodySystem::evaluate_with_tangent(const Parameters& parameters, double t, const BodyMotion& motion,
                                       std::span<const Vec3> stick_start, std::span<const Vec3> start,
                                       double velocity_factor) {
  add_applied(parameters, t);
  const Body& body = model.bodies[index];
  Mat12 tangent;
  BeamGradient g;
  for (int e = body.first_element; e < body.first_element + body.element_count; ++e) {
    const Element& element = model.elements[e];
    const int i = element.node[0] - first, j = element.node[1] - first;
    beam_tangent(
        element, elements[e - body.first_element],
        beam_ends(element, motion.position[i], motion.rotation[i], motion.position[j], motion.rotation[j]), g,
        tangent);
    force[i] -= g.force1;
    moment[i] -= g.moment1;
    force[j] -= g.force2;
    moment[j] -= g.moment2;
    lu.add(i, i, tangent.block<6, 6>(0, 0));
    lu.add(i, j, tangent.block<6, 6>(0, 6));
    lu.add(j, i, tangent.block<6, 6>(6, 0));
    lu.add(j, j, tangent.block<6, 6>(6, 6));
  }
  add_contacts<true>(contact_law(parameters, t), motion, stick_start, start, velocity_factor);
}

BodyEnergy BodySystem::energy(const ContactLaw& law, const BodyMotion& motion,
                              const std::vector<TouchingPair>& contacts,
                              std::vector<SectionForces>& sections) const {
  BodyEnergy sum;
  sum.kinetic = kinetic_energy(motion);
  const Body& body = model.bodies[index];
  for (int e = body.first_element; e < body.first_element + body.element_count; ++e) {
    const Element& element = model.elements[e];
    const int i = element.node[0] - first, j = element.node[1] - first;
    const BeamEnds ends =
        beam_ends(element, motion.position[i], motion.rotation[i], motion.position[j], motion.rotation[j]);
    const ElementState& now = elements[e - body.first_element];
    const BeamStrain elastic = elastic_strain(now, beam_strain(element, element.s, ends));
    sections[e] = section_forces(element, elastic);
    sum.strain += beam_energy(element, elastic);
  }
  for (const TouchingPair& pair : contacts) {
    // the printed law has no spring: what it takes in is dissipated
    if (law.kind != ContactLawKind::printed) sum.contact += penalty_energy(law, pair.depth, pair.L);
    sum.contact += pair.out.stick_energy;
  }
  return sum;
}

double BodySystem::kinetic_energy(const BodyMotion& motion) const {
  double sum = 0;
  for (int i = 0; i < count; ++i) {
    const Vec3& w = motion.angular_velocity[i];
    sum += 0.5 * model.node_mass[first + i] * motion.velocity[i].squaredNorm() +
           0.5 * w.dot(model.node_inertia[first + i] * w);
  }
  return sum;
}

void BodySystem::load(const State& state, BodyMotion& motion) const {
  motion.resize(count);
  std::copy_n(state.position.begin() + first, count, motion.position.begin());
  std::copy_n(state.velocity.begin() + first, count, motion.velocity.begin());
  std::copy_n(state.rotation.begin() + first, count, motion.rotation.begin());
  std::copy_n(state.angular_velocity.begin() + first, count, motion.angular_velocity.begin());
}

void BodySystem::load_elements(const State& state) {
  std::copy_n(state.elements.begin() + model.bodies[index].first_element, elements.size(), elements.begin());
}

void BodySystem::store_stick(const std::vector<TouchingPair>& contacts, std::vector<Vec3>& stick) const {
  const Body& body = model.bodies[index];
  const std::size_t planes = model.planes.size();
  std::fill_n(stick.begin() + body.first_contact_point * planes, body.contact_point_count * planes,
              Vec3::Zero());
  for (const TouchingPair& pair : contacts) stick[pair.point * planes + pair.plane] = pair.out.stick;
}

int BodySystem::element_at(int node) const {
  const Body& body = model.bodies[index];
  for (int e = body.first_element; e < body.first_element + body.element_count; ++e)
    if (model.elements[e].node[0] == node || model.elements[e].node[1] == node) return e;
  return -1;
}

}  // namespace topple
