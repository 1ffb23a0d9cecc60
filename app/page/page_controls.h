// What a live page lets its reader change: keys of the scene, with what is usual for each.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/support/language.h"
#include "solver/io/document/scene_document.h"
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
  int body = -1;       ///< piece of furniture that it belongs to; -1: to none alone
  int component = -1;  ///< of a list of numbers; -1: the value itself
  int follows = -1;    ///< control of whose value this one has `share` unless it is set; -1: none
  double share = 1;
  /// List of tables, SI, whose masses and inertias add up to `value` and change in proportion; null: the
  /// value itself.
  std::shared_ptr<const io::Node> list = {};
};

/// Of shakes: frequency, amplitude or scale, direction; of the contact law: friction, restitution, alpha; of
/// pieces of furniture: size, mass or what is loaded on a frame, height of the centre of gravity, tilt at the
/// start, friction; of anchors and fixings: whether they are in place. In the order in which a page shows
/// them. Of keys that a scene leaves out, those whose value its model tells.
std::vector<PageControl> page_controls(const io::Scene& scene);

/// "KEY=VALUE" of each key of which some control has another value than in the scene, or than that of the
/// control that it follows. `values`: one a control; not finite: as in the scene.
std::vector<std::string> changes(const std::vector<PageControl>& controls, const std::vector<double>& values);

}  // namespace topple::app
