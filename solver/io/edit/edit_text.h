// Edits of a running simulation in the words of a scene: their names, and what they may set.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "solver/io/scene/scene_keys.h"
#include "solver/run/edit.h"

namespace topple::io {

/// "shake.1.amplitude", "contact.alpha", "anchor.1.on", "run.time_step": the path in the scene; shakes and
/// anchors count from 1. "body.1.model", "body.1.damping": of a cabinet, a frame or a copy of one, in the
/// order of Model::bodies. "node.12.pull": nodes count from 1 through all bodies.
std::string edit_key(const Edit& edit);

/// The same as a scene has it: "fixing.2.on" of an anchor that a [[fixing]] stands for.
std::string scene_key(const Edit& edit, const Model& model);

/// Inverse of edit_key, its value zero. Nothing when no edit is called so.
std::optional<Edit> parse_edit_key(std::string_view text);

/// The row of the table of keys, or of a pull, which no scene has: range, unit and default.
const Key& key_of(Edit::Key key);

/// The word of a choice by its number (Edit); null: it has none.
const std::string_view* choice_of(const Key& key, double number);

/// How a value is written.
enum class EditSpelling {
  shown,    ///< for people: newmark, [motion, stress], 50 kgf, to six digits
  in_scene  ///< TOML that reads back the same: "newmark", ["motion", "stress"], "50 kgf"
};

/// The value of an edit that check_edit_value() passes, in the words and the unit of its key.
std::string edit_value_text(const Edit& edit, EditSpelling spelling);

/// Refuses a value that is not finite, out of range, no choice or no direction. Throws InputError with one
/// line: "contact.friction: 2.4 is outside 0..1.5".
void check_edit_value(const Edit& edit);

/// The same, and refuses an edit of what a run with these parameters does not have, such as a shake that does
/// not exist. An edit that passes can be applied. Throws InputError.
void check_edit(const Edit& edit, const Parameters& parameters, const Model& model);

}  // namespace topple::io
