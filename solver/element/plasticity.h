// Plastic flow of whole sections under axial force, torsion and bending.
#pragma once

#include <array>

#include "solver/element/element_state.h"
#include "solver/model/model.h"

namespace topple {

/// f = (N/N0)^2 + (Mx/Mx0)^2 + (My/My0)^2 + (Mz/Mz0)^2 - 1 of a section; -1 for an elastic one (infinite
/// capacity). sqrt(f + 1), the yield ratio: forces over those at which a proportional loading reaches the
/// yield surface.
double yield_function(const Element& element, const SectionForces& forces);

/// Below this f a section is elastic: a state that a step before left on the surface starts the next one so,
/// or Newton's first correction would be that of a mechanism.
inline constexpr double k_on_surface = 1e-10;

/// Shifted integration: elastic strain is integrated at the scheme's s; an element flows at its hinge places
/// xi_k, its ends (midpoint: the middle). With T_k, equilibrium along it,
///   g_k = T_k g:           N, Mx, My + a_k Vz, Mz - a_k Vy                  a_k = (L/2)(xi_k + s)
/// the section forces g at r = -s for a strain are those that minimise the complementary energy of their
/// difference from the elastic ones under f(T_k g) <= 0 for each k:
///   g = D (strain - offset) - D sum_k lambda_k n_k,   n_k = d f(T_k g)/d g,
///   lambda_k >= 0,  f_k <= 0,  lambda_k f_k = 0
/// and lambda_k n_k is the flow, which turns the element about xi_k as about a joint. The problem is convex:
/// g is unique, any number of surfaces begins and stops to flow within a step, and what is elastic stays
/// where it is integrated, so that the pair of elements keeps its exact bending beside a hinge.
struct SectionResponse {
  SectionForces forces;                         ///< at the elastic stress point
  std::array<double, 2> multiplier = {0., 0.};  ///< lambda_k
  bool flows() const { return multiplier[0] > 0 || multiplier[1] > 0; }
};
/// None when broken. lambda is found by Newton's method on the dual, which is concave, from lambda = 0.
SectionResponse respond(const Element& element, const ElementState& state, const BeamStrain& strain);

/// Derivatives of normal by gamma, normal by kappa (its transpose: moment by gamma) and moment by kappa, of a
/// section that flows:  X - X N (N^T X N)^-1 N^T X,  X = (D^-1 + sum_k lambda_k d n_k/d g)^-1,
/// N: n_k with lambda_k > 0.
struct SectionTangent {
  Mat3 normal_gamma, normal_kappa, moment_kappa;
};
SectionTangent section_tangent(const Element& element, const SectionResponse& response);

/// Adds the flow of `response` to the offset.
void take_flow(const Element& element, const SectionResponse& response, ElementState& state);

/// Bending, 1/m times the element's length, that flowed at each hinge place.
std::array<double, 2> flowed_turns(const Element& element, const BeamStrain& offset);

/// Where an element has flowed, as its offset tells: whether it flows now or not. Axial flow and twist alone:
/// at both ends. A broken one: broken.
Hinge flowed_at(const Element& element, const ElementState& state);

}  // namespace topple
