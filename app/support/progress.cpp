#include "app/support/progress.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

namespace topple::app {
namespace {

constexpr std::chrono::milliseconds k_bar_interval{100};
constexpr std::chrono::seconds k_line_interval{5};
constexpr int k_bar_width = 30;

/// The pipe that k_progress_variable names; -1: none. Programs that this one starts do not inherit it, and
/// that its reader has gone does not end this process.
int open_progress_pipe() {
  const char* const named = std::getenv(k_progress_variable);
  if (!named) return -1;
  const std::string_view text = named;
  int pipe = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), pipe);
  struct stat status {};
  if (error != std::errc() || end != text.data() + text.size() || fstat(pipe, &status) != 0 ||
      !S_ISFIFO(status.st_mode))
    return -1;
  fcntl(pipe, F_SETFD, FD_CLOEXEC);
  fcntl(pipe, F_SETFL, O_NONBLOCK);
  std::signal(SIGPIPE, SIG_IGN);
  return pipe;
}

int progress_pipe() {
  static const int pipe = open_progress_pipe();
  return pipe;
}

}  // namespace

std::string in_words(const ProgressReport& report) {
  return fmt::format("{:.4g} of {:.4g} {}, {:.3g}/s, {:.0f} s left", report.done, report.total, report.unit,
                     report.rate, report.left);
}

std::string json_line(const ProgressReport& report) {
  const nlohmann::ordered_json line = {{"what", report.what}, {"unit", report.unit},
                                       {"done", report.done}, {"total", report.total},
                                       {"rate", report.rate}, {"left_s", report.left}};
  return line.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::optional<ProgressReport> progress_in(const std::string& line) {
  const nlohmann::json read = nlohmann::json::parse(line, nullptr, false);
  if (!read.is_object()) return std::nullopt;
  try {
    return ProgressReport{.what = read.at("what"),
                          .unit = read.at("unit"),
                          .done = read.at("done"),
                          .total = read.at("total"),
                          .rate = read.at("rate"),
                          .left = read.at("left_s")};
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
}

Progress::Progress(std::string what, std::string unit, double total, bool quiet)
    : what_(std::move(what)),
      unit_(std::move(unit)),
      total_(total),
      pipe_(progress_pipe()),
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
  if (now - last_ < k_bar_interval || (pipe_ < 0 && !terminal_ && now - last_ < k_line_interval)) return;
  last_ = now;
  const double rate = done / Seconds(now - start_).count();
  const ProgressReport report{.what = what_,
                              .unit = unit_,
                              .done = done,
                              .total = total_,
                              .rate = rate,
                              .left = rate > 0 ? (total_ - done) / rate : 0.};
  if (pipe_ >= 0) {
    const std::string line = json_line(report);  // shorter than what a pipe takes whole or not at all
    if (write(pipe_, line.data(), line.size()) < 0) return;
  } else if (terminal_) {
    const int filled = static_cast<int>(std::clamp(done / total_, 0., 1.) * k_bar_width);
    fmt::print(stderr, "\r\033[K{} [{:=<{}}{: <{}}] {}", what_, "", filled, "", k_bar_width - filled,
               in_words(report));
    std::fflush(stderr);
    drawn_ = true;
  } else {
    fmt::print(stderr, "{}: {}\n", what_, in_words(report));
  }
}

}  // namespace topple::app
