// A scene file understood.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "solver/io/common/errors.h"
#include "solver/run/run.h"

namespace topple::io {

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

}  // namespace topple::io
