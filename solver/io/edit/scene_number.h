// One number of a scene by its dotted key.
#pragma once

#include <optional>
#include <string>

#include "solver/io/scene/scene.h"
#include "solver/io/scene/scene_keys.h"

namespace topple::io {

/// Where a dotted key leads.
struct SceneNumber {
  const Key* key;               ///< not null
  int entry;                    ///< index in the outermost array on the way; -1: there is none
  std::optional<double> value;  ///< SI, of the scene or value_left_out
};

/// `key` is run.time_step, and the step follows the contact (time_step = "auto").
bool is_step_chosen(const Scene& scene, const Key& key);

/// SI, what the scene takes for a key of one number that it leaves out: its default, or what follows from its
/// bodies (contact.alpha, contact.member_share). None: it has none, or is_step_chosen.
std::optional<double> value_left_out(const Scene& scene, const Key& key);

/// `path`: as of --set. Throws InputError when the scene has no such place, or no number can stand there.
SceneNumber number_in(const Scene& scene, const std::string& path);

}  // namespace topple::io
