#include "solver/study/overturn/planar_runs.h"

#include "solver/body/model_level.h"
#include "solver/contact/contact_default.h"
#include "solver/planar/planar_run.h"

namespace topple::study {
namespace {

constexpr double k_softer = 1 - 1e-6;  // alpha over rigid_alpha

/// Empty: nothing in the scene's settings is against it.
std::string setting_against(const Setup& setup) {
  const Parameters& p = setup.parameters;
  if (p.want_stress) return "stresses are asked for";
  if (p.contact.restitution > 0) return "contacts bounce";
  const std::optional<double> alpha = rigid_alpha(setup.model, p.contact, p.gravity);
  if (!alpha || p.contact.alpha < k_softer * *alpha) return "contacts are soft";
  return "";
}

/// Empty: nothing in the body's model is against it.
std::string model_against(const Setup& setup, int body) {
  const std::vector<BodyModel>& models = setup.parameters.models;
  const BodyModel asked = models.empty() ? BodyModel::frame : models[static_cast<std::size_t>(body)];
  if (asked == BodyModel::planar) return "";
  if (asked != BodyModel::automatic) return "its model is named";
  if (base_level(setup.model, setup.parameters, body).level != ModelLevel::rigid) return "it bends";
  return "";
}

}  // namespace

std::vector<planar::PlanarCase> planar_cases(const Setup& setup, std::string* why) {
  std::vector<planar::PlanarCase> cases;
  std::string against = setting_against(setup);
  for (int b = 0; b < setup.model.furniture_total() && against.empty(); ++b) {
    against = model_against(setup, b);
    planar::Obstacle obstacle = planar::Obstacle::none;
    if (against.empty()) {
      if (const auto found = planar::planar_case(setup.model, setup.parameters, setup.starts, b, &obstacle))
        cases.push_back(*found);
      else
        against = traits(obstacle).phrase;
    }
    if (!against.empty()) against = setup.model.bodies[static_cast<std::size_t>(b)].name + ": " + against;
  }
  if (why) *why = against;
  if (!against.empty()) cases.clear();
  return cases;
}

std::optional<std::vector<BodyEnd>> run_planar(const std::vector<planar::PlanarCase>& cases,
                                               const std::vector<Shake>& shakes, double duration,
                                               const std::function<bool()>& give_up) {
  std::vector<BodyEnd> out;
  for (const planar::PlanarCase& one : cases) {
    planar::PlanarRun run(one, shakes, duration);
    while (!run.over()) {
      run.advance();
      if (give_up()) return std::nullopt;
    }
    if (run.left() || run.stuck()) return std::nullopt;
    out.push_back({run.beyond_since(), run.lifted().has_value(), run.peak_slide()});
  }
  return out;
}

}  // namespace topple::study
