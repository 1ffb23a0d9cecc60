// How the window looks to one person, and where that is kept.
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

/// The next larger (1) or smaller (-1) scale of a person's steps; 0: the usual one.
double next_scale(double scale, int direction);

/// With letters no larger than a window of width x height px has room for, at least 640 x 360 px at scale 1
/// times `desktop_scale`, and one of a person's steps; never smaller than usual for that. A size of 0 or less
/// is not known yet.
Appearance fitting(Appearance appearance, float desktop_scale, float width, float height);

/// "$XDG_CONFIG_HOME/topple/settings"; empty when there is no place for it.
std::filesystem::path settings_file();
/// What is kept there; of what is not, the usual, in the language of the locale. A line that says what cannot
/// be understood is left in `warning`.
Appearance read_appearance(const std::filesystem::path& file, std::string& warning);
/// Throws std::runtime_error.
void keep_appearance(const std::filesystem::path& file, const Appearance& appearance);

/// Letters for texts in the language of the window and for the names in a scene; null: none.
render::Letters window_letters(const io::Scene* scene);

}  // namespace topple::app
