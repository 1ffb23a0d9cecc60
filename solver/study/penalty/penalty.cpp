#include "solver/study/penalty/penalty.h"

#include <algorithm>
#include <cmath>

#include "solver/contact/contact_law.h"
#include "solver/frame/integrator.h"
#include "solver/frame/modes.h"
#include "solver/study/common/alone.h"
#include "solver/study/common/parallel.h"
#include "solver/study/penalty/contact_trials.h"
#include "solver/study/penalty/impact.h"

namespace topple::study {
namespace {

using Case = PenaltyRow::Case;

constexpr double k_drawn_q[] = {1, 1.5, 2, 3};
constexpr int k_force_places = 50;
constexpr double k_speeds[] = {0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2};  // m/s
constexpr double k_beyond = 40;  // alphas are tried up to this over the steady one
constexpr double k_least_alpha = 1e-3 * k_standard_gravity, k_most_alpha = 1e6 * k_standard_gravity;
constexpr int k_modes = 12;

/// A row and the run that fills it; without run it is filled already.
struct Entry {
  PenaltyRow row;
  std::function<ContactTrial()> trial;
};

std::vector<BodyGroup> groups_of(const Setup& scene) {
  std::vector<BodyGroup> groups;
  for (int b = 0; b < static_cast<int>(scene.model.bodies.size()); ++b) {
    const std::string& name = scene.model.bodies[b].name;
    const auto like = std::find_if(groups.begin(), groups.end(), [&](const BodyGroup& group) {
      return group.obstacle == why_not_standing(scene.model, b) &&
             alike(scene.model, group.bodies.front(), b);
    });
    if (like != groups.end()) {
      like->names += ", " + name;
      like->bodies.push_back(b);
      continue;
    }
    BodyGroup group{.names = name, .bodies = {b}, .obstacle = why_not_standing(scene.model, b)};
    if (group.obstacle.empty()) {
      const Parameters& parameters = scene.parameters;
      group.theory = standing(scene.model, parameters, b);
      for (const Mode& mode : natural_modes(scene.model, b, k_modes))
        if (!mode.rigid && group.first_mode == 0) group.first_mode = mode.frequency;
      group.steady_alpha = alpha_for_tipping(group.theory, parameters.contact, k_theory_bound);
      if (!parameters.adaptive)
        group.resolved_alpha =
            alpha_for_period(group.theory, parameters.contact, k_period_steps * parameters.time_step);
    }
    groups.push_back(std::move(group));
  }
  return groups;
}

/// 1, 2, 5, 10 ... kgf from where a body would stand on its centre lines to well above what steady tipping
/// asks for, with the scene's alpha and the program's.
std::vector<double> alphas_for(const std::vector<BodyGroup>& groups, double scene_alpha) {
  double least = k_most_alpha, most = k_least_alpha;
  for (const BodyGroup& group : groups) {
    if (!group.obstacle.empty()) continue;
    const double sunk = group.theory.weight() / static_cast<double>(group.theory.contacts.size());
    least = std::min(least, 2 * sunk);
    most = std::max(most, k_beyond * group.steady_alpha);
  }
  std::vector<double> alphas{scene_alpha, ContactLaw().alpha};
  bool enough = false;
  for (double decade = k_least_alpha; decade <= k_most_alpha && !enough; decade *= 10)
    for (const double digit : {1., 2., 5.}) {
      const double alpha = digit * decade;
      if (alpha < least || alpha > k_most_alpha || enough) continue;
      alphas.push_back(alpha);
      enough = alpha >= most;
    }
  std::sort(alphas.begin(), alphas.end());
  const auto same = [](double a, double b) { return std::abs(a - b) < 1e-6 * b; };
  alphas.erase(std::unique(alphas.begin(), alphas.end(), same), alphas.end());
  return alphas;
}

/// The scene's step, or a shorter one that resolves the bounce.
void resolve(Setup& setup, double frequency) {
  Parameters& parameters = setup.parameters;
  if (parameters.adaptive || traits(parameters.integrator).is_explicit) return;
  parameters.time_step = std::min(parameters.time_step, 1 / (k_period_steps * frequency));
}

double fixed_step(const Setup& setup) {
  return setup.parameters.adaptive ? 0 : setup.parameters.time_step;
}

/// Runs of lower numbers come first: a time budget leaves out what decides least.
int urgency(const PenaltyStudy& study, const PenaltyRow& row) {
  if (row.kind != Case::half_sine) return 0;
  if (row.coarse) return 3;
  const double own = study.groups[row.group].steady_alpha;
  return row.law.alpha == study.law.alpha || row.law.alpha > own / 2 ? 1 : 2;
}

/// Lists the rows of a study in the order of Case.
class Lister {
 public:
  Lister(const Setup& scene, const PenaltyStudy& study) : scene_(scene), study_(study) {}

  std::vector<Entry> all() {
    list_force();
    each_alpha([&](int g, const Setup& body) { list_depth(g, body); });
    list_creep();
    list_restitution();
    each_alpha([&](int g, const Setup& body) { list_frequency(g, body); });
    each_alpha([&](int g, const Setup& body) { list_tipping(g, body); });
    each_alpha([&](int g, const Setup& body) { list_fall_back(g, body); });
    for (const double ratio : k_pulse_ratios)
      each_alpha([&](int g, const Setup& body) { list_half_sine(g, body, ratio); });
    return std::move(entries_);
  }

 private:
  const Standing& theory(int g) const { return study_.groups[g].theory; }

  PenaltyRow& add(Case kind, int group, const ContactLaw& law, std::function<ContactTrial()> trial = {}) {
    entries_.push_back(
        {{.kind = kind, .group = group, .law = law, .at = {}, .reference = {}}, std::move(trial)});
    return entries_.back().row;
  }

  template <typename List>
  void each_alpha(List list) {
    for (int g = 0; g < static_cast<int>(study_.groups.size()); ++g) {
      if (!study_.groups[g].obstacle.empty()) continue;
      Setup body = alone(scene_, study_.groups[g].bodies.front(), false);
      for (const double alpha : study_.alphas) {
        body.parameters.contact.alpha = alpha;
        list(g, body);
      }
    }
  }

  void list_force() {
    std::vector<double> drawn(std::begin(k_drawn_q), std::end(k_drawn_q));
    if (std::find(drawn.begin(), drawn.end(), study_.law.q) == drawn.end()) drawn.push_back(study_.law.q);
    std::sort(drawn.begin(), drawn.end());
    for (const double q : drawn)
      for (int k = 0; k <= k_force_places; ++k) {
        ContactLaw law = study_.law;
        law.q = q;
        PenaltyRow& row = add(Case::force, -1, law);
        row.at = static_cast<double>(k) / k_force_places;
        row.computed = penalty_force(law, 1 - *row.at);
        row.status = "completed";
      }
  }

  void list_depth(int g, const Setup& body) {
    const ContactLaw& law = body.parameters.contact;
    add(Case::depth, g, law, [body] { return settled_depth(body); }).reference = rest_depth(theory(g), law);
  }

  void list_creep() {
    for (int g = 0; g < static_cast<int>(study_.groups.size()); ++g) {
      if (!study_.groups[g].obstacle.empty()) continue;
      for (const ContactLawTraits& of : contact_laws()) {
        Setup body = alone(scene_, study_.groups[g].bodies.front(), true);
        body.parameters.contact.kind = of.kind;
        PenaltyRow& row =
            add(Case::creep, g, body.parameters.contact, [body] { return creep(body, k_creep_time); });
        row.time_step = fixed_step(body);
      }
    }
  }

  void list_restitution() {
    const Standing& first = std::find_if(study_.groups.begin(), study_.groups.end(), [](const BodyGroup& g) {
                              return g.obstacle.empty();
                            })->theory;
    const ImpactMass mass{first.mass, static_cast<int>(first.contacts.size()), first.contacts.front().L};
    for (const ContactLawTraits& of : contact_laws())
      for (const double speed : k_speeds) {
        Parameters parameters = scene_.parameters;
        parameters.contact.kind = of.kind;
        PenaltyRow& row =
            add(Case::restitution, -1, parameters.contact, [=] { return impact(mass, parameters, speed); });
        row.time_step = parameters.adaptive ? 0 : parameters.time_step;
        row.at = speed;
        row.reference = restitution(parameters.contact, speed);
      }
  }

  void list_frequency(int g, const Setup& body) {
    const ContactLaw& law = body.parameters.contact;
    const double expected = bounce_frequency(theory(g), law);
    PenaltyRow& row = add(Case::frequency, g, law, [=] { return settled_frequency(body, expected); });
    row.reference = expected;
  }

  void list_tipping(int g, const Setup& body) {
    PenaltyRow& row = add(Case::tipping, g, body.parameters.contact,
                          [body, theory = theory(g)] { return settled_tipping_limit(body, theory); });
    row.reference = theory(g).rigid_limit();
    refuse_sliding(row, theory(g), theory(g).rigid_limit());
  }

  void list_fall_back(int g, Setup body) {
    resolve(body, bounce_frequency(theory(g), body.parameters.contact));
    PenaltyRow& row = add(Case::fall_back, g, body.parameters.contact,
                          [body, theory = theory(g)] { return fall_back(body, theory); });
    row.time_step = fixed_step(body);
    row.reference = fall_back_time(theory(g));
    refuse_sliding(row, theory(g), theory(g).rigid_limit());
  }

  void list_half_sine(int g, const Setup& body, double ratio) {
    Setup resolved = body;
    resolve(resolved, bounce_frequency(theory(g), body.parameters.contact));
    add_half_sine(g, resolved, ratio);
    if (fixed_step(resolved) == fixed_step(body)) return;
    add_half_sine(g, body, ratio).coarse = true;
  }

  PenaltyRow& add_half_sine(int g, const Setup& body, double ratio) {
    const double expected = least_half_sine(theory(g), ratio);
    PenaltyRow& row = add(Case::half_sine, g, body.parameters.contact, [=, theory = theory(g)] {
      return overturning_half_sine(body, theory, ratio, expected);
    });
    row.time_step = fixed_step(body);
    row.at = ratio;
    row.reference = expected;
    refuse_sliding(row, theory(g), expected);
    return row;
  }

  /// A push of more than mu g moves a body along instead of tipping it, and theory does not hold.
  void refuse_sliding(PenaltyRow& row, const Standing& theory, double push) {
    if (push <= theory.grip * row.law.friction) return;
    row.status = "slides";
    entries_.back().trial = {};
  }

  const Setup& scene_;
  const PenaltyStudy& study_;
  std::vector<Entry> entries_;
};

}  // namespace

std::string why_not_studied(const Setup& setup) {
  if (setup.run.analysis != Analysis::dynamic) return "is not dynamic; contact is studied in motion";
  if (!floor_of(setup.model)) return "has no floor that is a horizontal plane";
  const Vec3& g = setup.parameters.gravity;
  if (!(g.z() < 0) || g.head<2>().norm() > 0) return "has no gravity that points down; bodies would not rest";
  for (int b = 0; b < static_cast<int>(setup.model.bodies.size()); ++b)
    if (why_not_standing(setup.model, b).empty()) return "";
  return "has no body that stands freely on its floor";
}

PenaltyStudy study_penalty(const std::string& name, const std::string& title, const Setup& scene,
                           const PenaltySettings& settings,
                           const std::function<bool(int done, int of)>& go_on) {
  PenaltyStudy study{name, title, scene.parameters.contact, fixed_step(scene), groups_of(scene), {}, {}};
  study.alphas = alphas_for(study.groups, study.law.alpha);
  std::vector<Entry> entries = Lister(scene, study).all();
  std::vector<Entry*> runs;
  for (Entry& entry : entries)
    if (entry.trial) runs.push_back(&entry);
  std::stable_sort(runs.begin(), runs.end(), [&](const Entry* a, const Entry* b) {
    return urgency(study, a->row) < urgency(study, b->row);
  });
  study.of = static_cast<int>(runs.size());
  for_each_case(
      study.of, settings.jobs,
      [&](int k, int) {
        Entry& entry = *runs[static_cast<std::size_t>(k)];
        const ContactTrial trial = entry.trial();
        entry.row.computed = trial.value;
        entry.row.status = trial.status;
      },
      [&](int done) { return go_on(done, study.of); });
  for (Entry& entry : entries) {
    study.run += entry.trial && entry.row.status != "not run" ? 1 : 0;
    study.rows.push_back(std::move(entry.row));
  }
  return study;
}

}  // namespace topple::study
