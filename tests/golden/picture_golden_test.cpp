#include <algorithm>

#include "tests/golden/golden.h"
#include "tests/unit/render/off_screen.h"
#include "tests/unit/render/synthetic_cabinet.h"

namespace topple::render {
namespace {

constexpr int k_width = 960;
constexpr int k_height = 540;

SceneFrame tipped_cabinet() {
  SceneFrame frame = synthetic_cabinet(6);
  add_words(frame);
  return frame;
}

TEST(GoldenPicture, tipped_cabinet) {
  const SceneFrame frame = tipped_cabinet();
  Picture picture(off_screen(), k_width, k_height);
  expect_golden(picture.draw(frame, fit_camera(NamedView::iso, frame, picture.aspect())),
                "tipped-cabinet.png");
  EXPECT_EQ(picture.left_out().total(), 0);
}

// Beside the stored picture: the mirror image of a symmetric cabinet's silhouette is itself.
TEST(GoldenPicture, front_of_a_cabinet_that_is_symmetric_about_its_middle_plane_is_its_own_mirror_image) {
  SceneFrame frame = synthetic_cabinet(0);
  frame.grounds.clear();
  Picture picture(off_screen(), k_width, k_height);
  const Camera camera = fit_camera(NamedView::front, frame, picture.aspect());
  const Image bodies = picture.draw(frame, camera);
  const Image empty = picture.draw(SceneFrame(), camera);
  const auto differs = [&](int x, int y) {
    const auto a = colour_at(bodies, {x, y});
    const auto b = colour_at(empty, {x, y});
    return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]) > 120;
  };
  int covered = 0;
  int unmatched = 0;
  for (int y = 0; y < k_height; ++y) {
    for (int x = 0; x < k_width; ++x) {
      if (!differs(x, y)) continue;
      ++covered;
      bool found = false;  // a pixel of room: sample positions are not symmetric
      for (int dx = -1; dx <= 1; ++dx) {
        for (int dy = -1; dy <= 1; ++dy) {
          found = found || differs(std::clamp(k_width - 1 - x + dx, 0, k_width - 1),
                                   std::clamp(y + dy, 0, k_height - 1));
        }
      }
      unmatched += !found;
    }
  }
  EXPECT_GT(covered, 5000);
  EXPECT_EQ(unmatched, 0);
}

}  // namespace
}  // namespace topple::render
