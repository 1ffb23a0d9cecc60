// The block that every engine gets, and what an engine has to offer.
#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

namespace topple::bench {

inline constexpr double k_gravity = 9.81;                   ///< m/s^2
inline constexpr double k_size[] = {0.38, 0.88, 1.79};      ///< m, x, y, z
inline constexpr double k_mass = 40;                        ///< kg, uniform
inline constexpr double k_friction = 1.5;                   ///< enough to rock without sliding
inline constexpr double k_settling = 0.5;                   ///< s, at rest before the floor shakes
inline constexpr double k_gal = 0.01;                       ///< m/s^2
inline constexpr double k_degree = std::numbers::pi / 180;  ///< rad

/// What happens to the block: let go on its +x edge, or at rest on a floor that shakes along x from t = 0 on.
struct Case {
  double tilt = 0;       ///< rad, > 0; 0: at rest
  double amplitude = 0;  ///< m/s^2, of the sine of the floor's acceleration
  double frequency = 2;  ///< Hz

  double floor_acceleration(double t) const {
    return t < 0 ? 0 : amplitude * std::sin(2 * std::numbers::pi * frequency * t);
  }
  /// s, negative: the instant from which the block is left to settle.
  double begin() const { return tilt > 0 ? 0 : -k_settling; }
  /// m, of the block's middle at the beginning.
  double middle_x() const { return k_size[0] / 2 * (1 - std::cos(tilt)) + k_size[2] / 2 * std::sin(tilt); }
  double middle_z() const { return k_size[0] / 2 * std::sin(tilt) + k_size[2] / 2 * std::cos(tilt); }
};

/// One engine with one setting, at t = 0 of one case.
struct Simulation {
  std::function<double()> advance;  ///< takes one step; the time after it, s; NaN: the engine gave up
  std::function<double()> tilt;     ///< rad, towards +x
  /// rad, at a time within the newest step, s; empty: known at its end alone.
  std::function<double(double)> tilt_within = {};
};

/// A point of an engine's grid.
struct Setting {
  double step;          ///< s; 0: adaptive
  std::string contact;  ///< all else that was set
  std::function<Simulation(const Case&)> start;
};

struct Engine {
  std::string name, version;
  std::string how;  ///< what holds for the whole grid
  std::vector<Setting> grid;
};

inline constexpr double k_steps[] = {1e-4, 2.5e-4, 5e-4, 1e-3, 2e-3, 4e-3};  ///< s, of every engine

Engine planar_engine();  ///< topple's planar block
Engine topple_engine();  ///< its bodies on penalty contacts
Engine mujoco_engine();
Engine bullet_engine();
Engine ode_engine();

/// A cabinet of the block's size and mass on `base = "edges"`, every contact key but friction left out, with
/// more lines in it.
Setting cabinet_on_edges(double step, const std::string& more);
Setting ode_box(double step);  ///< none of the quick steps

/// Steps of `h` from case.begin(): `step(a)` takes one under the floor acceleration a, m/s^2, of its middle.
/// Settles before it returns.
Simulation stepped(const Case& c, double h, std::function<bool(double)> step, std::function<double()> tilt);

}  // namespace topple::bench
