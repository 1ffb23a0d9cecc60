// How a command adds itself to the command line, and the options that several have.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/support/language.h"

namespace topple::app {

/// The commands of one call.
struct Commands {
  CLI::App app{"Shows how furniture tips over when the floor shakes.", "topple"};
  std::function<int()> action;  ///< of the command that was called

  /// `example`: a call, without the program's name.
  CLI::App& add(const char* name, const char* about, const char* example, std::function<int()> carry_out);
  /// The same with options, which last as long as the command.
  template <class Options>
  std::pair<CLI::App&, Options&> add(const char* name, const char* about, const char* example,
                                     int (*carry_out)(const Options&)) {
    const auto options = std::make_shared<Options>();
    return {add(name, about, example, [options, carry_out] { return carry_out(*options); }), *options};
  }
};

/// Adds a command and its options; stands beside what the command does.
using AddCommand = void(Commands& commands);
AddCommand add_run, add_view, add_render, add_export, add_modes, add_verify, add_study, add_compare,
    add_report, add_validate, add_check, add_info, add_recover, add_scenes, add_furniture;
/// In the order of --help.
inline constexpr AddCommand* k_commands[] = {add_run,    add_view,  add_render,  add_export, add_modes,
                                             add_verify, add_study, add_compare, add_report, add_validate,
                                             add_check,  add_info,  add_recover, add_scenes, add_furniture};

/// A path or name, which may not be empty. `type` with an ending, "FILE.png": nor may it end as a picture,
/// video or page of another kind.
CLI::Option& add_path(CLI::App& command, const char* names, std::string& value, const char* type,
                      const std::string& about);
/// SCENE, required.
CLI::Option& add_scene(CLI::App& command, std::string& value);
/// --set
void add_set(CLI::App& command, std::vector<std::string>& overrides);
/// --json; `about`: "write the summary as JSON".
void add_json(CLI::App& command, std::string& value, const std::string& about);
/// --force
void add_force(CLI::App& command, bool& value);
/// --quiet
void add_quiet(CLI::App& command, bool& value);

/// Reads a text into a value, or says what is wrong with the text: "\"0\" is not a whole number in 1..4".
using Reader = std::function<std::string(const std::string& text)>;
/// An option that is read by `read`.
CLI::Option& add_read(CLI::App& command, const char* name, const char* type, Reader read,
                      const std::string& about);

/// The whole of `text` as a number.
template <typename Number>
std::optional<Number> number_in(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Into an int, or an optional one.
template <class Whole>
Reader whole_number(Whole& value, int least, int most) {
  return [&value, least, most](const std::string& text) {
    const std::optional<int> number = number_in<int>(text);
    if (!number || *number < least || *number > most)
      return fmt::format("\"{}\" is not a whole number in {}..{}", text, least, most);
    value = *number;
    return std::string();
  };
}
/// "5%" or "0.05", between both ends of 0..1.
Reader share(std::optional<double>& value);
Reader seconds(std::optional<double>& value);

/// --jobs
CLI::Option& add_jobs(CLI::App& command, std::optional<int>& value, const std::string& about);

/// An option that is one of a list of words, each of which stands for a value.
template <class Value, class Target>
CLI::Option& add_choice(CLI::App& command, const char* name, const char* type, Target& value,
                        const std::vector<std::pair<std::string, Value>>& words, const std::string& about) {
  const auto choose = [&value, words](const std::string& word) {
    value = std::ranges::find(words, word, &std::pair<std::string, Value>::first)->second;
  };
  return *command.add_option_function<std::string>(name, choose, about)
              ->type_name(type)
              ->check(CLI::IsMember(words).description(""));
}
/// --lang, into a Language or an optional one.
template <class Target>
void add_language(CLI::App& command, Target& value, const char* about) {
  add_choice<Language>(command, "--lang", "LANGUAGE", value,
                       {{"en", Language::english}, {"ja", Language::japanese}}, about);
}

}  // namespace topple::app
