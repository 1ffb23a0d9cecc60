#include "app/cli/describe.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "app/batch/summary.h"
#include "app/batch/ways_summary.h"
#include "app/support/progress.h"
#include "app/support/terms.h"
#include "solver/body/model_level.h"
#include "solver/io/edit/edit_text.h"
#include "solver/io/recording/rerun.h"
#include "solver/io/scene/scene_words.h"
#include "solver/math/elementary.h"

namespace topple::app {
namespace {

using nlohmann::ordered_json;

ordered_json describe(const io::RecordedEvent& e, const ordered_json& bodies, const ordered_json& anchors) {
  static constexpr std::pair<Event::Kind, const char*> k_kinds[] = {
      {Event::Kind::uplift, "uplift"},     {Event::Kind::impact, "impact"},
      {Event::Kind::overturn, "overturn"}, {Event::Kind::hinge, "hinge"},
      {Event::Kind::fracture, "fracture"}, {Event::Kind::model, "model"},
      {Event::Kind::anchor, "anchor"}};
  const auto* const kind =
      std::ranges::find(k_kinds, e.event.kind, &std::pair<Event::Kind, const char*>::first);
  const auto body = static_cast<std::size_t>(e.event.body);
  if (kind == std::end(k_kinds) || body >= bodies.size())
    throw io::InputError("the recording has an event of a kind or a body that it does not describe");
  const auto anchor = static_cast<std::size_t>(e.event.anchor);
  if (e.event.kind == Event::Kind::anchor && anchor >= anchors.size())
    throw io::InputError("the recording has an event of an anchor that it does not describe");
  ordered_json out = {{"kind", kind->second},
                      {"time_s", e.time},
                      {"step", e.step},
                      {"body", bodies[body]["name"]},
                      {"value", e.event.value}};
  if (e.event.kind == Event::Kind::anchor) out["anchor"] = anchors[anchor]["name"];
  if (e.event.kind == Event::Kind::model) {
    out["model"] = traits(static_cast<ModelLevel>(e.event.value)).word;
    out["reason"] = name(e.event.reason);
  }
  return out;
}

/// In SI. Words are written in JSON as in a scene.
ordered_json value_json(const Edit& edit) {
  const io::Key& key = io::key_of(edit.key);
  if (key.type == io::KeyType::choice || key.type == io::KeyType::choices)
    return ordered_json::parse(io::edit_value_text(edit, io::EditSpelling::in_scene));
  return key.count == 3 ? vector_json(edit.value) : ordered_json(edit.value.x());
}

ordered_json describe(const LoggedEdit& logged) {
  return {{"branch", logged.branch},
          {"step", logged.step},
          {"time_s", logged.time},
          {"key", io::edit_key(logged.edit)},
          {"value", value_json(logged.edit)},
          {"shown", io::edit_value_text(logged.edit, io::EditSpelling::shown)}};
}

/// The ledger at one instant, named as in the summary.
ordered_json describe_energy(const io::FrameRow& row, bool is_static) {
  const std::vector<double>& e = row.energy;
  const bool anchors = e.size() > io::k_released;
  const double released = anchors ? e[io::k_released] : 0;
  return {{"input_J", e[io::k_input]},
          {"kinetic_J", e[io::k_kinetic]},
          {"strain_J", e[io::k_strain]},
          {"gravity_J", e[io::k_gravity]},
          {"contact_J", e[io::k_contact]},
          {"dissipated_J", e[io::k_friction] + e[io::k_normal_damping] + e[io::k_numerical] +
                               e[io::k_plastic] + e[io::k_damping] + released},
          {"friction_J", e[io::k_friction]},
          {"normal_damping_J", e[io::k_normal_damping]},
          {"numerical_J", e[io::k_numerical]},
          {"plastic_J", e[io::k_plastic]},
          {"damping_J", e[io::k_damping]},
          {"model_switch_J", e[io::k_model_switch]},
          {"anchor_J", anchors ? ordered_json(e[io::k_anchor]) : ordered_json(0)},
          {"released_J", anchors ? ordered_json(released) : ordered_json(0)},
          {"balance_error", is_static ? ordered_json(nullptr) : ordered_json(e[io::k_balance_error])}};
}

ordered_json describe(const io::Difference& found, const Model& model) {
  const auto& [at, what, element] = found;
  ordered_json out{
      {"branch", at.branch}, {"step", at.step}, {"time_s", at.time}, {"what", what}, {"element", nullptr}};
  if (element >= 0) {
    const Member& member = model.members[model.elements[element].member];
    out["element"] = element;
    out["member"] = member.name;
    out["body"] = model.bodies[member.body].name;
  }
  return out;
}

}  // namespace

ordered_json scene_description(const io::Scene& scene) {
  const Setup& setup = scene.setup;
  ordered_json out;
  out["kind"] = "scene";
  out["scene"] = scene.name;
  out["title"] = scene.title;
  out["analysis"] = row_of(io::k_analyses, setup.run.analysis).word;
  const bool loads = is_static(setup);
  out["duration_s"] = loads ? ordered_json(nullptr) : ordered_json(setup.run.duration);
  const bool steps = !loads && !setup.parameters.adaptive;
  out["time_step_s"] = steps ? ordered_json(setup.parameters.time_step) : ordered_json(nullptr);
  out["contact_alpha_N"] = setup.parameters.contact.alpha;
  if (loads) out["load_steps"] = setup.run.statics.load_steps;
  out["nodes"] = setup.model.node_total();
  out["elements"] = setup.model.elements.size();
  out["contact_points"] = setup.model.contact_points.size();
  out["bodies"] = ordered_json::array();
  for (const Body& body : setup.model.bodies) {
    const bool based = !body.support_polygon.empty();
    const double above = based ? body.centre_of_gravity.z() - body.support_polygon.front().z() : 0;
    out["bodies"].push_back({{"name", body.name},
                             {"mass_kg", body.mass},
                             {"centre_of_gravity_m", vector_json(body.centre_of_gravity)},
                             {"above_base_m", based ? ordered_json(above) : ordered_json(nullptr)},
                             {"inertia_kg_m2", vector_json(body.inertia.diagonal())},
                             {"nodes", body.node_count},
                             {"elements", body.element_count}});
  }
  out["anchors"] = ordered_json::array();
  for (std::size_t k = 0; k < setup.model.anchors.size(); ++k) {
    const Anchor& anchor = setup.model.anchors[k];
    out["anchors"].push_back(describe_anchor(setup.model, anchor));
    out["anchors"].back()["length_m"] = anchor.length;
    out["anchors"].back()["on"] = setup.parameters.anchors[k];
  }
  if (!setup.room.places.empty()) {
    out["person_m"] = setup.room.person;
    out["ways"] = ways_json(setup.room, setup.model, start_state(setup.model, setup.starts).position, {});
  }
  return out;
}

ordered_json recording_description(const io::Recording& recording) {
  const io::Scene scene = io::recorded_scene(recording);
  ordered_json out = scene_description(scene);
  const std::int32_t newest = recording.newest_branch();
  const std::vector<std::int64_t> shown = recording.frames_on_way_to(newest);
  out["kind"] = "recording";
  out["format"] = recording.format();
  out["arithmetic"] = recording.arithmetic();
  out["status"] = recording.status();
  out["frames"] = recording.frame_count();
  out["recorded_s"] = shown.empty() ? 0 : recording.index()[shown.back()].time;
  out["recorded_steps"] = shown.empty() ? 0 : recording.index()[shown.back()].step;
  out["checkpoints"] = recording.checkpoint_count();
  if (recording.checkpoint_count() > 0)
    out["last_state_hash"] =
        fmt::format("{:016x}", recording.checkpoint(recording.checkpoint_count() - 1).hash);
  if (!shown.empty()) out["energy"] = describe_energy(recording.frame(shown.back()), is_static(scene.setup));
  out["branches"] = ordered_json::array();
  for (const Branch& b : recording.history().branches)
    out["branches"].push_back({{"id", b.id}, {"parent", b.parent}, {"fork_step", b.fork_step}});
  out["edits"] = ordered_json::array();
  for (const LoggedEdit& e : recording.history().edits) out["edits"].push_back(describe(e));
  out["events"] = ordered_json::array();
  std::vector<io::RecordedEvent> events = recording.events_on_way_to(newest);
  // an uplift is dated back to when the side let go; "time" of a static run is its load, which may sink
  if (!is_static(scene.setup)) std::ranges::stable_sort(events, {}, &io::RecordedEvent::time);
  for (const io::RecordedEvent& e : events)
    out["events"].push_back(describe(e, out["bodies"], out["anchors"]));
  out.erase("ways");  // those of the end are in the summary
  if (!recording.summary_json().empty()) out["summary"] = ordered_json::parse(recording.summary_json());
  if (out.contains("summary") && out["summary"].contains("ways")) out["ways"] = out["summary"]["ways"];
  return out;
}

ordered_json verify(const io::Recording& recording) {
  const auto total = static_cast<double>(recording.checkpoint_count());
  Progress progress("re-run", "checkpoints", std::max(total, 1.), false);
  const io::Rerun rerun =
      io::rerun(recording, [&](std::int64_t seen) { progress.update(static_cast<double>(seen)); });
  const bool same = rerun.differences.empty(), own = recording.arithmetic() == arithmetic();
  ordered_json out{{"checkpoints", rerun.checkpoints},
                   {"branches", recording.history().branches.size()},
                   {"damaged", !rerun.damage.empty() || (!same && own)},
                   {"same", rerun.damage.empty() && same},
                   {"differences", ordered_json::array()}};
  const Model model = io::recorded_scene(recording).setup.model;
  for (const auto* list : {&rerun.damage, &rerun.differences})
    for (const io::Difference& difference : *list) out["differences"].push_back(describe(difference, model));
  return out;
}

}  // namespace topple::app
