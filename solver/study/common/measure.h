// What a study needs to know about the machine.
#pragma once

#include <functional>
#include <string>

namespace topple::study {

/// "AMD EPYC 7763 64-Core Processor"; "unknown processor" where the system does not tell.
std::string processor_name();

/// Cores that this process may run on, at least 1.
int core_count();

inline constexpr double k_timed = 0.05;    ///< s, CPU time spent on one measurement
inline constexpr double k_sample = 0.005;  ///< s, least of one sample: clocks are coarse and jump

/// CPU time of `work`, s, of the calling thread alone. It is repeated for samples of k_sample, and those for
/// `timed` seconds: the mean of the fastest sample. timed = 0: one call.
double cpu_time_of(const std::function<void()>& work, double timed = k_timed);

}  // namespace topple::study
