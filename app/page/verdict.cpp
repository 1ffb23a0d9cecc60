#include "app/page/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/report/report_words.h"
#include "app/support/terms.h"

namespace topple::app {
namespace {

constexpr std::size_t k_named = 3;  // falls, in the sentence

std::string in_hundredths(double value) {
  return fmt::format("{:.2f}", value);
}

std::string who_falls(const std::vector<BodyEnd>& falls, std::size_t count, Language language) {
  if (falls.size() > k_named)
    return say_in(language, words::k_many_fall, falls.size(), count, falls[0].name,
                  in_hundredths(*falls[0].overturned));
  std::string out;
  for (const BodyEnd& body : falls)
    out += say_in(language, words::k_falls, body.name, in_hundredths(*body.overturned)) + " ";
  if (falls.size() < count) out += say_in(language, words::k_others_stay, count - falls.size(), count);
  return out;
}

}  // namespace

std::vector<BodyEnd> ends_of(const Run& run) {
  const Model& model = run.setup().model;
  std::vector<BodyEnd> out;
  for (int b = 0; b < model.furniture_total(); ++b) {
    const BodyOutcome& of = run.outcome().bodies()[static_cast<std::size_t>(b)];
    BodyEnd end{
        model.bodies[static_cast<std::size_t>(b)].name, of.beyond_since, of.peak_tilt * k_degrees, {}};
    if (std::isfinite(of.peak.critical)) end.critical = of.peak.critical * k_degrees;
    end.held = is_held(model, run.parameters(), b);
    out.push_back(end);
  }
  return out;
}

std::string verdict_in_words(const std::vector<BodyEnd>& bodies, Language language) {
  std::vector<BodyEnd> falls;
  const BodyEnd* most = nullptr;  // by the share of its critical angle; of those that have none by the angle
  const auto before = [](const BodyEnd& a, const BodyEnd& b) {
    if (!a.critical || !b.critical) return !a.critical && (b.critical || a.peak_tilt < b.peak_tilt);
    return a.peak_tilt / *a.critical < b.peak_tilt / *b.critical;
  };
  for (const BodyEnd& body : bodies) {
    if (body.overturned) falls.push_back(body);
    if (most == nullptr || before(*most, body)) most = &body;
  }
  if (most == nullptr) return "";
  std::stable_sort(falls.begin(), falls.end(),
                   [](const BodyEnd& a, const BodyEnd& b) { return *a.overturned < *b.overturned; });
  if (!falls.empty()) return who_falls(falls, bodies.size(), language);
  const std::string tilt = in_hundredths(most->peak_tilt);
  if (!most->critical) return say_in(language, words::k_nothing_falls_far, most->name, tilt);
  return say_in(language,
                most->peak_tilt > *most->critical ? words::k_nothing_stays_over
                : most->held                      ? words::k_nothing_falls_held
                                                  : words::k_nothing_falls,
                most->name, tilt, in_hundredths(*most->critical));
}

}  // namespace topple::app
