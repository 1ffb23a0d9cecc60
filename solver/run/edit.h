// Changes of parameters while it runs.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "solver/model/model.h"
#include "solver/model/parameters.h"
#include "solver/model/table.h"

namespace topple {

/// A new value of one parameter. SI, as in Parameters; a number is the first component, `direction` uses all
/// three, a pull too, the frequency of a sweep two (first, last). A choice is the number of its enumerator;
/// want: 1 motion and stress, 0 motion alone; on and anchor: 1 or 0.
struct Edit {
  enum class Key {
    on,
    type,
    frequency,
    amplitude,
    direction,
    duration,
    scale,
    law,
    alpha,
    q,
    friction,
    friction_static,
    restitution,
    model,
    damping,
    anchor,
    integrator,
    want,
    time_step,
    pull
  };
  /// Table of the scene that the key is in. There is one `contact` and one `run`.
  enum class Of { shake, contact, body, anchor, run, node };
  Key key;
  int index = 0;  ///< of the shake, body, anchor or node; else 0
  Vec3 value = Vec3::Zero();
};

/// A table of the scene that has keys that can be edited.
struct EditTableTraits {
  Edit::Of kind;
  const char* word;  ///< in names of edits; "body" is a cabinet, a frame or a copy of one
  const char* keys;  ///< in the scene; a pull is in none
  bool numbered;     ///< else there is one
  int (*count)(const Model&, const Parameters&);
};
std::span<const EditTableTraits> edit_tables();
inline const EditTableTraits& traits(Edit::Of of) {
  return row_of(edit_tables(), of);
}

/// A parameter that can be edited while it runs. A new one is an Edit::Key and a row of the table in
/// edit.cpp, whose range, unit and words are those of the scene's key of the same name.
struct EditTraits {
  Edit::Key kind;
  Edit::Of of;
  const char* word;  ///< the key in the scene
  bool dynamic;      ///< statics have no use for it
  /// Whether it is among what can be edited there; a pull never is: it is of a moment, not of a scene.
  bool (*exists)(const Model&, const Parameters&, int index);
  Vec3 (*get)(const Parameters&, int index);
  void (*set)(const Edit&, const Model&, double t, Parameters&);  ///< from time t on, see apply()
  bool setting = false;                                           ///< how it is computed, not what
};
/// In the order of lists; rows of one Edit::Of stand together.
std::span<const EditTraits> edits();
inline const EditTraits& traits(Edit::Key key) {
  return row_of(edits(), key);
}

/// Every key, and shake, body or anchor that it is for, that can be edited.
std::vector<std::pair<Edit::Key, int>> editable(const Model& model, const Parameters& parameters);

/// The value that an edit of this key and shake, body or anchor sets.
Vec3 edited_value(const Parameters& parameters, Edit::Key key, int index);

/// Makes `edit` hold from time t on. Nothing jumps: a frequency keeps its phase; amplitude, direction, scale,
/// on and off change over a quarter of a period, of a record over 0.25 s (at once before the shake starts),
/// numbers of the contact law over two of contact_period, a pull in 0.05 s. A type, and the frequencies of a
/// sweep, begin the shake anew, with acceleration 0 but for a rectangle; a sine becomes a pulse of half its
/// period, or a sweep to ten times its frequency in 10 s. The rest changes at once: body models and anchors
/// with the next step, which also books what another contact law holds in its springs; time_step ends
/// adaptive stepping. At t = 0 all but a pull holds at once and no shake begins anew: the parameters are then
/// those of a setup that says so. The result depends on nothing but the arguments, so that edits can be
/// repeated.
void apply(const Edit& edit, const Model& model, double t, Parameters& parameters);

}  // namespace topple
