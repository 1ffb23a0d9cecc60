// The stability map: fates of runs, limits of theory against formulas and integration by hand, rows that do
// not depend on how they came.
#include "solver/study/stability/stability.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "solver/study/stability/stability_chart.h"
#include "solver/study/stability/stability_limits.h"
#include "study_cases.h"

namespace topple::study {
namespace {

using nlohmann::ordered_json;
using End = StabilityRun::End;

const std::string k_failures = TOPPLE_SOURCE_DIR "/assets/scenes/failures/";
StabilityRun fine() {
  StabilityRun run;
  run.fell = {true, false};
  run.penetration = 0.4;
  return run;
}

Agreement reference() {
  return agree({fine(), fine()});
}

TEST(Stability, a_run_is_judged_by_the_worst_that_befell_it) {
  EXPECT_EQ(judge(fine(), reference()), Fate::stable);
  const std::pair<End, Fate> ends[] = {{End::not_set_up, Fate::failed}, {End::not_settled, Fate::failed},
                                       {End::refused, Fate::refused},   {End::no_solution, Fate::no_solution},
                                       {End::growth, Fate::grows},      {End::passed_through, Fate::tunnels}};
  for (const auto& [end, fate] : ends) {
    StabilityRun run = fine();
    run.end = end;
    EXPECT_EQ(judge(run, reference()), fate);
  }
  // one after the other, each worse than the one before
  StabilityRun run = fine();
  run.numerical = 0.11;
  EXPECT_EQ(judge(run, reference()), Fate::loses);
  run.fell = {false, false};
  EXPECT_EQ(judge(run, reference()), Fate::wrong);
  run.penetration = 1.01;
  EXPECT_EQ(judge(run, reference()), Fate::tunnels);
  run.unexplained = 0.011;
  EXPECT_EQ(judge(run, reference()), Fate::grows);
}

TEST(Stability, energy_counts_from_its_bounds_on_and_by_its_sign) {
  const auto fate = [](double unexplained, double numerical) {
    StabilityRun run = fine();
    run.unexplained = unexplained;
    run.numerical = numerical;
    return judge(run, reference());
  };
  EXPECT_EQ(fate(0.99 * k_stable_balance, 0.99 * k_stable_damping), Fate::stable);
  EXPECT_EQ(fate(1.01 * k_stable_balance, 0), Fate::grows);
  EXPECT_EQ(fate(-1.01 * k_stable_balance, 0), Fate::loses);
  EXPECT_EQ(fate(0, 1.01 * k_stable_damping), Fate::loses);
  EXPECT_EQ(fate(0, -1.01 * k_stable_balance), Fate::grows);
}

TEST(Stability, a_soft_contact_that_any_run_sinks_through_is_no_tunnel) {
  StabilityRun run = fine();
  run.penetration = 2.1;
  StabilityRun soft = fine();
  soft.penetration = 2;
  EXPECT_EQ(judge(run, agree({soft})), Fate::stable);
  run.penetration = 2.6;
  EXPECT_EQ(judge(run, agree({soft})), Fate::tunnels);
}

TEST(Stability, without_a_verdict_to_compare_with_none_is_called_wrong) {
  StabilityRun other = fine();
  other.fell = {true, true};
  StabilityRun failed = fine();
  failed.end = End::no_solution;
  StabilityRun leaking = fine();
  leaking.unexplained = -0.02;
  for (const StabilityRun& odd : {other, failed, leaking}) {
    const Agreement open = agree({fine(), odd, fine()});
    EXPECT_FALSE(open.decided);
    EXPECT_NE(open.why_not, "");
    EXPECT_EQ(judge(fine(), open), Fate::undecided);
    EXPECT_EQ(judge(other, open), Fate::undecided);
  }
  EXPECT_TRUE(reference().decided);
  EXPECT_EQ(judge(other, reference()), Fate::wrong);
  EXPECT_EQ(judge(fine(), Agreement{}), Fate::undecided);
}

/// Energy after a linear contact of stiffness k over that before, for a mass that comes in with v and whose
/// distance is `part` of v h when a step begins: trapezoidal rule, the force at the new state.
double energy_kept(double k_h2, double part, bool closing_only) {
  // m = v = h = 1
  double x = part, v = -1, force = 0;
  for (int n = 0; n < 10000; ++n) {
    // x1 = x + (v + v1)/2, v1 = v + (f + f1)/2, f1 = k max(0, -x1)
    double f1 = 0, v1 = v + force / 2, x1 = x + (v + v1) / 2;
    if (x1 < 0) {  // linear in v1
      v1 = (v + force / 2 - k_h2 / 2 * (x + v / 2)) / (1 + k_h2 / 4);
      x1 = x + (v + v1) / 2;
      f1 = -k_h2 * x1;
    }
    const bool touched = force > 0;
    x = x1;
    v = v1;
    force = f1;
    if (closing_only && force > 0) return v * v + k_h2 * x * x;
    if (touched && force == 0) return v * v;
  }
  return 0;
}

TEST(Stability, an_impact_errs_by_at_most_a_quarter_of_the_squared_product_of_frequency_and_step) {
  constexpr double w_h = 0.2;
  double worst = 0;
  for (int k = 1; k < 1000; ++k)
    worst = std::max(worst, std::abs(energy_kept(w_h * w_h, k / 1000., true) - 1));
  const double period = 2 * std::numbers::pi / w_h;
  EXPECT_NEAR(worst / impact_error(1, period), 1, 0.02);  // the force slows it within the step: of order w h
  EXPECT_NEAR(impact_error(step_of_impact_error(0.01, period), period), 0.01, 1e-15);
  EXPECT_NEAR(step_of_impact_error(1, period), 2 / w_h, 1e-12);
}

TEST(Stability, newmark_damps_a_circle_at_the_rate_of_theory) {
  // a point on a circle, held by the exact radial acceleration: v1 = v + h ((1-g) a0 + g a1)
  constexpr double w = 3, h = 4e-3, gamma = 5. / 6, duration = 10;
  const double share = 1 - std::exp(-2 * (gamma - 0.5) * h * w * w * duration);
  EXPECT_NEAR(step_of_damping(share, gamma, w * w * duration), h, 1e-12);
  // published with the method: 22 % of the energy of a tumbling cabinet, which turns about its own axis too
  EXPECT_NEAR(share, 0.22, 0.01);
}

StabilityPlan small_plan() {
  StabilityPlan plan =
      plan_stability(io::load_scene(k_failures + "long-bounce.toml", {"run.time_step=0.1 ms"}),
                     "run.time_step=0.2 ms..8 ms:3", "contact.alpha=2000 kgf..20000 kgf:2");
  plan.horizon = 0.1;
  return plan;
}

TEST(Stability, limits_are_those_of_formulas_worked_out_by_hand) {
  constexpr double g = k_standard_gravity, L = 0.03, b = 0.19, cg = 1.05;
  // thrown down at 3 m/s from 50 mm onto nine contacts of alpha/L
  const Demand thrown = demand(small_plan().scene.setup, 0.1);
  const double v2 = 9 + 2 * g * 0.05;
  EXPECT_NEAR(thrown.bounce, 2 * std::numbers::pi * std::sqrt(40 / (9 * 80000 * g / L)), 1e-9);
  EXPECT_NEAR(thrown.landing, L / std::sqrt(v2), 1e-9);
  EXPECT_NEAR(thrown.alpha, 40 * v2 / 2 * 2 / (9 * L), 1e-6);
  // stands, and falls over: w^2 = 2 m g (R - b)/I of the edge; the top, 1.79 m up, lands on nine contacts
  const io::Scene standing = io::load_scene(k_failures + "printed-law.toml");
  const Demand d = demand(standing.setup, 3);
  const double R = std::hypot(b, cg), I = standing.setup.model.bodies[0].inertia(1, 1) + 40 * R * R,
               E = 40 * g * (R - b);
  EXPECT_NEAR(d.landing, L / (1.79 * std::sqrt(2 * E / I)), 1e-6);
  EXPECT_NEAR(d.alpha, E * 2 / (9 * L), 1e-3);
  // 4 p (1 - cos(phi/2)) is the integral of w over the angle of the fall
  const double p = std::sqrt(40 * g * R / I), phi = std::numbers::pi / 2 - std::atan(b / cg);
  double turning = 0;
  for (int k = 0; k < 10000; ++k) {
    const double at = (k + 0.5) * phi / 10000;
    turning += p * std::sqrt(2 * (1 - std::cos(at))) * phi / 10000;
  }
  EXPECT_NEAR(d.turning, turning, 1e-6 * turning);
  for (const auto kind : {ContactLawKind::paper, ContactLawKind::printed})
    EXPECT_NEAR(step_of_chatter({.kind = kind}, g), 2 * 0.01 / (0.6 * g), 1e-15);
  EXPECT_EQ(step_of_chatter({.kind = ContactLawKind::coulomb}, g), 0);
  EXPECT_EQ(step_of_chatter({.kind = ContactLawKind::paper, .friction = 0}, g), 0);
}

TEST(Stability, a_scene_that_names_a_tolerance_is_stepped_as_asked) {
  const StabilityPlan plan = plan_stability(io::load_scene("classroom"), "run.time_step=1 ms..4 ms:2", "");
  const topple::Setup setup = stepped_by(plan, plan.methods[1], {"run.time_step=2 ms"});
  EXPECT_FALSE(setup.parameters.adaptive);
  EXPECT_EQ(setup.parameters.time_step, 2e-3);
}

TEST(Stability, central_differences_are_refused_right_of_their_line) {
  StabilityPlan plan = small_plan();
  const std::vector<StabilityLimit> limits = stability_limits(plan);
  const StabilityLimit& line = limits.front();
  ASSERT_EQ(line.name, "explicit");
  for (const double off : {0.99, 1.01}) {
    const topple::Setup setup =
        stepped_by(plan, plan.methods[0],
                   {plan.y.change(0), plan.x.change_to(off * line.x.front()), "run.duration=1e-3"});
    topple::Run run(setup);
    EXPECT_EQ(run.advance().ok(), off < 1) << off;
  }
  // lines run along the other axis, across its cells
  for (const StabilityLimit& limit : limits) {
    if (limit.name == "capacity") continue;
    EXPECT_NEAR(limit.y.front() / plan.y.edges().front(), 1, 1e-6) << limit.name;
    EXPECT_NEAR(limit.y.back() / plan.y.edges().back(), 1, 1e-6) << limit.name;
  }
  // softer contacts bounce more slowly, as the root
  const auto bounce = std::ranges::find(limits, "bounce", &StabilityLimit::name);
  EXPECT_NEAR(bounce->x.front() / bounce->x.back(), std::sqrt(bounce->y.back() / bounce->y.front()), 1e-6);
}

std::vector<std::string> run_all(const StabilityPlan& plan) {
  std::vector<std::string> rows(static_cast<std::size_t>(plan.cases()));
  for (const int k : case_order(plan)) rows[static_cast<std::size_t>(k)] = run_case(plan, k, never);
  return rows;
}

TEST(Stability, steps_beyond_the_bounce_make_energy_and_short_ones_do_not) {
  const StabilityPlan plan = small_plan();
  const StabilityMap map = gather(plan, run_all(plan));
  EXPECT_EQ(map.run, map.of);
  for (const Agreement& r : map.references) EXPECT_TRUE(r.decided) << r.why_not;
  for (std::size_t m = 0; m < plan.methods.size(); ++m)
    for (int p = 0; p < plan.points(); ++p) {
      const Fate fate = map.cells[m][static_cast<std::size_t>(p)].fate;
      if (plan.methods[m].name == "central-difference") {
        EXPECT_EQ(fate, Fate::refused);
      } else if (p == 5) {  // 8 ms, 20000 kgf: longer than a bounce
        EXPECT_EQ(fate, Fate::grows) << m;
      } else if (p == 3 && plan.methods[m].name == "newmark-5/6") {  // takes what the posts ring with
        EXPECT_EQ(fate, Fate::loses);
      } else if (p % 3 == 0) {
        EXPECT_EQ(fate, Fate::stable) << m << " " << p;
      }
    }
  const ordered_json rows = rows_as_json(plan, map), json = map_as_json(plan, map);
  EXPECT_EQ(rows.size(), plan.methods.size() * 6);
  EXPECT_EQ(rows[0]["fate"], "refused");
  EXPECT_NE(rows[0]["status"].get<std::string>().find("is stable up to a time_step of"), std::string::npos);
  EXPECT_EQ(json["methods"][0]["counts"]["refused"], 6);
  const std::string chart = stability_chart(plan, map, stability_limits(plan), "here", ChartFormat::svg);
  for (const char* words :
       {"Where time integration fails in long-bounce", "\"here, ", "Central differences", "0 of 6 stable"})
    EXPECT_NE(chart.find(words), std::string::npos) << words;
}

TEST(Stability, what_was_not_run_is_open_in_every_result) {
  const StabilityPlan plan = small_plan();
  std::vector<std::string> rows(static_cast<std::size_t>(plan.cases()));
  const std::size_t last = rows.size() - 1;
  rows[last] = run_case(plan, static_cast<int>(last), never);
  const StabilityMap map = gather(plan, rows);
  EXPECT_EQ(map.run, 1);
  EXPECT_EQ(map.cells.back().front().fate, Fate::not_computed);
  EXPECT_TRUE(rows_as_json(plan, map)[0]["cpu_s"].is_null());
  EXPECT_EQ(rows_as_json(plan, map)[0]["status"], "not run");
  EXPECT_EQ(rows_as_json(plan, map)[0]["reference"], "not all reference runs were done");
}

TEST(Stability, a_run_ends_where_all_that_falls_has_fallen) {
  const auto horizon = [](const std::string& scene) {
    return find_horizon(io::load_scene(scene).setup, never);
  };
  const io::Scene a = io::load_scene("paper-a");
  topple::Run run(a.setup);
  while (!run.over()) run.advance();
  EXPECT_EQ(horizon("paper-a"), *run.outcome().bodies()[1].beyond_since + k_after_fall);
  EXPECT_EQ(horizon(k_failures + "soft-contact.toml"), 1);   // no longer than the scene
  EXPECT_EQ(horizon(k_failures + "fast-impact.toml"), 0.5);  // a run that fails tells nothing
}

TEST(Stability, plans_that_cannot_be_are_refused_in_one_line) {
  const auto refused_scene = [](const io::Scene& scene, const char* x, const char* y,
                                const std::string& part) {
    try {
      plan_stability(scene, x, y);
      ADD_FAILURE() << scene.name;
    } catch (const io::InputError& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  };
  const auto refused = [&](const std::string& scene, const char* x, const char* y, const std::string& part) {
    refused_scene(io::load_scene(scene), x, y, part);
  };
  refused("portal-pushover", "", "", "study stability: portal-pushover is not dynamic");
  refused("tumble", "", "", "--y KEY=FROM..TO:N is required: tumble has no floor");
  refused(k_failures + "newmark-rotation.toml", "run.gamma=0.5..0.9:3", "run.time_step=1e-3..1e-2:2",
          "--x run.gamma: is of one method");
  refused_scene(
      io::parse_scene("topple = 1\n[floor]\n[[block]]\nname = \"safe\"\nsize = [1, 1, 1]\nmass = 9\n",
                      "s.toml"),
      "", "", "study stability: s cannot be stepped by all methods: safe is a block");
  refused("paper-a", "contact.alpha=5 kgf..50 kgf:2", "", "--y contact.alpha: is the key of the x axis");
}

}  // namespace
}  // namespace topple::study
