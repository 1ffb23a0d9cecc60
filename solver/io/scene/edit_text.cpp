#include "solver/io/scene/edit_text.h"

#include <charconv>
#include <cmath>

#include "solver/body/ladder.h"
#include "solver/io/common/errors.h"

namespace topple::io {
namespace {

struct Name {
  Edit::Key key;
  const char *table, *name;
};

// In the order of Edit::Key. A body may be a frame or a copy of one: its edits say "body" and its number.
constexpr Name k_names[] = {
    {Edit::Key::on, "shake", "on"},
    {Edit::Key::type, "shake", "type"},
    {Edit::Key::frequency, "shake", "frequency"},
    {Edit::Key::amplitude, "shake", "amplitude"},
    {Edit::Key::direction, "shake", "direction"},
    {Edit::Key::duration, "shake", "duration"},
    {Edit::Key::scale, "shake", "scale"},
    {Edit::Key::law, "contact", "law"},
    {Edit::Key::alpha, "contact", "alpha"},
    {Edit::Key::q, "contact", "q"},
    {Edit::Key::friction, "contact", "friction"},
    {Edit::Key::friction_static, "contact", "friction_static"},
    {Edit::Key::restitution, "contact", "restitution"},
    {Edit::Key::model, "body", "model"},
    {Edit::Key::damping, "body", "damping"},
    {Edit::Key::anchor, "anchor", "on"},
    {Edit::Key::integrator, "run", "integrator"},
    {Edit::Key::want, "run", "want"},
    {Edit::Key::time_step, "run", "time_step"},
};

const Name& name_of(Edit::Key key) {
  return k_names[static_cast<std::size_t>(key)];
}

bool is_of(const char* table, Edit::Key key) {
  return std::string_view(name_of(key).table) == table;
}

bool is_numbered(Edit::Key key) {
  return is_of("shake", key) || is_of("body", key) || is_of("anchor", key);
}

// How many values an edit has.
int value_count(const Edit& edit, const Key& key) {
  return edit.key == Edit::Key::direction ? key.count : 1;
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
  const Name& name = name_of(key);
  return *find_key(is_of("body", key) ? "cabinet" : name.table, name.name);
}

std::string edit_key(const Edit& edit) {
  const Name& name = name_of(edit.key);
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
  for (int i = 0; i < value_count(edit, key); ++i) {
    const double value = edit.value[i];
    if (!std::isfinite(value)) fail(edit, short_number(value) + " is not a finite number");
    // conversion of units may round the end of a range outwards
    constexpr double slack = 1e-12;
    if (value < key.least - slack * std::abs(key.least) || value > key.most + slack * std::abs(key.most))
      fail(edit, value_text(key, value) + " is outside " + range_text(key));
  }
  const double number = edit.value.x();
  const int choices = static_cast<int>(key.choices.size());
  if (key.type == KeyType::choice && !(number >= 0 && number < choices && number == std::floor(number)))
    fail(edit, short_number(number) + " is not the number of a choice, 0.." + std::to_string(choices - 1));
  if ((key.type == KeyType::boolean || key.type == KeyType::choices) && number != 0 && number != 1)
    fail(edit, short_number(number) + " is neither 0 nor 1");
  if (edit.key == Edit::Key::direction && !(edit.value.stableNorm() > 0))
    fail(edit, "a zero vector has no direction");
}

namespace {

void expect_index(const Edit& edit, std::size_t count, const char* what) {
  if (edit.shake < 0 || edit.shake >= static_cast<int>(count))
    fail(edit, std::string("there is no such ") + what + "; the scene has " + std::to_string(count));
}

void check_shake_edit(const Edit& edit, const Shake& shake) {
  if (edit.key == Edit::Key::on) return;
  if (edit.key == Edit::Key::type) {
    const auto record = [](int kind) { return static_cast<Shake::Kind>(kind) == Shake::Kind::record; };
    if (record(static_cast<int>(shake.kind)) || record(static_cast<int>(edit.value.x())))
      fail(edit, "a record stays one, and nothing else becomes one");
    return;
  }
  expect_choice(edit, shake.kind, key_of(edit.key).when);
  if (edit.key == Edit::Key::frequency && shake.kind == Shake::Kind::sweep)
    check_edit_value({edit.key, edit.shake, Vec3(edit.value.y(), 0, 0)});
}

void check_body_edit(const Edit& edit, const Model& model) {
  const Body& body = model.bodies[edit.shake];
  if (edit.key == Edit::Key::damping && body.first_frequency == 0)
    fail(edit, "\"" + body.name + "\" has no known elastic mode; give it a damping in the scene");
  if (edit.key == Edit::Key::model) {
    const int asked = static_cast<int>(edit.value.x());
    if (can_be(model, edit.shake, static_cast<BodyModel>(asked))) return;
    const std::string word(key_of(edit.key).choices[static_cast<std::size_t>(asked)]);
    fail(edit, "\"" + body.name + "\" cannot be " + word +
                   "; supports and loads take a frame, elastic and auto a scene that says so");
  }
}

}  // namespace

void check_edit(const Edit& edit, const Parameters& parameters, const Model& model) {
  if (is_of("shake", edit.key)) expect_index(edit, parameters.shakes.size(), "shake");
  if (is_of("anchor", edit.key)) expect_index(edit, model.anchors.size(), "anchor");
  if (is_of("body", edit.key)) expect_index(edit, model.furniture_total(), "body");
  check_edit_value(edit);
  if (is_of("shake", edit.key)) check_shake_edit(edit, parameters.shakes[edit.shake]);
  if (is_of("body", edit.key)) check_body_edit(edit, model);
  if (edit.key == Edit::Key::restitution || edit.key == Edit::Key::friction_static)
    expect_choice(edit, parameters.contact.kind, key_of(edit.key).when);
}

}  // namespace topple::io
