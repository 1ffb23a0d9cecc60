// The two-node linear Timoshenko element with one integration point, geometrically exact.
#pragma once

#include "solver/element/element_state.h"
#include "solver/math/types.h"
#include "solver/model/model.h"

namespace topple {

/// Where an element is. Rotations take the element's reference triad to its ends' current axes.
struct BeamEnds {
  Vec3 x1, x2;  ///< m
  Mat3 r1, r2;  ///< node rotation times reference triad
  Vec3 psi;     ///< log(r1^T r2), |psi| < pi
};

BeamEnds beam_ends(const Element& element, const Vec3& x1, const Quat& q1, const Vec3& x2, const Quat& q2);

/// Gamma = Rs^T (x2-x1)/L - e1, K = psi/L, with Rs = r1 exp(t psi), t = (1+s)/2.
BeamStrain beam_strain(const Element& element, double s, const BeamEnds& ends);

/// Strain less the offset of `state`; zero when it is broken.
BeamStrain elastic_strain(const ElementState& state, const BeamStrain& strain);

/// U = L/2 (Gamma.Cn Gamma + K.Cm K) of the elastic strain, J.
double beam_energy(const Element& element, const BeamStrain& elastic);

/// Gradient of U, with the offset held or, at a hinge, taken along by the flow (plasticity.h): force and
/// moment at the first and second node, world axes; moments are conjugate to spatial spins.
struct BeamGradient {
  Vec3 force1, moment1, force2, moment2;
};

/// The gradient, and its derivative by (x1, spin1, x2, spin2), 12 x 12, row-major; not symmetric away from
/// equilibrium.
using Mat12 = Eigen::Matrix<double, 12, 12, Eigen::RowMajor>;
void beam_tangent(const Element& element, const ElementState& state, const BeamEnds& ends,
                  BeamGradient& gradient, Mat12& tangent);

}  // namespace topple
