#include "app/panels/ways_lines.h"

#include <fmt/format.h>

#include <cmath>

#include "app/panels/ways_words.h"
#include "app/picture/row.h"
#include "solver/run/ways.h"

namespace topple::app {
namespace {

using namespace window_words;

constexpr double k_follow = 0.25;  // s

std::vector<Vec3> nodes_of(const Model& model, const io::FrameRow& row) {
  std::vector<Vec3> nodes;
  for (int n = 0; n < model.node_total(); ++n) nodes.push_back(position(row, n));
  return nodes;
}

std::string line_of(const Setup& setup, const RoomPlan& plan, std::size_t p, const Way& way) {
  const Room& room = setup.room;
  const std::string& place = room.places[p].name;
  if (way.door < 0) return say(k_way_no_door, place);
  const std::string& door = room.doors[static_cast<std::size_t>(way.door)].name;
  const std::string width = fmt::format("{:.2f}", way.widest);
  if (way.open) {
    const auto line = shortest_way(room, plan, static_cast<int>(p), way.door);
    return say(k_way_open, place, door, width, line ? fmt::format("{:.1f}", line->length) : "-");
  }
  if (way.blocked_by.empty()) return say(k_way_narrow, place, door);
  std::string names;
  for (const int body : way.blocked_by)
    names += (names.empty() ? "" : ", ") + setup.model.bodies[static_cast<std::size_t>(body)].name;
  return say(k_way_blocked, place, door, width, names);
}

}  // namespace

void WaysLines::follow_hits(const Player& player) {
  const Setup& setup = player.scene().setup;
  const std::vector<RowPtr>& way = player.way();
  if (rows_ > way.size() || rows_ == 0 || way.front() != first_ || way[rows_ - 1] != last_) {
    rows_ = 0;
    hits_.assign(setup.room.places.size(), {});
  }
  for (; rows_ < way.size(); ++rows_)
    observe_hits(setup.room, setup.model, nodes_of(setup.model, *way[rows_]), way[rows_]->time, hits_);
  if (way.empty()) return;
  first_ = way.front();
  last_ = way.back();
}

const std::vector<std::string>& WaysLines::of(const Player& player, const io::FrameRow& row) {
  const Setup& setup = player.scene().setup;
  const Room& room = setup.room;
  if (room.places.empty()) return lines_;
  const bool same = row.branch == branch_ && row.time == time_;
  const bool near = row.branch == branch_ && player.playing() && std::abs(row.time - time_) < k_follow;
  if (same || near) return lines_;
  branch_ = row.branch;
  time_ = row.time;
  follow_hits(player);
  lines_ = {say(k_ways, fmt::format("{:g}", room.person))};
  harms_.clear();
  const RoomPlan plan = room_plan(room, setup.model, nodes_of(setup.model, row));
  const std::vector<Way> found = ways(room, plan);
  for (std::size_t p = 0; p < found.size(); ++p) {
    lines_.push_back(line_of(setup, plan, p, found[p]));
    if (!found[p].open && found[p].door >= 0) harms_.push_back(lines_.back());
    for (const PlaceOutcome::Hit& hit : hits_[p].hits)
      if (hit.time <= row.time) {
        lines_.push_back(say(k_way_hit, room.places[p].name,
                             setup.model.bodies[static_cast<std::size_t>(hit.body)].name,
                             fmt::format("{:.2f}", hit.time)));
        harms_.push_back(lines_.back());
      }
  }
  return lines_;
}

}  // namespace topple::app
