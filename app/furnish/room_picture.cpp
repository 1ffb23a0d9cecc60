#include "app/furnish/room_picture.h"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "app/picture/bridge.h"
#include "app/picture/row.h"
#include "app/picture/solid_bodies.h"
#include "solver/math/rotation.h"

namespace topple::app {
namespace {

constexpr double k_farthest_sight = 100;  // m, of a place on the floor from the eye

io::FrameRow start_row(const Setup& setup) {
  const Model& model = setup.model;
  io::FrameRow row = io::blank_row(io::row_shape(model));
  const State start = start_state(model, setup.starts);
  for (std::size_t i = 0; i < start.position.size(); ++i) {
    for (int k = 0; k < 3; ++k)
      row.position[3 * i + static_cast<std::size_t>(k)] = static_cast<float>(start.position[i][k]);
    const Quat& q = start.rotation[i];
    const double parts[] = {q.w(), q.x(), q.y(), q.z()};
    for (std::size_t k = 0; k < 4; ++k) row.rotation[4 * i + k] = static_cast<float>(parts[k]);
  }
  for (std::size_t b = 0; b < row.body.size(); ++b) {
    const BodyStart how = b < setup.starts.size() ? setup.starts[b] : BodyStart{};
    const Quat turn = exp_quaternion(how.rotation);
    const Vec3 centre = how.pivot + turn * (model.bodies[b].centre_of_gravity - how.pivot);
    row.body[b].x = centre.x(), row.body[b].y = centre.y(), row.body[b].z = centre.z();
    row.body[b].qw = turn.w(), row.body[b].qx = turn.x(), row.body[b].qy = turn.y(),
    row.body[b].qz = turn.z();
  }
  for (std::size_t k = 0; k < row.anchor.size(); ++k) {
    row.anchor[k].state = setup.parameters.anchors[k] ? io::k_anchor_slack : io::k_anchor_away;
    row.anchor[k].natural_length = static_cast<float>(model.anchors[k].length);
  }
  return row;
}

/// A part of the room that is large enough to furnish, on the side of the walls where the furniture is.
void widen(const Model& model, RunExtent& extent) {
  constexpr double k_least = 3.6;  // m
  for (int k = 0; k < 2; ++k) {
    const double missing = k_least - (extent.high[k] - extent.low[k]);
    if (!(missing > 0)) continue;
    extent.low[k] -= missing / 2;
    extent.high[k] += missing / 2;
    for (const WallLine& wall : wall_lines(model)) {
      if (std::abs(wall.normal[k]) < 0.99) continue;
      const double within = wall.normal[k] > 0 ? std::max(wall.at[k] - extent.low[k], 0.)
                                               : std::min(wall.at[k] - extent.high[k], 0.);
      extent.low[k] += within;
      extent.high[k] += within;
    }
  }
}

/// Walls as long as the room, from corner to corner: the bridge draws them near bodies alone.
void lengthen_walls(const Model& model, const RunExtent& extent, render::SceneFrame& frame) {
  constexpr double k_beyond = 0.3;  // m, of what stands in the room
  for (std::size_t i = 0; i < model.planes.size(); ++i) {
    render::Ground& ground = frame.grounds[i];
    if (ground.is_floor) continue;
    const Plane& plane = model.planes[i];
    const Vec2 along(ground.along[0], ground.along[1]), at = plane.point.head<2>();
    double low = 1e30, high = -1e30;
    for (const double x : {extent.low.x(), extent.high.x()})
      for (const double y : {extent.low.y(), extent.high.y()}) {
        low = std::min(low, along.dot(Vec2(x, y) - at) - k_beyond);
        high = std::max(high, along.dot(Vec2(x, y) - at) + k_beyond);
      }
    for (const WallLine& other : wall_lines(model)) {
      const double slope = other.normal.dot(along);
      if (std::abs(slope) < 1e-6) continue;
      const double corner = other.normal.dot(other.at - at) / slope;
      slope > 0 ? low = std::max(low, corner) : high = std::min(high, corner);
    }
    if (!(low < high)) continue;
    const Vec2 middle = at + (low + high) / 2 * along;
    ground.centre[0] = static_cast<float>(middle.x());
    ground.centre[1] = static_cast<float>(middle.y());
    ground.half_length = static_cast<float>((high - low) / 2);
  }
}

bool is_of(const Model& model, const render::Tube& tube, std::size_t body) {
  return tube.member < model.members.size() && tube.body == body;
}

}  // namespace

render::SceneFrame start_frame(const io::Scene& scene) {
  const io::FrameRow row = start_row(scene.setup);
  RunExtent extent;
  extent.add(scene.setup, scene.setup.parameters, row);
  widen(scene.setup.model, extent);
  PictureSettings settings;
  settings.words = false;
  render::SceneFrame frame = Bridge(scene, extent).frame(row, scene.setup.parameters, settings);
  lengthen_walls(scene.setup.model, extent, frame);
  SolidBodies(scene, Bodies::solid).dress(row, frame);
  return frame;
}

PieceShape shape_of(const render::SceneFrame& frame, const Model& model, const RoomPiece& piece) {
  PieceShape shape;
  const Quat back(Eigen::AngleAxisd(-piece.spot.yaw, Vec3::UnitZ()));
  const Vec3 at(piece.spot.at.x(), piece.spot.at.y(), piece.floor);
  const auto local = [&](render::Float3& x) { x = to_float(back * (Vec3(x[0], x[1], x[2]) - at)); };
  for (render::Tube tube : frame.tubes) {
    if (!is_of(model, tube, piece.body)) continue;
    const std::size_t first = shape.stations.size();
    for (std::size_t k = 0; k < tube.station_count; ++k) {
      render::Station station = frame.stations[tube.first_station + k];
      local(station.position);
      const Quat turn =
          back * Quat(station.rotation[0], station.rotation[1], station.rotation[2], station.rotation[3]);
      station.rotation = {static_cast<float>(turn.w()), static_cast<float>(turn.x()),
                          static_cast<float>(turn.y()), static_cast<float>(turn.z())};
      shape.stations.push_back(station);
    }
    shape.profiles.push_back(frame.profiles[tube.profile]);
    tube.profile = static_cast<std::uint32_t>(shape.profiles.size() - 1);
    tube.first_station = static_cast<std::uint32_t>(first);
    shape.tubes.push_back(tube);
  }
  for (render::Panel panel : frame.panels) {
    if (panel.body != piece.body) continue;
    for (render::Float3& corner : panel.corners) local(corner);
    shape.panels.push_back(panel);
  }
  return shape;
}

void hide_body(const Model& model, std::size_t body, render::SceneFrame& frame) {
  std::erase_if(frame.tubes, [&](const render::Tube& tube) { return is_of(model, tube, body); });
  std::erase_if(frame.panels, [&](const render::Panel& panel) { return panel.body == body; });
}

void add_shape(const PieceShape& shape, const Spot& spot, double floor, std::size_t body,
               const std::optional<render::Float4>& colour, render::SceneFrame& frame) {
  const Quat turn(Eigen::AngleAxisd(spot.yaw, Vec3::UnitZ()));
  const Vec3 at(spot.at.x(), spot.at.y(), floor);
  const auto placed = [&](render::Float3& x) { x = to_float(at + turn * Vec3(x[0], x[1], x[2])); };
  const auto profiles = static_cast<std::uint32_t>(frame.profiles.size());
  const auto stations = static_cast<std::uint32_t>(frame.stations.size());
  frame.profiles.insert(frame.profiles.end(), shape.profiles.begin(), shape.profiles.end());
  for (render::Station station : shape.stations) {
    placed(station.position);
    const Quat now =
        turn * Quat(station.rotation[0], station.rotation[1], station.rotation[2], station.rotation[3]);
    station.rotation = {static_cast<float>(now.w()), static_cast<float>(now.x()), static_cast<float>(now.y()),
                        static_cast<float>(now.z())};
    frame.stations.push_back(station);
  }
  for (render::Tube tube : shape.tubes) {
    tube.profile += profiles;
    tube.first_station += stations;
    tube.body = static_cast<std::uint32_t>(body);
    if (colour) tube.colour = *colour;
    frame.tubes.push_back(tube);
  }
  if (colour) return;  // sheets have no colour of their own
  for (render::Panel panel : shape.panels) {
    for (render::Float3& corner : panel.corners) placed(corner);
    panel.body = static_cast<std::uint32_t>(body);
    frame.panels.push_back(panel);
  }
}

void add_footprint(const Footprint& of, double floor, const render::Float4& colour,
                   render::SceneFrame& frame) {
  constexpr double k_line = 0.012, k_off = 0.03, k_mark = 0.10;  // m
  const Quat turn(Eigen::AngleAxisd(of.spot.yaw, Vec3::UnitZ()));
  const Vec3 at(of.spot.at.x(), of.spot.at.y(), floor + k_line / 4);
  const auto profile = static_cast<std::uint32_t>(frame.profiles.size());
  constexpr float k_wide = static_cast<float>(k_line / 2), k_flat = static_cast<float>(k_line / 6);
  frame.profiles.push_back(
      {.outline = {{-k_wide, -k_flat}, {k_wide, -k_flat}, {k_wide, k_flat}, {-k_wide, k_flat}}});
  const double d = of.half.x() + k_off, w = of.half.y() + k_off;
  const std::array<Vec2, 2> lines[] = {{Vec2(d, -w), Vec2(d, w)},
                                       {Vec2(d, w), Vec2(-d, w)},
                                       {Vec2(-d, w), Vec2(-d, -w)},
                                       {Vec2(-d, -w), Vec2(d, -w)},
                                       {Vec2(d, -k_mark), Vec2(d + k_mark, 0)},
                                       {Vec2(d + k_mark, 0), Vec2(d, k_mark)}};
  for (const auto& [a, b] : lines) {
    const Vec2 way = b - a;
    const Quat along = turn * Quat(Eigen::AngleAxisd(std::atan2(way.y(), way.x()), Vec3::UnitZ()));
    render::Tube tube;
    tube.first_station = static_cast<std::uint32_t>(frame.stations.size());
    tube.station_count = 2;
    tube.profile = profile;
    tube.member = tube.body = std::numeric_limits<std::uint32_t>::max();
    tube.lead = tube.trail = k_wide;
    tube.colour = colour;
    for (const Vec2& end : {a, b})
      frame.stations.push_back({to_float(at + turn * Vec3(end.x(), end.y(), 0)),
                                {static_cast<float>(along.w()), static_cast<float>(along.x()),
                                 static_cast<float>(along.y()), static_cast<float>(along.z())},
                                0});
    frame.tubes.push_back(tube);
  }
}

Sightline sightline(const render::Camera& camera, float width, float height, float x, float y) {
  const Eigen::Matrix4d back = (camera.projection * camera.view).cast<double>().inverse();
  const Eigen::Vector4d clip(2. * x / width - 1, 1 - 2. * y / height, 1, 1);
  const Eigen::Vector4d far = back * clip;
  const Eigen::Vector3d eye = camera.eye.cast<double>();
  return {eye, (far.head<3>() / far.w() - eye).normalized()};
}

std::optional<Vec2> on_level(const Sightline& sight, double height) {
  const double way = (height - sight.from.z()) / sight.direction.z();
  if (!(way > 0) || way > k_farthest_sight) return std::nullopt;
  return Vec2((sight.from + way * sight.direction).head<2>());
}

std::optional<std::size_t> ground_at(const Sightline& sight, const std::vector<render::Ground>& grounds) {
  std::optional<std::size_t> found;
  double nearest = k_farthest_sight;
  const auto vector = [](const render::Float3& v) { return Vec3(v[0], v[1], v[2]); };
  for (std::size_t i = 0; i < grounds.size(); ++i) {
    const render::Ground& ground = grounds[i];
    const Vec3 normal = vector(ground.normal), along = vector(ground.along);
    const double slope = sight.direction.dot(normal);
    if (slope >= 0) continue;  // seen from behind
    const double way = (vector(ground.centre) - sight.from).dot(normal) / slope;
    if (!(way > 0) || way > nearest) continue;
    const Vec3 from = sight.from + way * sight.direction - vector(ground.centre);
    if (std::abs(from.dot(along)) > ground.half_length ||
        std::abs(from.dot(normal.cross(along))) > ground.half_width)
      continue;
    nearest = way;
    found = i;
  }
  return found;
}

std::optional<Eigen::Vector2f> pixel_of(const render::Camera& camera, float width, float height,
                                        const Eigen::Vector3f& place) {
  const Eigen::Vector4f clip =
      camera.projection * camera.view * Eigen::Vector4f(place.x(), place.y(), place.z(), 1);
  if (!(clip.w() > 1e-3f)) return std::nullopt;
  return Eigen::Vector2f((clip.x() / clip.w() + 1) / 2 * width, (1 - clip.y() / clip.w()) / 2 * height);
}

}  // namespace topple::app
