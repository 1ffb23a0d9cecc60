// Tables of traits: what comes in kinds (contact laws, pulse shapes, schemes, ...) has one row per kind, with
// a member `kind`, and where scenes name it a member `word`. The order of rows is that of lists and charts
// and means nothing else.
#pragma once

#include <cstddef>
#include <iterator>
#include <string_view>
#include <vector>

namespace topple {

/// Index of the row of `kind`, which has one.
template <class Table, class Kind>
constexpr int place_of(const Table& table, Kind kind) {
  int place = 0;
  while (std::begin(table)[place].kind != kind) ++place;
  return place;
}

/// The row of `kind`, which has one.
template <class Table, class Kind>
constexpr const auto& row_of(const Table& table, Kind kind) {
  return std::begin(table)[place_of(table, kind)];
}

/// The words of a table, in its order.
template <class Table>
std::vector<std::string_view> words_of(const Table& table) {
  std::vector<std::string_view> words;
  for (const auto& row : table) words.push_back(row.word);
  return words;
}

}  // namespace topple
