#include "solver/element/beam_pack.h"

#include <algorithm>
#include <new>

#include "solver/element/plasticity.h"

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
    pack.hinged = false;
    pack.damping.set(k, 0);
    PackBeam<Four>& beam = pack.beam;
    const Quat triad(element.triad);
    set_lane(beam.triad.v, k, triad.vec());
    beam.triad.w.set(k, triad.w());
    set_lane(beam.triad_matrix, k, element.triad);
    beam.length.set(k, element.length);
    beam.inverse_length.set(k, 1 / element.length);
    beam.t.set(k, (1 + element.s) / 2);
    set_stiffness(beam, k, real ? element.normal_stiffness : Vec3::Zero(),
                  real ? element.bending_stiffness : Vec3::Zero());
    set_lane(beam.offset_gamma, k, Vec3::Zero());
    set_lane(beam.offset_kappa, k, Vec3::Zero());
  }
}

void BeamPacks::remember(std::span<const ElementState> elements) {
  for (std::size_t n = 0; n < elements.size(); ++n) {
    Pack& pack = packs_[n / 4];
    const int k = n % 4;
    const ElementState& state = elements[n];
    if (k == 0) pack.hinged = false;
    pack.hinged = pack.hinged || state.hinge != Hinge::none;
    set_lane(pack.beam.offset_gamma, k, state.offset.gamma);
    set_lane(pack.beam.offset_kappa, k, state.offset.kappa);
    const Element& element = model_->elements[pack.element[k]];
    const bool broken = state.hinge == Hinge::broken;
    set_stiffness(pack.beam, k, broken ? Vec3::Zero() : element.normal_stiffness,
                  broken ? Vec3::Zero() : element.bending_stiffness);
  }
}

void BeamPacks::respond_to(std::span<const ElementState> elements, std::size_t n,
                           const PackStrain<Four>& strain, PackSection<Four>& section) const {
  const Pack& pack = packs_[n];
  for (int k = 0; k < 4 && pack.element[k] >= 0; ++k) {
    const SectionForces forces = respond(model_->elements[pack.element[k]], elements[4 * n + k],
                                         {lane(strain.gamma, k), lane(strain.kappa, k)})
                                     .forces;
    set_lane(section.normal, k, forces.normal);
    set_lane(section.moment, k, forces.moment);
  }
}

void BeamPacks::damp(std::size_t first, std::size_t last, double time) {
  for (std::size_t n = first; n < last; ++n) packs_[n / 4].damping.set(n % 4, time);
  damped_ =
      std::any_of(packs_.begin(), packs_.end(), [](const Pack& pack) { return any_above(pack.damping, 0); });
}

// None where there is a hinge.
Four BeamPacks::damping(std::span<const ElementState> elements, std::size_t n) const {
  Four time = packs_[n].damping;
  for (int k = 0; packs_[n].hinged && k < 4 && packs_[n].element[k] >= 0; ++k)
    if (elements[4 * n + k].hinge != Hinge::none) time.set(k, 0);
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
  for (std::size_t n = 0; n < packs_.size(); ++n) {
    Pack& pack = packs_[n];
    const PackStrain<Four>& strain = strains_[n];
    PackSection<Four> section = elastic_section(pack.beam, strain);
    if (pack.hinged) respond_to(elements, n, strain, section);
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
  for (std::size_t n = 0; n < packs_.size(); ++n) {
    const Pack& pack = packs_[n];
    const PackStrain<Four> strain =
        pack_strain(pack.beam, ends_of(motion.position, motion.rotation, pack.i, pack.j));
    PackSection<Four> section = elastic_section(pack.beam, strain);
    if (pack.hinged) respond_to(elements, n, strain, section);
    PackBeam<Four> beam = pack.beam;
    if (damped_) {
      section = sum_of(section, viscous(elements, motion, n, strain));
      const Four stiffer = Four(1) + Four(velocity_factor) * pack.damping;
      beam.normal_stiffness = stiffer * beam.normal_stiffness;
      beam.bending_stiffness = stiffer * beam.bending_stiffness;
    }
    const PackGradient<Four> gradient = pack_gradient(beam, strain, section);
    subtract(gradient, pack.i, pack.j, forces);
    if (pack.hinged) {
      add_hinged_tangent(elements, motion, velocity_factor, n, lu);
      continue;
    }
    const PackAngleSlope<Four> slope = any_above(strain.angle.x, k_small_angle)
                                           ? any_angle_slope(strain.angle.x, pack.beam.t)
                                           : small_angle_slope(strain.angle.x, pack.beam.t);
    const PackTangent<Four> t = pack_tangent(beam, strain, section, gradient, slope);
    lu.add(pack.block[0], t.force_x2, -t.force_spin1, -t.moment1_x2, t.moment1_spin1);
    lu.add(pack.block[1], -t.force_x2, -t.force_spin2, t.moment1_x2, t.moment1_spin2);
    lu.add(pack.block[2], -t.force_x2, t.force_spin1, -t.moment2_x2, t.moment2_spin1);
    lu.add(pack.block[3], t.force_x2, t.force_spin2, t.moment2_x2, t.moment2_spin2);
  }
}

void BeamPacks::add_hinged_tangent(std::span<const ElementState> elements, const NodeMotion& motion,
                                   double velocity_factor, std::size_t n, BlockLu& lu) const {
  const Pack& pack = packs_[n];
  for (int k = 0; k < 4 && pack.element[k] >= 0; ++k) {
    Element element = model_->elements[pack.element[k]];
    if (elements[4 * n + k].hinge == Hinge::none) {
      const double stiffer = 1 + velocity_factor * pack.damping[k];
      element.normal_stiffness *= stiffer;
      element.bending_stiffness *= stiffer;
    }
    const int i = pack.i[k], j = pack.j[k];
    BeamGradient gradient;
    Mat12 tangent;
    beam_tangent(
        element, elements[4 * n + k],
        beam_ends(element, motion.position[i], motion.rotation[i], motion.position[j], motion.rotation[j]),
        gradient, tangent);
    lu.add(i, i, tangent.block<6, 6>(0, 0));
    lu.add(i, j, tangent.block<6, 6>(0, 6));
    lu.add(j, i, tangent.block<6, 6>(6, 0));
    lu.add(j, j, tangent.block<6, 6>(6, 6));
  }
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
