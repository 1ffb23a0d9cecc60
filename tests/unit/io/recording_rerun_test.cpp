// Which instants a run gives to its recording, and runs repeated from what was recorded.
#include <bit>
#include <functional>

#include "recording_fixture.h"
#include "solver/io/recording/rerun.h"

namespace topple::io::testing {
namespace {

/// A run of k_scene under edits that is recorded as it goes, and that can be continued from an earlier point.
class Session {
 public:
  explicit Session(const std::string& file, Scene scene = parse_scene(k_scene, "test"))
      : scene_(std::move(scene)),
        recorder_(file, scene_.name, scene_.text, scene_.setup.model, scene_.files),
        run_(scene_.setup) {
    take(observer_.observe(run_));
  }
  void go_to(std::int64_t step) {
    while (run_.state().step < step) {
      ASSERT_TRUE(run_.advance().ok());
      take(observer_.observe(run_));
    }
  }
  void edit(Edit::Key key, double value) { this->edit({.key = key, .value = Vec3(value, 0, 0)}); }
  void edit(const Edit& edit) {
    history_.edits.push_back({branch_, run_.state().step, run_.state().time, edit});
    recorder_.write(history_.edits.back());
    run_.edit(edit);
  }
  const topple::Run& run() const { return run_; }
  RunPoint point() const { return run_.point(); }
  void go_on_from(RunPoint point, std::int32_t parent) {
    take(observer_.last(run_));
    history_.branches.push_back({++branch_, parent, point.state.step});
    recorder_.write(history_.branches.back());
    // an edit may have been posted at the point's step after the point was kept
    point.parameters = parameters_at(scene_.setup, history_, branch_, point.state.step);
    run_ = topple::Run(scene_.setup, point);
    observer_ = Observer(branch_);
    take(observer_.observe(run_));
  }
  /// `lie`: gives the newest checkpoint another hash.
  void finish(bool lie = false) {
    Observation last = observer_.last(run_);
    ASSERT_TRUE(last.checkpoint);
    if (lie) ++last.checkpoint->hash;
    take(last);
    recorder_.finish("completed", "{}");
  }

 private:
  void take(const Observation& observation) { recorder_.write(observation); }

  Scene scene_;
  Recorder recorder_;
  topple::Run run_;
  Observer observer_;
  History history_{.branches = {{}}};
  std::int32_t branch_ = 0;
};

class RerunTest : public RecordingTest {
 protected:
  /// Three branches: 0 to 1.4 s, 1 from 0.7 s of 0, 2 from 1.19 s of 1.
  void record_session(bool lie = false) {
    Session session(path("a.h5"));
    session.edit(Edit::Key::friction, 0.5);
    session.go_to(300);
    session.edit(Edit::Key::alpha, 5000);
    session.go_to(1000);
    const RunPoint first = session.point();
    session.edit(Edit::Key::amplitude, 1);
    session.go_to(2000);
    session.go_on_from(first, 0);
    session.go_to(1200);
    session.edit(Edit::Key::q, 1.2);
    session.edit(Edit::Key::time_step, 0.5e-3);
    session.go_to(1700);
    const RunPoint second = session.point();
    session.go_to(2600);
    session.go_on_from(second, 1);
    session.edit(Edit::Key::frequency, 2);
    session.go_to(3000);
    session.finish(lie);
  }
  static Rerun again(const Recording& recording) {
    std::int64_t seen = 0;
    const Rerun result = rerun(recording, [&seen](std::int64_t passed) { EXPECT_EQ(passed, ++seen); });
    EXPECT_EQ(seen, recording.checkpoint_count());
    return result;
  }
};

TEST_F(RerunTest, a_session_with_edits_and_forks_has_the_same_hashes_again) {
  record_session();
  const Recording recording(path("a.h5"));
  EXPECT_EQ(recording.history().branches.size(), 3u);
  EXPECT_EQ(recording.history().edits.size(), 6u);
  const Rerun result = again(recording);
  EXPECT_EQ(result.checkpoints, recording.checkpoint_count());
  EXPECT_GE(result.checkpoints, 7);
  EXPECT_TRUE(result.differences.empty());
}

TEST_F(RerunTest, the_way_to_the_newest_branch_is_one_run_without_gaps) {
  record_session();
  const Recording recording(path("a.h5"));
  const std::vector<std::int64_t> way = recording.frames_on_way_to(2);
  double last = -1e-9;
  for (const std::int64_t i : way) {
    const double time = recording.index()[static_cast<std::size_t>(i)].time;
    EXPECT_GT(time, last);
    EXPECT_LT(time - last, 1. / 60 + 1e-12);
    last = time;
  }
}

TEST_F(RerunTest, rows_stand_at_multiples_of_the_output_interval_whatever_the_steps_are) {
  record_session();
  const Recording recording(path("a.h5"));
  int between = 0, within = 0;
  for (const FrameKey& row : recording.index()) {
    const double multiple = std::round(60 * row.time) / 60;
    between += row.time != multiple;
    within += row.time == multiple && std::abs(row.time - 0.7e-3 * std::round(row.time / 0.7e-3)) > 1e-6;
  }
  EXPECT_EQ(between, 3);  // branch 1 ends at 1.54 s, branch 2 is from 1.09 to 1.74 s
  EXPECT_GT(within, 50);
  // of bodies at rest on soft contacts steps are longer than rows are apart
  std::string calm = k_scene;
  calm.replace(calm.find("400 gal"), 7, "1 gal");
  calm.replace(calm.find("\"0.7 ms\""), 8, "\"auto\"\nwant = [\"motion\"]");
  Session session(path("calm.h5"), parse_scene(calm, "calm"));
  session.go_to(60);
  session.finish();
  const Recording auto_steps(path("calm.h5"));
  int in_one_step = 0;
  for (std::size_t k = 0; k + 1 < auto_steps.index().size(); ++k) {
    EXPECT_EQ(auto_steps.index()[k].time, static_cast<double>(k) / 60);
    in_one_step += auto_steps.index()[k].step == auto_steps.index()[k + 1].step;
  }
  EXPECT_GT(in_one_step, 3);
  EXPECT_TRUE(again(auto_steps).differences.empty());
}

// A hand makes a rigid body of what was a planar block. The step before it is longer than rows are apart.
TEST_F(RerunTest, rows_of_a_step_that_an_edit_follows_are_those_before_it) {
  const Scene scene = parse_scene(R"(topple = 1
floor = {}
[run]
duration = "3 s"
want = ["motion"]
[[shake]]
type = "sine"
frequency = "1 Hz"
amplitude = "150 gal"
[[furniture]]
kind = "desk"
)",
                                  "pulled.toml");
  Session session(path("pulled.h5"), scene);
  double before = 0;
  while (session.run().time() < 1) {
    before = session.run().time();
    session.go_to(session.run().step() + 1);
  }
  ASSERT_EQ(session.run().state().bodies[0].level, ModelLevel::planar);
  session.edit(
      {.key = Edit::Key::pull, .index = scene.setup.model.node_total() - 1, .value = Vec3(40, 0, 40)});
  const double edited = session.run().time();
  while (session.run().time() < 1.9) session.go_to(session.run().step() + 1);
  EXPECT_EQ(session.run().state().bodies[0].level, ModelLevel::rigid);
  session.finish();
  const Recording recording(path("pulled.h5"));
  const auto within = [&](const FrameKey& row) { return row.time > before && row.time < edited; };
  EXPECT_TRUE(std::any_of(recording.index().begin(), recording.index().end(), within));
  const Rerun result = again(recording);
  EXPECT_GT(result.checkpoints, 0);
  for (const Difference& one : result.differences) ADD_FAILURE() << one.what << " at " << one.at.time;
}

TEST_F(RerunTest, a_checkpoint_with_another_hash_is_told_with_its_branch) {
  record_session(true);
  const Recording recording(path("a.h5"));
  const Rerun result = again(recording);
  EXPECT_EQ(result.checkpoints, recording.checkpoint_count() - 1);
  EXPECT_TRUE(result.differences.empty());
  ASSERT_EQ(result.damage.size(), 1u);
  EXPECT_EQ(result.damage[0].at.branch, 2);
  EXPECT_EQ(result.damage[0].at.step, 3000);
  EXPECT_EQ(result.damage[0].what, "hash of the stored state");
}

TEST_F(RerunTest, an_edit_that_was_not_recorded_shows_as_a_difference_of_its_branch_only) {
  const Scene scene = parse_scene(k_scene, "test");
  {
    Recorder recorder(path("a.h5"), scene.name, scene.text, scene.setup.model);
    topple::Run run(scene.setup);
    Observer observer;
    recorder.write(observer.observe(run));
    const RunPoint start = run.point();
    while (run.state().step < 100) run.advance();
    recorder.write(observer.last(run));
    recorder.write(Branch{1, 0, 0});
    topple::Run other(scene.setup, start);
    Observer second(1);
    recorder.write(second.observe(other));
    other.edit({.key = Edit::Key::q, .value = Vec3(2, 0, 0)});
    while (other.state().step < 100) other.advance();
    recorder.write(second.last(other));
    recorder.finish("completed", "{}");
  }
  const Rerun result = again(Recording(path("a.h5")));
  EXPECT_EQ(result.checkpoints, 3);
  ASSERT_EQ(result.differences.size(), 1u);
  EXPECT_EQ(result.differences[0].at.branch, 1);
  EXPECT_EQ(result.differences[0].at.step, 100);
  EXPECT_GE(result.differences[0].element, 0);
}

TEST_F(RerunTest, a_changed_bit_in_a_frame_with_a_checksum_that_fits_is_told_with_its_step_and_element) {
  const Scene scene = parse_scene(k_scene, "test");
  {
    Session session(path("a.h5"));
    session.go_to(300);
    session.finish();
  }
  ASSERT_TRUE(again(Recording(path("a.h5"))).differences.empty());
  change_frame(path("a.h5"), 6, [](std::vector<float>& x) {
    x[3 * 5] = std::bit_cast<float>(std::bit_cast<std::uint32_t>(x[3 * 5]) ^ 1u);
  });
  const Recording recording(path("a.h5"));
  const Rerun result = again(recording);
  ASSERT_EQ(result.differences.size(), 1u);
  const Difference& found = result.differences[0];
  EXPECT_EQ(found.at.step, recording.frame(6).step);
  EXPECT_EQ(found.what, "position");
  const int* const node = scene.setup.model.elements.at(static_cast<std::size_t>(found.element)).node;
  EXPECT_TRUE(node[0] == 5 || node[1] == 5);
}

// Rows of a run that this one is not.
TEST_F(RerunTest, a_changed_number_in_a_frame_is_told_with_its_step_and_element) {
  const Scene scene = parse_scene(k_scene, "test");
  const Model& model = scene.setup.model;
  const auto first_difference = [&](const std::function<void(FrameRow&)>& change) {
    {
      Recorder recorder(path("a.h5"), scene.name, scene.text, model);
      topple::Run run(scene.setup);
      Observer observer;
      recorder.write(observer.observe(run));
      while (run.step() < 200) {
        EXPECT_TRUE(run.advance().ok());
        Observation now = observer.observe(run);
        for (FrameRow& row : now.frames)
          if (run.step() >= 100) change(row);
        recorder.write(now);
      }
      recorder.write(observer.last(run));
      recorder.finish("completed", "{}");
    }
    const Rerun result = again(Recording(path("a.h5")));
    EXPECT_EQ(result.differences.size(), 1u);
    return result.differences.empty() ? Difference{} : result.differences[0];
  };
  const auto step_after_100 = [](std::int64_t step) {
    return step >= 100 && step < 125;
  };  // 60 rows a second
  const Difference moved = first_difference([](FrameRow& row) { row.position[3 * 5] += 1e-6f; });
  EXPECT_TRUE(step_after_100(moved.at.step)) << moved.at.step;
  EXPECT_EQ(moved.what, "position");
  const int* node = model.elements.at(static_cast<std::size_t>(moved.element)).node;
  EXPECT_TRUE(node[0] == 5 || node[1] == 5);
  const Difference loaded = first_difference([](FrameRow& row) { row.section_force[6 * 7 + 2] += 1; });
  EXPECT_EQ(loaded.what, "section_force");
  EXPECT_EQ(loaded.element, 7);
  const Difference yielded = first_difference([](FrameRow& row) { row.hinge[3] = 1; });
  EXPECT_EQ(yielded.what, "hinge");
  EXPECT_EQ(yielded.element, 3);
  EXPECT_TRUE(step_after_100(yielded.at.step));
}

TEST_F(RerunTest, branches_from_the_start_begin_with_their_own_edits) {
  const Scene scene = parse_scene(k_scene, "test");
  const auto write = [&scene](Recorder& recorder, std::int32_t branch, double alpha) {
    topple::Run run(scene.setup);
    const Edit edit{.key = Edit::Key::alpha, .value = Vec3(alpha, 0, 0)};
    recorder.write(LoggedEdit{branch, 0, 0, edit});
    run.edit(edit);
    Observer observer(branch);
    recorder.write(observer.observe(run));
    while (run.step() < 100) {
      EXPECT_TRUE(run.advance().ok());
      recorder.write(observer.observe(run));
    }
    recorder.write(observer.last(run));
  };
  {
    Recorder recorder(path("a.h5"), scene.name, scene.text, scene.setup.model);
    write(recorder, 0, 1000);
    recorder.write(Branch{1, 0, 0});
    write(recorder, 1, 20000);
    recorder.write(Branch{2, 1, 0});
    write(recorder, 2, 5000);
    recorder.finish("completed", "{}");
  }
  const Recording recording(path("a.h5"));
  const Rerun result = again(recording);
  EXPECT_EQ(result.checkpoints, recording.checkpoint_count());
  EXPECT_TRUE(result.differences.empty() && result.damage.empty());
}

/// The scene of a cabinet that a record shakes, read from memory.
Scene record_scene() {
  std::string text = k_scene, file = "time_s,ax_gal,ay_gal\n";
  const auto begin = text.find("type = \"sine\""), end = text.find("[floor]");
  text.replace(begin, end - begin, "type = \"record\"\nfiles = [\"quake.csv\"]\nbaseline = \"parabola\"\n");
  for (int i = 0; i <= 230; ++i)
    file += std::to_string(0.01 * i) + "," + std::to_string(400 * std::sin(3 * 0.01 * i)) + "," +
            std::to_string(100 * std::sin(5 * 0.01 * i)) + "\n";
  return parse_scene(text, "test", {}, [file](const std::string&) { return file; });
}

TEST_F(RerunTest, a_record_is_repeated_and_continued_from_the_recording_alone) {
  {
    Session session(path("a.h5"), record_scene());
    session.edit(Edit::Key::friction, 0.5);
    session.go_to(1000);
    const RunPoint point = session.point();
    session.edit(Edit::Key::scale, 0.4);
    session.go_to(2000);
    session.go_on_from(point, 0);
    session.go_to(1500);
    session.edit(Edit::Key::scale, 1.3);
    session.go_to(3000);
    session.finish();
  }
  const Recording recording(path("a.h5"));
  ASSERT_EQ(recording.scene_files().size(), 1u);
  EXPECT_EQ(recording.scene_files()[0].name, "quake.csv");
  EXPECT_EQ(recording.scene_files()[0].bytes, record_scene().files[0].bytes);
  EXPECT_EQ(recording.scene_text(), record_scene().text);
  const Rerun result = again(recording);
  EXPECT_EQ(result.checkpoints, recording.checkpoint_count());
  EXPECT_GE(result.checkpoints, 5);
  EXPECT_TRUE(result.differences.empty());
}

TEST_F(RerunTest, a_file_that_is_not_in_the_recording_is_not_sought_elsewhere) {
  const Scene scene = record_scene();
  {
    Recorder recorder(path("a.h5"), scene.name, scene.text, scene.setup.model);
    recorder.write(Observer().observe(topple::Run(scene.setup)));
    recorder.finish("completed", "{}");
  }
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder_);
  write_bytes("quake.csv", scene.files[0].bytes);
  try {
    recorded_scene(Recording("a.h5"));
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("quake.csv: is not in the recording"), std::string::npos)
        << error.what();
  }
  std::filesystem::current_path(before);
}

TEST_F(RerunTest, what_does_not_belong_to_its_scene_is_refused) {
  const Scene scene = parse_scene(k_scene, "test");
  const auto error_of = [&](const std::string& text, const std::optional<Edit>& edit) -> std::string {
    {
      Recorder recorder(path("a.h5"), scene.name, text, scene.setup.model);
      const topple::Run run(scene.setup);
      recorder.write(Observer().observe(run));
      if (edit) recorder.write(LoggedEdit{0, 0, 0, *edit});
      recorder.finish("completed", "{}");
    }
    try {
      again(Recording(path("a.h5")));
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_EQ(error_of(scene.text, std::nullopt), "");
  EXPECT_EQ(error_of(scene.text, Edit{.key = Edit::Key::amplitude, .index = 1}),
            "the recording has an edit that its scene has no place for: shake.2.amplitude: there is no such "
            "shake; the scene has 1");
  std::string other = scene.text;
  other.replace(other.find("mass = "), 0, "shelves = 1\n");
  EXPECT_EQ(error_of(other, std::nullopt), k_another_model);
}

TEST(Observer, gives_rows_at_the_output_rate_and_a_checkpoint_each_second_of_its_branch) {
  const Scene scene = parse_scene(k_scene, "test");
  topple::Run run(scene.setup);
  Observer observer(3);
  const Observation first = observer.observe(run);
  ASSERT_TRUE(first.frames.size() == 1 && first.checkpoint);
  EXPECT_EQ(first.frames[0].branch, 3);
  EXPECT_EQ(first.checkpoint->branch, 3);
  EXPECT_EQ(first.checkpoint->step, 0);
  EXPECT_EQ(first.checkpoint->hash, hash(run.state()));
  int rows = 0, checkpoints = 0, events = 0;
  while (run.state().time < 1.2) {
    ASSERT_TRUE(run.advance().ok());
    const Observation now = observer.observe(run);
    EXPECT_EQ(now.empty(), now.frames.empty() && !now.checkpoint && now.events.empty());
    rows += static_cast<int>(now.frames.size());
    checkpoints += now.checkpoint.has_value();
    for (const RecordedEvent& event : now.events) EXPECT_EQ(event.branch, 3);
    events += static_cast<int>(now.events.size());
    for (const FrameRow& row : now.frames)  // most stand within a step
      EXPECT_EQ(row.step, run.step() - (row.time < run.time() - 1e-9));
  }
  EXPECT_EQ(rows, 72);
  EXPECT_EQ(checkpoints, 1);
  EXPECT_EQ(events, static_cast<int>(run.events().size()) - 1);  // but for the level on which it began
  EXPECT_GT(events, 0);
}

TEST(Observer, gives_the_last_state_once) {
  const Scene scene = parse_scene(k_scene, "test");
  topple::Run run(scene.setup);
  Observer observer;
  observer.observe(run);
  EXPECT_TRUE(observer.last(run).empty());
  ASSERT_TRUE(run.advance().ok());
  EXPECT_TRUE(observer.observe(run).empty());
  const Observation last = observer.last(run);
  ASSERT_TRUE(last.frames.size() == 1 && last.checkpoint);
  EXPECT_EQ(last.frames[0].step, 1);
  EXPECT_EQ(last.checkpoint->step, 1);
  EXPECT_TRUE(observer.last(run).empty());
}

TEST(Observer, of_a_branch_begins_with_a_row_and_a_checkpoint_but_without_its_parents_events) {
  const Scene scene = parse_scene(k_scene, "test");
  topple::Run run(scene.setup);
  while (run.events().empty() || run.step() == 0) ASSERT_TRUE(run.advance().ok());
  Observer root, branch(1);
  EXPECT_EQ(root.observe(run).events.size(), run.events().size());
  const Observation first = branch.observe(run);
  EXPECT_TRUE(first.frames.size() == 1 && first.checkpoint);
  EXPECT_TRUE(first.events.empty());
  const std::size_t before = run.events().size();
  while (run.events().size() == before && !run.over()) {
    ASSERT_TRUE(run.advance().ok());
    EXPECT_EQ(branch.observe(run).events.size(), run.events().size() - before);
  }
  EXPECT_GT(run.events().size(), before);
}

// Branches of the start have starts of their own, with other parameters than those of their parents.
TEST(Observer, of_a_branch_of_the_start_has_the_events_of_its_own_start) {
  const Scene scene = parse_scene(k_scene, "test");
  const topple::Run run(scene.setup);
  ASSERT_FALSE(run.events().empty());
  EXPECT_EQ(Observer(1).observe(run).events.size(), run.events().size());
  const std::vector<Stretch> way{{0, 0}, {1, 100}};
  const RecordedEvent parents{.branch = 0, .step = 0, .time = 0, .event = {}}, own{1, 0, 0, {}},
      later{1, 5, 0, {}};
  const auto branches = [&](const std::vector<RecordedEvent>& all) {
    std::vector<std::int32_t> out;
    for (const RecordedEvent& event : events_on(way, all)) out.push_back(event.branch);
    return out;
  };
  EXPECT_EQ(branches({parents, own, later}), (std::vector<std::int32_t>{1, 1}));
  EXPECT_EQ(branches({parents, later}), (std::vector<std::int32_t>{0, 1}));  // of recordings from before
}

}  // namespace
}  // namespace topple::io::testing
