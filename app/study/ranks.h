// This process among those that mpirun started.
#pragma once

#include <optional>
#include <string>

namespace topple::app {

/// What mpirun says in the environment; 1 and 0 of a process that was started alone.
int started_ranks();
int started_rank();

/// Messages between ranks by MPI. Any thread may call.
class Ranks {
 public:
  /// Joins the others. Throws BadInput when this build has no MPI, or not the one of that mpirun.
  Ranks();
  /// Waits for the others. Every message must have been taken.
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  int rank() const { return rank_; }
  int count() const { return count_; }
  void send(int to, int tag, const std::string& bytes);
  /// What has come, the oldest first; does not wait.
  std::optional<std::string> take(int from, int tag);
  /// Waits, asleep between two polls.
  std::string wait(int from, int tag);

 private:
  int rank_ = 0, count_ = 1;
};

}  // namespace topple::app
