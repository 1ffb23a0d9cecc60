// Floor of a linear building that its ground shakes.
//
//   a_floor = (1 - sum_r f_r) a_ground - sum_r f_r (2 zeta_r w_r x_r' + w_r^2 x_r)
//   x_r'' + 2 zeta_r w_r x_r' + w_r^2 x_r = -a_ground,   at rest before the ground moves
//
// f_r: participation factor of mode r times its shape at the floor. Each step of x_r is exact for an
// acceleration of the ground that is linear over an interval (N. C. Nigam, P. C. Jennings, Calculation of
// response spectra from strong-motion earthquake records, Bull. Seismol. Soc. Am. 59, 1969, 909-922); the
// line goes through the ground's acceleration at the interval's two Gauss points, which is exact for what is
// linear there, whatever jumps at the ends, and else of fourth order. Between, the floor's acceleration is
// the cubic with the values and slopes at both ends.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <vector>

namespace topple {

/// A mode of a building, as one of its floors has it.
struct BuildingMode {
  double period;   ///< s, undamped
  double damping;  ///< ratio to critical, > 0, < 1
  double factor;   ///< participation factor times shape at the floor
};

/// Modes at floor `storey`, 1..of, of a shear building of `of` equal storeys on a rigid ground, equal masses
/// at floors 1..of, floor `of` being the roof; `period`: of the first mode, s; every mode has `damping`.
///   w_r = 2 sqrt(k/m) sin(theta_r/2),  shape_r(j) = sin(j theta_r),  theta_r = (2 r - 1) pi / (2 of + 1)
///   participation factor times shape: 2 cot(theta_r/2) sin(j theta_r) / (2 of + 1); they sum to 1
std::vector<BuildingMode> shear_building(int storey, int of, double period, double damping);

/// One component of a ground's motion, over its own unit, `tau` seconds after its start.
struct GroundSignal {
  std::function<double(double tau)> acceleration;
  double grid = 0;      ///< s, divides `duration`: where it has kinks or jumps is a multiple of it
  double shortest = 0;  ///< s, its shortest period; infinite: it is linear between its kinks
  double duration = 0;  ///< s; of one that goes on its period, in which it repeats itself from `steady` on
  bool goes_on = false;
  double steady = 0;  ///< s
  double jump = 0;    ///< jump of the ground's velocity at its start, s times the unit
};

/// What the modes add to the floor's motion, per component of the ground's; shared and never changed.
struct FloorResponse {
  using Cubic = std::array<double, 4>;  ///< coefficients over the share of the interval, 0..1
  struct Component {
    double interval;           ///< s
    std::vector<Cubic> curve;  ///< from the start on
    std::size_t repeats = 0;   ///< the last so many intervals repeat for ever; 0: none
  };
  std::vector<BuildingMode> modes;
  int storey = 0, of = 0;  ///< of a shear building; else 0
  double ground = 0;       ///< 1 - sum of the factors: share of the ground's own acceleration
  double duration = 0;     ///< s, until all has died away; infinite: never
  double peak = 0;         ///< greatest sum of the components' sizes
  std::vector<Component> components;
};

/// Intervals beyond which floor_response() gives up.
inline constexpr std::size_t k_most_floor_intervals = 2'000'000;

/// Response to the components of one shake; null: it takes more than k_most_floor_intervals.
std::shared_ptr<FloorResponse> floor_response(std::vector<BuildingMode> modes,
                                              const std::vector<GroundSignal>& ground);

/// Part of a component's curve that holds at tau, and what of its interval has passed by then, 0..1; null:
/// nothing moves.
const FloorResponse::Cubic* floor_curve(const FloorResponse::Component& component, double tau, double& share);

/// Modal part of the floor's acceleration, over the ground's unit.
double floor_response_at(const FloorResponse::Component& component, double tau);

}  // namespace topple
