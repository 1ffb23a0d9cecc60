#include "app/study/sweep.h"

#include <fmt/format.h>

#include <chrono>
#include <exception>
#include <mutex>
#include <thread>

#include "app/study/ranks.h"
#include "app/study/study_results.h"
#include "app/support/interrupt.h"
#include "app/support/log.h"
#include "app/support/progress.h"
#include "solver/io/host/staged_file.h"
#include "solver/study/common/kept_rows.h"
#include "solver/study/common/measure.h"
#include "solver/study/common/parallel.h"

namespace topple::app {

using nlohmann::ordered_json;

namespace {

constexpr int k_common = 0;  // tag of what is for a rank; 1 and on: its workers
constexpr const char* k_end = "end";

/// What runs are asked after each step.
std::function<bool()> time_is_over(bool quick, Clock::time_point start) {
  return [quick, start] { return interrupted() || (quick && seconds_since(start) > k_quick); };
}

}  // namespace

Crew::Crew(std::optional<int> jobs) : jobs_(jobs.value_or(study::core_count())) {
  if (started_ranks() > 1) ranks_ = std::make_unique<Ranks>();
}

Crew::~Crew() {
  if (!ranks_ || !leads()) return;
  if (!broadcast_sent_)
    for (int rank = 1; rank < ranks(); ++rank) {
      ranks_->wait(rank, k_common);
      ranks_->send(rank, k_common, "0");
    }
  for (const Remote& worker : remote_) ranks_->send(worker.rank, worker.tag, k_end);
  for (const Remote& worker : remote_)
    while (ranks_->wait(worker.rank, worker.tag) != k_end) {  // a row that nobody waited for
    }
}

bool Crew::leads() const {
  return !ranks_ || ranks_->rank() == 0;
}

int Crew::ranks() const {
  return ranks_ ? ranks_->count() : 1;
}

int Crew::gather_workers(const std::vector<std::string>& broadcast) {
  broadcast_sent_ = true;
  for (int rank = 1; rank < ranks(); ++rank) {
    const int workers = std::stoi(ranks_->wait(rank, k_common));
    for (int worker = 1; worker <= workers; ++worker) remote_.push_back({rank, worker});
    ranks_->send(rank, k_common, std::to_string(broadcast.size()));
    for (const std::string& part : broadcast) ranks_->send(rank, k_common, part);
  }
  return jobs_ + static_cast<int>(remote_.size());
}

std::optional<std::vector<std::string>> Crew::receive_broadcast() {
  ranks_->send(0, k_common, std::to_string(jobs_));
  std::vector<std::string> broadcast(std::stoul(ranks_->wait(0, k_common)));
  for (std::string& part : broadcast) part = ranks_->wait(0, k_common);
  return broadcast.empty() ? std::nullopt : std::optional(std::move(broadcast));
}

void Crew::serve(const MakeWork& make, bool quick) {
  const auto give_up = time_is_over(quick, Clock::now());
  std::vector<std::jthread> threads;
  for (int worker = 1; worker <= jobs_; ++worker)
    threads.emplace_back([this, worker, &give_up, work = make()] {
      for (std::string task; (task = ranks_->wait(0, worker)) != k_end;)
        ranks_->send(0, worker, work(std::stoi(task), give_up));
      ranks_->send(0, worker, k_end);
    });
}

CaseWork Crew::work_of(int worker, const MakeWork& make) {
  if (worker < jobs_) return make();
  return [this, remote = remote_[static_cast<std::size_t>(worker - jobs_)]](
             int k, const std::function<bool()>& give_up) -> std::string {
    ranks_->send(remote.rank, remote.tag, std::to_string(k));
    for (; !give_up(); std::this_thread::sleep_for(std::chrono::microseconds(200)))
      if (std::optional<std::string> row = ranks_->take(remote.rank, remote.tag)) return *std::move(row);
    return "";
  };
}

std::optional<SweepEnd> sweep(Crew& crew, const SweepPlan& plan, const StudyOptions& options) {
  const auto give_up = time_is_over(options.quick, plan.start);
  SweepEnd end;
  end.unit = plan.unit;
  end.file = plan.stem + ".rows";
  if (!options.resume) host::expect_replaceable({end.file, options.force}, host::FileKind::json);
  ordered_json settings = plan.settings;
  settings["topple"] = TOPPLE_VERSION;
  study::KeptRows kept(end.file, settings, static_cast<int>(plan.order.size()), options.resume);
  std::vector<int> left;
  for (const int k : plan.order)
    if (kept.rows()[static_cast<std::size_t>(k)].empty()) left.push_back(k);
  end.kept = kept.count();
  if (!left.empty()) {
    const int workers = crew.gather_workers(plan.broadcast);
    std::vector<CaseWork> works;
    works.reserve(static_cast<std::size_t>(workers));
    for (int worker = 0; worker < workers; ++worker) works.push_back(crew.work_of(worker, plan.make));
    Progress progress(plan.label, plan.unit, static_cast<double>(left.size()), options.quiet);
    std::mutex keeping;
    std::exception_ptr trouble;
    study::for_each_case(
        static_cast<int>(left.size()), workers,
        [&](int n, int worker) {
          const int k = left[static_cast<std::size_t>(n)];
          const std::string row = works[static_cast<std::size_t>(worker)](k, give_up);
          if (row.empty()) return;
          const std::scoped_lock lock(keeping);
          try {
            if (!trouble) kept.add(k, row);
          } catch (...) {
            trouble = std::current_exception();
          }
        },
        [&](int done) {
          progress.update(done);
          const std::scoped_lock lock(keeping);
          return !give_up() && !trouble;
        });
    if (trouble) std::rethrow_exception(trouble);
  }
  end.rows = kept.rows();
  end.run = kept.count();
  if (!interrupted()) return end;
  log_message(fmt::format("interrupted; {} of {} {} are kept in {}, --resume goes on from there", end.run,
                          end.rows.size(), end.unit, end.file));
  return std::nullopt;
}

std::string SweepEnd::runs_in_words(const std::string& each) const {
  return fmt::format("{} of {} {}{}{}", run, rows.size(), unit, each,
                     kept > 0 ? fmt::format(" ({} from before)", kept) : "");
}

std::string SweepEnd::left_in_words(bool quick, const char* what) const {
  if (!quick) return "";
  return complete() ? ": --quick left nothing out"
                    : fmt::format("; --quick left out {}, {} first, --resume goes on from {}",
                                  rows.size() - run, what, file);
}

}  // namespace topple::app
