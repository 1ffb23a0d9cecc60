#include "solver/frame/step_span.h"

#include "solver/model/excitation.h"

namespace topple {
namespace {

std::vector<PulledNode> pulls_at(const Parameters& parameters, double t) {
  std::vector<PulledNode> forces;
  for (const Pull& pull : parameters.pulls) forces.push_back({pull.node, pull_force(pull, t)});
  return forces;
}

}  // namespace

StepInputs::StepInputs(const Parameters& parameters, double t)
    : time(t),
      law(contact_law(parameters, t)),
      floor(acceleration_from(parameters.shakes, t)),
      pulls(pulls_at(parameters, t)) {}

StepInputs::StepInputs(const Parameters& parameters, double t, const StepInputs& before)
    : time(t),
      law(parameters.contact_ramp.over > 0 ? PreparedLaw(contact_law(parameters, t)) : before.law),
      floor(floor_acceleration(parameters.shakes, t)),
      pulls(pulls_at(parameters, t)) {}

}  // namespace topple
