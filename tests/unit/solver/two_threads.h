// A run whose parts are stepped on two threads.
#pragma once

#include <functional>
#include <thread>

#include "solver/run/run.h"

namespace topple::test {

/// Every other part on a second thread; one worker: all as they come.
inline void share(topple::Run& run, int workers) {
  if (workers == 1) return;
  run.share({2, [](int count, const std::function<void(int, int)>& step) {
               std::thread second([&] {
                 for (int part = 1; part < count; part += 2) step(part, 1);
               });
               for (int part = 0; part < count; part += 2) step(part, 0);
               second.join();
             }});
}

}  // namespace topple::test
