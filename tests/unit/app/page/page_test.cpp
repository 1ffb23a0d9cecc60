// Live pages: what goes into them, without a browser (tests/page/ has those).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "app/page/export_page.h"
#include "app/page/page_controls.h"
#include "app/page/page_rows.h"
#include "app/page/verdict.h"
#include "app/picture/furnish_words.h"
#include "solver/io/recording/recording.h"
#include "unit/app/program.h"

namespace topple::app {
namespace {

std::vector<io::FrameRow> rows_of_a_run(const io::Scene& scene, int steps) {
  Run run(scene.setup);
  std::vector<io::FrameRow> rows{io::frame_row(run)};
  for (int i = 0; i < steps; ++i) run.advance(), rows.push_back(io::frame_row(run));
  return rows;
}

TEST(PageRows, rows_come_back_as_they_were_packed) {
  const io::Scene scene = io::load_scene("anchored");
  const std::vector<io::FrameRow> rows = rows_of_a_run(scene, 5);
  const std::string bytes = pack_rows(rows);
  EXPECT_EQ(bytes.size(), rows.size() * packed_size(scene.setup.model));
  const std::vector<io::FrameRow> back = unpack_rows(scene.setup.model, bytes);
  ASSERT_EQ(back.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(back[i].time, rows[i].time);
    EXPECT_EQ(back[i].position, rows[i].position);
    EXPECT_EQ(back[i].rotation, rows[i].rotation);
    EXPECT_EQ(back[i].section_force, rows[i].section_force);
    EXPECT_EQ(back[i].hinge, rows[i].hinge);
    EXPECT_EQ(back[i].body, rows[i].body);
    EXPECT_EQ(back[i].anchor, rows[i].anchor);
    EXPECT_EQ(back[i].level, rows[i].level);
    EXPECT_FALSE(back[i].knows_contacts);
  }
  EXPECT_THROW(unpack_rows(scene.setup.model, bytes.substr(1)), io::InputError);
}

TEST(PageRows, what_is_not_finite_is_left_out) {
  const io::Scene scene = io::load_scene("cabinet");
  std::vector<io::FrameRow> rows = rows_of_a_run(scene, 2);
  rows[1].position[0] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(unpack_rows(scene.setup.model, pack_rows(rows)).size(), 2u);
}

TEST(PageRows, many_rows_are_thinned_to_four_mebibytes) {
  const Model model = io::load_scene("cabinet").setup.model;
  const std::size_t most = k_most_page_bytes / packed_size(model);
  EXPECT_EQ(page_stride(model, 1), 1u);
  EXPECT_EQ(page_stride(model, most), 1u);
  for (const std::size_t rows : {most + 1, std::size_t{10000}, std::size_t{1000000}}) {
    const std::size_t stride = page_stride(model, rows);
    const std::size_t kept = (rows - 1) / stride + 1 + ((rows - 1) % stride != 0);
    EXPECT_LE(kept, most) << rows;
    EXPECT_GE(2 * kept, most) << rows;
  }
}

// Rows beside the peaks of a sine of 1 Hz: 95.1 gal of 100.
TEST(PageRows, the_peak_of_the_floor_is_that_of_the_run_and_not_of_the_rows_that_are_kept) {
  const io::Scene scene = io::parse_scene(
      "topple = 1\nshake = [{ type = \"sine\", amplitude = \"100 gal\", frequency = 1 }]\n"
      "block = [{ name = \"box\", size = [1, 1, 1], mass = 1 }]\n",
      "s");
  std::vector<Shake> shakes = scene.setup.parameters.shakes;
  std::vector<io::FrameRow> rows;
  for (const double time : {0.1, 0.4, 0.6, 0.8}) {
    io::FrameRow& row = rows.emplace_back();
    row.time = time;
    const Vec3 floor = floor_acceleration(shakes, time);
    for (int k = 0; k < 3; ++k) row.floor_acceleration[k] = floor[k];
  }
  EXPECT_NEAR(std::abs(floor_along(rows[1], shakes)), 0.588, 1e-3);
  EXPECT_NEAR(floor_peak(rows, shakes), 1, 1e-9);
  shakes[0].amplitude *= 2;  // the rows are those of another motion
  EXPECT_NEAR(floor_peak(rows, shakes), 0.951, 1e-3);
}

TEST(PageRows, a_floor_that_stands_still_has_the_scale_of_one_that_moves) {
  std::vector<io::FrameRow> rows(2);
  rows[1].floor_acceleration[0] = 1e-11;
  std::vector<Shake> shakes(1);
  shakes[0].direction = Vec3::UnitX();
  EXPECT_EQ(floor_scale(rows, {}), 0.1);
  EXPECT_EQ(floor_scale(rows, shakes), 0.1);
  rows[1].floor_acceleration[0] = 2;
  EXPECT_EQ(floor_scale(rows, shakes), 2);
}

TEST(PageControls, each_changes_the_scene_as_it_says) {
  for (const char* name :
       {"paper-a", "anchored", "cabinet", "near-fault", "desk", "folding-leg", "weak-storey"}) {
    const io::Scene scene = io::load_scene(name);
    const std::vector<PageControl> controls = page_controls(scene);
    std::vector<double> values;
    for (const PageControl& control : controls) values.push_back(control.value);
    EXPECT_FALSE(controls.empty()) << name;
    EXPECT_TRUE(changes(controls, values).empty()) << name;
    for (std::size_t i = 0; i < controls.size(); ++i) {
      const PageControl& one = controls[i];
      EXPECT_LE(one.least, one.value) << name << " " << one.key;
      EXPECT_GE(one.most, one.value) << name << " " << one.key;
      std::vector<double> other = values;
      other[i] = one.kind == PageControl::Kind::toggle ? 1 - one.value
                 : one.value < one.most                ? one.value + 0.05 * (one.most - one.value)
                                                       : one.value - 0.05 * (one.value - one.least);
      for (std::size_t k = 0; k < controls.size(); ++k)
        if (controls[k].follows == static_cast<int>(i)) other[k] = controls[k].share * other[i];
      const std::vector<std::string> sets = changes(controls, other);
      ASSERT_EQ(sets.size(), 1u) << name << " " << one.key;
      EXPECT_EQ(sets[0].rfind(one.key + "=", 0), 0u) << sets[0];
      const auto changed = page_controls(io::load_scene(name, sets));
      ASSERT_EQ(changed.size(), controls.size()) << sets[0];
      EXPECT_NEAR(changed[i].value, other[i], 1e-6 * std::max(1., std::abs(other[i]))) << sets[0];
    }
  }
}

std::optional<PageControl> control(const std::vector<PageControl>& controls, const std::string& key) {
  const auto found = std::ranges::find(controls, key, &PageControl::key);
  return found == controls.end() ? std::nullopt : std::optional(*found);
}

/// The scene with one control at `value`.
io::Scene changed(const std::string& name, const std::string& key, double value) {
  const std::vector<PageControl> controls = page_controls(io::load_scene(name));
  std::vector<double> values;
  for (const PageControl& one : controls) values.push_back(one.key == key ? value : one.value);
  return io::load_scene(name, changes(controls, values));
}

const Body& body(const io::Scene& scene, const std::string& name) {
  return *std::ranges::find(scene.setup.model.bodies, name, &Body::name);
}

TEST(PageControls, anchors_and_fixings_stand_under_the_word_that_the_window_has_for_them) {
  int found = 0;
  for (const PageControl& one : page_controls(io::load_scene("anchored"))) {
    if (one.kind != PageControl::Kind::toggle || !one.key.starts_with("anchor.")) continue;
    ++found;
    EXPECT_EQ(one.heading.english, furnish_words::k_fixings.english);
    EXPECT_EQ(one.heading.japanese, furnish_words::k_fixings.japanese);
  }
  EXPECT_EQ(found, 2);
}

TEST(PageControls, a_frame_can_be_made_heavier) {
  const io::Scene scene = io::load_scene("folding-leg");
  const auto mass = control(page_controls(scene), "frame.table.mass");
  ASSERT_TRUE(mass);
  EXPECT_NEAR(mass->value, body(scene, "table").mass, 1e-9);
  for (const double kg : {mass->least, mass->most})
    EXPECT_NEAR(body(changed("folding-leg", mass->key, kg), "table").mass, kg, 1e-9);
}

TEST(PageControls, what_is_loaded_on_a_frame_changes_in_proportion) {
  const io::Scene scene = io::load_scene("weak-storey");
  const std::vector<PageControl> controls = page_controls(scene);
  EXPECT_FALSE(control(controls, "frame.rack.mass"));
  const auto loads = control(controls, "frame.rack.masses");
  ASSERT_TRUE(loads);
  EXPECT_NEAR(loads->value, 12 * 60, 1e-9);
  const io::Scene other = changed("weak-storey", loads->key, 900);
  EXPECT_NEAR(body(other, "rack").mass - body(scene, "rack").mass, 900 - 12 * 60, 1e-9);
  for (int node = 4; node < 16; ++node)
    EXPECT_NEAR(other.setup.model.node_mass[node] - scene.setup.model.node_mass[node], 75 - 60, 1e-9) << node;
}

TEST(PageControls, a_frame_of_given_mass_stays_heavier_than_its_loads) {
  const io::Scene scene = io::load_scene("weak-storey", {"frame.rack.mass=760"});
  const auto mass = control(page_controls(scene), "frame.rack.mass");
  ASSERT_TRUE(mass);
  EXPECT_GT(mass->least, 12 * 60);
  EXPECT_NO_THROW(io::load_scene("weak-storey", {fmt::format("frame.rack.mass={}", mass->least)}));
}

TEST(PageControls, friction_of_a_frame_is_that_of_all_contacts_until_it_is_set) {
  const std::vector<PageControl> controls = page_controls(io::load_scene("folding-leg"));
  std::vector<double> values;
  std::size_t of_all = 0, own = 0;
  for (std::size_t i = 0; i < controls.size(); ++i) {
    values.push_back(controls[i].value);
    if (controls[i].key == "contact.friction") of_all = i;
    if (controls[i].key == "frame.table.friction") own = i;
  }
  ASSERT_EQ(controls[own].follows, static_cast<int>(of_all));
  values[of_all] = values[own] = 0;
  EXPECT_EQ(changes(controls, values), std::vector<std::string>{"contact.friction=0"});
  values[of_all] = 0.4;
  values[own] = 0.3;
  const io::Scene scene = io::load_scene("folding-leg", changes(controls, values));
  EXPECT_EQ(scene.setup.parameters.contact.friction, 0.4);
  EXPECT_NEAR(0.4 * body(scene, "table").grip, 0.3, 1e-12);
  EXPECT_EQ(body(scene, "cabinet").grip, 1);
}

TEST(PageControls, centre_of_gravity_of_a_cabinet_stays_in_the_middle_until_it_is_set) {
  const std::string text =
      "topple = 1\n[run]\nduration = 1\n[floor]\nwidth = \"60 mm\"\n[[cabinet]]\nsection = \"box "
      "30x1\"\nmaterial = \"steel\"\nname = \"wardrobe\"\n"
      "size = [\"560 mm\", \"960 mm\", \"2260 mm\"]\nmass = \"90 kg\"\n";
  const std::vector<PageControl> controls = page_controls(io::parse_scene(text, "wardrobe.toml"));
  std::vector<double> values;
  std::size_t height = 0, centre = 0;
  for (std::size_t i = 0; i < controls.size(); ++i) {
    values.push_back(controls[i].value);
    if (controls[i].key == "cabinet.wardrobe.size" && controls[i].component == 2) height = i;
    if (controls[i].key == "cabinet.wardrobe.cg_height") centre = i;
  }
  ASSERT_EQ(controls[centre].follows, static_cast<int>(height));
  EXPECT_NEAR(controls[centre].value, 1130, 1e-9);
  values[height] = 1450;
  values[centre] = controls[centre].share * 1450;
  EXPECT_NEAR(values[centre], 725, 1e-9);
  const std::vector<std::string> sets = changes(controls, values);
  ASSERT_EQ(sets.size(), 1u);
  const io::Scene shorter = io::parse_scene(text, "wardrobe.toml", sets);
  const Body& wardrobe = body(shorter, "wardrobe");
  EXPECT_NEAR(wardrobe.centre_of_gravity.z() - wardrobe.base_centre.z(), 0.725, 1e-9);
}

TEST(PageControls, a_piece_that_starts_tilted_can_start_otherwise) {
  const io::Scene scene = io::load_scene("folding-leg");
  const auto tilt = control(page_controls(scene), "cabinet.cabinet.tilt");
  ASSERT_TRUE(tilt);
  EXPECT_EQ(tilt->value, 13);
  const auto start = [](const io::Scene& of) {
    return of.setup.starts[static_cast<std::size_t>(&body(of, "cabinet") - of.setup.model.bodies.data())];
  };
  for (const double degrees : {0., 5., -13.})
    EXPECT_NEAR(start(changed("folding-leg", tilt->key, degrees)).rotation.norm(),
                std::abs(degrees) * k_pi / 180, 1e-12);
}

TEST(PageControls, what_is_no_number_changes_nothing) {
  const std::vector<PageControl> controls = page_controls(io::load_scene("paper-a"));
  const std::vector<double> values(controls.size(), std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(changes(controls, values).empty());
}

TEST(Verdict, says_who_falls_first_and_who_stays) {
  const std::vector<BodyEnd> bodies = {{"a", 3.2, 90, 10.}, {"b", 1.5, 90, 10.}, {"c", {}, 2, 10.}};
  EXPECT_EQ(
      verdict_in_words(bodies, Language::english),
      "“b” overturns 1.50 s after the start of the run. “a” overturns 3.20 s after the start of the run. "
      "Not overturned: 1 of 3 bodies.");
  EXPECT_EQ(verdict_in_words({{"c", {}, 2, 10.}}, Language::english),
            "Nothing overturns. “c” comes nearest to it: it tilts by 2.00° of the 10.00° at which it would.");
  EXPECT_EQ(verdict_in_words({{"c", {}, 5, 20.}, {"d", {}, 4, 10.}, {"e", {}, 9, {}}}, Language::english),
            "Nothing overturns. “d” comes nearest to it: it tilts by 4.00° of the 10.00° at which it would.");
  EXPECT_EQ(verdict_in_words({{"c", {}, 2, 10., true}}, Language::english),
            "Nothing overturns. “c” comes nearest to it: it tilts by 2.00°; without what holds it, it would "
            "overturn from 10.00° on.");
  EXPECT_EQ(verdict_in_words({}, Language::english), "");
}

TEST(ReplayOnly, three_times_the_wall_time_of_the_run_may_be_three_seconds) {
  const io::Scene scene = io::load_scene("paper-a");
  const auto word = [&](const std::string& summary, bool edited = false) {
    return std::string(why_replay_only(scene, {.summary = summary, .edited = edited}).word);
  };
  EXPECT_EQ(word("{\"wall_s\": 0.999}"), "");
  EXPECT_EQ(word("{\"wall_s\": 1.001}"), "replay_stress");
  EXPECT_EQ(
      why_replay_only(io::load_scene("paper-a", {"run.want=[\"motion\"]"}), {.summary = "{\"wall_s\": 2}"})
          .word,
      "replay_only");
  EXPECT_DOUBLE_EQ(why_replay_only(scene, {.summary = "{\"wall_s\": 1.2}"}).seconds, 3.6);
  EXPECT_EQ(word(""), "");
  EXPECT_EQ(word("{\"wall_s\": 0.1}", true), "replay_edits");
  EXPECT_EQ(why_replay_only(io::load_scene("portal-pushover"), {}).word, "replay_static");
}

std::string from_base64(const std::string& text) {
  static const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  unsigned bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<unsigned>(digits.find(c));
    count += 6;
    if (count >= 8) out += static_cast<char>(bits >> (count -= 8) & 0xff);
  }
  return out;
}

class ExportPageTest : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    if (!can_make_pages()) GTEST_SKIP() << "built without emscripten";
  }

  /// The page's own account of the run.
  static nlohmann::ordered_json data_of(const std::string& page) {
    const std::string begin = "<script id=\"data\" type=\"application/json\">";
    const std::size_t at = page.find(begin) + begin.size();
    return json_of(page.substr(at, page.find("</script>", at) - at));
  }

  /// A recording of a block's run, with this wall time in its summary.
  static void record_block(const std::string& file, double wall, bool edited = false) {
    const io::Scene scene = io::parse_scene(
        "topple = 1\nfloor = {}\n[run]\nduration = 0.1\nwant = [\"motion\"]\n[[block]]\n"
        "size = [0.3, 0.6, 1.5]\nmass = 60\n",
        "block.toml");
    topple::Run run(scene.setup);
    io::Observer observer;
    io::Recorder recorder({file, true}, scene.name, scene.text, scene.setup.model);
    if (edited) recorder.write(LoggedEdit{.edit = {Edit::Key::friction, 0, Vec3(0.3, 0, 0)}});
    recorder.write(observer.observe(run));
    while (!run.over()) run.advance(), recorder.write(observer.observe(run));
    recorder.write(observer.last(run));
    recorder.finish("completed", nlohmann::ordered_json({{"wall_s", wall}}).dump());
  }
};

TEST_F(ExportPageTest, a_run_that_takes_long_is_replayed_only_and_the_page_says_so) {
  for (const auto& [wall, live] : {std::pair(0.9, true), std::pair(1.3, false)}) {
    record_block("block.h5", wall);
    ASSERT_EQ(topple({"export", "block.h5", "--page", "page.html", "--force"}).code, 0);
    const std::string page = bytes_of("page.html");
    EXPECT_EQ(data_of(page)["live"], live);
    EXPECT_EQ(data_of(page)["reason"], live ? "" : "replay_only");
    EXPECT_EQ(page.find("This page replays only: a run takes about 4 s in a browser, more than the 3 s that "
                        "a page may take.") == std::string::npos,
              live);
  }
  ASSERT_EQ(topple({"export", "block.h5", "--page", "page.html", "--lang", "ja", "--force"}).code, 0);
  EXPECT_NE(bytes_of("page.html").find("このページは再生のみ。1回の計算にブラウザーで約4秒かかり"),
            std::string::npos);
}

// 18.83: the portal's load when a hinge is at each of its four corners.
TEST_F(ExportPageTest, of_loads_that_grow_the_greatest_is_told_and_no_tilt) {
  ASSERT_EQ(topple({"export", "portal-pushover", "--page", "page.html"}).code, 0);
  EXPECT_NE(bytes_of("page.html").find(">Greatest load factor: 18.83. Plastic hinges: 4.</p>"),
            std::string::npos);
  ASSERT_EQ(topple({"export", "portal-pushover", "--page", "page.html", "--lang", "ja"}).code, 0);
  EXPECT_NE(bytes_of("page.html").find(">最大荷重係数：18.83。塑性ヒンジ：4か所。</p>"), std::string::npos);
}

TEST_F(ExportPageTest, the_title_of_a_run_that_was_edited_says_so_in_the_words_of_the_window) {
  const auto title = [](bool edited, const char* language) {
    record_block("block.h5", 0.1, edited);
    EXPECT_EQ(topple({"export", "block.h5", "--page", "page.html", "--lang", language, "--force"}).code, 0);
    const std::string page = bytes_of("page.html"), begin = "<title>";
    const std::size_t at = page.find(begin) + begin.size();
    return page.substr(at, page.find('<', at) - at);
  };
  EXPECT_EQ(title(false, "en"), "block");
  EXPECT_EQ(title(true, "en"), "block (changed)");
  EXPECT_EQ(title(true, "ja"), "block（変更あり）");
}

TEST_F(ExportPageTest, ten_thousand_rows_are_thinned_evenly_and_the_last_is_kept) {
  write_bytes("long.toml",
              "topple = 1\nfloor = {}\nshake = [{ type = \"sine\", frequency = 1, amplitude = 3 }]\n"
              "[run]\nduration = 10\noutput_rate = 1000\nwant = [\"motion\"]\n"
              "[[block]]\nsize = [0.3, 0.6, 1.5]\nmass = 60\n");
  ASSERT_EQ(topple({"run", "long.toml", "-o", "long.h5", "--quiet"}).code, 0);
  ASSERT_EQ(topple({"export", "long.h5", "--page", "page.html"}).code, 0);
  const nlohmann::ordered_json data = data_of(bytes_of("page.html"));
  const io::Recording recording("long.h5");
  const auto& all = recording.index();
  ASSERT_GT(all.size(), 10000u);
  const auto stride = data["stride"].get<std::size_t>();
  const std::string bytes = from_base64(data["rows"]);
  EXPECT_LE(bytes.size(), k_most_page_bytes);
  const Model model = recorded_scene(recording).setup.model;
  const auto fits = [&](std::size_t every) {
    return ((all.size() - 1 + every - 1) / every + 1) * packed_size(model) <= k_most_page_bytes;
  };
  EXPECT_TRUE(fits(stride));
  EXPECT_FALSE(fits(stride - 1)) << "rows are left out that would fit";
  std::vector<double> expected;
  for (std::size_t i = 0; i < all.size(); i += stride) expected.push_back(all[i].time);
  if ((all.size() - 1) % stride != 0) expected.push_back(all.back().time);
  std::vector<double> times;
  for (const io::FrameRow& row : unpack_rows(model, bytes)) times.push_back(row.time);
  EXPECT_EQ(times, expected);
}

// Rows stand a third of a second apart.
TEST_F(ExportPageTest, who_is_hit_is_told_as_the_run_found_it) {
  write_bytes("hit.toml",
              "topple = 1\nfloor = {}\nplace = [{ name = \"bed\", at = [1, 0] }]\n"
              "run = { duration = 2, output_rate = 3, settle = false }\n"
              "[[block]]\nname = \"box\"\nsize = [0.3, 0.6, 1.5]\nmass = 60\ntilt = \"14 deg\"\n");
  const Ended run = topple({"run", "hit.toml", "-o", "hit.h5", "--quiet", "--json", "-"});
  ASSERT_EQ(run.code, 0) << run.err;
  ASSERT_EQ(topple({"export", "hit.h5", "--page", "page.html"}).code, 0);
  const nlohmann::ordered_json hit = json_of(run.out)["ways"][0]["hit_by"][0];
  EXPECT_EQ(
      data_of(bytes_of("page.html"))["hits"],
      nlohmann::ordered_json::parse(R"([{"place": 0, "body": 0, "time_s": )" + hit["time_s"].dump() + "}]"));
}

// Between rows 43 ms apart, where no summary has the time of the step.
TEST_F(ExportPageTest, without_a_summary_a_body_overturns_between_two_rows) {
  const io::Scene scene = io::parse_scene(
      "topple = 1\nfloor = {}\nrun = { duration = 3, output_rate = 23 }\n"
      "shake = [{ type = \"sine\", amplitude = \"500 gal\", frequency = 1 }]\n"
      "[[block]]\nsize = [0.3, 0.6, 1.5]\nmass = 60\n",
      "block.toml");
  topple::Run run(scene.setup);
  io::Observer observer;
  io::Recorder recorder({"block.h5", true}, scene.name, scene.text, scene.setup.model);
  recorder.write(observer.observe(run));
  while (!run.over()) run.advance(), recorder.write(observer.observe(run));
  recorder.finish("stopped", "");
  const std::optional<double> overturned = run.outcome().bodies()[0].beyond_since;
  ASSERT_TRUE(overturned);
  ASSERT_GT(std::abs(23 * *overturned - std::round(23 * *overturned)), 0.1);
  ASSERT_EQ(topple({"export", "block.h5", "--page", "page.html"}).code, 0);
  EXPECT_NEAR(data_of(bytes_of("page.html"))["bodies"][0]["overturn_time_s"].get<double>(), *overturned,
              1e-3);  // of 43 ms
}

TEST_F(ExportPageTest, a_scene_is_changed_as_by_run) {
  const std::vector<std::string> sets = {"--set", "run.duration=0.2", "--set", "cabinet.free.mass=99 kg"};
  const auto with_sets = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), sets.begin(), sets.end());
    return arguments;
  };
  ASSERT_EQ(topple(with_sets({"run", "paper-a", "-o", "run.h5", "--quiet"})).code, 0);
  ASSERT_EQ(topple(with_sets({"export", "paper-a", "--page", "page.html", "--quiet"})).code, 0);
  const nlohmann::ordered_json data = data_of(bytes_of("page.html"));
  ASSERT_EQ(data["stride"], 1);
  const io::Recording recording("run.h5");
  EXPECT_EQ(data["text"], recording.scene_text());
  const io::Scene scene = io::parse_scene(data["text"].get<std::string>(), "page.toml");
  EXPECT_EQ(scene.setup.model.bodies[0].name, "free");
  EXPECT_NEAR(scene.setup.model.bodies[0].mass, 99, 1e-9);
  const std::vector<io::FrameRow> rows = unpack_rows(scene.setup.model, from_base64(data["rows"]));
  ASSERT_EQ(rows.size(), static_cast<std::size_t>(recording.frame_count()));
  EXPECT_EQ(rows.back().position, recording.frame(recording.frame_count() - 1).position);
  expect_one_line({"export", "paper-a", "--page", "other.html", "--set", "cabinet.fre.mass=99"}, 2,
                  "cabinet.fre");
  expect_one_line({"export", "run.h5", "--page", "other.html", "--set", "run.duration=1"}, 2,
                  "--set: run.h5 is a recording");
  EXPECT_FALSE(std::filesystem::exists("other.html"));
}

TEST_F(ProgramTest, only_a_scene_for_a_page_can_be_changed) {
  write_bytes("one.h5", k_older_recording);
  expect_one_line({"export", "one.h5", "--csv", "folder", "--set", "run.duration=1"}, 2,
                  "--set: only a scene");
}

TEST_F(ExportPageTest, still_pictures_are_the_start_the_greatest_tilt_and_the_end) {
  ASSERT_EQ(topple({"export", "paper-a", "--page", "page.html", "--quiet", "--set", "run.duration=2"}).code,
            0);
  const std::string page = bytes_of("page.html");
  const nlohmann::ordered_json data = data_of(page);
  ASSERT_EQ(data["stride"], 1);
  const Model model = io::load_scene("paper-a").setup.model;
  const std::vector<io::FrameRow> rows = unpack_rows(model, from_base64(data["rows"]));
  double greatest = 0, at = 0;
  for (const io::FrameRow& row : rows)
    for (const io::BodyNumbers& body : row.body)
      if (body.critical_angle > 0 && body.tilt / body.critical_angle > greatest)
        greatest = body.tilt / body.critical_angle, at = row.time;
  std::size_t from = 0;
  for (const double time : {rows.front().time, at, rows.back().time}) {
    const std::string still = fmt::format("<img alt=\"{:.2f} s\" src=\"data:image/png;base64,", time);
    from = page.find(still, from);
    ASSERT_NE(from, std::string::npos) << still;
    from += still.size();
    EXPECT_EQ(from_base64(page.substr(from, 12)).substr(1, 3), "PNG");
  }
}

TEST_F(ExportPageTest, texts_of_a_scene_do_not_become_parts_of_the_page) {
  write_bytes("bad.toml",
              "topple = 1\ntitle = \"</script><script>alert(1)</script> @DATA@\"\nfloor = {}\n"
              "[run]\nduration = 0.1\nwant = [\"motion\"]\n[[block]]\nname = \"<b>\"\n"
              "size = [0.3, 0.6, 1.5]\nmass = 60\n");
  ASSERT_EQ(topple({"export", "bad.toml", "--page", "page.html"}).code, 0);
  const std::string page = bytes_of("page.html");
  EXPECT_EQ(page.find("<script>alert"), std::string::npos);
  EXPECT_EQ(page.find("<b>"), std::string::npos);
  EXPECT_NE(page.find("&lt;/script&gt;&lt;script&gt;alert(1)"), std::string::npos);
  EXPECT_NE(page.find("<script id=\"data\" type=\"application/json\">{\"name\":\"bad\""), std::string::npos);
}

TEST_F(ProgramTest, a_page_that_cannot_be_made_is_refused_in_one_line) {
  write_bytes("lost.toml", "topple = 1\n[[shake]]\ntype = \"record\"\nfiles = [\"lost.csv\"]\n");
  const Ended lost = topple({"export", "lost.toml", "--page", "page.html"});
  EXPECT_EQ(lost.code, 2);
  EXPECT_EQ(std::ranges::count(lost.err, '\n'), 1) << lost.err;
  EXPECT_NE(lost.err.find(can_make_pages() ? "lost.csv" : "emscripten"), std::string::npos) << lost.err;
  EXPECT_FALSE(std::filesystem::exists("page.html"));
}

}  // namespace
}  // namespace topple::app
