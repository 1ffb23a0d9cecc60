// Stated errors against those that runs at much finer steps show.
#include "solver/study/common/refinement.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "solver/io/scene/scene.h"

namespace topple::study {
namespace {

Outcome outcome(const Setup& setup) {
  Run run(setup);
  while (run.status().ok() && !run.over()) run.advance();
  EXPECT_TRUE(run.status().ok());
  return run.outcome();
}

/// The true error over the stated one may reach this. The statement takes the errors to go as the first power
/// of the step already; where two of them of opposite signs nearly meet at one of the steps it is too small
/// by chance. The greatest seen over these scenes and steps is 1.7; a statement that left out
/// k_error_of_difference or the floors fails.
constexpr double k_slack = 2;

/// With steps and their parts `finer` times shorter.
Setup exactly(Setup setup, double finer) {
  setup.parameters.time_step /= finer;
  setup.parameters.substep_refinement *= finer;
  setup.parameters.tolerance /= finer * finer;
  return setup;
}

/// Of the stress of a body against steps `finer` times shorter.
void expect_stated_stress(const io::Scene& scene, std::size_t body, double finer) {
  const Outcome run = outcome(scene.setup), truth = outcome(exactly(scene.setup, finer));
  const BodyError stated = errors(scene.setup, run, outcome(compared(scene.setup)))[body];
  ASSERT_TRUE(stated.peak_stress_error);
  EXPECT_LE(std::abs(run.bodies()[body].peak_stress - truth.bodies()[body].peak_stress),
            k_slack * *stated.peak_stress_error);
}

/// Stated errors of a scene against a run at steps `finer` times shorter.
void expect_stated(const io::Scene& scene, double finer) {
  const Setup& setup = scene.setup;
  const Outcome run = outcome(setup), truth = outcome(exactly(setup, finer));
  const std::vector<BodyError> stated = errors(setup, run, outcome(compared(setup)));
  ASSERT_EQ(stated.size(), static_cast<std::size_t>(setup.model.furniture_total()));
  for (std::size_t b = 0; b < stated.size(); ++b) {
    const BodyOutcome &found = run.bodies()[b], &exact = truth.bodies()[b];
    SCOPED_TRACE(scene.name + ", " + setup.model.bodies[b].name);
    ASSERT_TRUE(stated[b].same_course());
    EXPECT_EQ(found.beyond_since.has_value(), exact.beyond_since.has_value());
    if (found.beyond_since) {
      EXPECT_LE(std::abs(*found.beyond_since - *exact.beyond_since), k_slack * *stated[b].overturn_error);
    }
    EXPECT_LE(std::abs(found.peak_tilt - exact.peak_tilt),
              k_slack * stated[b].peak_tilt_error.value_or(k_least_tilt_error));  // let go from there
    EXPECT_LE(std::abs(found.peak_slide - exact.peak_slide), k_slack * *stated[b].peak_slide_error);
  }
}

TEST(Refinement, states_no_error_of_the_tilt_from_which_a_body_was_let_go) {
  const io::Scene scene = io::load_scene("free-rocking", {"run.duration=0.5"});
  const std::vector<BodyError> stated =
      errors(scene.setup, outcome(scene.setup), outcome(compared(scene.setup)));
  EXPECT_FALSE(stated[0].peak_tilt_error);
  EXPECT_TRUE(stated[0].peak_slide_error);
}

TEST(Refinement, halves_a_fixed_step_and_tightens_an_adaptive_one) {
  const io::Scene fixed = io::load_scene("paper-a");
  EXPECT_DOUBLE_EQ(refined(fixed.setup).parameters.time_step, fixed.setup.parameters.time_step / 2);
  EXPECT_DOUBLE_EQ(refined(fixed.setup).parameters.substep_refinement, 2);
  const io::Scene adaptive = io::load_scene("paper-a", {"run.time_step=auto"});
  EXPECT_DOUBLE_EQ(refined(adaptive.setup).parameters.tolerance, adaptive.setup.parameters.tolerance / 10);
}

TEST(Refinement, the_stated_error_holds_the_true_one_of_fixed_steps) {
  for (const char* step : {"run.time_step=4 ms", "run.time_step=2 ms", "run.time_step=1 ms"}) {
    SCOPED_TRACE(step);
    expect_stated(io::load_scene("paper-a", {step, "run.duration=3 s"}), 16);
    expect_stated(io::load_scene("near-fault", {step, "run.duration=3 s"}), 16);
    expect_stated(io::load_scene("free-rocking", {step, "run.duration=1 s"}), 16);
  }
}

TEST(Refinement, the_stated_error_holds_the_true_one_of_frames) {
  expect_stated(io::load_scene("paper-a", {"run.time_step=2 ms", "run.duration=2.5 s",
                                           "cabinet.free.model=frame", "cabinet.walled.model=frame"}),
                8);
}

TEST(Refinement, the_stated_error_holds_the_true_one_of_adaptive_steps) {
  for (const char* tolerance : {"run.tolerance=1e-2", "run.tolerance=1e-3"}) {
    SCOPED_TRACE(tolerance);
    expect_stated(io::load_scene("near-fault", {"run.time_step=auto", tolerance, "run.duration=5 s"}), 16);
    expect_stated(io::load_scene("paper-a", {"run.time_step=auto", tolerance, "run.duration=3 s"}), 16);
  }
}

TEST(Refinement, the_stated_error_holds_the_true_one_of_the_stress_of_what_stands) {
  for (const char* alpha : {"contact.alpha=200 kgf", "contact.alpha=1000 kgf", "contact.alpha=5000 kgf"})
    for (const char* step : {"run.time_step=2 ms", "run.time_step=1 ms"}) {
      SCOPED_TRACE(std::string(alpha) + ", " + step);
      // the one before the wall knocks against it
      const char* const model = "cabinet.walled.model=elastic";  // blows on a frame take shorter steps
      expect_stated_stress(io::load_scene("paper-a", {step, alpha, model, "run.duration=4 s"}), 1, 16);
    }
}

// 28.21 MPa at a tolerance of 1e-3, 29.34 at 1e-6: at 1e-4 with half the parts of a step 28.08.
TEST(Refinement, the_stated_error_holds_the_true_one_of_the_stress_of_adaptive_steps) {
  expect_stated_stress(io::load_scene("cabinet", {"run.duration=4.4", "cabinet.cabinet.model=elastic"}), 0,
                       32);
}

// It slides and rattles: 25 impacts, 20 when refined, other tolerances 17 to 57.
TEST(Refinement, the_stated_error_holds_the_true_one_of_what_anchors_bear) {
  const io::Scene scene = io::load_scene("anchored", {"run.duration=3"});
  const Outcome run = outcome(scene.setup), truth = outcome(exactly(scene.setup, 4));
  const auto stated = anchor_errors(scene.setup, run, outcome(compared(scene.setup)));
  ASSERT_EQ(stated.size(), 2u);
  for (std::size_t k = 0; k < stated.size(); ++k) {
    ASSERT_TRUE(stated[k]);
    EXPECT_GT(run.anchors()[k].peak_force, 0);
    EXPECT_LE(std::abs(run.anchors()[k].peak_force - truth.anchors()[k].peak_force), k_slack * *stated[k]);
  }
  // one breaks in one of the runs alone; then all do in both, and what they held falls
  topple::Setup weak = scene.setup;
  weak.model.anchors[0].strength = 1;
  EXPECT_FALSE(anchor_errors(scene.setup, run, outcome(weak))[0]);
  for (Anchor& anchor : weak.model.anchors) anchor.strength = 1;
  weak.run.duration = 10;
  const Outcome falls = outcome(weak);
  ASSERT_TRUE(falls.bodies()[0].beyond_since);
  EXPECT_FALSE(anchor_errors(weak, falls, falls)[0]);
  topple::Setup one = scene.setup;
  one.parameters.anchors = {false, true};
  const auto of_one = anchor_errors(one, outcome(one), outcome(one));
  EXPECT_FALSE(of_one[0]);
  EXPECT_TRUE(of_one[1]);
  const topple::Setup rigid =
      io::load_scene("anchored", {"run.duration=3", "cabinet.free.model=rigid"}).setup;
  EXPECT_FALSE(anchor_errors(rigid, outcome(rigid), outcome(compared(rigid)))[0]);
}

TEST(Refinement, what_stands_on_one_course_of_many_is_seen) {
  const topple::Setup setup = io::load_scene("desk", {"shake.1.amplitude=460 gal"}).setup;
  const BodyError stated = errors(setup, outcome(setup), outcome(compared(setup)))[0];
  EXPECT_TRUE(stated.same_course() && stated.parted());
  EXPECT_TRUE(stated.peak_slide_error);
}

// A landing is one blow, which the step resolves or not: 1871 MPa at 2 ms, 1843 at half of that, 2897 at
// 1/64 of it.
TEST(Refinement, no_error_is_stated_of_the_stress_of_a_landing) {
  const topple::Setup setup =
      io::load_scene("paper-a", {"run.duration=4 s", "run.time_step=2 ms", "contact.alpha=20000 kgf"}).setup;
  const std::vector<BodyError> stated = errors(setup, outcome(setup), outcome(compared(setup)));
  EXPECT_TRUE(stated[0].overturned && stated[0].same_verdict());
  EXPECT_TRUE(stated[0].overturn_error && !stated[0].peak_stress_error);
}

// 15.2 MPa at 1 ms, 15.4 at half of that, 18.8 at 1/32 of it; the one before the wall 147, 149 and, at 1/16,
// 161.
TEST(Refinement, no_error_is_stated_of_the_stress_of_a_frame_whose_landings_the_step_blurs) {
  const auto stated = [](const char* name, const char* alpha, const char* step, std::size_t body) {
    const topple::Setup setup = io::load_scene(name, {alpha, step, "run.duration=2 s"}).setup;
    return errors(setup, outcome(setup), outcome(compared(setup)))[body].peak_stress_error.has_value();
  };
  EXPECT_FALSE(stated("free-rocking", "contact.alpha=20000 kgf", "run.time_step=1 ms", 0));
  EXPECT_TRUE(stated("free-rocking", "contact.alpha=20000 kgf", "run.time_step=0.25 ms", 0));
  EXPECT_TRUE(stated("free-rocking", "contact.alpha=1250 kgf", "run.time_step=1 ms", 0));
  EXPECT_FALSE(stated("paper-a", "contact.alpha=8000 kgf", "run.time_step=1 ms", 1));
}

// It falls at 5.972 s after four impacts, at a tenth of the tolerance at 6.041 s after five, and with steps
// between not at all.
TEST(Refinement, another_number_of_impacts_before_the_fall_leaves_the_verdict_open) {
  const topple::Setup setup = io::parse_scene(
                                  "topple = 1\nfloor = {}\nrun = { duration = 8, want = [\"motion\"] }\n"
                                  "furniture = [{ kind = \"bookshelf\", name = \"shelf\", at = [0, 0] },\n"
                                  "{ kind = \"chest\", name = \"chest\", at = [0, 2.5] }]\n"
                                  "shake = [{ type = \"sine\", frequency = 1, amplitude = 1.6, taper = 1 }]",
                                  "shelf.toml")
                                  .setup;
  const std::vector<BodyError> stated = errors(setup, outcome(setup), outcome(compared(setup)));
  EXPECT_TRUE(stated[0].overturned && stated[0].overturned_refined);
  EXPECT_NE(stated[0].impacts, stated[0].impacts_refined);
  EXPECT_FALSE(stated[0].same_course() || stated[0].overturn_error);
}

// A pulse a little above the least that overturns: the time of the fall goes with the logarithm of what is
// above it. Were the steps' error that of 1.5 parts of 4 at these and of as much again at finer ones, 1 part
// would be left.
TEST(Refinement, what_nearly_balances_may_fall_later_by_more_than_twice_the_difference) {
  const auto pulse = [](double amplitude) {
    return io::parse_scene(
               fmt::format("topple = 1\nfloor = {{}}\nrun = {{ duration = 6, want = [\"motion\"] }}\n"
                           "block = [{{ name = \"box\", size = [0.4, 0.5, 1.8], mass = 50 }}]\n"
                           "shake = [{{ type = \"pulse\", duration = 0.5, amplitude = {:.17g} }}]",
                           amplitude),
               "box.toml")
        .setup;
  };
  double stays = 1, falls = 10;
  while (falls - stays > 1e-13 * falls) {
    const double middle = (stays + falls) / 2;
    (outcome(pulse(middle)).bodies()[0].beyond_since ? falls : stays) = middle;
  }
  const topple::Setup setup = pulse(falls);
  const auto above = [&](double parts) { return outcome(pulse(falls * (1 + 1e-6 * parts))); };
  const auto time = [&](double parts) { return *above(parts).bodies()[0].beyond_since; };
  const auto stated = [&](double parts, double finer) {
    return *errors(setup, above(parts), above(finer))[0].overturn_error;
  };
  // times are right to 1e-4 s, and the logarithm holds near the balance
  EXPECT_NEAR(stated(4, 2.5), time(1) - time(4), 0.01 * (time(1) - time(4)));
  EXPECT_GT(stated(4, 2.5), 2.8 * (time(2.5) - time(4)));
  EXPECT_DOUBLE_EQ(stated(1, 2.5), 2 * (time(1) - time(2.5)));
  EXPECT_GT(stated(4, 1), 3 * (time(1) - time(4)));  // none would be left
}

TEST(Refinement, where_the_verdicts_part_there_is_no_number) {
  const io::Scene weak = io::load_scene("paper-a", {"shake.1.amplitude=100 gal", "run.duration=3 s"});
  const io::Scene strong = io::load_scene("paper-a", {"run.duration=3 s"});
  const std::vector<BodyError> parted = errors(weak.setup, outcome(weak.setup), outcome(strong.setup));
  for (const BodyError& e : parted) {
    EXPECT_FALSE(e.same_verdict());
    EXPECT_TRUE(e.overturned_refined && e.overturn_refined && !e.overturn_time);
    EXPECT_FALSE(e.overturn_error || e.peak_tilt_error || e.peak_slide_error);
  }
}

}  // namespace
}  // namespace topple::study
