// Furniture values: the formula, floors of a stated spectrum, and blocks of which theory knows the answer.
#include "solver/study/validate/furniture_study.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "solver/io/common/errors.h"
#include "solver/study/validate/block_run.h"

namespace topple::study {
namespace {

// A_R50 = A_0 (1 + A_0/980) of the values as they are printed, to a gal and a half; chart and code of the
// corner frequency are those of criteria_test.cpp.
TEST(FurnitureStudy, the_five_values_follow_their_formula) {
  for (const FurnitureValue& value : furniture_values()) {
    EXPECT_NEAR(value.lift * (1 + value.slenderness()), value.median, 1.5 * k_gal) << value.name;
    EXPECT_EQ(value.median_at(0.5 * value.corner()), value.median);
    EXPECT_NEAR(value.median_at(2 * value.corner()), 2 * value.median, 1e-12);
  }
}

TEST(FurnitureStudy, floors_have_their_peak_and_their_frequency) {
  for (const double frequency : {0.4, 3.}) {
    const auto motion = floor_noise(frequency, 5);
    EXPECT_NEAR(motion->peak, 1, 1e-12);
    const std::vector<double>& a = motion->components[0].samples;
    int crossings = 0;
    for (std::size_t i = 1; i < a.size(); ++i) crossings += (a[i] > 0) != (a[i - 1] > 0);
    EXPECT_NEAR(crossings / (2 * motion->duration), frequency, 0.1 * frequency);
    EXPECT_NE(a[100], floor_noise(frequency, 6)->components[0].samples[100]);
  }
}

// Far below the corner a block that lifts does not come back: it overturns at A_0, whatever the floor. What
// slips before it lifts never does.
TEST(FurnitureStudy, a_slow_floor_overturns_at_what_lifts_and_a_smooth_one_never) {
  const std::vector<FurnitureValue> values{furniture_values().front()};
  const auto half = [&](const FurniturePoint& point) {
    return gather_furniture({run_furniture_case(values, point, [] { return false; })}).front().half;
  };
  const auto slow = half({0, 0.05, k_rough});
  ASSERT_TRUE(slow);
  EXPECT_NEAR(slow->median * values[0].median / values[0].lift, 1, 0.03);  // levels are 3.6 % apart
  EXPECT_FALSE(half({0, 0.5, 0.9 * values[0].slenderness()}));
}

TEST(FurnitureStudy, values_of_another_form_are_named_with_their_line) {
  namespace fs = std::filesystem;
  std::string name = (fs::temp_directory_path() / "topple-furniture-XXXXXX").string();
  ASSERT_NE(mkdtemp(name.data()), nullptr);
  const fs::path folder = name;
  const auto read = [&](const std::string& rows) {
    std::ofstream(folder / "furniture.csv") << "name,a0_gal,ar50_gal,height_m\n" + rows;
    return read_furniture(folder);
  };
  EXPECT_EQ(read("shelf,174,205,1.8\ndesk,535,826,0.7\n")[1].name, "desk");
  struct Bad {
    const char *rows, *part;
  };
  for (const Bad& bad :
       {Bad{"shelf,174,205,1.8\nshelf,232,287,1.8\n", ":3: name: \"shelf\" is in line 2 already"},
        Bad{"shelf,174,nan,1.8\n", ":2: ar50_gal: \"nan\" is no finite number"},
        Bad{"shelf,1.74,2.05,1.8\n", ":2: a0_gal: is outside 20..980 gal"},
        Bad{"shelf,174,205,1800\n", ":2: height_m: is outside 0.1..10 m"},
        Bad{"shelf,174,105,1.8\n", ":2: ar50_gal: is below a0_gal"}})
    try {
      read(bad.rows);
      ADD_FAILURE() << "read: " << bad.part;
    } catch (const io::InputError& error) {
      EXPECT_NE(std::string(error.what()).find(bad.part), std::string::npos) << error.what();
    }
  fs::remove_all(folder);
}

}  // namespace
}  // namespace topple::study
