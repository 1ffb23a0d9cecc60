// Changes of parameters while it runs.
#pragma once

#include <utility>
#include <vector>

#include "solver/model.h"
#include "solver/parameters.h"

namespace topple {

/// A new value of one parameter. SI, as in Parameters; numbers stand in the first component, only `direction`
/// uses all three. anchor: 1 puts it in place, 0 takes it away.
struct Edit {
  enum class Key {
    frequency,
    amplitude,
    direction,
    scale,
    alpha,
    q,
    friction,
    restitution,
    anchor,
    time_step
  };
  Key key;
  int shake = 0;  ///< of frequency, amplitude, direction and scale; of anchor: its index
  Vec3 value = Vec3::Zero();
};

/// Every key, and shake or anchor that it is for, that can be edited.
std::vector<std::pair<Edit::Key, int>> editable(const Parameters& parameters);

/// The value that an edit of this key and shake or anchor sets.
Vec3 edited_value(const Parameters& parameters, Edit::Key key, int shake);

/// Makes `edit` hold from time t on. Nothing jumps: a frequency keeps its phase, amplitude, direction and
/// scale change over a quarter of a period, of a record over 0.25 s (at once before the shake starts),
/// numbers of the contact law over two of contact_period. The result depends on nothing but the arguments, so
/// that edits can be repeated.
void apply(const Edit& edit, const Model& model, double t, Parameters& parameters);

/// Period of the slowest body that bounces on the contacts it rests on, s: 2 pi sqrt(L depth / (q g)), with
/// depth = (W / (n alpha))^(1/q) on the n contact points of its base. 0 without gravity or planes.
double contact_period(const Model& model, const ContactLaw& law, const Vec3& gravity);

/// The same of one body; 0 without gravity, planes or contact points.
double contact_period(const Model& model, int body, const ContactLaw& law, const Vec3& gravity);

}  // namespace topple
