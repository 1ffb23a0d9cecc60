// Recordings made to harm: what HDF5 does with one, stood in for by failing_hdf5.cpp, happens to a process
// beside the program.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "unit/app/program.h"

namespace topple::app {
namespace {

class ForeignRecordingTest : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    const std::vector<std::string> run = {"run",      "free-rocking", "--set",  "run.duration=0.2 s",
                                          "--output", "a.h5",         "--quiet"};
    ASSERT_EQ(topple(run).code, 0);
  }
  static Circumstances with_fault(const std::string& fault) {
    const char* const options = getenv("ASAN_OPTIONS");
    return {.set = {{"LD_PRELOAD", TOPPLE_FAILING_HDF5},
                    {"TOPPLE_HDF5_FAULT", fault},
                    {"ASAN_OPTIONS", (options ? std::string(options) + ":" : "") +
                                         "verify_asan_link_order=0:handle_segv=0"}}};
  }
};

TEST_F(ForeignRecordingTest, a_crash_of_the_library_is_one_line_in_every_command_that_reads) {
  const std::vector<std::vector<std::string>> commands = {
      {"info", "a.h5"},
      {"recover", "a.h5"},
      {"export", "--csv", "out", "a.h5"},
      {"compare", "a.h5", "a.h5"},
      {"render", "a.h5", "--still", "a.png", "--at", "0.1"},
      {"view", "a.h5"},
  };
  for (const auto& command : commands) {
    SCOPED_TRACE(command[0]);
    expect_one_line(command, 2, "a.h5: cannot read: it brings the HDF5 library to a crash",
                    with_fault("crash"));
  }
}

TEST_F(ForeignRecordingTest, an_endless_loop_in_the_library_ends) {
  expect_one_line({"info", "a.h5"}, 2, "a.h5: cannot read: it takes more than 10 s of processor time",
                  with_fault("loop"));
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they allow no limit of memory
TEST_F(ForeignRecordingTest, a_small_file_cannot_ask_for_all_memory) {
  expect_one_line({"info", "a.h5"}, 2, "a.h5: cannot read: it asks for more than 10", with_fault("memory"));
}
#endif

}  // namespace
}  // namespace topple::app
