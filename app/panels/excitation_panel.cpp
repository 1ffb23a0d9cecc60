#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "app/chart/lane.h"
#include "app/chart/log_chart.h"
#include "app/panels/panels.h"
#include "app/panels/teaching_panel.h"
#include "app/panels/teaching_words.h"
#include "solver/model/accelerogram.h"
#include "solver/model/excitation.h"

namespace topple::app {
namespace {

using namespace window_words;

constexpr LogAxis k_frequencies{0.1, 10}, k_amplitudes{10, 3000};  // Hz, gal
constexpr std::size_t k_path = 400;                                // places kept
constexpr double k_new_place = 0.002;                              // relative: less is the same place

/// Greatest acceleration of a record, m/s^2, and velocity that it leads to from rest, by the trapezoidal
/// rule, m/s, both along a direction: the criteria know no other.
struct RecordPeak {
  double acceleration = 0, velocity = 0;
};
RecordPeak peak_along(const Accelerogram& record, const Vec3& direction) {
  RecordPeak peak;
  double velocity = 0, before = 0;
  const int steps = static_cast<int>(std::lround(record.duration / record.interval));
  for (int k = 0; k <= steps; ++k) {
    const double now = direction.dot(acceleration(record, k * record.interval));
    if (k > 0) velocity += record.interval / 2 * (before + now);
    before = now;
    peak.acceleration = std::max(peak.acceleration, std::abs(now));
    peak.velocity = std::max(peak.velocity, std::abs(velocity));
  }
  return peak;
}

ShakePlace place_of(const Shake& shake) {
  const Vec3 along(shake.direction.x(), shake.direction.y(), 0);
  const ShakeTraits& uses = traits(shake.kind);
  if (uses.has_shape) {
    const PulseTraits& shape = traits(shake.shape);
    return {shape.cycles / shake.duration, along.norm() * shake.amplitude, shape.velocity * shape.cycles};
  }
  if (!uses.has_record) return {shake.frequency, along.norm() * shake.amplitude};
  const RecordPeak peak = peak_along(*shake.record, along.stableNormalized());
  return {peak.velocity > 0 ? peak.acceleration / (2 * k_pi * peak.velocity) : k_frequencies.high,
          std::abs(shake.scale) * peak.acceleration};
}

/// A word in the middle of a region between two heights at a frequency, if it has room.
void draw_region(ImDrawList& list, const LogChart& chart, double frequency, double low, double high,
                 const Phrase& words) {
  const std::string text = say(words);
  const float line = ImGui::GetTextLineHeight(), width = text_width(text);
  const ImVec2 lower = chart.at(frequency, std::max(low, chart.y.low)),
               upper = chart.at(frequency, std::min(high, chart.y.high));
  if (lower.y - upper.y < 1.2f * line) return;
  const float x = std::clamp(lower.x - width / 2, chart.left + 4, chart.right - width - 4);
  add_text(list, x, (lower.y + upper.y) / 2 - line / 2, theme().text, text);
}

void draw_criteria_chart(const CriteriaLimits& limits, const TeachingState& state) {
  const float height = std::min(0.64f * ImGui::GetContentRegionAvail().x, 16 * ImGui::GetTextLineHeight());
  const LogChart chart = chart_at_cursor(k_frequencies, k_amplitudes, height, say(k_amplitude_axis));
  ImDrawList& list = *ImGui::GetWindowDrawList();
  draw_log_grid(list, chart);
  list.PushClipRect({chart.left, chart.top}, {chart.right, chart.bottom}, true);
  const double west = limits.west / k_gal;
  const double share = state.path.back().share;
  const auto velocity_line = [&](double frequency) { return frequency * limits.ishiyama / share / k_gal; };
  const std::vector<LogCurve> curves{
      {say(k_west), theme().positive, 0, {chart.at(chart.x.low, west), chart.at(chart.x.high, west)}},
      {say(k_ishiyama),
       theme().line,
       0.45f * ImGui::GetTextLineHeight(),
       {chart.at(chart.x.low, velocity_line(chart.x.low)),
        chart.at(chart.x.high, velocity_line(chart.x.high))}}};
  for (const LogCurve& curve : curves) add_line(list, curve.points, curve.colour, curve.dash);
  draw_region(list, chart, 1, chart.y.low, west, k_stays);
  draw_region(list, chart, 4.5, west, velocity_line(4.5), k_rocks);
  draw_region(list, chart, 0.25, std::max(west, velocity_line(0.25)), chart.y.high, k_may_overturn);
  std::vector<ImVec2> path;
  for (const ShakePlace& place : state.path)
    path.push_back(chart.clamped(place.frequency, place.amplitude / k_gal));
  list.AddPolyline(path.data(), static_cast<int>(path.size()), theme().ghost, 0, 2);
  add_present(list, path.back());
  list.PopClipRect();
  ChartKey key(list, chart, say(k_frequency_axis));
  key.lines(curves);
  key.end();
}

void note_place(const ShakePlace& place, std::vector<ShakePlace>& path) {
  const auto same = [](double a, double b) { return std::abs(a - b) <= k_new_place * std::abs(b); };
  if (!path.empty() && same(place.frequency, path.back().frequency) &&
      same(place.amplitude, path.back().amplitude))
    return;
  path.push_back(place);
  if (path.size() > k_path) path.erase(path.begin());
}

/// No body of the scene has criteria.
std::string why_none(const Model& model, const Parameters& parameters) {
  bool askew = false;
  for (int b = 0; b < model.furniture_total(); ++b) {
    if (std::string words = slides_in_words(model, parameters, b); !words.empty()) return words;
    askew = askew || &why_no_limits(model, parameters, b) == &k_shaken_askew;
  }
  return say(askew ? k_no_edge_across : k_no_standing_body);
}

void draw_criteria(const Player& player, TeachingState& state) {
  const Model& model = player.scene().setup.model;
  const auto& shakes = player.parameters().shakes;
  const auto furniture = model.furniture_total();
  const Parameters& parameters = player.parameters();
  if (shakes.front().building) {
    text_wrapped(say(k_building_between));
    return;
  }
  if (!state.body || !has_limits(model, parameters, *state.body)) {
    state.body.reset();
    for (int b = 0; b < furniture && !state.body; ++b)
      if (has_limits(model, parameters, b)) state.body = b;
  }
  if (!state.body) {
    text_wrapped(why_none(model, parameters));
    return;
  }
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(say(k_body).c_str());
  ImGui::SameLine();
  ImGui::SetNextItemWidth(-1);
  if (ImGui::BeginCombo("##standing", model.bodies[static_cast<std::size_t>(*state.body)].name.c_str())) {
    for (int b = 0; b < furniture; ++b) {
      const std::string& name = model.bodies[static_cast<std::size_t>(b)].name;
      if (!has_limits(model, parameters, b))
        ImGui::TextDisabled("%s", say(why_no_limits(model, parameters, b), name).c_str());
      else if (list_entry(name, b == *state.body))
        state.body = b;
    }
    ImGui::EndCombo();
  }
  if (!state.limits_of || state.limits_of->first != *state.body || !(state.limits_of->second == parameters)) {
    state.limits_of.emplace(*state.body, parameters);
    state.limits = *limits_of(player, *state.body);
  }
  const CriteriaLimits& limits = state.limits;
  draw_criteria_chart(limits, state);
  const ShakePlace now = state.path.back();
  const bool record = traits(shakes.front().kind).has_record;
  const Phrase& by_criteria = verdict(limits, now);
  const auto write = [](const std::string& words) { text_wrapped(words); };
  write(say(record ? k_verdict_record : k_verdict, now.frequency, now.amplitude / k_gal, say(by_criteria)));
  const std::string held = held_in_words(player, *state.body);
  const std::string words = held.empty() ? difference_in_words(player, *state.body, limits, now) : held;
  if (!words.empty()) write(words);
  write(say(k_limits, limits.west / k_gal, 100 * limits.ishiyama, 100 * now.velocity()));
  write((limits.west < limits.rigid ? say(k_soft_limits) : "") +
        say(k_west_formula, limits.rigid / k_gal, 1e3 * limits.base, 1e3 * limits.height));
}

}  // namespace

void draw_excitation(Player& player, TeachingState& state, std::string& refused) {
  const auto& shakes = player.parameters().shakes;
  if (shakes.empty()) {
    text_wrapped(say(k_no_floor_shake));
    return;
  }
  const Shake& shake = shakes.front();
  if (!traits(shake.kind).has_record || state.path.empty() || state.record != shake.record ||
      state.scale != shake.scale)
    note_place(place_of(shake), state.path);
  state.record = shake.record;
  state.scale = shake.scale;
  if (!draw_map(player, state.map, refused)) draw_criteria(player, state);
  draw_map_controls(player, state.map);
}

}  // namespace topple::app
