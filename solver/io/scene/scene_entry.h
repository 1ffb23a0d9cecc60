// A table of a checked scene, read key by key with the defaults of the table of keys.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "solver/io/document/scene_document.h"
#include "solver/math/ranges.h"
#include "solver/math/types.h"

namespace topple::io {

/// A table that passed check_scene(), or one that is absent. Values are in SI.
class Entry {
 public:
  /// `node` may be null; `place` is blamed for what has no place of its own.
  Entry(const std::string& origin, std::string_view table, std::string path, const Node* node,
        const Place& place)
      : origin_(origin), table_(table), path_(std::move(path)), node_(node), place_(place) {}

  bool present() const { return node_ != nullptr; }
  bool has(std::string_view key) const { return find(key) != nullptr; }
  double number(std::string_view key) const;
  int integer(std::string_view key) const;
  bool flag(std::string_view key) const;
  std::string text(std::string_view key) const;
  std::vector<std::string> texts(std::string_view key) const;
  /// The word of a choice.
  std::string_view word(std::string_view key) const;
  /// What it stands for in `table` (model/table.h), the words of which are the key's choices.
  template <class Table>
  auto chosen(std::string_view key, const Table& table) const {
    return ranges::find(table, word(key), [](const auto& row) { return std::string_view(row.word); })->kind;
  }
  /// True when the key holds a word of its choices (or its default is one) instead of numbers.
  bool is_word(std::string_view key) const;
  /// Among the words of a list.
  bool names(std::string_view key, std::string_view word) const;
  std::vector<double> numbers(std::string_view key) const;
  Vec3 vector(std::string_view key) const;
  /// The vector as a unit vector; a zero vector is an error.
  Vec3 direction(std::string_view key) const;
  std::vector<Vec3> vectors(std::string_view key) const;
  std::vector<int> integers(std::string_view key) const;
  std::vector<std::pair<double, double>> history(std::string_view key) const;
  /// The entries of a list of tables, or the table itself.
  std::vector<Entry> entries(std::string_view key) const;
  Entry entry(std::string_view key) const;
  /// `node`, of another table, under the path of this one, which is blamed for what `node` does not have.
  Entry as(std::string_view table, const Node& node) const { return {origin_, table, path_, &node, place_}; }
  /// Its name, or "cabinet-2" when it has none.
  const std::string& name() const { return name_; }
  const std::string& path() const { return path_; }
  const Place& place() const { return place_; }
  const Node* node() const { return node_; }

  /// Blames a value, the key's absence, or with `part` an entry of a list. Throws InputError.
  [[noreturn]] void fail(std::string_view key, const std::string& message, int part = -1) const;
  /// How an error line on `key` begins: "s.toml:9:9: expect.tip.value: ".
  std::string where(std::string_view key) const;
  [[noreturn]] void fail(const std::string& message) const { io::fail(origin_, place_, path_, message); }

 private:
  const Node* find(std::string_view key) const { return node_ ? node_->find(key) : nullptr; }

  std::string origin_;
  std::string table_;
  std::string path_;
  std::string name_;
  const Node* node_;
  Place place_;
};

}  // namespace topple::io
