// Builds the rows of the table of keys; each call adds one.
#pragma once

#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include "solver/io/scene/scene_key.h"
#include "solver/math/types.h"
#include "solver/model/table.h"

namespace topple::io {

using Words = std::vector<std::string_view>;

/// A row just added: what it says besides its type and range.
class Row {
 public:
  explicit Row(Key& key) : key_(key) {}
  Row& required() { return key_.required = true, *this; }
  /// Default: values in SI.
  Row& absent(std::vector<double> values) { return key_.fallback = std::move(values), *this; }
  Row& absent(double value) { return absent(std::vector<double>{value}); }
  Row& absent(const Vec3& v) { return absent(std::vector<double>{v.x(), v.y(), v.z()}); }
  Row& absent_means(std::string_view text) { return key_.otherwise = text, *this; }
  /// Belongs to these choices of another key of the table.
  Row& only(std::string_view of, Words when) { return key_.of = of, key_.when = std::move(when), *this; }
  /// Belongs to these choices of run.analysis.
  Row& only_in(Words analyses) { return key_.analyses = std::move(analyses), *this; }
  /// Words that may stand instead of the numbers.
  Row& or_word(Words words) { return key_.choices = std::move(words), *this; }
  /// The list may be shorter: its last numbers may be left out.
  Row& at_least(int count) { return key_.least_count = count, *this; }
  /// One number is enough, also outside of a list.
  Row& or_one() { return key_.least_count = 1, *this; }

 private:
  Key& key_;
};

/// Adds rows to one table of the scene.
class Rows {
 public:
  Rows(std::vector<Key>& keys, std::string_view table) : keys_(keys), table_(table) {}

  Row number(std::string_view name, double least, double most, std::string_view about) {
    return number(name, Dimension::none, {}, least, most, about);
  }
  Row number(std::string_view name, Dimension dimension, std::string_view unit, double least, double most,
             std::string_view about) {
    return add(name, KeyType::number, about, dimension, unit, least, most);
  }
  Row integer(std::string_view name, double least, double most, std::string_view about) {
    return add(name, KeyType::integer, about, Dimension::none, {}, least, most);
  }
  Row integers(std::string_view name, int count, double least, double most, std::string_view about) {
    return add(name, KeyType::integers, about, Dimension::none, {}, least, most, count);
  }
  Row numbers(std::string_view name, int count, double least, double most, std::string_view about) {
    return numbers(name, count, Dimension::none, {}, least, most, about);
  }
  Row numbers(std::string_view name, int count, Dimension dimension, std::string_view unit, double least,
              double most, std::string_view about) {
    return add(name, KeyType::numbers, about, dimension, unit, least, most, count);
  }
  Row vectors(std::string_view name, Dimension dimension, std::string_view unit, double least, double most,
              std::string_view about) {
    return add(name, KeyType::vectors, about, dimension, unit, least, most);
  }
  Row history(std::string_view name, double least, double most, std::string_view about) {
    return add(name, KeyType::history, about, Dimension::none, {}, least, most);
  }
  Row texts(std::string_view name, int most, std::string_view about) {
    return add(name, KeyType::texts, about, Dimension::none, {}, -std::numeric_limits<double>::infinity(),
               std::numeric_limits<double>::infinity(), most);
  }
  Row word(std::string_view name, Words choices, std::string_view about) {
    return plain(name, KeyType::choice, about).or_word(std::move(choices));
  }
  /// One of the words of a table (model/table.h); `absent`: the default.
  template <class Table, class Kind>
  Row word(std::string_view name, const Table& table, Kind absent, std::string_view about) {
    Row row = word(name, words_of(table), about);
    for (const auto& one : table) keys_.back().numbers.push_back(static_cast<int>(one.kind));
    return row.absent(place_of(table, absent));
  }
  Row words(std::string_view name, Words choices, std::string_view about) {
    return plain(name, KeyType::choices, about).or_word(std::move(choices));
  }
  /// Text, true or false, tables.
  Row plain(std::string_view name, KeyType type, std::string_view about) {
    Key& key = keys_.emplace_back();
    key.table = table_;
    key.name = name;
    key.type = type;
    key.about = about;
    return Row(key);
  }

 private:
  Row add(std::string_view name, KeyType type, std::string_view about, Dimension dimension,
          std::string_view unit, double least, double most, int count = 0) {
    const Row row = plain(name, type, about);
    Key& key = keys_.back();
    key.dimension = dimension;
    key.unit = unit;
    key.least = least;
    key.most = most;
    key.count = count;
    return row;
  }

  std::vector<Key>& keys_;
  std::string_view table_;
};

/// [[cabinet]], [[frame]] and its parts, [[block]], [[furniture]] and its kinds.
void add_body_keys(std::vector<Key>& keys);

/// [[anchor]], [ceiling], [[fixing]].
void add_fitting_keys(std::vector<Key>& keys);

/// [[door]] and [[place]].
void add_room_keys(std::vector<Key>& keys);

}  // namespace topple::io
