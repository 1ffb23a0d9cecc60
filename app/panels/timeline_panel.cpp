#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "app/chart/lane.h"
#include "app/panels/edit_marks.h"
#include "app/panels/panels.h"
#include "app/picture/body_colour.h"
#include "app/picture/window_words.h"
#include "app/picture/words.h"
#include "app/support/terms.h"
#include "render/scene/text_layout.h"
#include "solver/body/model_level.h"
#include "solver/io/edit/edit_text.h"
#include "solver/model/accelerogram.h"
#include "solver/model/excitation.h"

namespace topple::app {
namespace {

constexpr int k_most_told = 6;                             // marks at one place, in its tooltip
constexpr float k_marks_apart = 2, k_marks_far_apart = 5;  // halves of a mark's width

using namespace window_words;

constexpr double k_tilt_room = 1.35;  // of the critical angle; tilts beyond it are cut there
constexpr double k_least_gal = 10, k_least_tilt = 1;
constexpr double k_headroom = 1.08;  // of the lane of the floor, over its greatest acceleration

constexpr std::size_t k_coloured = 5;  // bodies with a colour of their own

/// As the run begins, rad; 0: none.
double critical_angle(const Player& player, std::size_t body) {
  return player.way().empty() ? 0 : player.way().front()->body[body].critical_angle;
}

/// Tilts over the critical angle of the body; of one that has none, over a quarter turn.
double tilt_share(const io::FrameRow& row, std::size_t body) {
  const double critical = row.body[body].critical_angle;
  return row.body[body].tilt / (critical > 0 ? critical : k_pi / 2);
}

/// Those that tilt most over the run, of what they can, in their own order; one of each colour.
std::vector<std::size_t> coloured_bodies(const TiltHistory& tilts) {
  std::vector<std::pair<double, std::size_t>> shares;
  for (std::size_t b = 0; b < tilts.greatest().size(); ++b) shares.emplace_back(-tilts.greatest()[b], b);
  std::ranges::sort(shares);
  std::vector<std::size_t> coloured;
  for (const auto& [share, b] : shares)
    if (coloured.size() < k_coloured &&
        std::ranges::find(coloured, body_colour(b), body_colour) == coloured.end())
      coloured.push_back(b);
  std::ranges::sort(coloured);
  return coloured;
}

/// That of their paths in the scene.
ImU32 line_colour(const std::vector<std::size_t>& coloured, std::size_t body) {
  if (std::ranges::find(coloured, body) == coloured.end()) return theme().other;
  const auto& [red, green, blue] = body_colour(body);
  const auto clear = [](int part) { return window_is_dark() ? part + (255 - part) / 4 : part; };
  return IM_COL32(clear(red), clear(green), clear(blue), 255);
}

using Value = std::function<double(const io::FrameRow&)>;

void add_curve(ImDrawList& list, const Lane& lane, std::span<const RowPtr> rows, const Value& value,
               ImU32 colour, float thickness) {
  add_curve(
      list, lane, rows, [&](std::size_t i) { return value(*rows[i]); }, colour, thickness);
}

double peak(const std::vector<RowPtr>& rows, const Value& value) {
  double most = 0;
  for (const RowPtr& row : rows) most = std::max(most, std::abs(value(*row)));
  return most;
}

/// The greatest acceleration that a single shake is said to have along an axis, m/s^2; 0: none is said.
double said_peak(const std::vector<Shake>& shakes, int axis) {
  if (shakes.size() != 1 || shakes.front().building) return 0;
  const Shake& shake = shakes.front();
  if (traits(shake.kind).has_amplitude) return std::abs(shake.amplitude * shake.direction[axis]);
  const auto& components = shake.record->components;
  return components.size() == 1
             ? std::abs(shake.scale * shake.record->peak * components.front().direction[axis])
             : 0;
}

}  // namespace

double floor_peak(const std::vector<RowPtr>& rows, const std::vector<Shake>& shakes, double output_rate) {
  constexpr double k_least_missed = 1e-3;  // of the peak
  const double turn = shakes.empty() ? 0 : std::min(highest_frequency(shakes.front()) / output_rate, 0.5);
  const double missed = std::max(1 - std::cos(k_pi * turn), k_least_missed);
  double most = 0;
  for (int k = 0; k < 3; ++k) {
    const Value component = [k](const io::FrameRow& row) { return row.floor_acceleration[k]; };
    const double seen = peak(rows, component), said = said_peak(shakes, k);
    most = std::max(most, seen >= (1 - missed) * said ? std::max(seen, said) : seen);
  }
  return most;
}

namespace {

void add_acceleration(ImDrawList& list, Lane lane, const Player& player, float label_left) {
  const std::vector<RowPtr>& rows = player.way();
  const auto component = [](int k) {
    return [k](const io::FrameRow& row) { return row.floor_acceleration[k] / k_gal; };
  };
  const double most =
      std::max(k_least_gal,
               floor_peak(rows, player.parameters().shakes, player.scene().setup.run.output_rate) / k_gal);
  lane.high = k_headroom * most;
  lane.low = -lane.high;
  list.AddLine({lane.left, lane.y(0)}, {lane.right, lane.y(0)}, theme().faint);
  std::string moving;
  for (int k = 0; k < 3; ++k) {
    if (!rows.empty() && peak(rows, component(k)) == 0) continue;
    add_curve(list, lane, rows, component(k), theme().floor[k], k_thin_curve);
    moving += (moving.empty() ? "" : ", ") + std::string(1, "xyz"[k]);
  }
  const float line = ImGui::GetTextLineHeight();
  add_text(list, label_left, lane.top, theme().text, say(k_floor_lane));
  if (!moving.empty()) add_text(list, label_left, lane.top + line, theme().text, moving);
  const std::string top = fmt::format("{:.0f}", most);
  add_text(list, lane.left - text_width(top) - 6, lane.top - 2, theme().text, top);
}

void add_load_factor(ImDrawList& list, Lane lane, const std::vector<RowPtr>& rows, float label_left) {
  const auto factor = [](const io::FrameRow& row) { return row.load_factor; };
  double least = 0, greatest = 0;
  for (const RowPtr& row : rows) {
    least = std::min(least, row->load_factor);
    greatest = std::max(greatest, row->load_factor);
  }
  lane.low = 1.08 * least;
  lane.high = greatest > least ? 1.08 * greatest : 1;
  list.AddLine({lane.left, lane.y(0)}, {lane.right, lane.y(0)}, theme().faint);
  add_curve(list, lane, rows, factor, theme().floor[0], k_thin_curve);
  add_text(list, label_left, lane.top, theme().text, say(k_load_factor));
  add_text(list, label_left, lane.top + ImGui::GetTextLineHeight(), theme().text, say(k_up_to, greatest));
}

void add_tilts(ImDrawList& list, Lane lane, const Player& player, const TiltHistory& tilts,
               const GhostCurves& ghost, float label_left) {
  const auto& bodies = player.scene().setup.model.bodies;
  const std::size_t furniture = tilts.greatest().size();
  const bool shares = tilts.shares();
  double most = 0;
  for (const double tilt : tilts.greatest())
    most = std::max(most, shares ? std::min(tilt, k_tilt_room) : tilt);
  lane.low = 0;
  lane.high = shares ? k_tilt_room : std::max(k_least_tilt, 1.1 * most);
  list.AddLine({lane.left, lane.bottom}, {lane.right, lane.bottom}, theme().axis);
  const float line = ImGui::GetTextLineHeight();
  if (shares) {
    const int dashes = static_cast<int>(std::ceil((lane.right - lane.left) / 9));
    for (int k = 0; k < dashes; ++k) {
      const float x = lane.left + 9 * static_cast<float>(k);
      list.AddLine({x, lane.y(1)}, {std::min(x + 5, lane.right), lane.y(1)}, theme().axis);
    }
    add_text(list, lane.left + 4, lane.y(1) - line - 1, theme().text,
             most < k_tilt_room ? say(k_critical_at_one) : say(k_critical_and_cut, k_tilt_room));
  }
  const std::vector<float> places = places_of(lane, player.way());
  const std::vector<std::size_t> coloured = coloured_bodies(tilts);
  const auto is_coloured = [&](std::size_t b) { return std::ranges::find(coloured, b) != coloured.end(); };
  for (const bool with_colour : {false, true})  // coloured ones lie on top
    for (std::size_t b = 0; b < furniture; ++b) {
      if (is_coloured(b) != with_colour) continue;
      if (b < ghost.body.size() && ghost.body[b] >= 0) {
        const auto other = static_cast<std::size_t>(ghost.body[b]);
        add_curve(
            list, lane, ghost.way,
            [other, shares](const io::FrameRow& row) {
              return shares ? std::min(tilt_share(row, other), k_tilt_room)
                            : row.body[other].tilt * k_degrees;
            },
            theme().ghost, k_thin_curve);
      }
      add_curve(
          list, lane, places, [&tilts, b](std::size_t i) { return tilts.shown(i, b); },
          with_colour ? line_colour(coloured, b) : theme().other, with_colour ? k_thick_curve : k_thin_curve);
    }
  const float room = lane.left - label_left - 4;
  float y = lane.top - 2;
  add_text(list, label_left, y, theme().text, say(shares ? k_tilt_share_lane : k_tilt_lane));
  const auto fits = static_cast<std::size_t>(std::max((lane.bottom - y) / line - 1, 0.f));
  const bool all = coloured.size() == furniture && coloured.size() <= fits;
  const std::size_t shown =
      all ? coloured.size() : std::min(coloured.size(), fits - std::min<std::size_t>(fits, 1));
  const ImFont& font = *ImGui::GetFont();
  for (std::size_t i = 0; i < shown; ++i) {
    y += line;
    list.AddRectFilled({label_left, y + line / 2 - 1.5f}, {label_left + 10, y + line / 2 + 1.5f},
                       line_colour(coloured, coloured[i]));
    add_text(list, label_left + 14, y, theme().text,
             render::shortened(font, bodies[coloured[i]].name, room - 14));
  }
  if (!all && fits > 0) add_text(list, label_left, y + line, theme().text, say(k_more, furniture - shown));
}

/// When, of a step that has a row in a static run.
std::string when(const Player& player, std::int64_t step, double time) {
  if (!is_static(player.scene().setup)) return fmt::format("{:.3f} s", time);
  const auto at = std::find_if(player.way().begin(), player.way().end(),
                               [step](const RowPtr& row) { return row->step == step; });
  return at == player.way().end() ? say(k_load_step_number, step)
                                  : instant_in_words(player.scene().setup, **at);
}

bool is_pull(const EditMark& mark) {
  return traits(mark.last.edit.key).of == Edit::Of::node;
}

std::string edit_text(const Player& player, const EditMark& mark) {
  const auto instant = [&](const LoggedEdit& edit) { return when(player, edit.step, edit.time); };
  const Edit& edit = mark.last.edit;
  if (!is_pull(mark))
    return say(k_edited, instant(mark.last), io::scene_key(edit, player.scene().setup.model),
               io::edit_value_text(edit, io::EditSpelling::shown));
  const Model& model = player.scene().setup.model;
  return say(k_event, instant(mark.first), model.bodies[model.node_body[edit.index]].name,
             say(k_pulled_until, instant(mark.last)));
}

std::string with_body(const Player& player, const io::RecordedEvent& event, const std::string& what) {
  const Model& model = player.scene().setup.model;
  return say(k_event, when(player, event.step, event.time),
             model.bodies[static_cast<std::size_t>(event.event.body)].name, what);
}

template <const Phrase& what>
std::string body_text(const Player& player, const io::RecordedEvent& event) {
  return with_body(player, event, say(what));
}

std::string anchor_text(const Player& player, const io::RecordedEvent& event) {
  const Anchor& anchor = player.scene().setup.model.anchors[static_cast<std::size_t>(event.event.anchor)];
  return say(k_anchor_breaks, when(player, event.step, event.time), anchor.name, std::abs(event.event.value));
}

std::string model_text(const Player& player, const io::RecordedEvent& event) {
  return with_body(player, event,
                   say(k_computed_as, say(phrase_of(static_cast<ModelLevel>(event.event.value))),
                       say(phrase_of(event.event.reason))));
}

using Draw = void (*)(ImDrawList& list, ImVec2 p, float size, ImU32 colour);

void add_triangle(ImDrawList& list, ImVec2 p, float size, ImU32 colour) {
  list.AddTriangleFilled({p.x - size, p.y + size}, {p.x, p.y - size}, {p.x + size, p.y + size}, colour);
}

void add_bar(ImDrawList& list, ImVec2 p, float size, ImU32 colour) {
  list.AddLine({p.x, p.y - size}, {p.x, p.y + size}, colour, 2);
}

void add_circle(ImDrawList& list, ImVec2 p, float size, ImU32 colour) {
  list.AddCircle(p, size, colour, 12, 1.5f);
}

void add_square(ImDrawList& list, ImVec2 p, float size, ImU32 colour) {
  list.AddRectFilled({p.x - size, p.y - size}, {p.x + size, p.y + size}, colour);
}

void add_open_square(ImDrawList& list, ImVec2 p, float size, ImU32 colour) {
  list.AddRect({p.x - size, p.y - size}, {p.x + size, p.y + size}, colour);
}

/// A cross with an edge, which is seen on what lies under it.
void add_cross(ImDrawList& list, ImVec2 p, float size, ImU32 colour) {
  for (const auto& [width, of] : {std::pair(4.f, theme().halo), std::pair(2.f, colour)}) {
    list.AddLine({p.x - size, p.y - size}, {p.x + size, p.y + size}, of, width);
    list.AddLine({p.x - size, p.y + size}, {p.x + size, p.y - size}, of, width);
  }
}

struct EventMark {
  Event::Kind kind;
  Draw draw;
  const Phrase& words;  ///< in the key
  std::string (*text)(const Player& player, const io::RecordedEvent& event);
  GivesWay gives_way = GivesWay::to_none;
  bool breaks = false;  ///< it lies on top of the others
};
constexpr EventMark k_event_marks[] = {
    {Event::Kind::uplift, add_triangle, k_mark_lifts, body_text<k_lifts>, GivesWay::to_breaks},
    {Event::Kind::impact, add_bar, k_mark_strikes, body_text<k_strikes>, GivesWay::to_breaks},
    {Event::Kind::hinge, add_circle, k_mark_hinge, body_text<k_hinges>},
    {Event::Kind::fracture, add_cross, k_mark_breaks, body_text<k_breaks>, GivesWay::to_none, true},
    {Event::Kind::anchor, add_cross, k_mark_breaks, anchor_text, GivesWay::to_none, true},
    {Event::Kind::overturn, add_square, k_mark_passes, body_text<k_passes>},
    {Event::Kind::model, add_open_square, k_mark_model, model_text, GivesWay::to_all}};

void add_edit_mark(ImDrawList& list, ImVec2 p, float size) {
  list.AddNgonFilled(p, size, theme().edit, 4);
}

/// What the marks of the run mean, in a row from `x` on, as far as there is room.
void add_mark_key(ImDrawList& list, const Player& player, float x, float y, float right) {
  const float line = ImGui::GetTextLineHeight(), size = 0.28f * line;
  const std::vector<io::RecordedEvent> events = player.events();
  const auto add = [&](const Phrase& words, const auto& draw) {
    const std::string text = say(words);
    const float width = line + text_width(text) + 0.8f * line;
    if (x + width > right) return;
    draw(ImVec2(x + line / 2, y + line / 2));
    add_text(list, x + line, y, theme().text, text);
    x += width;
  };
  const Phrase* last = nullptr;
  for (const EventMark& mark : k_event_marks) {
    const auto is_one = [&](const io::RecordedEvent& event) { return event.event.kind == mark.kind; };
    if (&mark.words == last || std::ranges::none_of(events, is_one)) continue;
    add(mark.words, [&](ImVec2 p) { mark.draw(list, p, size, theme().text); });
    last = &mark.words;
  }
  if (!player.edits().empty()) add(k_mark_edit, [&](ImVec2 p) { add_edit_mark(list, p, size); });
}

/// Marks along the bottom of the tilt lane; the one under the mouse says what it is.
void add_marks(ImDrawList& list, const Lane& lane, const Player& player, const TiltHistory& tilts) {
  const float size = 0.28f * ImGui::GetTextLineHeight();
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  std::string hovered;
  int told = 0, more = 0;
  const auto add = [&](double time, float y, const std::function<std::string()>& text, bool drawn,
                       auto shape) {
    const float x = lane.x(time);
    if (x < lane.left || x > lane.right) return;
    if (drawn) shape(ImVec2(x, y));
    if (std::abs(mouse.x - x) >= size || std::abs(mouse.y - y) >= 2 * size) return;
    if (told == k_most_told)
      ++more;
    else
      hovered += (told++ > 0 ? "\n" : "") + text();
  };
  const float y = lane.bottom + size + 2;
  const std::vector<std::size_t> coloured = coloured_bodies(tilts);
  const std::vector<io::RecordedEvent> events = player.events();
  std::vector<PlacedMark> places;
  for (const io::RecordedEvent& event : events) {
    const EventMark& mark = row_of(k_event_marks, event.event.kind);
    places.push_back({lane.x(event.time), mark.gives_way, mark.breaks});
  }
  const std::vector<bool> drawn = drawn_marks(places, k_marks_apart * size, k_marks_far_apart * size);
  const auto draw = [&](const io::RecordedEvent& event, ImVec2 p) {
    row_of(k_event_marks, event.event.kind)
        .draw(list, p, size, line_colour(coloured, static_cast<std::size_t>(event.event.body)));
  };
  for (std::size_t i = 0; i < events.size(); ++i)
    add(
        events[i].time, y,
        [&] { return row_of(k_event_marks, events[i].event.kind).text(player, events[i]); }, drawn[i],
        [&](ImVec2 p) { draw(events[i], p); });
  for (std::size_t i = 0; i < events.size(); ++i)
    if (const float x = places[i].x; places[i].breaks && x >= lane.left && x <= lane.right)
      draw(events[i], {x, y});
  for (const EditMark& mark :
       edit_marks(player.edits(), [&](const LoggedEdit& edit) { return player.goes_on(edit); }))
    add(
        is_pull(mark) ? mark.first.time : mark.last.time, lane.top, [&] { return edit_text(player, mark); },
        true, [&](ImVec2 p) { add_edit_mark(list, p, size); });
  if (player.way().empty()) return;
  for (const Stretch& stretch : player.history().way_to(player.shown_branch()))
    for (const Branch& branch : player.history().branches) {
      if (branch.id != stretch.branch || branch.parent < 0 || branch.fork_step == 0) continue;
      const auto at = std::find_if(player.way().begin(), player.way().end(),
                                   [&](const RowPtr& row) { return row->branch == branch.id; });
      if (at == player.way().end()) continue;
      const float x = lane.x((*at)->time);
      list.AddLine({x, lane.top}, {x, lane.bottom}, theme().axis);
    }
  if (more > 0) hovered += "\n" + say(k_more, more);
  if (!hovered.empty()) ImGui::SetTooltip("%s", hovered.c_str());
}

}  // namespace

void TiltHistory::follow(const Player& player) {
  const std::vector<RowPtr>& way = player.way();
  const std::size_t pieces = static_cast<std::size_t>(player.scene().setup.model.furniture_total());
  std::size_t rows = pieces == 0 ? 0 : shown_.size() / pieces;
  const bool goes_on = rows > 0 && greatest_.size() == pieces && rows <= way.size() &&
                       way.front() == first_ && way[rows - 1] == last_;
  if (!goes_on) {
    rows = 0;
    shown_.clear();
    greatest_.assign(pieces, 0);
    shares_ = false;  // else nothing falls by itself
    for (std::size_t b = 0; b < pieces; ++b) shares_ |= critical_angle(player, b) > 0;
  }
  for (; rows < way.size(); ++rows)
    for (std::size_t b = 0; b < pieces; ++b) {
      const io::FrameRow& row = *way[rows];
      const double tilt = shares_ ? tilt_share(row, b) : row.body[b].tilt * k_degrees;
      greatest_[b] = std::max(greatest_[b], tilt);
      shown_.push_back(static_cast<float>(shares_ ? std::min(tilt, k_tilt_room) : tilt));
    }
  if (!way.empty()) first_ = way.front(), last_ = way.back();
}

void draw_timeline(Player& player, const Box& box, TiltHistory& tilts, const GhostCurves& ghost) {
  begin_panel("timeline", box);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float line = ImGui::GetTextLineHeight();
  const float padding = ImGui::GetStyle().WindowPadding.x;
  const float label_left = box.left + padding;
  Lane lane{box.left + 7.5f * line,
            box.left + box.width - 1.2f * padding,
            box.top + 8,
            box.top + box.height - 2.77f * line - 6,
            player.length(),
            0,
            1};
  const float height = lane.bottom - lane.top;
  Lane upper = lane, lower = lane;
  upper.bottom = lane.top + 0.4f * height;
  lower.top = lane.top + 0.46f * height;
  if (is_static(player.scene().setup))
    add_load_factor(list, upper, player.way(), label_left);
  else
    add_acceleration(list, upper, player, label_left);
  tilts.follow(player);
  add_tilts(list, lower, player, tilts, ghost, label_left);
  add_axis(list, lower, player.scene().setup, label_left);

  const float x = lane.x(player.time());
  list.AddLine({x, lane.top}, {x, lane.bottom}, theme().cursor, 1.5f);
  list.AddTriangleFilled({x - 5, lane.top - 5}, {x + 5, lane.top - 5}, {x, lane.top + 3}, theme().cursor);
  ImGui::SetCursorScreenPos({lane.left, lane.top});
  ImGui::InvisibleButton("scrub", {lane.right - lane.left, height + line});
  if (ImGui::IsItemActive())
    player.scrub((ImGui::GetIO().MousePos.x - lane.left) / (lane.right - lane.left) * player.length());
  if (ImGui::IsItemFocused() && ImGui::GetIO().NavVisible) {
    list.AddRect(ImGui::GetItemRectMin(), ImGui::GetItemRectMax(), ImGui::GetColorU32(ImGuiCol_NavHighlight),
                 3, 0, 2);
    if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_LeftArrow))) player.step(-1);
    if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_RightArrow))) player.step(1);
  }
  add_marks(list, lower, player, tilts);
  add_mark_key(list, player, lane.left, box.top + box.height - 1.15f * line, lane.right);
  ImGui::End();
}

}  // namespace topple::app
