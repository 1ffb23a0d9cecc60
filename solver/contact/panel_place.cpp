#include "solver/contact/panel_place.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/contact/nearest_places.h"

namespace topple {
namespace {

constexpr double k_straight = 1e-12;  // of the sides: twist of a parallelogram, and cosine of a right angle

void set_shares(PanelPlace& place) {
  const double u = place.r[0], v = place.r[1];
  place.share = {(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v};
  place.change = {{{v - 1, u - 1}, {1 - v, -u}, {v, u}, {-v, 1 - u}}};
}

// Shares, slopes and distance at place.r.
void look(const Vec3& p, const std::array<Vec3, 4>& corner, PanelPlace& place) {
  set_shares(place);
  place.between = p;
  place.along.fill(Vec3::Zero());
  for (int k = 0; k < 4; ++k) {
    place.between -= place.share[k] * corner[k];
    for (int m = 0; m < 2; ++m) place.along[m] += place.change[k][m] * corner[k];
  }
}

}  // namespace

PanelPlace panel_place(const Vec3& p, const std::array<Vec3, 4>& corner) {
  constexpr int k_iterations = 8;
  constexpr double k_found = 1e-14;  // of r
  PanelPlace place;
  const Vec3 a = corner[1] - corner[0], b = corner[3] - corner[0];
  place.twist = corner[2] - corner[1] - b;
  const double aa = a.squaredNorm(), bb = b.squaredNorm(), ab = a.dot(b);
  if (place.twist.squaredNorm() < k_straight * k_straight * (aa + bb)) {
    const Vec3 from = p - corner[0];
    const double pa = a.dot(from), pb = b.dot(from), inverse = 1 / (aa * bb - ab * ab);
    place.r = {inverse * (bb * pa - ab * pb), inverse * (aa * pb - ab * pa)};
    place.along = {a, b};
    place.between = from - place.r[0] * a - place.r[1] * b;
    set_shares(place);
    return place;
  }
  place.r = {0.5, 0.5};
  for (int i = 0; i < k_iterations; ++i) {
    look(p, corner, place);
    const Eigen::Vector2d change = place.inverse() * Eigen::Vector2d(place.along[0].dot(place.between),
                                                                     place.along[1].dot(place.between));
    if (!change.allFinite()) break;
    place.r = {place.r[0] + change[0], place.r[1] + change[1]};
    if (change.cwiseAbs().maxCoeff() < k_found) break;
  }
  look(p, corner, place);
  return place;
}

Eigen::Matrix2d PanelPlace::inverse() const {
  Eigen::Matrix2d second;
  second << along[0].squaredNorm(), along[0].dot(along[1]) - twist.dot(between), 0, along[1].squaredNorm();
  second(1, 0) = second(0, 1);
  return second.inverse();
}

NearestOnPanel nearest_on_panel(const Vec3& p, const std::array<Vec3, 4>& corner) {
  PanelPlace place = panel_place(p, corner);
  if (place.within()) return {place.share, place.between};
  const double aa = place.along[0].squaredNorm(), bb = place.along[1].squaredNorm(),
               ab = place.along[0].dot(place.along[1]);
  if (place.twist.squaredNorm() < k_straight * k_straight * (aa + bb) && ab * ab < k_straight * aa * bb) {
    for (double& r : place.r) r = std::clamp(r, 0., 1.);
    look(p, corner, place);
    return {place.share, place.between};
  }
  NearestOnPanel nearest{{}, Vec3::Constant(std::numeric_limits<double>::infinity())};
  for (int k = 0; k < 4; ++k) {
    const int next = (k + 1) % 4;
    const NearestPoints at = nearest_points(p, corner[k], corner[next]);
    if (!(at.between.squaredNorm() < nearest.between.squaredNorm())) continue;
    nearest = {{}, at.between};
    nearest.share[k] = 1 - at.t;
    nearest.share[next] = at.t;
  }
  return nearest;
}

PanelShare panel_share(const Panel& panel, const PanelPlace& place, double reach) {
  Panel::Place at = Panel::Place::Zero();
  std::array<Panel::Place, 2> along{Panel::Place::Zero(), Panel::Place::Zero()};
  for (int k = 0; k < 4; ++k) {
    at += place.share[k] * panel.corner[k];
    for (int m = 0; m < 2; ++m) along[m] += place.change[k][m] * panel.corner[k];
  }
  double share = 1;
  Panel::Place slope = Panel::Place::Zero();
  for (const auto& [from, to] : panel.members) {
    const Panel::Place line = to - from;
    const Panel::Place off =
        at - from - std::clamp((at - from).dot(line) / line.squaredNorm(), 0., 1.) * line;
    const double distance = off.norm();
    if (distance >= reach) continue;
    const double x = distance / reach, own = x * x * (3 - 2 * x);
    slope *= own;
    if (distance > 0) slope += share * 6 * x * (1 - x) / (reach * distance) * off;
    share *= own;
  }
  return {share, {slope.dot(along[0]), slope.dot(along[1])}};
}

bool crosses_panel(const Vec3& from, const Vec3& to, const std::array<Vec3, 4>& corner) {
  const Vec3 middle = (corner[0] + corner[1] + corner[2] + corner[3]) / 4;
  const Vec3 normal = (corner[2] - corner[0]).cross(corner[3] - corner[1]);
  const double a = (from - middle).dot(normal), b = (to - middle).dot(normal);
  return (a < 0) != (b < 0) && panel_place(from + a / (a - b) * (to - from), corner).within();
}

}  // namespace topple
