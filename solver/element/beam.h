// The two-node linear Timoshenko element with one integration point, geometrically exact: one element, by the
// formulas of beam_kernel.h.
#pragma once

#include "solver/element/beam_kernel.h"
#include "solver/element/element_state.h"
#include "solver/math/types.h"
#include "solver/model/model.h"

namespace topple {

/// Positions, m, and rotations of an element's two nodes.
using BeamEnds = PackEnds<double>;
BeamEnds beam_ends(const Vec3& x1, const Quat& q1, const Vec3& x2, const Quat& q2);

/// Constants of one element, without offset, for the functions of beam_kernel.h.
PackBeam<double> pack_beam(const Element& element);

/// Gamma = Rs^T (x2-x1)/L - e1, K = psi/L, with psi = log(R1^T R2), |psi| < pi, and Rs = R1 exp(t psi), t =
/// (1+s)/2; R1, R2: rotations of the nodes times the element's reference triad.
BeamStrain beam_strain(const Element& element, const BeamEnds& ends);

/// Strain less the offset of `state`; zero when it is broken.
BeamStrain elastic_strain(const ElementState& state, const BeamStrain& strain);

/// U = L/2 (Gamma.Cn Gamma + K.Cm K) of the elastic strain, J.
double beam_energy(const Element& element, const BeamStrain& elastic);

/// Gradient of U by positions and spatial spins of the two nodes, N and N m, world axes: the element acts on
/// them with its opposite. The offset is held, but for the flow of a hinge (plasticity.h).
struct BeamGradient {
  Vec3 force1, moment1, force2, moment2;
};

/// Rows and columns: x1, spin1, x2, spin2.
using Mat12 = Eigen::Matrix<double, 12, 12, Eigen::RowMajor>;
/// The gradient and its derivative, which is not symmetric away from equilibrium; both zero when broken.
void beam_tangent(const Element& element, const ElementState& state, const BeamEnds& ends,
                  BeamGradient& gradient, Mat12& tangent);
/// The elastic tangent in the reference pose, where it is symmetric.
Mat12 beam_stiffness(const Model& model, const Element& element);

}  // namespace topple
