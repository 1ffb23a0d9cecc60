#include "app/panels/map_panel.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "app/chart/lane.h"
#include "app/chart/log_chart.h"
#include "app/panels/teaching_words.h"
#include "solver/body/model_level.h"
#include "solver/io/edit/edit_text.h"

namespace topple::app {
namespace {

using namespace window_words;
using study::Axis;
using study::Verdict;

constexpr double k_same = 1e-6;  // relative, of values that are an axis's

constexpr Verdict k_verdicts[] = {Verdict::all, Verdict::some, Verdict::rocks, Verdict::stands,
                                  Verdict::failed};

const Phrase& words_of(Verdict verdict) {
  static constexpr const Phrase* k_words[] = {&k_not_computed,  &k_run_failed, &k_all_overturn,
                                              &k_some_overturn, &k_rocks,      &k_stands_still};
  return *k_words[static_cast<int>(verdict)];
}

std::string title_of(const Axis& axis) {
  return say(axis.name == "frequency"  ? k_frequency_axis
             : axis.name == "duration" ? k_duration_axis
                                       : k_amplitude_axis);
}

Edit edit_of(const Axis& axis, const Parameters& now) {
  Edit edit = *io::parse_edit_key(axis.key);
  edit.value = edited_value(now, edit.key, edit.index);
  return edit;
}

double value_now(const Axis& axis, const Parameters& now) {
  return edit_of(axis, now).value.x() / axis.si;
}

LogAxis range_of(const Axis& axis) {
  const std::vector<double> edges = axis.edges();
  return {edges.front(), edges.back()};
}

/// Where the axis has a value; -1: beyond its ends.
int place_on(const Axis& axis, double value) {
  const std::vector<double> edges = axis.edges();
  const auto after = std::ranges::upper_bound(edges, value);
  return after == edges.end() ? -1 : static_cast<int>(after - edges.begin()) - 1;
}

const study::OverturnPoint& point(const OverturnFound& found, int i, int j) {
  return found.map.points[static_cast<std::size_t>(j * found.plan->x.count() + i)];
}

/// The floor's shake was computed from that of a building's ground.
bool moves_ground(const Player& player) {
  const std::vector<Shake>& shakes = player.parameters().shakes;
  return !shakes.empty() && shakes.front().building != nullptr;
}

/// Shakes from now on as at this point; one thing to undo.
void load(Player& player, const study::OverturnPlan& plan, int i, int j, std::string& refused) {
  player.begin_edit();
  try {
    for (const auto& [axis, k] : {std::pair(&plan.x, i), std::pair(&plan.y, j)}) {
      Edit edit = edit_of(*axis, player.parameters());
      edit.value.x() = axis->in_si(k);
      player.edit(edit);
    }
    refused.clear();
  } catch (const io::InputError& error) {
    refused = error.what();
  }
}

/// What tells verdicts apart without colours.
void add_mark(ImDrawList& list, ImVec2 at, float size, Verdict verdict) {
  const ImU32 ink = theme().verdict[static_cast<int>(verdict)].mark;
  const float r = 0.28f * size;
  const float thin = std::max(1.f, 0.12f * size);
  if (verdict == Verdict::rocks) list.AddCircleFilled(at, 0.6f * r, ink, 10);
  if (verdict == Verdict::some)
    list.AddTriangleFilled({at.x - r, at.y + 0.8f * r}, {at.x + r, at.y + 0.8f * r}, {at.x, at.y - r}, ink);
  if (verdict == Verdict::failed) {
    list.AddLine({at.x, at.y - r}, {at.x, at.y + r}, ink, thin);
    list.AddLine({at.x - r, at.y}, {at.x + r, at.y}, ink, thin);
  }
  if (verdict == Verdict::all) {
    list.AddLine({at.x - r, at.y - r}, {at.x + r, at.y + r}, ink, thin);
    list.AddLine({at.x - r, at.y + r}, {at.x + r, at.y - r}, ink, thin);
  }
}

/// What runs within the cell say: some overturn, some do not. Nothing where its neighbours agree with it.
std::optional<study::CellShare> doubt(const OverturnFound& found, int i, int j) {
  const auto place = static_cast<std::size_t>(j * found.plan->x.count() + i);
  if (place >= found.shares.size() || !found.shares[place]) return std::nullopt;
  const study::CellShare& share = *found.shares[place];
  return share.overturned > 0 && share.overturned < share.runs ? std::optional(share) : std::nullopt;
}

void add_doubt(ImDrawList& list, ImVec2 at, float size) {
  list.AddCircle(at, 0.4f * size, theme().text, 16, std::max(1.f, 0.1f * size));
}

void draw_cells(ImDrawList& list, const LogChart& chart, const OverturnFound& found) {
  const std::vector<double> x = found.plan->x.edges(), y = found.plan->y.edges();
  for (std::size_t j = 0; j + 1 < y.size(); ++j)
    for (std::size_t i = 0; i + 1 < x.size(); ++i) {
      const Verdict verdict = point(found, static_cast<int>(i), static_cast<int>(j)).verdict;
      if (verdict == Verdict::not_computed) continue;
      const ImVec2 low = chart.at(x[i], y[j]), high = chart.at(x[i + 1], y[j + 1]);
      list.AddRectFilled({low.x, high.y}, {high.x, low.y}, theme().verdict[static_cast<int>(verdict)].fill);
      const ImVec2 middle{(low.x + high.x) / 2, (low.y + high.y) / 2};
      const float size = std::min(high.x - low.x, low.y - high.y);
      add_mark(list, middle, size, verdict);
      if (doubt(found, static_cast<int>(i), static_cast<int>(j))) add_doubt(list, middle, size);
    }
}

std::vector<LogCurve> curves_of(const LogChart& chart, const study::Criteria& criteria) {
  const float dash = 0.45f * ImGui::GetTextLineHeight();
  std::vector<LogCurve> curves;
  for (const study::Criterion& criterion : criteria.list) {
    LogCurve curve{say(k_one_pulse), theme().text, 0.35f * dash, {}};
    if (criterion.name == "west") curve = {say(k_west), theme().positive, 0, {}};
    if (criterion.name == "ishiyama") curve = {say(k_ishiyama), theme().line, dash, {}};
    if (criterion.name == "one-sine") curve.name = say(k_one_cycle);
    for (std::size_t n = 0; n < criterion.x.size(); ++n)
      curve.points.push_back(chart.at(criterion.x[n], criterion.y[n]));
    curves.push_back(std::move(curve));
  }
  return curves;
}

/// Names of the pieces that overturn in most runs of a cell, or in half of them.
std::string fallen_in_words(const study::OverturnMap& map, const study::OverturnPoint& at) {
  std::string names;
  for (std::size_t b = 0; b < at.fell.size(); ++b)
    if (2 * at.fell[b] >= at.runs) names += (names.empty() ? "" : say(k_comma)) + map.bodies[b];
  return names;
}

/// The verdict; where neighbours disagree what runs within the cell say too: a probability if they differ.
std::string outcome_in_words(const OverturnFound& found, int i, int j) {
  const study::OverturnPoint& at = point(found, i, j);
  const auto place = static_cast<std::size_t>(j * found.plan->x.count() + i);
  const bool near_an_edge = place < found.shares.size() && found.shares[place];
  const study::CellShare share = near_an_edge ? *found.shares[place] : study::CellShare();
  if (doubt(found, i, j)) {
    const study::Interval within = study::wilson(share.overturned, share.runs);
    return say(k_map_unsure, share.overturned, share.runs, 100 * share.probability(), 100 * within.low,
               100 * within.high);
  }
  std::string verdict = say(words_of(at.verdict));
  if (at.verdict == Verdict::some) verdict += say(k_colon) + fallen_in_words(found.map, at);
  if (const auto time = at.time(0.5)) verdict += say(k_map_first_at, *time);
  if (at.verdict == Verdict::failed) verdict += say(k_colon) + at.status;
  if (near_an_edge) verdict += say(share.overturned > 0 ? k_map_all_fall : k_map_all_stand, share.runs);
  return verdict;
}

std::string cell_in_words(const OverturnFound& found, int i, int j) {
  const Axis &x = found.plan->x, &y = found.plan->y;
  return say(k_map_cell, x.values[static_cast<std::size_t>(i)], x.unit, y.values[static_cast<std::size_t>(j)],
             y.unit, outcome_in_words(found, i, j));
}

/// The cell below the mouse: told, and loaded by a click.
void handle_mouse(Player& player, const LogChart& chart, const OverturnFound& found, std::string& refused) {
  if (!ImGui::IsWindowHovered() ||
      !ImGui::IsMouseHoveringRect({chart.left, chart.top}, {chart.right, chart.bottom}))
    return;
  const ImVec2 at = ImGui::GetIO().MousePos;
  const auto value = [](const LogAxis& axis, float part) {
    return axis.low * std::pow(axis.high / axis.low, static_cast<double>(part));
  };
  const int i = place_on(found.plan->x, value(chart.x, (at.x - chart.left) / (chart.right - chart.left)));
  const int j = place_on(found.plan->y, value(chart.y, (chart.bottom - at.y) / (chart.bottom - chart.top)));
  if (i < 0 || j < 0) return;
  const float gap = 4 * ImGui::GetTextLineHeight();
  ImGui::SetNextWindowPos({chart.left - gap, at.y}, ImGuiCond_Always, {1, 0.5f});  // beside the cells
  const bool of_ground = moves_ground(player), can = player.can_edit() && !of_ground;
  ImGui::SetTooltip("%s\n%s", cell_in_words(found, i, j).c_str(),
                    say(can         ? k_map_click
                        : of_ground ? k_map_of_ground
                                    : k_map_no_click)
                        .c_str());
  if (ImGui::IsMouseClicked(0) && can) load(player, *found.plan, i, j, refused);
}

/// The way for the keyboard: to the cells beside that of the present shake.
void draw_steps(Player& player, const OverturnFound& found, std::string& refused) {
  const study::OverturnPlan& plan = *found.plan;
  const auto nearest = [&](const Axis& axis) {
    const double now = std::clamp(value_now(axis, player.parameters()), axis.edges().front(),
                                  std::nextafter(axis.edges().back(), 0));
    return place_on(axis, now);
  };
  const int i = nearest(plan.x), j = nearest(plan.y);
  const auto step = [&](const char* name, ImGuiDir direction, int to_i, int to_j) {
    const bool there = to_i >= 0 && to_i < plan.x.count() && to_j >= 0 && to_j < plan.y.count();
    ImGui::SameLine();
    ImGui::BeginDisabled(!there || !player.can_edit() || moves_ground(player));
    if (ImGui::ArrowButton(name, direction)) load(player, plan, to_i, to_j, refused);
    ImGui::EndDisabled();
  };
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(title_of(plan.x).c_str());
  step("##lower", ImGuiDir_Left, i - 1, j);
  step("##higher", ImGuiDir_Right, i + 1, j);
  const std::string title = title_of(plan.y);
  const float frame = ImGui::GetFrameHeight(), gap = ImGui::GetStyle().ItemSpacing.x;
  ImGui::SameLine();
  if (ImGui::GetContentRegionAvail().x < text_width(title) + 2 * (frame + gap)) ImGui::NewLine();
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(title.c_str());
  step("##weaker", ImGuiDir_Down, i, j - 1);
  step("##stronger", ImGuiDir_Up, i, j + 1);
}

/// Whether parameters other than the axes differ from these.
bool has_changed(const Player& player, const study::OverturnPlan& plan, const Parameters& of) {
  const auto of_axis = [&](Edit::Key key, int index) {
    const std::string name = io::edit_key({key, index});
    return name == plan.x.key || name == plan.y.key;
  };
  return parameters_differ(player.scene().setup.model, player.parameters(), of, of_axis);
}

bool can_have_map(const Player& player) {
  const Parameters& now = player.parameters();
  const Setup& setup = player.scene().setup;
  return !player.way().empty() && setup.run.analysis == Analysis::dynamic &&
         setup.model.furniture_total() > 0 && study::usual_axes(now.shakes) != nullptr;
}

void show(const std::shared_ptr<const OverturnFound>& found, MapState& state) {
  if (state.shown != found) {
    const study::Criteria& criteria = found->map.criteria;
    state.soft_limit.reset();
    if (!criteria.list.empty()) state.soft_limit = study::soft_limit(criteria.body, state.of.contact);
    state.bends.clear();
    const Model& model = found->plan->scene.setup.model;
    for (int b = 0; b < model.furniture_total() && found->map.planar > 0 && state.bends.empty(); ++b)
      if (base_level(model, state.of, b).reason == LevelReason::bending) state.bends = model.bodies[b].name;
  }
  state.shown = found;
  state.shown_of = state.of;
}

}  // namespace

std::string no_lines_in_words(Language language, const std::string& why) {
  for (const Phrase& reason :
       {k_lines_several, k_lines_building, k_lines_steep, k_lines_moving, k_lines_no_block})
    if (reason.english == why) return say_in(language, reason);
  return why;
}

std::string present_in_words(const OverturnFound& found, const Parameters& now) {
  const Axis &x = found.plan->x, &y = found.plan->y;
  const double at_x = value_now(x, now), at_y = value_now(y, now);
  const int i = place_on(x, at_x), j = place_on(y, at_y);
  if (i < 0 || j < 0) return say(k_map_outside);
  const auto is_of = [](double value, const Axis& axis, int k) {
    return std::abs(value / axis.values[static_cast<std::size_t>(k)] - 1) <= k_same;
  };
  const std::string cell = cell_in_words(found, i, j);
  return is_of(at_x, x, i) && is_of(at_y, y, j) ? say(k_map_here_exact, cell)
                                                : say(k_map_here, cell, at_x, x.unit, at_y, y.unit);
}

void update_map(const Player& player, MapState& state) {
  using Follows = MapState::Follows;
  const bool over = state.search && state.search->over();  // asked first: the last result comes before it
  const auto found = state.search ? state.search->result() : nullptr;
  if (found && found->plan && (over || !state.shown || state.follows != Follows::yes)) show(found, state);
  const bool failed = over && found && !found->plan;
  if (failed) state.shown.reset();
  if (over && state.follows == Follows::untried) {
    state.follows = failed ? Follows::no : Follows::yes;
    if (failed) state.search.reset();  // a button asks for the map
  }
  if (state.follows == Follows::no || !can_have_map(player)) return;
  if (state.search && !over) return;
  const bool changed = !state.search || (state.shown ? has_changed(player, *state.shown->plan, state.of)
                                                     : !(player.parameters() == state.of));
  if (!changed) return;
  state.of = player.parameters();
  state.search = search_overturning(player.scene(), state.of, true);
}

bool draw_map(Player& player, MapState& state, std::string& refused) {
  update_map(player, state);
  const std::shared_ptr<const OverturnFound> found = state.shown;
  if (!found) return false;
  const study::OverturnPlan& plan = *found->plan;
  const float line = ImGui::GetTextLineHeight();
  const float height = std::min(0.9f * ImGui::GetContentRegionAvail().x, 26 * line);
  const LogChart chart = chart_at_cursor(range_of(plan.x), range_of(plan.y), height, title_of(plan.y));
  state.cells = {chart.left, chart.top, chart.right - chart.left, chart.bottom - chart.top};
  ImDrawList& list = *ImGui::GetWindowDrawList();
  draw_log_grid(list, chart);
  list.PushClipRect({chart.left, chart.top}, {chart.right, chart.bottom}, true);
  draw_cells(list, chart, *found);
  const std::vector<LogCurve> curves = curves_of(chart, found->map.criteria);
  for (const LogCurve& curve : curves) add_line(list, curve.points, curve.colour, curve.dash);
  const double x = value_now(plan.x, player.parameters()), y = value_now(plan.y, player.parameters());
  add_present(list, chart.clamped(x, y));
  list.PopClipRect();
  handle_mouse(player, chart, *found, refused);
  ChartKey key(list, chart, title_of(plan.x));
  key.begin_line();
  for (const Verdict verdict : k_verdicts) {
    if (std::ranges::none_of(found->map.points, [=](const auto& p) { return p.verdict == verdict; }))
      continue;
    const ImVec2 at = key.entry(say(words_of(verdict)));
    const float half = 0.5f * line;
    list.AddRectFilled({at.x - half, at.y - half}, {at.x + half, at.y + half},
                       theme().verdict[static_cast<int>(verdict)].fill);
    list.AddRect({at.x - half, at.y - half}, {at.x + half, at.y + half}, theme().axis);
    add_mark(list, at, line, verdict);
  }
  bool doubts = false;
  for (int k = 0; k < plan.x.count() * plan.y.count(); ++k)
    doubts = doubts || doubt(*found, k % plan.x.count(), k / plan.x.count());
  if (doubts) add_doubt(list, key.entry(say(k_map_doubt)), line);
  if (!curves.empty()) key.lines(curves);
  add_present(list, key.entry(say(k_present)));
  key.end();
  if (state.follows != MapState::Follows::yes && has_changed(player, plan, state.shown_of)) {
    text_wrapped(say(k_map_stale));  // what follows would be of another shake
    draw_steps(player, *found, refused);
    return true;
  }
  if (!curves.empty())
    text_wrapped(
        (say(k_map_lines, found->map.criteria.bodies) +
         (state.soft_limit ? say(k_full_stop) + " " + say(k_map_soft, *state.soft_limit / k_gal) : "")));
  else if (!found->map.criteria.why_not.empty())  // else they are not there yet
    text_wrapped(say(k_map_no_lines, no_lines_in_words(window_language(), found->map.criteria.why_not)));
  text_wrapped(present_in_words(*found, player.parameters()));
  if (!state.bends.empty()) text_wrapped(say(k_map_rigid, state.bends));
  draw_steps(player, *found, refused);
  return true;
}

void draw_map_controls(const Player& player, MapState& state) {
  using Follows = MapState::Follows;
  const bool trying = state.follows == Follows::untried;  // whether the map can follow: nobody asked for it
  const auto found = state.search && !trying ? state.search->result() : nullptr;
  const bool busy = state.search && !state.search->over(), searching = busy && !trying;
  if (busy && trying && state.shown) {
    ImGui::TextUnformatted(say(k_map_progress, state.shown->map.run, state.shown->map.of).c_str());
    ImGui::ProgressBar(static_cast<float>(state.search->progress()), {-1, 0.5f * ImGui::GetTextLineHeight()},
                       "");
    return;
  }
  const bool failed = found && !busy && !found->plan;  // as of a shake askew, until the sliders move again
  if (state.follows == Follows::yes && !failed) {
    ImGui::TextDisabled("%s", say(k_map_follows).c_str());
  } else {
    if (searching) {
      const auto progress = static_cast<float>(state.search->progress());
      if (found) ImGui::TextUnformatted(say(k_map_progress, found->map.run, found->map.of).c_str());
      ImGui::ProgressBar(progress, {-1, 0.5f * ImGui::GetTextLineHeight()}, "");
      if (ImGui::Button((say(k_cancel) + "##cancel-map").c_str())) state.search->stop();
      return;
    }
    if (found && !found->failure.empty())
      text_wrapped(state.follows == Follows::yes ? say(k_map_cannot_follow)
                                                 : say(k_map_failed, found->failure));
    const bool can = can_have_map(player);
    ImGui::BeginDisabled(!can);
    const bool asked = ImGui::Button((say(state.shown ? k_map_again : k_overturning_map) + "##map").c_str(),
                                     {found && !failed ? 0.f : -1.f, 0});
    ImGui::EndDisabled();
    if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
      ImGui::SetTooltip("%s", say(can ? k_map_about : k_map_needs).c_str());
    if (asked) {
      state.follows = Follows::no;
      state.of = player.parameters();
      state.search = search_overturning(player.scene(), state.of);
      return;
    }
    if (!found || failed) return;
    ImGui::SameLine();
  }
  if (ImGui::Button((say(k_map_close) + "##close-map").c_str())) {
    state = {};
    state.follows = Follows::no;
  }
}

}  // namespace topple::app
