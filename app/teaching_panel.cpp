#include "app/teaching_panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "app/lane.h"
#include "app/teaching_words.h"
#include "app/words.h"
#include "solver/accelerogram.h"
#include "solver/study/alone.h"
#include "solver/study/criteria.h"

namespace topple::app {
namespace {

using namespace window_words;

constexpr double k_least_frequency = 0.1, k_most_frequency = 10;  // Hz
constexpr double k_least_amplitude = 0.1, k_most_amplitude = 30;  // m/s^2
constexpr std::size_t k_path = 400;                               // places kept
constexpr double k_new_place = 0.002;                             // relative: less is the same place

/// Greatest velocity that a record of acceleration leads to from rest, by the trapezoidal rule, m/s.
double peak_velocity(const Accelerogram& record) {
  Vec3 velocity = Vec3::Zero(), before = acceleration(record, 0);
  double most = 0;
  for (double t = record.interval; t <= record.duration; t += record.interval) {
    const Vec3 now = acceleration(record, t);
    velocity += record.interval / 2 * (before + now);
    before = now;
    most = std::max(most, velocity.norm());
  }
  return most;
}

ShakePlace place_of(const Shake& shake) {
  const double level = shake.direction.head<2>().norm();
  switch (shake.kind) {
    case Shake::Kind::sine:
    case Shake::Kind::sweep:
      return {shake.frequency, level * shake.amplitude};
    case Shake::Kind::pulse:
      return {(shake.shape == Shake::Shape::full_sine ? 1 : 0.5) / shake.duration, level * shake.amplitude};
    case Shake::Kind::record:
      break;
  }
  const double velocity = peak_velocity(*shake.record);
  return {velocity > 0 ? shake.record->peak / (2 * k_pi * velocity) : k_most_frequency,
          std::abs(shake.scale) * shake.record->peak};
}

/// What the criteria say of one body.
struct Limits {
  double west;      ///< m/s^2
  double ishiyama;  ///< m/s

  const Phrase& verdict(const ShakePlace& at) const {
    if (at.amplitude < west) return k_stays;
    return at.amplitude < 2 * k_pi * at.frequency * ishiyama ? k_rocks : k_may_overturn;
  }
};

std::optional<Limits> limits_of(const Player& player, int body) {
  const Model& model = player.scene().setup.model;
  const Parameters& parameters = player.parameters();
  if (!study::why_not_standing(model, body).empty()) return std::nullopt;
  std::optional<Limits> least;
  for (const double sense : {1., -1.}) {
    const Vec3 direction = sense * parameters.shakes.front().direction;
    const auto standing = study::standing_towards(model, parameters, body, direction);
    if (!standing) continue;
    const double west = study::west_acceleration(*standing);
    if (!least || west < least->west) least = Limits{west, study::ishiyama_velocity(*standing)};
  }
  return least;
}

/// Both axes logarithmic.
struct Chart {
  float left, right, top, bottom;
  float x(double frequency) const {
    return left + static_cast<float>(std::log(frequency / k_least_frequency) /
                                     std::log(k_most_frequency / k_least_frequency)) *
                      (right - left);
  }
  float y(double amplitude) const {
    return bottom - static_cast<float>(std::log(amplitude / k_least_amplitude) /
                                       std::log(k_most_amplitude / k_least_amplitude)) *
                        (bottom - top);
  }
  ImVec2 at(const ShakePlace& place) const {
    return {std::clamp(x(place.frequency), left, right), std::clamp(y(place.amplitude), top, bottom)};
  }
};

void draw_grid(ImDrawList& list, const Chart& chart) {
  list.AddRectFilled({chart.left, chart.top}, {chart.right, chart.bottom}, theme().sheet);
  const float line = ImGui::GetTextLineHeight();
  for (const double frequency : {0.1, 0.2, 0.5, 1., 2., 5., 10.}) {
    const float x = chart.x(frequency);
    list.AddLine({x, chart.top}, {x, chart.bottom}, theme().faint);
    if (frequency != 0.1 && frequency != 1 && frequency != 10) continue;
    const std::string label = fmt::format("{:g}", frequency);
    add_text(list, std::min(x - text_width(label) / 2, chart.right - text_width(label)), chart.bottom + 2,
             theme().text, label);
  }
  for (const double gal : {10., 20., 50., 100., 200., 500., 1000., 2000.}) {
    const float y = chart.y(gal * k_gal);
    list.AddLine({chart.left, y}, {chart.right, y}, theme().faint);
    if (gal != 10 && gal != 100 && gal != 1000) continue;
    const std::string label = fmt::format("{:g}", gal);
    add_text(list, chart.left - text_width(label) - 4, std::min(y - line / 2, chart.bottom - line),
             theme().text, label);
  }
  list.AddRect({chart.left, chart.top}, {chart.right, chart.bottom}, theme().axis);
}

/// A word in the middle of a region between two heights at a frequency, if it has room.
void draw_region(ImDrawList& list, const Chart& chart, double frequency, double low, double high,
                 const Phrase& words) {
  const std::string text = say(words);
  const float line = ImGui::GetTextLineHeight(), width = text_width(text);
  const float lower = chart.y(std::max(low, k_least_amplitude)),
              upper = chart.y(std::min(high, k_most_amplitude));
  if (lower - upper < 1.2f * line) return;
  const float x = std::clamp(chart.x(frequency) - width / 2, chart.left + 4, chart.right - width - 4);
  add_text(list, x, (lower + upper) / 2 - line / 2, theme().text, text);
}

void draw_chart(const Limits& limits, const TeachingState& state) {
  const float line = ImGui::GetTextLineHeight(), width = ImGui::GetContentRegionAvail().x;
  const ImVec2 low = ImGui::GetCursorScreenPos();
  const float height = std::min(0.72f * width, 18 * line);
  const Chart chart{low.x + text_width("1000") + 8, low.x + width - 4, low.y + 1.3f * line, low.y + height};
  ImDrawList& list = *ImGui::GetWindowDrawList();
  add_text(list, low.x, low.y, theme().text, say(k_amplitude_axis));
  draw_grid(list, chart);
  list.PushClipRect({chart.left, chart.top}, {chart.right, chart.bottom}, true);
  const auto velocity_line = [&](double frequency) { return 2 * k_pi * frequency * limits.ishiyama; };
  list.AddLine({chart.left, chart.y(limits.west)}, {chart.right, chart.y(limits.west)}, theme().positive,
               1.8f);
  list.AddLine({chart.left, chart.y(velocity_line(k_least_frequency))},
               {chart.right, chart.y(velocity_line(k_most_frequency))}, theme().line, 1.8f);
  draw_region(list, chart, 1, k_least_amplitude, limits.west, k_stays);
  draw_region(list, chart, 4.5, limits.west, velocity_line(4.5), k_rocks);
  draw_region(list, chart, 0.25, std::max(limits.west, velocity_line(0.25)), k_most_amplitude,
              k_may_overturn);
  std::vector<ImVec2> path;
  for (const ShakePlace& place : state.path) path.push_back(chart.at(place));
  list.AddPolyline(path.data(), static_cast<int>(path.size()), theme().ghost, 0, 2);
  const ImVec2 now = chart.at(state.path.back());
  list.AddCircleFilled(now, 0.42f * line, theme().sheet, 20);
  list.AddCircleFilled(now, 0.32f * line, theme().cursor, 20);
  list.PopClipRect();
  // names of the lines stand in a key below: on the lines they would meet the regions' words
  float y = chart.bottom + 1.25f * line, x = chart.left;
  const std::string axis = say(k_frequency_axis);
  add_text(list, chart.right - text_width(axis), y, theme().text, axis);
  y += 1.15f * line;
  const std::pair<const Phrase&, ImU32> curves[] = {{k_west, theme().positive}, {k_ishiyama, theme().line}};
  for (const auto& [name, colour] : curves) {
    list.AddRectFilled({x, y + line / 2 - 1}, {x + line, y + line / 2 + 1}, colour);
    add_text(list, x + 1.3f * line, y, theme().text, say(name));
    x += 2.2f * line + text_width(say(name));
  }
  ImGui::Dummy({width, y + 1.3f * line - low.y});
}

void note_place(const ShakePlace& place, std::vector<ShakePlace>& path) {
  const auto same = [](double a, double b) { return std::abs(a - b) <= k_new_place * std::abs(b); };
  if (!path.empty() && same(place.frequency, path.back().frequency) &&
      same(place.amplitude, path.back().amplitude))
    return;
  path.push_back(place);
  if (path.size() > k_path) path.erase(path.begin());
}

void draw_criteria(const Player& player, TeachingState& state) {
  const Model& model = player.scene().setup.model;
  const auto& shakes = player.parameters().shakes;
  if (shakes.empty()) {
    ImGui::TextWrapped("%s", say(k_no_floor_shake).c_str());
    return;
  }
  const auto furniture = model.furniture_total();
  if (!state.body || !limits_of(player, *state.body)) {
    state.body.reset();
    for (int b = 0; b < furniture && !state.body; ++b)
      if (limits_of(player, b)) state.body = b;
  }
  if (!state.body) {
    ImGui::TextWrapped("%s", say(k_no_standing_body).c_str());
    return;
  }
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(say(k_body).c_str());
  ImGui::SameLine();
  ImGui::SetNextItemWidth(-1);
  if (ImGui::BeginCombo("##standing", model.bodies[static_cast<std::size_t>(*state.body)].name.c_str())) {
    for (int b = 0; b < furniture; ++b)
      if (limits_of(player, b) &&
          ImGui::Selectable(model.bodies[static_cast<std::size_t>(b)].name.c_str(), b == *state.body))
        state.body = b;
    ImGui::EndCombo();
  }
  const Limits limits = *limits_of(player, *state.body);
  const Shake& shake = shakes.front();
  if (shake.kind != Shake::Kind::record || state.path.empty() || state.record != shake.record ||
      state.scale != shake.scale)
    note_place(place_of(shake), state.path);
  state.record = shake.record;
  state.scale = shake.scale;
  draw_chart(limits, state);
  const ShakePlace now = state.path.back();
  const bool record = shake.kind == Shake::Kind::record;
  ImGui::TextWrapped("%s", say(record ? k_verdict_record : k_verdict, now.frequency, now.amplitude / k_gal,
                               say(limits.verdict(now)))
                               .c_str());
  ImGui::TextWrapped("%s", say(k_limits, limits.west / k_gal, 100 * limits.ishiyama,
                               100 * now.amplitude / (2 * k_pi * now.frequency))
                               .c_str());
}

void draw_presets(Player& player) {
  static constexpr std::pair<const Phrase&, std::size_t> k_buttons[] = {{k_long_period, 0},
                                                                        {k_short_period, 1}};
  const bool can = can_shake_as_sine(player);
  for (const auto& [name, k] : k_buttons) {
    const Demo& demo = demos()[k];
    ImGui::BeginDisabled(!can);
    if (ImGui::Button(say(name).c_str(), {-1, 0})) shake_as_sine(player, demo.frequency, demo.amplitude);
    ImGui::EndDisabled();
    if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
      ImGui::SetTooltip(
          "%s", (can ? say(k_preset_about, demo.frequency, demo.amplitude) : say(k_sine_only)).c_str());
  }
}

void draw_demos(const Player& player, TeachingState& state) {
  ImGui::TextDisabled("%s", say(k_demos).c_str());
  state.wanted.reset();
  for (std::size_t k = 0; k < demos().size() && !state.guide; ++k) {
    if (ImGui::Button((say(demos()[k].name) + fmt::format("##demo{}", k)).c_str(), {-1, 0})) state.wanted = k;
    if (ImGui::IsItemHovered() && player.scene().name != k_demo_scene)
      ImGui::SetTooltip("%s", say(k_demo_opens, k_demo_scene).c_str());
  }
  if (!state.guide) return;
  DemoGuide& guide = *state.guide;
  ImGui::TextWrapped(
      "%s", say(k_demo_step, say(guide.demo().name), guide.step().value_or(0) + 1, guide.demo().steps.size())
                .c_str());
  ImGui::TextWrapped("%s", say(guide.text()).c_str());
  ImGui::BeginDisabled(guide.under_way() || guide.step().value_or(0) == 0);
  if (ImGui::Button((say(k_previous) + "##previous").c_str())) guide.previous();
  ImGui::EndDisabled();
  ImGui::SameLine();
  ImGui::BeginDisabled(guide.under_way() || guide.last());
  if (ImGui::Button((say(k_next) + "##next").c_str())) guide.next();
  ImGui::EndDisabled();
  ImGui::SameLine();
  if (ImGui::Button((say(k_quit_demo) + "##quit").c_str())) state.guide.reset();
}

void draw_accuracy(const Player& player, TeachingState& state) {
  if (is_static(player.scene().setup)) return;
  const auto result = state.accuracy ? state.accuracy->result() : std::nullopt;
  if (!state.accuracy || result) {
    ImGui::BeginDisabled(player.way().empty());
    const bool asked = ImGui::Button((say(k_how_accurate) + "##accurate").c_str(), {-1, 0});
    ImGui::EndDisabled();
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", say(k_how_accurate_about).c_str());
    if (asked) {
      Setup setup = player.scene().setup;
      for (const Edit& edit : player.edits_since_start()) apply(edit, setup.model, 0, setup.parameters);
      state.accuracy = std::make_unique<Accuracy>(setup);
      return;
    }
  } else {
    const auto progress = static_cast<float>(state.accuracy->progress());
    ImGui::TextUnformatted(say(k_estimating, 100 * progress).c_str());
    ImGui::ProgressBar(progress, {-1, 0.5f * ImGui::GetTextLineHeight()}, "");
    if (ImGui::Button((say(k_cancel) + "##cancel").c_str())) state.accuracy.reset();
  }
  if (!result) return;
  for (const std::string& line : accuracy_in_words(player.scene().setup.model, *result))
    ImGui::TextWrapped("%s", line.c_str());
  if (result->failure.empty()) ImGui::TextWrapped("%s", say(k_estimate_note).c_str());
}

}  // namespace

void draw_teaching(Player& player, TeachingState& state) {
  draw_criteria(player, state);
  draw_presets(player);
  ImGui::Separator();
  draw_demos(player, state);
  ImGui::Separator();
  draw_accuracy(player, state);
}

}  // namespace topple::app
