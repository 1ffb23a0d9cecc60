// Anchors of a scene.
#include <algorithm>
#include <cmath>

#include "solver/io/common/units.h"
#include "solver/io/scene/scene_fittings.h"
#include "solver/io/scene/scene_read.h"

namespace topple::io {
namespace {

// Of the body's reach, from the nearest member: what a fitting may bridge.
constexpr double k_nowhere = 0.1;

// What pulls may not lead through the face of a floor or wall. `width`: contact width of the member there.
void check_faces(const Entry& root, const Entry& entry, const Anchor& anchor, const Vec3& point,
                 double width) {
  if (anchor.type == Anchor::Type::pole) return;
  const auto check = [&](const Entry& face, const std::string& name, const Vec3& at, const Vec3& normal) {
    const double own = is_beams(face) ? 0 : face.number("width");
    const double behind = normal.dot(at - anchor.to);
    if (behind <= (own > 0 ? own : width) || normal.dot(point - anchor.to) <= 0) return;
    entry.fail("to", "lies " + millimetres(behind) + " behind the face of " + name +
                         ", into which it would pull the body");
  };
  if (const Entry floor = root.entry("floor"); floor.present())
    check(floor, "the floor", Vec3::Zero(), Vec3::UnitZ());
  for (const Entry& wall : root.entries("wall")) {
    const std::vector<double> at = wall.numbers("at");
    check(wall, "wall \"" + wall.name() + "\"", Vec3(at[0], at[1], 0), wall.direction("normal"));
  }
}

// What is attached there must be near the body's members. Returns their contact width there, m.
double check_point(const Entry& entry, const char* key, const Model& model, const State& start, int index,
                   const Vec3& point) {
  const Body& body = model.bodies[index];
  const auto [member, distance] = nearest_member(model, index, start, point);
  const double width = width_of(model, member);
  if (distance > std::max(k_nowhere * body.reach, width))
    entry.fail(key, "an anchor to nowhere: the nearest member of \"" + body.name + "\", \"" +
                        model.members[member].name + "\", is " + millimetres(distance) + " away");
  return width;
}

}  // namespace

void read_anchors(const Entry& root, Setup& setup) {
  Model& model = setup.model;
  const State start = start_state(model, setup.starts);
  for (const Entry& entry : root.entries("anchor")) {
    Anchor anchor;
    anchor.name = entry.name();
    anchor.body = find_body(entry, model);
    const Body& body = model.bodies[anchor.body];
    if (body.ground) entry.fail("body", "\"" + body.name + "\" is no furniture");
    const Vec3 point = entry.vector("point");
    anchor.to = entry.vector("to");
    anchor.type = entry.chosen("type", k_anchor_types);
    anchor.stiffness = entry.number("stiffness");
    if (entry.has("strength")) anchor.strength = entry.number("strength");
    const double width = check_point(entry, "point", model, start, anchor.body, point);
    if (entry.has("to_body")) {
      anchor.other.body = find_body(entry, "to_body", model);
      if (anchor.other.body == anchor.body) entry.fail("to_body", "is the anchor's own body");
      check_point(entry, "to", model, start, anchor.other.body, anchor.to);
    } else {
      check_faces(root, entry, anchor, point, width);
    }
    add_anchor(entry, start, point, entry.number("preload"), std::move(anchor), setup);
  }
}

}  // namespace topple::io
