// A TOML text as a tree in which every key and value knows where it was written.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "solver/io/common/errors.h"

namespace topple::io {

/// Where a key or value was written: a line and column from 1, or an override.
struct Place {
  int line = 0;
  int column = 0;
  std::shared_ptr<const std::string> override_text;  ///< "contact.friction=9"; null: in the file
  std::shared_ptr<const std::string> file = {};      ///< null: the scene's own
};

/// Entry of an array by which people know what was made of it, such as the cabinet of a [[furniture]].
struct SourceEntry {
  std::string table;   ///< "furniture"
  std::size_t number;  ///< from 1
  std::string path;    ///< "furniture.bookshelf": what errors call it
};

struct Item;

/// A TOML value.
struct Node {
  enum class Kind { boolean, integer, real, text, date, list, table };
  Kind kind = Kind::table;
  Place place;
  bool boolean = false;
  std::int64_t integer = 0;
  double real = 0;  ///< of an integer too
  std::string text;
  std::vector<Item> items;                         ///< of a list or a table, in the order written
  std::shared_ptr<const SourceEntry> source = {};  ///< of an entry that was not written as one of its list

  /// The value of a key of a table; null when absent.
  const Node* find(std::string_view key) const;
  const Item* find_item(std::string_view key) const;
  Item* find_item(std::string_view key);
  bool is_number() const { return kind == Kind::integer || kind == Kind::real; }
};

/// An entry of a table, or of a list (then without key).
struct Item {
  std::string key;
  Place key_place;
  Node value;
};

/// Of a tree, made rather than written: all of it says that it was written at `place`.
Node number_node(double value, const Place& place);
Node text_node(const std::string& text, const Place& place);
Node list_node(std::vector<Node> values, const Place& place);
Node numbers_node(std::initializer_list<double> values, const Place& place);
/// The key of a table becomes `value`, in its place or behind the last.
void set_key(Node& table, std::string_view key, Node value);
/// Everything in the tree was written at `place`.
void set_place(Node& node, const Place& place);

/// "ORIGIN:L:C: PATH: MESSAGE" or "--set KEY=VALUE: PATH: MESSAGE", always one line.
std::string error_line(const std::string& origin, const Place& place, const std::string& path,
                       const std::string& message);

/// What is wrong at a place of the scene; what() is the error_line().
struct SceneError : InputError {
  SceneError(const std::string& origin, Place at, std::string key_path, std::string text)
      : InputError(error_line(origin, at, key_path, text)),
        place(std::move(at)),
        path(std::move(key_path)),
        message(std::move(text)) {}
  Place place;
  std::string path, message;
};

/// Throws SceneError.
[[noreturn]] void fail(const std::string& origin, const Place& place, const std::string& path,
                       const std::string& message);

/// Parses TOML. Throws InputError at the place where it is broken.
Node parse_toml(std::string_view text, const std::string& origin);

/// Applies "KEY=VALUE". KEY is dotted; entries of arrays go by their name or number from 1. Creates absent
/// keys and the tables above them, but no entry of an array. Throws InputError, also for bytes that are not
/// UTF-8, which no scene can hold.
void apply_override(Node& root, const std::string& override_text);
/// What the title of a scene ends with whose values are no longer those it was written with.
inline constexpr std::string_view k_title_changed = " (changed)";
/// Applies what a person sets, and says so in the title, but for one that is set itself.
void change(Node& root, const std::vector<std::string>& overrides);

/// A text as a TOML basic string: escaped, with double quotes around it.
std::string written_text(std::string_view text);

/// A value as TOML, on one line.
std::string written_value(const Node& node);

/// TOML text of the tree; comments are lost, order is kept.
std::string write_toml(const Node& root);

/// What errors and overrides call entry `index` of an array: its name, else that of its kind, of further ones
/// of that kind with -2, -3, ..., else its number from 1.
std::string entry_label(const Node& list, std::size_t index);

/// Name of a kind of furniture: of a file without folder and extension.
std::string kind_stem(const std::string& kind);

/// What errors call that entry of the array `key`: "cabinet.free", or the entry that it was made of.
std::string entry_path(const Node& list, const std::string& key, std::size_t index);

/// "a table", "text", "a list": what was found.
std::string_view kind_name(Node::Kind kind);

/// The value as it would be written, on one line, shortened when long: "2.4", "\"30 mm\"".
std::string shown(const Node& node);

}  // namespace topple::io
