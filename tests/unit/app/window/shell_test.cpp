// Choosing, opening, saving and exporting, off screen, with mouse and keyboard fed by hand.
#include <hdf5.h>

#include <algorithm>
#include <cmath>

#include "app/window/status_line.h"
#include "solver/io/recording/recording.h"
#include "unit/app/shell_fixture.h"
#include "unit/app/small_disk.h"

namespace topple::app {
namespace {

constexpr const char* k_at2 =
    "PEER NGA STRONG MOTION DATABASE RECORD\nSomewhere\nACCELERATION TIME SERIES IN UNITS OF G\n"
    "NPTS= 6, DT= .02000 SEC\n 0.0 0.1 0.2 0.1 0.0 -0.1\n";

TEST_F(ShellTest, typing_filters_the_scenes_and_enter_opens_the_one_selected) {
  shell_->choose_scene();
  frame();
  EXPECT_GT(shell_->chooser().shown().size(), 20u);
  type("PAPER-");
  EXPECT_EQ(shell_->chooser().shown(), (std::vector<std::string>{"paper-a", "paper-b"}));
  press(render::key::right);
  EXPECT_EQ(shell_->chooser().selected(), "paper-b");
  press(render::key::enter);
  ASSERT_TRUE(until([&] { return ready(); }));
  EXPECT_EQ(shell_->title(), "topple: paper-b");
  EXPECT_FALSE(shell_->chooser().is_open());
}

// "yield" stands in the titles of others that come first in the list.
TEST_F(ShellTest, what_was_recorded_before_another_scene_is_told_too_when_it_closes) {
  open_rocking();
  run_to(0.1);
  const std::string first = player().status().recording;
  ASSERT_NE(first, "");
  shell_->open(write("other.toml", k_rocking));
  ASSERT_TRUE(until([&] { return ready() && shell_->session()->scene().name.ends_with("other"); }));
  run_to(0.1);
  for (int i = 0; i < 20; ++i) frame();
  const std::vector<LiveStatus> ends = shell_->close("stopped");
  ASSERT_EQ(ends.size(), 2u);
  EXPECT_EQ(ends[0].recording, first);
  EXPECT_NE(ends[1].recording, first);
}

TEST_F(ShellTest, a_name_that_begins_as_typed_comes_before_titles_that_hold_it) {
  shell_->choose_scene();
  frame();
  type("yield");
  EXPECT_GT(shell_->chooser().shown().size(), 1u);
  EXPECT_EQ(shell_->chooser().selected(), "yielding");
}

TEST_F(ShellTest, thumbnails_fill_in_and_are_kept) {
  shell_->choose_scene();
  const auto kept = [&] {
    std::error_code none;
    return !fs::is_empty(scratch_ / "cache/topple", none) && !none;
  };
  ASSERT_TRUE(until(kept));
  const auto image = render::load_png(fs::directory_iterator(scratch_ / "cache/topple")->path());
  ASSERT_TRUE(image.has_value());
  EXPECT_EQ(image->width, k_thumbnail_width);
  std::vector<std::uint8_t> row(image->rgba.begin() + 4 * 320 * 100, image->rgba.begin() + 4 * 320 * 101);
  EXPECT_TRUE(std::ranges::any_of(row, [](std::uint8_t byte) { return byte < 100; }));  // a body
}

TEST_F(ShellTest, files_that_were_opened_come_first_and_missing_ones_cannot_be_chosen) {
  const std::string a = write("a.toml", k_rocking), b = write("b.toml", k_rocking);
  for (const std::string& path : {a, b, a}) {
    shell_->open(path);
    ASSERT_TRUE(
        until([&] { return ready() && shell_->title() == "topple: " + fs::path(path).stem().string(); }));
  }
  EXPECT_EQ(recent_files(), (std::vector<std::string>{a, b}));
  fs::remove(a);
  press('O', true);
  ASSERT_TRUE(shell_->chooser().is_open());
  type(a);
  EXPECT_EQ(shell_->chooser().selected(), a);
  press(render::key::enter);
  EXPECT_FALSE(shell_->opening());
  EXPECT_TRUE(shell_->chooser().is_open());
  press(render::key::escape);
  EXPECT_FALSE(shell_->chooser().is_open());
  for (int i = 0; i < 20; ++i) remember_recent((scratch_ / std::to_string(i).c_str()).string());
  EXPECT_EQ(recent_files().size(), k_most_recent);
  EXPECT_EQ(recent_files().front(), (scratch_ / "19").string());
}

TEST_F(ShellTest, another_scene_closes_the_recording_of_the_one_that_runs) {
  open_rocking();
  run_to(0.1);
  for (int i = 0; i < 4; ++i) player().slower();  // it is under way when the other one is there
  player().play();
  const std::string recording = shell_->session()->recording();
  ASSERT_FALSE(recording.empty());
  shell_->drop({write("other.toml", k_rocking)});
  ASSERT_TRUE(until([&] { return ready() && shell_->title() == "topple: other"; }));
  EXPECT_EQ(player().time(), 0);
  EXPECT_NE(shell_->session()->recording(), recording);
  ASSERT_TRUE(until([&] { return io::Recording(recording).status() == "stopped"; }));
  EXPECT_GT(io::Recording(recording).frame_count(), 5);
  shell_->drop({recording});
  ASSERT_TRUE(until([&] { return player().replay() && !player().way().empty(); }));
  EXPECT_EQ(shell_->session()->recording(), recording);
}

TEST_F(ShellTest, a_broken_scene_is_explained_as_on_the_command_line_and_what_was_open_stays) {
  open_rocking();
  run_to(0.1);
  const double time = player().time();
  std::string text = k_rocking;
  text.replace(text.find("300 gal"), 7, "300 kg");
  const std::string broken = write("broken.toml", text);
  std::string expected;
  try {
    io::load_scene(broken);
  } catch (const io::InputError& error) {
    expected = error.what();
  }
  ASSERT_NE(expected.find("broken.toml:8:"), std::string::npos) << expected;
  shell_->drop({broken});
  ASSERT_TRUE(until([&] { return shell_->message().has_value(); }));
  EXPECT_EQ(shell_->message()->text, expected);
  click("Copy");
  EXPECT_EQ(std::string(ImGui::GetClipboardText()), expected);
  click("Close");
  EXPECT_FALSE(shell_->message().has_value());
  EXPECT_EQ(shell_->title(), "topple: rocking");
  EXPECT_EQ(player().time(), time);
  EXPECT_TRUE(player().can_edit());
  run_to(time + 0.05);
}

TEST_F(ShellTest, damaged_recordings_and_files_of_other_kinds_are_refused_with_their_reason) {
  const std::string damaged = write("damaged.h5", "\x89HDF\r\n\x1a\nand nothing more");
  for (const std::string& path :
       {damaged, write("notes.txt", "not an accelerogram"), (scratch_ / "").string()}) {
    shell_->drop({path});
    ASSERT_TRUE(until([&] { return shell_->message().has_value(); }));
    EXPECT_NE(shell_->message()->text.find(path), std::string::npos) << shell_->message()->text;
    EXPECT_EQ(shell_->message()->text.find('\n'), std::string::npos);
    press(render::key::escape);
    EXPECT_EQ(shell_->session(), nullptr);
  }
}

TEST_F(ShellTest, a_recording_of_another_format_is_refused_and_what_was_open_goes_on) {
  open_rocking();
  run_to(0.1);
  shell_->show({.scene = live_scene(), .recording = {}, .output = (scratch_ / "a.h5").string()}, "");
  ASSERT_TRUE(until([&] { return ready(); }));
  run_to(0.1);
  shell_->close("stopped");
  const std::string other = (scratch_ / "other.h5").string();
  fs::copy_file(scratch_ / "a.h5", other);
  {
    const hid_t file = H5Fopen(other.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    const hid_t version = H5Aopen(file, "version", H5P_DEFAULT);
    const int later = 11;
    ASSERT_GE(H5Awrite(version, H5T_NATIVE_INT, &later), 0);
    H5Aclose(version);
    H5Fclose(file);
  }
  open_rocking();
  shell_->drop({other});
  ASSERT_TRUE(until([&] { return shell_->message().has_value(); }));
  EXPECT_EQ(shell_->message()->text,
            other + ": recording format 11 is not supported by this version, which reads formats 1 to 10");
  press(render::key::escape);
  EXPECT_EQ(shell_->title(), "topple: rocking");
  run_to(0.1);
}

TEST_F(ShellTest, a_guided_demo_opens_its_own_scene_and_what_was_open_stays_recorded) {
  open_rocking();
  run_to(0.1);
  const std::string recording = shell_->session()->recording();
  shell_->session()->viewer().show(Viewer::Tab::teach);
  click(std::string(demos()[0].name.english) + "##demo0", "side/content");
  const auto begun = [&] { return shell_->session()->viewer().teaching().guide.has_value(); };
  ASSERT_TRUE(until(begun));
  EXPECT_EQ(shell_->title(), "topple: paper-a");
  EXPECT_EQ(player().parameters().shakes[0].frequency, demos()[0].frequency);
  ASSERT_TRUE(until([&] { return io::Recording(recording).status() == "stopped"; }));
  const auto stands_still = [&] { return shell_->session()->viewer().teaching().guide->step() == 0; };
  ASSERT_TRUE(until(stands_still));
  click("Back to rocking##back", "side/content");
  ASSERT_TRUE(until([&] { return ready() && shell_->title() == "topple: rocking"; }));
  EXPECT_FALSE(shell_->session()->viewer().teaching().guide.has_value());
}

TEST_F(ShellTest, an_accelerogram_becomes_the_first_shake_of_a_copy_that_starts_anew) {
  open_rocking();
  run_to(0.1);
  const std::string record = write("quake.AT2", k_at2);
  shell_->drop({record});
  ASSERT_TRUE(until([&] { return ready() && player().parameters().shakes[0].kind == Shake::Kind::record; }));
  EXPECT_EQ(player().time(), 0);
  EXPECT_EQ(shell_->session()->scene().setup.model.bodies.size(), 1u);
  ASSERT_EQ(shell_->session()->scene().files.size(), 1u);
  EXPECT_EQ(shell_->session()->scene().files[0].bytes, k_at2);

  shell_->drop({write("gap.AT2", std::string(k_at2) + "0.3")});
  ASSERT_TRUE(until([&] { return shell_->message().has_value(); }));
  EXPECT_NE(shell_->message()->text.find("gap.AT2"), std::string::npos);
  EXPECT_EQ(player().parameters().shakes[0].kind, Shake::Kind::record);
}

TEST_F(ShellTest, without_a_place_for_recordings_the_run_goes_on_and_says_so) {
  setenv("XDG_STATE_HOME", "/dev/null/nowhere", 1);
  open_rocking();
  ASSERT_TRUE(shell_->message().has_value());
  EXPECT_NE(shell_->message()->text.find("XDG_STATE_HOME"), std::string::npos);
  press(render::key::escape);
  run_to(0.1);
  EXPECT_TRUE(shell_->session()->recording().empty());
}

TEST_F(ShellTest, a_read_only_place_for_recordings_is_explained) {
  const std::string disk = (scratch_ / "disk").string();
  if (!mount_disk(disk, "400k", true)) GTEST_SKIP() << "mounting is not allowed";
  setenv("XDG_STATE_HOME", disk.c_str(), 1);
  open_rocking();
  EXPECT_TRUE(until([&] { return shell_->message().has_value(); }));
  press(render::key::escape);
  run_to(0.1);
  unmount_disk(disk);
}

TEST_F(ShellTest, a_full_disk_ends_the_recording_and_not_the_run) {
  const std::string disk = (scratch_ / "disk").string();
  if (!mount_disk(disk, "300k")) GTEST_SKIP() << "mounting is not allowed";
  setenv("XDG_STATE_HOME", disk.c_str(), 1);
  open_rocking();
  const std::string recording = shell_->session()->recording();
  player().play();
  ASSERT_TRUE(until([&] { return shell_->message().has_value(); }));
  EXPECT_NE(shell_->message()->text.find(recording), std::string::npos) << shell_->message()->text;
  const double time = player().time();
  press(render::key::escape);
  EXPECT_FALSE(shell_->message().has_value());
  EXPECT_TRUE(until([&] { return player().time() > time || !player().playing(); }));
  for (int i = 0; i < 5; ++i) frame();
  EXPECT_FALSE(shell_->message().has_value());  // shown once
  const std::vector<LiveStatus> ends = shell_->close("stopped");
  EXPECT_FALSE(ends.back().record_failure.empty());
  unmount_disk(disk);
}

TEST_F(ShellTest, a_step_that_fails_offers_half_of_it) {
  shell_->show(
      {.scene = live_scene(k_rocking, {"run.integrator=central-difference", "cabinet.free.model=frame"}),
       .recording = {},
       .output = (scratch_ / "d.h5").string()},
      "");
  ASSERT_TRUE(until([&] { return ready(); }));
  player().play();
  ASSERT_TRUE(until([&] { return shell_->message().has_value(); }));
  EXPECT_NE(shell_->message()->text.find("the time integration is stable up to"), std::string::npos)
      << shell_->message()->text;
  ASSERT_TRUE(shell_->message()->may_halve_step);
  EXPECT_FALSE(player().playing());
  EXPECT_GE(player().status().element, 0);
  const auto last_good = player().row();
  ASSERT_TRUE(last_good.has_value());
  EXPECT_TRUE(std::ranges::all_of(last_good->position, [](float x) { return std::isfinite(x); }));
  const double step = player().parameters().time_step;
  click("Halve the step and retry");
  EXPECT_DOUBLE_EQ(player().parameters().time_step, step / 2);
}

TEST_F(ShellTest, where_a_step_failed_is_marked_in_the_picture) {
  shell_->show({.scene = live_scene(k_rocking, {"run.integrator=central-difference"})}, "");
  ASSERT_TRUE(until([&] { return ready(); }));
  const auto scene = [&] {  // without words and panels
    press(render::key::escape);
    for (int i = 0; i < 60; ++i) frame();  // until it is drawn at its best
    const render::Image image = stage_.shot(shell_->surface(), *ImGui::GetDrawData());
    std::vector<std::uint8_t> pixels;
    for (std::size_t y = 100; y < 450; ++y)
      pixels.insert(pixels.end(), &image.rgba[4 * (1280 * y + 200)], &image.rgba[4 * (1280 * y + 750)]);
    return pixels;
  };
  const std::vector<std::uint8_t> before = scene();
  player().play();
  ASSERT_TRUE(until([&] { return shell_->message().has_value(); }));
  ASSERT_EQ(player().time(), 0);
  EXPECT_NE(scene(), before);
}

TEST_F(ShellTest, a_run_that_cannot_keep_up_tells_when_it_ends) {
  shell_->show({.scene = live_scene(k_rocking, {"run.time_step=1e-6", "run.integrator=central-difference",
                                                "cabinet.1.model=frame"})},
               "");
  ASSERT_TRUE(until([&] { return ready(); }));
  player().play();
  EXPECT_TRUE(until([&] { return status_in_words(player()).find(" to the end.") != std::string::npos; }))
      << status_in_words(player());
}

TEST_F(ShellTest, the_scene_is_saved_as_it_is_now_and_no_file_is_replaced_unasked) {
  open_rocking();
  run_to(0.1);
  player().begin_edit();
  player().edit({Edit::Key::friction, 0, Vec3(0.321, 0, 0)});
  const std::string path = (scratch_ / "kept.toml").string();
  save_as(path);
  EXPECT_FALSE(shell_->save_dialog().is_open());
  const io::Scene saved = io::load_scene(path);
  EXPECT_EQ(saved.setup.parameters.contact.friction, 0.321);
  EXPECT_EQ(recent_files().front(), path);
  EXPECT_EQ(saved.title, "A rocking cabinet for tests");
  run_to(player().time() + 0.05);
  const Viewer& viewer = shell_->session()->viewer();
  EXPECT_EQ(viewer.title(), "A rocking cabinet for tests (changed), saved as kept");
  player().to_start();
  EXPECT_EQ(viewer.title(), "A rocking cabinet for tests");
  player().to_end();
  const auto proposal = [&] {
    shell_->save_dialog().open(shell_->session()->scene());
    frame();
    frame();
    const ImGuiInputTextState& field = ImGui::GetCurrentContext()->InputTextState;
    EXPECT_EQ(field.ID, ImGui::GetActiveID());
    EXPECT_EQ(std::abs(field.Stb.select_end - field.Stb.select_start), field.CurLenW);
    EXPECT_GT(field.CurLenW, 0);
    shell_->save_dialog().close();
    frame();
    return std::string(shell_->save_dialog().path);
  };
  EXPECT_EQ(proposal(), (scratch_ / "kept-1.toml").string());
  save_as((scratch_ / "kept-1.toml").string());
  EXPECT_EQ(proposal(), (scratch_ / "kept-2.toml").string());

  const std::string other = write("other.toml", "mine");
  save_as(other);
  press(render::key::enter);
  EXPECT_TRUE(shell_->save_dialog().is_open());
  EXPECT_EQ(read(other), "mine");
  click("Replace it");
  EXPECT_FALSE(shell_->save_dialog().is_open());
  EXPECT_EQ(io::load_scene(other).setup.parameters.contact.friction, 0.321);
  EXPECT_EQ(files_like(".part"), 0);
}

TEST_F(ShellTest, what_cannot_be_saved_is_explained_in_the_dialog_which_stays) {
  open_rocking();
  const std::pair<std::string, std::string> targets[] = {{"/proc/nothing.toml", "/proc/nothing.toml"},
                                                         {(scratch_ / "no/such.toml").string(), "no folder"}};
  for (const auto& [target, reason] : targets) {
    save_as(target);
    EXPECT_TRUE(shell_->save_dialog().is_open());
    EXPECT_NE(shell_->save_dialog().refused().find(reason), std::string::npos)
        << shell_->save_dialog().refused();
    press(render::key::escape);
  }
  const std::string good = (scratch_ / "good.toml").string();
  save_as(good);
  EXPECT_TRUE(fs::exists(good));
  run_to(0.1);
}

TEST_F(ShellTest, accelerograms_are_saved_beside_the_scene) {
  open_rocking();
  shell_->drop({write("quake.AT2", k_at2)});
  ASSERT_TRUE(until([&] { return ready() && player().parameters().shakes[0].record; }));
  const io::Scene& absolute = shell_->session()->scene();
  const io::Scene relative =
      io::parse_scene(k_rocking.substr(0, k_rocking.find("[[shake]]")) +
                          "[[shake]]\ntype = \"record\"\nfiles = [\"quake.AT2\"]\n" +
                          k_rocking.substr(k_rocking.find("[contact]")),
                      "r.toml", {}, [](const std::string&) { return std::string(k_at2); });
  fs::create_directory(scratch_ / "far");
  const std::string path = (scratch_ / "far/kept.toml").string();
  save_scene(relative, relative.setup.parameters, path, false);
  EXPECT_EQ(read((scratch_ / "far/quake.AT2").string()), k_at2);
  EXPECT_EQ(io::load_scene(path).files.size(), 1u);
  std::ofstream(scratch_ / "far/quake.AT2") << "another";
  const std::string second = (scratch_ / "far/second.toml").string();
  EXPECT_THROW(save_scene(relative, relative.setup.parameters, second, false), std::runtime_error);
  EXPECT_FALSE(fs::exists(second));
  save_scene(absolute, absolute.setup.parameters, second, false);  // names the file where it is
  EXPECT_EQ(io::load_scene(second).files[0].bytes, k_at2);
  EXPECT_EQ(read((scratch_ / "far/quake.AT2").string()), "another");
}

}  // namespace
}  // namespace topple::app
