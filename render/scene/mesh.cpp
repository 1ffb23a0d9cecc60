#include "render/scene/mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>

#include "render/scene/colour_map.h"
#include "render/scene/drawable.h"

namespace topple::render {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

/// A profile ready to be swept: one entry a facet, with the normals at its two corners.
struct Section {
  struct Facet {
    Vector2f from, to;
    Vector2f from_normal, to_normal;
  };
  std::vector<Facet> facets;
  std::vector<Vector2f> corners;   // counter-clockwise
  std::vector<std::uint32_t> cap;  // triangles over `corners`
};

template <class Range, class Predicate>
bool all_of(const Range& range, Predicate predicate) {
  return std::all_of(std::begin(range), std::end(range), predicate);
}

float cross(const Vector2f& a, const Vector2f& b) {
  return a.x() * b.y() - a.y() * b.x();
}

Section section_of(const Profile& profile) {
  Section section;
  if (profile.outline.size() < 3 || !all_of(profile.outline, [](const auto& p) { return drawable(p); })) {
    return section;
  }
  float twice_area = 0;
  for (std::size_t i = 0; i < profile.outline.size(); ++i) {
    const auto& p = profile.outline[i];
    const auto& q = profile.outline[(i + 1) % profile.outline.size()];
    section.corners.emplace_back(p[0], p[1]);
    twice_area += p[0] * q[1] - p[1] * q[0];
  }
  if (twice_area < 0) std::reverse(section.corners.begin(), section.corners.end());
  std::vector<std::array<float, 2>> outline;
  for (const Vector2f& c : section.corners) outline.push_back({c.x(), c.y()});
  section.cap = triangulated(outline);

  const std::size_t n = section.corners.size();
  std::vector<Vector2f> normals(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Vector2f edge = section.corners[(i + 1) % n] - section.corners[i];
    normals[i] = Vector2f(edge.y(), -edge.x()).normalized();
  }
  for (std::size_t i = 0; i < n; ++i) {
    Section::Facet facet{section.corners[i], section.corners[(i + 1) % n], normals[i], normals[i]};
    if (profile.smooth) {
      facet.from_normal = (normals[(i + n - 1) % n] + normals[i]).normalized();
      facet.to_normal = (normals[i] + normals[(i + 1) % n]).normalized();
    }
    section.facets.push_back(facet);
  }
  return section;
}

constexpr Float4 k_torn_colour{0.86f, 0.22f, 0.10f, 1};

std::uint32_t packed(const Float4& colour) {
  std::uint32_t rgba = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    rgba |= static_cast<std::uint32_t>(std::lround(255 * std::clamp(colour[i], 0.0f, 1.0f))) << (8 * i);
  }
  return rgba;
}

std::uint32_t opaque(const Float4& colour) {
  return packed(colour) | 0xff000000u;
}

/// A station's cross-section plane in the picture's frame.
struct Ring {
  Vector3f centre, axis, y, z;
  float at;
  float torn = 0;  // m, how far every other corner stands back along the axis

  Vector3f place(const Vector2f& p, std::size_t corner) const {
    return centre + p.x() * y + p.y() * z + (corner % 2 == 0 ? 0.f : torn) * axis;
  }
  Vector3f direct(const Vector2f& n) const { return n.x() * y + n.y() * z; }
};

bool drawable_station(const Station& s) {
  const Float4& q = s.rotation;
  const float norm2 = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
  return drawable(s.position) && norm2 > 1e-6f && norm2 < 1e6f && std::isfinite(s.value);
}

void push_cap(Mesh& mesh, const Section& section, const Ring& ring, bool first) {
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
  const Vector3f normal = first ? Vector3f(-ring.axis) : ring.axis;
  for (std::size_t i = 0; i < section.corners.size(); ++i) {
    mesh.vertices.push_back(
        {ring.place(section.corners[i], i), normal, ring.at, ring.torn != 0 ? packed(k_torn_colour) : 0});
  }
  for (std::size_t i = 0; i + 2 < section.cap.size(); i += 3) {
    mesh.indices.push_back(base + section.cap[i]);
    mesh.indices.push_back(base + section.cap[first ? i + 2 : i + 1]);
    mesh.indices.push_back(base + section.cap[first ? i + 1 : i + 2]);
  }
}

void push_tube(Mesh& mesh, const Section& section, const std::vector<Ring>& rings) {
  for (std::size_t r = 0; r + 1 <= rings.size(); ++r) {
    const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
    const auto ring_size = static_cast<std::uint32_t>(2 * section.facets.size());
    for (std::size_t i = 0; i < section.facets.size(); ++i) {
      const Section::Facet& facet = section.facets[i];
      const std::size_t next = (i + 1) % section.facets.size();
      mesh.vertices.push_back(
          {rings[r].place(facet.from, i), rings[r].direct(facet.from_normal), rings[r].at, 0});
      mesh.vertices.push_back(
          {rings[r].place(facet.to, next), rings[r].direct(facet.to_normal), rings[r].at, 0});
    }
    if (r + 1 == rings.size()) break;
    for (std::uint32_t v = base; v < base + ring_size; v += 2) {
      mesh.indices.insert(mesh.indices.end(),
                          {v, v + 1, v + ring_size, v + 1, v + 1 + ring_size, v + ring_size});
    }
  }
  push_cap(mesh, section, rings.front(), true);
  push_cap(mesh, section, rings.back(), false);
}

/// `stations` are the frame's or those of its ghosts.
bool push_tube(Mesh& mesh, const SceneFrame& frame, const std::vector<Station>& stations,
               const std::vector<Section>& sections, const Tube& tube) {
  const std::size_t first = tube.first_station;
  const std::size_t count = tube.station_count;
  if (tube.profile >= sections.size() || sections[tube.profile].corners.empty() || count < 2 ||
      first + count > stations.size() || !drawable(tube.lead) || !drawable(tube.trail) ||
      !drawable(tube.torn_first) || !drawable(tube.torn_last) || !drawable(tube.colour)) {
    return false;
  }
  std::vector<Ring> rings;
  for (std::size_t i = first; i < first + count; ++i) {
    const Station& s = stations[i];
    if (!drawable_station(s)) return false;
    const Eigen::Matrix3f turn =
        Eigen::Quaternionf(s.rotation[0], s.rotation[1], s.rotation[2], s.rotation[3])
            .normalized()
            .toRotationMatrix();
    const float at = has_value_range(frame.legend) ? legend_position(frame.legend, s.value) : 0.0f;
    rings.push_back({Vector3f(s.position.data()), turn.col(0), turn.col(1), turn.col(2), at});
  }
  rings.front().centre -= tube.lead * rings.front().axis;
  rings.back().centre += tube.trail * rings.back().axis;
  rings.front().torn = tube.torn_first;
  rings.back().torn = -tube.torn_last;
  const std::size_t before = mesh.vertices.size();
  push_tube(mesh, sections[tube.profile], rings);
  if (tube.colour[3] > 0)
    for (std::size_t i = before; i < mesh.vertices.size(); ++i) mesh.vertices[i].rgba = opaque(tube.colour);
  return true;
}

std::vector<Section> sections_of(const SceneFrame& frame) {
  std::vector<Section> sections;
  for (const Profile& profile : frame.profiles) sections.push_back(section_of(profile));
  return sections;
}

/// The section with every side moved outwards by `by`, m.
Section grown(const Section& section, float by) {
  Profile profile;
  const std::size_t n = section.facets.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Section::Facet& before = section.facets[(i + n - 1) % n];
    const Section::Facet& after = section.facets[i];
    const Vector2f a = before.to - before.from;
    const Vector2f b = after.to - after.from;
    const Vector2f sum = Vector2f(a.y(), -a.x()).normalized() + Vector2f(b.y(), -b.x()).normalized();
    // where both moved sides meet; a sharp corner reaches out no farther than four times as much
    const Vector2f corner = after.from + 2 * by * sum / std::max(sum.squaredNorm(), 0.5f);
    profile.outline.push_back({corner.x(), corner.y()});
  }
  return section_of(profile);
}

/// A frustum of a cone about the line from..to, closed at `from`.
void push_cone(Mesh& mesh, const Vector3f& from, const Vector3f& to, float from_radius, float to_radius,
               std::uint32_t rgba) {
  constexpr std::uint32_t k_sides = 16;
  const Vector3f axis = (to - from).normalized();
  const Vector3f y = axis.unitOrthogonal();
  const Vector3f z = axis.cross(y);
  const float slope = (from_radius - to_radius) / (to - from).norm();
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
  for (std::uint32_t i = 0; i < k_sides; ++i) {
    const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / k_sides;
    const Vector3f out = std::cos(angle) * y + std::sin(angle) * z;
    const Vector3f normal = (out + slope * axis).normalized();
    mesh.vertices.push_back({from + from_radius * out, normal, 0, rgba});
    mesh.vertices.push_back({to + to_radius * out, normal, 0, rgba});
    mesh.vertices.push_back({from + from_radius * out, -axis, 0, rgba});
  }
  for (std::uint32_t i = 0; i < k_sides; ++i) {
    const std::uint32_t a = base + 3 * i;
    const std::uint32_t b = base + 3 * ((i + 1) % k_sides);
    mesh.indices.insert(mesh.indices.end(), {a, b, a + 1, b, b + 1, a + 1});
    if (i >= 2) mesh.indices.insert(mesh.indices.end(), {base + 2, a + 2, base + 3 * (i - 1) + 2});
  }
}

bool push_arrow(Mesh& mesh, const Arrow& arrow, float scene_size) {
  if (!drawable(arrow.from) || !drawable(arrow.to) || !drawable(arrow.colour)) return false;
  const Vector3f from(arrow.from.data());
  const Vector3f to(arrow.to.data());
  const float length = (to - from).norm();
  if (length < 1e-6f) return true;  // a force of zero has no direction to show
  const float radius = std::min(0.0030f * scene_size, 0.08f * length);
  const Vector3f neck = to - std::min(7.5f * radius, 0.6f * length) / length * (to - from);
  const std::uint32_t rgba = opaque(arrow.colour);
  push_cone(mesh, from, neck, radius, radius, rgba);
  push_cone(mesh, neck, to, 2.8f * radius, 0, rgba);
  return true;
}

bool push_ring(Mesh& mesh, const render::Ring& ring) {
  constexpr std::uint32_t k_around = 40, k_across = 10;
  constexpr float k_thickness = 0.13f, k_head = 0.85f;  // of the radius
  constexpr float k_turn = 2 * std::numbers::pi_v<float>;
  if (!drawable(ring.centre) || !drawable(ring.axis) || !drawable(ring.colour) || !drawable(ring.radius) ||
      ring.radius <= 0)
    return false;
  const Vector3f centre(ring.centre.data());
  const Vector3f axis = Vector3f(ring.axis.data()).stableNormalized();
  if (!(axis.norm() > 0.5f)) return false;
  const Vector3f y = axis.unitOrthogonal();
  const Vector3f z = axis.cross(y);
  const std::uint32_t rgba = opaque(ring.colour);
  const auto out = [&](float angle) { return Vector3f(std::cos(angle) * y + std::sin(angle) * z); };
  const float arc = ring.turns ? 0.80f * k_turn : k_turn;
  const std::uint32_t last = ring.turns ? k_around : k_around - 1;  // a closed one ends where it began
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
  for (std::uint32_t i = 0; i <= last; ++i) {
    const Vector3f o = out(arc * static_cast<float>(i) / k_around);
    for (std::uint32_t j = 0; j < k_across; ++j) {
      const float across = k_turn * static_cast<float>(j) / k_across;
      const Vector3f normal = std::cos(across) * o + std::sin(across) * axis;
      mesh.vertices.push_back({centre + ring.radius * (o + k_thickness * normal), normal, 0, rgba});
    }
  }
  for (std::uint32_t i = 0; i < k_around; ++i) {
    for (std::uint32_t j = 0; j < k_across; ++j) {
      const std::uint32_t a = base + k_across * i, b = base + k_across * ((i + 1) % (last + 1));
      const std::uint32_t k = (j + 1) % k_across;
      mesh.indices.insert(mesh.indices.end(), {a + j, b + j, b + k, a + j, b + k, a + k});
    }
  }
  if (!ring.turns) return true;
  for (std::uint32_t j = 1; j + 1 < k_across; ++j)
    mesh.indices.insert(mesh.indices.end(), {base, base + j, base + j + 1});
  const Vector3f neck = centre + ring.radius * out(arc);
  push_cone(mesh, neck, neck + k_head * ring.radius * axis.cross(out(arc + 0.3f)),
            2.9f * k_thickness * ring.radius, 0, rgba);
  return true;
}

/// A ribbon through `points` that faces the eye. alpha: of the colour, at each point.
void push_line(Mesh& mesh, const std::vector<Float3>& points, const Float4& colour,
               const std::vector<float>* alpha, const Vector3f& eye, float thickness) {
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto at = [&](std::size_t i) { return Vector3f(points[i].data()); };
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3f along = at(std::min(i + 1, points.size() - 1)) - at(i > 0 ? i - 1 : 0);
    const Vector3f to_eye = eye - at(i);
    Vector3f side = along.cross(to_eye).stableNormalized();
    if (!side.allFinite()) side.setZero();
    Float4 here = colour;
    if (alpha) here[3] *= (*alpha)[i];
    for (const float sign : {-0.5f, 0.5f})
      mesh.vertices.push_back({at(i) + sign * thickness * to_eye.norm() * side, to_eye, 0, packed(here)});
  }
  for (std::uint32_t i = 0; i + 1 < points.size(); ++i) {
    const std::uint32_t v = base + 2 * i;
    mesh.indices.insert(mesh.indices.end(), {v, v + 1, v + 2, v + 1, v + 3, v + 2});
  }
}

bool drawable(const std::vector<Float3>& points) {
  return all_of(points, [](const Float3& p) { return render::drawable(p); });
}

}  // namespace

std::vector<std::uint32_t> triangulated(const std::vector<std::array<float, 2>>& outline) {
  std::vector<std::uint32_t> left(outline.size());
  for (std::uint32_t i = 0; i < left.size(); ++i) left[i] = i;
  std::vector<std::uint32_t> triangles;
  const auto point = [&](std::uint32_t i) { return Vector2f(outline[i][0], outline[i][1]); };
  // Cuts ears: convex corners whose triangle holds no other corner.
  while (left.size() >= 3) {
    std::size_t ear = left.size();
    for (std::size_t i = 0; i < left.size() && ear == left.size(); ++i) {
      const Vector2f a = point(left[(i + left.size() - 1) % left.size()]);
      const Vector2f b = point(left[i]);
      const Vector2f c = point(left[(i + 1) % left.size()]);
      if (cross(b - a, c - b) <= 0) continue;
      const bool free = std::none_of(left.begin(), left.end(), [&](std::uint32_t j) {
        const Vector2f p = point(j);
        return p != a && p != b && p != c && cross(b - a, p - a) >= 0 && cross(c - b, p - b) >= 0 &&
               cross(a - c, p - c) >= 0;
      });
      if (free) ear = i;
    }
    if (ear == left.size()) break;  // what is left is flat or crosses itself
    const std::size_t n = left.size();
    triangles.insert(triangles.end(), {left[(ear + n - 1) % n], left[ear], left[(ear + 1) % n]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  return triangles;
}

Mesh solid_mesh(const SceneFrame& frame, LeftOut& left_out) {
  Mesh mesh;
  const std::vector<Section> sections = sections_of(frame);
  for (const Tube& tube : frame.tubes) {
    const auto first = static_cast<std::uint32_t>(mesh.indices.size());
    if (!push_tube(mesh, frame, frame.stations, sections, tube)) ++left_out.tubes;
    mesh.tubes.push_back({first, static_cast<std::uint32_t>(mesh.indices.size()) - first});
  }
  for (const render::Ring& ring : frame.rings) {
    if (!push_ring(mesh, ring)) ++left_out.rings;
  }
  return mesh;
}

Mesh arrow_mesh(const SceneFrame& frame, LeftOut& left_out) {
  Mesh mesh;
  const auto [low, high] = drawable_bounds(frame);
  for (const Arrow& arrow : frame.arrows) {
    if (!push_arrow(mesh, arrow, (high - low).norm())) ++left_out.arrows;
  }
  return mesh;
}

Mesh trail_mesh(const SceneFrame& frame, const Vector3f& eye, float thickness, LeftOut& left_out) {
  Mesh mesh;
  for (const Trail& trail : frame.trails) {
    if (trail.points.size() < 2 || trail.strength.size() != trail.points.size() || !drawable(trail.points) ||
        !drawable(trail.colour) || !all_of(trail.strength, [](float s) { return std::isfinite(s); })) {
      ++left_out.trails;
      continue;
    }
    push_line(mesh, trail.points, trail.colour, &trail.strength, eye, thickness);
  }
  return mesh;
}

Mesh band_mesh(const SceneFrame& frame, const Vector3f& eye, float thickness, LeftOut& left_out) {
  constexpr float k_fill = 0.42f;  // of the colour's alpha
  Mesh mesh;
  for (const Band& band : frame.bands) {
    if (band.base.size() < 2 || band.base.size() != band.edge.size() || !drawable(band.base) ||
        !drawable(band.edge) || !drawable(band.colour)) {
      ++left_out.bands;
      continue;
    }
    const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
    Float4 fill = band.colour;
    fill[3] *= k_fill;
    for (std::size_t i = 0; i < band.base.size(); ++i)
      for (const Float3& p : {band.base[i], band.edge[i]})
        mesh.vertices.push_back({Vector3f(p.data()), Vector3f::UnitZ(), 0, packed(fill)});
    for (std::uint32_t i = 0; i + 1 < band.base.size(); ++i) {
      const std::uint32_t v = base + 2 * i;
      mesh.indices.insert(mesh.indices.end(), {v, v + 1, v + 2, v + 1, v + 3, v + 2});
    }
    std::vector<Float3> outline = band.edge;
    outline.insert(outline.begin(), band.base.front());
    outline.push_back(band.base.back());
    push_line(mesh, outline, band.colour, nullptr, eye, thickness);
  }
  return mesh;
}

Mesh ghost_mesh(const SceneFrame& frame, LeftOut& left_out) {
  Mesh mesh;
  const std::vector<Section> sections = sections_of(frame);
  for (const Tube& tube : frame.ghost_tubes) {
    if (!push_tube(mesh, frame, frame.ghost_stations, sections, tube)) ++left_out.tubes;
  }
  return mesh;
}

Mesh shell_mesh(const SceneFrame& frame, const Vector3f& eye, float thickness, const Float4& colour) {
  Mesh mesh;
  for (Tube tube : frame.tubes) {
    if ((tube.member != frame.highlighted_member && tube.body != frame.highlighted_body) ||
        tube.profile >= frame.profiles.size() ||
        tube.first_station + std::size_t{tube.station_count} > frame.stations.size() ||
        tube.station_count < 2) {
      continue;
    }
    const Vector3f middle(frame.stations[tube.first_station + tube.station_count / 2].position.data());
    const float by = thickness * (middle - eye).norm();
    if (!drawable(by)) continue;
    tube.lead += by;
    tube.trail += by;
    std::vector<Section> sections(frame.profiles.size());
    sections[tube.profile] = grown(section_of(frame.profiles[tube.profile]), by);
    push_tube(mesh, frame, frame.stations, sections, tube);
  }
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) std::swap(mesh.indices[i], mesh.indices[i + 1]);
  for (Vertex& vertex : mesh.vertices) vertex.rgba = opaque(colour);
  return mesh;
}

std::vector<PanelVertex> panel_mesh(const SceneFrame& frame, const Vector3f& eye, LeftOut& left_out) {
  struct Sorted {
    float distance;
    const Panel* panel;
  };
  std::vector<Sorted> order;
  for (const Panel& panel : frame.panels) {
    if (!all_of(panel.corners, [](const Float3& c) { return drawable(c); })) {
      ++left_out.panels;
      continue;
    }
    Vector3f centre = Vector3f::Zero();
    for (const Float3& corner : panel.corners) centre += Vector3f(corner.data()) / 4;
    order.push_back({(centre - eye).norm(), &panel});
  }
  std::stable_sort(order.begin(), order.end(),
                   [](const Sorted& a, const Sorted& b) { return a.distance > b.distance; });
  std::vector<PanelVertex> vertices;
  for (const Sorted& entry : order) {
    std::array<Vector3f, 4> p;
    for (std::size_t i = 0; i < 4; ++i) p[i] = Vector3f(entry.panel->corners[i].data());
    const Vector3f normal = (p[2] - p[0]).cross(p[3] - p[1]);
    if (normal.norm() < 1e-12f) continue;  // a panel without area has nothing to show
    for (const std::size_t i : {0u, 1u, 2u, 0u, 2u, 3u}) {
      vertices.push_back({p[i], normal.normalized(), {i == 1 || i == 2 ? 1.0f : 0.0f, i >= 2 ? 1.0f : 0.0f}});
    }
  }
  return vertices;
}

}  // namespace topple::render
