// Pictures, videos and tables made by a second process of the program, so that the window goes on.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace topple::app {

/// `topple ARGUMENTS` at work. What it makes appears at `result` when it has succeeded, and not before;
/// nothing is left of it when it fails, is cancelled, or its owner goes.
class ExportJob {
 public:
  /// `partial`: where the process writes a folder, which becomes `result` at the end; empty: it writes
  /// `result`, a file, by itself. Throws std::runtime_error when it cannot be started.
  ExportJob(const std::string& program, const std::vector<std::string>& arguments, std::string result,
            std::string partial = "");
  ~ExportJob();
  ExportJob(const ExportJob&) = delete;
  ExportJob& operator=(const ExportJob&) = delete;

  /// Takes in what it said. True when anything changed.
  bool update();
  void cancel();
  bool done() const { return process_ < 0; }
  bool cancelled() const { return cancelled_; }
  /// Of a process that is done: why it failed; empty: it did not.
  const std::string& failure() const { return failure_; }
  const std::string& result() const { return result_; }
  double part() const { return part_; }                  ///< 0..1, as far as it tells
  const std::string& progress() const { return line_; }  ///< "40 of 300 pictures, 23/s, 11 s left"

 private:
  void read_lines();
  void take_line(const std::string& line);
  void end(int status);
  void remove_partial();

  std::string result_, partial_;
  pid_t process_ = -1, was_ = -1;
  int terminal_ = -1;
  std::string unread_, line_, last_words_, failure_;
  double part_ = 0;
  bool cancelled_ = false;
};

}  // namespace topple::app
