// Algorithms over whole ranges, with projections, as those of std::ranges: the standard library of emscripten
// (LLVM 13) has none of them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <iterator>
#include <utility>

namespace topple::ranges {

// Each does what std::ranges::NAME does with the same arguments, and returns iterators.

/// `compare` of what the projection makes of two elements.
template <class Compare, class Projection>
auto projected(Compare& compare, Projection& projection) {
  return [&](const auto& a, const auto& b) -> bool {
    return std::invoke(compare, std::invoke(projection, a), std::invoke(projection, b));
  };
}

template <class Range, class Predicate, class Projection = std::identity>
auto find_if(Range&& range, Predicate predicate, Projection projection = {}) {
  auto at = std::begin(range);
  for (; at != std::end(range); ++at)
    if (std::invoke(predicate, std::invoke(projection, *at))) break;
  return at;
}

template <class Range, class Value, class Projection = std::identity>
auto find(Range&& range, const Value& value, Projection projection = {}) {
  return find_if(
      range, [&](const auto& item) { return item == value; }, std::move(projection));
}

template <class Range, class Predicate, class Projection = std::identity>
bool any_of(Range&& range, Predicate predicate, Projection projection = {}) {
  return find_if(range, std::move(predicate), std::move(projection)) != std::end(range);
}

template <class Range, class Predicate, class Projection = std::identity>
bool none_of(Range&& range, Predicate predicate, Projection projection = {}) {
  return !any_of(range, std::move(predicate), std::move(projection));
}

template <class Range, class Predicate, class Projection = std::identity>
bool all_of(Range&& range, Predicate predicate, Projection projection = {}) {
  return none_of(range, std::not_fn(std::move(predicate)), std::move(projection));
}

template <class Range, class Predicate, class Projection = std::identity>
std::ptrdiff_t count_if(Range&& range, Predicate predicate, Projection projection = {}) {
  std::ptrdiff_t count = 0;
  for (const auto& item : range) count += std::invoke(predicate, std::invoke(projection, item)) ? 1 : 0;
  return count;
}

template <class Range, class Value>
std::ptrdiff_t count(Range&& range, const Value& value) {
  return std::count(std::begin(range), std::end(range), value);
}

template <class First, class Second, class Predicate = std::equal_to<>, class OfFirst = std::identity,
          class OfSecond = std::identity>
bool equal(First&& first, Second&& second, Predicate predicate = {}, OfFirst of_first = {},
           OfSecond of_second = {}) {
  return std::equal(std::begin(first), std::end(first), std::begin(second), std::end(second),
                    [&](const auto& a, const auto& b) {
                      return std::invoke(predicate, std::invoke(of_first, a), std::invoke(of_second, b));
                    });
}

template <class Range, class Compare = std::less<>, class Projection = std::identity>
void sort(Range&& range, Compare compare = {}, Projection projection = {}) {
  std::sort(std::begin(range), std::end(range), projected(compare, projection));
}

template <class Range, class Compare = std::less<>, class Projection = std::identity>
void stable_sort(Range&& range, Compare compare = {}, Projection projection = {}) {
  std::stable_sort(std::begin(range), std::end(range), projected(compare, projection));
}

template <class Range>
void reverse(Range&& range) {
  std::reverse(std::begin(range), std::end(range));
}

template <class Range, class Value>
void fill(Range&& range, const Value& value) {
  std::fill(std::begin(range), std::end(range), value);
}

template <class Range, class Value, class Compare = std::less<>, class Projection = std::identity>
bool binary_search(Range&& range, const Value& value, Compare compare = {}, Projection projection = {}) {
  const auto before = [&](const auto& item, const Value& of) {
    return std::invoke(compare, std::invoke(projection, item), of);
  };
  const auto at = std::lower_bound(std::begin(range), std::end(range), value, before);
  return at != std::end(range) && !std::invoke(compare, value, std::invoke(projection, *at));
}

template <class Range, class Compare = std::less<>, class Projection = std::identity>
auto min_element(Range&& range, Compare compare = {}, Projection projection = {}) {
  return std::min_element(std::begin(range), std::end(range), projected(compare, projection));
}

template <class Range, class Compare = std::less<>, class Projection = std::identity>
auto max_element(Range&& range, Compare compare = {}, Projection projection = {}) {
  return std::max_element(std::begin(range), std::end(range), projected(compare, projection));
}

template <class Range, class Compare = std::less<>, class Projection = std::identity>
auto minmax_element(Range&& range, Compare compare = {}, Projection projection = {}) {
  return std::minmax_element(std::begin(range), std::end(range), projected(compare, projection));
}

template <class Range, class Output, class Operation>
auto transform(Range&& range, Output output, Operation operation) {
  return std::transform(std::begin(range), std::end(range), output, std::move(operation));
}

template <class Range, class Output>
auto copy(Range&& range, Output output) {
  return std::copy(std::begin(range), std::end(range), output);
}

template <class Range, class Output, class Predicate>
auto copy_if(Range&& range, Output output, Predicate predicate) {
  return std::copy_if(std::begin(range), std::end(range), output, std::move(predicate));
}

}  // namespace topple::ranges
