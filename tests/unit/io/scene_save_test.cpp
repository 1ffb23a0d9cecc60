// Scenes saved as they have become by edits.
#include "solver/io/edit/scene_save.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "solver/io/edit/edit_text.h"
#include "solver/io/edit/scene_rewrite.h"

namespace topple::io {
namespace {

KeyChange change(std::vector<std::string> path, std::optional<std::string> value) {
  return {std::move(path), std::move(value)};
}

TEST(RewriteToml, values_change_in_their_place_and_comments_stay) {
  const std::string text =
      "topple = 1  # version\n# 机の揺れ\n[run]\nduration = \"20 s\"   # 長い, \"quoted\"\n\n"
      "[[shake]]\nname = 'a # no comment'\nfrequency = [\"1 Hz\", # first\n  \"2 Hz\"] # both\n";
  EXPECT_EQ(
      rewrite_toml(text, {change({"run", "duration"}, "3.5"), change({"shake", "1", "frequency"}, "\"4 Hz\""),
                          change({"shake", "1", "name"}, "\"b\"")}),
      "topple = 1  # version\n# 机の揺れ\n[run]\nduration = 3.5   # 長い, \"quoted\"\n\n"
      "[[shake]]\nname = \"b\"\nfrequency = \"4 Hz\" # both\n");
}

TEST(RewriteToml, keys_are_added_to_their_table_and_taken_out_of_it) {
  const std::string text =
      "[run]\nduration = 1\n\n[run.control]\nnode = 1\n\n[[shake]]\ncycles = 2 # gone\ntaper = 1\n";
  EXPECT_EQ(rewrite_toml(
                text, {change({"run", "time_step"}, "0.001"), change({"shake", "1", "cycles"}, std::nullopt),
                       change({"shake", "1", "on"}, "false"), change({"contact", "q"}, "2"),
                       change({"wall", "1", "name"}, "\"w\"")}),
            "[run]\nduration = 1\ntime_step = 0.001\n\n[run.control]\nnode = 1\n\n[[shake]]\ntaper = 1\non = "
            "false\n\n[contact]\nq = 2\n\n[[wall]]\nname = \"w\"\n");
}

TEST(RewriteToml, what_is_written_inline_is_written_anew) {
  const std::string text = rewrite_toml(
      "run = { duration = 1, settle = true }\nshake = [{ name = \"a\", cycles = 2 }]\ncontact.q = 1\n",
      {change({"run", "duration"}, std::nullopt), change({"run", "time_step"}, "0.5"),
       change({"shake", "1", "cycles"}, std::nullopt), change({"contact", "alpha"}, "2.0")});
  const std::string again = rewrite_toml(text, {});
  EXPECT_EQ(text, again);
  EXPECT_EQ(text.find("duration"), std::string::npos);
  EXPECT_EQ(text.find("cycles"), std::string::npos);
  EXPECT_NE(text.find("time_step = 0.5"), std::string::npos);
  EXPECT_NE(text.find("alpha = 2.0"), std::string::npos);
  EXPECT_NE(text.find("settle = true"), std::string::npos);
}

TEST(RewriteToml, entries_come_and_go_with_all_of_their_lines) {
  const std::string text =
      "topple = 1\n\n# at the back\n[[furniture]] # one\nkind = \"desk\"\ncopies = [[0, 0, 0],  # here\n  "
      "[1, 0, "
      "0]]\n\n[[furniture]]\nkind = \"chair\"\n[furniture.contents]\nmass = 1\n\n[run]\nduration = 1 # s\n";
  EXPECT_EQ(rewrite_toml(text, {change({"furniture", "2"}, std::nullopt)}),
            "topple = 1\n\n# at the back\n[[furniture]] # one\nkind = \"desk\"\ncopies = [[0, 0, 0],  # "
            "here\n  [1, 0, "
            "0]]\n\n[run]\nduration = 1 # s\n");
  EXPECT_EQ(rewrite_toml(
                text, {change({"furniture", "1"}, std::nullopt), change({"furniture", "1"}, std::nullopt)}),
            "topple = 1\n\n# at the back\n\n[run]\nduration = 1 # s\n");
  EXPECT_EQ(rewrite_toml(text, {change({"furniture", "1", "copies", "1"}, "[2, 0, 0]"),
                                change({"furniture", "1", "copies", "2"}, std::nullopt)}),
            "topple = 1\n\n# at the back\n[[furniture]] # one\nkind = \"desk\"\ncopies = [[2, 0, 0],  # "
            "here\n  ]\n\n[[furniture]]\n"
            "kind = \"chair\"\n[furniture.contents]\nmass = 1\n\n[run]\nduration = 1 # s\n");
  EXPECT_EQ(rewrite_toml(text, {change({"furniture", "3"}, "{ kind = \"table\", at = [1, 2.5] }")}),
            "topple = 1\n\n# at the back\n[[furniture]] # one\nkind = \"desk\"\ncopies = [[0, 0, 0],  # "
            "here\n  [1, 0, "
            "0]]\n\n[[furniture]]\nkind = \"chair\"\n[furniture.contents]\nmass = 1\n\n[[furniture]]\nkind = "
            "\"table\"\nat = "
            "[1, 2.5]\n\n[run]\nduration = 1 # s\n");
  EXPECT_EQ(rewrite_toml("a = 1", {change({"wall", "1"}, "{ at = [0, 1] }")}),
            "a = 1\n\n[[wall]]\nat = [0, 1]\n");
  EXPECT_EQ(rewrite_toml("a = 1\n[ceiling] # high\nat = 3\n", {change({"ceiling"}, std::nullopt)}),
            "a = 1\n");
}

TEST(RewriteToml, entries_within_brackets_come_and_go) {
  const std::string text =
      "wall = [\n  { name = \"a\", at = [0, 1] }, # left\n  { name = \"b\", at = [2, 1] },\n]\n[floor]\n";
  EXPECT_EQ(rewrite_toml(text, {change({"wall", "1"}, std::nullopt)}),
            "wall = [\n  # left\n  { name = \"b\", at = [2, 1] },\n]\n[floor]\n");
  EXPECT_EQ(
      rewrite_toml(text, {change({"wall", "2"}, std::nullopt), change({"wall", "1", "name"}, std::nullopt),
                          change({"wall", "1", "normal"}, "[1, 0, 0]")}),
      "wall = [\n  { at = [0, 1], normal = [1, 0, 0] }, # left\n]\n[floor]\n");
  EXPECT_EQ(
      rewrite_toml(text, {change({"wall", "3"}, "{ at = [5, 5] }")}),
      "wall = [\n  { name = \"a\", at = [0, 1] }, # left\n  { name = \"b\", at = [2, 1] }, { at = [5, 5] "
      "},\n]\n[floor]\n");
  EXPECT_EQ(rewrite_toml("wall = [{ at = 1 }] # only\n[floor]\n", {change({"wall", "1"}, std::nullopt)}),
            "[floor]\n");
}

const std::string k_to_be_saved = R"(topple = 1
title = "A scene to be saved"   # 題
[run]
duration = "2 s"
spectral_radius = 0.7 # of generalized-alpha
[[shake]]
name = "table"
frequency = "2 Hz"     # near resonance
amplitude = "300 gal"
cycles = 8
taper = 1
[[shake]]
name = "second"
type = "pulse"
amplitude = "100 gal"
duration = "0.2 s"
[contact]
alpha = "500 kgf"      # stiff
restitution = 0.1
[floor]
[[material]]
name = "steel"
young = "205 GPa"
poisson = 0.3
density = 7850
[[section]]
name = "post"
shape = "box"
size = ["30 mm", "30 mm"]
thickness = "1 mm"
[[cabinet]]
name = "first"
size = ["400 mm", "880 mm", "1800 mm"]
mass = "40 kg"
cg_height = "0.9 m"
shelves = 2
section = "post"
material = "steel"
[[cabinet]]
name = "twin"
at = [3, 0]
copies = [[0, 0, 0], [0, 2, 0]]
size = ["400 mm", "880 mm", "1800 mm"]
mass = "40 kg"
cg_height = "0.9 m"
shelves = 2
section = "post"
material = "steel"
[[anchor]]
name = "strap"
body = "first"
point = [-0.2, 0, 1.7]
to = [-0.4, 0, 1.7]
type = "strap"
stiffness = "50 kN/m"
)";

Scene original() {
  return parse_scene(k_to_be_saved, "saved.toml");
}

/// What an edit may set besides the present value.
Vec3 another_value(const Edit& edit, const Parameters& now) {
  const Vec3 value = edited_value(now, edit.key, edit.index);
  const Key& key = key_of(edit.key);
  if (edit.key == Edit::Key::direction) return Vec3(1, 2, 0.5).normalized();
  if (edit.key == Edit::Key::frequency) return 1.37 * value;
  if (key.type == KeyType::boolean || key.type == KeyType::choices) return Vec3(1 - value.x(), 0, 0);
  if (edit.key == Edit::Key::type) return Vec3(value.x() == 0 ? 1 : 0, 0, 0);
  if (key.type == KeyType::choice) return Vec3(value.x() == 1 ? 2 : 1, 0, 0);
  if (edit.key == Edit::Key::friction_static) return 1.2 * value;  // not below friction
  const double wanted = value.x() == 0 ? 0.123 : 0.8137 * value.x();
  return Vec3(std::clamp(wanted, key.least, key.most), 0, 0);
}

/// Every key that can be edited has the value that it has in `now`.
void expect_same(const Model& model, const Parameters& loaded, const Parameters& now) {
  for (const auto& [key, index] : editable(model, now))
    EXPECT_EQ(edited_value(loaded, key, index), edited_value(now, key, index)) << edit_key({key, index});
  EXPECT_EQ(loaded.adaptive, now.adaptive);
}

TEST(SavedScene, an_unchanged_scene_keeps_its_text) {
  const Scene scene = original();
  EXPECT_EQ(edited_scene(scene, scene.setup.parameters).text, scene.text);
}

TEST(SavedScene, every_edit_is_in_the_scene_that_is_saved) {
  const Scene scene = original();
  const Model& model = scene.setup.model;
  for (const auto& [key, index] : editable(model, scene.setup.parameters)) {
    Parameters now = scene.setup.parameters;
    Edit edit{key, index};
    edit.value = another_value(edit, now);
    SCOPED_TRACE(edit_key(edit));
    if (key == Edit::Key::integrator) now.models.assign(now.models.size(), BodyModel::frame);
    const auto set = [&](int body) {
      edit.index = body;
      ASSERT_NO_THROW(check_edit(edit, now, model));
      apply(edit, model, 0.4, now);
    };
    set(index);
    const bool of_a_body = key == Edit::Key::model || key == Edit::Key::damping;
    if (of_a_body && index > 0) set(3 - index);  // the other copy
    const SavedScene saved = edited_scene(scene, now);
    EXPECT_TRUE(saved.given_up.empty());
    EXPECT_NE(saved.text, scene.text);
    expect_same(model, parse_scene(saved.text, "again.toml").setup.parameters, now);
    EXPECT_NE(saved.text.find("# 題"), std::string::npos) << saved.text;
  }
}

TEST(SavedScene, all_edits_together_are_in_it) {
  const Scene scene = original();
  Parameters now = scene.setup.parameters;
  for (const auto& [key, index] : editable(scene.setup.model, scene.setup.parameters)) {
    if (key == Edit::Key::type || key == Edit::Key::law || key == Edit::Key::integrator) continue;
    const int body = index == 2 ? 1 : index;  // copies alike
    Edit edit{key, body};
    edit.value = another_value(edit, scene.setup.parameters);
    edit.index = index;
    apply(edit, scene.setup.model, 0.4, now);
  }
  const SavedScene saved = edited_scene(scene, now);
  EXPECT_TRUE(saved.given_up.empty());
  expect_same(scene.setup.model, parse_scene(saved.text, "again.toml").setup.parameters, now);
}

TEST(SavedScene, a_shake_of_another_type_has_the_keys_of_that_type) {
  const Scene scene = original();
  for (const Shake::Kind first : {Shake::Kind::sweep, Shake::Kind::pulse}) {
    Parameters now = scene.setup.parameters;
    apply({Edit::Key::type, 0, Vec3(static_cast<int>(first), 0, 0)}, scene.setup.model, 0.4, now);
    apply({Edit::Key::type, 1, Vec3(0, 0, 0)}, scene.setup.model, 0.4, now);
    const SavedScene saved = edited_scene(scene, now);
    const Scene loaded = parse_scene(saved.text, "again.toml");
    expect_same(scene.setup.model, loaded.setup.parameters, now);
    EXPECT_EQ(saved.text.find("cycles"), std::string::npos);
    topple::Run run(loaded.setup);
    EXPECT_TRUE(run.advance().ok());
  }
}

TEST(SavedScene, a_sweep_that_does_not_change_is_saved_next_to_what_it_is_and_said_so) {
  const Scene scene = original();
  Parameters now = scene.setup.parameters;
  apply({Edit::Key::type, 0, Vec3(1, 0, 0)}, scene.setup.model, 0.4, now);
  apply({Edit::Key::frequency, 0, Vec3(2, 2, 0)}, scene.setup.model, 0.4, now);
  const SavedScene saved = edited_scene(scene, now);
  EXPECT_EQ(saved.given_up, std::vector<std::string>{"shake.1.frequency"});
  const Shake loaded = parse_scene(saved.text, "again.toml").setup.parameters.shakes[0];
  EXPECT_DOUBLE_EQ(loaded.last_frequency, 2);
}

TEST(SavedScene, the_share_of_alpha_between_members_that_was_chosen_stays_when_alpha_is_stated) {
  const Scene scene = load_scene("moving-in");
  Parameters now = scene.setup.parameters;
  ASSERT_LT(now.contact.member_share, 1);
  apply({Edit::Key::alpha, 0, Vec3(2 * now.contact.alpha, 0, 0)}, scene.setup.model, 0.4, now);
  const SavedScene saved = edited_scene(scene, now);
  const Scene again = parse_scene(saved.text, "again.toml", {}, files_of(scene));
  EXPECT_EQ(again.setup.parameters.contact.member_share, now.contact.member_share);
}

TEST(SavedScene, its_title_is_that_of_the_scene_and_says_nothing_of_changes) {
  const auto saved_title = [](const std::vector<std::string>& overrides) {
    const Scene scene = load_scene("moving-in", overrides);
    Parameters now = scene.setup.parameters;
    apply({Edit::Key::friction, 0, Vec3(0.4321, 0, 0)}, scene.setup.model, 0, now);
    return parse_scene(edited_scene(scene, now).text, "again.toml", {}, files_of(scene)).title;
  };
  const std::string title = load_scene("moving-in").title;
  EXPECT_EQ(saved_title({}), title);
  EXPECT_EQ(saved_title({"run.duration=1"}), title);
}

TEST(SavedScene, static_friction_that_goes_with_friction_stays_unwritten) {
  const Scene scene = load_scene("cabinet");
  for (const double held : {0.45, 0.5}) {
    Parameters now = scene.setup.parameters;
    apply({Edit::Key::friction, 0, Vec3(0.45, 0, 0)}, scene.setup.model, 0.4, now);
    apply({Edit::Key::friction_static, 0, Vec3(held, 0, 0)}, scene.setup.model, 0.4, now);
    const SavedScene saved = edited_scene(scene, now);
    EXPECT_EQ(saved.text.find("friction_static") != std::string::npos, held > 0.45) << saved.text;
  }
}

TEST(SavedScene, what_an_absent_key_means_is_written_where_another_edit_would_change_it) {
  std::string text = k_to_be_saved;
  text.erase(text.find("alpha = \"500 kgf\""), std::string("alpha = \"500 kgf\"").size());
  const Scene scene = parse_scene(text, "absent.toml");
  ASSERT_TRUE(scene.setup.parameters.adaptive);  // as alpha is left out
  Parameters now = scene.setup.parameters;
  apply({Edit::Key::alpha, 0, Vec3(3000, 0, 0)}, scene.setup.model, 0.4, now);
  expect_same(scene.setup.model, parse_scene(edited_scene(scene, now).text, "again.toml").setup.parameters,
              now);
}

TEST(SavedScene, copies_that_are_computed_differently_are_refused) {
  const Scene scene = original();
  Parameters now = scene.setup.parameters;
  apply({Edit::Key::model, 2, Vec3(static_cast<int>(BodyModel::rigid), 0, 0)}, scene.setup.model, 0.4, now);
  try {
    edited_scene(scene, now);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("twin"), std::string::npos) << error.what();
  }
}

TEST(SavedScene, an_integrator_of_frames_is_given_up_beside_elastic_bodies_and_said_so) {
  const Scene scene = original();
  Parameters now = scene.setup.parameters;
  apply({Edit::Key::integrator, 0, Vec3(3, 0, 0)}, scene.setup.model, 0.4, now);
  const SavedScene saved = edited_scene(scene, now);
  EXPECT_EQ(saved.given_up, std::vector<std::string>{"run.integrator"});
  EXPECT_EQ(parse_scene(saved.text, "again.toml").setup.parameters.models, scene.setup.parameters.models);
}

TEST(SavedScene, every_built_in_scene_can_be_saved_with_another_friction) {
  for (const BuiltinScene& builtin : builtin_scenes()) {
    SCOPED_TRACE(builtin.name);
    const Scene scene = load_scene(std::string(builtin.name));
    Parameters now = scene.setup.parameters;
    apply({Edit::Key::friction, 0, Vec3(0.4321, 0, 0)}, scene.setup.model, 0, now);
    const SavedScene saved = edited_scene(scene, now);
    const Scene loaded = parse_scene(saved.text, "again.toml", {}, files_of(scene));
    EXPECT_EQ(loaded.setup.parameters.contact.friction, 0.4321);
    for (std::size_t at = 0; (at = scene.text.find("\n#", at)) != std::string::npos; ++at) {
      const std::string comment = scene.text.substr(at, scene.text.find('\n', at + 1) - at);
      EXPECT_NE(saved.text.find(comment), std::string::npos) << comment;
    }
  }
}

TEST(SceneWithRecord, a_built_in_record_takes_the_place_of_the_first_shake) {
  const Scene scene = scene_with_record(original(), {"near-fault.csv"});
  const std::vector<Shake>& shakes = scene.setup.parameters.shakes;
  ASSERT_EQ(shakes.size(), 2u);
  EXPECT_EQ(shakes[0].kind, Shake::Kind::record);
  EXPECT_EQ(shakes[1].kind, Shake::Kind::pulse);
  ASSERT_EQ(scene.files.size(), 1u);
  EXPECT_EQ(scene.title, "A scene to be saved");
}

TEST(SceneWithRecord, a_scene_without_a_shake_gains_one) {
  const Scene bare = parse_scene(k_to_be_saved.substr(0, k_to_be_saved.find("[[shake]]")) +
                                     k_to_be_saved.substr(k_to_be_saved.find("[contact]")),
                                 "bare.toml");
  ASSERT_TRUE(bare.setup.parameters.shakes.empty());
  EXPECT_EQ(scene_with_record(bare, {"near-fault.csv"}).setup.parameters.shakes.size(), 1u);
}

TEST(SceneWithRecord, what_is_no_accelerogram_is_refused_in_one_line) {
  try {
    scene_with_record(original(), {"/etc/hostname"});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("/etc/hostname"), std::string::npos);
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  }
}

}  // namespace
}  // namespace topple::io
