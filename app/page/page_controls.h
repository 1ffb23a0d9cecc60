// What a live page lets its reader change: keys of the scene, with what is usual for each.
#pragma once

#include <string>
#include <vector>

#include "app/support/language.h"
#include "solver/io/scene/scene.h"

namespace topple::app {

/// A slider or a switch.
struct PageControl {
  enum class Kind { number, angle, toggle };
  Kind kind = Kind::number;
  std::string key = {};    ///< as of --set: "cabinet.free.mass"
  std::string group = {};  ///< name of what it belongs to; empty: `heading` alone says it
  Phrase heading = {};
  Phrase label = {};
  std::string_view unit = {};  ///< in which `value` counts
  double least = 0, most = 1;
  double value = 0;  ///< of the scene; toggle: 1 on
  bool logarithmic = false;
  int component = -1;  ///< of a list of numbers; -1: the value itself
};

/// Of shakes: frequency, amplitude or scale, direction; of the contact law: friction, restitution, alpha; of
/// pieces of furniture: size, mass, height of the centre of gravity; of anchors and fixings: whether they are
/// in place. In the order in which a page shows them. Of keys that a scene leaves out, those whose value its
/// model tells.
std::vector<PageControl> page_controls(const io::Scene& scene);

/// "KEY=VALUE" of each key of which some control has another value than in the scene. `values`: one a
/// control.
std::vector<std::string> changes(const std::vector<PageControl>& controls, const std::vector<double>& values);

}  // namespace topple::app
