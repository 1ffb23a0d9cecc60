// Keys of what holds bodies.
#include "solver/io/scene/fixing_kinds.h"
#include "solver/io/scene/scene_key_rows.h"
#include "solver/io/scene/scene_words.h"

namespace topple::io {
namespace {

using T = KeyType;
using D = Dimension;

constexpr double k_far = 1e3;  // m

// Of an anchor, and of a fixing, which becomes one or several.
void add_holding(Rows& rows, bool of_fixing) {
  const char* const by_kind = "as its kind has it, assumed";
  Row stiffness =
      rows.number("stiffness", D::stiffness, "kN/m", 1, 1e12, "along the line from `to` to `point`");
  if (of_fixing)
    stiffness.absent_means(by_kind);
  else
    stiffness.required();
  rows.number("strength", D::force, "kN", 1e-3, 1e12, "breaks above it")
      .absent_means(of_fixing ? by_kind : "never breaks")
      .only_in({"dynamic"});
  Row preload =
      rows.number("preload", D::force, "N", 0, 1e6, "what it pulls with at the start, a pole pushes");
  if (of_fixing)
    preload.absent_means(by_kind);
  else
    preload.absent(0);
  rows.plain("on", T::boolean, "in place; one that is put in place later starts without force").absent(1);
}

}  // namespace

void add_fitting_keys(std::vector<Key>& keys) {
  Rows anchor(keys, "anchor");
  anchor.plain("name", T::text, "name in the summary").absent_means("anchor-1, ...");
  anchor.plain("body", T::text, "a cabinet, a frame, a block, or a copy").required();
  anchor
      .numbers("point", 3, D::length, "m", -k_far, k_far,
               "on the body where it starts; rigidly joined to the nearest node")
      .required();
  anchor
      .numbers(
          "to", 3, D::length, "m", -k_far, k_far,
          "on a wall or the floor: fixed to the floor's frame; with `to_body` on that body where it starts")
      .required();
  anchor.plain("to_body", T::text, "another body, which the anchor ties to this one")
      .absent_means("the floor's frame")
      .only_in({"dynamic"});
  anchor.word(
      "type", k_anchor_types, Anchor::Type::strap,
      "strap: pulls only; bracket: both ways, and where `point` and `to` are one in all directions; pole: "
      "pushes only");
  add_holding(anchor, false);

  Rows ceiling(keys, "ceiling");
  ceiling.number("at", D::length, "m", 0.1, 100, "its height").required();

  Rows fixing(keys, "fixing");
  fixing.plain("name", T::text, "name in the summary").absent_means("fixing-1, ...");
  fixing
      .word("kind", words_of(k_fixings),
            "L-bracket: both ways across a gap; strap: pulls only; pole: from the top to the ceiling, pushes "
            "only; "
            "mat: sticks the corners of the base to the floor; stopper: wedges under the side away from the "
            "wall; "
            "connector: bolts "
            "two bodies together")
      .required();
  fixing.plain("body", T::text, "a cabinet, a frame, a block, or a copy").required();
  fixing.plain("to", T::text, "a wall, `floor`, `ceiling`, or another body").required();
  fixing
      .numbers("at", 3, D::length, "m", -k_far, k_far,
               "where it holds on the body as it starts, within 100 mm of it")
      .absent_means("the node nearest to what it leads to; see the guide");
  add_holding(fixing, true);
}

}  // namespace topple::io
