#include "app/gltf/run_motion.h"

#include <algorithm>

#include "app/picture/bridge.h"
#include "app/picture/row.h"
#include "app/picture/thinning.h"
#include "render/scene/drawable.h"
#include "solver/io/common/errors.h"

namespace topple::app {
namespace {

constexpr int k_along_element = k_stations - 1;
// Steps from colour to colour of a member: the uniforms of any shader hold the weights of their targets.
constexpr int k_most_colour_steps = 32;

/// In stations.
int colour_step(const Member& member) {
  if (k_along_element * member.element_count <= k_most_colour_steps) return 1;
  return k_along_element * ((member.element_count + k_most_colour_steps - 1) / k_most_colour_steps);
}

bool deforms(const RunMotion& run, const Model& model, int node) {
  return run.deforms[model.node_body[node]];
}

/// Those of anchors are not.
bool is_of_member(const Model& model, const render::Tube& tube) {
  return tube.member < model.members.size();
}

/// Numbers of the rows that can be drawn, and what all of them say together; nothing when it was given up.
std::optional<std::vector<std::int64_t>> survey(const io::Scene& scene, const Replay& replay,
                                                const io::Proceed& proceed, RunMotion& run) {
  const Model& model = scene.setup.model;
  run.deforms.resize(model.bodies.size());
  run.breaks.resize(model.elements.size());
  std::vector<std::int64_t> rows;
  for (std::int64_t i = 0; i < replay.frame_count(); ++i) {
    if (proceed && !proceed()) return std::nullopt;
    const io::FrameRow row = replay.frame(i);
    const float time = static_cast<float>(row.time);
    if (!is_finite(row) || (!run.times.empty() && time <= run.times.back())) continue;
    run.extent.add(scene.setup, scene.setup.parameters, row);
    for (std::size_t b = 0; b < model.bodies.size(); ++b)
      run.deforms[b] = run.deforms[b] || io::has_stresses(row, static_cast<int>(b));
    for (std::size_t e = 0; e < model.elements.size(); ++e)
      run.breaks[e] = run.breaks[e] || row.hinge[e] == k_broken;
    rows.push_back(i);
    run.times.push_back(time);
  }
  if (rows.empty()) throw io::InputError("the recording holds no instant that can be drawn");
  return rows;
}

void size_tracks(const Model& model, RunMotion& run) {
  run.bodies.resize(model.bodies.size());
  run.nodes.resize(model.node_position.size());
  for (const Member& member : model.members) {
    const int step = colour_step(member), steps = k_along_element * member.element_count;
    run.colours.push_back({static_cast<std::size_t>((steps + step - 1) / step + 1)});
  }
}

/// Leaves every so many rows, and the last, where their numbers would take too much memory.
void thin_rows(const Model& model, std::vector<std::int64_t>& rows, RunMotion& run) {
  std::size_t numbers = 3 + 7 * model.bodies.size();
  for (int i = 0; i < model.node_total(); ++i) numbers += deforms(run, model, i) ? 7 : 0;
  for (const Track& colour : run.colours) numbers += colour.columns;
  const std::size_t step = numbers * sizeof(float) * rows.size() / k_most_row_bytes + 1;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (i % step == 0 || i + 1 == rows.size()) {
      rows[kept] = rows[i];
      run.times[kept++] = run.times[i];
    }
  rows.resize(kept);
  run.times.resize(kept);
}

void add_poses(const Model& model, const io::FrameRow& row, RunMotion& run) {
  const Vec3 shift = floor_shift(row);
  run.floor.add(shift);
  for (std::size_t b = 0; b < run.bodies.size(); ++b) {
    run.bodies[b].place.add(row.body[b].centre() + shift);
    run.bodies[b].turn.add(row.body[b].rotation());
  }
  for (int i = 0; i < model.node_total(); ++i) {
    if (!deforms(run, model, i)) continue;
    const io::BodyNumbers& body = row.body[model.node_body[i]];
    const Quat back = body.rotation().normalized().conjugate();
    run.nodes[i].place.add(back * (position(row, i) - body.centre()));
    run.nodes[i].turn.add(back * rotation(row, i));
  }
}

void add_colours(const Model& model, const render::SceneFrame& frame, RunMotion& run) {
  if (run.legend.quantity.empty()) run.legend = frame.legend;
  std::vector<std::vector<float>> stations(model.members.size());
  for (const render::Tube& tube : frame.tubes)
    for (std::uint32_t s = 0; s < tube.station_count && is_of_member(model, tube); ++s) {
      const float value = frame.stations[tube.first_station + s].value;
      stations[tube.member].push_back(tube.colour[3] > 0 ? k_own_colour
                                                         : legend_position(frame.legend, value));
    }
  for (std::size_t m = 0; m < stations.size(); ++m) {
    if (stations[m].empty()) continue;
    for (std::size_t k = 0; k < run.colours[m].columns; ++k)
      run.colours[m].values.push_back(stations[m][std::min<std::size_t>(
          colour_place(model.members[m], k),
          stations[m].size() - 1)]);  // straight ones have two of one colour
  }
}

/// row: any, of whose shape they are.
render::SceneFrame reference_picture(const io::Scene& scene, const Bridge& bridge, io::FrameRow row,
                                     const RunMotion& run) {
  const Model& model = scene.setup.model;
  for (int i = 0; i < model.node_total(); ++i) {
    for (int k = 0; k < 3; ++k) row.position[3 * i + k] = static_cast<float>(model.node_position[i][k]);
    for (int k = 0; k < 4; ++k) row.rotation[4 * i + k] = k == 0;
  }
  for (std::size_t e = 0; e < run.breaks.size(); ++e) row.hinge[e] = run.breaks[e] ? k_broken : 0;
  for (std::size_t b = 0; b < run.deforms.size(); ++b)
    if (run.deforms[b]) row.level[b] = static_cast<std::uint8_t>(ModelLevel::frame);
  std::ranges::fill(row.floor_displacement, 0);
  render::SceneFrame out = bridge.frame(row, scene.setup.parameters);
  std::erase_if(out.tubes, [&](const render::Tube& tube) { return !is_of_member(model, tube); });
  return out;
}

}  // namespace

int colour_place(const Member& member, std::size_t k) {
  return std::min(static_cast<int>(k) * colour_step(member), k_along_element * member.element_count);
}

std::optional<RunMotion> run_motion(const io::Scene& scene, const Replay& replay,
                                    const io::Proceed& proceed) {
  const Model& model = scene.setup.model;
  RunMotion run;
  std::optional<std::vector<std::int64_t>> rows = survey(scene, replay, proceed, run);
  if (!rows) return std::nullopt;
  size_tracks(model, run);
  thin_rows(model, *rows, run);
  const Bridge bridge(scene, run.extent);
  for (const std::int64_t i : *rows) {
    if (proceed && !proceed()) return std::nullopt;
    const io::FrameRow row = replay.frame(i);
    add_poses(model, row, run);
    add_colours(model, bridge.frame(row, scene.setup.parameters), run);
  }
  run.reference = reference_picture(scene, bridge, replay.frame(rows->front()), run);
  return run;
}

}  // namespace topple::app
