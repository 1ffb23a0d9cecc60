// What studies have in common: cases on threads, rows as text, gnuplot, CPU time.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "solver/study/common/gnuplot.h"
#include "solver/study/common/measure.h"
#include "solver/study/common/parallel.h"
#include "solver/study/common/rows.h"

namespace topple::study {
namespace {

TEST(ForEachCase, each_is_worked_once_on_any_number_of_threads) {
  for (const int jobs : {1, 2, 7, 100}) {
    std::vector<std::atomic<int>> times(50);
    int last = 0;
    for_each_case(
        50, jobs,
        [&](int k, int worker) {
          EXPECT_LT(worker, jobs);
          ++times[static_cast<std::size_t>(k)];
        },
        [&](int done) {
          EXPECT_EQ(done, ++last);
          return true;
        });
    for (const std::atomic<int>& count : times) EXPECT_EQ(count, 1);
    EXPECT_EQ(last, 50);
  }
}

TEST(ForEachCase, none_is_begun_after_a_no) {
  std::atomic<int> begun = 0;
  for_each_case(
      100, 1, [&](int, int) { ++begun; }, [](int done) { return done < 3; });
  EXPECT_EQ(begun, 3);
}

TEST(ForEachCase, the_first_error_is_thrown_when_all_have_ended) {
  std::atomic<int> ended = 0;
  const auto work = [&](int k, int) {
    if (k == 3 || k == 17) throw std::runtime_error("case " + std::to_string(k));
    ++ended;
  };
  try {
    for_each_case(20, 3, work, [](int) { return true; });
    FAIL() << "nothing was thrown";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "case 3");
  }
  EXPECT_EQ(ended, 18);
}

TEST(Rows, csv_has_keys_then_a_line_a_row) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  EXPECT_EQ(csv_text(rows), "");
  rows.push_back({{"name", "a"}, {"value", 0.1}, {"count", 3}});
  rows.push_back({{"name", "with, \"marks\""}, {"value", nullptr}, {"count", -1}});
  EXPECT_EQ(csv_text(rows), "name,value,count\na,0.1,3\n\"with, \"\"marks\"\"\",,-1\n");
}

TEST(Gnuplot, quoted_text_reads_back_the_same) {
  for (const std::string text : {"plain", "it's", "''", "a\\nb \"c\" $d `e` @f %g #h", "κ ≥ 2"})
    EXPECT_EQ(run_gnuplot("set print '-'\nprint " + gnuplot_quoted(text) + "\n"), text + "\n");
  EXPECT_EQ(gnuplot_quoted("two\nlines"), "\"two lines\"");
}

TEST(Gnuplot, a_failure_is_told_in_one_line) {
  for (const char* script : {"plot nothing\n", "set terminal none-such\n", ""}) {
    try {
      run_gnuplot(script);
      FAIL() << script;
    } catch (const ChartError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
      EXPECT_TRUE(std::string(error.what()).starts_with("gnuplot failed (exit status ")) << error.what();
    }
  }
}

TEST(Gnuplot, where_it_is_missing_the_package_is_named) {
  const std::string path = std::getenv("PATH");
  setenv("PATH", "/none", 1);
  EXPECT_THROW(
      {
        try {
          run_gnuplot("print 1\n");
        } catch (const ChartError& error) {
          EXPECT_NE(std::string(error.what()).find("gnuplot-nox"), std::string::npos);
          throw;
        }
      },
      ChartError);
  setenv("PATH", path.c_str(), 1);
}

TEST(CpuTime, is_that_of_the_work_alone) {
  int calls = 0;
  EXPECT_GE(cpu_time_of([&] { ++calls; }, 0), 0);
  EXPECT_EQ(calls, 1);
  volatile double sink = 0;
  const auto work = [&](int turns) {
    return cpu_time_of([&sink, turns] {
      for (int k = 0; k < turns; ++k) sink = sink + k;
    });
  };
  const double one = work(20000), ten = work(200000);
  EXPECT_GT(ten / one, 5);
  EXPECT_LT(ten / one, 20);
}

}  // namespace
}  // namespace topple::study
