// Languages of what the program shows. Phrases stand in tables: report_words.h, window_words.h.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace topple::app {

enum class Language { english, japanese };

/// One thing said in each language; {0}, {1} ... are what it is said of.
struct Phrase {
  std::string_view english, japanese;
};

/// The phrase in one language.
template <class... Of>
std::string say_in(Language language, const Phrase& phrase, const Of&... of) {
  return fmt::format(fmt::runtime(language == Language::english ? phrase.english : phrase.japanese), of...);
}

}  // namespace topple::app
