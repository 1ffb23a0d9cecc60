#include "solver/beam_pack.h"

#include "solver/plasticity.h"

namespace topple {
namespace {

// Of four nodes.
PackVector<Four> gather(const Vec3* x, const std::array<int, 4>& node) {
  const auto two = [x](int a, int b) {
    return _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_loadu_pd(x[a].data())), _mm_loadu_pd(x[b].data()),
                                1);
  };
  const __m256d ac = two(node[0], node[2]), bd = two(node[1], node[3]);
  return {Four::Vector(_mm256_unpacklo_pd(ac, bd)), Four::Vector(_mm256_unpackhi_pd(ac, bd)),
          Four::Vector{x[node[0]].z(), x[node[1]].z(), x[node[2]].z(), x[node[3]].z()}};
}

PackQuaternion<Four> gather(const Quat* q, const std::array<int, 4>& node) {
  PackQuaternion<Four> out{
      {load(q[node[0]].coeffs().data()), load(q[node[1]].coeffs().data()), load(q[node[2]].coeffs().data())},
      load(q[node[3]].coeffs().data())};
  transpose(out.v.x, out.v.y, out.v.z, out.w);
  return out;
}

PackEnds<Four> gather(std::span<const Vec3> position, std::span<const Quat> rotation,
                      const std::array<int, 4>& i, const std::array<int, 4>& j) {
  return {gather(position.data(), i), gather(position.data(), j), gather(rotation.data(), i),
          gather(rotation.data(), j)};
}

// Four vectors, one per lane; the last number of each is 0.
std::array<Four, 4> lanes(const PackVector<Four>& v) {
  std::array<Four, 4> rows{v.x, v.y, v.z, Four(0)};
  transpose(rows[0], rows[1], rows[2], rows[3]);
  return rows;
}

Vec3 lane(const PackVector<Four>& v, int k) {
  return {v.x[k], v.y[k], v.z[k]};
}

void set_lane(PackVector<Four>& v, int k, const Vec3& value) {
  v.x.set(k, value.x());
  v.y.set(k, value.y());
  v.z.set(k, value.z());
}

void set_stiffness(PackBeam<Four>& beam, int k, const Vec3& normal, const Vec3& bending) {
  set_lane(beam.normal_stiffness, k, normal);
  set_lane(beam.bending_stiffness, k, bending);
}

}  // namespace

BeamPacks::BeamPacks(const Model& model, std::span<const OwnElement> own)
    : model_(&model), packs_((own.size() + 3) / 4) {
  for (std::size_t n = 0; n < 4 * packs_.size(); ++n) {
    Pack& pack = packs_[n / 4];
    const int k = n % 4;
    const bool real = n < own.size();
    const OwnElement& from = own[real ? n : own.size() - 1];
    const Element& element = model.elements[from.element];
    pack.i[k] = from.i;
    pack.j[k] = from.j;
    pack.element[k] = real ? from.element : -1;
    pack.hinged = false;
    PackBeam<Four>& beam = pack.beam;
    const Quat triad(element.triad);
    set_lane(beam.triad.v, k, triad.vec());
    beam.triad.w.set(k, triad.w());
    for (int row = 0; row < 3; ++row) set_lane(beam.triad_matrix.row[row], k, element.triad.row(row));
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

void BeamPacks::subtract_gradient(std::span<const ElementState> elements, std::span<const Vec3> position,
                                  std::span<const Quat> rotation, std::span<NodeForce> forces) const {
  for (std::size_t n = 0; n < packs_.size(); ++n) {
    const Pack& pack = packs_[n];
    const PackStrain<Four> strain = pack_strain(pack.beam, gather(position, rotation, pack.i, pack.j));
    PackSection<Four> section = elastic_section(pack.beam, strain);
    if (pack.hinged)
      for (int k = 0; k < 4 && pack.element[k] >= 0; ++k) {
        const SectionForces forces_at = respond(model_->elements[pack.element[k]], elements[4 * n + k],
                                                {lane(strain.gamma, k), lane(strain.kappa, k)})
                                            .forces;
        set_lane(section.normal, k, forces_at.normal);
        set_lane(section.moment, k, forces_at.moment);
      }
    const PackGradient<Four> g = pack_gradient(pack.beam, strain, section);
    const std::array<Four, 4> force2 = lanes(g.force2), moment1 = lanes(g.moment1),
                              moment2 = lanes(g.moment2);
    for (int k = 0; k < 4; ++k) {
      NodeForce &first = forces[pack.i[k]], &second = forces[pack.j[k]];
      store(first.force, load(first.force) + force2[k]);
      store(first.moment, load(first.moment) - moment1[k]);
      store(second.force, load(second.force) - force2[k]);
      store(second.moment, load(second.moment) - moment2[k]);
    }
  }
}

double BeamPacks::energy(std::span<const Vec3> position, std::span<const Quat> rotation,
                         std::vector<SectionForces>& sections) const {
  Four total(0);
  for (const Pack& pack : packs_) {
    const PackStrain<Four> strain = pack_strain(pack.beam, gather(position, rotation, pack.i, pack.j));
    const PackSection<Four> section = elastic_section(pack.beam, strain);
    total = total + pack_energy(pack.beam, strain, section);
    const std::array<Four, 4> normal = lanes(section.normal), moment = lanes(section.moment);
    for (int k = 0; k < 4 && pack.element[k] >= 0; ++k) {
      SectionForces& out = sections[pack.element[k]];
      store(out.normal.data(), normal[k]);
      out.moment = {moment[k][0], moment[k][1], moment[k][2]};
    }
  }
  return sum(total);
}

}  // namespace topple
