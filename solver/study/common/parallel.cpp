#include "solver/study/common/parallel.h"

#include <algorithm>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace topple::study {

void for_each_case(int count, int jobs, const std::function<void(int k, int worker)>& work,
                   const std::function<bool(int done)>& go_on) {
  std::vector<std::exception_ptr> thrown(static_cast<std::size_t>(count));
  std::mutex mutex;
  int next = 0, done = 0;
  bool going = true;
  const auto take = [&] {
    const std::scoped_lock lock(mutex);
    return going && next < count ? next++ : -1;
  };
  const auto work_off = [&](int worker) {
    for (int k = take(); k >= 0; k = take()) {
      try {
        work(k, worker);
      } catch (...) {
        thrown[static_cast<std::size_t>(k)] = std::current_exception();
      }
      const std::scoped_lock lock(mutex);
      ++done;
      going = going && go_on(done);
    }
  };
  {
    std::vector<std::jthread> helpers;
    for (int j = 1; j < std::min(jobs, count); ++j) helpers.emplace_back(work_off, j);
    work_off(0);
  }
  for (const std::exception_ptr& error : thrown)
    if (error) std::rethrow_exception(error);
}

}  // namespace topple::study
