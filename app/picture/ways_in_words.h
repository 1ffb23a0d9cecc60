// People at an instant, in lines of text: their ways out, and who hits them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "solver/io/recording/observer.h"
#include "solver/run/place_hits.h"
#include "solver/run/run.h"

namespace topple::app {

/// Lines of harms in a picture.
inline constexpr std::size_t k_most_harms = 4;

struct WaysInWords {
  std::vector<std::string> lines;  ///< none: the scene has no places
  std::vector<std::string> harms;  ///< those of them that tell of harm: who is hit, who has no way out
};

/// `hits`: one per place, of the whole run.
WaysInWords ways_in_words(const Setup& setup, const io::FrameRow& row, std::span<const PlaceOutcome> hits);

/// Takes in who is hit at a row; `hits` becomes as long as there are places.
void add_hits(const Setup& setup, const io::FrameRow& row, std::vector<PlaceOutcome>& hits);

}  // namespace topple::app
