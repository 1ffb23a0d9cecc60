#include "app/cli/misuse.h"

#include <CLI/CLI.hpp>
#include <string_view>
#include <vector>

#include "app/support/errors.h"
#include "solver/io/common/nearest_name.h"

namespace topple::app {
namespace {

std::string nearest_option(const CLI::App& table, const std::string& name) {
  std::vector<std::string> known;
  const auto add = [&](const CLI::App& owner) {
    for (const CLI::Option* option : owner.get_options({}))
      known.insert(known.end(), option->get_lnames().begin(), option->get_lnames().end());
  };
  for (const CLI::App* command : table.get_subcommands()) {
    add(*command);
    for (const CLI::App* group : command->get_subcommands({})) add(*group);
  }
  return io::nearest_name(name, known);
}

/// Empty: all are known.
std::string unknown_option(const CLI::App& table) {
  for (const std::string& word : table.remaining(true)) {
    if (!word.starts_with('-') || word == "-" || word == "--") continue;
    const std::string option = word.substr(0, word.find('='));
    std::string name = option;
    name.erase(0, name.find_first_not_of('-'));
    const std::string near = nearest_option(table, name);
    return "unknown option " + option + (near.empty() ? "" : "; the nearest is --" + near);
  }
  return "";
}

/// CLI11's sentences on the number of values say little: "--json: 1 required FILE|- missing". Those on lists
/// of words, "--lang: de not in {en,ja}", are worded as others on values.
std::string in_words(const CLI::ParseError& error) {
  std::string text = error.what();
  constexpr std::string_view list = " not in {";
  if (const std::size_t end = text.rfind(list); end != std::string::npos && text.ends_with('}')) {
    const std::size_t begin = text.find(": ") + 2;
    std::string known;
    for (const char letter : text.substr(end + list.size())) {
      if (letter != '}') known += letter;
      if (letter == ',') known += ' ';
    }
    return text.substr(0, begin) + "\"" + text.substr(begin, end - begin) + "\" is not one of " + known;
  }
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) == nullptr) return text;
  const std::string option = text.substr(0, text.find(':'));
  if (text.find("At Most 1") != std::string::npos) return option + ": given more than once";
  constexpr std::string_view before = ": 1 required ", after = " missing";
  const std::size_t begin = text.find(before), end = text.rfind(after);
  if (begin == std::string::npos || end == std::string::npos) return text;
  return option + ": needs a value, " + text.substr(begin + before.size(), end - begin - before.size());
}

}  // namespace

void refuse_unknown_command(const CLI::App& table, int argc, char** argv) {
  if (argc < 2) return;
  const std::string first = argv[1];
  if (first.rfind('-', 0) == 0) {
    if (first == "-h" || first == "--help" || first == "--version") return;
    throw BadInput(first + ": unknown option; a command comes first (topple --help)");
  }
  std::string known;
  for (const CLI::App* command : table.get_subcommands({})) {
    if (command->get_name() == first) return;
    known += (known.empty() ? "" : ", ") + command->get_name();
  }
  throw BadInput("\"" + first + "\" is not a command; known: " + known + " (topple --help)");
}

std::string misuse(const CLI::App& table, const CLI::ParseError& error) {
  const std::string unknown = unknown_option(table);
  return unknown.empty() ? in_words(error) : unknown;
}

}  // namespace topple::app
