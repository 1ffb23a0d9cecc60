#include "app/panels/appearance.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <fstream>
#include <string_view>

#include "app/panels/phrase_tables.h"
#include "app/picture/window_words.h"
#include "app/support/files.h"

namespace topple::app {
namespace {

namespace fs = std::filesystem;

constexpr double k_scales[] = {0.75, 0.9, 1, 1.1, 1.25, 1.5, 1.75, 2, 2.5, 3};

Language language_of_locale() {
  for (const char* const name : {"LC_ALL", "LC_MESSAGES", "LANG"})
    if (const char* const value = std::getenv(name); value && *value)
      return std::string_view(value).starts_with("ja") ? Language::japanese : Language::english;
  return Language::english;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  return first == text.npos ? "" : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// False: not one of the settings.
bool set(Appearance& appearance, std::string_view key, std::string_view value) {
  if (key == "scale") {
    double scale = 0;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), scale);
    if (error != std::errc() || end != value.data() + value.size() ||
        !(scale >= k_least_scale && scale <= k_most_scale))
      return false;
    appearance.scale = scale;
    return true;
  }
  if (key == "theme" && (value == "\"light\"" || value == "\"dark\"")) {
    appearance.dark = value == "\"dark\"";
    return true;
  }
  if (key == "language" && (value == "\"en\"" || value == "\"ja\"")) {
    appearance.language = value == "\"ja\"" ? Language::japanese : Language::english;
    return true;
  }
  return false;
}

}  // namespace

double next_scale(double scale, int direction) {
  if (direction == 0) return 1;
  if (direction > 0) {
    const auto* const larger = std::ranges::upper_bound(k_scales, scale);
    return larger == std::end(k_scales) ? k_most_scale : *larger;
  }
  const auto* const at = std::ranges::lower_bound(k_scales, scale);
  return at == std::begin(k_scales) ? k_least_scale : *(at - 1);
}

Appearance fitting(Appearance appearance, float desktop_scale, float width, float height) {
  constexpr float k_least_width = 640, k_least_height = 360;  // px
  if (!(width > 0) || !(height > 0)) return appearance;
  const double room = std::min(width / k_least_width, height / k_least_height) / desktop_scale;
  double largest = 1;
  for (const double scale : k_scales)
    if (scale <= room) largest = std::max(largest, scale);
  appearance.scale = std::min(appearance.scale, largest);
  return appearance;
}

fs::path settings_file() {
  const char* const config = std::getenv("XDG_CONFIG_HOME");
  const char* const home = std::getenv("HOME");
  if (config && *config == '/') return fs::path(config) / "topple/settings";
  return home && *home == '/' ? fs::path(home) / ".config/topple/settings" : fs::path();
}

Appearance read_appearance(const fs::path& path, std::string& warning) {
  Appearance appearance{.language = language_of_locale()};
  std::ifstream file(path);
  std::string text;
  for (int number = 1; std::getline(file, text); ++number) {
    const std::string_view line = trimmed(text);
    if (line.empty() || line[0] == '#') continue;
    const std::size_t equals = line.find('=');
    if (equals == line.npos ||
        !set(appearance, trimmed(line.substr(0, equals)), trimmed(line.substr(equals + 1))))
      warning = fmt::format(
          "{}:{}: \"{}\" is not understood; allowed are scale = {}..{}, theme = \"light\" or "
          "\"dark\", language = \"en\" or \"ja\"",
          path.string(), number, line, k_least_scale, k_most_scale);
  }
  return appearance;
}

void keep_appearance(const fs::path& path, const Appearance& appearance) {
  std::error_code error;
  fs::create_directories(path.parent_path(), error);  // what is wrong shows when the file is written
  write_whole_file(path, host::FileKind::any,
                   fmt::format("scale = {}\ntheme = \"{}\"\nlanguage = \"{}\"\n", appearance.scale,
                               appearance.dark ? "dark" : "light",
                               appearance.language == Language::japanese ? "ja" : "en"));
}

render::Letters window_letters(const io::Scene* scene) {
  const bool japanese = window_language() == Language::japanese;
  std::string text(window_words::k_japanese.japanese);
  if (scene) {
    const Model& model = scene->setup.model;
    text += scene->title + scene->name;
    for (const auto& body : model.bodies) text += body.name;
    for (const auto& member : model.members) text += member.name;
    for (const auto& anchor : model.anchors) text += anchor.name;
    for (const auto& section : model.sections) text += section.name;
    for (const auto& material : model.materials) text += material.name;
  }
  if (japanese) text += phrase_tables();
  return {.more = text, .needed = japanese};
}

}  // namespace topple::app
