// How the solver runs tasks on threads, which it does not make itself.
#pragma once

#include <functional>

namespace topple {

/// Calls f(task, worker) once for each task 0..count-1, in any order; returns when all are done. worker is
/// 0..workers-1; calls with the same one do not overlap. f does not throw.
struct ParallelFor {
  int workers = 1;
  std::function<void(int count, const std::function<void(int task, int worker)>& f)> run;  ///< empty: none
};

}  // namespace topple
