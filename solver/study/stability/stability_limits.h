// What theory says of the limits that a stability map is drawn with.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "solver/study/stability/stability.h"

namespace topple::study {

/// How hard a scene is on a step: the greatest of its furniture.
struct Demand {
  double explicit_step = 0;  ///< s, 2/w of the stiffest vibration with all contacts closed; 0: no frames
  double bounce = 0;         ///< s, shortest period of a body on its contacts; 0: none
  double landing = 0;        ///< s, in which a landing body crosses the width of its contact; 0: none lands
  double alpha = 0;    ///< N, below which a body that lands flat goes through its contacts; 0: none does
  double turning = 0;  ///< rad^2/s, integral of the squared angular velocity over a fall; without gravity,
                       ///< over the run
};
/// `scene` after `duration`, s. A body that stands freely is taken to fall over its nearest edge from
/// balance:
///   w^2 = 2 m g (R - b)/I_edge when it lies; its far end, H from the edge, lands at v = w H
///   landing = L/v,  alpha = m g (R - b) (q + 1)/(n L), n contacts on the side on which it lands
/// and then turning = 4 p (1 - cos((pi/2 - critical)/2)). One that starts with velocity v0 or at a height d
/// above the floor lands at v^2 = v0^2 + 2 g d:
///   landing = L/v,  alpha = m v^2 (q + 1)/(2 n L), n contacts on the base
Demand demand(const Setup& scene, double duration);

/// Share of its energy that one closing or opening of a linear contact gives or takes at most when
/// trapezoidal work meets a force that begins in mid-step, at a distance d <= v h from the step's end:
///   k d (v h - d)/2 <= k (v h)^2/8 = (w h)^2/4 of m v^2/2
/// so that a bounce has e^2 = 1 -+ (w h)^2/4. Derived.
double impact_error(double step, double period);
/// Inverse: s.
double step_of_impact_error(double error, double period);

/// Step at which Newmark takes `share` of the energy of a rotation with this integral of w^2 dt, s. Each step
/// lacks (gamma - 1/2) h^2 w^2 v, so that E goes as exp(-2 (gamma - 1/2) h int w^2 dt). Derived.
double step_of_damping(double share, double gamma, double turning);

/// Longest step at which smoothed friction does not change sides: 2 v_s/(mu g), s. 0: none is smoothed.
double step_of_chatter(const ContactLaw& law, double gravity);

/// A line over the map: polyline in the axes' units, clipped by nothing.
struct StabilityLimit {
  std::string name;                  ///< "explicit"
  std::string formula, about;        ///< "h = 2/ω", what lies beyond it
  std::vector<std::string> methods;  ///< names of those that it is a limit of
  std::vector<double> x, y;
  std::optional<double> at_scene;  ///< where the scene itself stands, in `unit`
  std::string unit;                ///< "ms", "kgf"
};
std::vector<StabilityLimit> stability_limits(const StabilityPlan& plan);

}  // namespace topple::study
