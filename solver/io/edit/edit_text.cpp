#include "solver/io/edit/edit_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "solver/body/model_level.h"
#include "solver/frame/integrator.h"
#include "solver/io/common/digits.h"
#include "solver/io/common/errors.h"
#include "solver/math/ranges.h"
#include "solver/model/excitation.h"

namespace topple::io {
namespace {

/// How many numbers a value has at least: of a frequency, which a sweep has two of, one.
int least_count(const Key& key) {
  if (key.type != KeyType::numbers) return 1;
  return key.least_count > 0 ? key.least_count : key.count;
}

std::string every_digit(double x) {
  std::string text = shortest_digits(x);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

/// In the unit of the key where that reads back the same, else in SI.
std::string exact_text(const Key& key, double si) {
  if (!key.unit.empty()) {
    const std::string text = value_text(key, si);
    if (parse_quantity(text, key.dimension).si == si) return '"' + text + '"';
  }
  return every_digit(si);
}

/// Whether 0 stands for the word that a key takes in place of a number: time_step = "auto".
bool is_word(const Key& key, double number) {
  return key.type == KeyType::number && !key.choices.empty() && number == 0;
}

std::string list_text(const std::vector<std::string>& items) {
  std::string text;
  for (const std::string& item : items) text += (text.empty() ? "[" : ", ") + item;
  return text + "]";
}

[[noreturn]] void fail(const Edit& edit, const std::string& message) {
  throw InputError(edit_key(edit) + ": " + message);
}

/// Refuses the key of a choice that was not made.
void expect_choice(const Edit& edit, const Parameters& parameters) {
  const Key& key = key_of(edit.key);
  const auto choice = ranges::find_if(
      edits(), [&](const EditTraits& row) { return row.of == traits(edit.key).of && row.word == key.of; });
  if (choice == edits().end()) return;
  const std::string_view made = *choice_of(key_of(choice->kind), choice->get(parameters, edit.index).x());
  std::string words;
  for (const std::string_view word : key.when) {
    if (word == made) return;
    words += (words.empty() ? "" : " or ") + std::string(word);
  }
  const std::string of(key.of);
  fail(edit, "belongs to " + of + " = " + words + ", but " + of + " is " + std::string(made));
}

void check_type(const Edit& edit, const Parameters& parameters, const Model&) {
  const auto asked = static_cast<Shake::Kind>(static_cast<int>(edit.value.x()));
  if (!traits(parameters.shakes[edit.index].kind).has_amplitude || !traits(asked).has_amplitude)
    fail(edit, "a record stays one, and nothing else becomes one");
}

void check_frequency(const Edit& edit, const Parameters& parameters, const Model&) {
  if (traits(parameters.shakes[edit.index].kind).sweeps)
    check_edit_value({edit.key, edit.index, Vec3(edit.value.y(), 0, 0)});
}

void check_ground(const Edit& edit, const Parameters& parameters, const Model&) {
  if (parameters.shakes[edit.index].building)
    fail(edit,
         "the shake moves the ground of a building, whose floor was computed from it; change the scene and "
         "run it again");
}

void check_model(const Edit& edit, const Parameters&, const Model& model) {
  const auto asked = static_cast<BodyModel>(static_cast<int>(edit.value.x()));
  if (!traits(asked).by_edit)
    fail(edit,
         "a body is " + std::string(traits(asked).word) + " from the start of a run on; a scene says so");
  if (model.bodies[edit.index].solid && !can_be(model, edit.index, asked))
    fail(edit,
         "\"" + model.bodies[edit.index].name + "\" cannot be " + traits(asked).word + "; a block is rigid");
  if (!can_be(model, edit.index, asked))
    fail(edit, "\"" + model.bodies[edit.index].name + "\" cannot be " + traits(asked).word +
                   "; supports and loads take a frame, elastic and auto a scene that says so");
}

void check_integrator(const Edit& edit, const Parameters&, const Model& model) {
  if (edit.value.x() == k_automatic_integrator) return;
  const IntegratorTraits& asked = traits(static_cast<Integrator>(static_cast<int>(edit.value.x())));
  const auto block = ranges::find_if(model.bodies, &Body::solid);
  if (asked.is_explicit && block != model.bodies.end())
    fail(edit, "\"" + block->name + "\" is a block, which is rigid: \"" + asked.word +
                   "\" makes a frame of each body that is near another");
}

void check_pull(const Edit& edit, const Parameters&, const Model& model) {
  const Body& body = model.bodies[model.node_body[edit.index]];
  if (body.ground) fail(edit, "\"" + body.name + "\" is a floor or a wall, which stays where it is");
}

void check_damping(const Edit& edit, const Parameters&, const Model& model) {
  const Body& body = model.bodies[edit.index];
  if (body.first_frequency == 0)
    fail(edit, "\"" + body.name + "\" has no known elastic mode; give it a damping in the scene");
}

/// What range and choice of a key do not tell; most keys need no row.
struct EditCheck {
  Edit::Key key;
  void (*check)(const Edit&, const Parameters&, const Model&);
};
constexpr EditCheck k_checks[] = {{Edit::Key::type, check_ground},
                                  {Edit::Key::frequency, check_ground},
                                  {Edit::Key::duration, check_ground},
                                  {Edit::Key::type, check_type},
                                  {Edit::Key::frequency, check_frequency},
                                  {Edit::Key::model, check_model},
                                  {Edit::Key::integrator, check_integrator},
                                  {Edit::Key::damping, check_damping},
                                  {Edit::Key::pull, check_pull}};

}  // namespace

const Key& key_of(Edit::Key key) {
  static const Key pull{.table = "node",
                        .name = "pull",
                        .type = KeyType::numbers,
                        .dimension = Dimension::force,
                        .unit = "N",
                        .least = -1e9,
                        .most = 1e9,
                        .count = 3,
                        .about = "a force that a hand pulls with"};
  const EditTraits& row = traits(key);
  return key == Edit::Key::pull ? pull : *find_key(traits(row.of).keys, row.word);
}

std::string edit_key(const Edit& edit) {
  const EditTraits& row = traits(edit.key);
  const EditTableTraits& table = traits(row.of);
  return std::string(table.word) + "." + (table.numbered ? std::to_string(edit.index + 1) + "." : "") +
         row.word;
}

std::string scene_key(const Edit& edit, const Model& model) {
  const int fixing = edit.key == Edit::Key::anchor ? model.anchors[edit.index].fixing_number : 0;
  return fixing > 0 ? "fixing." + std::to_string(fixing) + ".on" : edit_key(edit);
}

std::optional<Edit> parse_edit_key(std::string_view text) {
  const std::size_t dot = text.find('.');
  int number = 1;
  if (dot != std::string_view::npos)
    std::from_chars(text.data() + dot + 1, text.data() + text.size(), number);
  for (const EditTraits& row : edits()) {
    const Edit edit{.key = row.kind, .index = traits(row.of).numbered ? number - 1 : 0};
    if (edit.index >= 0 && edit_key(edit) == text) return edit;
  }
  return std::nullopt;
}

const std::string_view* choice_of(const Key& key, double number) {
  for (std::size_t k = 0; k < key.choices.size(); ++k)
    if (key.numbers[k] == number) return &key.choices[k];
  return nullptr;
}

std::string edit_value_text(const Edit& edit, EditSpelling spelling) {
  const Key& key = key_of(edit.key);
  const bool in_scene = spelling == EditSpelling::in_scene;
  const double number = edit.value.x();
  const auto spelt = [&](std::string_view word) {
    return in_scene ? '"' + std::string(word) + '"' : std::string(word);
  };
  if (key.type == KeyType::boolean) return number != 0 ? "true" : "false";
  if (key.type == KeyType::choice) return spelt(*choice_of(key, number));
  if (is_word(key, number)) return spelt(key.choices.front());
  std::vector<std::string> items;
  if (key.type == KeyType::choices) {
    for (std::size_t k = 0; k < (number != 0 ? key.choices.size() : 1); ++k)
      items.push_back(spelt(key.choices[k]));
    return list_text(items);
  }
  int count = least_count(key);
  while (count < key.count && edit.value[count] != 0) ++count;
  for (int i = 0; i < count; ++i)
    items.push_back(in_scene ? exact_text(key, edit.value[i]) : value_text(key, edit.value[i]));
  return count == 1 ? items[0] : list_text(items);
}

void check_edit_value(const Edit& edit) {
  const Key& key = key_of(edit.key);
  if (is_word(key, edit.value.x())) return;
  for (int i = 0; i < least_count(key); ++i) {
    const double value = edit.value[i];
    if (!std::isfinite(value)) fail(edit, short_number(value) + " is not a finite number");
    // conversion of units may round the end of a range outwards
    constexpr double slack = 1e-12;
    if (value < key.least - slack * std::abs(key.least) || value > key.most + slack * std::abs(key.most))
      fail(edit, value_text(key, value) + " is outside " + range_text(key));
  }
  const double number = edit.value.x();
  if (key.type == KeyType::choice && !choice_of(key, number)) {
    std::string choices;
    for (std::size_t k = 0; k < key.choices.size(); ++k)
      choices += ", " + std::to_string(key.numbers[k]) + " (" + std::string(key.choices[k]) + ")";
    fail(edit, short_number(number) + " is not the number of a choice" + choices);
  }
  if ((key.type == KeyType::boolean || key.type == KeyType::choices) && number != 0 && number != 1)
    fail(edit, short_number(number) + " is neither 0 nor 1");
  if (edit.key == Edit::Key::direction && !(edit.value.stableNorm() > 0))
    fail(edit, "a zero vector has no direction");
}

void check_edit(const Edit& edit, const Parameters& parameters, const Model& model) {
  const EditTableTraits& table = traits(traits(edit.key).of);
  const int count = table.count(model, parameters);
  if (table.numbered && (edit.index < 0 || edit.index >= count))
    fail(edit, std::string("there is no such ") + table.word + "; the scene has " + std::to_string(count));
  check_edit_value(edit);
  expect_choice(edit, parameters);
  for (const EditCheck& row : k_checks)
    if (row.key == edit.key) row.check(edit, parameters, model);
}

}  // namespace topple::io
