// Pictures and videos: the same every time, from a scene as from its recording.
#include <cstdlib>
#include <set>

#include "render/output/image.h"
#include "unit/app/program.h"
#include "unit/app/scenes.h"

namespace topple::app {
namespace {

/// Nothing but a cabinet, which flies off sideways and falls. At 0.4 s it is 0.9 m away.
const std::string k_flying = R"(topple = 1
title = "x"
[run]
duration = "0.4 s"
settle = false
)" + k_library + k_cabinet + R"(
model = "rigid"
velocity = [1, 0.5, 0]
)";

class RenderTest : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write_bytes("s.toml", k_shaken);
    ASSERT_EQ(topple({"run", "s.toml", "-o", "a.h5"}).code, 0);
  }
  static void draw(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "render");
    for (const char* more : {"--size", "320x180", "--quiet"}) arguments.emplace_back(more);
    const Ended ended = topple(arguments);
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_EQ(ended.out + ended.err, "");
  }
  /// Width or height of a PNG file, from its header.
  static int side_at(const std::string& png, std::size_t at) {
    int side = 0;
    for (std::size_t k = 0; k < 4; ++k) side = 256 * side + static_cast<unsigned char>(png.at(at + k));
    return side;
  }
  /// Where the picture at 0.4 s differs from that at 0 in the middle, where there are no words. Pixels.
  static int moved_pixels(const std::string& camera, bool ui) {
    std::vector<render::Image> images;
    for (const char* at : {"0", "0.4"}) {
      std::vector<std::string> words{"render", "f.toml",  "--still", "f.png",    "--at", at,
                                     "--size", "960x540", "--quiet", "--camera", camera};
      if (ui) words.emplace_back("--ui");
      EXPECT_EQ(topple(words).code, 0);
      images.push_back(render::load_png("f.png").value());
    }
    int moved = 0;
    for (std::size_t y = 110; y < 300; ++y)
      for (std::size_t x = 260; x < 520; ++x)
        for (std::size_t k = 0; k < 3; ++k)
          if (const std::size_t i = 4 * (960 * y + x) + k;
              std::abs(images[0].rgba[i] - images[1].rgba[i]) > 30) {
            ++moved;
            break;
          }
    return moved;
  }
};

TEST_F(RenderTest, a_still_has_the_asked_size_and_the_same_bytes_every_time) {
  draw({"a.h5", "--still", "a.png", "--at", "0.155"});
  draw({"a.h5", "--still", "b.png", "--at", "0.155"});
  draw({"s.toml", "--still", "c.png", "--at", "0.155"});
  const std::string png = bytes_of("a.png");
  ASSERT_GT(png.size(), 1000u);
  EXPECT_EQ(side_at(png, 16), 320);
  EXPECT_EQ(side_at(png, 20), 180);
  EXPECT_EQ(bytes_of("b.png"), png);
  EXPECT_EQ(bytes_of("c.png"), png) << "a scene drawn on the fly differs from its recording";
  draw({"a.h5", "--still", "d.png", "--at", "0.3"});
  EXPECT_NE(bytes_of("d.png"), png);
}

TEST_F(RenderTest, osmesa_and_egl_draw_the_same_bytes) {
  draw({"a.h5", "--still", "any.png", "--at", "0.155"});  // OSMesa where it is installed
  draw({"a.h5", "--still", "egl.png", "--at", "0.155", "--renderer", "egl"});
  ASSERT_GT(bytes_of("any.png").size(), 1000u);
  EXPECT_TRUE(bytes_of("egl.png") == bytes_of("any.png"));  // the same Mesa's software
}

TEST_F(RenderTest, without_osmesa_egl_draws_without_a_word_and_what_was_asked_for_is_named) {
  const Circumstances without_osmesa{.set = {{"LD_LIBRARY_PATH", std::filesystem::current_path()}}};
  const auto draw_still = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments{"render", "a.h5",  "--still", "c.png",
                                       "--at",   "0.155", "--size",  "320x180"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return topple(arguments, without_osmesa);
  };
  draw({"a.h5", "--still", "a.png", "--at", "0.155"});
  write_bytes("libOSMesa.so.8", "");  // no library
  const Ended other = draw_still({});
  EXPECT_EQ(other.code, 0) << other.err;
  EXPECT_EQ(other.err, "");
  EXPECT_TRUE(bytes_of("c.png") == bytes_of("a.png"));
  const Ended asked = draw_still({"--renderer", "osmesa"});
  EXPECT_EQ(asked.code, 1) << asked.err;
  EXPECT_NE(asked.err.find("libosmesa6"), std::string::npos) << asked.err;
  write_bytes("libEGL.so.1", "");
  const Ended neither = draw_still({});
  EXPECT_EQ(neither.code, 1) << neither.err;
  for (const char* package : {"libosmesa6", "libegl1", "libegl-mesa0"})
    EXPECT_NE(neither.err.find(package), std::string::npos) << neither.err;
  EXPECT_EQ(draw_still({"--renderer", "vulkan"}).code, 2);
}

TEST_F(RenderTest, a_sequence_covers_the_recording_and_is_the_same_every_time) {
  draw({"a.h5", "--png", "p", "--fps", "20"});
  draw({"s.toml", "--png", "q", "--fps", "20"});
  std::vector<std::string> names;
  for (int i = 0; i <= 6; ++i) names.push_back("/frame-00000" + std::to_string(i) + ".png");
  for (const std::string& name : names) {
    EXPECT_FALSE(bytes_of("p" + name).empty());
    EXPECT_EQ(bytes_of("p" + name), bytes_of("q" + name)) << name;
  }
  EXPECT_EQ(files().size(), 2 + 2 * (1 + names.size()));
  draw({"a.h5", "--still", "still.png", "--at", "0.15"});
  EXPECT_EQ(bytes_of("still.png"), bytes_of("p" + names[3]));
}

TEST_F(RenderTest, a_long_sequence_is_the_stills_of_its_instants) {
  draw({"a.h5", "--png", "p", "--fps", "100"});
  for (const int number : {0, 7, 16, 30}) {
    const std::string name = std::to_string(number);
    draw({"a.h5", "--still", "still.png", "--at", std::to_string(number / 100.)});
    EXPECT_EQ(bytes_of("still.png"), bytes_of("p/frame-" + std::string(6 - name.size(), '0') + name + ".png"))
        << number;
  }
  EXPECT_TRUE(bytes_of("p/frame-000031.png").empty());
}

TEST_F(RenderTest, the_panels_of_the_window_are_drawn_when_asked_for) {
  const auto with_panels = [](const std::string& source, const std::string& picture) {
    const Ended ended =
        topple({"render", source, "--still", picture, "--at", "0.15", "--ui", "--size", "1000x600"});
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_EQ(ended.out + ended.err, "");
  };
  with_panels("a.h5", "a.png");
  with_panels("a.h5", "b.png");
  const std::string png = bytes_of("a.png");
  EXPECT_EQ(side_at(png, 16), 1000);
  EXPECT_EQ(side_at(png, 20), 600);
  EXPECT_EQ(bytes_of("b.png"), png);
  const Ended plain = topple({"render", "a.h5", "--still", "c.png", "--at", "0.15", "--size", "1000x600"});
  EXPECT_EQ(plain.code, 0);
  EXPECT_NE(bytes_of("c.png"), png);
  draw({"a.h5", "--png", "p", "--fps", "10", "--ui"});
  EXPECT_FALSE(bytes_of("p/frame-000003.png").empty());
}

TEST_F(RenderTest, from_and_to_cut_a_sequence_out) {
  draw({"a.h5", "--png", "all", "--fps", "20"});
  draw({"a.h5", "--png", "part", "--fps", "20", "--from", "0.1", "--to", "0.2"});
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator("part"), {}), 3);
  EXPECT_EQ(bytes_of("part/frame-000000.png"), bytes_of("all/frame-000002.png"));
  EXPECT_EQ(bytes_of("part/frame-000002.png"), bytes_of("all/frame-000004.png"));
  draw({"a.h5", "--png", "slow", "--fps", "20", "--from", "0.1", "--to", "0.2", "--speed", "0.5"});
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator("slow"), {}), 5);
  EXPECT_EQ(bytes_of("slow/frame-000002.png"), bytes_of("part/frame-000001.png"));
  draw({"a.h5", "--png", "beyond", "--fps", "20", "--from", "-5", "--to", "99"});
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator("beyond"), {}), 7);
}

TEST_F(RenderTest, a_video_is_the_same_every_time) {
  draw({"a.h5", "--mp4", "a.mp4", "--fps", "20"});
  draw({"a.h5", "--mp4", "b.mp4", "--fps", "20"});
  draw({"s.toml", "--mp4", "c.mp4", "--fps", "20"});
  const std::string video = bytes_of("a.mp4");
  EXPECT_EQ(video.substr(4, 4), "ftyp");
  EXPECT_EQ(bytes_of("b.mp4"), video);
  EXPECT_EQ(bytes_of("c.mp4"), video);
}

TEST_F(RenderTest, cameras_differ) {
  std::vector<std::string> pictures;
  for (const char* camera : {"front", "side", "top", "iso", "30,20,6,0,0,1", "30,20,8,0,0,1"}) {
    draw({"a.h5", "--still", "a.png", "--at", "0", "--camera", camera});
    pictures.push_back(bytes_of("a.png"));
    EXPECT_EQ(std::count(pictures.begin(), pictures.end(), pictures.back()), 1) << camera;
  }
}

TEST_F(RenderTest, a_body_that_is_followed_stays_where_it_is_in_the_picture) {
  constexpr int k_rounding = 20;  // pixels on edges
  write_bytes("f.toml", k_flying);
  for (const char* camera : {"follow", "side,follow", "follow:free", "30,20,6,0,0,1,follow"})
    EXPECT_LT(moved_pixels(camera, false), k_rounding) << camera;
  EXPECT_LT(moved_pixels("side,follow", true), k_rounding);
  for (const char* camera : {"iso", "side", "30,20,6,0,0,1"})
    EXPECT_GT(moved_pixels(camera, false), 1000) << camera;
  EXPECT_GT(moved_pixels("side", true), 1000);
}

TEST_F(RenderTest, the_body_of_inspect_is_followed_else_the_first) {
  write_bytes("f.toml", k_flying + R"(
[[cabinet]]
name = "other"
at = [0, 3]
size = ["380 mm", "880 mm", "1790 mm"]
mass = "40 kg"
section = "post"
material = "steel"
model = "rigid"
)");
  const auto picture = [](std::vector<std::string> more) {
    std::vector<std::string> words{"f.toml", "--still", "f.png", "--at", "0.4", "--camera"};
    words.insert(words.end(), more.begin(), more.end());
    draw(words);
    return bytes_of("f.png");
  };
  EXPECT_EQ(picture({"follow"}), picture({"follow:free"}));
  EXPECT_NE(picture({"follow"}), picture({"follow:other"}));
  EXPECT_EQ(picture({"follow", "--inspect", "other"}), picture({"follow:other", "--inspect", "other"}));
}

TEST_F(RenderTest, every_option_of_the_picture_changes_it) {
  std::vector<std::string> pictures;
  const std::vector<std::vector<std::string>> options{{},
                                                      {"--colour", "yield-ratio"},
                                                      {"--colour", "axial"},
                                                      {"--colour", "moment"},
                                                      {"--colour", "torsion"},
                                                      {"--colour", "displacement"},
                                                      {"--map", "cividis"},
                                                      {"--range", "instant"},
                                                      {"--range", "12.5"},
                                                      {"--exaggerate", "200"},
                                                      {"--forces"},
                                                      {"--no-panels"},
                                                      {"--bodies", "solid"},
                                                      {"--no-words"},
                                                      {"--trails", "run"},
                                                      {"--inspect", "free"},
                                                      {"--inspect", "free/post-1"}};
  for (const std::vector<std::string>& option : options) {
    std::vector<std::string> call{"a.h5", "--still", "a.png", "--at", "0.25"};
    call.insert(call.end(), option.begin(), option.end());
    draw(call);
    pictures.push_back(bytes_of("a.png"));
    EXPECT_EQ(std::count(pictures.begin(), pictures.end(), pictures.back()), 1)
        << (option.empty() ? "" : option.front() + " " + option.back());
  }
}

TEST_F(RenderTest, furniture_is_drawn_as_beams_as_it_looks_or_as_both) {
  write_bytes("f.toml",
              "topple = 1\nfloor = {}\n[[furniture]]\nkind = \"bookshelf\"\n"
              "[[shake]]\nfrequency = 1\namplitude = 1\n");
  std::set<std::string> pictures;
  for (const char* bodies : {"beams", "solid", "both"}) {
    draw({"f.toml", "--still", "f.png", "--at", "0", "--bodies", bodies, "--no-words"});
    pictures.insert(bytes_of("f.png"));
  }
  EXPECT_EQ(pictures.size(), 3u);
}

TEST_F(RenderTest, options_of_the_picture_that_mean_nothing_are_refused) {
  const auto refused = [](const std::vector<std::string>& option, const std::string& words) {
    std::vector<std::string> call{"render", "a.h5", "--still", "a.png", "--at", "0"};
    call.insert(call.end(), option.begin(), option.end());
    expect_one_line(call, 2, words);
  };
  refused({"--colour", "red"}, "--colour: \"red\" is not one of stress");
  refused({"--map", "jet"}, "--map: \"jet\" is not one of");
  refused({"--map", "diverging"}, "--map: \"diverging\" is not one of");
  for (const char* range : {"0", "-1", "nan", "inf", "1e13", "much"})
    refused({"--range", range}, "is not run, instant or a number");
  for (const char* factor : {"0.5", "201", "nan", "x"})
    refused({"--exaggerate", factor}, "is not a number from 1 to 200");
  for (const char* factor : {"0", "-1", "1001", "nan", "x"})
    refused({"--speed", factor},
            "--speed: \"" + std::string(factor) + "\" is not a number from 0.001 to 1000");
  refused({"--trails", "0"}, "--trails: \"0\" is not one of");
  refused({"--inspect", "nobody"}, "--inspect: nobody: there is no body of that name; there are free");
  refused({"--inspect", "free/x"}, "--inspect: free/x: free has no such member; it has post-1");
  refused({"--ghost", "1"}, "--ghost: a.h5 has no branch 1; its branches are 0..0");
  refused({"--ghost", "-1"}, "is not a whole number");
  EXPECT_EQ(files(), (std::vector<std::string>{"a.h5", "s.toml"}));
}

TEST_F(RenderTest, instants_outside_the_recording_are_refused) {
  for (const char* time : {"-0.1", "0.31", "1e300"})
    expect_one_line({"render", "a.h5", "--still", "a.png", "--at", time}, 2,
                    "is outside the recording, 0..0.3 s");
  expect_one_line({"render", "a.h5", "--png", "p", "--from", "0.2", "--to", "0.1"}, 2,
                  "nothing lies between");
  EXPECT_EQ(files(), (std::vector<std::string>{"a.h5", "s.toml"}));
}

TEST_F(RenderTest, static_runs_go_by_the_part_of_the_way) {
  expect_one_line({"render", "portal-pushover", "--still", "a.png", "--at", "2"}, 2,
                  "--at: 2 is outside the scene, 0..1 of the way through the loads");
  std::vector<std::string> pictures;
  for (const char* at : {"0.1", "0.7"}) {
    draw({"portal-pushover", "--ui", "--still", "a.png", "--at", at});
    pictures.push_back(bytes_of("a.png"));
  }
  EXPECT_NE(pictures[0], pictures[1]);
}

TEST_F(RenderTest, what_a_failed_run_computed_is_drawn_and_the_failure_told) {
  write_bytes("beam.toml", k_beam);
  const std::vector<std::string> set{"--set", "run.integrator=central-difference", "--size", "320x180"};
  const auto with = [&](std::vector<std::string> call) {
    call.insert(call.end(), set.begin(), set.end());
    return topple(call);
  };
  const Ended drawn = with({"render", "beam.toml", "--still", "a.png", "--at", "0"});
  EXPECT_EQ(drawn.code, 1);
  EXPECT_NE(drawn.err.find("the time integration is stable up to"), std::string::npos) << drawn.err;
  EXPECT_TRUE(std::filesystem::exists("a.png"));
  const Ended beyond = with({"render", "beam.toml", "--still", "b.png", "--at", "0.1"});
  EXPECT_EQ(beyond.code, 1);
  EXPECT_NE(beyond.err.find("--at: 0.1 s is outside the recording"), std::string::npos) << beyond.err;
  EXPECT_FALSE(std::filesystem::exists("b.png"));
}

}  // namespace
}  // namespace topple::app
