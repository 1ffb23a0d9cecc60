#include "app/picture/drawing_processes.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>

namespace topple::app {
namespace {

constexpr int k_many = 40;

/// In the order in which they were taken.
std::vector<int> draw(int count, const std::function<void(int number)>& before) {
  std::vector<int> taken;
  draw_pictures(
      count,
      [&]() -> DrawPicture {
        return [&before](int number) -> std::vector<std::uint8_t> {
          before(number);
          // more than a pipe holds
          return std::vector<std::uint8_t>(100000, static_cast<std::uint8_t>(number));
        };
      },
      [&](int number, const std::vector<std::uint8_t>& answer) {
        EXPECT_EQ(answer.size(), 100000u);
        EXPECT_EQ(answer.front(), number);
        EXPECT_EQ(answer[99999], number);
        taken.push_back(number);
      });
  return taken;
}

std::vector<int> numbers(int count) {
  std::vector<int> all(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) all[static_cast<std::size_t>(i)] = i;
  return all;
}

TEST(DrawingProcesses, answers_come_in_order_whoever_draws_first) {
  EXPECT_EQ(draw(k_many, [](int number) { usleep(number % 3 == 0 ? 3000 : 0); }), numbers(k_many));
  EXPECT_EQ(draw(1, [](int) {}), numbers(1));
  EXPECT_EQ(draw(0, [](int) {}), numbers(0));
}

TEST(DrawingProcesses, many_are_drawn_by_others_and_few_here) {
  std::set<std::int32_t> processes;
  const auto open = []() -> DrawPicture {
    return [](int) {
      const std::int32_t id = getpid();
      std::vector<std::uint8_t> answer(sizeof id);
      std::memcpy(answer.data(), &id, sizeof id);
      return answer;
    };
  };
  const auto take = [&](int, const std::vector<std::uint8_t>& answer) {
    std::int32_t id;
    std::memcpy(&id, answer.data(), sizeof id);
    processes.insert(id);
  };
  draw_pictures(3, open, take);
  EXPECT_EQ(processes, std::set<std::int32_t>{getpid()});
  if (std::thread::hardware_concurrency() < 2) GTEST_SKIP() << "one core";
  processes.clear();
  draw_pictures(k_many, open, take);
  EXPECT_GE(processes.size(), 2u);
  EXPECT_FALSE(processes.contains(getpid()));
}

TEST(DrawingProcesses, what_one_throws_is_thrown_here) {
  for (const int count : {8, k_many}) try {
      draw(count, [](int number) {
        if (number == 5) throw std::runtime_error("no ink");
      });
      FAIL() << count;
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "no ink") << count;
    }
}

TEST(DrawingProcesses, one_that_is_killed_is_told_of) {
  if (std::thread::hardware_concurrency() < 2) GTEST_SKIP() << "one core";
  try {
    draw(k_many, [](int number) {
      if (number == 7) raise(SIGKILL);
    });
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("was killed"), std::string::npos) << error.what();
  }
}

TEST(DrawingProcesses, all_end_when_a_taker_throws) {
  const auto open = []() -> DrawPicture { return [](int) { return std::vector<std::uint8_t>(100000); }; };
  EXPECT_THROW(draw_pictures(k_many, open,
                             [](int number, const std::vector<std::uint8_t>&) {
                               if (number == 4) throw std::runtime_error("no room");
                             }),
               std::runtime_error);
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1) << "a process is left";
}

}  // namespace
}  // namespace topple::app
