#include "app/picture/anchor_picture.h"

#include <algorithm>
#include <cmath>

#include "app/picture/row.h"

namespace topple::app {
namespace {

constexpr render::Float4 k_held_colour = {0.80f, 0.09f, 0.13f, 1};
constexpr render::Float4 k_idle_colour = {0.93f, 0.45f, 0.42f, 1};  // carries nothing
constexpr render::Float4 k_lost_colour = {0.56f, 0.56f, 0.56f, 1};  // and will not, or has lost its hold
constexpr double k_band = 0.04, k_band_thickness = 0.016, k_rod = 0.016, k_plate = 0.042,
                 k_thimble = 0.032;      // m, width and radii
constexpr double k_plate_depth = 0.012;  // m
constexpr double k_stump = 0.4;          // of the natural length, of a strap
constexpr double k_least_stump = 0.08;   // m
constexpr double k_least_sag = 0.15;     // of the span, and
constexpr double k_seen_sag = 0.1;       // m: the lesser of the two is seen as slack
constexpr double k_most_sag = 0.6;
constexpr double k_steep = 0.5;  // rise over span
constexpr int k_band_stations = 13;

enum Shape { band, rod, plate, thimble, k_shapes };

render::Profile round(double radius) {
  constexpr int k_sides = 20;
  render::Profile out;
  out.smooth = true;
  for (int i = 0; i < k_sides; ++i) {
    const double angle = 2 * k_pi * i / k_sides;
    out.outline.push_back(
        {static_cast<float>(radius * std::cos(angle)), static_cast<float>(radius * std::sin(angle))});
  }
  return out;
}

render::Profile rectangle(double y, double z) {
  const auto a = static_cast<float>(y / 2), b = static_cast<float>(z / 2);
  return {{{-a, -b}, {a, -b}, {a, b}, {-a, b}}, false};
}

/// Local x along `direction`, y level.
Quat along(const Vec3& direction) {
  const Vec3 x = direction.normalized();
  Vec3 y = Vec3::UnitZ().cross(x);
  if (y.norm() < 1e-3) y = Vec3::UnitY();
  y = (y - x * x.dot(y)).normalized();
  Mat3 axes;
  axes << x, y, x.cross(y);
  return Quat(axes);
}

class Painter {
 public:
  Painter(render::SceneFrame& out, std::uint32_t member, std::uint32_t body, std::uint32_t first_profile)
      : out_(out), member_(member), body_(body), first_profile_(first_profile) {}

  /// A tube through `points`.
  void draw(Shape shape, const render::Float4& colour, const std::vector<Vec3>& points) {
    render::Tube tube;
    tube.first_station = static_cast<std::uint32_t>(out_.stations.size());
    tube.station_count = static_cast<std::uint32_t>(points.size());
    tube.profile = first_profile_ + static_cast<std::uint32_t>(shape);
    tube.member = member_;
    tube.body = body_;
    tube.colour = colour;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3 way = points[std::min(i + 1, points.size() - 1)] - points[i > 0 ? i - 1 : 0];
      const Eigen::Vector3f x = points[i].cast<float>();
      const Eigen::Quaternionf q = along(way).cast<float>();
      out_.stations.push_back({{x.x(), x.y(), x.z()}, {q.w(), q.x(), q.y(), q.z()}, 0});
    }
    out_.tubes.push_back(tube);
  }
  void mark(Shape shape, const render::Float4& colour, const Vec3& at, const Vec3& direction) {
    const Vec3 half = k_plate_depth / 2 * direction;
    draw(shape, colour, {at - half, at + half});
  }

 private:
  render::SceneFrame& out_;
  const std::uint32_t member_, body_, first_profile_;
};

/// A parabola as long as the strap between its ends: down, or sideways where it is steep and a wall behind it
/// would hide that.
std::vector<Vec3> sagging(const Vec3& from, const Vec3& to, double length) {
  const Vec3 span = to - from;
  const double chord = span.norm();
  const double loose = std::max(length / chord - 1, 0.);
  const double sag =
      chord * std::clamp(std::sqrt(3. / 8 * loose), std::min(k_least_sag, k_seen_sag / chord), k_most_sag);
  Vec3 side = Vec3::UnitZ().cross(span);
  if (!(side.norm() > 1e-3 * chord)) side = Vec3::UnitX();
  const bool steep = std::abs(span.z()) > k_steep * chord;
  const Vec3 down = (steep ? side : Vec3(-Vec3::UnitZ() + span * (span.z() / (chord * chord)))).normalized();
  std::vector<Vec3> points;
  for (int i = 0; i < k_band_stations; ++i) {
    const double t = static_cast<double>(i) / (k_band_stations - 1);
    points.emplace_back(from + t * span + 4 * t * (1 - t) * sag * down);
  }
  return points;
}

}  // namespace

namespace {

Vec3 place_of(const io::FrameRow& row, const Vec3& shift, const AnchorEnd& end) {
  return position(row, end.node) + shift + rotation(row, end.node) * end.arm;
}

}  // namespace

Vec3 attached_point(const Model& model, const io::FrameRow& row, const Vec3& shift, std::size_t k) {
  return place_of(row, shift, model.anchors[k].own());
}

Vec3 far_point(const Model& model, const io::FrameRow& row, const Vec3& shift, std::size_t k) {
  const Anchor& anchor = model.anchors[k];
  return anchor.other.body < 0 ? Vec3(anchor.to + shift) : place_of(row, shift, anchor.other);
}

void add_anchors(const Model& model, const io::FrameRow& row, const Vec3& shift, render::SceneFrame& out) {
  if (model.anchors.empty()) return;
  const auto first_profile = static_cast<std::uint32_t>(out.profiles.size());
  for (const render::Profile& profile :
       {rectangle(k_band, k_band_thickness), round(k_rod), round(k_plate), round(k_thimble)})
    out.profiles.push_back(profile);
  for (std::size_t k = 0; k < model.anchors.size(); ++k) {
    const Anchor& anchor = model.anchors[k];
    const float state = row.anchor[k].state;
    const double length = row.anchor[k].natural_length;
    const Vec3 from = far_point(model, row, shift, k), to = attached_point(model, row, shift, k);
    Vec3 direction = to - from;
    // a pin is a bolt head where it is, as long as it is short
    direction = direction.norm() > 1e-6 ? Vec3(direction.normalized()) : Vec3(Vec3::UnitY());
    Painter painter(out, static_cast<std::uint32_t>(model.members.size() + k),
                    static_cast<std::uint32_t>(anchor.body), first_profile);
    const bool strap = anchor.type == Anchor::Type::strap && length > 0;
    const Shape shape = strap ? band : rod;
    if (state == io::k_anchor_away) continue;
    const bool lost = state == io::k_anchor_broken || !strap;
    const render::Float4& colour = state == io::k_anchor_holds ? k_held_colour
                                   : lost                      ? k_lost_colour
                                                               : k_idle_colour;
    painter.mark(plate, colour, from, direction);
    painter.mark(thimble, colour, to, direction);
    if (state == io::k_anchor_broken) {
      const double stump = strap ? std::max(k_stump * length, k_least_stump) : k_least_stump;
      // stumps of a strap hang down, those of a rod stay
      const Vec3 fall = strap ? Vec3(0.6 * direction - 0.8 * Vec3::UnitZ()).normalized() : direction,
                 back = strap ? Vec3(-0.6 * direction - 0.8 * Vec3::UnitZ()).normalized() : Vec3(-direction);
      painter.draw(shape, colour, {from, from + stump * fall});
      painter.draw(shape, colour, {to, to + stump * back});
    } else if (state == io::k_anchor_holds) {
      painter.draw(shape, colour, {from, to});
    } else if (strap) {
      painter.draw(shape, colour, sagging(from, to, length));
    } else {
      painter.draw(shape, colour, {from, from + length * direction});
    }
  }
}

}  // namespace topple::app
