// Shake-table tests of two rocks of granite: which fell under which measured motion of the table.
//
// A folder has outcomes.csv and a file test-NNN.csv or test-NNN.csv.gz for each of its rows. Tests of 2021,
// repository ZhangChen/virtual_shake_robot_pybullet (GPL-3.0), folder data/Shake_Table_Response.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <vector>

#include "solver/model/accelerogram.h"
#include "solver/study/validate/data_table.h"

namespace topple::study {

inline constexpr std::size_t k_rocks = 2;

/// A rock is a row of this table; it rocks about an edge across the table's motion.
struct RockTraits {
  const char* name;
  const char* outcome;       ///< column of outcomes.csv
  double height;             ///< m, of the centre of gravity over the lowest point, of its mesh
  double inertia_over_mass;  ///< m^2, about the axis across the motion through the centre of gravity
};
const std::array<RockTraits, k_rocks>& rocks();

struct GraniteTest {
  int number = 0;
  double peak_velocity = 0;          ///< m/s, of the table as the authors' sheet states it
  std::array<bool, k_rocks> fell{};  ///< of rocks()
  std::shared_ptr<const Accelerogram> motion;
};

struct GraniteData {
  std::vector<GraniteTest> tests;  ///< by number
  Skipped skipped;                 ///< with keep_going
};

/// Throws io::InputError "FILE:LINE: ..." on what is not of this form: a row without its file or a file
/// without its row, two rows of one test, times that do not rise in equal steps, a peak other than the one
/// that outcomes.csv states. With `keep_going` a bad file, or row without one, is left out and named.
GraniteData read_granite(const std::filesystem::path& folder, bool keep_going);

}  // namespace topple::study
