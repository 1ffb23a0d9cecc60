#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/chart/lane.h"
#include "app/chart/log_chart.h"
#include "app/panels/load_path.h"
#include "app/panels/load_path_words.h"
#include "app/panels/panels.h"
#include "app/picture/words.h"
#include "app/support/terms.h"
#include "render/scene/text_layout.h"
#include "render/scene/ticks.h"
#include "solver/model/table.h"

namespace topple::app {
namespace {

using namespace window_words;

constexpr float k_dash = 4;             // px, of unstable stretches
constexpr double k_rounding = 1e-6;     // m or rad, of what rows hold in single precision
constexpr double k_in_millimetres = 1;  // m: travels below it

struct LossWord {
  Stability::Loss kind;
  const Phrase& words;
};
constexpr LossWord k_loss_words[] = {{Stability::Loss::limit_point, k_limit_point},
                                     {Stability::Loss::buckling, k_buckles},
                                     {Stability::Loss::mechanism, k_mechanism},
                                     {Stability::Loss::fracture, k_section_breaks}};

struct PathChart : ChartBox {
  PathAxis x, y;
  ImVec2 at(double travel, double factor) const {
    return {left + x.part(travel) * (right - left), bottom - y.part(factor) * (bottom - top)};
  }
};

/// Of what a path is drawn over.
struct PathUnit {
  const char* word;
  double size;  ///< SI
};
PathUnit unit_of(const PathMeasure& measure, const std::vector<double>& travels) {
  if (measure.direction >= 3) return {"°", 1 / k_degrees};
  double most = 0;
  for (const double travel : travels) most = std::max(most, std::abs(travel));
  return most < k_in_millimetres ? PathUnit{"mm", 1e-3} : PathUnit{"m", 1};
}

render::Ticks ticks_of(const PathAxis& axis, float length, float apart) {
  return render::nice_ticks(axis.low, axis.high, std::max(2, static_cast<int>(length / apart)));
}

std::string tick_text(double value, const render::Ticks& ticks) {
  return fmt::format("{:.{}f}", value + 0., ticks.decimals);  // + 0 makes 0 of -0
}

/// The chart with its grid and numbers, in the window under way.
PathChart draw_path_grid(ImDrawList& list, const Box& box, const PathAxis& x, const PathAxis& y) {
  const float line = ImGui::GetTextLineHeight(), padding = ImGui::GetStyle().WindowPadding.x;
  PathChart chart{{.left = box.left + padding,
                   .right = box.left + box.width - 1.5f * padding,
                   .top = box.top + padding + 1.3f * line,
                   .bottom = box.top + box.height - 4.9f * line},
                  x,
                  y};
  add_text(list, chart.left, box.top + padding, theme().text, say(k_load_factor));
  const render::Ticks up = ticks_of(y, chart.bottom - chart.top, 2 * line);
  float numbers = 0;
  for (const double value : up.values) numbers = std::max(numbers, text_width(tick_text(value, up)));
  chart.left += numbers + 6;
  list.AddRectFilled({chart.left, chart.top}, {chart.right, chart.bottom}, theme().sheet);
  for (const double value : up.values) {
    const float at = chart.at(x.low, value).y;
    list.AddLine({chart.left, at}, {chart.right, at}, theme().faint);
    const std::string text = tick_text(value, up);
    add_text(list, chart.left - text_width(text) - 4, at - line / 2, theme().text, text);
  }
  const render::Ticks along = ticks_of(x, chart.right - chart.left, 4 * line);
  for (const double value : along.values) {
    const float at = chart.at(value, y.low).x;
    list.AddLine({at, chart.top}, {at, chart.bottom}, theme().faint);
    const std::string text = tick_text(value, along);
    const float width = text_width(text);  // the first one would lie on the lowest of the other axis
    add_text(list, std::clamp(at - width / 2, chart.left, box.left + box.width - width - 2), chart.bottom + 2,
             theme().text, text);
  }
  list.AddRect({chart.left, chart.top}, {chart.right, chart.bottom}, theme().axis);
  return chart;
}

/// Stable stretches, then those with an end that is not.
void draw_stretches(ImDrawList& list, const Player& player, const std::vector<ImVec2>& points) {
  const auto unstable = [&](std::size_t i) {
    const Stability* const told = player.stability(*player.way()[i]);
    return told && !told->stable();
  };
  std::vector<ImVec2> stretch{points.front()};
  for (std::size_t i = 1; i < points.size(); ++i) {
    const bool now = unstable(i - 1) || unstable(i);
    stretch.push_back(points[i]);
    if (i + 1 < points.size() && now == (unstable(i) || unstable(i + 1))) continue;
    add_line(list, stretch, now ? theme().hinge : theme().line, now ? k_dash : 0);
    stretch = {points[i]};
  }
}

/// A place beside a ring for a word of that size, apart from what is `taken`, and from the path if there is
/// one; none: {0, 0, 0, 0}.
ImVec4 room_for_word(const PathChart& chart, ImVec2 at, float away, ImVec2 size,
                     const std::vector<ImVec4>& taken, const std::vector<ImVec2>& path) {
  const float most = std::max(chart.left + 3, chart.right - size.x - 3);
  const float middle = std::clamp(at.x - size.x / 2, chart.left + 3, most);
  const float left = std::clamp(at.x - away - size.x, chart.left + 3, most),
              right = std::min(at.x + away, most);
  std::vector<ImVec4> apart;
  for (const float y : {at.y - away - size.y, at.y - size.y / 2, at.y + away, at.y + away + size.y,
                        at.y + away + 2 * size.y, at.y + away + 3 * size.y})
    for (const float x : {middle, right, left}) {
      const ImVec4 room{x, y, x + size.x, y + size.y};
      const bool free = room.y > chart.top && room.w < chart.bottom &&
                        std::ranges::none_of(taken, [&](const ImVec4& other) {
                          return room.x < other.z && other.x < room.z && room.y < other.w && other.y < room.w;
                        });
      if (free) apart.push_back(room);
    }
  for (const ImVec4& room : apart)
    if (std::ranges::none_of(
            path, [&](ImVec2 p) { return p.x > room.x && p.x < room.z && p.y > room.y && p.y < room.w; }))
      return room;
  return apart.empty() ? ImVec4{0, 0, 0, 0} : apart.front();
}

/// Load steps at which stability is lost in a way that it was not since the path was last stable.
std::vector<std::size_t> losses(const Player& player) {
  std::vector<std::size_t> out;
  std::vector<Stability::Loss> lost;
  for (std::size_t i = 0; i < player.way().size(); ++i) {
    const Stability* const told = player.stability(*player.way()[i]);
    if (!told || told->loss == Stability::Loss::none) {
      lost.clear();
    } else if (std::ranges::find(lost, told->loss) == lost.end()) {
      lost.push_back(told->loss);
      out.push_back(i);
    }
  }
  return out;
}

/// Rings where stability is lost, with words beside them as far as they have room.
void draw_losses(ImDrawList& list, const Player& player, const PathChart& chart,
                 const std::vector<ImVec2>& points) {
  const float line = ImGui::GetTextLineHeight(), radius = 0.36f * line;
  const Model& model = player.scene().setup.model;
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const std::vector<std::size_t> lost = losses(player);
  std::vector<ImVec4> taken;
  for (const std::size_t i : lost) {
    list.AddCircle(points[i], radius, theme().text, 16, 1.6f);
    taken.emplace_back(points[i].x - radius, points[i].y - radius, points[i].x + radius,
                       points[i].y + radius);
  }
  for (const std::size_t i : lost) {
    const io::FrameRow& row = *player.way()[i];
    const Stability& told = *player.stability(row);
    const std::string words = say(row_of(k_loss_words, told.loss).words);
    if (std::hypot(mouse.x - points[i].x, mouse.y - points[i].y) < 1.5f * radius && told.node >= 0) {
      const Body& body = model.bodies[static_cast<std::size_t>(model.node_body[told.node])];
      const Member* const within = member_within(model, told.node);
      const std::string place =
          within == nullptr ? say(k_node, told.node - body.first_node) : say(k_inside_of, within->name);
      ImGui::SetTooltip(
          "%s",
          say(k_moves_most, instant_in_words(player.scene().setup, row), words, place, body.name).c_str());
    }
    const ImVec4 room = room_for_word(chart, points[i], radius + 3, {text_width(words), line}, taken, points);
    if (room.z == 0) continue;
    const ImVec2 to(std::clamp(points[i].x, room.x, room.z), std::clamp(points[i].y, room.y, room.w));
    const float way = std::hypot(to.x - points[i].x, to.y - points[i].y),
                edge = radius / std::max(way, radius);
    list.AddLine({points[i].x + edge * (to.x - points[i].x), points[i].y + edge * (to.y - points[i].y)}, to,
                 theme().axis);
    add_text(list, room.x, room.y, theme().text, words);
    taken.push_back(room);
  }
}

void draw_path_key(ImDrawList& list, const Player& player, const PathChart& chart,
                   const std::string& x_title) {
  const auto is = [&](bool stable) {
    return std::ranges::any_of(player.way(), [&](const RowPtr& row) {
      const Stability* const told = player.stability(*row);
      return told && told->stable() == stable;
    });
  };
  const bool stable = is(true), unstable = is(false);
  ChartKey key(list, chart, x_title);
  std::vector<LogCurve> curves;
  if (stable || !unstable)
    curves.push_back({say(stable ? k_stable : k_stability_unknown), theme().line, 0, {}});
  if (unstable) curves.push_back({say(k_unstable), theme().hinge, k_dash, {}});
  key.lines(curves);
}

}  // namespace

void draw_load_path(Player& player, const Box& box) {
  begin_panel("load path", box);
  const std::vector<RowPtr>& way = player.way();
  const auto now = player.row();
  const float line = ImGui::GetTextLineHeight();
  if (way.empty() || !now || box.height < 9 * line) {
    ImGui::End();
    return;
  }
  const Setup& setup = player.scene().setup;
  const PathMeasure measure = path_measure(setup, *way.front(), *way.back());
  std::vector<double> along = travels(setup.model, measure, way), factors;
  for (const RowPtr& row : way) factors.push_back(row->load_factor);
  const auto finite = [](double value) { return std::isfinite(value); };
  if (!std::ranges::all_of(along, finite) || !std::ranges::all_of(factors, finite)) {
    ImGui::End();
    return;
  }
  const std::size_t before = static_cast<std::size_t>(
      std::ranges::upper_bound(way, now->time, {}, [](const RowPtr& row) { return row->time; }) -
      way.begin());
  const PathUnit unit = unit_of(measure, along);
  const double here =
      travel(setup.model, measure, *now, along[std::max<std::size_t>(before, 1) - 1]) / unit.size;
  for (double& value : along) value /= unit.size;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const PathChart chart = draw_path_grid(list, box, {along, k_rounding / unit.size}, {factors, 0});
  std::vector<ImVec2> points;
  for (std::size_t i = 0; i < way.size(); ++i) points.push_back(chart.at(along[i], factors[i]));
  list.PushClipRect({chart.left, chart.top}, {chart.right, chart.bottom}, true);
  draw_stretches(list, player, points);
  draw_losses(list, player, chart, points);
  add_present(list, chart.at(here, now->load_factor));
  list.PopClipRect();
  const ImFont& font = *ImGui::GetFont();
  const std::string title = render::shortened(
      font, name_of(setup, measure), chart.right - chart.left - text_width(std::string(", ") + unit.word));
  draw_path_key(list, player, chart, title + ", " + unit.word);
  ImGui::SetCursorScreenPos({chart.left, chart.top});
  ImGui::InvisibleButton("path", {chart.right - chart.left, chart.bottom - chart.top});
  if (ImGui::IsItemActive()) player.scrub(way[nearest_point(points, ImGui::GetIO().MousePos)]->time);
  if (ImGui::IsItemFocused() && ImGui::GetIO().NavVisible) {
    list.AddRect(ImGui::GetItemRectMin(), ImGui::GetItemRectMax(), ImGui::GetColorU32(ImGuiCol_NavHighlight),
                 3, 0, 2);
    if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_LeftArrow))) player.step(-1);
    if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_RightArrow))) player.step(1);
  }
  ImGui::End();
}

}  // namespace topple::app
