// Where methods fail (assets/scenes/failures): each scene fails as it says, the program says so, and on the
// other side of the limit nothing is wrong.
#include <set>

#include "program.h"

namespace topple::app {
namespace {

struct Failure {
  const char* scene;
  const char* said;       // by the error or a warning
  const char* otherwise;  // KEY=VALUE with which it works
};

constexpr Failure k_failures[] = {
    {"explicit-step", "is stable up to a time_step of", "run.time_step=4e-5"},
    {"fast-tumbling", "has no converged solution", "run.time_step=1e-3"},
    {"friction-chatter", "friction changes sides", "run.time_step=2e-3"},
    {"long-bounce", "a contact is not resolved", "run.time_step=5e-5"},
    {"newmark-rotation", "the time integration took", "run.gamma=0.5"},
    {"printed-law", "holds bodies back where they part", "contact.law=paper"},
    {"soft-contact", "contact widths", "contact.alpha=500 kgf"},
    {"stiff-pendulum", "energy balance error", "run.time_step=5e-3"},
};

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
    EXPECT_TRUE(json_of(ended.out)["warnings"].empty()) << ended.err;
  }
}

TEST_F(FailuresTest, say_in_their_first_line_what_fails_and_are_all_tried) {
  std::set<std::string> tried;
  for (const Failure& failure : k_failures) tried.insert(failure.scene);
  for (const auto& entry : std::filesystem::directory_iterator(k_folder)) {
    EXPECT_TRUE(tried.contains(entry.path().stem().string())) << entry.path();
    EXPECT_EQ(bytes_of(entry.path().string()).substr(0, 2), "# ") << entry.path();
  }
}

}  // namespace
}  // namespace topple::app
