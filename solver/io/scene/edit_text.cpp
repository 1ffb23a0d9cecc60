#include "solver/io/scene/edit_text.h"

#include <charconv>
#include <cmath>

#include "solver/body/model_level.h"
#include "solver/contact/contact_law.h"
#include "solver/io/common/errors.h"
#include "solver/model/excitation.h"

namespace topple::io {
namespace {

// The table of the scene's path. A body may be a frame or a copy of one: its edits say "body" and its number.
std::string_view table_of(Edit::Of of) {
  switch (of) {
    case Edit::Of::shake:
      return "shake";
    case Edit::Of::contact:
      return "contact";
    case Edit::Of::body:
      return "body";
    case Edit::Of::anchor:
      return "anchor";
    case Edit::Of::run:
      break;
  }
  return "run";
}

bool is_numbered(Edit::Of of) {
  return of != Edit::Of::contact && of != Edit::Of::run;
}

// How many values an edit has.
int value_count(const Edit& edit, const Key& key) {
  return edit.key == Edit::Key::direction ? key.count : 1;
}

[[noreturn]] void fail(const Edit& edit, const std::string& message) {
  throw InputError(edit_key(edit) + ": " + message);
}

/// Refuses the key of a choice that was not made: `word` was, of the choices of `key.of`.
void expect_choice(const Edit& edit, std::string_view word) {
  const Key& key = key_of(edit.key);
  std::string words;
  for (const std::string_view other : key.when) {
    if (other == word) return;
    words += (words.empty() ? "" : " or ") + std::string(other);
  }
  const std::string of(key.of);
  fail(edit, "belongs to " + of + " = " + words + ", but " + of + " is " + std::string(word));
}

}  // namespace

const Key& key_of(Edit::Key key) {
  const EditTraits& row = traits(key);
  return *find_key(row.of == Edit::Of::body ? "cabinet" : table_of(row.of), row.word);
}

std::string edit_key(const Edit& edit) {
  const EditTraits& row = traits(edit.key);
  const std::string number = is_numbered(row.of) ? std::to_string(edit.shake + 1) + "." : "";
  return std::string(table_of(row.of)) + "." + number + row.word;
}

std::optional<Edit> parse_edit_key(std::string_view text) {
  const std::size_t dot = text.find('.');
  int number = 1;
  if (dot != std::string_view::npos)
    std::from_chars(text.data() + dot + 1, text.data() + text.size(), number);
  for (const EditTraits& row : edits()) {
    const Edit edit{.key = row.kind, .shake = is_numbered(row.of) ? number - 1 : 0};
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
    const auto& asked = shake_kinds()[static_cast<std::size_t>(edit.value.x())];
    if (!traits(shake.kind).has_amplitude || !asked.has_amplitude)
      fail(edit, "a record stays one, and nothing else becomes one");
    return;
  }
  expect_choice(edit, traits(shake.kind).word);
  if (edit.key == Edit::Key::frequency && traits(shake.kind).sweeps)
    check_edit_value({edit.key, edit.shake, Vec3(edit.value.y(), 0, 0)});
}

void check_body_edit(const Edit& edit, const Model& model) {
  const Body& body = model.bodies[edit.shake];
  if (edit.key == Edit::Key::damping && body.first_frequency == 0)
    fail(edit, "\"" + body.name + "\" has no known elastic mode; give it a damping in the scene");
  if (edit.key == Edit::Key::model) {
    const int asked = static_cast<int>(edit.value.x());
    if (can_be(model, edit.shake, body_models()[static_cast<std::size_t>(asked)].kind)) return;
    const std::string word(key_of(edit.key).choices[static_cast<std::size_t>(asked)]);
    fail(edit, "\"" + body.name + "\" cannot be " + word +
                   "; supports and loads take a frame, elastic and auto a scene that says so");
  }
}

}  // namespace

void check_edit(const Edit& edit, const Parameters& parameters, const Model& model) {
  const Edit::Of of = traits(edit.key).of;
  if (of == Edit::Of::shake) expect_index(edit, parameters.shakes.size(), "shake");
  if (of == Edit::Of::anchor) expect_index(edit, model.anchors.size(), "anchor");
  if (of == Edit::Of::body) expect_index(edit, model.furniture_total(), "body");
  check_edit_value(edit);
  if (of == Edit::Of::shake) check_shake_edit(edit, parameters.shakes[edit.shake]);
  if (of == Edit::Of::body) check_body_edit(edit, model);
  if (key_of(edit.key).of == "law") expect_choice(edit, traits(parameters.contact).word);
}

}  // namespace topple::io
