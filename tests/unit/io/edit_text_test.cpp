#include "solver/io/edit/edit_text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "solver/io/scene/scene.h"

namespace topple::io {
namespace {

std::string refusal_of(const Edit& edit, const Setup& setup) {
  try {
    check_edit(edit, setup.parameters, setup.model);
    return {};
  } catch (const InputError& error) {
    return error.what();
  }
}

Edit number(Edit::Key key, double value, int index = 0) {
  return {.key = key, .index = index, .value = Vec3(value, 0, 0)};
}

/// A sine and a pulse.
topple::Setup two_shakes() {
  topple::Setup setup;
  setup.parameters.shakes.resize(2);
  setup.parameters.shakes[1].kind = Shake::Kind::pulse;
  return setup;
}

/// A sine, a pulse, a record and a sweep; two bodies.
topple::Setup all_shakes() {
  topple::Setup setup = two_shakes();
  setup.parameters.shakes.resize(4);
  setup.parameters.shakes[2].kind = Shake::Kind::record;
  setup.parameters.shakes[3].kind = Shake::Kind::sweep;
  setup.model.bodies.resize(2);
  for (Body& body : setup.model.bodies) body.first_frequency = 100;
  return setup;
}

TEST(EditText, names_are_the_paths_of_the_scene) {
  EXPECT_EQ(edit_key(number(Edit::Key::amplitude, 0)), "shake.1.amplitude");
  EXPECT_EQ(edit_key(number(Edit::Key::frequency, 0, 11)), "shake.12.frequency");
  EXPECT_EQ(edit_key(number(Edit::Key::direction, 0, 1)), "shake.2.direction");
  EXPECT_EQ(edit_key(number(Edit::Key::alpha, 0, 3)), "contact.alpha");
  EXPECT_EQ(edit_key(number(Edit::Key::q, 0)), "contact.q");
  EXPECT_EQ(edit_key(number(Edit::Key::friction, 0)), "contact.friction");
  EXPECT_EQ(edit_key(number(Edit::Key::restitution, 0)), "contact.restitution");
  EXPECT_EQ(edit_key(number(Edit::Key::time_step, 0)), "run.time_step");
}

TEST(EditText, every_name_reads_back_and_has_its_row_in_the_table_of_keys) {
  const topple::Setup setup = all_shakes();
  for (const auto& [key, shake] : editable(setup.model, setup.parameters)) {
    const Edit edit{.key = key, .index = shake};
    const std::optional<Edit> read = parse_edit_key(edit_key(edit));
    ASSERT_TRUE(read) << edit_key(edit);
    EXPECT_EQ(read->key, key);
    EXPECT_EQ(read->index, shake);
    const Key& row = key_of(key);
    EXPECT_TRUE(edit_key(edit).ends_with(row.name));
    EXPECT_TRUE(edit_key(edit).starts_with(row.table == "cabinet" ? "body" : row.table));
    EXPECT_LT(row.least, row.most);
  }
}

TEST(EditText, anchors_are_switched_by_number) {
  topple::Setup setup;
  setup.model.anchors.resize(2);
  setup.parameters.anchors = {true, true};
  EXPECT_EQ(edit_key(number(Edit::Key::anchor, 0, 1)), "anchor.2.on");
  EXPECT_EQ(parse_edit_key("anchor.2.on")->index, 1);
  EXPECT_EQ(parse_edit_key("anchor.2.on")->key, Edit::Key::anchor);
  EXPECT_FALSE(parse_edit_key("anchor.on"));
  EXPECT_FALSE(parse_edit_key("anchor.2.strength"));
  EXPECT_EQ(refusal_of(number(Edit::Key::anchor, 0, 1), setup), "");
  EXPECT_EQ(refusal_of(number(Edit::Key::anchor, 1, 1), setup), "");
  EXPECT_EQ(refusal_of(number(Edit::Key::anchor, 0.5), setup), "anchor.1.on: 0.5 is neither 0 nor 1");
  EXPECT_EQ(refusal_of(number(Edit::Key::anchor, 1, 2), setup),
            "anchor.3.on: there is no such anchor; the scene has 2");
}

TEST(EditText, other_names_are_none) {
  for (const char* text : {"",
                           ".",
                           "alpha",
                           "contact",
                           "contact.",
                           "contact.1.alpha",
                           "contact.normal_speed",
                           "cabinet.1.model",
                           "contact.alpha ",
                           "Contact.alpha",
                           "shake.amplitude",
                           "shake.0.amplitude",
                           "shake.-1.amplitude",
                           "shake.01.amplitude",
                           "shake.+1.amplitude",
                           "shake.1.5.amplitude",
                           "shake.1.",
                           "shake.1",
                           "shake.1.start",
                           "shake.99999999999999999999.amplitude",
                           "shake.2147483648.amplitude",
                           "run.duration",
                           "run.1.time_step"})
    EXPECT_FALSE(parse_edit_key(text)) << text;
  EXPECT_FALSE(parse_edit_key(std::string_view("contact.q\0", 10)));
}

TEST(EditText, values_at_the_ends_of_a_range_pass_and_beyond_them_not) {
  const topple::Setup setup = all_shakes();
  for (const auto& [key, shake] : editable(setup.model, setup.parameters)) {
    const Key& row = key_of(key);
    if (key == Edit::Key::direction || row.type != KeyType::number) continue;
    if (key == Edit::Key::frequency && shake == 3) continue;  // it has two
    for (const double end : {row.least, row.most}) {
      EXPECT_EQ(refusal_of(number(key, end, shake), setup), "") << row.name;
      EXPECT_EQ(refusal_of(number(key, std::nextafter(end, 2 * end), shake), setup), "")
          << row.name;  // rounding
    }
    const double step = 1e-6 * (row.most - row.least);
    EXPECT_NE(refusal_of(number(key, row.most + step, shake), setup), "") << row.name;
    EXPECT_NE(refusal_of(number(key, row.least - step, shake), setup), "") << row.name;
  }
}

TEST(EditText, errors_are_lines_in_the_words_of_a_scene) {
  const topple::Setup setup = two_shakes();
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(refusal_of(number(Edit::Key::friction, 2.4), setup), "contact.friction: 2.4 is outside 0..1.5");
  EXPECT_EQ(refusal_of(number(Edit::Key::amplitude, 1200), setup),
            "shake.1.amplitude: 120000 gal is outside 0..100000 gal");
  EXPECT_EQ(refusal_of(number(Edit::Key::time_step, 1e-8), setup),
            "run.time_step: 1e-08 s is outside 1e-07..0.1 s");
  EXPECT_EQ(refusal_of(number(Edit::Key::time_step, 0), setup), "");  // auto
  EXPECT_EQ(refusal_of(number(Edit::Key::alpha, nan), setup), "contact.alpha: nan is not a finite number");
  EXPECT_EQ(refusal_of(number(Edit::Key::alpha, infinity), setup),
            "contact.alpha: inf is not a finite number");
  EXPECT_EQ(refusal_of(number(Edit::Key::frequency, 2, 2), setup),
            "shake.3.frequency: there is no such shake; the scene has 2");
  EXPECT_EQ(refusal_of(number(Edit::Key::frequency, 2, -1), setup),
            "shake.0.frequency: there is no such shake; the scene has 2");
  EXPECT_EQ(refusal_of(number(Edit::Key::frequency, 2, 1), setup),
            "shake.2.frequency: belongs to type = sine or sweep, but type is pulse");
  EXPECT_EQ(refusal_of(number(Edit::Key::scale, 2, 1), setup),
            "shake.2.scale: belongs to type = record, but type is pulse");
  EXPECT_EQ(refusal_of(number(Edit::Key::amplitude, 2, 2), all_shakes()),
            "shake.3.amplitude: belongs to type = sine or sweep or pulse, but type is record");
  EXPECT_EQ(refusal_of(number(Edit::Key::frequency, 2, 3), all_shakes()),
            "shake.4.frequency: 0 Hz is outside 0.001..1000 Hz");  // the last one of the sweep
  EXPECT_EQ(refusal_of({.key = Edit::Key::frequency, .index = 3, .value = Vec3(2, 5, 0)}, all_shakes()), "");
}

TEST(EditText, choices_are_numbers_of_those_that_the_run_has_a_place_for) {
  topple::Setup setup = all_shakes();
  EXPECT_EQ(refusal_of(number(Edit::Key::law, 2), setup), "");
  EXPECT_EQ(refusal_of(number(Edit::Key::law, 3), setup),
            "contact.law: 3 is not the number of a choice, 0 (coulomb), 1 (paper), 2 (printed)");
  EXPECT_EQ(refusal_of(number(Edit::Key::law, 0.5), setup),
            "contact.law: 0.5 is not the number of a choice, 0 (coulomb), 1 (paper), 2 (printed)");
  EXPECT_EQ(refusal_of(number(Edit::Key::law, std::nan("")), setup),
            "contact.law: nan is not a finite number");
  EXPECT_EQ(refusal_of(number(Edit::Key::integrator, 3), setup), "");
  EXPECT_EQ(refusal_of(number(Edit::Key::want, 2), setup), "run.want: 2 is neither 0 nor 1");
  EXPECT_EQ(refusal_of(number(Edit::Key::on, -1), setup), "shake.1.on: -1 is neither 0 nor 1");
  EXPECT_EQ(refusal_of(number(Edit::Key::type, 1), setup), "");
  EXPECT_EQ(refusal_of(number(Edit::Key::type, 3), setup),
            "shake.1.type: a record stays one, and nothing else becomes one");
  EXPECT_EQ(refusal_of(number(Edit::Key::type, 0, 2), setup),
            "shake.3.type: a record stays one, and nothing else becomes one");
  setup.model.bodies[1].name = "desk";
  setup.model.bodies[1].first_frequency = 0;
  EXPECT_EQ(edit_key(number(Edit::Key::model, 1, 1)), "body.2.model");
  EXPECT_EQ(refusal_of(number(Edit::Key::model, 1, 1), setup), "");
  EXPECT_EQ(refusal_of(number(Edit::Key::model, 2, 1), setup),
            "body.2.model: \"desk\" cannot be elastic; supports and loads take a frame, elastic and auto a "
            "scene that says so");
  EXPECT_EQ(refusal_of(number(Edit::Key::damping, 0.1, 1), setup),
            "body.2.damping: \"desk\" has no known elastic mode; give it a damping in the scene");
  EXPECT_EQ(refusal_of(number(Edit::Key::damping, 0.1, 2), setup),
            "body.3.damping: there is no such body; the scene has 2");
}

TEST(EditText, an_anchor_of_a_fixing_is_called_as_the_scene_calls_it) {
  const Model fixed = load_scene("sixth-floor").setup.model, anchored = load_scene("anchored").setup.model;
  const auto last = static_cast<int>(fixed.anchors.size()) - 1;
  EXPECT_EQ(scene_key({.key = Edit::Key::anchor, .index = last}, fixed),
            "fixing." + std::to_string(fixed.anchors.back().fixing_number) + ".on");
  EXPECT_EQ(scene_key({.key = Edit::Key::anchor, .index = 1}, anchored), "anchor.2.on");
  EXPECT_EQ(scene_key({.key = Edit::Key::amplitude}, fixed), "shake.1.amplitude");
}

TEST(EditText, a_pull_is_of_a_node_of_what_moves) {
  const std::optional<Edit> read = parse_edit_key("node.3.pull");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->key, Edit::Key::pull);
  EXPECT_EQ(read->index, 2);
  EXPECT_EQ(edit_key(*read), "node.3.pull");
  EXPECT_FALSE(parse_edit_key("node.0.pull"));
  EXPECT_FALSE(parse_edit_key("node.pull"));
  Edit edit = *read;
  edit.value = Vec3(12.5, 0, -3);
  EXPECT_EQ(edit_value_text(edit, EditSpelling::shown), "[12.5 N, 0 N, -3 N]");
  const Scene scene = load_scene("paper-a");
  const Model& model = scene.setup.model;
  EXPECT_NO_THROW(check_edit(edit, scene.setup.parameters, model));
  edit.value = Vec3::Zero();  // let go of
  EXPECT_NO_THROW(check_edit(edit, scene.setup.parameters, model));
  edit.value.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(check_edit(edit, scene.setup.parameters, model), InputError);
  edit.value.x() = 2e9;
  EXPECT_THROW(check_edit(edit, scene.setup.parameters, model), InputError);
  edit = {.key = Edit::Key::pull, .index = model.node_total(), .value = Vec3(1, 0, 0)};
  EXPECT_THROW(check_edit(edit, scene.setup.parameters, model), InputError);
}

TEST(EditText, each_choice_that_can_be_edited_has_a_number_of_its_own) {
  for (const EditTraits& row : edits()) {
    const Key& key = key_of(row.kind);
    if (key.type != KeyType::choice) continue;
    ASSERT_EQ(key.numbers.size(), key.choices.size()) << row.word;
    for (std::size_t k = 0; k < key.choices.size(); ++k)
      EXPECT_EQ(*choice_of(key, key.numbers[k]), key.choices[k]) << row.word;
    EXPECT_EQ(choice_of(key, -1), nullptr);
  }
}

TEST(EditText, values_are_in_the_words_and_units_of_scenes) {
  const double third = 1. / 3;
  const auto expect = [](const Edit& edit, const char* shown, const char* in_scene) {
    EXPECT_EQ(edit_value_text(edit, EditSpelling::shown), shown) << edit_key(edit);
    EXPECT_EQ(edit_value_text(edit, EditSpelling::in_scene), in_scene) << edit_key(edit);
  };
  expect(number(Edit::Key::type, 2), "pulse", "\"pulse\"");
  expect(number(Edit::Key::law, 0), "coulomb", "\"coulomb\"");
  expect(number(Edit::Key::integrator, 3), "newmark", "\"newmark\"");
  expect(number(Edit::Key::model, 1), "rigid", "\"rigid\"");
  expect(number(Edit::Key::want, 1), "[motion, stress]", "[\"motion\", \"stress\"]");
  expect(number(Edit::Key::want, 0), "[motion]", "[\"motion\"]");
  expect(number(Edit::Key::on, 1), "true", "true");
  expect(number(Edit::Key::anchor, 0), "false", "false");
  expect(number(Edit::Key::amplitude, 2), "200 gal", "\"200 gal\"");
  expect(number(Edit::Key::time_step, third), "0.333333 s", "0.3333333333333333");
  expect(number(Edit::Key::time_step, 0), "auto", "\"auto\"");
  expect(number(Edit::Key::friction, third), "0.333333", "0.3333333333333333");
  expect(number(Edit::Key::q, 2), "2", "2.0");
  expect(number(Edit::Key::frequency, 2), "2 Hz", "\"2 Hz\"");
  expect({.key = Edit::Key::frequency, .value = Vec3(2, third, 0)}, "[2 Hz, 0.333333 Hz]",
         "[\"2 Hz\", 0.3333333333333333]");
  expect({.key = Edit::Key::direction, .value = Vec3(third, 1, 0)}, "[0.333333, 1, 0]",
         "[0.3333333333333333, 1.0, 0.0]");
}

TEST(EditText, a_direction_needs_a_length) {
  const topple::Setup setup = two_shakes();
  const auto direction = [](const Vec3& v) { return Edit{.key = Edit::Key::direction, .value = v}; };
  EXPECT_EQ(refusal_of(direction(Vec3::Zero()), setup), "shake.1.direction: a zero vector has no direction");
  EXPECT_EQ(refusal_of(direction({0, 0, std::nan("")}), setup),
            "shake.1.direction: nan is not a finite number");
  EXPECT_EQ(refusal_of(direction({0, 2e6, 0}), setup), "shake.1.direction: 2e+06 is outside -1e+06..1e+06");
  EXPECT_EQ(refusal_of(direction({0, 0, 1e-200}), setup), "");
  Parameters parameters = setup.parameters;
  apply(direction({0, 0, 1e-200}), setup.model, 0, parameters);
  EXPECT_EQ(parameters.shakes[0].direction, Vec3::UnitZ());
}

TEST(EditText, restitution_and_static_friction_belong_to_one_law) {
  topple::Setup setup = two_shakes();
  EXPECT_EQ(refusal_of(number(Edit::Key::restitution, 0.3), setup), "");
  setup.parameters.contact.kind = ContactLawKind::printed;
  EXPECT_EQ(refusal_of(number(Edit::Key::restitution, 0.3), setup),
            "contact.restitution: belongs to law = coulomb, but law is printed");
  EXPECT_EQ(refusal_of(number(Edit::Key::friction_static, 0.7), setup),
            "contact.friction_static: belongs to law = coulomb, but law is printed");
}

}  // namespace
}  // namespace topple::io
