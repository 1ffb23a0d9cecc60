// Measured tosses of a cube in every engine.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "solver/study/validate/toss_run.h"

namespace topple::bench {

/// One engine with one setting. `run`: poses at the times of a toss's rows; empty: it gave up.
struct TossSetting {
  std::string engine, words;
  std::function<std::vector<study::CubePose>(const study::Toss& toss, double offset)> run;
};
std::vector<TossSetting> topple_toss_settings();
std::vector<TossSetting> mujoco_toss_settings();
std::vector<TossSetting> bullet_toss_settings();

inline constexpr double k_toss_steps[] = {1e-3, 2e-3, 4e-3};  ///< s
inline constexpr double k_toss_frictions[] = {0.12, 0.14, 0.16, 0.18, 0.20};

/// Steps of `h` from the first row on: `step` takes one and returns the pose after it. Rows lie between two.
std::vector<study::CubePose> stepped_toss(const study::Toss& toss, double h,
                                          const std::function<study::CubePose()>& step);

/// All settings on all tosses of a folder of data. Writes FOLDER/tosses.csv and prints each engine beside
/// topple, each toss under the setting that is best on the other nine tenths by the cost of contact_grid(),
/// whatever that costs, and among settings that take no more CPU time than topple's best.
void run_tosses(const std::filesystem::path& folder, const std::string& data);

}  // namespace topple::bench
