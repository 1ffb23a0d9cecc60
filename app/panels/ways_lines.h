// The way out at the instant shown, in lines of text.
#pragma once

#include "app/live/player.h"
#include "app/picture/ways_in_words.h"
#include "app/support/language.h"

namespace topple::app {

/// Kept until another instant is shown; while a run plays they follow twice per simulated second.
class WaysLines {
 public:
  /// None: the scene has no places.
  const std::vector<std::string>& of(const Player& player, const io::FrameRow& row) {
    return at(player, row).lines;
  }
  const std::vector<std::string>& harms(const Player& player, const io::FrameRow& row) {
    return at(player, row).harms;
  }

 private:
  const WaysInWords& at(const Player& player, const io::FrameRow& row);

  WaysInWords words_;
  std::int32_t branch_ = -1;
  Language language_ = Language::english;
  double time_ = -1;  // s, of the words
};

}  // namespace topple::app
