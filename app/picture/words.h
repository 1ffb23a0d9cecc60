// What is happening, in words.
#pragma once

#include <string>
#include <vector>

#include "solver/io/recording/observer.h"
#include "solver/io/scene/scene.h"
#include "solver/run/run.h"

namespace topple::app {

/// title_in (titles.h) in the language of the window.
std::string in_window_language(const std::string& title);

/// The scene's title; with `parameters` that were changed since, or of a run that was `changed` on its way,
/// "A cabinet under 190 gal (changed)".
std::string title_in_words(const io::Scene& scene, const Parameters& parameters, bool changed = false);

/// "free: leans 4.2° of 10.9°". gravity: m/s^2.
std::string body_in_words(const Model& model, const Vec3& gravity, const io::FrameRow& row, std::size_t body);

/// One line for each of the furniture; of many, for those that tilt most of what they can, and one that
/// counts the others.
std::vector<std::string> bodies_in_words(const Model& model, const Vec3& gravity, const io::FrameRow& row);

/// The most lines that bodies_in_words() has in a run.
int most_lines_of_bodies(const Model& model);

/// "strap" in the language of the window.
std::string anchor_type_in_words(const Anchor& anchor);

/// "strap left: pulls 430 N, 22 % of its strength".
std::string anchor_in_words(const Model& model, const io::FrameRow& row, std::size_t anchor);

/// One line for each of a few anchors, else one that counts them.
std::vector<std::string> anchors_in_words(const Model& model, const io::FrameRow& row);

/// "t = 1.23 s"; of a static run "load step 12 of 40, load factor 3.42".
std::string instant_in_words(const Setup& setup, const io::FrameRow& row);

/// "floor: 0.5 Hz, 190 gal" of the first shake, with when it begins or ended; empty without one.
std::string shake_in_words(const Parameters& parameters, double t);

}  // namespace topple::app
