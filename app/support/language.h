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

inline std::string_view in_language(Language language, const Phrase& phrase) {
  return language == Language::english ? phrase.english : phrase.japanese;
}
template <class Of>
const Of& in_language(Language, const Of& of) {
  return of;
}

/// What was said, in each language.
struct Said {
  std::string english, japanese;
  bool operator==(const Said&) const = default;
};
inline const std::string& in_language(Language language, const Said& words) {
  return language == Language::english ? words.english : words.japanese;
}
/// A phrase of what is the same in each language, or itself a phrase.
template <class... Of>
Said said(const Phrase& phrase, const Of&... of) {
  return {say_in(Language::english, phrase, in_language(Language::english, of)...),
          say_in(Language::japanese, phrase, in_language(Language::japanese, of)...)};
}

}  // namespace topple::app
