// Words beside places of the scene.
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Geometry>

#include "render/scene/drawable.h"
#include "render/scene/overlay.h"
#include "render/scene/overlay_parts.h"
#include "render/scene/text_layout.h"

namespace topple::render {
namespace {

using Eigen::Vector3f;

// Where a label may lie, from its place: to the right first, then all around it and farther away.
struct Side {
  float x, y;
};
constexpr Side k_label_sides[] = {{1, 0}, {-1, 0}, {0, -1}, {1, -1}, {-1, -1}, {1, 1}, {-1, 1}, {0, 1}};
constexpr float k_farther[] = {0, 1.5f, 3.5f, 6, 9};  // of the label's height

constexpr std::size_t k_near = 3;  // of these, for a place to which no line leads

constexpr float k_step_away = 0.15f;  // of being covered wholly, what each of k_farther costs
constexpr float k_quarters = 4;       // shares of what is covered in these steps: labels stay where they are
constexpr float k_hardly = 0.05f;     // of a label, covered

bool overlap(const OverlayBox& a, const OverlayBox& b) {
  return a.left < b.right && a.right > b.left && a.top < b.bottom && a.bottom > b.top;
}

float common_area(const OverlayBox& a, const OverlayBox& b) {
  const float across = std::min(a.right, b.right) - std::max(a.left, b.left),
              down = std::min(a.bottom, b.bottom) - std::max(a.top, b.top);
  return std::max(across, 0.f) * std::max(down, 0.f);
}

/// Whether the line from `a` to `b` passes through the box.
bool crosses(const ImVec2& a, const ImVec2& b, const OverlayBox& box) {
  float from = 0, to = 1;
  const auto cut = [&](float start, float step, float low, float high) {
    if (step == 0) return start > low && start < high;
    const float first = (low - start) / step, second = (high - start) / step;
    from = std::max(from, std::min(first, second));
    to = std::min(to, std::max(first, second));
    return from < to;
  };
  return cut(a.x, b.x - a.x, box.left, box.right) && cut(a.y, b.y - a.y, box.top, box.bottom);
}

/// What `camera` sees in `room`.
class Projection {
 public:
  Projection(const Camera& camera, const OverlayBox& room)
      : all_(camera.projection * camera.view), room_(room) {}

  /// px; nothing behind the eye.
  std::optional<ImVec2> at(const Float3& place) const {
    return drawable(place) ? at(Vector3f(place.data())) : std::nullopt;
  }
  std::optional<ImVec2> at(const Vector3f& place) const {
    const Eigen::Vector4f clip = all_ * place.homogeneous();
    if (!(clip.w() > 0) || !clip.allFinite()) return std::nullopt;
    return ImVec2(room_.left + (room_.right - room_.left) * (0.5f + 0.5f * clip.x() / clip.w()),
                  room_.top + (room_.bottom - room_.top) * (0.5f - 0.5f * clip.y() / clip.w()));
  }

  /// Boxes about the beams and sheets of bodies.
  std::vector<OverlayBox> bodies(const SceneFrame& frame) const {
    std::vector<OverlayBox> boxes;
    for (const Panel& panel : frame.panels) {
      if (panel.body == k_no_body) continue;
      Bounds bounds;
      for (const Float3& corner : panel.corners) bounds.add(at(corner));
      bounds.end(boxes);
    }
    for (const Tube& tube : frame.tubes) {
      if (tube.profile >= frame.profiles.size() ||
          tube.first_station + std::size_t{tube.station_count} > frame.stations.size())
        continue;
      Bounds bounds;
      for (std::uint32_t i = 0; i < tube.station_count; ++i) {
        const Station& station = frame.stations[tube.first_station + i];
        if (!drawable(station.position)) continue;
        const Eigen::Quaternionf turn(station.rotation[0], station.rotation[1], station.rotation[2],
                                      station.rotation[3]);
        const Vector3f centre(station.position.data());
        for (const auto& [y, z] : frame.profiles[tube.profile].outline)
          bounds.add(at(Vector3f(centre + turn * Vector3f(0, y, z))));
      }
      bounds.end(boxes);
    }
    return boxes;
  }

 private:
  struct Bounds {
    OverlayBox box{"", std::numeric_limits<float>::max(), std::numeric_limits<float>::max(),
                   std::numeric_limits<float>::lowest(), std::numeric_limits<float>::lowest()};
    void add(const std::optional<ImVec2>& p) {
      if (!p) return;
      box.left = std::min(box.left, p->x);
      box.right = std::max(box.right, p->x);
      box.top = std::min(box.top, p->y);
      box.bottom = std::max(box.bottom, p->y);
    }
    void end(std::vector<OverlayBox>& boxes) const {
      if (box.left <= box.right) boxes.push_back(box);
    }
  };

  const Eigen::Matrix4f all_;
  const OverlayBox room_;
};

/// Finds a place for one label after the other.
class Placing {
 public:
  Placing(const OverlayBox& room, std::span<const OverlayBox> taken, std::vector<OverlayBox> bodies)
      : room_(room),
        taken_(taken.begin(), taken.end()),
        overlays_(taken_.size()),
        bodies_(std::move(bodies)) {}

  /// Of a label of that size beside `at`; nothing: there is no room.
  std::optional<OverlayBox> place(const ImVec2& at, float width, float height, float away) {
    std::optional<OverlayBox> best;
    float least = std::numeric_limits<float>::max();
    const bool covered = is_covered(at);
    const std::size_t farthest = covered ? k_near : std::size(k_farther);
    for (std::size_t far = 0; far < farthest; ++far)
      for (const Side& side : k_label_sides) {
        const float cost_of_way = k_step_away * static_cast<float>(far);
        if (cost_of_way >= least) continue;
        const OverlayBox box = beside(at, side, away + k_farther[far] * height, width, height);
        if (!is_free(box) || (!covered && !line_is_free(at, middle(box)))) continue;
        if (const float cost = cost_of_way + covers(box); cost < least) {
          least = cost;
          best = box;
        }
      }
    if (!best && !covered) best = below_others(at, width, height, away);
    if (best) taken_.push_back(*best);
    return best;
  }

  /// Whether a line from a place to its label runs over no overlay.
  bool line_is_free(const ImVec2& from, const ImVec2& to) const {
    return std::none_of(taken_.begin(), taken_.begin() + static_cast<std::ptrdiff_t>(overlays_),
                        [&](const OverlayBox& other) { return crosses(from, to, other); });
  }

 private:
  OverlayBox beside(const ImVec2& at, const Side& side, float away, float width, float height) const {
    const float left = at.x + side.x * away + (side.x - 1) * width / 2,
                top = at.y + side.y * (side.x == 0 ? away : away + height / 2) - height / 2;
    OverlayBox box{"label", std::round(std::clamp(left, room_.left, room_.right - width)),
                   std::round(std::clamp(top, room_.top, room_.bottom - height)), 0, 0};
    box.right = box.left + width;
    box.bottom = box.top + height;
    return box;
  }
  bool is_free(const OverlayBox& box) const {
    return std::ranges::none_of(taken_, [&](const OverlayBox& other) { return overlap(box, other); });
  }
  /// Whether a place itself is under an overlay: no line leads there then.
  bool is_covered(const ImVec2& at) const {
    return std::any_of(taken_.begin(), taken_.begin() + static_cast<std::ptrdiff_t>(overlays_),
                       [&](const OverlayBox& other) {
                         return at.x > other.left && at.x < other.right && at.y > other.top &&
                                at.y < other.bottom;
                       });
  }
  static ImVec2 middle(const OverlayBox& box) {
    return {(box.left + box.right) / 2, (box.top + box.bottom) / 2};
  }
  /// Share of a label that lies over bodies.
  float covers(const OverlayBox& box) const {
    float area = 0;
    for (const OverlayBox& body : bodies_) area += common_area(box, body);
    const float share = std::min(area / ((box.right - box.left) * (box.bottom - box.top)), 1.f);
    return share < k_hardly ? 0 : std::ceil(k_quarters * share) / k_quarters;
  }
  /// Below all that would be in its way.
  std::optional<OverlayBox> below_others(const ImVec2& at, float width, float height, float away) const {
    OverlayBox box = beside(at, k_label_sides[0], away, width, height);
    const auto is_over = [&](const OverlayBox& other) { return overlap(box, other); };
    for (auto other = taken_.begin(); other != taken_.end();)
      if ((other = std::ranges::find_if(taken_, is_over)) != taken_.end()) {
        box.top = other->bottom + 1;
        box.bottom = box.top + height;
      }
    return box.bottom > room_.bottom ? std::nullopt : std::optional(box);
  }

  const OverlayBox room_;
  std::vector<OverlayBox> taken_;  // the overlays, then labels
  const std::size_t overlays_;
  const std::vector<OverlayBox> bodies_;
};

}  // namespace

void draw_labels(ImDrawList& list, const OverlayFonts& fonts, const SceneFrame& frame, const Camera& camera,
                 const OverlayBox& room, float lowest, std::span<const OverlayBox> taken) {
  if (frame.labels.empty()) return;
  const float unit = fonts.text->FontSize / 17, pad = 3 * unit, away = 9 * unit;
  const ImFont& font = *fonts.small;
  const Projection seen(camera, room);
  OverlayBox above = room;
  above.bottom = lowest;
  Placing placing(above, taken, seen.bodies(frame));
  for (const Label& label : frame.labels) {
    const auto at = seen.at(label.at);
    if (!at || label.words.empty()) continue;
    const float width = text_width(font, label.words) + 2 * pad, height = font.FontSize + 2 * pad;
    if (width > room.right - room.left || height > lowest - room.top) continue;
    const std::optional<OverlayBox> box = placing.place(*at, width, height, away);
    if (!box) continue;
    const ImVec2 end(std::clamp(at->x, box->left, box->right), std::clamp(at->y, box->top, box->bottom));
    if (std::hypot(end.x - at->x, end.y - at->y) > away + height && placing.line_is_free(*at, end))
      list.AddLine(*at, end, colours(frame.dark).title, std::max(1.f, unit));
    list.AddRectFilled({box->left, box->top}, {box->right, box->bottom}, colours(frame.dark).sheet, pad);
    list.AddText(fonts.small, font.FontSize, {box->left + pad, box->top + pad}, colours(frame.dark).title,
                 label.words.c_str());
  }
}

}  // namespace topple::render
