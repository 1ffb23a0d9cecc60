// Section of the report page: how the floor shakes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/report/report_parts.h"
#include "solver/model/accelerogram.h"
#include "solver/model/excitation.h"

namespace topple::app {
namespace {

constexpr double k_still = 1e-6;  // m/s^2: a component below it is none
constexpr const char* k_axes[] = {"x", "y", "z"};

std::string direction(const Vec3& d) {
  for (int k = 0; k < 3; ++k)
    if (std::abs(std::abs(d[k]) - 1) < 1e-9) return (d[k] < 0 ? "\u2212" : "") + std::string(k_axes[k]);
  return fmt::format("({}, {}, {})", short_shown(d.x(), 3), short_shown(d.y(), 3), short_shown(d.z(), 3));
}

std::string shape_name(const ReportPage& page, Shake::Shape shape) {
  for (const auto& [kind, name] : words::k_shapes)
    if (kind == shape) return page.text(name);
  return traits(shape).word;
}

std::string gal_of(const Shake& shake) {
  return short_shown(shake.amplitude / k_gal);
}

/// Kinds of shakes that have a sentence.
struct ShakeSentence {
  Shake::Kind kind;
  std::string (*in_words)(const ReportPage&, const Shake&);
};
constexpr ShakeSentence k_sentences[] = {
    {Shake::Kind::sine,
     [](const ReportPage& page, const Shake& shake) {
       return page.text(words::k_sine, short_shown(shake.frequency), gal_of(shake),
                        direction(shake.direction), short_shown(shake.start),
                        shake.cycles > 0 ? page.text(words::k_cycles, short_shown(shake.cycles))
                                         : page.text(words::k_endless));
     }},
    {Shake::Kind::sweep,
     [](const ReportPage& page, const Shake& shake) {
       return page.text(words::k_sweep, short_shown(shake.frequency), short_shown(shake.last_frequency),
                        gal_of(shake), direction(shake.direction), short_shown(shake.start),
                        short_shown(shake.duration));
     }},
    {Shake::Kind::pulse,
     [](const ReportPage& page, const Shake& shake) {
       return page.text(words::k_pulse, shape_name(page, shake.shape), gal_of(shake),
                        direction(shake.direction), short_shown(shake.start), short_shown(shake.duration));
     }},
    {Shake::Kind::record,
     [](const ReportPage& page, const Shake& shake) {
       return page.text(words::k_record, short_shown(shake.record->duration), shake.record->components.size(),
                        short_shown(std::abs(shake.scale) * shake.record->peak / k_gal),
                        short_shown(shake.scale), short_shown(shake.start));
     }},
};

std::string building(const ReportPage& page, const Shake& shake) {
  if (!shake.building) return "";
  const FloorResponse& of = *shake.building;
  double longest = 0;
  for (const BuildingMode& mode : of.modes) longest = std::max(longest, mode.period);
  return of.of > 0 ? page.text(words::k_in_building, of.storey, of.of, short_shown(longest, 3),
                               short_shown(of.modes.front().damping, 3))
                   : page.text(words::k_in_modes, of.modes.size(), short_shown(longest, 3));
}

std::string in_words(const ReportPage& page, const Shake& shake) {
  for (const ShakeSentence& sentence : k_sentences)
    if (sentence.kind == shake.kind) return sentence.in_words(page, shake) + building(page, shake);
  return traits(shake.kind).word;
}

double peak_along(const study::Motion& motion, int axis) {
  double largest = 0;
  for (const Vec3& a : motion.samples) largest = std::max(largest, std::abs(a[axis]));
  return largest;
}

/// One chart for each component that moves, all with the same scale.
std::string charts(const ReportPage& page) {
  const study::Motion& motion = page.report().motion;
  const double most =
      1.1 * std::max({peak_along(motion, 0), peak_along(motion, 1), peak_along(motion, 2)}) / k_gal;
  std::string out;
  for (int axis = 0; axis < 3; ++axis) {
    if (peak_along(motion, axis) < k_still) continue;
    LineChart chart;
    chart.x_label = page.text(words::k_time);
    chart.y_label = page.text(words::k_gal_along, k_axes[axis]);
    chart.x_to = static_cast<double>(motion.samples.size() - 1) * motion.interval;
    chart.y_from = -most, chart.y_to = most;
    chart.height = 170;
    ChartCurve curve;
    for (std::size_t i = 0; i < motion.samples.size(); ++i) {
      curve.x.push_back(static_cast<double>(i) * motion.interval);
      curve.y.push_back(motion.samples[i][axis] / k_gal);
    }
    chart.curves.push_back(std::move(curve));
    out += svg_chart(chart);
  }
  return out;
}

}  // namespace

std::string floor_section(ReportPage& page) {
  const Report& report = page.report();
  const std::vector<Shake>& shakes = report.scene->setup.parameters.shakes;
  if (shakes.empty()) return page.section(words::k_floor, page.paragraph(page.say(words::k_no_shake)));
  std::string out = "<ul>\n";
  for (const Shake& shake : shakes) out += "<li>" + escaped(in_words(page, shake)) + "</li>\n";
  out += "</ul>\n";
  if (std::ranges::any_of(shakes, [](const Shake& s) {
        return traits(s.kind).steady && s.initial_velocity == Shake::Start::jump;
      }))
    out += page.paragraph(page.say(words::k_jump), "note");
  out += page.figure(charts(page), page.say(words::k_floor_chart, page.next_figure()));

  const double a = study::intensity_acceleration(report.motion), intensity = study::instrumental_intensity(a);
  const auto gal = [](double si) { return short_shown(si / k_gal) + " gal"; };
  std::vector<std::vector<std::string>> rows;
  const auto moves = [&](int axis) { return peak_along(report.motion, axis) >= k_still; };
  for (int axis = 0; axis < 3; ++axis)
    if (moves(axis) && moves(0) + moves(1) + moves(2) > 1)
      rows.push_back({page.say(words::k_peak_along, k_axes[axis]), gal(peak_along(report.motion, axis))});
  rows.push_back(
      {page.say(rows.empty() ? words::k_peak_floor : words::k_peak_vector), gal(study::peak(report.motion))});
  rows.push_back({page.say(words::k_a_value), short_shown(a) + " gal"});
  rows.push_back({page.say(words::k_i_value), shown(intensity, 1)});
  rows.push_back(
      {page.say(words::k_degree),
       page.say(words::k_degrees_of_intensity[static_cast<std::size_t>(study::intensity_scale(intensity))])});
  out += page.table({}, rows, false);
  out += page.paragraph(
      page.say(words::k_intensity_note,
               short_shown(static_cast<double>(report.motion.samples.size() - 1) * report.motion.interval)),
      "note");
  return page.section(words::k_floor, out);
}

}  // namespace topple::app
