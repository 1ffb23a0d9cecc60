// A recording written by a thread of its own, through a queue.
#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "solver/io/host/staged_file.h"
#include "solver/io/recording/recording.h"
#include "solver/io/scene/scene.h"

namespace topple::app {

class LiveRecorder {
 public:
  using Item = std::variant<io::Observation, Branch, LoggedEdit>;

  /// Starts the recording. `arithmetic`: as for io::Recorder. Throws io::WriteError when it cannot be.
  LiveRecorder(const host::Target& target, const io::Scene& scene,
               const std::string& arithmetic = topple::arithmetic());
  /// A recording that was not finished reads as interrupted.
  ~LiveRecorder();
  LiveRecorder(const LiveRecorder&) = delete;
  LiveRecorder& operator=(const LiveRecorder&) = delete;

  /// From any thread; ignored after finish() or a failure. Blocks while a thousand items are queued.
  void post(Item item);
  /// Writes what was posted, status and summary, closes, and returns then. Only the first call counts.
  void finish(const std::string& status, const std::string& summary_json);
  /// Why the recording broke off, one line; empty: it did not.
  std::string failure() const;

 private:
  void work(const host::Target& target, const io::Scene& scene, const std::string& arithmetic);
  void write_until_ended(io::Recorder& recorder);

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Item> items_;
  bool started_ = false, ended_ = false, finished_ = false;
  std::string status_, summary_, failure_;
  std::mutex finishing_;
  std::thread thread_;
};

}  // namespace topple::app
