#include "app/cli/manual.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <sstream>
#include <vector>

#include "solver/io/scene/scene.h"

namespace topple::app {
namespace {

/// Of one command: values without a name first, then options, those of its groups included; not --help, which
/// all have.
std::vector<const CLI::Option*> options_of(const CLI::App& command) {
  std::vector<const CLI::Option*> all = command.get_options({});
  for (const CLI::App* group : command.get_subcommands({}))
    for (const CLI::Option* option : group->get_options({})) all.push_back(option);
  std::erase_if(all, [](const CLI::Option* option) { return option->check_lname("help"); });
  std::stable_partition(all.begin(), all.end(), [](const CLI::Option* o) { return o->get_positional(); });
  return all;
}

void replace_all(std::string& text, const std::string& what, const std::string& with) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + with.size()))
    text.replace(at, what.size(), with);
}

/// Text as roff shows it: hyphens that can be copied, no requests at the starts of lines.
std::string roff(std::string text) {
  replace_all(text, "\\", "\\e");
  replace_all(text, "-", "\\-");
  replace_all(text, "\n", "\n\\&");
  return "\\&" + text;
}

bool takes_value(const CLI::Option& option) {
  return option.get_items_expected_max() > 0;
}

std::string option_head(const CLI::Option& option) {
  if (option.get_positional()) return "\\fI" + roff(option.get_name(true)) + "\\fR";
  std::string head;
  for (const std::string& name : option.get_snames()) head += "\\fB" + roff("-" + name) + "\\fR, ";
  for (const std::string& name : option.get_lnames()) head += "\\fB" + roff("--" + name) + "\\fR";
  return head + (takes_value(option) ? " \\fI" + roff(option.get_type_name()) + "\\fR" : "");
}

std::string command_section(const CLI::App& command) {
  std::string usage, list;
  for (const CLI::Option* option : options_of(command)) {
    if (option->get_positional())
      usage += (option->get_required() ? option_head(*option) : "[" + option_head(*option) + "]") + " ";
    list += ".TP\n" + option_head(*option) + "\n" + roff(option->get_description()) + "\n";
  }
  // "Example:\n  topple run ..."
  std::string example = command.get_footer();
  example.erase(0, example.find('\n') + 1);
  return ".SS topple " + command.get_name() + "\n.B topple " + command.get_name() + "\n" + usage +
         "[\\fIOPTIONS\\fR]\n.PP\n" + roff(command.get_description()) + ".\n" + list +
         ".PP\nExample:\n.EX\n" + roff(example) + "\n.EE\n";
}

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands({});
}

/// The single words of a list at the beginning of a description: "front, side or iso (default): where from".
std::string listed_words(std::string text) {
  text.resize(std::min(text.find(':'), text.size()));
  for (const char* between : {" (default)", ",", " or "}) replace_all(text, between, "\n");
  std::istringstream pieces(text);
  std::string words;
  for (std::string piece; std::getline(pieces, piece);) {
    piece.erase(0, piece.find_first_not_of(' '));
    if (!piece.empty() && piece.find(' ') == std::string::npos) words += (words.empty() ? "" : " ") + piece;
  }
  return words;
}

/// The bash command that completes a value of the option; empty: nothing does.
std::string bash_value(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  for (const char* listed : {"NAME", "LANGUAGE", "QUANTITY", "RANGE", "SPAN"})
    if (type == listed) return "_topple_words '" + listed_words(option.get_description()) + "'";
  if (type == "DIR") return "_filedir -d";
  if (const std::size_t dot = type.rfind('.'); dot != std::string::npos)
    return "_filedir " + type.substr(dot + 1);
  return type.find("FILE") != std::string::npos ? "_filedir" : "";
}

/// "run:-o|run:--output"
std::string bash_pattern(const std::string& command, const CLI::Option& option) {
  std::string patterns;
  for (const std::string& name : option.get_snames()) patterns += "|" + command + ":-" + name;
  for (const std::string& name : option.get_lnames()) patterns += "|" + command + ":--" + name;
  return patterns.substr(1);
}

/// The words that a description explains: "one: what it is; two: what it is" gives "one two".
std::string explained_words(const std::string& description) {
  std::string words;
  for (std::size_t begin = 0; begin < description.size();) {
    const std::size_t end = std::min(description.find("; ", begin), description.size());
    words += (words.empty() ? "" : " ") + description.substr(begin, description.find(':', begin) - begin);
    begin = end + 2;
  }
  return words;
}

/// Completes a value without an option's name: the scenes that are built in, folders, files of what is read.
std::string bash_positional(const CLI::Option& option) {
  const std::string name = option.get_name();
  if (name == "RECORDING") return "_filedir h5; ";
  if (name == "DATA") return "_filedir -d; ";
  return std::string("_topple_words \"$scenes\"; _filedir ") +
         (name.starts_with("SCENE") ? "toml; " : "'@(toml|h5)'; ");
}

/// The same of all of a command. What follows a KIND is completed when it has been given.
std::string bash_positionals(const CLI::App& command) {
  std::string kinds, rest;
  for (const CLI::Option* option : options_of(command)) {
    if (!option->get_positional()) continue;
    if (option->get_name() == "KIND")
      kinds = explained_words(option->get_description());
    else if (const std::string one = bash_positional(*option); rest.find(one) == std::string::npos)
      rest += one;
  }
  if (kinds.empty()) return rest;
  return fmt::format("if _topple_given '{0}'; then {1}else _topple_words '{0}'; fi; ", kinds, rest);
}

}  // namespace

std::string manual_page(const CLI::App& app, std::string frame) {
  std::string commands;
  for (const CLI::App* command : commands_of(app)) commands += command_section(*command);
  replace_all(frame, "@VERSION@", TOPPLE_VERSION);
  replace_all(frame, "@COMMANDS@\n", commands);
  return frame;
}

std::string bash_completion(const CLI::App& app) {
  std::string scenes, commands, values, without, rest;
  for (const io::BuiltinScene& scene : io::builtin_scenes()) scenes += std::string(scene.name) + " ";
  for (const CLI::App* command : commands_of(app)) {
    const std::string name = command->get_name();
    commands += name + " ";
    std::string options = "--help";
    for (const CLI::Option* option : options_of(*command)) {
      if (option->get_positional()) continue;
      for (const std::string& long_name : option->get_lnames()) options += " --" + long_name;
      if (!takes_value(*option)) continue;
      const std::string pattern = bash_pattern(name, *option), value = bash_value(*option);
      if (value.empty())
        without += "|" + pattern;
      else
        values += fmt::format("    {}) {}; return ;;\n", pattern, value);
    }
    rest += fmt::format("    {}) if [[ $cur == -* ]]; then _topple_words '{}'; else {}:; fi ;;\n", name,
                        options, bash_positionals(*command));
  }
  return fmt::format(R"(# bash completion for topple, made from the program's own table of commands
_topple_words() {{ COMPREPLY+=($(compgen -W "$1" -- "$cur")); }}
_topple_given() {{
  local word
  for word in "${{words[@]:2:cword-2}}"; do [[ " $1 " == *" $word "* ]] && return; done
  return 1
}}
_topple() {{
  local cur prev words cword
  local scenes='{}'
  _init_completion -n = || return
  if ((cword == 1)); then
    _topple_words '{}--help --version'
    return
  fi
  case ${{words[1]}}:$prev in
{}    {}) return ;;
  esac
  case ${{words[1]}} in
{}  esac
}}
complete -F _topple topple
)",
                     scenes, commands, values, without.substr(1), rest);
}

}  // namespace topple::app
