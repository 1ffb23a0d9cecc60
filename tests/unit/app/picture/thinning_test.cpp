#include "app/picture/thinning.h"

#include <gtest/gtest.h>

namespace topple::app {
namespace {

TEST(Thinning, every_second_instant_of_the_older_half_goes_and_the_first_stays) {
  std::vector<int> instants{0, 1, 2, 3, 4, 5, 6, 7, 8};
  thin_older_half(instants);
  EXPECT_EQ(instants, (std::vector{0, 2, 4, 5, 6, 7, 8}));
  std::vector<int> few{0, 1, 2};
  thin_older_half(few);
  EXPECT_EQ(few, (std::vector{0, 2}));
  std::vector<int> pairs{0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6, 6, 7, 7, 8, 8};
  thin_older_half(pairs, 2);
  EXPECT_EQ(pairs, (std::vector{0, 0, 2, 2, 4, 4, 5, 5, 6, 6, 7, 7, 8, 8}));
}

}  // namespace
}  // namespace topple::app
