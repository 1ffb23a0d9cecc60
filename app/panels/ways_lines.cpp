#include "app/panels/ways_lines.h"

#include <cmath>

namespace topple::app {
namespace {

constexpr double k_follow = 0.5;  // s

}  // namespace

const WaysInWords& WaysLines::at(const Player& player, const io::FrameRow& row) {
  const bool kept = row.branch == branch_ && language_ == window_language();
  const bool same = kept && row.time == time_;
  const bool near = kept && player.playing() && std::abs(row.time - time_) < k_follow;
  if (same || near) return words_;
  branch_ = row.branch;
  language_ = window_language();
  time_ = row.time;
  return words_ = ways_in_words(player.scene().setup, row, player.extent().hits);
}

}  // namespace topple::app
