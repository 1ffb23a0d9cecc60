// Pictures, videos and tables made by a second process of the program, so that the window goes on.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "solver/io/host/process.h"
#include "solver/io/host/staged_file.h"

namespace topple::app {

/// `topple ARGUMENTS` at work. What it makes appears at `result` when it has succeeded, and not before;
/// nothing is left of it when it fails, is cancelled, or its owner goes.
class ExportJob {
 public:
  enum class Makes { file, folder };

  /// file: the process writes `result` itself. folder: the path of a staging folder is appended to
  /// `arguments`. Throws std::runtime_error when it cannot be started.
  ExportJob(const std::string& program, std::vector<std::string> arguments, std::string result,
            Makes makes = Makes::file);
  ~ExportJob();
  ExportJob(const ExportJob&) = delete;
  ExportJob& operator=(const ExportJob&) = delete;

  /// Takes in what it said. True when anything changed.
  bool update();
  void cancel();
  bool done() const { return !process_ || !process_->running(); }
  bool cancelled() const { return cancelled_; }
  /// Of a process that is done: why it failed; empty: it did not.
  const std::string& failure() const { return failure_; }
  const std::string& result() const { return result_; }
  double part() const { return part_; }                  ///< 0..1, as last reported
  const std::string& progress() const { return line_; }  ///< "40 of 300 pictures, 23/s, 11 s left"

 private:
  void read_reports();
  void end(const host::Ended& ended);

  std::string result_;
  std::optional<host::StagedFolder> folder_;
  host::MemoryFile errors_;
  host::Descriptor reports_;
  std::optional<host::Process> process_;
  std::string unread_, line_, failure_;
  double part_ = 0;
  bool cancelled_ = false;
};

}  // namespace topple::app
