// What a repaired recording keeps of a session with edits and branches.
#include <csignal>

#include "recording_fixture.h"
#include "solver/io/recording/recover.h"
#include "solver/io/recording/rerun.h"

namespace topple::io::testing {
namespace {

/// Records an edit at step 300 and a second branch from there, then dies with the file open.
int die_in_a_session(const std::string& file) {
  const Scene scene = parse_scene(k_scene, "test");
  Recorder recorder(file, scene.name, scene.text, scene.setup.model, scene.files);
  topple::Run run(scene.setup);
  Observer observer;
  recorder.write(observer.observe(run));
  const auto go_to = [&](std::int64_t step) {
    while (run.state().step < step && run.advance().ok()) recorder.write(observer.observe(run));
  };
  go_to(300);
  const RunPoint point = run.point();
  const Edit edit{.key = Edit::Key::friction, .value = Vec3(0.3, 0, 0)};
  recorder.write(LoggedEdit{.branch = 0, .step = 300, .time = run.state().time, .edit = edit});
  run.edit(edit);
  go_to(900);
  recorder.write(observer.last(run));
  recorder.write(Branch{.id = 1, .parent = 0, .fork_step = 300});
  run = topple::Run(scene.setup, point);
  run.edit(edit);
  observer = Observer(1);
  recorder.write(observer.observe(run));
  go_to(700);
  recorder.flush();
  return 0 * raise(SIGKILL);
}

TEST_F(RecordingTest, a_repaired_session_keeps_its_edits_and_branches_and_runs_again) {
  ASSERT_EQ(in_child([this] { return die_in_a_session(path("a.h5")); }), -SIGKILL);
  const Recording killed(path("a.h5"));
  const SoundRows rows = sound_rows(killed);
  EXPECT_EQ(rows.damaged_frames + rows.damaged_checkpoints, 0);
  write_recovered(killed, rows, path("b.h5"));
  const Recording repaired(path("b.h5"));
  ASSERT_EQ(repaired.history().branches.size(), 2u);
  EXPECT_EQ(repaired.history().branches[1].fork_step, 300);
  ASSERT_EQ(repaired.history().edits.size(), 1u);
  EXPECT_EQ(repaired.history().edits[0].edit.value, killed.history().edits[0].edit.value);
  EXPECT_EQ(repaired.frames_on_way_to(1).size(), killed.frames_on_way_to(1).size());
  EXPECT_EQ(repaired.events().size(), killed.events().size());
  const Rerun again = rerun(repaired, [](std::int64_t) {});
  EXPECT_EQ(again.checkpoints, killed.checkpoint_count());
  EXPECT_TRUE(again.differences.empty());
}

TEST_F(RecordingTest, a_recording_of_another_model_is_not_repaired) {
  {
    const Scene scene = parse_scene(k_scene, "test");
    std::string other = k_scene;
    other += "shelves = 1\n";
    Recorder recorder(path("a.h5"), scene.name, other, scene.setup.model);
    recorder.write(Observer().observe(topple::Run(scene.setup)));
    recorder.finish("completed", "{}");
  }
  const Recording recording(path("a.h5"));
  EXPECT_THROW(write_recovered(recording, sound_rows(recording), path("b.h5")), InputError);
  EXPECT_EQ(files_in_folder(), 1u);
}

}  // namespace
}  // namespace topple::io::testing
