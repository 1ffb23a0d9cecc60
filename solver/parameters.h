// What may be edited while it runs.
#pragma once

#include <vector>

#include "solver/types.h"

namespace topple {

enum class ContactLawKind { coulomb, paper, printed };

/// Penalty contact (Eqs. 2 and 3), see contact_law.h.
struct ContactLaw {
  ContactLawKind kind = ContactLawKind::coulomb;
  double alpha = 50 * k_standard_gravity;  ///< N, penalty coefficient
  double q = 1;                            ///< penalty index
  double friction = 0.6;                   ///< mu
  double restitution = 0.5;                ///< coulomb law
  double normal_speed = 0.01;              ///< m/s, eps_n of the coulomb law
  double slip_speed = 0.01;  ///< m/s, smoothing of the direction v/|v| of the paper and printed laws
};

/// One floor acceleration; several add up.
struct Shake {
  enum class Kind { sine, pulse };
  enum class Shape { half_sine, full_sine, rectangle };
  enum class Start { rest, jump };
  Kind kind = Kind::sine;
  double amplitude = 0;            ///< m/s^2
  double frequency = 1;            ///< Hz, sine
  Vec3 direction = Vec3::UnitX();  ///< unit
  double start = 0;                ///< s
  double cycles = 0;               ///< sine: 0 = until the end
  double taper = 0;                ///< sine: cycles of smooth rise and fall
  Start initial_velocity = Start::rest;
  Shape shape = Shape::half_sine;  ///< pulse
  double duration = 1;             ///< s, pulse
};

enum class Integrator { central_difference, generalized_alpha };

/// Legal ranges, units and defaults of these stand in solver/io/scene_keys.h, one table for scene files,
/// sliders and fuzzers.
struct Parameters {
  ContactLaw contact;
  std::vector<Shake> shakes;
  Vec3 gravity{0, 0, -k_standard_gravity};  ///< m/s^2
  Integrator integrator = Integrator::generalized_alpha;
  double spectral_radius = 0.8;  ///< of generalized-alpha at infinity, 0..1
  double time_step = 1e-3;       ///< s
};

}  // namespace topple
