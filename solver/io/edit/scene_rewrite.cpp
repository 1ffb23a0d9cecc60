#include "solver/io/edit/scene_rewrite.h"

#include <utf8.h>

#include <algorithm>
#include <stdexcept>

#include "solver/io/document/scene_document.h"

namespace topple::io {
namespace {

const char* const k_origin = "scene";

/// Where something begins that was written at `place`, whose columns count letters.
std::size_t offset_of(const std::string& text, const Place& place) {
  std::size_t at = 0;
  for (int line = 1; line < place.line; ++line) {
    at = text.find('\n', at);
    if (at == std::string::npos) throw std::logic_error("a place beyond the text");
    ++at;
  }
  auto letter = text.begin() + static_cast<std::ptrdiff_t>(at);
  for (int column = 1; column < place.column && letter != text.end(); ++column)
    utf8::next(letter, text.end());
  return static_cast<std::size_t>(letter - text.begin());
}

std::size_t end_of_text(const std::string& text, std::size_t at) {
  const char quote = text[at];
  const std::string three(3, quote);
  const std::string closing = text.compare(at, 3, three) == 0 ? three : std::string(1, quote);
  for (at += closing.size(); at < text.size(); ++at) {
    if (quote == '"' && text[at] == '\\')
      ++at;
    else if (text.compare(at, closing.size(), closing) == 0)
      return at + closing.size();
  }
  return at;
}

/// Behind the value that begins at `at`.
std::size_t end_of_value(const std::string& text, std::size_t at) {
  int depth = 0;
  while (at < text.size()) {
    const char c = text[at];
    if (c == '"' || c == '\'') {
      at = end_of_text(text, at);
      if (depth == 0) return at;
      continue;
    }
    if (c == '#') {
      if (depth == 0) return at;
      at = std::min(text.find('\n', at), text.size());
      continue;
    }
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') {
      if (depth == 0) return at;
      if (--depth == 0) return at + 1;
    }
    const bool bare_ends = c == ',' || c == '\n' || c == '\r' || c == ' ' || c == '\t';
    if (depth == 0 && bare_ends) return at;
    ++at;
  }
  return at;
}

std::size_t line_begin(const std::string& text, std::size_t at) {
  const std::size_t before = at == 0 ? std::string::npos : text.rfind('\n', at - 1);
  return before == std::string::npos ? 0 : before + 1;
}

std::size_t line_end(const std::string& text, std::size_t at) {
  const std::size_t end = text.find('\n', at);
  return end == std::string::npos ? text.size() : end + 1;
}

Node value_of(const std::string& toml) {
  return std::move(parse_toml("value = " + toml, k_origin).items.at(0).value);
}

std::size_t number_of(const std::string& label) {
  return static_cast<std::size_t>(std::stoul(label)) - 1;
}

/// A list that loses its last entry goes with it.
KeyChange normal(const Node& root, KeyChange change) {
  const Node* at = &root;
  for (std::size_t k = 0; at && k + 1 < change.path.size(); ++k)
    at = at->kind == Node::Kind::table                  ? at->find(change.path[k])
         : number_of(change.path[k]) < at->items.size() ? &at->items[number_of(change.path[k])].value
                                                        : nullptr;
  if (!change.value && at && at->kind == Node::Kind::list && at->items.size() == 1) change.path.pop_back();
  return change;
}

/// The change made in the tree: what the text has to mean afterwards.
void change_tree(Node& root, const KeyChange& change) {
  Node* at = &root;
  for (std::size_t k = 0; k + 1 < change.path.size(); ++k) {
    const std::string& step = change.path[k];
    if (at->kind == Node::Kind::list) {
      if (number_of(step) == at->items.size()) at->items.push_back({});
      at = &at->items.at(number_of(step)).value;
      continue;
    }
    if (at->kind != Node::Kind::table) throw std::logic_error(step + ": has no keys");
    if (!at->find_item(step)) {
      at->items.push_back({step, {}, {}});
      if (change.path[k + 1] == "1") at->items.back().value.kind = Node::Kind::list;
    }
    at = &at->find_item(step)->value;
  }
  const std::string& key = change.path.back();
  if (at->kind == Node::Kind::list) {
    const std::size_t index = number_of(key);
    if (!change.value)
      at->items.erase(at->items.begin() + static_cast<std::ptrdiff_t>(index));
    else if (index == at->items.size())
      at->items.push_back({{}, {}, value_of(*change.value)});
    else
      at->items.at(index).value = value_of(*change.value);
  } else if (!change.value) {
    std::erase_if(at->items, [&](const Item& item) { return item.key == key; });
  } else if (Item* const item = at->find_item(key)) {
    item->value = value_of(*change.value);
  } else {
    at->items.push_back({key, {}, value_of(*change.value)});
  }
}

bool same(const Node& a, const Node& b) {
  if (a.kind != b.kind || a.items.size() != b.items.size() || a.boolean != b.boolean ||
      a.integer != b.integer || a.real != b.real || a.text != b.text)
    return false;
  for (std::size_t i = 0; i < a.items.size(); ++i) {
    const Node* const other = a.kind == Node::Kind::table ? b.find(a.items[i].key) : &b.items[i].value;
    if (!other || !same(a.items[i].value, *other)) return false;
  }
  return true;
}

/// The table or list that holds what changes; null: it does not stand in the text.
const Node* holder(const Node& root, const KeyChange& change) {
  const Node* at = &root;
  for (std::size_t k = 0; at && k + 1 < change.path.size(); ++k) {
    if (at->kind == Node::Kind::list)
      at = number_of(change.path[k]) < at->items.size() ? &at->items[number_of(change.path[k])].value
                                                        : nullptr;
    else
      at = at->find(change.path[k]);
  }
  return at;
}

std::string line_of(const KeyChange& change) {
  return change.path.back() + " = " + *change.value + "\n";
}

/// In a new table at the end.
void append_table(std::string& text, const KeyChange& change) {
  const bool entry = change.path.size() == 3;
  if (!text.empty() && text.back() != '\n') text += '\n';
  text += (entry ? "\n[[" : "\n[") + change.path[0] + (entry ? "]]\n" : "]\n") + line_of(change);
}

/// Behind the last key that stands on a line of the table's own, else behind its header.
void insert_line(std::string& text, const Node& table, const KeyChange& change) {
  std::size_t at = 0;
  for (const Item& item : table.items) {
    const std::size_t key = offset_of(text, item.key_place), value = offset_of(text, item.value.place);
    const bool own =
        text.compare(key, item.key.size(), item.key) == 0 && value > key && text.find('=', key) < value;
    if (own) at = std::max(at, line_end(text, end_of_value(text, value)));
  }
  if (at == 0) at = line_end(text, offset_of(text, table.place));
  if (at > 0 && text[at - 1] != '\n') text.insert(at++, "\n");
  text.insert(at, line_of(change));
}

bool is_inline(const std::string& text, const Node& table) {
  return text[offset_of(text, table.place)] == '{';
}

/// Whether the entries of the list have headers of their own.
bool has_headers(const std::string& text, const Node& list) {
  return !list.items.empty() && list.items.front().value.kind == Node::Kind::table &&
         !is_inline(text, list.items.front().value);
}

/// Behind the last line of what stands in an entry that has a header.
std::size_t end_of_entry(const std::string& text, const Node& table) {
  std::size_t end = line_end(text, offset_of(text, table.place));
  for (const Item& item : table.items) {
    const Node& value = item.value;
    const std::size_t begin = offset_of(text, value.place);
    const bool headers = value.kind == Node::Kind::table ? !is_inline(text, value) : has_headers(text, value);
    if (!headers)
      end = std::max(end, line_end(text, end_of_value(text, begin)));
    else if (value.kind == Node::Kind::table)
      end = std::max(end, end_of_entry(text, value));
    else
      for (const Item& entry : value.items) end = std::max(end, end_of_entry(text, entry.value));
  }
  return end;
}

/// A [[table]] with all keys of `value`, behind the last entry of `list`; null: at the end.
void insert_entry(std::string& text, const std::string& name, const Node* list, const std::string& value) {
  std::string lines = "[[" + name + "]]\n";
  for (const Item& item : value_of(value).items) lines += item.key + " = " + written_value(item.value) + "\n";
  std::size_t at = list ? end_of_entry(text, list->items.back().value) : text.size();
  if (at > 0 && text[at - 1] != '\n') text.insert(at++, "\n");
  text.insert(at, at > 0 ? "\n" + lines : lines);
}

/// `words` behind the last item of what is written between brackets or braces, or as the only one.
void insert_inline(std::string& text, const Node& holder, const std::string& words) {
  if (holder.items.empty())
    text.insert(offset_of(text, holder.place) + 1, words);
  else
    text.insert(end_of_value(text, offset_of(text, holder.items.back().value.place)), ", " + words);
}

/// Takes out what stands from `begin` to `end` between brackets or braces, and a comma beside it.
void erase_inline(std::string& text, std::size_t begin, std::size_t end) {
  const std::size_t next = text.find_first_not_of(" \t\r\n", end);
  if (next != std::string::npos && text[next] == ',') {
    end = std::min(text.find_first_not_of(" \t", next + 1), text.size());
  } else if (const std::size_t before = text.find_last_not_of(" \t\r\n", begin - 1);
             before != std::string::npos && text[before] == ',') {
    begin = before;
  }
  text.erase(begin, end - begin);
  const std::size_t from = line_begin(text, begin), to = line_end(text, begin);
  if (to < text.size() && text.find_first_not_of(" \t\r\n", from) >= to) text.erase(from, to - from);
}

/// Takes out the lines from that of `begin` to `end`, and an empty one behind them where one is before them.
void erase_lines(std::string& text, std::size_t begin, std::size_t end) {
  const std::size_t from = line_begin(text, begin);
  const bool after_gap = from < 2 || text[from - 2] == '\n';
  if (after_gap && end < text.size() && text[end] == '\n') ++end;
  text.erase(from, end - from);
}

/// An entry of a list is taken out, replaced or added.
void change_entry(std::string& text, const Node& list, const KeyChange& change) {
  const std::size_t index = number_of(change.path.back());
  const bool headers = has_headers(text, list);
  if (index == list.items.size()) {
    headers ? insert_entry(text, change.path[change.path.size() - 2], &list, *change.value)
            : insert_inline(text, list, *change.value);
    return;
  }
  const Node& entry = list.items.at(index).value;
  const std::size_t begin = offset_of(text, entry.place);
  if (change.value) {
    text.replace(begin, end_of_value(text, begin) - begin, *change.value);
  } else if (headers) {
    erase_lines(text, begin, end_of_entry(text, entry));
  } else {
    erase_inline(text, begin, end_of_value(text, begin));
  }
}

/// Makes the change in the text, for the forms in which scenes are usually written.
void change_text(std::string& text, const KeyChange& change) {
  const Node root = parse_toml(text, k_origin);
  const Node* const table = holder(root, change);
  if (table && table->kind == Node::Kind::list) return change_entry(text, *table, change);
  const std::string& key = change.path.back();
  if (!table && change.value && change.path.size() == 2 && key == "1")
    return insert_entry(text, change.path[0], nullptr, *change.value);
  const Item* const item = table ? table->find_item(key) : nullptr;
  const bool within = table && table != &root && is_inline(text, *table);
  if (item && item->value.kind == Node::Kind::list && has_headers(text, item->value) && !change.value) {
    KeyChange entry = change;
    entry.path.push_back("1");
    return change_entry(text, item->value, entry);  // it has one (normal)
  }
  if (item && item->value.kind == Node::Kind::table && !is_inline(text, item->value) && !change.value)
    return erase_lines(text, offset_of(text, item->value.place), end_of_entry(text, item->value));
  if (item) {
    const std::size_t begin = offset_of(text, item->value.place), end = end_of_value(text, begin);
    if (change.value) {
      text.replace(begin, end - begin, *change.value);
    } else if (within) {
      erase_inline(text, offset_of(text, item->key_place), end);
    } else {
      const std::size_t from = line_begin(text, offset_of(text, item->key_place));
      text.erase(from, line_end(text, end) - from);
    }
  } else if (change.value && within) {
    insert_inline(text, *table, key + " = " + *change.value);
  } else if (change.value) {
    table ? insert_line(text, *table, change) : append_table(text, change);
  }
}

}  // namespace

std::string rewrite_toml(const std::string& text, const std::vector<KeyChange>& changes) {
  Node wanted = parse_toml(text, k_origin);
  std::vector<KeyChange> all;
  for (const KeyChange& change : changes) {
    all.push_back(normal(wanted, change));
    change_tree(wanted, all.back());
  }
  std::string result = text;
  try {
    for (const KeyChange& change : all) change_text(result, change);
    if (same(parse_toml(result, k_origin), wanted)) return result;
  } catch (const std::exception&) {  // written in another form
  }
  return write_toml(wanted);
}

}  // namespace topple::io
