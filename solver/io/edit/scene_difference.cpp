#include "solver/io/edit/scene_difference.h"

#include <utf8.h>

#include <algorithm>

#include "solver/io/common/digits.h"
#include "solver/io/document/scene_document.h"
#include "solver/io/edit/scene_number.h"
#include "solver/io/scene/scene_keys.h"
#include "solver/math/ranges.h"

namespace topple::io {
namespace {

constexpr std::size_t k_longest = 60;  // letters of a value that is shown

/// A value as it is compared and as it is shown.
struct Value {
  std::string exact, shown;
};

Value quantity(const Key* key, double si) {
  return {shortest_digits(si), key ? value_text(*key, si) : short_number(si)};
}

bool has_quantities(const Key* key) {
  return key && (key->type == KeyType::number || key->type == KeyType::numbers ||
                 key->type == KeyType::vectors || key->type == KeyType::history);
}

Value value_of(const Node& node, const Key* key) {
  if (node.is_number()) return quantity(has_quantities(key) ? key : nullptr, node.real);
  if (node.kind == Node::Kind::boolean)
    return {node.boolean ? "true" : "false", node.boolean ? "true" : "false"};
  if (node.kind == Node::Kind::text) {
    if (has_quantities(key))
      if (const Quantity read = parse_quantity(node.text, key->dimension); read.si)
        return quantity(key, *read.si);
    return {'"' + node.text + '"', node.text};
  }
  if (node.kind == Node::Kind::date) return {shown(node), shown(node)};
  Value out{"[", "["};
  for (const Item& item : node.items) {
    const Value part = value_of(item.value, key);
    const std::string name = item.key.empty() ? "" : item.key + " = ";
    out.exact += name + part.exact + ", ";
    out.shown += (out.shown.size() > 1 ? ", " : "") + name + part.shown;
  }
  return {out.exact + "]", out.shown + "]"};
}

/// What a key means that the scene leaves out, where that is a value.
std::optional<Value> fallback(const Scene& scene, const Key* key) {
  if (!key || key->fallback.empty()) return std::nullopt;
  const double first = key->fallback.front();
  if (is_step_chosen(scene, *key)) return Value{"\"auto\"", "auto"};
  switch (key->type) {
    case KeyType::number:
    case KeyType::integer:
      return quantity(key, *value_left_out(scene, *key));
    case KeyType::boolean:
      return Value{first != 0 ? "true" : "false", first != 0 ? "true" : "false"};
    case KeyType::choice: {
      const std::string word(key->choices[static_cast<std::size_t>(first)]);
      return Value{'"' + word + '"', word};
    }
    case KeyType::numbers: {
      Value out{"[", default_text(*key)};
      for (const double x : key->fallback) out.exact += shortest_digits(x) + ", ";
      return Value{out.exact + "]", out.shown};
    }
    default:
      return std::nullopt;
  }
}

std::string cut(const std::string& text) {
  if (text.size() <= k_longest) return text;
  const auto end = utf8::find_invalid(text.begin(), text.begin() + k_longest);  // no letter is split
  return std::string(text.begin(), end) + "…";
}

class Comparison {
 public:
  Comparison(const Scene& a, const Scene& b) : a_(a), b_(b) {}

  std::vector<SceneDifference> found;

  void tables(const Node* a, const Node* b, const std::string& path, const std::string& table) {
    for (const Node* side : {a, b}) {
      if (!side) continue;
      for (const Item& item : side->items) {
        if (side == b && a && a->find(item.key)) continue;
        const Node* const of_a = a ? a->find(item.key) : nullptr;
        const Node* const of_b = b ? b->find(item.key) : nullptr;
        const std::string key = path.empty() ? item.key : path + "." + item.key;
        item_of(of_a, of_b, key, table, item.key);
      }
    }
  }

  // Where both leave it out, it may still differ: it follows from the furniture.
  void chosen(const char* name, double ContactLaw::*number) {
    const Key& key = *find_key("contact", name);
    const std::string path = std::string("contact.") + name;
    const double left = a_.setup.parameters.contact.*number, right = b_.setup.parameters.contact.*number;
    if (left == right || ranges::find(found, path, &SceneDifference::key) != found.end()) return;
    found.push_back({path, value_text(key, left), value_text(key, right)});
  }

 private:
  static bool is_table(const Node* node) { return node && node->kind == Node::Kind::table; }
  static bool is_entries(const Node* node) {
    return node && node->kind == Node::Kind::list && !node->items.empty() &&
           node->items.front().value.kind == Node::Kind::table;
  }

  void item_of(const Node* a, const Node* b, const std::string& path, const std::string& table,
               const std::string& name) {
    const std::string inner = table.empty() ? name : table + "." + name;
    if (is_entries(a) || is_entries(b)) return entries(a, b, path, inner);
    if ((is_table(a) || !a) && (is_table(b) || !b)) return tables(a, b, path, inner);
    const Key* const key = find_key(table, name);
    const auto value = [&](const Scene& scene, const Node* node) {
      return node ? std::optional(value_of(*node, key)) : fallback(scene, key);
    };
    const std::optional<Value> left = value(a_, a), right = value(b_, b);
    if (left && right && left->exact == right->exact) return;
    const auto text = [](const std::optional<Value>& v) {
      return v ? std::optional(cut(v->shown)) : std::nullopt;
    };
    found.push_back({path, text(left), text(right)});
  }

  static const Node* entry(const Node* list, const std::string& label) {
    for (std::size_t i = 0; list && i < list->items.size(); ++i)
      if (entry_label(*list, i) == label) return &list->items[i].value;
    return nullptr;
  }

  void entries(const Node* a, const Node* b, const std::string& path, const std::string& table) {
    for (const Node* side : {a, b})
      for (std::size_t i = 0; side && i < side->items.size(); ++i) {
        const std::string label = entry_label(*side, i);
        const Node *const of_a = entry(a, label), *const of_b = entry(b, label);
        if (side == b && of_a) continue;
        if (of_a && of_b)
          tables(of_a, of_b, path + "." + label, table);
        else
          found.push_back({path + "." + label, of_a ? std::optional<std::string>("present") : std::nullopt,
                           of_b ? std::optional<std::string>("present") : std::nullopt});
      }
  }

  const Scene &a_, &b_;
};

// What was changed is told by its own key.
Node as_titled(const Scene& scene) {
  Node root = parse_toml(scene.text, scene.name);
  Item* const title = root.find_item("title");
  if (title && title->value.text.ends_with(k_title_changed))
    title->value.text.erase(title->value.text.size() - k_title_changed.size());
  return root;
}

}  // namespace

std::vector<SceneDifference> differences(const Scene& a, const Scene& b) {
  const Node left = as_titled(a), right = as_titled(b);
  Comparison comparison(a, b);
  comparison.tables(&left, &right, "", "");
  comparison.chosen("alpha", &ContactLaw::alpha);
  if (a.setup.model.bodies.size() > 1 || b.setup.model.bodies.size() > 1)
    comparison.chosen("member_share", &ContactLaw::member_share);
  return std::move(comparison.found);
}

}  // namespace topple::io
