// Scenes and accelerograms that the program brings along.
#pragma once

#include <string_view>
#include <vector>

namespace topple::io {

/// Name and text of each built-in scene, in alphabetical order.
struct BuiltinScene {
  std::string_view name;
  std::string_view text;
};
const std::vector<BuiltinScene>& builtin_scenes();
/// The same of those that `topple verify` runs, "verify/NAME".
const std::vector<BuiltinScene>& verification_scenes();
/// The same of the benchmarks of `topple study elements`, "elements/NAME".
const std::vector<BuiltinScene>& study_scenes();
/// The same of the kinds of furniture (furniture_kind.h), "bookshelf".
const std::vector<BuiltinScene>& builtin_furniture();

/// Synthetic accelerograms (assets/records), name and text; scenes name them as files.
const std::vector<BuiltinScene>& builtin_records();

}  // namespace topple::io
