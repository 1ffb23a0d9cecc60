#include "solver/element/beam_pack.h"

#include <algorithm>
#include <cmath>
#include <new>

#include "solver/element/beam.h"

namespace topple {
namespace {

[[gnu::always_inline]] inline PackEnds<Four> ends_of(std::span<const Vec3> position,
                                                     std::span<const Quat> rotation,
                                                     const std::array<int, 4>& i,
                                                     const std::array<int, 4>& j) {
  return {gather(position.data(), i), gather(position.data(), j), gather(rotation.data(), i),
          gather(rotation.data(), j)};
}

[[gnu::always_inline]] inline PackEndRates<Four> rates_of(const NodeMotion& motion,
                                                          const PackEnds<Four>& ends,
                                                          const std::array<int, 4>& i,
                                                          const std::array<int, 4>& j) {
  return {gather(motion.velocity.data(), i), gather(motion.velocity.data(), j),
          rotate(ends.q1, gather(motion.angular_velocity.data(), i)),
          rotate(ends.q2, gather(motion.angular_velocity.data(), j))};
}

[[gnu::always_inline]] inline PackSection<Four> sum_of(const PackSection<Four>& a,
                                                       const PackSection<Four>& b) {
  return {a.normal + b.normal, a.moment + b.moment};
}

void set_element(PackBeam<Four>& pack, int k, const PackBeam<double>& one) {
  set_lane(pack.triad.v, k, unpacked(one.triad.v));
  pack.triad.w.set(k, one.triad.w);
  set_lane(pack.triad_matrix, k, unpacked(one.triad_matrix));
  pack.length.set(k, one.length);
  pack.inverse_length.set(k, one.inverse_length);
  pack.t.set(k, one.t);
  set_lane(pack.normal_stiffness, k, unpacked(one.normal_stiffness));
  set_lane(pack.bending_stiffness, k, unpacked(one.bending_stiffness));
  set_lane(pack.offset_gamma, k, unpacked(one.offset_gamma));
  set_lane(pack.offset_kappa, k, unpacked(one.offset_kappa));
}

void set_stiffness(PackBeam<Four>& beam, int k, const Vec3& normal, const Vec3& bending) {
  set_lane(beam.normal_stiffness, k, normal);
  set_lane(beam.bending_stiffness, k, bending);
}

[[gnu::always_inline]] inline void subtract(const PackGradient<Four>& g, const std::array<int, 4>& i,
                                            const std::array<int, 4>& j, std::span<NodeForce> forces) {
  const std::array<Four, 4> force2 = lanes(g.force2), moment1 = lanes(g.moment1), moment2 = lanes(g.moment2);
  for (int k = 0; k < 4; ++k) {
    NodeForce &first = forces[i[k]], &second = forces[j[k]];
    store(first.force, load(first.force) + force2[k]);
    store(first.moment, load(first.moment) - moment1[k]);
    store(second.force, load(second.force) - force2[k]);
    store(second.moment, load(second.moment) - moment2[k]);
  }
}

[[gnu::always_inline]] inline void add(const PackTangent<Four>& t,
                                       const std::array<std::array<int, 4>, 4>& block, BlockLu& lu) {
  lu.add(block[0], t.force_x2, -t.force_spin1, -t.moment1_x2, t.moment1_spin1);
  lu.add(block[1], -t.force_x2, -t.force_spin2, t.moment1_x2, t.moment1_spin2);
  lu.add(block[2], -t.force_x2, t.force_spin1, -t.moment2_x2, t.moment2_spin1);
  lu.add(block[3], t.force_x2, t.force_spin2, t.moment2_x2, t.moment2_spin2);
}

// It has a hinge, had one, or is broken. Were it damped again at each unloading, the viscous stress would
// leap from one step to the next and do work that no motion shows.
bool has_flowed(const ElementState& state) {
  return state.hinge != Hinge::none || !state.offset.gamma.isZero(0) || !state.offset.kappa.isZero(0);
}

}  // namespace

BeamPacks::BeamPacks(const Model& model, std::span<const OwnElement> own, const BlockLu& lu)
    : model_(&model), packs_((own.size() + 3) / 4), strains_(packs_.size()) {
  for (std::size_t n = 0; n < 4 * packs_.size(); ++n) {
    Pack& pack = packs_[n / 4];
    const int k = n % 4;
    const bool real = n < own.size();
    const OwnElement& from = own[real ? n : own.size() - 1];
    const Element& element = model.elements[from.element];
    pack.i[k] = from.i;
    pack.j[k] = from.j;
    pack.block[0][k] = lu.index(from.i, from.i);
    pack.block[1][k] = lu.index(from.i, from.j);
    pack.block[2][k] = lu.index(from.j, from.i);
    pack.block[3][k] = lu.index(from.j, from.j);
    pack.element[k] = real ? from.element : -1;
    pack.yields = (k > 0 && pack.yields) || std::isfinite(element.capacity[0]);
    pack.flowed = false;
    for (int c = 0; c < 4; ++c) pack.inverse_square[c].set(k, real ? std::pow(element.capacity[c], -2) : 0);
    for (int p = 0; p < 2; ++p) pack.arm[p].set(k, element.length / 2 * (element.hinge_place[p] + element.s));
    pack.damping.set(k, 0);
    set_element(pack.beam, k, pack_beam(element));
    if (!real) set_stiffness(pack.beam, k, Vec3::Zero(), Vec3::Zero());
  }
}

void BeamPacks::remember(std::span<const ElementState> elements) {
  for (std::size_t n = 0; n < elements.size(); ++n) {
    Pack& pack = packs_[n / 4];
    const int k = n % 4;
    const ElementState& state = elements[n];
    if (k == 0) pack.flowed = false;
    pack.flowed = pack.flowed || has_flowed(state);
    set_lane(pack.beam.offset_gamma, k, state.offset.gamma);
    set_lane(pack.beam.offset_kappa, k, state.offset.kappa);
    const Element& element = model_->elements[pack.element[k]];
    const bool broken = state.hinge == Hinge::broken;
    set_stiffness(pack.beam, k, broken ? Vec3::Zero() : element.normal_stiffness,
                  broken ? Vec3::Zero() : element.bending_stiffness);
  }
}

bool BeamPacks::respond_to(std::span<const ElementState> elements, std::size_t n,
                           const PackStrain<Four>& strain, PackSection<Four>& section,
                           Responses& responses) const {
  const Pack& pack = packs_[n];
  if (!pack.yields) return false;
  const auto& [normal, twist, bending_y, bending_z] = pack.inverse_square;
  const PackVector<Four>&g = section.normal, &m = section.moment;
  const Four straight = normal * g.x * g.x + twist * m.x * m.x;
  const auto beyond = [&, &bending_y = bending_y, &bending_z = bending_z](Four arm) {
    const Four my = m.y + arm * g.z, mz = m.z - arm * g.y;
    return any_above(straight + bending_y * my * my + bending_z * mz * mz, 1 + k_on_surface);
  };
  if (!beyond(pack.arm[0]) && !beyond(pack.arm[1])) return false;
  for (int k = 0; k < 4 && pack.element[k] >= 0; ++k) {
    responses[k] = respond(model_->elements[pack.element[k]], elements[4 * n + k],
                           {lane(strain.gamma, k), lane(strain.kappa, k)});
    set_lane(section.normal, k, responses[k].forces.normal);
    set_lane(section.moment, k, responses[k].forces.moment);
  }
  return true;
}

void BeamPacks::damp(std::size_t first, std::size_t last, double time) {
  for (std::size_t n = first; n < last; ++n) packs_[n / 4].damping.set(n % 4, time);
  damped_ =
      std::any_of(packs_.begin(), packs_.end(), [](const Pack& pack) { return any_above(pack.damping, 0); });
}

// None where there is a hinge or was one.
Four BeamPacks::damping(std::span<const ElementState> elements, std::size_t n) const {
  Four time = packs_[n].damping;
  for (int k = 0; packs_[n].flowed && k < 4 && packs_[n].element[k] >= 0; ++k)
    if (has_flowed(elements[4 * n + k])) time.set(k, 0);
  return time;
}

void BeamPacks::subtract_gradient(std::span<const ElementState> elements, const NodeMotion& motion,
                                  std::span<NodeForce> forces) {
  // in two passes: the way through one pack is long, and the processor looks no further than one ahead;
  // strains are made in place, not copied there
  for (std::size_t n = 0; n < packs_.size(); ++n)
    new (&strains_[n]) PackStrain<Four>(
        pack_strain(packs_[n].beam, ends_of(motion.position, motion.rotation, packs_[n].i, packs_[n].j)));
  Four total(0);
  Responses responses;
  tears_ = false;
  for (std::size_t n = 0; n < packs_.size(); ++n) {
    Pack& pack = packs_[n];
    const PackStrain<Four>& strain = strains_[n];
    tears_ |= any_above(strain.angle.x, k_torn * k_torn);
    PackSection<Four> section = elastic_section(pack.beam, strain);
    respond_to(elements, n, strain, section, responses);
    total = total + pack_energy(pack.beam, strain, section);
    pack.section = section;
    if (damped_) section = sum_of(section, viscous(elements, motion, n, strain));
    subtract(pack_gradient(pack.beam, strain, section), pack.i, pack.j, forces);
  }
  latest_energy_ = sum(total);
}

PackSection<Four> BeamPacks::viscous(std::span<const ElementState> elements, const NodeMotion& motion,
                                     std::size_t n, const PackStrain<Four>& strain) const {
  const Pack& pack = packs_[n];
  const PackEnds<Four> ends = ends_of(motion.position, motion.rotation, pack.i, pack.j);
  return viscous_section(pack.beam, strain, rates_of(motion, ends, pack.i, pack.j), damping(elements, n));
}

void BeamPacks::subtract_gradient(std::span<const ElementState> elements, const NodeMotion& motion,
                                  double velocity_factor, std::span<NodeForce> forces, BlockLu& lu) {
  Responses responses;
  tears_ = false;
  for (std::size_t n = 0; n < packs_.size(); ++n) {
    const Pack& pack = packs_[n];
    const PackStrain<Four> strain =
        pack_strain(pack.beam, ends_of(motion.position, motion.rotation, pack.i, pack.j));
    tears_ |= any_above(strain.angle.x, k_torn * k_torn);
    PackSection<Four> section = elastic_section(pack.beam, strain);
    const bool flows = respond_to(elements, n, strain, section, responses);
    PackStiffness<Four> stiffness{pack.beam.normal_stiffness, pack.beam.bending_stiffness};
    if (damped_) {
      section = sum_of(section, viscous(elements, motion, n, strain));
      const Four stiffer = Four(1) + Four(velocity_factor) * damping(elements, n);
      stiffness = {stiffer * stiffness.normal_gamma, stiffer * stiffness.moment_kappa};
    }
    const PackGradient<Four> gradient = pack_gradient(pack.beam, strain, section);
    subtract(gradient, pack.i, pack.j, forces);
    const PackAngleSlope<Four> slope = angle_slopes(strain.angle.x, pack.beam.t);
    add(flows ? pack_tangent(pack.beam, strain, section, gradient, slope,
                             flowing_stiffness(n, responses, stiffness))
              : pack_tangent(pack.beam, strain, section, gradient, slope, stiffness),
        pack.block, lu);
  }
}

PackFlowing<Four> BeamPacks::flowing_stiffness(std::size_t n, const Responses& responses,
                                               const PackStiffness<Four>& elastic) const {
  const Pack& pack = packs_[n];
  PackFlowing<Four> all{diagonal(elastic.normal_gamma), in_all_lanes(packed(Mat3(Mat3::Zero()))),
                        diagonal(elastic.moment_kappa)};
  // what damping adds: it does not know of the flow within a step
  const PackVector<Four> viscous_normal = elastic.normal_gamma - pack.beam.normal_stiffness,
                         viscous_moment = elastic.moment_kappa - pack.beam.bending_stiffness;
  for (int k = 0; k < 4 && pack.element[k] >= 0; ++k) {
    if (!responses[k].flows()) continue;
    const SectionTangent one = section_tangent(model_->elements[pack.element[k]], responses[k]);
    set_lane(all.normal_gamma, k, one.normal_gamma + Mat3(lane(viscous_normal, k).asDiagonal()));
    set_lane(all.normal_kappa, k, one.normal_kappa);
    set_lane(all.moment_kappa, k, one.moment_kappa + Mat3(lane(viscous_moment, k).asDiagonal()));
  }
  return all;
}

double BeamPacks::viscous_work(std::span<const ElementState> elements, const NodeMotion& start,
                               const NodeMotion& end) const {
  if (!damped_) return 0;
  Four total(0);
  for (std::size_t n = 0; n < packs_.size(); ++n) {
    const Pack& pack = packs_[n];
    const auto strain_at = [&](const NodeMotion& motion) {
      return pack_strain(pack.beam, ends_of(motion.position, motion.rotation, pack.i, pack.j));
    };
    const PackStrain<Four> strain0 = strain_at(start), strain1 = strain_at(end);
    const PackSection<Four> both =
        sum_of(viscous(elements, start, n, strain0), viscous(elements, end, n, strain1));
    total = total + Four(0.5) * pack.beam.length *
                        (dot(both.normal, strain1.gamma - strain0.gamma) +
                         dot(both.moment, strain1.kappa - strain0.kappa));
  }
  return sum(total);
}

double BeamPacks::latest_energy(std::vector<SectionForces>& sections) const {
  for (const Pack& pack : packs_) store_sections(pack, pack.section, sections);
  return latest_energy_;
}

void BeamPacks::store_sections(const Pack& pack, const PackSection<Four>& section,
                               std::vector<SectionForces>& sections) {
  const std::array<Four, 4> normal = lanes(section.normal), moment = lanes(section.moment);
  for (int k = 0; k < 4 && pack.element[k] >= 0; ++k) {
    SectionForces& out = sections[pack.element[k]];
    store_three(out.normal.data(), normal[k]);
    store_three(out.moment.data(), moment[k]);
  }
}

double BeamPacks::energy(std::span<const Vec3> position, std::span<const Quat> rotation,
                         std::vector<SectionForces>& sections) const {
  Four total(0);
  for (const Pack& pack : packs_) {
    const PackStrain<Four> strain = pack_strain(pack.beam, ends_of(position, rotation, pack.i, pack.j));
    const PackSection<Four> section = elastic_section(pack.beam, strain);
    total = total + pack_energy(pack.beam, strain, section);
    store_sections(pack, section, sections);
  }
  return sum(total);
}

}  // namespace topple
