// What [[anchor]] and [[fixing]] have in common: where they hold on bodies.
#pragma once

#include <string>

#include "solver/io/scene/scene_entry.h"
#include "solver/model/model.h"
#include "solver/run/run.h"
#include "solver/state/state.h"

namespace topple::io {

/// "12.5 mm".
std::string millimetres(double metres);

/// Member of a body that is nearest to a point, and how far, m; 0 on a sheet of it.
struct NearestMember {
  int member = -1;
  double distance = 0;
};
NearestMember nearest_member(const Model& model, int body, const State& start, const Vec3& point);

/// Contact width of a member, m: what lies within it is on the member.
double width_of(const Model& model, int member);

/// A point of a body as it starts, joined to the nearest node.
AnchorEnd end_at(const Model& model, int body, const State& start, const Vec3& point);

/// Completes an anchor that leads from `anchor.to` to `point` of its body, and adds it to the setup.
/// `preload`, N: what it holds at the start, a pull or of a pole a push.
void add_anchor(const Entry& entry, const State& start, const Vec3& point, double preload, Anchor anchor,
                Setup& setup);

}  // namespace topple::io
