#include "app/picture/ways_in_words.h"

#include <fmt/format.h>

#include "app/picture/row.h"
#include "app/picture/ways_words.h"
#include "solver/run/ways.h"

namespace topple::app {
namespace {

using namespace window_words;

std::vector<Vec3> nodes_of(const Model& model, const io::FrameRow& row) {
  std::vector<Vec3> nodes;
  nodes.reserve(model.node_position.size());
  for (int n = 0; n < model.node_total(); ++n) nodes.push_back(position(row, n));
  return nodes;
}

std::string line_of(const Setup& setup, const RoomPlan& plan, std::size_t p, const Way& way) {
  const Room& room = setup.room;
  const std::string& place = room.places[p].name;
  if (way.door < 0) return say(k_way_no_door, place);
  const std::string& door = room.doors[static_cast<std::size_t>(way.door)].name;
  const std::string width = fmt::format("{:.{}f}", way.widest, way.open ? 2 : 3);
  if (way.open) {
    const auto line = shortest_way(room, plan, static_cast<int>(p), way.door);
    return say(k_way_open, place, door, width, line ? fmt::format("{:.1f}", line->length) : "-");
  }
  if (way.blocked_by.empty()) return say(k_way_narrow, place, door);
  std::string names;
  for (const int body : way.blocked_by)
    names += (names.empty() ? "" : ", ") + setup.model.bodies[static_cast<std::size_t>(body)].name;
  return way.caught ? say(k_way_caught, place, names) : say(k_way_blocked, place, door, width, names);
}

}  // namespace

void add_hits(const Setup& setup, const io::FrameRow& row, std::vector<PlaceOutcome>& hits) {
  hits.resize(setup.room.places.size());
  if (!hits.empty()) observe_hits(setup.room, setup.model, nodes_of(setup.model, row), row.time, hits);
}

WaysInWords ways_in_words(const Setup& setup, const io::FrameRow& row, std::span<const PlaceOutcome> hits) {
  const Room& room = setup.room;
  WaysInWords out;
  if (room.places.empty()) return out;
  out.lines = {say(k_ways, fmt::format("{:g}", room.person))};
  const RoomPlan plan = room_plan(room, setup.model, nodes_of(setup.model, row));
  const std::vector<Way> found = ways(room, plan);
  for (std::size_t p = 0; p < found.size(); ++p) {
    out.lines.push_back(line_of(setup, plan, p, found[p]));
    if (!found[p].open && found[p].door >= 0) out.harms.push_back(out.lines.back());
    for (const PlaceOutcome::Hit& hit : p < hits.size() ? hits[p].hits : std::vector<PlaceOutcome::Hit>())
      if (hit.time <= row.time) {
        out.lines.push_back(say(k_way_hit, room.places[p].name,
                                setup.model.bodies[static_cast<std::size_t>(hit.body)].name,
                                fmt::format("{:.1f}", hit.time)));
        out.harms.push_back(out.lines.back());
      }
  }
  return out;
}

}  // namespace topple::app
