// Where methods fail (assets/scenes/failures): each scene fails as it says, the program says so, and on the
// other side of the limit nothing is wrong.
#include <set>

#include "solver/io/scene/scene.h"
#include "unit/app/program.h"

namespace topple::app {
namespace {

struct Failure {
  const char* scene;
  const char* said;       // by the error or a warning
  const char* otherwise;  // KEY=VALUE with which it works
};

constexpr Failure k_failures[] = {
    {"explicit-step", "is stable up to a time_step of", "run.time_step=4e-5"},
    {"fast-impact", "a contact is not resolved", "run.time_step=2e-5"},
    {"fast-tumbling", "of the energy is unaccounted for", "run.time_step=1e-3"},
    {"friction-chatter", "friction changes sides", "run.time_step=2e-3"},
    {"long-bounce", "a contact is not resolved", "run.time_step=5e-5"},
    {"newmark-rotation", "the time integration took", "run.gamma=0.5"},
    {"printed-law", "holds bodies back where they part", "contact.law=paper"},
    {"soft-contact", "contact widths", "contact.alpha=500 kgf"},
    {"stiff-pendulum", "energy balance error", "run.time_step=5e-3"},
};

// What fails elsewhere and here does not.
constexpr const char* k_avoided[] = {"double-hinge", "joint-hinges", "live-jump", "parallel-members",
                                     "unloading-hinge"};

const std::string k_folder = TOPPLE_SOURCE_DIR "/assets/scenes/failures";

using FailuresTest = ProgramTest;

TEST_F(FailuresTest, are_reported_and_are_gone_on_the_other_side_of_their_limit) {
  for (const Failure& failure : k_failures) {
    SCOPED_TRACE(failure.scene);
    const std::string file = k_folder + "/" + failure.scene + ".toml";
    const Ended bad = topple({"run", file, "--quiet"});
    EXPECT_NE(bad.err.find(failure.said), std::string::npos) << bad.err;
    std::vector<std::string> good{"run", file, "--quiet", "--json", "-", "--set", failure.otherwise};
    if (std::string(failure.scene) == "newmark-rotation") good.insert(good.end(), {"--set", "run.beta=0.25"});
    const Ended ended = topple(good);
    EXPECT_EQ(ended.code, 0) << ended.err;
    const auto summary = json_of(ended.out);
    for (const auto& warning : summary.at("warnings")) {  // of steel that is given no yield, of soft contacts
      const auto words = warning.get<std::string>();
      EXPECT_TRUE(words.starts_with("the stress in body ") || words.starts_with("contact.alpha = "))
          << ended.err;
    }
  }
}

// A step of 0.1 s leads through the whole blow: contacts are closed at neither of its ends, and took energy.
// Taken as a whole it leaves 220 % unexplained; the tenth is what would be refused.
TEST_F(FailuresTest, a_blow_within_one_step_is_taken_in_parts) {
  const Ended ended = topple({"run", k_folder + "/fast-impact.toml", "--quiet", "--json", "-", "--set",
                              "contact.alpha=20000 kgf", "--set", "run.time_step=100 ms"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_LT(json_of(ended.out)["energy"]["balance_error"], 0.1);
}

// Which of the steps part is rounding: here all three do. At 615 gal the cabinet falls after 2 s, whatever
// the step.
TEST_F(FailuresTest, a_verdict_that_flips_with_the_step_is_seen_by_an_estimate) {
  const auto open_verdicts = [](const char* amplitude) {
    int open = 0;
    for (const char* step : {"2 ms", "1 ms", "0.5 ms"}) {
      const Ended ended = topple({"run", k_folder + "/flipping-verdict.toml", "--quiet", "--estimate",
                                  "--set", std::string("run.time_step=") + step, "--set",
                                  std::string("shake.1.amplitude=") + amplitude});
      EXPECT_EQ(ended.code, 0) << ended.err;
      open += ended.err.find("a finer run takes another course: cabinet") != std::string::npos ? 1 : 0;
    }
    return open;
  };
  EXPECT_GT(open_verdicts("725 gal"), 0);
  EXPECT_EQ(open_verdicts("615 gal"), 0);
}

TEST_F(FailuresTest, that_the_method_avoids_leave_nothing_to_warn_of) {
  for (const char* scene : k_avoided) {
    SCOPED_TRACE(scene);
    const Ended ended = topple({"run", k_folder + "/" + scene + ".toml", "--quiet", "--json", "-"});
    EXPECT_EQ(ended.code, 0) << ended.err;
    const auto summary = json_of(ended.out);
    for (const auto& warning : summary["warnings"])
      EXPECT_TRUE(warning.get<std::string>().starts_with("contact.alpha = ")) << ended.err;
    const auto& body = summary["bodies"][0];
    if (std::string(scene) == "joint-hinges") {  // plastic theory: one hinge at each foot and joint, 6 Mp/h
      EXPECT_EQ(body["hinges"], 6);
      EXPECT_NEAR(summary["peak_load_factor"].get<double>(), 1, 2e-5);
    }
    // A tray that fell by 2 mm onto one point of each rail would rock by some tenths of a degree.
    if (std::string(scene) == "parallel-members") {
      EXPECT_LT(body["peak_tilt_deg"], 1e-3);
    }
    // Three times there and back: work that flow took, not a spring that gives it back.
    if (std::string(scene) == "unloading-hinge") {
      EXPECT_GT(summary["energy"]["plastic_J"], 5);
      EXPECT_LT(summary["energy"]["balance_error"], 1e-6);
    }
  }
}

// 25 times alpha at once: what the springs hold grows by 24 times and throws the cabinet 30 mm up (method: a
// live change). Passed over two bounces it rises by no more than what it had sunk, and stays on its contacts.
TEST_F(FailuresTest, a_live_change_of_alpha_does_not_throw_a_cabinet_up) {
  const io::Scene scene = io::load_scene(k_folder + "/live-jump.toml", {});
  topple::Run run(scene.setup);
  const double alpha = scene.setup.parameters.contact.alpha, start = run.state().position[0].z();
  const double sunk = 0.06 * 40 / 450;  // m, 40 kg on nine contacts of 50 kgf and L = 60 mm
  while (run.time() < 0.5) ASSERT_TRUE(run.advance().ok());
  run.edit({.key = Edit::Key::alpha, .value = {25 * alpha, 0, 0}});
  double highest = 0;
  while (!run.over()) {
    ASSERT_TRUE(run.advance().ok());
    EXPECT_FALSE(run.contacts().empty()) << run.time();
    highest = std::max(highest, run.state().position[0].z() - start);
  }
  EXPECT_GT(highest, 0.9 * sunk * (1 - 1. / 25));
  EXPECT_LT(highest, 1.1 * sunk);
  EXPECT_LT(run.state().energy.balance_error(), 1e-3);
}

TEST_F(FailuresTest, say_in_their_first_line_what_fails_and_are_all_tried) {
  std::set<std::string> tried;
  for (const Failure& failure : k_failures) tried.insert(failure.scene);
  tried.insert("flipping-verdict");
  tried.insert(std::begin(k_avoided), std::end(k_avoided));
  for (const auto& entry : std::filesystem::directory_iterator(k_folder)) {
    EXPECT_TRUE(tried.contains(entry.path().stem().string())) << entry.path();
    EXPECT_EQ(bytes_of(entry.path().string()).substr(0, 2), "# ") << entry.path();
  }
}

}  // namespace
}  // namespace topple::app
