#include "app/support/progress.h"

#include <fcntl.h>
#include <unistd.h>

#include "unit/app/program.h"
#include "unit/app/scenes.h"

namespace topple::app {
namespace {

TEST(ProgressLines, a_report_is_one_line_of_json_that_reads_back_the_same) {
  const ProgressReport report{
      .what = "two\nlines", .unit = "pictures", .done = 40, .total = 300, .rate = 23, .left = 11.3};
  const std::string line = json_line(report);
  EXPECT_EQ(line.find('\n'), line.size() - 1);
  const auto read = progress_in(line);
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->what, report.what);
  EXPECT_EQ(read->unit, report.unit);
  EXPECT_EQ(read->done, report.done);
  EXPECT_EQ(read->total, report.total);
  EXPECT_EQ(read->rate, report.rate);
  EXPECT_EQ(read->left, report.left);
  EXPECT_EQ(in_words(*read), "40 of 300 pictures, 23/s, 11 s left");
}

TEST(ProgressLines, what_is_no_report_is_passed_over) {
  for (const char* line :
       {"", "drawing [==  ] 4 of 9", "[1, 2]", "{\"done\": 1}",
        "{\"done\": ", "{\"what\":\"a\",\"unit\":\"b\",\"done\":null,\"total\":1,\"rate\":1,\"left_s\":1}"})
    EXPECT_FALSE(progress_in(line).has_value()) << line;
}

class ProgressPipeTest : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write_bytes("s.toml", k_shaken);
    ASSERT_EQ(pipe(ends_), 0);  // that a child inherits
  }
  void TearDown() override {
    for (const int end : ends_) close(end);
    ProgramTest::TearDown();
  }
  Circumstances with_pipe() const { return {.set = {{k_progress_variable, std::to_string(ends_[1])}}}; }

  const std::vector<std::string> call_{"run", "s.toml", "--set", "run.duration=600"};
  int ends_[2] = {-1, -1};
};

TEST_F(ProgressPipeTest, a_process_that_was_given_a_pipe_tells_its_progress_there_alone) {
  const int out = memory(), err = memory();
  const pid_t child = start(call_, out, err, with_pipe());
  std::string text;
  while (std::count(text.begin(), text.end(), '\n') < 2) {
    char bytes[4096];
    const ssize_t had = read(ends_[0], bytes, sizeof bytes);
    ASSERT_GT(had, 0);
    text.append(bytes, static_cast<std::size_t>(had));
  }
  kill(child, SIGINT);
  EXPECT_EQ(wait_for(child), 130);
  const auto report = progress_in(text.substr(0, text.find('\n')));
  ASSERT_TRUE(report.has_value()) << text;
  EXPECT_EQ(report->unit, "s simulated");
  EXPECT_EQ(report->total, 600);
  EXPECT_GT(report->done, 0);
  EXPECT_LT(report->done, 600);
  EXPECT_GT(report->rate, 0);
  EXPECT_TRUE(content(err).starts_with("topple: interrupted")) << content(err);
  close(out);
  close(err);
}

TEST_F(ProgressPipeTest, a_reader_that_has_gone_or_does_not_read_holds_nothing_up) {
  fcntl(ends_[1], F_SETPIPE_SZ, 4096);
  std::string line(4096, '.');
  ASSERT_EQ(write(ends_[1], line.data(), line.size()), 4096);  // it is full
  EXPECT_EQ(topple({"run", "s.toml", "--set", "run.duration=20"}, with_pipe()).code, 0);
  close(ends_[0]);
  ends_[0] = open("/dev/null", O_RDONLY | O_CLOEXEC);
  EXPECT_EQ(topple({"run", "s.toml", "--set", "run.duration=20"}, with_pipe()).code, 0);
}

TEST_F(ProgressPipeTest, what_is_no_pipe_is_not_written_to) {
  const int file = open("file", O_RDWR | O_CREAT, 0600);
  for (const std::string& named :
       {std::to_string(file), std::string("99"), std::string("-1"), std::string("x"), std::string()})
    EXPECT_EQ(topple({"run", "s.toml"}, {.set = {{k_progress_variable, named}}}).code, 0) << named;
  EXPECT_EQ(bytes_of("file"), "");
  close(file);
}

}  // namespace
}  // namespace topple::app
