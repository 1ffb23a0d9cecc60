#include "app/panels/load_path.h"

#include <algorithm>
#include <cmath>

#include "app/panels/load_path_words.h"
#include "app/picture/row.h"
#include "solver/math/rotation.h"

namespace topple::app {
namespace {

constexpr double k_path_room = 0.12;  // of the range of an axis, on either side

Vec3 place_in(const PathMeasure& measure, const io::FrameRow& row) {
  return measure.node < 0 ? row.body[static_cast<std::size_t>(measure.body)].centre()
                          : position(row, measure.node);
}

Vec3 reference_place(const Model& model, const PathMeasure& measure) {
  return measure.node < 0 ? model.bodies[static_cast<std::size_t>(measure.body)].centre_of_gravity
                          : model.node_position[static_cast<std::size_t>(measure.node)];
}

}  // namespace

PathMeasure path_measure(const Setup& setup, const io::FrameRow& first, const io::FrameRow& last) {
  const Model& model = setup.model;
  const auto& control = setup.run.statics.control;
  if (control && !control->arc_length)
    return {model.node_body[control->node], control->node, control->direction};
  PathMeasure out{0, 0, 0};
  if (!setup.probes.empty()) {
    out.body = setup.probes.front().body;
    out.node = setup.probes.front().node;
  } else {
    double most = 0;
    for (int i = 0; i < model.node_total(); ++i)
      if (const double way = (position(last, i) - position(first, i)).norm(); way > most) {
        most = way;
        out.node = i;
      }
    out.body = model.node_body[out.node];
  }
  (place_in(out, last) - place_in(out, first)).cwiseAbs().maxCoeff(&out.direction);
  return out;
}

std::string name_of(const Setup& setup, const PathMeasure& measure) {
  const std::string direction(1, "xyzXYZ"[measure.direction]);
  for (const Probe& probe : setup.probes)
    if (probe.body == measure.body && probe.node == measure.node)
      return say(window_words::k_probe_way, probe.name, direction);
  const Body& body = setup.model.bodies[static_cast<std::size_t>(measure.body)];
  return say(window_words::k_node_way, body.name, measure.node - body.first_node, direction);
}

double travel(const Model& model, const PathMeasure& measure, const io::FrameRow& row, double before) {
  if (measure.direction < 3)
    return (place_in(measure, row) - reference_place(model, measure))[measure.direction];
  const double turn = log_quaternion(measure.node < 0 ? row.body[measure.body].rotation()
                                                      : rotation(row, measure.node))[measure.direction - 3];
  return turn + 2 * k_pi * std::round((before - turn) / (2 * k_pi));
}

std::vector<double> travels(const Model& model, const PathMeasure& measure, const std::vector<RowPtr>& way) {
  std::vector<double> out;
  out.reserve(way.size());
  for (const RowPtr& row : way) out.push_back(travel(model, measure, *row, out.empty() ? 0 : out.back()));
  return out;
}

PathAxis::PathAxis(const std::vector<double>& values, double rounding) {
  const auto [least, greatest] = std::ranges::minmax(values);
  low = least < -rounding ? least : 0;
  high = greatest > rounding ? greatest : 0;
  if (low == high) high = 1;
  const double room = k_path_room * (high - low);
  if (low < 0) low -= room;
  high += room;
}

std::size_t nearest_point(const std::vector<ImVec2>& points, ImVec2 place) {
  const auto distance = [&](ImVec2 p) { return std::hypot(p.x - place.x, p.y - place.y); };
  return static_cast<std::size_t>(std::ranges::min_element(points, {}, distance) - points.begin());
}

}  // namespace topple::app
