#include "solver/beam_pack.h"

#include <new>

#include "solver/plasticity.h"

namespace topple {
namespace {

[[gnu::always_inline]] inline PackEnds<Four> ends_of(std::span<const Vec3> position,
                                                     std::span<const Quat> rotation,
                                                     const std::array<int, 4>& i,
                                                     const std::array<int, 4>& j) {
  return {gather(position.data(), i), gather(position.data(), j), gather(rotation.data(), i),
          gather(rotation.data(), j)};
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

void BeamPacks::subtract_gradient(std::span<const ElementState> elements, std::span<const Vec3> position,
                                  std::span<const Quat> rotation, std::span<NodeForce> forces) {
  // in two passes: the way through one pack is long, and the processor looks no further than one ahead;
  // strains are made in place, not copied there
  for (std::size_t n = 0; n < packs_.size(); ++n)
    new (&strains_[n])
        PackStrain<Four>(pack_strain(packs_[n].beam, ends_of(position, rotation, packs_[n].i, packs_[n].j)));
  Four total(0);
  for (std::size_t n = 0; n < packs_.size(); ++n) {
    Pack& pack = packs_[n];
    const PackStrain<Four>& strain = strains_[n];
    PackSection<Four> section = elastic_section(pack.beam, strain);
    if (pack.hinged) respond_to(elements, n, strain, section);
    total = total + pack_energy(pack.beam, strain, section);
    subtract(pack_gradient(pack.beam, strain, section), pack.i, pack.j, forces);
    pack.section = section;
  }
  latest_energy_ = sum(total);
}

void BeamPacks::subtract_gradient(std::span<const ElementState> elements, std::span<const Vec3> position,
                                  std::span<const Quat> rotation, std::span<NodeForce> forces, BlockLu& lu) {
  for (std::size_t n = 0; n < packs_.size(); ++n) {
    const Pack& pack = packs_[n];
    const PackStrain<Four> strain = pack_strain(pack.beam, ends_of(position, rotation, pack.i, pack.j));
    PackSection<Four> section = elastic_section(pack.beam, strain);
    if (pack.hinged) respond_to(elements, n, strain, section);
    const PackGradient<Four> gradient = pack_gradient(pack.beam, strain, section);
    subtract(gradient, pack.i, pack.j, forces);
    if (pack.hinged) {
      add_hinged_tangent(elements, position, rotation, n, lu);
      continue;
    }
    const PackAngleSlope<Four> slope = any_above(strain.angle.x, k_small_angle)
                                           ? any_angle_slope(strain.angle.x, pack.beam.t)
                                           : small_angle_slope(strain.angle.x, pack.beam.t);
    const PackTangent<Four> t = pack_tangent(pack.beam, strain, section, gradient, slope);
    lu.add(pack.block[0], t.force_x2, -t.force_spin1, -t.moment1_x2, t.moment1_spin1);
    lu.add(pack.block[1], -t.force_x2, -t.force_spin2, t.moment1_x2, t.moment1_spin2);
    lu.add(pack.block[2], -t.force_x2, t.force_spin1, -t.moment2_x2, t.moment2_spin1);
    lu.add(pack.block[3], t.force_x2, t.force_spin2, t.moment2_x2, t.moment2_spin2);
  }
}

void BeamPacks::add_hinged_tangent(std::span<const ElementState> elements, std::span<const Vec3> position,
                                   std::span<const Quat> rotation, std::size_t n, BlockLu& lu) const {
  const Pack& pack = packs_[n];
  for (int k = 0; k < 4 && pack.element[k] >= 0; ++k) {
    const Element& element = model_->elements[pack.element[k]];
    const int i = pack.i[k], j = pack.j[k];
    BeamGradient gradient;
    Mat12 tangent;
    beam_tangent(element, elements[4 * n + k],
                 beam_ends(element, position[i], rotation[i], position[j], rotation[j]), gradient, tangent);
    lu.add(i, i, tangent.block<6, 6>(0, 0));
    lu.add(i, j, tangent.block<6, 6>(0, 6));
    lu.add(j, i, tangent.block<6, 6>(6, 0));
    lu.add(j, j, tangent.block<6, 6>(6, 6));
  }
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
