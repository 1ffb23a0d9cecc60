// topple report: what the page says, and that it is one file a browser shows.
#include "app/report/report.h"

#include <fmt/format.h>

#include <cmath>
#include <regex>

#include "app/batch/summary.h"
#include "app/report/svg_chart.h"
#include "unit/app/program.h"
#include "unit/app/scenes.h"

namespace topple::app {
namespace {

using Json = nlohmann::ordered_json;

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// It is a planar block throughout.
constexpr const char* k_lone_block =
    "topple = 1\n[run]\nduration = 0.3\nwant = [\"motion\"]\n[floor]\n"
    "[[shake]]\ntype = \"sine\"\namplitude = \"100 gal\"\nfrequency = 1\n"
    "[[block]]\nname = \"box\"\nsize = [0.4, 0.5, 1.8]\nmass = 50\n";

/// The page of a run of k_shaken, made without pictures and trials.
class ReportPageTest : public ::testing::Test {
 protected:
  ReportPageTest() : scene_(io::parse_scene(k_shaken, "s.toml")) {
    topple::Run run(scene_.setup);
    while (!run.over()) EXPECT_TRUE(run.advance().ok());
    report_.scene = &scene_;
    report_.command = "topple report s.toml";
    report_.summary = summary(scene_, run, "completed", 1);
    report_.summary["error_estimate"] = error_estimate(scene_.setup, run.outcome(), run.outcome());
    report_.motion = study::floor_motion(scene_.setup.parameters.shakes, 0.3);
    report_.tilts = {{.time = {0, 0.3}, .tilt = {0, 1}, .critical = 10.3}};
    report_.spread = 0.05;
  }
  /// Runs another scene to its end and tells of that.
  void tell_of(const io::Scene& scene) {
    topple::Run run(scene.setup);
    while (!run.over()) ASSERT_TRUE(run.advance().ok());
    report_.scene = &scene;
    report_.summary = summary(scene, run, "completed", 1);
    report_.summary["error_estimate"] = error_estimate(scene.setup, run.outcome(), run.outcome());
  }
  std::string page(Language language = Language::english) const { return report_page(report_, language); }

  io::Scene scene_;
  Report report_;
};

TEST_F(ReportPageTest, names_are_text_and_never_markup) {
  scene_.title = "<script>alert('x')</script> & \"more\"";
  report_.summary["bodies"][0]["name"] = "<b>bold</b>";
  const std::string html = page();
  EXPECT_FALSE(holds(html, "<script"));
  EXPECT_FALSE(holds(html, "<b>bold"));
  EXPECT_TRUE(holds(html, "&lt;script&gt;alert(&#39;x&#39;)&lt;/script&gt; &amp; &quot;more&quot;"));
  EXPECT_EQ(escaped("a\x01\xff"
                    "b"),
            "a\uFFFDb");
}

TEST_F(ReportPageTest, anchors_are_compared_where_there_are_some) {
  EXPECT_FALSE(holds(page(), "With and without anchors"));
  EXPECT_TRUE(holds(page(), "3. How certain this is"));
  EXPECT_TRUE(holds(page(), "No anchor, strap or pole holds the furniture"));
  const io::Scene scene = io::parse_scene(k_shaken + k_straps, "s.toml");
  tell_of(scene);
  report_.without_anchors = report_.summary;
  (*report_.without_anchors)["bodies"][0]["overturned"] = true;
  (*report_.without_anchors)["bodies"][0]["overturn_time_s"] = 0.25;
  const std::string html = page();
  EXPECT_TRUE(holds(html, "3. With and without anchors"));
  EXPECT_TRUE(holds(html, "4. How certain this is"));
  EXPECT_TRUE(holds(html, "<td>0.25</td>"));
  EXPECT_FALSE(holds(html, "No anchor, strap or pole"));
  EXPECT_TRUE(holds(page(Language::japanese), "固定具の有無による違い"));
}

TEST_F(ReportPageTest, what_the_run_without_anchors_is_warned_of_stands_beside_it) {
  const io::Scene scene = io::parse_scene(k_shaken + k_straps, "s.toml");
  tell_of(scene);
  report_.summary["warnings"] = {"both"};
  report_.without_anchors = report_.summary;
  EXPECT_FALSE(holds(page(), "warns of the run without anchors"));
  (*report_.without_anchors)["warnings"].push_back("the stress in body \"box\" is beyond < all");
  const std::string html = page();
  EXPECT_TRUE(holds(html,
                    "<p>The program warns of the run without anchors:</p>\n<ul lang=\"en\">\n"
                    "<li>the stress in body &quot;box&quot; is beyond &lt; all</li>\n</ul>"));
  EXPECT_LT(html.find("is beyond &lt; all"), html.find("How certain this is"));
  EXPECT_TRUE(holds(page(Language::japanese), "固定なしの計算に対するプログラムの警告（英語）："));
}

// A place that has no door, too.
TEST_F(ReportPageTest, who_gets_out_is_compared_with_and_without_what_holds) {
  const io::Scene scene = io::parse_scene(k_shaken + k_straps, "s.toml");
  tell_of(scene);
  const auto way = [](const char* place, const Json& open) {
    return Json{{"place", place},
                {"door", "door"},
                {"open", open},
                {"widest_m", 0.6},
                {"length_m", 2.},
                {"caught", false},
                {"hit_by", Json::array()},
                {"blocked_by", Json::array()},
                {"before", {{"open", true}, {"widest_m", 0.6}}}};
  };
  report_.summary["person_m"] = 0.5;
  report_.summary["ways"] = {way("desk", true), way("cell", nullptr)};
  report_.nodes_at_start = report_.nodes_at_end = scene.setup.model.node_position;
  report_.without_anchors = report_.summary;
  (*report_.without_anchors)["ways"][0]["open"] = false;
  const std::string html = page();
  EXPECT_TRUE(
      holds(html, "<th scope=\"col\">way, with anchors</th><th scope=\"col\">way, without anchors</th>"));
  EXPECT_TRUE(holds(html, "<th scope=\"row\">desk</th><td>open</td><td>closed</td>"));
  EXPECT_TRUE(holds(html, "<th scope=\"row\">cell</th><td>\u2013</td><td>\u2013</td>"));
  EXPECT_TRUE(holds(page(Language::japanese), "<td>通れる</td><td>通れない</td>"));
}

TEST_F(ReportPageTest, what_a_stopper_lifts_is_held_and_what_an_anchor_away_held_is_not) {
  const std::string said = "Nothing holds box: what differs there";
  const auto is_told = [&](const std::string& more, std::vector<std::string> changes) {
    const io::Scene scene = io::parse_scene(k_lone_block + more, "s.toml", changes);
    tell_of(scene);
    report_.without_anchors = report_.summary;
    (*report_.without_anchors)["bodies"][0]["overturned"] = true;
    return holds(page(), said);
  };
  const std::string stopper =
      "[[wall]]\nname = \"back\"\nat = [-0.26, 0]\nnormal = [1, 0, 0]\n[[fixing]]\nname = \"stop\"\nbody = "
      "\"box\"\nkind = \"stopper\"\nto = \"floor\"\n";
  const std::string strap =
      "[[anchor]]\nname = \"strap\"\nbody = \"box\"\npoint = [0, 0, 1.8]\nto = [-1, 0, 1.8]\n"
      "stiffness = 1e4\n";
  EXPECT_FALSE(is_told(stopper, {}));
  EXPECT_TRUE(is_told(stopper, {"fixing.stop.on=false"}));
  EXPECT_FALSE(is_told(strap, {}));
  EXPECT_TRUE(is_told(strap, {"anchor.strap.on=false"}));
}

TEST_F(ReportPageTest, what_the_stress_of_a_section_that_flows_is_is_told_where_hinges_formed) {
  EXPECT_FALSE(holds(page(), "N/A + M/W"));
  report_.summary["bodies"][0]["hinges"] = 1;
  EXPECT_TRUE(holds(page(), "told as if it were elastic, N/A + M/W"));
  EXPECT_TRUE(holds(page(Language::japanese), "塑性ヒンジ"));
}

TEST_F(ReportPageTest, a_run_that_was_stopped_says_until_when_all_of_it_is) {
  EXPECT_FALSE(holds(page(), "All on this page is until"));
  report_.summary["status"] = "stopped";
  report_.summary["simulated_s"] = 5.46;
  EXPECT_TRUE(holds(page(), "All on this page is until 5.46 s"));
  EXPECT_TRUE(holds(page(Language::japanese), "5.46秒まで"));
}

TEST_F(ReportPageTest, titles_of_built_in_scenes_are_in_the_language_of_the_page) {
  scene_.title = "A cantilever under a sudden tip load";
  EXPECT_TRUE(holds(page(), "<h1>A cantilever under a sudden tip load</h1>"));
  EXPECT_TRUE(holds(page(Language::japanese), "<h1>先端に急に荷重がかかる片持ち梁</h1>"));
  scene_.title += " (changed)";
  EXPECT_TRUE(holds(page(Language::japanese), "<h1>先端に急に荷重がかかる片持ち梁（変更あり）</h1>"));
}

// 50 kN/m and 2 kN, and what the summary says of the run.
TEST_F(ReportPageTest, an_anchor_stands_with_its_name_its_force_and_its_share_of_the_strength) {
  const io::Scene scene = io::parse_scene(k_shaken + k_straps + "strength = \"2 kN\"\n", "s.toml");
  tell_of(scene);
  report_.without_anchors = report_.summary;
  const double force = report_.summary["anchors"][1]["peak_force_N"];
  report_.summary["error_estimate"]["anchors"][1]["peak_force_N"] = nullptr;
  ASSERT_GT(force, 0);
  const std::string html = page();
  EXPECT_TRUE(holds(html, "<th scope=\"row\">strong</th>"));
  EXPECT_TRUE(holds(html, fmt::format("<td>50</td><td>2000</td><td>{:.4g}</td><td>{:.0f} %</td>", force,
                                      100 * force / 2000)));
  report_.summary["error_estimate"]["anchors"][1]["peak_force_N"] = 3;
  EXPECT_TRUE(holds(page(), fmt::format("<td>50</td><td>2000</td><td>{:.0f} ± 3</td>", force)));
  EXPECT_TRUE(holds(html, "<td>50</td><td>1</td>"));
  EXPECT_TRUE(holds(html, "<td>breaks at "));
  for (int k = 0; k < 21; ++k)
    report_.trials.push_back(
        {.factor = 1, .finished = true, .overturned = {false}, .open = {}, .broke = {k > 0, k > 12}});
  const std::string tried = page();
  EXPECT_TRUE(holds(tried, "broke in"));
  EXPECT_TRUE(holds(tried, "20 of 21 runs"));
  EXPECT_TRUE(holds(tried, "8 of 21 runs"));
}

TEST_F(ReportPageTest, anchors_that_are_not_in_place_are_said_to_be_so_and_hold_nothing) {
  const io::Scene scene =
      io::parse_scene(k_shaken + k_straps, "s.toml", {"anchor.weak.on=false", "anchor.strong.on=false"});
  tell_of(scene);
  const std::string html = page();
  EXPECT_TRUE(holds(html, "3. Anchors, none of them in place"));
  EXPECT_TRUE(holds(html, "<td>50</td><td>1</td><td>\u2013</td><td>not in place</td>"));
  EXPECT_FALSE(holds(html, "The same run with all of them removed"));
  EXPECT_TRUE(holds(html, "4. How certain this is"));
  EXPECT_TRUE(holds(html, "No anchor, strap or pole holds the furniture"));
}

TEST_F(ReportPageTest, what_moved_a_body_is_named_and_not_what_frames_would_have_had) {
  const io::Scene scene = io::parse_scene(k_shaken, "s.toml", {"cabinet.free.model=elastic"});
  tell_of(scene);
  const std::string html = page();
  EXPECT_TRUE(holds(html, "<td>central differences</td>"));
  EXPECT_FALSE(holds(html, "generalized-alpha"));
  EXPECT_TRUE(holds(html, "rigid motion with elastic modes"));
}

TEST_F(ReportPageTest, planar_blocks_are_not_said_to_stand_on_springs) {
  EXPECT_TRUE(holds(page(), "penalty coefficient"));
  const io::Scene scene = io::parse_scene(k_lone_block, "s.toml");
  tell_of(scene);
  const std::string html = page();
  EXPECT_TRUE(holds(html, "rigid block in a vertical plane"));
  EXPECT_FALSE(holds(html, "penalty"));
  EXPECT_FALSE(holds(html, "is a spring"));
  EXPECT_TRUE(holds(html, "a planar block has no springs"));
  // What fell lies on springs; what has points between its edges rocks on them.
  const io::Scene shaken =
      io::parse_scene(k_lone_block, "s.toml", {"run.duration=4", "shake.1.amplitude=500 gal"});
  tell_of(shaken);
  const std::string fell = page();
  EXPECT_TRUE(holds(fell, "Contact of a planar block is rigid"));
  EXPECT_TRUE(holds(fell, "is a spring"));
  EXPECT_TRUE(holds(fell, "penalty coefficient"));
  const io::Scene edges = io::parse_scene(
      k_shaken, "s.toml", {"cabinet.free.model=planar", "run.want=[\"motion\"]", "contact.restitution=0"});
  tell_of(edges);
  const std::string on_edges = page();
  EXPECT_TRUE(holds(on_edges, "rigid block in a vertical plane"));
  EXPECT_FALSE(holds(on_edges, "Contact of a planar block is rigid"));
  EXPECT_TRUE(holds(on_edges, "is a spring"));
}

TEST_F(ReportPageTest, what_falls_at_one_instant_has_no_order) {
  const io::Scene scene =
      io::parse_scene(std::string(k_lone_block) +
                          "[[block]]\nname = \"twin\"\nsize = [0.4, 0.5, 1.8]\nmass = 50\nat = [0, 3]\n"
                          "[[block]]\nname = \"late\"\nsize = [0.45, 0.5, 1.8]\nmass = 50\nat = [0, 6]\n",
                      "s.toml", {"run.duration=4", "shake.1.amplitude=500 gal"});
  tell_of(scene);
  report_.tilts.resize(3, report_.tilts[0]);
  EXPECT_TRUE(report_.summary["bodies"][2]["overturned"].get<bool>());
  EXPECT_TRUE(holds(page(), "first overturning: box, twin<"));
}

TEST_F(ReportPageTest, elastic_stresses_are_not_said_to_be_those_of_steel) {
  EXPECT_TRUE(holds(page(), "Stresses are elastic"));
  EXPECT_FALSE(holds(page(), "real steel"));
}

// All but the one at the back stand far from the piece, the door and the person.
TEST_F(ReportPageTest, the_plan_of_a_room_has_all_its_walls) {
  const io::Scene scene =
      io::parse_scene(std::string(k_lone_block) +
                          "at = [-1.8, 0]\n[[place]]\nname = \"desk\"\nat = [-1, 0]\n"
                          "[[door]]\nname = \"door\"\nwall = \"back\"\nat = 1\nwidth = 0.8\n"
                          "[[wall]]\nname = \"back\"\nat = [-2.1, 0]\nnormal = [1, 0, 0]\n"
                          "[[wall]]\nname = \"front\"\nat = [1.5, 0]\nnormal = [-1, 0, 0]\n"
                          "[[wall]]\nname = \"left\"\nat = [0, 2.5]\nnormal = [0, -1, 0]\n"
                          "[[wall]]\nname = \"right\"\nat = [0, -2.5]\nnormal = [0, 1, 0]\n",
                      "s.toml");
  tell_of(scene);
  report_.nodes_at_start = report_.nodes_at_end = scene.setup.model.node_position;
  const std::string html = page();
  EXPECT_TRUE(holds(html, "Every place keeps a way out; the narrowest is 0.80 m wide, from “desk”."));
  const std::regex wall(
      "<line x1=\"(.*?)\" y1=\"(.*?)\" x2=\"(.*?)\" y2=\"(.*?)\" stroke=\"#222\" stroke-width=\"5\"/>");
  int lines = 0;
  for (std::sregex_iterator line(html.begin(), html.end(), wall), end; line != end; ++line, ++lines)
    for (int k = 1; k <= 4; ++k) {
      EXPECT_GE(std::stod((*line)[k]), 0) << line->str();
      EXPECT_LE(std::stod((*line)[k]), k % 2 == 1 ? 720 : 620) << line->str();
    }
  EXPECT_EQ(lines, 5);  // the one with the door is in two parts
}

// Whatever the peak of the floor: a scale needs more than its zero.
TEST(SvgChart, the_axis_of_a_low_chart_has_ticks_beside_zero) {
  for (double peak = 1; peak < 10; peak *= 1.03) {
    LineChart chart;
    chart.y_from = -1.1 * peak, chart.y_to = 1.1 * peak;
    chart.x_to = 1;
    chart.height = 170;
    const std::string svg = svg_chart(chart);
    std::size_t ticks = 0;
    for (std::size_t at = svg.find("text-anchor=\"end\""); at != std::string::npos;
         at = svg.find("text-anchor=\"end\"", at + 1))
      ++ticks;
    EXPECT_GE(ticks, 3u) << peak;
    EXPECT_LE(ticks, 7u) << peak;
  }
}

TEST_F(ReportPageTest, a_share_stands_with_its_interval) {
  for (int k = 0; k < 21; ++k)
    report_.trials.push_back(
        {.factor = 0.95 + 0.005 * k, .finished = true, .overturned = {k >= 13}, .open = {}, .broke = {}});
  const std::string html = page();
  EXPECT_TRUE(holds(html, "8 of 21 runs"));
  EXPECT_TRUE(holds(html, "<td>38 %</td><td>21\u201359 %</td>"));  // Wilson: 0.2075 to 0.5912
  EXPECT_TRUE(holds(html, "turns on small differences in the shaking"));
  EXPECT_TRUE(holds(page(Language::japanese), "21回中8回"));
  report_.trials[0].finished = false;
  EXPECT_TRUE(holds(page(), "1 of 21 runs failed and are left out: with the input times "));
  EXPECT_TRUE(holds(page(), "8 of 20 runs"));
}

// One that leans farther is farther from its own critical angle: 0.54 of 20, 0.5 of 7.
TEST_F(ReportPageTest, the_figure_at_the_top_is_the_one_that_the_sentence_tells) {
  Json near = report_.summary["bodies"][0];
  near["overturned"] = false;
  near["overturn_time_s"] = near["first_beyond_critical_s"] = nullptr;
  Json far = near;
  near["name"] = "near", near["peak_tilt_deg"] = 0.5, near["peak_critical_share"] = 0.5 / 7;
  far["name"] = "far", far["peak_tilt_deg"] = 0.54, far["peak_critical_share"] = 0.54 / 20;
  report_.summary["bodies"] = {near, far};
  report_.summary["error_estimate"]["bodies"] = {report_.summary["error_estimate"]["bodies"][0],
                                                 report_.summary["error_estimate"]["bodies"][0]};
  report_.tilts = {{.time = {0, 0.3}, .tilt = {0, 0.5}, .critical = 7},
                   {.time = {0, 0.3}, .tilt = {0, 0.54}, .critical = 20}};
  const std::string html = page();
  EXPECT_TRUE(holds(html, "“near” comes nearest to it: it tilts by 0.50° of the 7.00° at which it would."));
  EXPECT_TRUE(holds(html, "<b>0.50°</b><span>tilt of what comes nearest to overturning: near</span>"));
  EXPECT_TRUE(holds(html, "<td>7.00</td>"));
  EXPECT_TRUE(holds(html, "<td>20.00</td>"));
  report_.tilts[0].critical = report_.tilts[1].critical = {};
  EXPECT_TRUE(holds(page(), "“far” tilts most, by 0.54°."));
  EXPECT_TRUE(holds(page(), "<b>0.54°</b><span>greatest tilt: far</span>"));
}

TEST_F(ReportPageTest, an_open_verdict_is_said_at_the_top_and_has_no_number) {
  Json& e = report_.summary["error_estimate"];
  e["disagreements"] = {"free does not overturn, but at 0.2 s when refined"};
  e["bodies"][0] = {{"name", "free"},           {"same_course", false},    {"overturn_time_s", nullptr},
                    {"peak_tilt_deg", nullptr}, {"peak_slide_m", nullptr}, {"peak_stress_Pa", nullptr}};
  const std::string html = page();
  EXPECT_TRUE(holds(html, "A finer computation takes another course (section 3)"));
  EXPECT_TRUE(holds(html, "when, or whether, “free” falls."));
  EXPECT_TRUE(holds(html, "“free” stays standing, but overturns in the finer run"));
  EXPECT_FALSE(holds(html, " ± 0"));
}

/// What the base64 of a picture happens to spell says nothing.
std::string without_pictures(std::string html) {
  const std::string begin = "base64,";
  for (std::size_t at = 0; (at = html.find(begin, at)) != std::string::npos; ++at)
    html.erase(at, html.find('"', at) - at);
  return html;
}

class ReportTest : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write_bytes("s.toml", k_shaken);
  }
  static std::string made(const std::vector<std::string>& more) {
    std::vector<std::string> call{"report", "s.toml", "-o", "r.html", "--quiet"};
    call.insert(call.end(), more.begin(), more.end());
    const Ended ended = topple(call);
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_EQ(ended.out, "report: r.html\n");
    return bytes_of("r.html");
  }
};

TEST_F(ReportTest, the_page_is_one_file_that_refers_to_nothing) {
  const std::string html = made({});
  EXPECT_EQ(files(), (std::vector<std::string>{"r.html", "s.toml"}));
  const std::string plain = without_pictures(html);
  for (const char* part : {"http", "//", "<script", "<iframe", "url(", "@import", "srcset"})
    EXPECT_FALSE(holds(plain, part)) << part;
  for (const char* attribute : {"src=\"", "href=\""})
    for (std::size_t at = plain.find(attribute); at != std::string::npos; at = plain.find(attribute, at + 1))
      EXPECT_EQ(plain.compare(plain.find('"', at) + 1, 5, "data:"), 0) << plain.substr(at, 40);
  for (const char* part :
       {"A cabinet for tests", "400 gal", "JMA ", "instrumental intensity", "critical angle", "0 of 21 runs",
        "95 % interval (Wilson)", "half the step (0.5 ms, and half the parts of rigid and elastic bodies)",
        "Not validated against experiment", "50 kgf (490.33 N)", "topple " TOPPLE_VERSION,
        "central differences",  // of its elastic model; generalized-alpha moves frames alone
        "data:image/png;base64,iVBORw0KGgo"})
    EXPECT_TRUE(holds(html, part)) << part;
}

TEST_F(ReportTest, the_same_scene_gives_the_same_page) {
  EXPECT_EQ(made({"--jobs", "1"}), made({"--jobs", "2"}));
}

TEST_F(ReportTest, japanese_pages_are_japanese) {
  const std::string html = made({"--lang", "ja", "--set", "shake.1.amplitude=300 gal"});
  for (const char* part : {"<html lang=\"ja\">", "計測震度相当値", "震度", "信頼区間（Wilson法）",
                           "実験による妥当性確認は行っていない", "shake.1.amplitude=300 gal", "300 gal"})
    EXPECT_TRUE(holds(html, part)) << part;
  for (const char* part : {"How the floor shakes", "overturns", "peak tilt", "friction coefficient"})
    EXPECT_FALSE(holds(html, part)) << part;
}

TEST_F(ReportTest, without_a_shake_there_is_no_intensity_and_no_probability) {
  const Ended ended = topple({"report", "free-rocking", "--set", "run.duration=0.5 s", "--quiet"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(ended.out, "report: free-rocking-report.html\n");
  const std::string html = bytes_of("free-rocking-report.html");
  EXPECT_TRUE(holds(html, "The floor does not shake."));
  EXPECT_TRUE(holds(html, "no probability is given"));
  EXPECT_FALSE(holds(html, "JMA scale"));
}

TEST_F(ReportTest, a_run_that_fails_leaves_an_older_page) {
  write_bytes("beam.toml", k_beam);
  write_bytes("r.html", "<!DOCTYPE html>older");
  expect_one_line(
      {"report", "beam.toml", "-o", "r.html", "--quiet", "--set", "run.integrator=central-difference"}, 1,
      "; r.html is not written");
  EXPECT_EQ(bytes_of("r.html"), "<!DOCTYPE html>older");
}

/// stdout and stderr of headless Chromium on the page; nothing when it is not installed.
std::optional<std::pair<std::string, std::string>> in_chromium(const std::string& page) {
  if (std::system("command -v chromium >/dev/null 2>&1") != 0) return std::nullopt;
  const std::string call =
      "timeout 60 chromium --headless --no-sandbox --disable-gpu --user-data-dir=profile "
      "--enable-logging=stderr "
      "--host-resolver-rules='MAP * ~NOTFOUND' --dump-dom file://\"$PWD\"/" +
      page + " >dom 2>log";
  EXPECT_EQ(std::system(call.c_str()), 0) << bytes_of("log");
  return std::pair(bytes_of("dom"), bytes_of("log"));
}

TEST_F(ReportTest, a_browser_shows_it_without_complaint) {
  for (const char* language : {"en", "ja"}) {
    made({"--lang", language});
    const auto shown = in_chromium("r.html");
    if (!shown)
      GTEST_SKIP() << "chromium is not installed (Debian package chromium): the page was not opened";
    const auto& [dom, log] = *shown;
    EXPECT_TRUE(holds(dom, "<footer>")) << language;
    EXPECT_TRUE(holds(dom, "<polyline")) << language;
    EXPECT_TRUE(holds(dom, "src=\"data:image/png;base64,")) << language;
    EXPECT_FALSE(holds(log, "CONSOLE")) << log;
  }
}

}  // namespace
}  // namespace topple::app
