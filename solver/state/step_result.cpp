#include "solver/state/step_result.h"

#include <algorithm>
#include <cstdio>

namespace topple {
namespace {

constexpr double k_no_load = 1e-3;  // load factor

std::string format(const char* pattern, double a) {
  char text[96];
  std::snprintf(text, sizeof text, pattern, a);
  return text;
}

const char* in_words(NoRest why) {
  switch (why) {
    case NoRest::leaves:
      return "nothing keeps it where it is (does it stand on something, with enough friction, clear of its "
             "neighbours, and can alpha and the steel carry it?)";
    case NoRest::tips_over:
      return "it balances, but tips over by itself (do soft contacts let it lean?)";
    case NoRest::not_found:
      break;
  }
  return "none was found (is it clear of its neighbours, and can alpha and the steel carry it?)";
}

const char* loss_in_words(Stability::Loss loss) {
  using Loss = Stability::Loss;
  switch (loss) {
    case Loss::limit_point:
      return " carries no more there, a limit point; run.control with an arc follows a path that turns down";
    case Loss::buckling:
      return " buckles there, sideways to its loads";
    case Loss::mechanism:
      return " is a mechanism there, or its path is nearly flat; run.control with an arc follows it on";
    case Loss::fracture:
      return " breaks there, and what is left does not carry the loads; run.control with an arc follows a "
             "path that goes on or turns down";
    case Loss::none:
      break;
  }
  return " has no neighbouring equilibrium; try more load_steps";
}

}  // namespace

StepStatus look_at_numbers(const Model& model, const Parameters& parameters, const State& state, bool nodes) {
  StepStatus status;
  status.time = state.time;
  if (!is_finite(parameters)) {
    status.kind = StepStatus::Kind::bad_parameter;
  } else if (!is_finite(state, nodes)) {
    status.kind = StepStatus::Kind::not_finite;
    status.body = body_not_finite(model, state);
  }
  return status;
}

MemberForce member_force(const MemberTouch& touch, const MemberPair& pair) {
  MemberForce force{pair.elements, touch.s, touch.t, touch.input.depth, touch.out.force, touch.u};
  const auto find = [](int count, int& element, double& place) {
    const int which = std::min(static_cast<int>(place * count), count - 1);
    element += which;
    place = place * count - which;
  };
  find(pair.count[0], force.elements.a, force.s);
  find(pair.count[1], force.elements.b, force.t);
  return force;
}

std::string StepStatus::message(const Model& model) const {
  if (ok()) return "ok";
  std::string where =
      body >= 0 ? "body \"" + model.bodies[body].name + "\"" : "the floor, a contact, an anchor or an energy";
  if (element >= 0) {
    const Member& member = model.members[model.elements[element].member];
    where += ", member \"" + member.name + "\" (element " + std::to_string(element) + ")";
  }
  const std::string when = format("at %.6g s", time),
                    finer = by_tolerance ? "; try a smaller tolerance" : "; try a smaller time_step";
  switch (kind) {
    case Kind::newton_diverged:
      return "the step " + when + " has no converged solution: " + where + finer;
    case Kind::not_accurate:
      return "no step is short enough for the tolerance " + when + (body >= 0 ? ": " + where : "") +
             "; try a larger tolerance, or a fixed time_step";
    case Kind::not_finite:
      return "the motion is no longer finite " + when + ": " + where + finer;
    case Kind::singular:
      return "the stiffness is singular " + when + ": " + where + "; a part may be free to move";
    case Kind::not_settled:
      return "before the first step, " + when + ": " + where +
             " does not come to rest under gravity: " + in_words(no_rest) +
             "; settle = false starts it as it is";
    case Kind::step_too_long:
      return where + format(": the time integration is stable up to a time_step of %.4g s", limit) +
             ", met " + when + "; try a smaller one, or generalized-alpha";
    case Kind::no_equilibrium:
      if (stability.loss == Stability::Loss::mechanism && load_factor < k_no_load)
        return where + " is a mechanism before it carries anything: a part may be free to move";
      return format("no equilibrium was found at load factor %.6g: ", load_factor) + where +
             loss_in_words(stability.loss);
    case Kind::passed_through:
      return "members would pass through each other unseen in the step " + when + ": " + where + finer;
    case Kind::energy_lost:
      return (body >= 0 ? "a contact is not resolved: " : "") +
             ("more than a tenth of the energy is unaccounted for after the step " + when +
              ", which is not taken") +
             (body >= 0 ? ": " + where : "") +
             (by_tolerance ? "; try a fixed time_step, or softer contacts (alpha)" : finer);
    case Kind::uncontrolled:
      return where + ": the loads do not move the controlled direction";
    case Kind::bad_parameter:
      return "a parameter is no finite number " + when;
    case Kind::ok:
      break;
  }
  return "";
}

}  // namespace topple
