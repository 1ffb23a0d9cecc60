// What a scene asks of bodies that begin as planar blocks.
#include <algorithm>
#include <cmath>

#include "solver/body/candidates.h"
#include "solver/body/model_level.h"
#include "solver/body/planar_body.h"
#include "solver/contact/proximity.h"
#include "solver/io/common/units.h"
#include "solver/io/scene/scene_read.h"
#include "solver/math/ranges.h"

namespace topple::io {
namespace {

/// Whether it becomes a rigid body as soon as it begins.
bool is_near_another(const Model& model, const State& start, int body) {
  return ranges::any_of(start.candidate_pairs, [&](const ElementPair& pair) {
    return body_of(model, pair.a) == body || body_of(model, pair.b) == body;
  });
}

/// Empty: it begins as one.
std::string why_no_block(const Setup& setup, const State& start, int body, bool asked) {
  const LevelChoice base = base_level(setup.model, setup.parameters, body);
  if (!asked && base.level != ModelLevel::rigid)
    return "it is computed as \"" + std::string(traits(base.level).word) + "\" (" + name(base.reason) + ")";
  const std::string_view why = why_not_planar(setup.model, setup.parameters, start, body, asked);
  if (why.empty() && is_near_another(setup.model, start, body))
    return "another body is within " + short_number(1e3 * start.candidate_margin) + " mm";
  return std::string(why);
}

/// Of a body that begins as a planar block.
void check_restitution(const Entry& entry, const Setup& setup, const State& start, int body, bool asked) {
  const double given = setup.model.bodies[body].restitution;
  const std::optional<BlockState> begins =
      PlanarBody(setup.model, body).begin(setup.parameters, start, asked);
  if (!(given > 1) || !begins) return;
  const double most = planar::greatest_restitution(
      planar::block_along(setup.model, setup.parameters, begins->along, body).block);
  if (given > most)
    entry.fail("restitution", short_number(given) + " lets \"" + setup.model.bodies[body].name +
                                  "\" gain energy at an impact; at most " +
                                  short_number(std::floor(most * 1e4) / 1e4));
}

}  // namespace

void check_planar(const Entry& root, const Setup& setup) {
  State start = start_state(setup.model, setup.starts);
  NearSearch search(setup.model);
  int body = 0;
  for (const char* const kind : {"cabinet", "frame", "block"})
    for (const Entry& entry : root.entries(kind)) {
      const bool asked = traits(entry.chosen("model", body_models())).kind == BodyModel::planar;
      const int end = body + static_cast<int>(std::max<std::size_t>(1, entry.vectors("copies").size()));
      for (; body < end; ++body) {
        if (!asked && !entry.has("restitution")) continue;
        update_candidates(setup.model, search, start, 0);
        const std::string why = why_no_block(setup, start, body, asked);
        if (!why.empty())
          entry.fail(asked ? "model" : "restitution",
                     "\"" + setup.model.bodies[body].name + "\" is no planar block: " + why);
        check_restitution(entry, setup, start, body, asked);
      }
    }
}

}  // namespace topple::io
