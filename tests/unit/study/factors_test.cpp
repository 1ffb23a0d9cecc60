// What an ensemble varies: distributions, what a factor does to blocks and to scenes, what is refused.
#include "solver/study/overturn/factors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "solver/model/accelerogram.h"
#include "solver/study/overturn/planar_runs.h"
#include "solver/study/overturn/varied_run.h"
#include "study_cases.h"

namespace topple::study {
namespace {

io::Scene cabinet() {
  return io::load_scene("cabinet");
}

FactorPlan plan_of(const std::vector<std::string>& texts) {
  return plan_factors(texts, cabinet());
}

/// Sorted values of the first factor.
std::vector<double> drawn(const FactorPlan& plan, int count, std::uint64_t stream = 3) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(plan.draw(stream, static_cast<std::uint32_t>(i)).front());
  std::ranges::sort(values);
  return values;
}

// 1,024 points of the sequence are one in each of 1,024 intervals: sorted, they are the quantiles within
// 1/1024 of the probability.
TEST(Factors, draws_have_the_distributions_that_were_asked_for) {
  constexpr int k_draws = 1024;
  const auto within = [](const std::vector<double>& values, double low, double high, double share) {
    const auto inside = std::ranges::count_if(values, [&](double v) { return v >= low && v <= high; });
    EXPECT_NEAR(static_cast<double>(inside) / k_draws, share, 2. / k_draws + 1e-4);
  };
  const std::vector<double> uniform = drawn(plan_of({"amplitude=uniform:0.8..1.4"}), k_draws);
  EXPECT_GE(uniform.front(), 0.8);
  EXPECT_LE(uniform.back(), 1.4);
  within(uniform, 0.8, 1.1, 0.5);
  const std::vector<double> normal = drawn(plan_of({"friction=normal:10%"}), k_draws);
  EXPECT_GE(normal.front(), 0.7);  // cut at three standard deviations
  within(normal, 0.9, 1.1, 0.6827 / 0.9973);
  within(normal, 0.7, 1, 0.5);
  const std::vector<double> lognormal = drawn(plan_of({"size=lognormal:0.2"}), k_draws);
  within(lognormal, std::exp(-0.2), std::exp(0.2), 0.6827);
  within(lognormal, 0, 1, 0.5);
}

TEST(Factors, the_same_seed_draws_the_same_and_another_seed_others) {
  FactorPlan plan = plan_of({"amplitude=uniform:0.8..1.4", "mass=lognormal:0.3"});
  const std::vector<double> first = plan.draw(17, 5);
  EXPECT_EQ(first, plan.draw(17, 5));
  // as on any machine
  EXPECT_EQ(first.size(), 2u);
  EXPECT_NE(first, plan.draw(18, 5));
  EXPECT_NE(first, plan.draw(17, 6));
  plan.seed = 2;
  EXPECT_NE(first, plan.draw(17, 5));
}

TEST(Factors, amplitudes_are_scaled_together_or_each_alone) {
  std::vector<Shake> shakes(2);
  shakes[0].amplitude = 2, shakes[1].amplitude = 3;
  const io::Scene scene = io::load_scene("cabinet");
  FactorPlan both = plan_factors({"amplitude=uniform:0.5..2"}, scene);
  const double half[] = {0.5};
  std::vector<Shake> varied = shakes;
  vary(both, half, varied);
  EXPECT_EQ(varied[0].amplitude, 1);
  EXPECT_EQ(varied[1].amplitude, 1.5);
  both.factors[0].shake = 1;
  varied = shakes;
  vary(both, half, varied);
  EXPECT_EQ(varied[0].amplitude, 2);
  EXPECT_EQ(varied[1].amplitude, 1.5);
}

// A block and the scene that is read anew with the same factors are one: to rounding, as masses of members
// are fitted, and but for the contact width of the posts, which does not grow.
TEST(Factors, a_varied_block_is_the_block_of_the_varied_scene) {
  const io::Scene whole = cabinet();
  const io::Scene scene = io::parse_scene(whole.text, whole.name, overturn_settings(whole));
  const std::vector<planar::PlanarCase> own = planar_cases(scene.setup);
  ASSERT_EQ(own.size(), 1u);
  const FactorPlan plan = plan_of({"size=uniform:0.5..2", "mass=uniform:0.5..2", "friction=uniform:0.5..2"});
  const double values[] = {1.25, 1.5, 0.8};
  planar::PlanarCase fast = own.front();
  vary(plan, values, fast);
  const topple::Setup slow_setup = varied_setup(plan, values, scene);
  const planar::PlanarCase slow = planar_cases(slow_setup).front();
  for (const auto& [a, b] :
       {std::pair(fast.block.left, slow.block.left), std::pair(fast.block.right, slow.block.right),
        std::pair(fast.block.height, slow.block.height), std::pair(fast.block.mass, slow.block.mass),
        std::pair(fast.block.inertia, slow.block.inertia)})
    EXPECT_NEAR(a / b, 1, 0.01);
  EXPECT_NEAR(fast.block.kinetic_friction, slow.block.kinetic_friction, 1e-12);
  EXPECT_NEAR(fast.block.height, 1.25 * own.front().block.height, 1e-12);
}

// The rate that Housner's impact leaves, times the factor: the next swing rises with its square.
TEST(Factors, restitution_makes_no_energy) {
  const io::Scene whole = cabinet();
  const io::Scene scene = io::parse_scene(whole.text, whole.name, overturn_settings(whole));
  const FactorPlan plan = plan_of({"restitution=uniform:0.5..2"});
  planar::PlanarCase of = planar_cases(scene.setup).front();
  const double twice[] = {2};
  vary(plan, twice, of);
  const planar::Block& b = of.block;
  const double k2 = b.inertia_over_mass(), kept = (k2 + b.height * b.height - b.left * b.right) /
                                                  (k2 + b.height * b.height + b.left * b.left);
  EXPECT_NEAR(b.restitution * kept, 1, 1e-12);
}

TEST(Factors, records_are_files_in_the_order_of_their_names_and_folders_count_for_theirs) {
  const FactorPlan two = plan_of({"records=near-fault.csv,long-period-x.AT2"});
  EXPECT_EQ(two.records, (std::vector<std::string>{"near-fault.csv", "long-period-x.AT2"}));
  const std::vector<io::Scene> scenes = scenes_of(two, cabinet());
  ASSERT_EQ(scenes.size(), 2u);
  for (const io::Scene& scene : scenes) {
    EXPECT_EQ(scene.name, "cabinet");
    EXPECT_EQ(scene.setup.parameters.shakes.front().kind, Shake::Kind::record);
  }
  EXPECT_NE(scenes[0].setup.parameters.shakes.front().record->duration,
            scenes[1].setup.parameters.shakes.front().record->duration);
  EXPECT_EQ(with_files_of(scenes).files.size(), 2u);
}

TEST(Factors, what_makes_no_sense_is_refused_in_one_line) {
  const auto refused = [](const std::vector<std::string>& texts, const std::string& message,
                          const std::string& scene = "cabinet") {
    try {
      plan_factors(texts, io::load_scene(scene));
      ADD_FAILURE() << message;
    } catch (const io::InputError& error) {
      EXPECT_NE(std::string(error.what()).find("--vary " + message), std::string::npos) << error.what();
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  };
  refused({"width=normal:5%"},
          "width=normal:5%: \"width\" is not a factor; known: amplitude, phase, size, mass, friction, "
          "restitution, records");
  refused({"friction"}, "friction: expected FACTOR=DISTRIBUTION");
  refused({"friction=gamma:2"},
          "friction=gamma:2: \"gamma:2\" is not uniform:FROM..TO, normal:SD or lognormal:SD");
  refused({"friction=uniform:2..1"}, "friction=uniform:2..1: a factor is within 0..100, FROM less than TO");
  refused({"friction=uniform:1"}, "friction=uniform:1: \"1\" is not FROM..TO");
  refused({"friction=normal:0"}, "friction=normal:0: \"0\" is not a standard deviation above 0 up to 0.33");
  refused({"size=uniform:0..1"}, "size=uniform:0..1: the factor begins above 0");
  refused({"friction.1=normal:5%"}, "friction.1=normal:5%: \"friction\" is not of a shake");
  refused({"amplitude.9=normal:5%"}, "amplitude.9=normal:5%: cabinet has no shake \"9\"");
  refused({"mass=normal:5%", "mass=normal:6%"}, "mass=normal:6%: there is another one");
  refused({"phase=uniform:0..1"}, "phase=uniform:0..1: takes no distribution");
  refused({"phase"}, "phase: no shake is a sine", "near-fault");
  refused({"records=no-such.AT2"}, "records: no-such.AT2: ");
  refused({"records=near-fault.csv,near-fault.csv"},
          "records=near-fault.csv,near-fault.csv: near-fault.csv: is named twice");
  refused({"amplitude=normal:5%"}, "amplitude=normal:5%: the floor does not shake", "free-rocking");
}

}  // namespace
}  // namespace topple::study
