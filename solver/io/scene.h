// Scene files: TOML text to Setup. Contract: interface 2.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "solver/run.h"

namespace topple::io {

/// Bad input. what() is one line, ready to print: "scene.toml:14:9: contact.friction: 2.4 is outside 0..1.5".
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// What theory or print says about a number of the summary.
struct Expectation {
  std::string name;
  std::string value;  ///< JSON pointer into the summary: "/probes/0/final/displacement_m/2"
  double reference = 0;
  double tolerance = 0;  ///< largest |value - reference|/scale
  double scale = 1;      ///< > 0, |reference| unless given
  std::string source;    ///< of the reference
  std::string reason;    ///< why this tolerance
  std::string place;     ///< begin of an error line on `value`: "s.toml:9:9: expect.tip.value: "
};

/// A file that a scene names, such as an accelerogram.
struct SceneFile {
  std::string name;  ///< as the scene writes it
  std::string bytes;
};

/// Gives the bytes of a file that a scene names. Throws InputError with what is wrong with it.
using ReadSceneFile = std::function<std::string(const std::string& name)>;

/// A scene file understood.
struct Scene {
  std::string name;  ///< "paper-a": built-in name, or the file's name without folder and extension
  std::string title;
  std::string text;              ///< the TOML that describes it, overrides applied: what a recording keeps
  std::vector<SceneFile> files;  ///< that it names, each once: what a recording keeps beside the text
  Setup setup;
  std::vector<Expectation> expectations;
};

/// Loads a built-in scene by name or a file by path; a path wins when the file exists. `overrides`:
/// "KEY=VALUE" as of --set. Throws InputError.
Scene load_scene(const std::string& path_or_name, const std::vector<std::string>& overrides = {});

/// The same from text; `origin` is what error lines call it. Without `read`, the files that the scene names
/// are sought beside `origin`, then among the built-in records.
Scene parse_scene(std::string_view text, const std::string& origin,
                  const std::vector<std::string>& overrides = {}, const ReadSceneFile& read = {});

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

/// Synthetic accelerograms (assets/records), name and text; scenes name them as files.
const std::vector<BuiltinScene>& builtin_records();

}  // namespace topple::io
