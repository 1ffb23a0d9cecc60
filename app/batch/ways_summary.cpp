#include "app/batch/ways_summary.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "solver/run/ways.h"

namespace topple::app {
namespace {

using nlohmann::ordered_json;

ordered_json way_json(const Room& room, const Model& model, const RoomPlan& plan, int place, const Way& way) {
  if (way.door < 0)
    return {{"door", nullptr}, {"open", nullptr}, {"widest_m", nullptr}, {"length_m", nullptr}};
  ordered_json out{{"door", room.doors[static_cast<std::size_t>(way.door)].name},
                   {"open", way.open},
                   {"widest_m", way.widest},
                   {"length_m", nullptr}};
  if (way.open)
    if (const auto line = shortest_way(room, plan, place, way.door)) out["length_m"] = line->length;
  out["caught"] = way.caught;
  out["blocked_by"] = ordered_json::array();
  for (const int body : way.blocked_by)
    out["blocked_by"].push_back(model.bodies[static_cast<std::size_t>(body)].name);
  return out;
}

std::string joined(const ordered_json& names) {
  std::string text;
  for (const auto& name : names) text += (text.empty() ? "" : ", ") + name.get<std::string>();
  return text;
}

}  // namespace

ordered_json ways_json(const Room& room, const Model& model, std::span<const Vec3> position,
                       const std::vector<PlaceOutcome>& hits) {
  ordered_json out = ordered_json::array();
  const RoomPlan plan = room_plan(room, model, position);
  const std::vector<Way> found = ways(room, plan);
  for (std::size_t p = 0; p < found.size(); ++p) {
    ordered_json one{{"place", room.places[p].name}};
    one.update(way_json(room, model, plan, static_cast<int>(p), found[p]));
    one["hit_by"] = ordered_json::array();
    for (const PlaceOutcome::Hit& hit : hits.empty() ? std::vector<PlaceOutcome::Hit>{} : hits[p].hits)
      one["hit_by"].push_back(
          {{"body", model.bodies[static_cast<std::size_t>(hit.body)].name}, {"time_s", hit.time}});
    out.push_back(std::move(one));
  }
  return out;
}

ordered_json ways_json(const Run& run) {
  const Setup& setup = run.setup();
  ordered_json out = ways_json(setup.room, setup.model, run.state().position, run.places());
  ordered_json before =
      ways_json(setup.room, setup.model, start_state(setup.model, setup.starts).position, {});
  for (std::size_t p = 0; p < out.size(); ++p) {
    before[p].erase("place");
    before[p].erase("hit_by");
    out[p]["before"] = std::move(before[p]);
  }
  return out;
}

std::string hits_in_words(const ordered_json& way) {
  std::string hits;
  for (const auto& hit : way["hit_by"])
    hits += fmt::format("{}{} at {:.2f} s", hits.empty() ? "" : ", ", hit["body"].get<std::string>(),
                        hit["time_s"].get<double>());
  return hits;
}

namespace {

/// Of two that are closed.
bool is_same(const ordered_json& way, const ordered_json& before) {
  constexpr double k_millimetre = 1e-3;
  return way["caught"] == before["caught"] &&
         std::abs(way["widest_m"].get<double>() - before["widest_m"].get<double>()) < k_millimetre;
}

}  // namespace

std::string ways_in_words(const ordered_json& ways, double person) {
  std::string out;
  for (const auto& way : ways) {
    out += fmt::format("place {}: ", way["place"].get<std::string>());
    if (way["open"].is_null()) {
      out += "there is no door";
    } else if (way["open"].get<bool>()) {
      out += fmt::format("way to {} open, widest {:.2f} m", way["door"].get<std::string>(),
                         way["widest_m"].get<double>());
      if (!way["length_m"].is_null())
        out += fmt::format(", shortest {:.1f} m long", way["length_m"].get<double>());
    } else if (way["caught"].get<bool>()) {
      out += "cannot leave, blocked where they are by " + joined(way["blocked_by"]);
    } else {
      out += fmt::format("no way to {} for a person of {:g} m", way["door"].get<std::string>(), person);
      if (way["widest_m"].get<double>() > 0)
        out += fmt::format(", {:.3f} m left", way["widest_m"].get<double>());
      out +=
          way["blocked_by"].empty() ? ": the door is narrower" : ", blocked by " + joined(way["blocked_by"]);
    }
    if (way["open"] == false && way.contains("before") && way["before"]["open"] == false)
      out += is_same(way, way["before"]) ? ", as before the shake" : ", closed before the shake, too";
    const std::string hits = hits_in_words(way);
    out += (hits.empty() ? "" : "; hit by " + hits) + "\n";
  }
  return out;
}

}  // namespace topple::app
