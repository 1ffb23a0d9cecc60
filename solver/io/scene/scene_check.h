// Checks of a scene's tree against the table of keys.
#pragma once

#include <string>

#include "solver/io/document/scene_document.h"

namespace topple::io {

/// Refuses what the table of keys does not allow: unknown and unsupported keys, wrong types, dimensions,
/// values out of range, keys of a choice that was not made, missing keys, names used twice. Tables are
/// checked in the order of the file, within a table the choices first. Throws InputError.
void check_scene(const Node& root, const std::string& origin);

/// Name of entry `index` of a kind: its `name`, else "cabinet-2".
std::string entry_name(const Node& list, std::string_view kind, std::size_t index);

}  // namespace topple::io
