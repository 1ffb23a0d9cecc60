#include "solver/frame/step_span.h"

#include "solver/model/excitation.h"

namespace topple {

StepInputs::StepInputs(const Parameters& parameters, double t)
    : time(t), law(contact_law(parameters, t)), floor(floor_acceleration(parameters.shakes, t)) {}

StepInputs::StepInputs(const Parameters& parameters, double t, const StepInputs& before)
    : time(t),
      law(parameters.contact_ramp.over > 0 ? PreparedLaw(contact_law(parameters, t)) : before.law),
      floor(floor_acceleration(parameters.shakes, t)) {}

}  // namespace topple
