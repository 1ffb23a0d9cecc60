#include "solver/element/beam.h"

#include "solver/element/plasticity.h"

namespace topple {
namespace {

BeamStrain strain_of(const PackStrain<double>& strain) {
  return {unpacked(strain.gamma), unpacked(strain.kappa)};
}

Mat12 whole(const PackTangent<double>& t) {
  Mat12 out;
  const auto set = [&](int row, int column, const PackMatrix<double>& block) {
    out.block<3, 3>(3 * row, 3 * column) = unpacked(block);
  };
  const auto set_row = [&](int row, const PackMatrix<double>& x2, const PackMatrix<double>& spin1,
                           const PackMatrix<double>& spin2) {
    set(row, 0, -x2);
    set(row, 1, spin1);
    set(row, 2, x2);
    set(row, 3, spin2);
  };
  set_row(0, -t.force_x2, -t.force_spin1, -t.force_spin2);
  set_row(1, t.moment1_x2, t.moment1_spin1, t.moment1_spin2);
  set_row(2, t.force_x2, t.force_spin1, t.force_spin2);
  set_row(3, t.moment2_x2, t.moment2_spin1, t.moment2_spin2);
  return out;
}

}  // namespace

BeamEnds beam_ends(const Vec3& x1, const Quat& q1, const Vec3& x2, const Quat& q2) {
  return {packed(x1), packed(x2), packed(q1), packed(q2)};
}

PackBeam<double> pack_beam(const Element& element) {
  const PackVector<double> none{0, 0, 0};
  return {packed(Quat(element.triad)),
          packed(element.triad),
          element.length,
          1 / element.length,
          (1 + element.s) / 2,
          packed(element.normal_stiffness),
          packed(element.bending_stiffness),
          none,
          none};
}

BeamStrain beam_strain(const Element& element, const BeamEnds& ends) {
  return strain_of(pack_strain(pack_beam(element), ends));
}

BeamStrain elastic_strain(const ElementState& state, const BeamStrain& strain) {
  if (state.hinge == Hinge::broken) return {Vec3::Zero(), Vec3::Zero()};
  return {strain.gamma - state.offset.gamma, strain.kappa - state.offset.kappa};
}

double beam_energy(const Element& element, const BeamStrain& elastic) {
  return element.length / 2 *
         (elastic.gamma.dot(element.normal_stiffness.cwiseProduct(elastic.gamma)) +
          elastic.kappa.dot(element.bending_stiffness.cwiseProduct(elastic.kappa)));
}

void beam_tangent(const Element& element, const ElementState& state, const BeamEnds& ends,
                  BeamGradient& gradient, Mat12& tangent) {
  if (state.hinge == Hinge::broken) {
    gradient = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
    tangent.setZero();
    return;
  }
  const PackBeam<double> beam = pack_beam(element);
  const PackStrain<double> strain = pack_strain(beam, ends);
  const SectionResponse response = respond(element, state, strain_of(strain));
  const PackSection<double> section{packed(response.forces.normal), packed(response.forces.moment)};
  const PackGradient<double> g = pack_gradient(beam, strain, section);
  gradient = {unpacked(-g.force2), unpacked(g.moment1), unpacked(g.force2), unpacked(g.moment2)};
  const PackAngleSlope<double> slope = angle_slopes(strain.angle.x, beam.t);
  if (response.flows()) {
    const SectionTangent flowing = section_tangent(element, response);
    tangent =
        whole(pack_tangent(beam, strain, section, g, slope,
                           PackFlowing<double>{packed(flowing.normal_gamma), packed(flowing.normal_kappa),
                                               packed(flowing.moment_kappa)}));
  } else {
    tangent = whole(pack_tangent(beam, strain, section, g, slope,
                                 PackStiffness<double>{beam.normal_stiffness, beam.bending_stiffness}));
  }
}

Mat12 beam_stiffness(const Model& model, const Element& element) {
  BeamGradient gradient;
  Mat12 tangent;
  beam_tangent(element, ElementState{},
               beam_ends(model.node_position[element.node[0]], Quat::Identity(),
                         model.node_position[element.node[1]], Quat::Identity()),
               gradient, tangent);
  return tangent;
}

}  // namespace topple
