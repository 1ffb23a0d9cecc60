#include "solver/io/host/process.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <system_error>

namespace topple::host {
namespace {

TEST(Processes, what_goes_in_and_comes_out_is_kept_in_memory) {
  MemoryFile input("input"), output("output"), errors("errors");
  input.write("words\n");
  Process process(
      "sh", {"-c", "cat; echo trouble >&2; exit 3"},
      {.input = input.descriptor(), .output = output.descriptor(), .errors = errors.descriptor()});
  const Ended ended = process.wait();
  EXPECT_EQ(ended.code, 3);
  EXPECT_FALSE(ended.good());
  EXPECT_EQ(in_words(ended), "exit status 3");
  EXPECT_FALSE(process.running());
  EXPECT_EQ(output.content(), "words\n");
  EXPECT_EQ(last_line(errors.content()), "trouble");
}

TEST(Processes, streams_that_are_not_given_lead_nowhere) {
  Process process("sh", {"-c", "cat && echo words && echo words >&2"}, {});
  EXPECT_TRUE(process.wait().good());
}

TEST(Processes, a_fourth_stream_and_variables_reach_the_child) {
  MemoryFile extra("extra");
  Process process("sh", {"-c", "echo $TOPPLE_TEST_WORD >&3"}, {.extra = extra.descriptor()},
                  {"TOPPLE_TEST_WORD=told"});
  EXPECT_TRUE(process.wait().good());
  EXPECT_EQ(extra.content(), "told\n");
}

TEST(Processes, a_program_that_is_missing_is_named) {
  try {
    const Process process("no-such-program", {}, {});
    FAIL() << "it was started";
  } catch (const std::system_error& error) {
    EXPECT_STREQ(error.what(), "no-such-program: No such file or directory");
  }
}

TEST(Processes, a_signal_that_ended_one_is_told) {
  Process process("sleep", {"60"}, {});
  EXPECT_FALSE(process.poll().has_value());
  process.signal(SIGTERM);
  const Ended ended = process.wait();
  EXPECT_EQ(ended.signal, SIGTERM);
  EXPECT_EQ(in_words(ended), "signal 15");
  EXPECT_EQ(process.poll()->signal, SIGTERM);
}

TEST(Processes, one_ends_with_its_owner) {
  pid_t number = 0;
  {
    const Process process("sleep", {"60"}, {});
    number = process.number();
  }
  EXPECT_EQ(kill(number, 0), -1);
  EXPECT_EQ(errno, ESRCH);
}

TEST(Processes, the_last_line_with_words_is_found) {
  EXPECT_EQ(last_line(""), "");
  EXPECT_EQ(last_line(" \n\n"), "");
  EXPECT_EQ(last_line("one"), "one");
  EXPECT_EQ(last_line("one\r two \n\n"), "two");
}

}  // namespace
}  // namespace topple::host
