#include "app/panels/computed.h"

#include <algorithm>
#include <set>

#include "app/picture/window_words.h"
#include "app/support/integrators.h"
#include "solver/body/model_level.h"
#include "solver/frame/integrator.h"

namespace topple::app {

using namespace window_words;

namespace {

std::string moved_by(const Player& player, ModelLevel level) {
  const Parameters& parameters = player.parameters();
  const Phrase* const own =
      model_words::moved_by(level, moves_otherwise(level, player.scene().setup.model, parameters));
  return say(own == nullptr ? phrase_of_choice(traits(parameters.integrator).word) : *own);
}

}  // namespace

std::optional<double> step_taken(const Player& player) {
  const std::vector<RowPtr>& way = player.way();
  const std::optional<io::FrameRow> now = player.row();
  if (!now || way.size() < 2) return std::nullopt;
  const auto earlier = [](const RowPtr& row, double time) { return row->time < time; };
  const auto at = std::lower_bound(way.begin() + 1, way.end() - 1, now->time, earlier);
  auto before = at - 1;  // a step may be longer than the frames are apart
  while (before != way.begin() && (*before)->step == (*at)->step) --before;
  const std::int64_t steps = (*at)->step - (*before)->step;
  if (steps <= 0) return std::nullopt;
  return ((*at)->time - (*before)->time) / static_cast<double>(steps);
}

std::string computed_in_words(const Player& player, std::size_t body) {
  const std::optional<io::FrameRow> now = player.row();
  if (!now) return "";
  const auto level = static_cast<ModelLevel>(now->level[body]);
  LevelReason reason =
      base_level(player.scene().setup.model, player.parameters(), static_cast<int>(body)).reason;
  for (const io::RecordedEvent& event : player.events())
    if (event.event.kind == Event::Kind::model && event.event.body == static_cast<int>(body) &&
        event.time <= now->time)
      reason = event.event.reason;
  return say(k_computed_now, say(phrase_of(level)), say(phrase_of(reason)), moved_by(player, level));
}

std::string integrators_in_words(const Player& player) {
  const std::optional<io::FrameRow> now = player.row();
  if (!now) return "";
  const std::set<std::uint8_t> levels(now->level.begin(), now->level.end());
  const bool as_chosen = !moves_otherwise(ModelLevel::frame, player.scene().setup.model, player.parameters());
  if (as_chosen && levels == std::set{static_cast<std::uint8_t>(ModelLevel::frame)}) return "";
  std::string all;
  for (const std::uint8_t level : levels)
    all += (all.empty() ? "" : "; ") + moved_by(player, static_cast<ModelLevel>(level));
  return say(k_integrators_now, all);
}

}  // namespace topple::app
