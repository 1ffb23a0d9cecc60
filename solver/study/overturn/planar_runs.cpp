#include "solver/study/overturn/planar_runs.h"

#include <algorithm>

#include "solver/body/model_level.h"
#include "solver/body/planar_body.h"
#include "solver/contact/contact_default.h"

namespace topple::study {
namespace {

/// Empty: nothing in the scene's settings is against it.
std::string setting_against(const Setup& setup) {
  const Parameters& p = setup.parameters;
  if (p.want_stress) return "stresses are asked for";
  if (setup.room.ways() > 0) return "the way out depends on where bodies come to lie";
  if (p.contact.restitution > 0) return "contacts bounce";
  if (!stands_for_hard_floor(setup.model, p.contact, p.gravity)) return "contacts are soft";
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
      const Parameters& p = setup.parameters;
      const auto found = planar::planar_case(setup.model, p, setup.starts, b, &obstacle);
      if (!found)
        against = traits(obstacle).phrase;
      else if (hard_floor_error(setup.model, b, *found, p.contact) > p.accuracy)
        against = "contacts are soft for its base";
      else
        cases.push_back(*found);
    }
    if (!against.empty()) against = setup.model.bodies[static_cast<std::size_t>(b)].name + ": " + against;
  }
  if (why) *why = against;
  if (!against.empty()) cases.clear();
  return cases;
}

std::vector<std::optional<std::vector<BodyEnd>>> run_planar(const std::vector<PlanarMember>& members,
                                                            const std::function<bool()>& give_up,
                                                            planar::LaneUse* use) {
  struct Place {
    std::size_t member, block;
  };
  std::vector<Place> places;
  std::vector<std::optional<std::vector<BodyEnd>>> out;
  for (std::size_t m = 0; m < members.size(); ++m) {
    for (std::size_t b = 0; b < members[m].blocks.size(); ++b) places.push_back({m, b});
    out.emplace_back(members[m].blocks.size());
  }
  std::size_t ended = 0;
  const planar::LaneUse used = planar::run_in_lanes(
      static_cast<int>(places.size()),
      [&](int i) -> std::unique_ptr<planar::PlanarRun> {
        const auto [m, b] = places[static_cast<std::size_t>(i)];
        if (!out[m]) return ++ended, nullptr;
        return std::make_unique<planar::PlanarRun>(members[m].blocks[b], members[m].shakes,
                                                   members[m].duration);
      },
      [&](int i, const planar::PlanarRun& run) {
        const auto [m, b] = places[static_cast<std::size_t>(i)];
        ++ended;
        if (run.left() || run.stuck()) out[m].reset();
        if (out[m]) (*out[m])[b] = {run.beyond_since(), run.lifted().has_value(), run.peak_slide()};
      },
      give_up);
  if (ended < places.size()) std::ranges::fill(out, std::nullopt);
  if (use) use->busy += used.busy, use->lanes += used.lanes;
  return out;
}

}  // namespace topple::study
