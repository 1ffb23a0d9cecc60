// Scenes that are wrong: one line that says where, exit code 2, nothing on disk.
#include "unit/app/program.h"
#include "unit/app/scenes.h"

namespace topple::app {
namespace {

class BadSceneTest : public ProgramTest {
 protected:
  /// Every command that takes a scene refuses it in the same words.
  static void expect_refused(const std::string& name, const std::string& part) {
    const std::vector<std::string> before = files();
    expect_one_line({"run", name, "-o", "a.h5"}, 2, part);
    expect_one_line({"run", name, "--json", "a.json"}, 2, part);
    expect_one_line({"run", name, "--json", "-"}, 2, part);
    expect_one_line({"render", name, "--png", "pictures"}, 2, part);
    expect_one_line({"render", name, "--still", "a.png", "--at", "0"}, 2, part);
    expect_one_line({"check", name}, 2, part);
    expect_one_line({"info", name}, 2, part);
    EXPECT_EQ(files(), before);
  }
  static void expect_text_refused(const std::string& text, const std::string& part) {
    write_bytes("s.toml", text);
    expect_refused("s.toml", "s.toml:");
    expect_one_line({"check", "s.toml"}, 2, part);
  }
  /// The shaken cabinet with `from` replaced.
  static std::string changed(const std::string& from, const std::string& to) {
    std::string text = k_shaken;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  }
  static std::string frame(const std::string& nodes, const std::string& members) {
    return "topple = 1\n" + k_library + "[[frame]]\nname = \"f\"\nnodes = " + nodes +
           "\nmembers = " + members;
  }
};

TEST_F(BadSceneTest, a_missing_file) {
  expect_refused("none.toml", "none.toml: no such file or built-in scene; built-in: ");
}

TEST_F(BadSceneTest, a_folder) {
  std::filesystem::create_directory("folder");
  expect_refused("folder", "folder: is a folder");
}

TEST_F(BadSceneTest, broken_toml) {
  expect_text_refused("topple = 1\n[run\n", "s.toml:2:");
  expect_text_refused("hello\n", "s.toml:1:");
  expect_text_refused(std::string("\x89\xff\0\1", 4), "s.toml:1:1: ");
  expect_text_refused("", "topple: missing");
}

TEST_F(BadSceneTest, an_accelerogram_that_is_missing_or_wrong) {
  const std::string record =
      changed("frequency = \"2 Hz\"\namplitude = \"400 gal\"", "type = \"record\"\nfiles = [\"ns.csv\"]");
  expect_text_refused(record, "s.toml:8:10: shake.table.files.1: ns.csv: no such file; built-in records: ");
  write_bytes("ns.csv", "time_s,ax_g\n0,0.1\n0.01,300\n");
  expect_text_refused(record, "ns.csv:3: peak: 300 g is above 5 g; is the unit right?");
  write_bytes("ns.csv", std::string("\0\1\2", 3));
  expect_text_refused(record, "ns.csv:1: is not text");
  std::filesystem::remove("ns.csv");
  std::filesystem::create_directory("ns.csv");
  expect_text_refused(record, "shake.table.files.1: ns.csv: is a folder");
}

TEST_F(BadSceneTest, an_unknown_key) {
  expect_text_refused(changed("duration", "length"), "s.toml:4:1: run.length: unknown key; known: ");
}

TEST_F(BadSceneTest, a_wrong_unit) {
  expect_text_refused(changed("0.3 s", "0.3 kg"),
                      "s.toml:4:12: run.duration: \"0.3 kg\" is a mass, expected a time");
  expect_text_refused(changed("0.3 s", "0.3 fortnights"), "unknown unit \"fortnights\"");
}

TEST_F(BadSceneTest, a_negative_mass) {
  expect_text_refused(changed("40 kg", "-40 kg"), "cabinet.free.mass: \"-40 kg\" is outside ");
}

TEST_F(BadSceneTest, an_impossible_centre_of_gravity) {
  expect_text_refused(changed("mass = ", "cg_height = 1.7\nmass = "),
                      "cabinet.free.cg_height: 1.7 m cannot be reached with positive densities");
  expect_text_refused(changed("mass = ", "cg_height = 2.5\nmass = "), "cabinet.free.cg_height: ");
}

TEST_F(BadSceneTest, a_member_of_zero_length) {
  expect_text_refused(
      frame("[[0, 0, 0], [1, 0, 0]]", R"([{ nodes = [1, 1], section = "post", material = "steel" }])"),
      "no length");
}

TEST_F(BadSceneTest, two_nodes_in_one_place) {
  expect_text_refused(frame("[[0, 0, 0], [1, 0, 0], [1, 0, 0]]",
                            R"([{ nodes = [0, 1], section = "post", material = "steel" },
                                { nodes = [0, 2], section = "post", material = "steel" }])"),
                      "nodes 1 and 2 are in one place");
}

TEST_F(BadSceneTest, a_name_used_twice) {
  expect_text_refused(k_shaken + k_cabinet, "\"free\" is used twice, first in line ");
}

TEST_F(BadSceneTest, a_scene_without_bodies) {
  expect_text_refused("topple = 1\n", "there are no bodies");
}

TEST_F(BadSceneTest, every_bad_scene_of_a_check_is_told) {
  write_bytes("s.toml", k_shaken);
  write_bytes("bad.toml", "hello\n");
  const Ended ended = topple({"check", "s.toml", "none.toml", "bad.toml"});
  EXPECT_EQ(ended.code, 2);
  EXPECT_EQ(ended.out, "s.toml: ok\n");
  // and the soft contacts of the good one
  EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 3) << ended.err;
  EXPECT_NE(ended.err.find("warning: s.toml: contact.alpha = 50 kgf is soft"), std::string::npos)
      << ended.err;
}

// With q = 2 the alpha of a rigid floor is beyond what may be named.
TEST_F(BadSceneTest, no_alpha_is_advised_that_no_scene_may_name) {
  write_bytes("s.toml", k_shaken);
  const std::string words = topple({"check", "s.toml", "--set", "contact.q=2"}).err;
  EXPECT_NE(words.find("no alpha at all takes 1000000 kgf, the greatest there is"), std::string::npos)
      << words;
  EXPECT_EQ(words.find("as on a rigid floor too"), std::string::npos) << words;
}

// The refrigerator is there, but overlaps another; a misspelt kind is a piece that others may mean.
TEST_F(BadSceneTest, what_refers_to_a_piece_that_has_an_error_has_none) {
  const auto told = [](const char* kind, const char* at) {
    write_bytes(
        "s.toml",
        std::string(
            "topple = 1\nfloor = {}\nwall = [{ name = \"w\", at = [-0.3, 0], normal = [1, 0, 0] }]\n") +
            "[[furniture]]\nkind = \"chest\"\n[[furniture]]\nkind = \"" + kind + "\"\nat = " + at +
            "\n[[fixing]]\nkind = \"L-bracket\"\nbody = \"refrigerator\"\nto = \"w\"\n");
    return topple({"check", "s.toml"}).err;
  };
  for (const std::string& err : {told("refrigerator", "[0.1, 0, 0]"), told("refrigeratr", "[2, 0, 0]")}) {
    EXPECT_EQ(std::count(err.begin(), err.end(), '\n'), 1) << err;
    EXPECT_EQ(err.find("there is no body"), std::string::npos) << err;
  }
}

TEST_F(BadSceneTest, a_shake_that_rows_do_not_follow_is_warned_of) {
  const Ended ended = topple({"check", "wardrobe", "--set", "shake.1.frequency=\"30 Hz\""});
  EXPECT_NE(ended.err.find("shake 1 of 30 Hz is too fast for rows at 100 Hz"), std::string::npos)
      << ended.err;
  EXPECT_EQ(topple({"check", "wardrobe", "--set", "shake.1.frequency=\"20 Hz\""}).err, "");
}

TEST_F(BadSceneTest, an_error_in_a_kind_of_ones_own_is_that_of_its_file) {
  write_bytes(
      "kind.toml",
      "topple = 1\n[kind]\nsource = \"assumed\"\n[[block]]\nsize = [0.3, 0.3, 0.3]\nmass = 5\nmas = 5\n");
  write_bytes("s.toml", "topple = 1\n[floor]\n[[furniture]]\nkind = \"kind.toml\"\nat = [0, 0]\n");
  for (const char* command : {"check", "run"}) {
    const Ended ended = topple({command, "s.toml"});
    EXPECT_EQ(ended.code, 2);
    EXPECT_TRUE(ended.err.starts_with("topple: kind.toml:7:1: block.1.mas: unknown key")) << ended.err;
    EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
  }
}

TEST_F(BadSceneTest, all_errors_of_a_scene_are_told_at_once) {
  write_bytes("s.toml", changed("restitution = 0.5", "restitution = 5") +
                            "[[probe]]\nbody = \"no\"\n[[door]]\nwall = \"no\"\n");
  const Ended ended = topple({"check", "s.toml"});
  EXPECT_EQ(ended.code, 2);
  EXPECT_EQ(ended.out, "");
  EXPECT_NE(ended.err.find("probe.2.body: there is no body \"no\""), std::string::npos) << ended.err;
  EXPECT_NE(ended.err.find("door.1.at: missing"), std::string::npos) << ended.err;
}

TEST_F(BadSceneTest, what_will_surprise_is_warned_of) {
  const auto block = [](const std::string& name, const std::string& at) {
    return "[[block]]\nname = \"" + name + "\"\nsize = [0.2, 0.2, 0.2]\nmass = 1\nat = [" + at + "]\n";
  };
  const std::string hangs = block("box", "2, 0, 0.3") + block("desk", "3, 0, 0") +
                            block("lamp", "3, 0, 0.25") + block("shelf", "4, 0, 0") +
                            block("vase", "4.15, 0, 0.21");
  const std::string bracket =
      "[[anchor]]\nname = \"bracket\"\nbody = \"free\"\npoint = [-0.19, 0, 1.79]\nto = [-0.25, 0, 1.79]\n"
      "type = \"bracket\"\nstiffness = \"1000 kN/m\"\npreload = \"900 N\"\nstrength = \"500 N\"\n";
  write_bytes("s.toml", changed("alpha = \"50 kgf\"\n", "") + hangs + bracket);
  const Ended ended = topple({"check", "s.toml"});
  EXPECT_EQ(ended.code, 0);
  for (const char* words :
       {"\"box\" stands on nothing: it hangs 300 mm above the floor",
        "\"lamp\" stands on nothing: it hangs 40 mm or more above \"desk\"; settling brings it "
        "down where that is little",
        "the centre of gravity of \"vase\" is 45 mm beside \"shelf\""})
    EXPECT_NE(ended.err.find(words), std::string::npos) << ended.err;
  EXPECT_NE(ended.err.find("anchor \"bracket\" holds \"free\" in the middle of its member"),
            std::string::npos)
      << ended.err;
  EXPECT_NE(ended.err.find("anchor \"bracket\" is put in with 900 N, above its strength of 500 N"),
            std::string::npos)
      << ended.err;
  EXPECT_EQ(ended.err.find("is soft"), std::string::npos) << ended.err;
}

// Seats 420 mm wide, one turned by 30 degrees: their corners are 17 mm within each other.
TEST_F(BadSceneTest, what_starts_a_little_within_its_neighbour_is_warned_of) {
  const auto chairs = [](const char* yaw) {
    return std::string(
               "topple = 1\nfloor = {}\nrun = { duration = 1 }\nfurniture = [\n"
               "{ kind = \"chair\", name = \"a\", at = [0, 0] },\n"
               "{ kind = \"chair\", name = \"b\", at = [0, -0.48], yaw = \"") +
           yaw + "\" }]\n";
  };
  write_bytes("turned.toml", chairs("30 deg"));
  write_bytes("straight.toml", chairs("0 deg"));
  const Ended turned = topple({"check", "turned.toml"}), straight = topple({"check", "straight.toml"});
  EXPECT_EQ(turned.code, 0);
  EXPECT_NE(turned.err.find("mm within each other: contact pushes them apart"), std::string::npos)
      << turned.err;
  EXPECT_EQ(straight.err.find("within each other"), std::string::npos) << straight.err;
}

TEST_F(BadSceneTest, a_room_that_bends_too_much_for_rigid_bodies_is_warned_of) {
  write_bytes("room.toml", shelves_of_books(5));
  write_bytes("few.toml", shelves_of_books(4));
  const std::string words = "5 bodies bend too much to be rigid at run.accuracy = 0.01";
  for (const char* command : {"check", "run"}) {
    const Ended ended = topple({command, "room.toml"}), few = topple({command, "few.toml"});
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_NE(ended.err.find(words), std::string::npos) << ended.err;
    EXPECT_EQ(few.err.find("bend too much"), std::string::npos) << few.err;
  }
  const Ended ended = topple({"run", "room.toml"});
  const std::size_t remedy = ended.err.find("run.accuracy = 0.0", ended.err.find(words) + words.size());
  ASSERT_NE(remedy, std::string::npos) << ended.err;
  const std::string set = "run.accuracy=" + ended.err.substr(remedy + 15, 4);
  const Ended rigid = topple({"run", "room.toml", "--set", set});
  EXPECT_NE(rigid.out.find(": rigid from 0.000 s"), std::string::npos) << set << rigid.out;
  EXPECT_EQ(rigid.err.find("bend too much"), std::string::npos) << rigid.err;
}

// The cabinets withstand 94.9 of 177.5 gal (as in CriteriaTest), which is what the window says too.
TEST_F(BadSceneTest, soft_contacts_are_said_to_tip_as_early_as_they_do) {
  for (const auto& words : std::vector<std::vector<std::string>>{
           {"check", "paper-a"}, {"run", "paper-a", "--set", "run.duration=\"0.1 s\""}}) {
    const Ended ended = topple(words);
    EXPECT_EQ(ended.code, 0);
    for (const char* part : {"under a steady push", "at up to 47 % less acceleration than on a rigid floor",
                             "in a shake at still less", "of a steady push below 2 %"})
      EXPECT_NE(ended.err.find(part), std::string::npos) << words[0] << ": " << ended.err;
  }
}

TEST_F(BadSceneTest, check_tells_which_fixings_are_not_in_place) {
  const auto away = [&](const std::vector<std::string>& words) {
    const std::string out = topple(words).out;
    int lines = 0;
    for (std::size_t at = out.find(", not in place\n"); at != std::string::npos;
         at = out.find(", not in place\n", at + 1))
      ++lines;
    return lines;
  };
  EXPECT_EQ(away({"check", "sixth-floor"}), 0);
  EXPECT_EQ(away({"check", "sixth-floor", "--set", "fixing.1.on=false"}), 2);  // two brackets
}

TEST_F(BadSceneTest, the_built_in_scenes_are_good_and_listed) {
  const Ended list = topple({"scenes"});
  EXPECT_EQ(list.code, 0);
  std::vector<std::string> names{"check"};
  for (std::size_t at = 0; at < list.out.size(); at = list.out.find('\n', at) + 1)
    names.push_back(list.out.substr(at, list.out.find(' ', at) - at));
  EXPECT_GE(names.size(), 3u);
  EXPECT_EQ(topple(names).code, 0);
}

}  // namespace
}  // namespace topple::app
