#include "app/window/status_line.h"

#include <algorithm>
#include <cmath>

#include "app/picture/window_words.h"
#include "app/support/terms.h"

namespace topple::app {

using namespace window_words;

namespace {

constexpr double k_kept_up = 0.8;       // of the speed that is asked for, from which nobody waits
constexpr double k_least_known = 1e-3;  // times real time, below which no end can be told

std::string running_in_words(const Player& player) {
  const double asked = player.speed(), achieved = player.status().achieved;
  if (achieved < k_least_known || achieved > k_kept_up * asked) return say(k_running, asked, achieved);
  const double seconds = std::ceil((player.length() - player.time()) / achieved);
  const std::string left = seconds < 120 ? say(k_seconds, seconds) : say(k_minutes, std::ceil(seconds / 60));
  return say(k_running_slow, asked, achieved, left);
}

bool is_restarted(const Player& player) {
  const std::vector<Branch>& branches = player.history().branches;
  const auto shown = std::ranges::find(branches, player.shown_branch(), &Branch::id);
  return player.ghost_branch() && shown != branches.end() && shown->fork_step == 0 && player.row()->step == 0;
}

std::string joined(const std::vector<Said>& warnings) {
  std::string out;
  for (const Said& warning : warnings)
    out += (out.empty() ? "" : say(k_semicolon)) + in_language(window_language(), warning);
  return out;
}

std::string paused_in_words(const Player& player) {
  return is_restarted(player) ? say(k_restarted, player.shown_branch(), *player.ghost_branch())
                              : say(k_paused);
}

}  // namespace

std::string status_in_words(const Player& player) {
  const LiveStatus& status = player.status();
  const bool loads = is_static(player.scene().setup);
  switch (status.kind) {
    case LiveStatus::Kind::starting:
      return say(k_settling);
    case LiveStatus::Kind::reading:
      return say(k_reading);
    case LiveStatus::Kind::ended:
      return say(k_ended, status.message);
    case LiveStatus::Kind::returning:
      return say(k_returning);
    case LiveStatus::Kind::failed:
      if (player.at_head()) return say(k_stopped, status.message);
      break;
    case LiveStatus::Kind::over:
      if (player.at_head())
        return (loads ? say(k_loads_done) : say(k_run_ended, player.time())) + say(k_after_end) +
               (status.warnings.empty() ? "" : say(k_warns, joined(status.warnings)));
      break;
    default:
      break;
  }
  if (player.way().empty()) return status.message.empty() ? say(k_no_instants) : status.message;
  if (player.at_head())
    return !player.playing() ? paused_in_words(player)
           : loads           ? say(k_running_loads)
                             : running_in_words(player);
  std::string words = say(player.replay() ? k_recording : k_looking_back);
  if (player.playing()) words += loads ? say(k_played) : say(k_played_at, player.speed());
  if (!status.message.empty() && status.kind != LiveStatus::Kind::over)
    return say(k_says, words, status.message);
  return say(player.replay() ? k_can_branch : k_can_branch_or_return, words);
}

}  // namespace topple::app
