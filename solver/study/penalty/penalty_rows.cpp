// Rows of the penalty study: names, bounds and JSON.
#include <cmath>
#include <nlohmann/json.hpp>

#include "solver/contact/contact_law.h"
#include "solver/study/common/rows.h"
#include "solver/study/penalty/penalty.h"

namespace topple::study {
namespace {

using nlohmann::ordered_json;
using Case = PenaltyRow::Case;

ordered_json positive_or_null(double value) {
  return value > 0 ? ordered_json(value) : ordered_json(nullptr);
}

}  // namespace

std::optional<double> PenaltyRow::error() const {
  if (!computed || !reference || *reference == 0) return std::nullopt;
  return std::abs(*computed - *reference) / std::abs(*reference);
}

std::optional<bool> PenaltyRow::kept() const {
  switch (kind) {
    case Case::depth:
      return computed && *computed <= k_depth_bound;
    case Case::creep:
      return computed && *computed <= k_creep_bound;
    case Case::tipping:
    case Case::fall_back:
    case Case::half_sine:
      if (status == "slides") return std::nullopt;
      return computed && *error() <= k_theory_bound;
    default:
      return std::nullopt;
  }
}

CaseMeaning meaning(Case kind) {
  switch (kind) {
    case Case::force:
      return {"force", "Penalty force", "N", "l/L", "", ""};
    case Case::depth:
      return {"depth",
              "Greatest depth 1 - l/L of the contacts at rest",
              "1",
              "",
              "rigid body in balance; (W/(n alpha))^(1/q) on n contacts around its centre",
              "computed at most 0.01"};
    case Case::creep:
      return {"creep", "Greatest way of a node in 10 s at rest", "m", "", "", "computed at most 1e-6"};
    case Case::restitution:
      return {"restitution",
              "Restitution of a normal impact without gravity",
              "1",
              "impact speed, m/s",
              "quadrature of the law",
              ""};
    case Case::frequency:
      return {"frequency",
              "Vertical motion on the contacts about rest, without loss",
              "Hz",
              "",
              "sqrt(k/m)/2 pi of a rigid body that does not lean, k the sum of q (alpha/L) depth^(q-1)",
              ""};
    case Case::tipping:
      return {"tipping", "Greatest steady acceleration withstood, over g", "1",
              "",        "b/h of a rigid block on rigid contact",          "error at most 0.02"};
    case Case::fall_back:
      return {"fall-back", "Time to fall back from half of the critical angle", "s",
              "",          "th'' = -p^2 sin(critical - th), integrated",        "error at most 0.02"};
    case Case::half_sine:
      return {"half-sine",
              "Least half-sine that overturns, over g",
              "1",
              "w/p",
              "th'' = p^2 (-sin(critical - th) + a/g cos(critical - th)), integrated",
              "error at most 0.02"};
  }
  return {};
}

ordered_json rows_as_json(const PenaltyStudy& study) {
  ordered_json rows = ordered_json::array();
  for (const PenaltyRow& row : study.rows) {
    const CaseMeaning what = meaning(row.kind);
    rows.push_back(
        {{"case", what.name},
         {"body", row.group < 0 ? ordered_json(nullptr) : ordered_json(study.groups[row.group].names)},
         {"law", traits(row.law).word},
         {"alpha_N", row.law.alpha},
         {"q", row.law.q},
         {"time_step_s", positive_or_null(row.time_step)},
         {"at", or_null(row.at)},
         {"unit", what.unit},
         {"reference", or_null(row.reference)},
         {"computed", or_null(row.computed)},
         {"error", or_null(row.error())},
         {"kept", or_null(row.kept())},
         {"status", row.status}});
  }
  return rows;
}

ordered_json cases_as_json() {
  ordered_json list = ordered_json::array();
  for (const Case kind : {Case::force, Case::depth, Case::creep, Case::restitution, Case::frequency,
                          Case::tipping, Case::fall_back, Case::half_sine}) {
    const CaseMeaning what = meaning(kind);
    list.push_back({{"case", what.name},
                    {"title", what.title},
                    {"unit", what.unit},
                    {"at", what.at},
                    {"reference", what.reference},
                    {"bound", what.bound}});
  }
  return list;
}

ordered_json groups_as_json(const PenaltyStudy& study) {
  ordered_json list = ordered_json::array();
  for (const BodyGroup& group : study.groups) {
    ordered_json entry{{"body", group.names}, {"stands", group.obstacle.empty()}};
    if (!group.obstacle.empty()) {
      entry["why_not"] = group.obstacle;
    } else {
      const Standing& body = group.theory;
      entry.update({{"mass_kg", body.mass},
                    {"contacts", body.contacts.size()},
                    {"b_m", body.base},
                    {"h_m", body.height},
                    {"p_1_s", body.p()},
                    {"rigid_limit_g", body.rigid_limit()},
                    {"first_elastic_mode_Hz", positive_or_null(group.first_mode)},
                    {"alpha_for_steady_tipping_N", group.steady_alpha},
                    {"alpha_resolved_by_time_step_N", positive_or_null(group.resolved_alpha)}});
    }
    list.push_back(std::move(entry));
  }
  return list;
}

}  // namespace topple::study
