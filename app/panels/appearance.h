// Scale, theme and language of the window, and the file that keeps them.
#pragma once

#include <filesystem>
#include <string>

#include "app/support/language.h"
#include "render/scene/font.h"
#include "solver/io/scene/scene.h"

namespace topple::app {

inline constexpr double k_least_scale = 0.75, k_most_scale = 3;

struct Appearance {
  double scale = 1;  ///< of letters and panels, k_least_scale..k_most_scale
  bool dark = false;
  Language language = Language::english;
  bool operator==(const Appearance&) const = default;
};

/// The next larger (1) or smaller (-1) of the scales that can be chosen; 0: the default one.
double next_scale(double scale, int direction);

/// `appearance` with its scale limited to the largest one for which a window of width x height px has room
/// (640 x 360 px times scale and `desktop_scale`), but not to less than 1. Unchanged for a size of 0 or less:
/// it is not known yet.
Appearance fitting(Appearance appearance, float desktop_scale, float width, float height);

/// "$XDG_CONFIG_HOME/topple/settings"; empty when there is no place for it.
std::filesystem::path settings_file();
/// What is kept there, with defaults for the rest and the language of the locale. `warning`: a line about
/// what cannot be understood; unchanged where all can.
Appearance read_appearance(const std::filesystem::path& file, std::string& warning);
/// Throws std::runtime_error.
void keep_appearance(const std::filesystem::path& file, const Appearance& appearance);

/// Characters for texts in the language of the window and for the names in a scene; null: none.
render::Letters window_letters(const io::Scene* scene);

}  // namespace topple::app
