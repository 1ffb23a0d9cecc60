// Texts of the window, in its languages.
#pragma once

#include "app/language.h"

namespace topple::app {

/// Of the window; English until another one is chosen.
inline Language& window_language() {
  static Language language = Language::english;
  return language;
}

/// The phrase in the language of the window.
template <class... Of>
std::string say(const Phrase& phrase, const Of&... of) {
  return say_in(window_language(), phrase, of...);
}

namespace window_words {}

}  // namespace topple::app
