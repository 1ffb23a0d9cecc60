#include "solver/io/edit_text.h"

#include <charconv>
#include <cmath>

#include "solver/io/scene.h"

namespace topple::io {
namespace {

struct Name {
  Edit::Key key;
  const char *table, *name;
};

// In the order of Edit::Key.
constexpr Name k_names[] = {
    {Edit::Key::frequency, "shake", "frequency"}, {Edit::Key::amplitude, "shake", "amplitude"},
    {Edit::Key::direction, "shake", "direction"}, {Edit::Key::scale, "shake", "scale"},
    {Edit::Key::alpha, "contact", "alpha"},       {Edit::Key::q, "contact", "q"},
    {Edit::Key::friction, "contact", "friction"}, {Edit::Key::restitution, "contact", "restitution"},
    {Edit::Key::anchor, "anchor", "on"},          {Edit::Key::time_step, "run", "time_step"},
};

bool of_shake(Edit::Key key) {
  return key_of(key).table == "shake";
}

bool is_numbered(Edit::Key key) {
  return of_shake(key) || key == Edit::Key::anchor;
}

[[noreturn]] void fail(const Edit& edit, const std::string& message) {
  throw InputError(edit_key(edit) + ": " + message);
}

/// Refuses the key of a choice that was not made; `chosen`: which of the choices of `key.of` was. `when`: the
/// choices whose value can be edited.
template <typename Choice>
void expect_choice(const Edit& edit, Choice chosen, const std::vector<std::string_view>& when) {
  const Key& key = key_of(edit.key);
  const Key& choice = *find_key(key.table, key.of);
  const std::string_view word = choice.choices[static_cast<std::size_t>(chosen)];
  std::string words;
  for (const std::string_view other : when) {
    if (other == word) return;
    words += (words.empty() ? "" : " or ") + std::string(other);
  }
  const std::string of(key.of);
  fail(edit, "belongs to " + of + " = " + words + ", but " + of + " is " + std::string(word));
}

}  // namespace

const Key& key_of(Edit::Key key) {
  const Name& name = k_names[static_cast<std::size_t>(key)];
  return *find_key(name.table, name.name);
}

std::string edit_key(const Edit& edit) {
  const Name& name = k_names[static_cast<std::size_t>(edit.key)];
  const std::string number = is_numbered(edit.key) ? std::to_string(edit.shake + 1) + "." : "";
  return std::string(name.table) + "." + number + name.name;
}

std::optional<Edit> parse_edit_key(std::string_view text) {
  const std::size_t dot = text.find('.');
  int number = 1;
  if (dot != std::string_view::npos)
    std::from_chars(text.data() + dot + 1, text.data() + text.size(), number);
  for (const Name& name : k_names) {
    const Edit edit{.key = name.key, .shake = is_numbered(name.key) ? number - 1 : 0};
    if (edit.shake >= 0 && edit_key(edit) == text) return edit;
  }
  return std::nullopt;
}

void check_edit_value(const Edit& edit) {
  const Key& key = key_of(edit.key);
  const int count = edit.key == Edit::Key::direction ? key.count : 1;
  for (int i = 0; i < count; ++i) {
    const double value = edit.value[i];
    if (!std::isfinite(value)) fail(edit, short_number(value) + " is not a finite number");
    // conversion of units may round the end of a range outwards
    constexpr double slack = 1e-12;
    if (value < key.least - slack * std::abs(key.least) || value > key.most + slack * std::abs(key.most))
      fail(edit, value_text(key, value) + " is outside " + range_text(key));
  }
  if (key.type == KeyType::boolean && edit.value.x() != 0 && edit.value.x() != 1)
    fail(edit, short_number(edit.value.x()) + " is neither 0 nor 1");
  if (edit.key == Edit::Key::direction && !(edit.value.stableNorm() > 0))
    fail(edit, "a zero vector has no direction");
}

void check_edit(const Edit& edit, const Setup& setup) {
  const std::vector<Shake>& shakes = setup.parameters.shakes;
  if (of_shake(edit.key) && (edit.shake < 0 || edit.shake >= static_cast<int>(shakes.size())))
    fail(edit, "there is no such shake; the scene has " + std::to_string(shakes.size()));
  const std::vector<Anchor>& anchors = setup.model.anchors;
  if (edit.key == Edit::Key::anchor && (edit.shake < 0 || edit.shake >= static_cast<int>(anchors.size())))
    fail(edit, "there is no such anchor; the scene has " + std::to_string(anchors.size()));
  check_edit_value(edit);
  const std::vector<std::string_view>& when = key_of(edit.key).when;
  if (edit.key == Edit::Key::frequency)
    expect_choice(edit, shakes[edit.shake].kind, {"sine"});  // the two of a sweep stay as they are
  else if (of_shake(edit.key))
    expect_choice(edit, shakes[edit.shake].kind, when);
  if (edit.key == Edit::Key::restitution) expect_choice(edit, setup.parameters.contact.kind, when);
}

}  // namespace topple::io
