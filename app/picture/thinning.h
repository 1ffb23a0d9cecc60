// Memory that a run may take however long it lasts.
#pragma once

#include <cstddef>
#include <vector>

#include "solver/io/recording/observer.h"

namespace topple::app {

/// Of the rows that can be shown, and of the states that a run can return to. Older ones are thinned out; a
/// recording keeps them all.
inline constexpr std::size_t k_most_row_bytes = std::size_t{512} << 20;
inline constexpr std::size_t k_most_point_bytes = std::size_t{16} << 20;

std::size_t memory_of(const io::FrameRow& row);

/// Leaves every second instant of the older half out, never the first. Items stand in the order of their age,
/// `each` to an instant.
template <typename Item>
void thin_older_half(std::vector<Item>& items, std::size_t each = 1) {
  const std::size_t older = (items.size() / each + 1) / 2;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < items.size(); ++i)
    if (const std::size_t instant = i / each; instant >= older || instant % 2 == 0) {
      if (kept != i) items[kept] = std::move(items[i]);
      ++kept;
    }
  items.erase(items.begin() + static_cast<std::ptrdiff_t>(kept), items.end());
}

}  // namespace topple::app
