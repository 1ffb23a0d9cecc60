#include "app/panels/precision_panel.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "app/chart/lane.h"
#include "app/chart/log_chart.h"
#include "app/panels/panels.h"
#include "app/panels/precision_words.h"
#include "app/panels/shell_words.h"
#include "app/panels/teaching_words.h"
#include "solver/body/model_level.h"
#include "solver/io/edit/edit_text.h"

namespace topple::app {
namespace {

using namespace window_words;
using study::Measure;
using study::Method;

constexpr float k_reach = 0.7f;  // lines of text, from the mouse to a point

/// A mark; open where steps follow a tolerance.
enum class Sign { circle, square, triangle, diamond, turned_triangle, cross };
struct Look {
  Method kind;
  Sign sign;
  bool open;
  ImU32 light, dark;
};
// Colours of Okabe and Ito, as in `topple study precision`.
constexpr ImU32 k_vermilion = IM_COL32(213, 94, 0, 255), k_green = IM_COL32(0, 158, 115, 255),
                k_blue = IM_COL32(0, 114, 178, 255), k_sky = IM_COL32(86, 180, 233, 255);
constexpr Look k_looks[] = {
    {Method::scene, Sign::diamond, true, IM_COL32(17, 17, 17, 255), IM_COL32(240, 240, 240, 255)},
    {Method::rigid, Sign::circle, false, k_vermilion, k_vermilion},
    {Method::rigid_auto, Sign::circle, true, k_vermilion, k_vermilion},
    {Method::elastic, Sign::square, false, k_green, k_green},
    {Method::elastic_auto, Sign::square, true, k_green, k_green},
    {Method::generalized_alpha, Sign::triangle, false, k_blue, k_sky},
    {Method::generalized_alpha_auto, Sign::triangle, true, k_blue, k_sky},
    {Method::newmark, Sign::diamond, false, IM_COL32(204, 121, 167, 255), IM_COL32(204, 121, 167, 255)},
    {Method::newmark_damped, Sign::turned_triangle, false, IM_COL32(140, 109, 0, 255),
     IM_COL32(230, 190, 60, 255)},
    {Method::central_difference, Sign::cross, false, IM_COL32(17, 17, 17, 255),
     IM_COL32(240, 240, 240, 255)}};

void add_sign(ImDrawList& list, ImVec2 at, Method method) {
  const Look& look = row_of(k_looks, method);
  const ImU32 ink = window_is_dark() ? look.dark : look.light;
  const float r = 0.32f * ImGui::GetTextLineHeight(), thin = 0.3f * r;
  const auto shape = [&](std::initializer_list<ImVec2> corners) {
    std::vector<ImVec2> points;
    for (const ImVec2& corner : corners) points.push_back({at.x + r * corner.x, at.y + r * corner.y});
    if (look.open)
      list.AddPolyline(points.data(), static_cast<int>(points.size()), ink, ImDrawFlags_Closed, thin);
    else
      list.AddConvexPolyFilled(points.data(), static_cast<int>(points.size()), ink);
  };
  switch (look.sign) {
    case Sign::circle:
      look.open ? list.AddCircle(at, 0.9f * r, ink, 16, thin) : list.AddCircleFilled(at, r, ink, 16);
      return;
    case Sign::square:
      return shape({{-0.85f, -0.85f}, {0.85f, -0.85f}, {0.85f, 0.85f}, {-0.85f, 0.85f}});
    case Sign::triangle:
      return shape({{0, -1.1f}, {1.1f, 0.9f}, {-1.1f, 0.9f}});
    case Sign::diamond:
      return shape({{0, -1.2f}, {1, 0}, {0, 1.2f}, {-1, 0}});
    case Sign::turned_triangle:
      return shape({{-1.1f, -0.9f}, {1.1f, -0.9f}, {0, 1.1f}});
    case Sign::cross:
      list.AddLine({at.x - r, at.y - r}, {at.x + r, at.y + r}, ink, 0.4f * r);
      list.AddLine({at.x - r, at.y + r}, {at.x + r, at.y - r}, ink, 0.4f * r);
  }
}

const study::PrecisionRow& row(const PrecisionFound& found, int k) {
  return found.study.rows[static_cast<std::size_t>(k)];
}

/// %, no less than the reference can tell; none: it has none, or it is 0.
std::optional<double> error_of(const PrecisionFound& found, int k, Measure measure) {
  const auto& error = row(found, k).errors[index(measure)];
  if (!error || !row(found, k).cost) return std::nullopt;
  const double shown =
      std::max(*error, found.study.references.front().uncertainty[index(measure)].value_or(0));
  return shown > 0 ? std::optional(100 * shown) : std::nullopt;
}

std::string setting_in_words(const PrecisionFound& found, int k) {
  const study::Setting& setting = found.plan->setting_of(k);
  const std::string method = say(row_of(k_methods, setting.method).name);
  return setting.step > 0 ? say(k_with_step, method, 1e3 * setting.step)
                          : say(k_with_tolerance, method, setting.tolerance);
}

std::string point_in_words(const PrecisionFound& found, int k, Measure measure) {
  return say(k_setting, setting_in_words(found, k), 1e3 * *row(found, k).cost, *error_of(found, k, measure));
}

void load(Player& player, const PrecisionFound& found, int k, std::string& refused) {
  const auto edits = edits_to(player, found.parameters[static_cast<std::size_t>(k)]);
  if (!edits) return;
  player.begin_edit();
  try {
    for (const Edit& edit : *edits) player.edit(edit);
    refused.clear();
  } catch (const io::InputError& error) {
    refused = error.what();
  }
}

/// The case that is as the parameters are now and has an error; -1: none.
int present_case(const Player& player, const PrecisionFound& found, Measure measure) {
  for (int k = 0; k < found.plan->cases(); ++k) {
    if (!error_of(found, k, measure)) continue;
    const auto edits = edits_to(player, found.parameters[static_cast<std::size_t>(k)]);
    if (edits && edits->empty()) return k;
  }
  return -1;
}

void draw_chart(const PrecisionFound& found, int present, PrecisionState& state, float height) {
  LogAxis x{1e300, 0}, y{1e300, 0};
  const auto widen = [](LogAxis& axis, double value, double below, double above) {
    axis = {std::min(axis.low, value / below), std::max(axis.high, value * above)};
  };
  state.points.clear();
  for (int k = 0; k < found.plan->cases(); ++k) {
    const auto error = error_of(found, k, state.measure);
    if (!error) continue;
    widen(x, 1e3 * *row(found, k).cost, 1.4, 1.4);
    widen(y, *error, 2, 2.5);
    state.points.push_back({k, {}});
  }
  if (state.points.empty()) return;
  const float line = ImGui::GetTextLineHeight();
  const LogChart chart = chart_at_cursor(x, y, height, say(k_error_axis));
  ImDrawList& list = *ImGui::GetWindowDrawList();
  draw_log_grid(list, chart);
  const auto place = [&](int k) {
    return chart.at(1e3 * *row(found, k).cost, *error_of(found, k, state.measure));
  };
  LogCurve front{say(k_pareto), theme().ghost, 0, {}};
  for (const int k : study::front(*found.plan, found.study, 0, state.measure))
    if (error_of(found, k, state.measure)) front.points.push_back(place(k));
  list.AddPolyline(front.points.data(), static_cast<int>(front.points.size()), front.colour, 0, 0.35f * line);
  if (present >= 0) list.AddCircle(place(present), 0.62f * line, theme().cursor, 24, 0.14f * line);
  ChartKey key(list, chart, say(k_cost_axis));
  key.begin_line();
  std::array<bool, study::k_methods> named = {};
  for (PrecisionPoint& point : state.points) {
    const ImVec2 at = point.at = place(point.k);
    const Method method = found.plan->setting_of(point.k).method;
    add_sign(list, at, method);
    if (std::exchange(named[static_cast<std::size_t>(method)], true)) continue;
    add_sign(list, key.entry(say(row_of(k_methods, method).name)), method);
  }
  const ImVec2 at = key.entry(front.name);
  list.AddLine({at.x - 0.7f * line, at.y}, {at.x + 0.7f * line, at.y}, front.colour, 0.35f * line);
  if (present >= 0) list.AddCircle(key.entry(say(k_present)), 0.42f * line, theme().cursor, 24, 0.14f * line);
  key.end();
}

void handle_mouse(Player& player, const PrecisionFound& found, const std::vector<PrecisionPoint>& points,
                  Measure measure, std::string& refused) {
  if (!ImGui::IsWindowHovered() || points.empty()) return;
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const auto distance = [&](const PrecisionPoint& p) {
    return std::hypot(p.at.x - mouse.x, p.at.y - mouse.y);
  };
  const PrecisionPoint& nearest = *std::ranges::min_element(points, {}, distance);
  if (distance(nearest) > k_reach * ImGui::GetTextLineHeight()) return;
  const bool can = edits_to(player, found.parameters[static_cast<std::size_t>(nearest.k)]).has_value();
  ImGui::SetTooltip("%s\n%s", point_in_words(found, nearest.k, measure).c_str(),
                    say(!can                ? k_setting_in_scene
                        : player.can_edit() ? k_setting_click
                                            : k_map_no_click)
                        .c_str());
  if (can && player.can_edit() && ImGui::IsMouseClicked(0)) load(player, found, nearest.k, refused);
}

/// The way for the keyboard: along the front.
void draw_steps(Player& player, const PrecisionFound& found, int present, Measure measure,
                std::string& refused) {
  std::vector<int> front = study::front(*found.plan, found.study, 0, measure);
  std::erase_if(front, [&](int k) {
    return !edits_to(player, found.parameters[static_cast<std::size_t>(k)]) || !error_of(found, k, measure);
  });
  int cheaper = -1, costlier = -1;  // the front is in the order of cost
  const double now = present >= 0 ? *row(found, present).cost : 0;
  for (const int k : front) {
    if (k == present) continue;
    if (*row(found, k).cost < now) cheaper = k;
    if (*row(found, k).cost > now && costlier < 0) costlier = k;
  }
  const auto button = [&](const Phrase& name, const char* id, int k) {
    ImGui::BeginDisabled(k < 0 || !player.can_edit());
    if (ImGui::Button((say(name) + id).c_str())) load(player, found, k, refused);
    ImGui::EndDisabled();
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", say(k_along_front).c_str());
  };
  button(k_cheaper, "##cheaper", cheaper);
  ImGui::SameLine();
  button(k_more_exact, "##exact", costlier);
}

void draw_measure(Measure& measure) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(say(k_error_of).c_str());
  ImGui::SameLine();
  ImGui::SetNextItemWidth(18 * ImGui::GetFontSize());
  if (ImGui::BeginCombo("##measure", say(row_of(k_measures, measure).name).c_str())) {
    for (const auto& [kind, name] : k_measures)
      if (list_entry(say(name), kind == measure)) measure = kind;
    ImGui::EndCombo();
  }
}

void draw_controls(const Player& player, PrecisionState& state, const PrecisionFound* found) {
  if (state.search->over()) {
    ImGui::BeginDisabled(player.way().empty());
    if (ImGui::Button((say(k_map_again) + "##again").c_str())) state.search.reset();
    ImGui::EndDisabled();
  } else if (ImGui::Button((say(k_cancel) + "##cancel-precision").c_str())) {
    state.search->stop();
  }
  if (!found || !found->plan) return;
  ImGui::SameLine();
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(say(k_precision_progress, found->study.run, found->study.of).c_str());
}

bool is_setting(Edit::Key key, int) {
  return traits(key).setting;
}

}  // namespace

std::optional<std::vector<Edit>> edits_to(const Player& player, const Parameters& wanted) {
  const Parameters& now = player.parameters();
  const Model& model = player.scene().setup.model;
  if (wanted.adaptive ? !now.adaptive || now.tolerance != wanted.tolerance : false) return std::nullopt;
  if (wanted.integrator == Integrator::newmark && (wanted.beta != now.beta || wanted.gamma != now.gamma))
    return std::nullopt;
  std::vector<Edit> edits;
  for (const auto& [key, of] : editable(model, now)) {
    if (!is_setting(key, of)) continue;
    const Edit edit{key, of, edited_value(wanted, key, of)};
    if (edit.value == edited_value(now, key, of)) continue;
    if (key == Edit::Key::model &&
        !can_be(model, of, static_cast<BodyModel>(static_cast<int>(edit.value.x()))))
      return std::nullopt;
    edits.push_back(edit);
  }
  return edits;
}

void draw_precision(Player& player, PrecisionState& state, std::string& refused) {
  if (!state.search) {
    state.of = player.parameters();
    state.search = search_precision(player.scene(), state.of);
  }
  const float line = ImGui::GetTextLineHeight();
  const ImVec2 room = ImGui::GetIO().DisplaySize;
  const float height = std::clamp(0.94f * room.y - 19 * line, 10 * line, 21 * line);
  ImGui::SetNextWindowSize({std::min(46 * line, 0.97f * room.x), 0});  // as high as what is in it
  ImGui::SetNextWindowSizeConstraints({0, 0}, {room.x, 0.96f * room.y});
  ImGui::SetNextWindowPos({room.x / 2, 0.02f * room.y}, ImGuiCond_Appearing, {0.5f, 0});
  ImGui::Begin((say(k_precision) + "###precision").c_str(), &state.open,
               ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings);
  const auto found = state.search->result();
  std::vector<PrecisionPoint>& points = state.points;
  if (found && !found->failure.empty()) {
    text_wrapped(say(k_precision_failed, found->failure));
  } else if (found) {
    draw_measure(state.measure);
    const int present = present_case(player, *found, state.measure);
    draw_chart(*found, present, state, height);
    handle_mouse(player, *found, points, state.measure, refused);
    const study::Reference& reference = found->study.references.front();
    if (reference.run < 0)
      text_wrapped(say(k_no_errors_yet));
    else if (points.empty())
      text_wrapped(say(k_no_such_error));
    else
      text_wrapped((present >= 0 ? say(k_setting_now, point_in_words(*found, present, state.measure))
                                 : say(k_setting_not_there)));
    if (reference.run >= 0)
      text_wrapped(say(k_precision_reference, setting_in_words(*found, reference.run),
                       setting_in_words(*found, reference.check), reference.window));
    if (!points.empty()) draw_steps(player, *found, present, state.measure, refused);
    if (parameters_differ(player.scene().setup.model, player.parameters(), state.of, is_setting))
      text_wrapped(say(k_map_stale));
    if (!points.empty()) ImGui::SameLine();
  }
  draw_controls(player, state, found.get());
  ImGui::End();
  if (!state.open && state.search) state.search->stop();
}

}  // namespace topple::app
