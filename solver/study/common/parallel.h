// Independent cases of a study on several threads.
#pragma once

#include <functional>

namespace topple::study {

/// Calls work(k, worker) once for each k = 0..count-1 on `jobs` >= 1 threads, begun in this order; worker is
/// 0..jobs-1, calls with the same one do not overlap. After each case calls go_on(done), one thread at a
/// time; once it is false no further case is begun. When all threads have ended, throws what the case with
/// the lowest k threw.
void for_each_case(int count, int jobs, const std::function<void(int k, int worker)>& work,
                   const std::function<bool(int done)>& go_on);

}  // namespace topple::study
