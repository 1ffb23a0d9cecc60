// The summary in words.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <utf8.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "app/batch/load_steps.h"
#include "app/batch/summary.h"
#include "app/batch/ways_summary.h"
#include "app/support/force_error.h"
#include "app/support/integrators.h"
#include "app/support/model_words.h"
#include "app/support/models_in_brief.h"
#include "app/support/terms.h"
#include "solver/body/model_level.h"
#include "solver/planar/planar_case.h"
#include "solver/study/common/refinement.h"

namespace topple::app {
namespace {

using nlohmann::ordered_json;

constexpr double k_least_error = 1e-4;  // of a model, that is told: those of steps are greater

std::string text(const ordered_json& value, const char* format) {
  return value.is_null() ? "-" : fmt::format(fmt::runtime(format), value.get<double>());
}

std::string two_digits(double error) {
  return error < 100 ? fmt::format("{:.2g}", error) : fmt::format("{:.0f}", error);
}

/// The line about `error_estimate` of a run of `bodies`.
std::string estimate_in_words(const ordered_json& e, const ordered_json& bodies) {
  const std::string begin = fmt::format("error of the time integration ({}): ", e["how"].get<std::string>());
  if (e.contains("failed"))
    return begin + "unknown, the finer run failed: " + e["failed"].get<std::string>() + "\n";
  std::string parts;
  if (!e["disagreements"].empty()) {
    std::string words;
    for (const auto& line : e["disagreements"])
      words += (words.empty() ? "" : "; ") + line.get<std::string>();
    const bool open =
        std::ranges::any_of(e["bodies"], [](const ordered_json& body) { return !body["same_verdict"]; });
    parts = (open ? "the verdict itself is open: " : "the two runs part: ") + words;
    if (e["disagreements"].size() == e["bodies"].size()) return begin + parts + "\n";
    parts += "; of the others ";
  }
  const auto part = [&](const char* name, const char* key, double scale, const char* unit, double least) {
    double error = -1;
    for (const ordered_json& body : e["bodies"])
      if (!body[key].is_null()) error = std::max(error, body[key].get<double>());
    if (error < 0) return std::string();
    return fmt::format("{} {}{} {}, ", name, error > (1 + 1e-9) * least ? "" : "less than ",
                       two_digits(scale * error), unit);
  };
  std::string words = part("overturning", "overturn_time_s", 1, "s", study::k_least_time_error) +
                      part("peak tilt", "peak_tilt_deg", 1, "deg", study::k_least_tilt_error * k_degrees) +
                      part("base moved", "peak_slide_m", 1e3, "mm", study::k_least_slide_error) +
                      part("peak stress", "peak_stress_Pa", 1e-6, "MPa", 0);
  words.resize(words.size() - std::min<std::size_t>(words.size(), 2));
  bool blow = false;  // decides a stress
  for (std::size_t b = 0; b < e["bodies"].size(); ++b)
    blow = blow || (e["bodies"][b]["same_course"].get<bool>() && e["bodies"][b]["peak_stress_Pa"].is_null() &&
                    !bodies[b]["peak_stress_Pa"].is_null());
  if (blow) words += "; of the stress of a landing it is unknown";
  for (const auto& line : e["parted"]) words += "; " + line.get<std::string>() + ": one course of many";
  return begin + parts + words + "\n";
}

std::string static_head(const ordered_json& s) {
  std::string out = fmt::format(
      "{}: {} in {:.2f} s of wall time\nstatic: {} load steps, {} halved, {} iterations\n",
      s["scene"].get<std::string>(), s["status"].get<std::string>(), s["wall_s"].get<double>(),
      s["steps"].get<long>(), s["rejected_steps"].get<long>(), s["newton_iterations"].get<long>());
  const ordered_json& steps = s["static"];
  constexpr double k_nothing = 1e-9;  // of the greatest factor
  const auto size = [](const ordered_json& step) {
    return step["factor"].is_number() ? std::abs(step["factor"].get<double>()) : 0.;
  };
  double greatest = 0;
  for (const ordered_json& step : steps) greatest = std::max(greatest, size(step));
  const auto is_nothing = [&](const ordered_json& step) {
    return step["converged"].get<bool>() && size(step) < k_nothing * greatest;
  };
  for (std::size_t k = 0; k < steps.size();) {
    const ordered_json& first = steps[k];
    std::size_t end = k + 1;  // of those of which the same is to be said
    if (is_nothing(first) && first["stable"] == false) {
      while (end < steps.size() && is_nothing(steps[end])) ++end;
      out += fmt::format("load factor 0 in {} step{}: a mechanism, which carries nothing\n", end - k,
                         end - k > 1 ? "s" : "");
      k = end;
      continue;
    }
    while (end < steps.size() &&
           std::ranges::all_of(std::array{"converged", "loss", "negative_pivots"},
                               [&](const char* key) { return steps[end][key] == first[key]; }))
      ++end;
    const auto factor = [&](const ordered_json& step) {
      return is_nothing(step) ? std::string("0") : text(step["factor"], "{:.6g}");
    };
    out += "load factor " + factor(first);
    if (end > k + 1) {
      std::size_t most = k;
      for (std::size_t i = k; i < end; ++i)
        if (size(steps[i]) > size(steps[most])) most = i;
      const std::string passed = factor(steps[most]), last = factor(steps[end - 1]);
      out += fmt::format(" to {} in {} steps{}", last, end - k,
                         passed != last && passed != factor(first) ? ", greatest " + passed : "");
    }
    out += fmt::format(": {}{}\n",
                       first["converged"].get<bool>() ? "converged"
                       : s["status"] == "stopped"     ? "not stable, the path ends"
                                                      : "no equilibrium near the last one",
                       loss_in_words(first));
    k = end;
  }
  const auto stable = [](const ordered_json& step) { return step["stable"] == true; };
  if (!steps.empty() && std::ranges::all_of(steps, stable))
    out += s["status"] == "diverged" ? "stable at every load factor up to there\n"
                                     : "stable at every load factor\n";
  return out + "\n";
}

// Of pieces that have another one.
std::string own_frictions(const ordered_json& s) {
  constexpr std::size_t k_most = 3;
  std::string words;
  std::size_t count = 0;
  for (const ordered_json& b : s["bodies"])
    if (b.contains("friction") && b["friction"] != s["contact"]["friction"] && ++count <= k_most)
      words += fmt::format("{}{} {:.6g}", count > 1 ? ", " : "", b["name"].get<std::string>(),
                           b["friction"].get<double>());
  return count == 0
             ? ""
             : " (" + words + (count > k_most ? fmt::format(" and {} more", count - k_most) : "") + ")";
}

// What moved bodies on the levels that they were on.
std::string integrators(const ordered_json& s) {
  std::set<ModelLevel> levels, otherwise;
  std::string of_frames;
  const auto take = [&](const ordered_json& of) {
    const ModelLevel level = level_called(of["model"].get<std::string>()).kind;
    levels.insert(level);
    const LevelIntegrator& integrator = row_of(k_level_integrators, level);
    if (level == ModelLevel::frame) of_frames = of["integrator"].get<std::string>();
    if (integrator.differs && of["integrator"] == integrator.otherwise) otherwise.insert(level);
  };
  for (const auto& b : s["bodies"]) {
    take(b);
    for (const auto& change : b["models"]) take(change);
  }
  if (levels.contains(ModelLevel::rigid))
    levels.erase(ModelLevel::elastic);  // which is moved by a part of that
  std::vector<std::string> all;
  for (const ModelLevel level :
       {ModelLevel::frame, ModelLevel::elastic, ModelLevel::rigid, ModelLevel::planar}) {
    if (!levels.contains(level)) continue;
    const Phrase* const own = model_words::moved_by(level, otherwise.contains(level));
    std::string words = own ? std::string(own->english) : of_frames;
    if (level == ModelLevel::frame && levels.size() > 1) words += " (frames)";
    if (level == ModelLevel::planar) words += " (planar)";
    all.push_back(std::move(words));
  }
  return fmt::format("{}", fmt::join(all, ", "));
}

/// What the estimate leaves out: it is of a body that stands.
std::string what_enlarges(const ordered_json& body, const ordered_json& change, bool solid) {
  constexpr double k_slides = 1e-3;  // m, above creep on its contacts
  const bool near = body["not_planar"] == planar::traits(planar::Obstacle::near).phrase;
  const ordered_json pinch = body.value("peak_pinch_ratio", ordered_json()),
                     slide = body.value("peak_slide_m", ordered_json());
  // of a block soft contacts are in it, up to a landing, but not those that stand for a hard floor
  const std::string until = change["model"] == "planar" ? " until it lands" : " until it lifts";
  if (change["model"] == "rigid" && near)
    return until + "; leaning and striking something, from which a frame springs back, enlarge that";
  if (change["model"] == "elastic" && pinch.is_number() && pinch > 0)
    return until + "; leaning and knocks against other bodies enlarge that";
  if (body["impacts"].get<int>() > 0) return until + "; leaning and landing enlarge that";
  if (!body["first_beyond_critical_s"].is_null()) return until + "; leaning enlarges that";
  if (!solid && slide.is_number() && slide > k_slides)
    return " until it slides; legs that bend back as it slips enlarge that";
  return "";
}

std::string allowed_error(const ordered_json& s, const ordered_json& body, const ordered_json& change) {
  const ordered_json &estimate = change["error_estimate"], &fell = body["overturn_time_s"];
  if (level_called(change["model"].get<std::string>()).moves_nodes) return "";
  if (!fell.is_null() && fell.get<double>() <= change["from_s"].get<double>()) return "";
  if (estimate.is_null()) return "; error unknown since it landed on parts that give way more than contacts";
  if (estimate == 0) return "";  // a block, or nothing pushed it
  const bool solid = change["reason"] == name(LevelReason::solid);
  const double error = estimate.get<double>();
  const std::string size =
      error < k_least_error ? "less than 0.1 %" : fmt::format("about {:.2g} %", 100 * error);
  if (change["error_of"] == "stress" && error >= 1) return "; what its blows do to its stresses is not known";
  if (change["error_of"] == "stress")
    return "; but for friction at its feet its stresses are off from a frame's by " + size;
  const std::string off = size + what_enlarges(body, change, solid);
  if (solid) return "; its contacts give, which puts it off by " + off;
  const bool on_hard_floor = change["model"] == "planar" && s["contact"]["stands_for_hard_floor"] == true;
  const char* const but = change["model"] == "elastic" ? "but for friction at its feet "
                          : on_hard_floor              ? "not counting how far its contacts give way, it is "
                                                       : "";
  return fmt::format("; {}off from a frame by {}", but, off);
}

// Of the model that a body begins with.
std::string not_planar(const ordered_json& body, const ordered_json& model) {
  const bool first = model["from_s"] == body["models"].front()["from_s"];
  return !first || body["not_planar"].is_null() ? ""
                                                : "; not planar: " + body["not_planar"].get<std::string>();
}

// Bodies that were computed alike share theirs.
std::string model_lines(const ordered_json& s) {
  constexpr std::size_t few = 4;
  struct Alike {
    std::vector<std::string> models, names;
  };
  std::vector<Alike> all;
  for (const auto& b : s["bodies"]) {
    std::vector<std::string> models;
    for (const ordered_json& model : models_in_brief(b["models"])) {
      const std::string times = model["times"];
      models.push_back(
          fmt::format("{} from {} s{} ({}{}{})\n", model["model"].get<std::string>(),
                      text(model["from_s"], "{:.3f}"), times.empty() ? "" : ", " + times + " times",
                      model["reason"].get<std::string>(), not_planar(b, model), allowed_error(s, b, model)));
    }
    auto group = std::ranges::find(all, models, &Alike::models);
    if (group == all.end()) group = all.insert(all.end(), {std::move(models), {}});
    group->names.push_back(b["name"].get<std::string>());
  }
  std::string out;
  for (const auto& [models, names] : all) {
    const std::size_t told = names.size() > few ? few - 1 : names.size();
    std::string who =
        fmt::format("{}", fmt::join(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(told), ", "));
    if (told < names.size()) who += fmt::format(" and {} more", names.size() - told);
    for (const std::string& model : models) out += who + ": " + model;
  }
  return out;
}

std::string contact_line(const ordered_json& s) {
  const ordered_json& contact = s["contact"];
  if (contact.is_null()) return "";
  const ordered_json &share = contact["member_share"], &restitution = contact["restitution"];
  return fmt::format(
      "contact: {}, alpha {:.6g} kgf{}, q {:.6g}, friction {:.6g}{}{}\n", contact["law"].get<std::string>(),
      contact["alpha_N"].get<double>() / k_standard_gravity,
      share.is_null() || share == 1 ? ""
                                    : fmt::format(" ({:.3g} of it between members)", share.get<double>()),
      contact["q"].get<double>(), contact["friction"].get<double>(), own_frictions(s),
      restitution.is_null() ? "" : fmt::format(", restitution {:.6g}", restitution.get<double>()));
}

std::string dynamic_head(const ordered_json& s) {
  std::string out = fmt::format("{}: {} after {:.6g} s", s["scene"].get<std::string>(),
                                s["status"].get<std::string>(), s["simulated_s"].get<double>());
  const double real_time = s["realtime_factor"].is_null() ? 0 : s["realtime_factor"].get<double>();
  if (real_time > 0)
    out += fmt::format(" ({:.2f} s of wall time, {:.{}g} times real time)", s["wall_s"].get<double>(),
                       real_time, real_time < 10 ? 2 : 4);
  out += fmt::format("\n{}, {} {} s: {} steps, {} rejected", integrators(s),
                     s["adaptive"].get<bool>() ? "mean step" : "step", text(s["time_step_s"], "{:g}"),
                     s["steps"].get<long>(), s["rejected_steps"].get<long>());
  // as where no body is a frame
  if (const auto iterations = s["newton_iterations"].get<long>(); iterations > 0)
    out += fmt::format(", {} iterations", iterations);
  out += "\n" + contact_line(s);
  return out + energy_in_words(s["energy"]) + "\n";
}

std::string damage_line(const ordered_json& b) {
  const int hinges = b["hinges"].get<int>(), fractures = b["fractures"].get<int>();
  if (hinges + fractures == 0) return "";
  const auto counted = [](int count, const char* what) {
    return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
  };
  return b["name"].get<std::string>() + ": " + (hinges > 0 ? counted(hinges, "plastic hinge") : "") +
         (hinges > 0 && fractures > 0 ? ", " : "") +
         (fractures > 0 ? counted(fractures, "broken section") : "") +
         (hinges > 0 && !b["peak_stress_Pa"].is_null()
              ? " (where a section flows its stress is told as if elastic, N/A + M/W, and may be above yield)"
              : "") +
         "\n";
}

// Of a body that may come back yet.
std::string lately_line(const ordered_json& b, const ordered_json& end) {
  constexpr double lately = 1, far = 60;  // s, degrees
  if (!b["overturned"].get<bool>() || end.is_null() || b["final_tilt_deg"].is_null()) return "";
  const double since = end.get<double>() - b["overturn_time_s"].get<double>();
  if (since > lately || b["final_tilt_deg"].get<double>() > far) return "";
  return fmt::format(
      "{}: beyond its critical angle for the last {:.3g} s alone; a longer run tells whether it comes back\n",
      b["name"].get<std::string>(), since);
}

// Of a body that a slight change may topple, or keep from it.
std::string chance_line(const ordered_json& b) {
  constexpr int k_many_impacts = 10;  // each enlarges what differs before it
  constexpr double k_near = 0.8;      // of the critical angle
  const ordered_json told = b.value("peak_critical_share", ordered_json());  // older recordings lack it
  if (told.is_null()) return "";
  const auto share = told.get<double>();
  const bool fell = b["overturned"].get<bool>();
  const auto before = [&](const ordered_json& impact) { return impact < b["overturn_time_s"]; };
  const auto impacts = fell ? std::ranges::count_if(b["impact_times_s"], before) : 0;
  if (fell ? impacts <= k_many_impacts : share < k_near || share > 1) return "";
  return fmt::format(
      "{}: {}, so that a slight change may {}; topple report gives the share of such runs in which it "
      "falls\n",
      b["name"].get<std::string>(),
      fell ? fmt::format("overturned after {} impacts", impacts)
           : fmt::format("came to {:.0f} % of its critical angle", 100 * share),
      fell ? "keep it upright" : "topple it");
}

std::string anchor_line(const ordered_json& a, const ordered_json& error, const char* when) {
  const double peak = a["peak_force_N"].get<double>();
  std::string line = a["fixing"].is_null() ? "" : fixing_line(a) + "\n";
  if (was_never_in_place(a))
    return line + fmt::format("anchor {}: not in place\n", a["name"].get<std::string>());
  line += fmt::format("anchor {}: greatest force {:.4g}{} N", a["name"].get<std::string>(), peak,
                      error.is_null() ? "" : " ± " + two_digits(error.get<double>()));
  if (a["broke"].get<bool>())
    return line + fmt::format(", broke at {} {}\n", text(a["break_time_s"], "{:.4f}"), when);
  if (!a["strength_N"].is_null())
    line += ", " + percent_of(peak, a["strength_N"].get<double>()) + " of its strength";
  if (!a["in_place"].get<bool>()) return line + ", taken away\n";
  return line + (a["slack"].get<bool>() ? ", slack at the end\n" : "\n");
}

}  // namespace

std::size_t letters(const std::string& text) {
  const std::string clean = utf8::replace_invalid(text);
  return static_cast<std::size_t>(utf8::distance(clean.begin(), clean.end()));
}

std::string fixing_line(const ordered_json& a) {
  const auto at = [](const ordered_json& end) {
    return fmt::format("node {} of {}, {:.0f} mm from it", end["node"].get<int>(),
                       end["body"].get<std::string>(), 1e3 * end["distance_m"].get<double>());
  };
  const std::string to = a["leads_to"].get<std::string>();
  return fmt::format("fixing {}: {} on {}, to {}", a["name"].get<std::string>(),
                     a["fixing"].get<std::string>(), at(a["own_end"]),
                     a["other_end"].is_null() ? to : at(a["other_end"]));
}

std::string wedge_line(const ordered_json& w) {
  if (w["nodes"].empty())
    return fmt::format("fixing {}: stopper of {}, not in place", w["name"].get<std::string>(),
                       w["body"].get<std::string>());
  std::string nodes;
  for (const auto& node : w["nodes"])
    nodes += (nodes.empty() ? "" : " and ") + std::to_string(node.get<int>());
  return fmt::format("fixing {}: stopper under node{} {} of {}, lifts it by {:.1f} mm",
                     w["name"].get<std::string>(), w["nodes"].size() > 1 ? "s" : "", nodes,
                     w["body"].get<std::string>(), 1e3 * w["lift_m"].get<double>());
}

std::string energy_in_words(const ordered_json& e) {
  constexpr double k_told = 1e-3;  // of what came in or was dissipated
  const auto joules = [&](const char* key) { return e[key].is_null() ? 0 : e[key].get<double>(); };
  const double plastic = joules("plastic_J"), switched = joules("model_switch_J");
  const double size = std::max(std::abs(joules("input_J")), std::abs(joules("dissipated_J")));
  return fmt::format(
      "energy: {} J came in{}, {} J dissipated{}, balance error {}\n", text(e["input_J"], "{:.4g}"),
      std::abs(switched) <= k_told * size ? ""
                                          : fmt::format(", {:.3g} J as models of bodies changed", switched),
      text(e["dissipated_J"], "{:.4g}"),
      plastic == 0 ? "" : fmt::format(" ({:.4g} J of it by plastic flow)", plastic),
      text(e["balance_error"], "{:.1e}"));
}

namespace {

std::string stress_text(const ordered_json& b) {
  return b["peak_stress_Pa"].is_null() ? "-"
                                       : fmt::format("{:.2f}", 1e-6 * b["peak_stress_Pa"].get<double>());
}

/// Of a run that ended before its time.
std::string until_when(const ordered_json& s) {
  static constexpr std::pair<std::string_view, const char*> k_ends[] = {
      {"stopped", "stopped"}, {"diverged", "diverged"}, {"interrupted", "was interrupted"}};
  const auto* const end =
      std::ranges::find(k_ends, s["status"].get<std::string>(), [](const auto& row) { return row.first; });
  if (end == std::end(k_ends)) return "";
  return fmt::format("all that follows is until {} s, where the run {}; what comes later is not known\n",
                     text(s["simulated_s"], "{:.6g}"), end->second);
}

/// A row for each body; of loads on frames that are held, which have no angle to fall at, their stress alone.
std::string outcome_rows(const ordered_json& s, int width, const char* when) {
  const bool can_fall =
      s["analysis"] != "static" || std::ranges::any_of(s["bodies"], [](const ordered_json& b) {
        return !b.value("critical_tilt_deg", ordered_json()).is_null();
      });
  if (!can_fall) {
    std::string out =
        fmt::format("{:<{}} {:>11}\n{:<{}} {:>11}\n", "body", width, "peak stress", "", width, "MPa");
    for (const auto& b : s["bodies"])
      out += fmt::format("{:<{}} {:>11}\n", b["name"].get<std::string>(), width, stress_text(b));
    return out;
  }
  std::string out =
      fmt::format("{:<{}} {:>12} {:>9} {:>8} {:>10} {:>10} {:>10} {:>11}\n", "body", width, "overturned",
                  "uplift", "impacts", "peak tilt", "final tilt", "base moved", "peak stress");
  out += fmt::format("{:<{}} {:>12} {:>9} {:>8} {:>10} {:>10} {:>10} {:>11}\n", "", width, when, when, "",
                     "deg", "deg", "mm", "MPa");
  for (const auto& b : s["bodies"])
    out += fmt::format(
        "{:<{}} {:>12} {:>9} {:>8} {:>10} {:>10} {:>10} {:>11}\n", b["name"].get<std::string>(), width,
        b["overturned"].get<bool>() ? text(b["overturn_time_s"], "{:.4f}") : "no",
        text(b["first_uplift_s"], "{:.3f}"), b["impacts"].get<int>(), text(b["peak_tilt_deg"], "{:.3f}"),
        text(b["final_tilt_deg"], "{:.3f}"),
        b["peak_slide_m"].is_null() ? "-" : fmt::format("{:.2f}", 1e3 * b["peak_slide_m"].get<double>()),
        stress_text(b));
  return out;
}

}  // namespace

std::string summary_table(const ordered_json& s) {
  const bool is_static = s["analysis"] == "static";
  const char* const when = is_static ? "of path" : "s";  // a static run has no time
  std::string out = is_static ? static_head(s) : dynamic_head(s);
  int width = 14;
  for (const auto& b : s["bodies"])
    width = std::max(width, static_cast<int>(letters(b["name"].get<std::string>())));
  if (!is_static) out += until_when(s);
  out += outcome_rows(s, width, when);
  out += model_lines(s);
  for (const auto& b : s["bodies"])
    if (!b["overturned"].get<bool>() && !b["first_beyond_critical_s"].is_null())
      out += fmt::format("{}: leaned beyond its critical angle, first at {} {}, and came back\n",
                         b["name"].get<std::string>(), text(b["first_beyond_critical_s"], "{:.3f}"), when);
  for (const auto& b : s["bodies"])
    if (!is_static) out += lately_line(b, s["simulated_s"]) + chance_line(b);
  for (const auto& b : s["bodies"]) out += damage_line(b);
  for (std::size_t k = 0; k < s["anchors"].size(); ++k)
    out += anchor_line(s["anchors"][k], force_error(s, k), when);
  for (const auto& w : s["wedges"]) out += wedge_line(w) + "\n";
  if (s.contains("error_estimate") && !s["error_estimate"].is_null())
    out += estimate_in_words(s["error_estimate"], s["bodies"]);
  if (s.contains("ways")) out += ways_in_words(s["ways"], s["person_m"].get<double>());
  for (const auto& p : s["probes"]) {
    const auto& d = p["final"]["displacement_m"];
    out += fmt::format("probe {}: {}, {}, {} m\n", p["name"].get<std::string>(), text(d[0], "{:.6g}"),
                       text(d[1], "{:.6g}"), text(d[2], "{:.6g}"));
  }
  return out;
}

}  // namespace topple::app
