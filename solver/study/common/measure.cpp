#include "solver/study/common/measure.h"

#include <sched.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>
#include <limits>

namespace topple::study {
namespace {

double thread_cpu_time() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace

std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown processor";
}

int core_count() {
  cpu_set_t set;
  return sched_getaffinity(0, sizeof set, &set) == 0 ? std::max(1, CPU_COUNT(&set)) : 1;
}

double cpu_time_of(const std::function<void()>& work, double timed) {
  const double sample = std::min(k_sample, timed);
  double least = std::numeric_limits<double>::infinity(), spent = 0;
  int repeats = 1;
  do {
    const double start = thread_cpu_time();
    for (int k = 0; k < repeats; ++k) work();
    const double taken = thread_cpu_time() - start;
    spent += taken;
    if (taken < sample)
      repeats *= 2;
    else
      least = std::min(least, taken / repeats);
  } while (spent < timed || !std::isfinite(least));
  return least;
}

}  // namespace topple::study
