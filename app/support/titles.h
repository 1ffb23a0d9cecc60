// Titles of scenes in the languages of the window.
#pragma once

#include <iterator>
#include <string>

#include "app/support/title_words.h"
#include "solver/io/document/scene_document.h"
#include "solver/math/ranges.h"

namespace topple::app {

/// The title of a built-in scene, also of one whose values were set, in a language; other titles as they are.
inline std::string title_in(Language language, const std::string& title) {
  const bool changed = title.ends_with(io::k_title_changed);
  const std::string plain = title.substr(0, title.size() - (changed ? io::k_title_changed.size() : 0));
  const auto* const known = ranges::find(title_words::k_titles, plain, &Phrase::english);
  const std::string shown = known == std::end(title_words::k_titles) ? plain : say_in(language, *known);
  return changed ? say_in(language, title_words::k_title_changed, shown) : shown;
}

}  // namespace topple::app
