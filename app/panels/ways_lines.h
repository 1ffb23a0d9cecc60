// The way out at the instant shown, in lines of text.
#pragma once

#include <string>
#include <vector>

#include "app/live/player.h"
#include "solver/run/place_hits.h"

namespace topple::app {

/// Kept until another instant is shown; while a run plays they follow four times per simulated second.
class WaysLines {
 public:
  /// None: the scene has no places.
  const std::vector<std::string>& of(const Player& player, const io::FrameRow& row);
  /// Those of them that tell of harm: who is hit, who has no way out.
  const std::vector<std::string>& harms(const Player& player, const io::FrameRow& row) {
    of(player, row);
    return harms_;
  }

 private:
  void follow_hits(const Player& player);

  std::vector<std::string> lines_, harms_;
  std::int32_t branch_ = -1;
  double time_ = -1;  // s, of the lines
  std::vector<PlaceOutcome> hits_;
  std::size_t rows_ = 0;  // of Player::way() that are in the hits
  RowPtr first_, last_;   // of them
};

}  // namespace topple::app
