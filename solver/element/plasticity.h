// Plastic flow of a whole section under axial force, torsion and bending.
#pragma once

#include "solver/element/element_state.h"
#include "solver/model/model.h"

namespace topple {

/// Axial force N, torsion Mx and bending My, Mz (N and N m), or a number for each of them.
using Vec4 = Eigen::Vector4d;
using Mat4 = Eigen::Matrix4d;

/// f = (N/N0)^2 + (Mx/Mx0)^2 + (My/My0)^2 + (Mz/Mz0)^2 - 1; -1 for an elastic section (infinite capacity).
/// sqrt(f + 1), the yield ratio: forces over those at which a proportional loading reaches the yield surface.
double yield_function(const Vec4& forces, const Vec4& capacity);
double yield_function(const Element& element, const SectionForces& forces);

/// Closest point of the yield surface f = 0, measured by the elastic energy, for a trial state outside:
///   g_i = g_tr,i / (1 + 2 lambda D_i / g0_i^2),  D: stiffness, g0: capacity,
/// and lambda, which makes the plastic strain lambda df/dg. Newton on F^(-1/2) = 1 with F = f + 1, which is
/// concave in lambda and linear for one component: monotonic from lambda = 0. A trial state inside or on the
/// surface stays.
struct PlasticReturn {
  Vec4 forces;
  double multiplier = 0;  ///< lambda >= 0
};
PlasticReturn return_to_yield(const Vec4& trial, const Vec4& stiffness, const Vec4& capacity);

/// Consistent tangent of the return, d forces / d strain, for multiplier > 0. Symmetric.
///   X - X n n^T X / (n^T X n),  X = diag(D_i / (1 + 2 lambda D_i / g0_i^2)),  n = df/dg
Mat4 plastic_tangent(const PlasticReturn& point, const Vec4& stiffness, const Vec4& capacity);

/// Shifted integration: elastic strain is integrated at the scheme's s; a hinge flows at its own place xi, an
/// end of the element (midpoint: the middle). Equilibrium along the element gives the forces at xi from those
/// at r = -s; its transpose brings the flow back, so that the element turns about the hinge as about a joint:
///   g_h = T g:             N, Mx, My + a Vz, Mz - a Vy                     a = (L/2)(xi + s)
///   stiffness T D T^T:     EA, GJ, EIy + a^2 kGAz, EIz + a^2 kGAy, diagonal
///   offset += T^T flow:    gamma_x, gamma_y -= a kappa_z, gamma_z += a kappa_y; kappa
/// Nothing elastic changes when a hinge forms, moves or goes: no jump of forces, no energy from a shift, and
/// the pair of elements keeps its exact bending beside a hinge.
struct SectionResponse {
  SectionForces forces;  ///< at the elastic stress point
  bool flows = false;
  PlasticReturn point;  ///< at the hinge, when it flows
};
/// Section forces at a strain: elastic without hinge, none when broken, else returned to the yield surface.
SectionResponse respond(const Element& element, const ElementState& state, const BeamStrain& strain);

/// Derivatives of normal by gamma, normal by kappa (its transpose: moment by gamma) and moment by kappa, of a
/// section that flows.
struct SectionTangent {
  Mat3 normal_gamma, normal_kappa, moment_kappa;
};
SectionTangent section_tangent(const Element& element, Hinge hinge, const SectionResponse& response);

/// Adds the flow of `response` to the offset.
void take_flow(const Element& element, const SectionResponse& response, ElementState& state);

/// Place xi of a hinge along the element, -1..1; else that of the elastic stress point, -s.
double hinge_place(const Element& element, Hinge hinge);

}  // namespace topple
