// Sweeps of studies: their cases on threads and, under mpirun, on other ranks; rows kept while they come.
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/study/study_options.h"
#include "app/support/clock.h"

namespace topple::app {

class Ranks;

/// Works out one case: its row, JSON in one line; empty when give_up() came true. One worker's calls do not
/// overlap.
using CaseWork = std::function<std::string(int k, const std::function<bool()>& give_up)>;
/// Makes what one worker has for itself.
using MakeWork = std::function<CaseWork()>;

/// Workers that call run_case() of the plan's study.
template <class Plan>
MakeWork work_on(const Plan& plan) {
  return [&plan] {
    return [&plan](int k, const std::function<bool()>& give_up) { return run_case(plan, k, give_up); };
  };
}

/// The workers of a sweep: threads of this process, and under mpirun those of the other ranks, to which rank
/// 0 hands out cases. They need nothing but the same command line: rank 0 broadcasts the rest.
class Crew {
 public:
  /// `jobs`: threads of this process; absent: one per core that it may run on. Under mpirun joins the other
  /// ranks; throws BadInput where it cannot.
  explicit Crew(std::optional<int> jobs);
  /// Rank 0 lets the others go.
  ~Crew();

  bool leads() const;
  int ranks() const;
  int jobs() const { return jobs_; }
  /// Rank 0, once: broadcasts this to the others. Returns the number of workers.
  int gather_workers(const std::vector<std::string>& broadcast);
  /// The others: none when rank 0 has no work.
  std::optional<std::vector<std::string>> receive_broadcast();
  /// The others: works until rank 0 says that it was all. With `quick` runs are given up when its time is
  /// over.
  void serve(const MakeWork& make, bool quick);
  /// Rank 0: the work of one of the workers, those of this process first.
  CaseWork work_of(int worker, const MakeWork& make);

 private:
  struct Remote {
    int rank, tag;
  };
  int jobs_;
  std::unique_ptr<Ranks> ranks_;  ///< null: alone
  std::vector<Remote> remote_;
  bool broadcast_sent_ = false;
};

struct SweepPlan {
  std::string label = {};              ///< of the progress
  std::string unit = "runs";           ///< what is counted
  std::string stem = {};               ///< of its results; rows are kept in STEM.rows while it goes on
  nlohmann::ordered_json settings;     ///< that rows depend on, besides the version
  std::vector<int> order;              ///< of all cases, as they are begun
  std::vector<std::string> broadcast;  ///< to the other ranks, in this order
  MakeWork make;
  Clock::time_point start = Clock::now();  ///< of the study, from which the time of --quick counts
};

struct SweepEnd {
  std::vector<std::string> rows;  ///< per case; empty: it was not run
  int run = 0, kept = 0;          ///< cases that have a row, those of them from before included
  std::string unit;               ///< of the plan
  std::string file;               ///< where rows are kept; gone once all are there and written
  bool complete() const { return run == static_cast<int>(rows.size()); }
  /// "12 of 40 runs of 0.3 s", and how many of them are from before; `each`: " of 0.3 s".
  std::string runs_in_words(const std::string& each) const;
  /// What --quick did to it; `what` it leaves out first.
  std::string left_in_words(bool quick, const char* what) const;
};

/// Runs the cases that have no row yet until all have one, the time of --quick is over or Ctrl+C comes, which
/// must be deferred (interrupt.h): then none, and it is said where to go on. Runs that are under way then are
/// given up: one may take minutes. Throws std::runtime_error when a row cannot be kept.
std::optional<SweepEnd> sweep(Crew& crew, const SweepPlan& plan, const StudyOptions& options);

}  // namespace topple::app
