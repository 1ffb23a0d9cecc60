#include "app/support/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace topple::app {
namespace {

constexpr std::chrono::milliseconds k_bar_interval{100};
constexpr std::chrono::seconds k_line_interval{5};
constexpr int k_bar_width = 30;

}  // namespace

Progress::Progress(std::string what, std::string unit, double total, bool quiet)
    : what_(std::move(what)),
      unit_(std::move(unit)),
      total_(total),
      quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) != 0),
      start_(Clock::now()),
      last_(start_) {}

Progress::~Progress() {
  if (drawn_ && terminal_) std::fputs("\r\033[K", stderr);
}

void Progress::update(double done) {
  if (quiet_) return;
  const Clock::time_point now = Clock::now();
  if (terminal_ ? now - last_ < k_bar_interval : now - last_ < k_line_interval) return;
  last_ = now;
  drawn_ = true;
  const double elapsed = Seconds(now - start_).count();
  const double rate = done / elapsed;
  const double part = std::clamp(done / total_, 0., 1.);
  const std::string text = fmt::format("{:.4g} of {:.4g} {}, {:.3g}/s, {:.0f} s left", done, total_, unit_,
                                       rate, rate > 0 ? (total_ - done) / rate : 0.);
  if (terminal_) {
    const int filled = static_cast<int>(part * k_bar_width);
    fmt::print(stderr, "\r\033[K{} [{:=<{}}{: <{}}] {}", what_, "", filled, "", k_bar_width - filled, text);
    std::fflush(stderr);
  } else {
    fmt::print(stderr, "{}: {}\n", what_, text);
  }
}

}  // namespace topple::app
