#include <fmt/format.h>

#include <filesystem>

#include "app/validate/validation.h"
#include "app/validate/validation_page.h"
#include "solver/study/validate/granite_chart.h"

namespace topple::app {
namespace {

using nlohmann::ordered_json;

struct Granite {
  study::GraniteData data;
  study::GraniteFit fit;
  study::GraniteResults results;
};

std::string percent(double share) {
  return fmt::format("{:.1f} %", 100 * share);
}

std::string with_interval(const study::Scores& scores) {
  return fmt::format("{} ({:.1f} to {:.1f} %)", percent(scores.share()), 100 * scores.interval.low,
                     100 * scores.interval.high);
}

/// Mean share right over the halves.
std::string mean_share(const study::RockResults& rock, study::Scores study::HalfScores::*of) {
  double sum = 0;
  for (const study::HalfScores& half : rock.halves) sum += (half.*of).share();
  return percent(sum / static_cast<double>(rock.halves.size()));
}

std::string halves_in_words(const study::RockResults& rock) {
  int behind = 0, beyond_chance = 0;
  for (const study::HalfScores& half : rock.halves)
    behind += half.only_plain > half.only_model, beyond_chance += half.behind_plain();
  return fmt::format(
      "one half by the other, {} times: right {}, threshold {}, plain block {} in the mean; behind the plain "
      "block in {}, beyond chance in {}",
      rock.halves.size(), mean_share(rock, &study::HalfScores::scores),
      mean_share(rock, &study::HalfScores::threshold), mean_share(rock, &study::HalfScores::plain), behind,
      beyond_chance);
}

std::string in_words(const Granite& of) {
  std::string text = fmt::format("{} tests, {}\n", of.data.tests.size(),
                                 of.results.fitted_here
                                     ? "each predicted by what was fitted on the other nine tenths"
                                     : fmt::format("predicted by what was fitted on {} tests", of.fit.tests));
  for (std::size_t k = 0; k < study::k_rocks; ++k) {
    const study::RockResults& rock = of.results.rocks[k];
    text += fmt::format(
        "{}: right {}, Brier {:.3f}; never falls {}, threshold of velocity {}, plain Housner block {}\n"
        "  {} of {} verdicts open under 5 % of the input; sure ones right {}; missed {}, expected {:.1f}\n"
        "  rigid model of the median rock: right {}; as a planar block {}; alike in {}\n",
        study::rocks()[k].name, with_interval(rock.scores), rock.scores.brier,
        percent(rock.never.scores.share()), percent(rock.threshold.scores.share()),
        percent(rock.plain.scores.share()), rock.of_open.count, rock.scores.count,
        percent(rock.of_sure.share()), rock.scores.count - rock.scores.right, rock.expected_missed,
        percent(rock.rigid.scores.share()), percent(rock.median.scores.share()), percent(rock.agreement));
    if (!rock.halves.empty()) text += "  " + halves_in_words(rock) + "\n";
  }
  return text;
}

std::vector<std::vector<std::string>> score_rows(const Granite& of) {
  std::vector<std::vector<std::string>> rows;
  for (std::size_t k = 0; k < study::k_rocks; ++k) {
    const study::RockResults& rock = of.results.rocks[k];
    for (const auto& [name, scores] :
         {std::pair<const char*, const study::Scores&>{"scattered block", rock.scores},
          {"plain Housner block", rock.plain.scores},
          {"threshold of velocity", rock.threshold.scores},
          {"never falls", rock.never.scores},
          {"median rock", rock.median.scores},
          {"median rock, rigid model", rock.rigid.scores}})
      rows.push_back({study::rocks()[k].name + std::string(", ") + name, with_interval(scores),
                      fmt::format("{:.3f}", scores.brier), std::to_string(scores.confusion.hits),
                      std::to_string(scores.confusion.false_alarms), std::to_string(scores.confusion.misses),
                      std::to_string(scores.confusion.correct_rejections)});
  }
  return rows;
}

std::string between(double low, double high, double unit, int digits) {
  return fmt::format(" ({:.{}f} to {:.{}f})", low / unit, digits, high / unit, digits);
}

std::vector<std::vector<std::string>> fit_rows(const Granite& of) {
  std::vector<std::vector<std::string>> rows;
  for (std::size_t k = 0; k < study::k_rocks; ++k) {
    const study::RockFindings& found = of.fit.rocks[k];
    const study::RockDistribution &at = found.fitted, &low = found.low, &high = found.high;
    const auto shown = [&](double value, double least, double most, double unit, int digits) {
      return fmt::format("{:.{}f}", value / unit, digits) +
             (of.results.fitted_here ? between(least, most, unit, digits) : "");
    };
    rows.push_back({study::rocks()[k].name, shown(at.median.left, low.median.left, high.median.left, 1e-3, 1),
                    shown(at.median.right, low.median.right, high.median.right, 1e-3, 1),
                    shown(at.median.restitution, low.median.restitution, high.median.restitution, 1, 2),
                    shown(at.median.inertia, low.median.inertia, high.median.inertia, 1, 2),
                    shown(at.edge_scatter, low.edge_scatter, high.edge_scatter, 1e-2, 0),
                    shown(at.restitution_scatter, low.restitution_scatter, high.restitution_scatter, 1, 2),
                    fmt::format("{:.3f}", found.threshold),
                    fmt::format("{:.0f}, {:.0f}", 1e3 * found.plain.left, 1e3 * found.plain.right)});
  }
  return rows;
}

std::string missed_section(const Granite& of) {
  std::vector<std::vector<std::string>> rows;
  std::string words;
  for (std::size_t k = 0; k < study::k_rocks; ++k) {
    const study::RockResults& rock = of.results.rocks[k];
    int missed = 0, near = 0;
    for (std::size_t i = 0; i < of.data.tests.size(); ++i) {
      const study::Forecast& one = rock.forecasts[i];
      if (one.right()) continue;
      ++missed, near += one.probability > 0.2 && one.probability < 0.8;
      const study::GraniteTest& test = of.data.tests[i];
      rows.push_back({fmt::format("{}, test {}", study::rocks()[k].name, test.number),
                      fmt::format("{:.3f}", test.peak_velocity), fmt::format("{:.2f}", one.probability),
                      one.measured ? "fell" : "stood", rock.sure[i] ? "" : "yes"});
    }
    words +=
        html_paragraph(fmt::format("{}: {} missed. Were every probability true, {:.1f} were to be expected: "
                                   "what is missed is what the scatter "
                                   "of a rock put back by hand makes, as far as these are alike. {} of the "
                                   "missed were told between 0.2 and 0.8.",
                                   study::rocks()[k].name, missed, rock.expected_missed, near));
  }
  words +=
      html_paragraph(fmt::format("In {} tests both rocks were missed. The table's other components, how a "
                                 "rock stood before each test, and what "
                                 "its underside wore off are not known.",
                                 of.results.both_missed));
  return html_section("What is missed",
                      words + html_table({"", "velocity, m/s", "probability", "measured", "open"}, rows));
}

std::string halves_section(const Granite& of) {
  if (!of.results.fitted_here) return "";
  std::vector<std::vector<std::string>> rows;
  std::string words = html_paragraph(fmt::format(
      "Every other test by the rest and the reverse, then {} random cuts (seed {}), both ways. Only one "
      "right: "
      "tests that the scattered block tells rightly and the plain block does not, and the reverse.",
      study::k_random_halves, study::k_half_seed));
  for (std::size_t k = 0; k < study::k_rocks; ++k) {
    words += html_paragraph(study::rocks()[k].name + std::string(": ") +
                            halves_in_words(of.results.rocks[k]) + ".");
    for (const study::HalfScores& half : of.results.rocks[k].halves)
      rows.push_back({study::rocks()[k].name, with_interval(half.scores),
                      fmt::format("{:.3f}", half.scores.brier), percent(half.plain.share()),
                      percent(half.threshold.share()), percent(half.never.share()),
                      fmt::format("{}, {}", half.only_model, half.only_plain)});
  }
  return html_section("One half by the other",
                      words + html_table({"", "right, 95 %", "Brier", "plain block", "threshold",
                                          "never falls", "only one right"},
                                         rows));
}

std::string page_of(const Granite& of) {
  const auto& [first, second] = of.results.rocks;
  std::string result = html_tiles({{percent(first.scores.share()), "SP1: tests predicted rightly"},
                                   {percent(second.scores.share()), "SP2: tests predicted rightly"},
                                   {fmt::format("{:.3f}, {:.3f}", first.scores.brier, second.scores.brier),
                                    "Brier scores (0 best, 0.25 a coin)"},
                                   {std::to_string(of.data.tests.size()), "tests"}});
  result += html_paragraph(
      of.results.fitted_here
          ? "Each test is predicted by what was fitted on the other nine tenths, the baselines likewise."
          : fmt::format("All is predicted by what was fitted on {} other tests.", of.fit.tests));
  result += html_table({"share predicted rightly", "95 %", "Brier", "falls, fell", "falls, stood",
                        "stands, fell", "stands, stood"},
                       score_rows(of));
  std::string fitted = html_paragraph(
      "A planar block without slip, its height that of the mesh. Fitted by likelihood: the distances of both "
      "edges, a factor on the rate that Housner's impact leaves, one on the inertia of the mesh, and how far "
      "edges and rate scatter from test to test. In brackets: 95 % by drawing tests anew.");
  fitted += html_table({"", "left, mm", "right, mm", "factor", "inertia", "edges ±, %", "factor ±",
                        "threshold, m/s", "plain block, mm"},
                       fit_rows(of));
  std::string open;
  for (std::size_t k = 0; k < study::k_rocks; ++k) {
    const study::RockResults& rock = of.results.rocks[k];
    open +=
        html_paragraph(fmt::format("{}: of {} tests {} change their verdict when the input changes by 5 %; "
                                   "there a probability is told (Brier "
                                   "{:.3f}). Of the other {} verdicts {} are right.",
                                   study::rocks()[k].name, rock.scores.count, rock.of_open.count,
                                   rock.of_open.brier, rock.of_sure.count, percent(rock.of_sure.share())));
  }
  return html_section("Result", result) + k_chart_here + halves_section(of) +
         html_section("Probability instead of verdict", open) + html_section("What is fitted", fitted) +
         missed_section(of) +
         html_section(
             "What this does not show",
             html_paragraph("The rocks are rough and round: their edges are effective ones, fitted, below "
                            "those of the mesh. No rocking history was at hand, only who fell. Nothing is "
                            "said of sliding, nor of a cabinet."));
}

std::optional<Comparison> compare_granite(const ValidationOptions& options, const std::string& stem) {
  const auto all = std::make_shared<Granite>();
  all->data = study::read_granite(options.data, options.keep_going);
  const std::vector<study::GraniteTest>& tests = all->data.tests;
  const bool here = options.fit.empty();
  const ordered_json settings{{"validate", "granite"}, {"tests", study::fingerprint(tests)}};
  const auto work = [](auto run) { return MakeWork([run] { return CaseWork(run); }); };
  if (here) {
    study::expect_enough(tests);
    const auto rows = run_cases(options, "granite: fit", stem + "-fit", settings, study::fit_cases(),
                                work([&](int k, const std::function<bool()>& give_up) {
                                  return study::run_fit_case(tests, k, give_up);
                                }));
    if (!rows) return std::nullopt;
    all->fit = study::fit_granite(tests, *rows);
  } else {
    all->fit = study::fit_from_json(study::unpacked(options.fit), options.fit);
  }
  ordered_json predicting = settings;
  predicting["fit"] = study::fit_as_json(all->fit);
  const auto rows =
      run_cases(options, "granite: predictions", stem, predicting, study::prediction_cases(tests, here),
                work([&](int k, const std::function<bool()>& give_up) {
                  return study::run_prediction_case(tests, all->fit, here, k, give_up);
                }));
  if (!rows) return std::nullopt;
  all->results = study::gather_granite(tests, all->fit, here, *rows);
  return Comparison{.title = "Two rocks of granite on a shaking table",
                    .entries = study::granite_json(tests, all->fit, all->results),
                    .rows = study::granite_rows(tests, all->results),
                    .skipped = all->data.skipped,
                    .chart =
                        [all](const std::string& origin, study::ChartFormat format) {
                          return study::granite_chart(all->data.tests, all->fit, all->results, origin,
                                                      format);
                        },
                    .page = page_of(*all),
                    .text = in_words(*all),
                    .fit = here ? std::optional(study::fit_as_json(all->fit)) : std::nullopt};
}

}  // namespace

const Validation k_granite_validation = {
    .name = "granite",
    .about = "which of two rocks falls in tests on a shaking table",
    .source =
        "shake-table tests of June to August 2021, github.com/ZhangChen/virtual_shake_robot_pybullet, folder "
        "data/Shake_Table_Response (GPL-3.0)",
    .needs_data = true,
    .takes_fit = true,
    .compare = compare_granite};

}  // namespace topple::app
