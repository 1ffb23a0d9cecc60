// Pictures that a person has looked at. One that differs is written to the build folder (tests/golden/) for a
// look. With TOPPLE_NEW_GOLDEN set the stored ones are written anew, to be looked at again:
//   TOPPLE_NEW_GOLDEN=1 ctest --preset release -R Golden
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "render/output/image.h"
#include "tests/unit/render/read_png.h"

namespace topple::render {

// On one Mesa version pictures are exact. Another version may round coverage and filtering
// differently: single pixels on edges by a lot, surfaces by one step.
inline constexpr double k_mean_tolerance = 0.25;  // of 255, over all channels
inline constexpr double k_outlier_step = 24;      // of 255
inline constexpr double k_outlier_share = 0.002;  // of the channels

inline void expect_golden(const Image& image, const char* name) {
  const std::filesystem::path golden = std::filesystem::path(TOPPLE_GOLDEN_DIR) / name;
  const std::filesystem::path actual = std::filesystem::path(TOPPLE_GOLDEN_OUT) / name;
  const auto keep = [&] {
    std::filesystem::create_directories(actual.parent_path());
    write_png(actual, image);
  };
  if (std::getenv("TOPPLE_NEW_GOLDEN")) {
    write_png(golden, image);
    return;
  }
  if (!std::filesystem::exists(golden)) {
    keep();
    FAIL() << golden << " is missing; look at " << actual;
  }
  const Image wanted = read_png(golden);
  ASSERT_EQ(wanted.width, image.width);
  ASSERT_EQ(wanted.height, image.height);
  double sum = 0;
  std::size_t outliers = 0;
  for (std::size_t i = 0; i < image.rgba.size(); ++i) {
    const double step = std::abs(double{1} * image.rgba[i] - wanted.rgba[i]);
    sum += step;
    outliers += step > k_outlier_step;
  }
  const auto count = static_cast<double>(image.rgba.size());
  const bool same =
      sum / count <= k_mean_tolerance && static_cast<double>(outliers) / count <= k_outlier_share;
  if (!same) keep();
  EXPECT_TRUE(same) << name << ": mean difference " << sum / count << ", " << outliers
                    << " channels differ by more than " << k_outlier_step << "; see " << actual;
}

}  // namespace topple::render
