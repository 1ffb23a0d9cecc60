// Calls that are wrong in themselves, and help.
#include "solver/io/common/nearest_name.h"
#include "solver/math/processor.h"
#include "unit/app/program.h"
#include "unit/app/scenes.h"

namespace topple::app {
namespace {

class UsageTest : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write_bytes("s.toml", k_shaken);
  }
  void TearDown() override {
    EXPECT_EQ(files(), std::vector<std::string>{"s.toml"});  // nothing was begun
    ProgramTest::TearDown();
  }
};

TEST_F(UsageTest, help_and_version_go_to_standard_output) {
  EXPECT_EQ(topple({"--version"}).out,
            std::string("topple " TOPPLE_VERSION "\nsolver for ") + instruction_set() + "\n");
  for (const char* command : {"", "run", "render", "export", "verify", "study", "compare", "report",
                              "validate", "check", "info", "recover", "scenes", "furniture"}) {
    SCOPED_TRACE(command);
    const Ended ended =
        topple(*command ? std::vector<std::string>{command, "--help"} : std::vector<std::string>{"--help"});
    EXPECT_EQ(ended.code, 0);
    EXPECT_EQ(ended.err, "");
    EXPECT_NE(ended.out.find("Usage: topple"), std::string::npos);
    EXPECT_NE(ended.out.find(std::string("Example")), std::string::npos);
    EXPECT_NE(ended.out.find(std::string("  topple ") + command), std::string::npos);
  }
}

TEST_F(UsageTest, unknown_words_are_named) {
  expect_one_line({}, 2, "subcommand is required");
  expect_one_line({"frob"}, 2, "\"frob\" is not a command; known: run, view, render, ");
  expect_one_line({""}, 2, "\"\" is not a command");
  expect_one_line({"--frob"}, 2, "--frob: unknown option");
  expect_one_line({"--quiet", "run", "s.toml"}, 2, "--quiet: unknown option; a command comes first");
  expect_one_line({"run", "s.toml", "--frob"}, 2, "topple: unknown option --frob (topple run --help)\n");
  expect_one_line({"run", "s.toml", "--frob=2"}, 2, "topple: unknown option --frob (topple run --help)\n");
  expect_one_line({"run", "s.toml", "-f"}, 2, "topple: unknown option -f (topple run --help)\n");
  expect_one_line({"run", "s.toml", "---"}, 2, "unknown option ---");
  expect_one_line({"run", "s.toml", "more"}, 2, "not expected: more");
  expect_one_line({"scenes", "more"}, 2, "not expected: more");
}

TEST_F(UsageTest, the_option_that_is_nearest_to_a_mistyped_one_is_named) {
  expect_one_line({"run", "s.toml", "--ouput", "x"}, 2,
                  "topple: unknown option --ouput; the nearest is --output (topple run --help)\n");
  expect_one_line({"run", "--ouput=x", "s.toml"}, 2, "unknown option --ouput; the nearest is --output");
  expect_one_line({"run", "s.toml", "--out", "x"}, 2, "unknown option --out; the nearest is --output");
  expect_one_line({"render", "s.toml", "--stlil", "a.png", "--at", "0"}, 2, "the nearest is --still");
  expect_one_line({"render", "s.toml", "--color", "axial", "--mp4", "a.mp4"}, 2, "the nearest is --colour");
  expect_one_line({"study", "overturn", "paper-a", "--emsemble", "4"}, 2, "the nearest is --ensemble");
}

TEST(NearestName, is_that_of_the_fewest_slips_and_none_where_there_are_many) {
  using io::edit_distance, io::nearest_name;
  EXPECT_EQ(edit_distance("", "abc"), 3);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
  EXPECT_EQ(edit_distance("sittign", "sitting"), 1);
  EXPECT_EQ(edit_distance("output", "output"), 0);
  const std::vector<std::string> known{"json", "jobs", "quiet", "output"};
  EXPECT_EQ(nearest_name("jsno", known), "json");
  EXPECT_EQ(nearest_name("job", known), "jobs");
  EXPECT_EQ(nearest_name("outptu", known), "output");
  EXPECT_EQ(nearest_name("frob", known), "");
  EXPECT_EQ(nearest_name("j", known), "");
  EXPECT_EQ(nearest_name("", known), "");
}

TEST_F(UsageTest, files_are_not_called_what_they_are_not) {
  const auto expect = [](std::vector<std::string> call, const std::string& ending,
                         const std::string& written) {
    expect_one_line(call, 2,
                    call[call.size() - 2] + ": \"" + call.back() + "\" ends in " + ending +
                        ", but what is written is " + written);
  };
  expect({"render", "s.toml", "--at", "0", "--still", "x.jpg"}, ".jpg", ".png");
  expect({"render", "s.toml", "--at", "0", "--still", "x.mp4"}, ".mp4", ".png");
  expect({"render", "s.toml", "--at", "0", "--still", "x.JPEG"}, ".jpeg", ".png");
  expect({"render", "s.toml", "--mp4", "x.gif"}, ".gif", ".mp4");
  expect({"compare", "s.toml", "s.toml", "--mp4", "x.avi"}, ".avi", ".mp4");
  expect({"report", "s.toml", "--output", "x.pdf"}, ".pdf", ".html");
  expect({"run", "s.toml", "--output", "x.png"}, ".png", ".h5");
  expect({"export", "a.h5", "--xdmf", "x.png"}, ".png", ".xdmf");
  expect({"export", "a.h5", "--gltf", "x.gltf"}, ".gltf", ".glb");
  expect({"export", "a.h5", "--gltf", "x.obj"}, ".obj", ".glb");
}

TEST_F(UsageTest, help_says_that_a_recording_replaces_an_older_one) {
  for (const char* command : {"run", "view", "recover"})
    EXPECT_NE(topple({command, "--help"}).out.find("in place of an older"), std::string::npos) << command;
}

TEST_F(UsageTest, what_is_missing_is_named) {
  expect_one_line({"run"}, 2, "SCENE is required");
  expect_one_line({"render", "s.toml"}, 2, "[--png,--mp4,--still] is required");
  expect_one_line({"render", "s.toml", "--still", "a.png"}, 2, "--still requires --at");
  expect_one_line({"render", "s.toml", "--at", "0"}, 2, "--at requires --still");
  expect_one_line({"render", "s.toml", "--png", "p", "--mp4", "a.mp4"}, 2, "2 were given");
  expect_one_line({"export", "a.h5"}, 2, "[--csv,--xdmf,--vtk,--gltf,--page] is required");
  expect_one_line({"export", "a.h5", "--csv", "d", "--xdmf", "x"}, 2, "2 were given");
  expect_one_line({"check"}, 2, "SCENES is required");
  expect_one_line({"info"}, 2, "FILE is required");
  expect_one_line({"recover"}, 2, "RECORDING is required");
  expect_one_line({"run", "s.toml", "--json"}, 2, "--json: needs a value, FILE|-");
  expect_one_line({"run", "s.toml", "--set"}, 2, "--set: needs a value, KEY=VALUE");
  expect_one_line({"run", "s.toml", "-o", "a.h5", "-o", "b.h5"}, 2, "--output: given more than once");
}

TEST_F(UsageTest, empty_names_are_refused) {
  expect_one_line({"run", ""}, 2, "is empty");
  expect_one_line({"run", "s.toml", "-o", ""}, 2, "--output: is empty");
  expect_one_line({"view", ""}, 2, "is empty");
  expect_one_line({"view", "-o", "a.h5"}, 2, "SOURCE");
  expect_one_line({"view", "s.toml", "-o", ""}, 2, "--output: is empty");
  expect_one_line({"run", "s.toml", "--json", ""}, 2, "--json: is empty");
  expect_one_line({"render", "s.toml", "--png", ""}, 2, "--png: is empty");
  expect_one_line({"render", "s.toml", "--mp4", ""}, 2, "--mp4: is empty");
  expect_one_line({"render", "s.toml", "--still", "", "--at", "0"}, 2, "--still: is empty");
  expect_one_line({"export", "", "--csv", "c"}, 2, "is empty");
  expect_one_line({"export", "a.h5", "--csv", ""}, 2, "--csv: is empty");
  expect_one_line({"export", "a.h5", "--xdmf", ""}, 2, "--xdmf: is empty");
  expect_one_line({"export", "a.h5", "--vtk", ""}, 2, "--vtk: is empty");
  expect_one_line({"info", ""}, 2, "is empty");
  expect_one_line({"recover", ""}, 2, "is empty");
  expect_one_line({"recover", "a.h5", "-o", ""}, 2, "--output: is empty");
  expect_one_line({"check", ""}, 2, "is empty");
}

TEST_F(UsageTest, studies_that_cannot_be_are_refused) {
  expect_one_line({"study"}, 2, "KIND is required");
  expect_one_line({"study", "elements"}, 2, "--output is required (topple study --help)");
  expect_one_line({"study", "elements", "-o", ""}, 2, "--output: is empty");
  expect_one_line(
      {"study", "frob", "-o", "out"}, 2,
      "\"frob\" is not a study; known: elements, fragility, overturn, penalty, precision, stability");
  expect_one_line({"study", "penalty", "-o", "out"}, 2,
                  "study penalty: SCENE is required (topple study --help)");
  expect_one_line({"study", "penalty", "paper-a"}, 2, "--output is required (topple study --help)");
  expect_one_line({"study", "elements", "s.toml", "-o", "out"}, 2,
                  "study elements: has scenes of its own and takes none (found \"s.toml\")");
  expect_one_line({"study", "elements", "-o", "out", "--set", "run.elements=asi"}, 2,
                  "study elements: has no scene to --set a key of");
  expect_one_line({"study", "overturn", "-o", "out"}, 2, "study overturn: SCENE is required");
  expect_one_line({"study", "stability", "paper-a", "-o", "out", "--ensemble", "4"}, 2,
                  "--ensemble: not of study stability");
  expect_one_line({"study", "stability", "paper-a", "-o", "out", "--x", "run.time_step=1..2:2"}, 2,
                  "--x run.time_step: 1 s is outside 1e-07..0.1 s");
  expect_one_line({"study", "stability", "portal-pushover", "-o", "out"}, 2,
                  "study stability: portal-pushover is not dynamic");
  for (const char* kind : {"elements", "penalty"}) {
    std::vector<std::string> call{"study", kind};
    if (kind == std::string("penalty")) call.push_back("paper-a");
    call.insert(call.end(), {"-o", "out"});
    const auto refused = [&](const std::vector<std::string>& options) {
      std::vector<std::string> whole = call;
      whole.insert(whole.end(), options.begin(), options.end());
      expect_one_line(whole, 2, options[0] + ": not of study " + kind);
    };
    refused({"--x", "contact.friction=0..1:2"});
    refused({"--y", "contact.friction=0..1:2"});
    refused({"--ensemble", "4"});
    refused({"--resume"});
  }
  expect_one_line({"study", "precision", "-o", "out"}, 2, "study precision: SCENE is required");
  expect_one_line({"study", "precision", "paper-a"}, 2, "--output is required");
  expect_one_line({"study", "precision", "paper-a", "-o", "out", "--x", "contact.q=1..2:2"}, 2,
                  "--x: not of study precision");
  expect_one_line({"study", "precision", "paper-a", "-o", "out", "--ensemble", "4"}, 2,
                  "--ensemble: not of study precision");
  for (const char* size : {"1", "x", "1000001"})
    expect_one_line({"study", "overturn", "paper-a", "-o", "out", "--ensemble", size}, 2,
                    "--ensemble: \"" + std::string(size) + "\" is not a whole number in 2..1000000");
  for (const char* spread : {"0", "100%", "5 %", "x"})
    expect_one_line({"study", "overturn", "paper-a", "-o", "out", "--ensemble", "4", "--spread", spread}, 2,
                    "--spread: \"" + std::string(spread) + "\" is not between 0% and 100%");
  expect_one_line({"study", "overturn", "paper-a", "-o", "out", "--spread", "5%"}, 2,
                  "--spread requires --ensemble");
  expect_one_line({"study", "overturn", "paper-a", "-o", "out", "--vary", "phase"}, 2,
                  "--vary requires --ensemble");
  expect_one_line({"study", "overturn", "paper-a", "-o", "out", "--x", "contact.friction=0..2:3"}, 2,
                  "--x contact.friction: 2 is outside 0..1.5");
  for (const char* jobs : {"", "0", "-1", "257", "two", "1.5"})
    expect_one_line({"study", "elements", "-o", "out", "--jobs", jobs}, 2,
                    "--jobs: \"" + std::string(jobs) + "\" is not a whole number in 1..256");
}

TEST_F(UsageTest, reports_and_comparisons_that_cannot_be_are_refused) {
  expect_one_line({"report"}, 2, "SCENE is required");
  expect_one_line({"report", "s.toml", "--lang", "de"}, 2, "--lang: \"de\" is not one of en, ja");
  expect_one_line({"report", "s.toml", "-o", ""}, 2, "--output: is empty");
  expect_one_line({"report", "s.toml", "-o", "s.toml"}, 2, "--output: s.toml is what is being read");
  expect_one_line({"report", "s.toml", "-o", "none/r.html"}, 2,
                  "none/r.html: cannot be written: there is no folder");
  expect_one_line({"report", "s.toml", "--jobs", "0"}, 2, "--jobs: \"0\" is not a whole number in 1..256");
  expect_one_line({"report", "none.toml"}, 2, "none.toml: no such file or built-in scene");
  expect_one_line({"report", "portal-pushover"}, 2, "a report needs a scene with run.analysis = \"dynamic\"");
  expect_one_line({"compare"}, 2, "A is required");
  expect_one_line({"compare", "s.toml"}, 2, "B is required");
  expect_one_line({"compare", "s.toml", "none.toml"}, 2, "none.toml: no such file or built-in scene");
  expect_one_line({"compare", "s.toml", "portal-pushover"}, 2, "one of s.toml and portal-pushover is static");
  expect_one_line({"compare", "portal-pushover", "portal-pushover", "--mp4", "a.mp4"}, 2,
                  "--mp4: portal-pushover is static, and the video has a clock");
  expect_one_line({"compare", "s.toml", "verify/beams-frequencies"}, 2, "has no motion to compare");
  expect_one_line({"compare", "s.toml", "s.toml", "--json", "s.toml"}, 2,
                  "--json: s.toml is what is being read");
  expect_one_line({"compare", "s.toml", "s.toml", "--mp4", "none/a.mp4"}, 2, "there is no folder");
}

TEST_F(UsageTest, words_that_a_list_lacks_are_refused_with_the_list) {
  const auto expect = [](const std::string& option, const std::string& word, const std::string& known) {
    expect_one_line(
        {"render", "s.toml", "--png", "p", option, word}, 2,
        "topple: " + option + ": \"" + word + "\" is not one of " + known + " (topple render --help)\n");
  };
  for (const char* word : {"", "vulkan", "OSMESA", "0", "a not in {b}"})
    expect("--renderer", word, "osmesa, egl");
  for (const char* word : {"", "jet", "diverging", "1"}) expect("--map", word, "viridis, cividis");
  for (const char* word : {"", "none", "2"}) expect("--trails", word, "second, run");
  expect("--colour", "red", "stress, yield-ratio, axial, moment, torsion, displacement");
  for (const char* word : {"", "de", "EN"}) expect("--lang", word, "en, ja");
  expect_one_line({"view", "s.toml", "--lang", "de"}, 2, "--lang: \"de\" is not one of en, ja (topple view");
}

TEST_F(UsageTest, sizes_that_no_picture_has_are_refused) {
  for (const char* size : {"", "1", "0x0", "-320x180", "320x", "x180", "320x180x", "320x180p", "63x64",
                           "320X180", " 320x180", "320 x 180", "8193x64", "99999999999999x64", "1e3x64"})
    expect_one_line({"render", "s.toml", "--png", "p", "--size", size}, 2,
                    "--size: \"" + std::string(size) + "\" is not WIDTHxHEIGHT with 64..8192 each");
  expect_one_line({"render", "s.toml", "--mp4", "a.mp4", "--size", "321x180"}, 2, "even width and height");
}

TEST_F(UsageTest, numbers_that_are_none_are_refused) {
  for (const char* rate : {"0", "-1", "1001", "29.97", "abc", "nan", "1e9"})
    expect_one_line({"render", "s.toml", "--png", "p", "--fps", rate}, 2,
                    "--fps: \"" + std::string(rate) + "\" is not a whole number in 1..1000");
  for (const char* time : {"", "abc", "nan", "inf", "1 s", "0x1"}) {
    const std::string refusal = std::string(": \"") + time + "\" is not a number of seconds";
    expect_one_line({"render", "s.toml", "--still", "a.png", "--at", time}, 2, "--at" + refusal);
    expect_one_line({"render", "s.toml", "--png", "p", "--from", time}, 2, "--from" + refusal);
    expect_one_line({"render", "s.toml", "--png", "p", "--to", time}, 2, "--to" + refusal);
  }
}

TEST_F(UsageTest, instants_outside_the_scene_are_refused_before_it_runs) {
  for (const char* time : {"-1", "0.31", "1e9"})
    expect_one_line({"render", "s.toml", "--still", "a.png", "--at", time}, 2,
                    "is outside the scene, 0..0.3 s");
  expect_one_line({"render", "s.toml", "--png", "p", "--from", "0.2", "--to", "0.1"}, 2,
                  "nothing lies between 0.2 and 0.1 s");
  expect_one_line({"render", "s.toml", "--png", "p", "--from", "0.5"}, 2, "--from");
  expect_one_line({"render", "s.toml", "--png", "p", "--to", "-0.5"}, 2, "--to");
}

TEST_F(UsageTest, unknown_cameras_are_refused) {
  for (const char* camera : {"", "up", "Front", "1,2,3,4,5", "1,2,3,4,5,6,7", "1,99,3,0,0,0", "1,2,0,0,0,0",
                             "1,2,3,nan,0,0", "up,follow", "sidefollow", "follow:", "follow,side", ",follow"})
    expect_one_line({"render", "s.toml", "--png", "p", "--camera", camera}, 2,
                    "--camera: \"" + std::string(camera) + "\" is not one of front, side, top, iso");
  expect_one_line({"render", "s.toml", "--png", "p", "--camera", "follow:nobody"}, 2,
                  "--camera: nobody: there is no body of that name; there are free");
}

TEST_F(UsageTest, overrides_that_do_not_fit_are_refused) {
  const auto expect = [](const std::string& change, const std::string& part) {
    expect_one_line({"run", "s.toml", "-o", "a.h5", "--set", change}, 2, "--set " + change + ": ");
    expect_one_line({"check", "s.toml", "--set", change}, 2, part);
  };
  expect("run.duration", "expected KEY=VALUE");
  expect("=1", "expected KEY=VALUE");
  expect("", "expected KEY=VALUE");
  expect("run.length=1", "run.length: unknown key");
  expect("run.duration=", "run.duration: \"\" is not a number with a unit");
  expect("run.duration=1 m", "run.duration: \"1 m\" is a length, expected a time");
  expect("contact.friction=-1", "contact.friction: -1 is outside 0..1.5");
  expect("cabinet.other.mass=1", "cabinet.other: no such entry; known: free");
}

TEST_F(UsageTest, a_line_break_in_a_name_does_not_break_the_line) {
  expect_one_line({"run", "a\nb"}, 2, "a\\x0ab: no such file or built-in scene");
}

}  // namespace
}  // namespace topple::app
