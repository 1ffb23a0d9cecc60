// Penalty contact of a scene: force, rest, creep, restitution, and what alpha does to standing bodies.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "solver/run/run.h"
#include "solver/study/common/standing.h"

namespace topple::study {

inline constexpr double k_depth_bound = 0.01;       ///< of the depth 1 - l/L at rest
inline constexpr double k_theory_bound = 0.02;      ///< of the error against rigid contact
inline constexpr double k_creep_bound = 1e-6;       ///< m, of the displacement in k_creep_time at rest
inline constexpr double k_creep_time = 10;          ///< s
inline constexpr double k_period_steps = 20;        ///< time steps that resolve a period of the bounce
inline constexpr double k_pulse_ratios[] = {2, 4};  ///< w/p of the half-sines

/// One number of the study.
struct PenaltyRow {
  enum class Case { force, depth, creep, restitution, frequency, tipping, fall_back, half_sine };
  Case kind;
  int group = -1;  ///< index into PenaltyStudy::groups; -1: of no body
  ContactLaw law;
  double time_step = 0;             ///< s; 0: chosen step by step, or none is taken
  bool coarse = false;              ///< the scene's own step, which is too long to resolve the bounce
  std::optional<double> at;         ///< l/L, impact speed in m/s, or w/p
  std::optional<double> reference;  ///< of theory, in CaseMeaning::unit
  std::optional<double> computed = {};
  std::string status = "not run";

  std::optional<double> error() const;  ///< |computed - reference|/|reference|
  /// Whether the bound of its case is kept; none: it has no bound.
  std::optional<bool> kept() const;
};

/// A case by name, what its numbers are, and their bound.
struct CaseMeaning {
  const char *name, *title, *unit;
  const char* at;         ///< what PenaltyRow::at is; "": nothing
  const char* reference;  ///< source
  const char* bound;      ///< in words; "": none
};
CaseMeaning meaning(PenaltyRow::Case kind);

/// Bodies that are alike when each stands alone on the floor.
struct BodyGroup {
  std::string names;  ///< "free, walled"
  std::vector<int> bodies;
  std::string obstacle;       ///< why they do not stand on the floor; else empty
  Standing theory = {};       ///< of a rigid one
  double first_mode = 0;      ///< Hz, of the first elastic mode; 0: none found
  double steady_alpha = 0;    ///< N, alpha_for_tipping within k_theory_bound
  double resolved_alpha = 0;  ///< N, greatest with k_period_steps of the scene's step a period; 0: adaptive
};

struct PenaltyStudy {
  std::string scene, title;
  ContactLaw law;
  double time_step = 0;  ///< s; 0: adaptive
  std::vector<BodyGroup> groups;
  std::vector<double> alphas;    ///< N, tried, ascending
  std::vector<PenaltyRow> rows;  ///< by case, group, law, q, alpha
  int run = 0, of = 0;           ///< rows that take a run
};

/// Why a scene cannot be studied: "has no floor that is a horizontal plane". Empty: it can.
std::string why_not_studied(const Setup& setup);

struct PenaltySettings {
  int jobs = 1;  ///< runs at a time
};

/// All runs, cheap ones and those that decide on alpha first. The scene must be fit for it. go_on(done, of)
/// as for_each_case (parallel.h).
PenaltyStudy study_penalty(const std::string& name, const std::string& title, const Setup& scene,
                           const PenaltySettings& settings,
                           const std::function<bool(int done, int of)>& go_on);

/// The rows as a list of flat objects: the content of penalty.csv.
nlohmann::ordered_json rows_as_json(const PenaltyStudy& study);

/// The cases with title, unit, source and bound.
nlohmann::ordered_json cases_as_json();

/// The groups with what is known of them before any run.
nlohmann::ordered_json groups_as_json(const PenaltyStudy& study);

}  // namespace topple::study
