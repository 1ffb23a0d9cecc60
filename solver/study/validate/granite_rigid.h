// A rock as a body of the rigid model: a base of four corners, its mass and inertia in one point.
#pragma once

#include <functional>
#include <optional>

#include "solver/run/run.h"
#include "solver/study/validate/granite_fit.h"

namespace topple::study {

/// One rock in one test. Contacts without restitution leave the rate of Housner's impact; where the rock has
/// another factor the body's velocities are multiplied by it at the end of the step in which the tilt
/// changes its sign.
class RigidRock {
 public:
  RigidRock(const RockTraits& traits, const Rock& rock, const GraniteTest& test);

  void advance();
  bool over() const;
  bool fell() const;
  double tilt() const;  ///< rad, about the axis across the motion, positive towards +x
  double rate() const;  ///< rad/s

 private:
  Setup setup_;
  double restitution_;
  std::optional<Run> run_;
};

/// Whether the rock falls in a test.
bool rigid_falls(const RockTraits& traits, const Rock& rock, const GraniteTest& test,
                 const std::function<bool()>& give_up);

}  // namespace topple::study
