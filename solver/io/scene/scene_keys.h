// Every key of a scene file: type, unit, range, default and meaning, in one table. The checks, the reference
// in assets/guide/scene-reference.md and the app's sliders are driven by it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "solver/io/scene/scene_key.h"

namespace topple::io {

/// The table, in the order of the reference.
const std::vector<Key>& scene_keys();

/// Tables of which a [[furniture]] becomes an entry.
inline constexpr std::string_view k_furniture_bodies[] = {"cabinet", "frame", "block"};

/// Null when there is no such key. Of "furniture" also one of a body that it may become.
const Key* find_key(std::string_view table, std::string_view name);

/// "0..1.5", "0.001..1e+06 kgf".
std::string range_text(const Key& key);

/// A value in the key's unit: "0.6", "50 kgf".
std::string value_text(const Key& key, double si);

/// "0.6", "50 kgf", "[0, 0, -9.80665] m/s^2", "coulomb", "true"; empty without default.
std::string default_text(const Key& key);

/// The table as Markdown: assets/guide/scene-reference.md.
std::string scene_reference();

}  // namespace topple::io
