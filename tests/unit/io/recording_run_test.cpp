// Recordings of real runs: what was stepped is what is read, and a run goes on from what was recorded.
#include <cstdlib>

#include "recording_fixture.h"
#include "solver/io/export/export_csv.h"

namespace topple::io::testing {
namespace {

class RunRecordingTest : public RecordingTest {
 protected:
  /// Records a run of k_scene and keeps what a reader ought to find.
  void record() {
    scene_ = parse_scene(k_scene, "test");
    topple::Run run(scene_.setup);
    Recorder recorder(path("run.h5"), scene_.name, scene_.text, scene_.setup.model);
    const auto keep = [&] {  // what multiples of 1/60 s it has passed
      for (; static_cast<double>(rows_.size()) / 60 < run.time() + 1e-9;) {
        const double time = static_cast<double>(rows_.size()) / 60;
        rows_.push_back(time < run.time() - 1e-9 ? frame_row(run, time) : frame_row(run));
      }
    };
    Observer observer;
    recorder.write(observer.observe(run));
    keep();
    while (!run.over()) {
      const StepStatus status = run.advance();
      ASSERT_TRUE(status.ok()) << status.message(scene_.setup.model);
      recorder.write(observer.observe(run));
      recorder.flush_if_due();
      keep();
    }
    if (rows_.back().step != run.state().step) rows_.push_back(frame_row(run));
    last_hash_ = hash(run.state());
    events_ = run.events();
    recorder.write(observer.last(run));
    recorder.finish("completed", "{\"schema\": 1}");
  }
  Scene scene_;
  std::vector<FrameRow> rows_;
  std::vector<Event> events_;
  std::uint64_t last_hash_ = 0;
};

TEST_F(RunRecordingTest, a_recorded_run_reads_back_as_it_was) {
  record();
  const Recording recording(path("run.h5"));
  EXPECT_EQ(recording.status(), "completed");
  EXPECT_EQ(recording.summary_json(), "{\"schema\": 1}");
  EXPECT_EQ(recording.scene_text(), scene_.text);
  ASSERT_EQ(recording.frame_count(), static_cast<std::int64_t>(rows_.size()));
  EXPECT_GE(rows_.size(), 138u);
  EXPECT_EQ(rows_.front().step, 0);
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    ASSERT_TRUE(same(recording.frame(static_cast<std::int64_t>(i)), rows_[i])) << i;
  }
  const auto events = recording.events();
  ASSERT_EQ(events.size(), events_.size());
  EXPECT_GT(events.size(), 0u);
  for (std::size_t i = 0; i < events.size(); ++i) {
    EXPECT_EQ(events[i].event.kind, events_[i].kind);
    EXPECT_EQ(events[i].step, events_[i].step);
    EXPECT_EQ(events[i].event.value, events_[i].value);
  }
}

TEST_F(RunRecordingTest, seek_equals_linear_replay) {
  record();
  const Recording recording(path("run.h5"));
  const Scene scene = parse_scene(recording.scene_text(), recording.scene_name());
  const std::int64_t count = recording.checkpoint_count();
  ASSERT_EQ(count, 4);  // 0 s, 1 s, 2 s and the end
  EXPECT_EQ(recording.checkpoint(0).step, 0);
  EXPECT_EQ(recording.checkpoint(count - 1).hash, last_hash_);
  for (std::int64_t i = 0; i < count; ++i) {
    const Checkpoint checkpoint = recording.checkpoint(i);
    State state = unpack(scene.setup.model, checkpoint.state);
    EXPECT_EQ(hash(state), checkpoint.hash) << i;
    EXPECT_EQ(state.time, checkpoint.time);
    EXPECT_EQ(state.step, checkpoint.step);
    if (i + 1 == count) break;
    const Checkpoint next = recording.checkpoint(i + 1);
    topple::Run run(scene.setup, std::move(state), scene.setup.parameters);
    while (run.state().step < next.step) ASSERT_TRUE(run.advance().ok());
    EXPECT_EQ(hash(run.state()), next.hash) << i;
  }
}

// Its nodes are where they were when somebody looked last.
TEST_F(RunRecordingTest, a_block_that_goes_on_from_a_checkpoint_bears_no_forces_in_its_sections) {
  const Scene scene = load_scene("cabinet");
  topple::Run whole(scene.setup);
  while (whole.time() < 3) ASSERT_TRUE(whole.advance().ok());
  State state = whole.state();
  ASSERT_EQ(state.bodies[0].level, ModelLevel::planar);
  state.position[0].z() += 0.01;
  const topple::Run rest(scene.setup, state, scene.setup.parameters);
  for (const SectionForces& forces : rest.sections())
    EXPECT_TRUE(forces.normal.isZero(0) && forces.moment.isZero(0));
}

TEST_F(RunRecordingTest, an_exported_run_has_a_row_for_each_frame_and_thing) {
  record();
  export_csv(Recording(path("run.h5")), path("csv"));
  const Model& model = scene_.setup.model;
  const auto lines = [this](const char* name) {
    const std::string text = bytes_of(path(std::string("csv/") + name));
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) - 1;
  };
  EXPECT_EQ(lines("bodies.csv"), rows_.size() * model.bodies.size());
  EXPECT_EQ(lines("nodes.csv"), rows_.size() * model.node_position.size());
  EXPECT_EQ(lines("elements.csv"), rows_.size() * model.elements.size());
  EXPECT_EQ(lines("floor.csv"), rows_.size());
}

}  // namespace
}  // namespace topple::io::testing
