// Recordings of runs with anchors, and what others look like beside them.
#include <set>

#include "recording_fixture.h"
#include "solver/io/export/export_csv.h"
#include "solver/io/recording/rerun.h"

namespace topple::io::testing {
namespace {

/// The straps of the built-in scene: one breaks at the first pull, the other is taken away and put in place.
class AnchorRecordingTest : public RecordingTest {
 protected:
  void record() {
    Recorder recorder(path("run.h5"), scene_.name, scene_.text, scene_.setup.model);
    topple::Run run(scene_.setup);
    Observer observer;
    const auto take = [&](const Observation& observation) {
      rows_.insert(rows_.end(), observation.frames.begin(), observation.frames.end());
      recorder.write(observation);
    };
    const auto edit = [&](double on) {
      const Edit change{.key = Edit::Key::anchor, .index = 1, .value = Vec3(on, 0, 0)};
      recorder.write(LoggedEdit{0, run.step(), run.time(), change});
      run.edit(change);
    };
    take(observer.observe(run));
    while (!run.over()) {
      if (run.step() == 1300) edit(0);
      if (run.step() == 1500) edit(1);
      ASSERT_TRUE(run.advance().ok());
      take(observer.observe(run));
    }
    events_ = run.events();
    energy_ = run.state().energy;
    take(observer.last(run));
    recorder.finish("completed", "{}");
  }
  Scene scene_ = load_scene("anchored", {"run.duration=2.3", "anchor.left.strength=60 N"});
  std::vector<FrameRow> rows_;
  std::vector<Event> events_;
  EnergyLedger energy_;
};

TEST_F(AnchorRecordingTest, forces_states_and_breaking_read_back_and_the_run_repeats) {
  record();
  const Recording recording(path("run.h5"));
  ASSERT_EQ(recording.frame_count(), static_cast<std::int64_t>(rows_.size()));
  std::vector<std::set<float>> states(2);
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const FrameRow row = recording.frame(static_cast<std::int64_t>(i));
    ASSERT_TRUE(same(row, rows_[i])) << i;
    ASSERT_EQ(row.anchor.size(), 2u);
    for (std::size_t k = 0; k < 2; ++k) {
      const AnchorNumbers& anchor = row.anchor[k];
      states[k].insert(anchor.state);
      EXPECT_EQ(anchor.tension != 0, anchor.state == k_anchor_holds);
      const double stretch = anchor.tension / scene_.setup.model.anchors[k].stiffness;
      EXPECT_NEAR(anchor.energy, anchor.tension * stretch / 2, 1e-6);
    }
    EXPECT_NEAR(row.energy[k_anchor], double(row.anchor[0].energy) + double(row.anchor[1].energy), 1e-6);
  }
  EXPECT_EQ(states[0], (std::set<float>{k_anchor_slack, k_anchor_holds, k_anchor_broken}));
  EXPECT_EQ(states[1], (std::set<float>{k_anchor_away, k_anchor_slack, k_anchor_holds}));
  EXPECT_GT(energy_.released, 0);
  EXPECT_EQ(rows_.back().energy[k_released], energy_.released);

  const auto broken = [](const auto& events) {
    return std::ranges::count_if(events, [](const Event& e) { return e.kind == Event::Kind::anchor; });
  };
  std::vector<Event> read;
  for (const RecordedEvent& event : recording.events()) read.push_back(event.event);
  EXPECT_EQ(broken(events_), 1);
  ASSERT_EQ(broken(read), 1);
  const auto is_anchor = [](const Event& e) { return e.kind == Event::Kind::anchor; };
  const Event &back = *std::ranges::find_if(read, is_anchor),
              &was = *std::ranges::find_if(events_, is_anchor);
  EXPECT_EQ(back.anchor, 0);
  EXPECT_EQ(back.step, was.step);
  EXPECT_EQ(back.value, was.value);
  EXPECT_GT(back.value, 60);

  const Rerun again = rerun(recording, [](std::int64_t) {});
  EXPECT_EQ(again.checkpoints, recording.checkpoint_count());
  EXPECT_TRUE(again.differences.empty());
}

TEST_F(AnchorRecordingTest, an_export_has_a_row_for_each_anchor) {
  record();
  export_csv(Recording(path("run.h5")), path("csv"));
  const std::string text = bytes_of(path("csv/anchors.csv"));
  EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(text, '\n')), 1 + 2 * rows_.size());
  EXPECT_EQ(text.find("time_s,anchor,tension_N,energy_J,natural_length_m,state\n"), 0u);
  EXPECT_NE(text.find(",left,0,0,"), std::string::npos);
  EXPECT_NE(text.find(",broken\n"), std::string::npos);
  const std::string energy = bytes_of(path("csv/energy.csv"));
  EXPECT_NE(energy.find(",balance_error,anchor_J,released_J\n"), std::string::npos);
}

TEST_F(AnchorRecordingTest, a_recording_without_anchors_has_no_columns_for_them) {
  const RowShape shape{.nodes = 3, .elements = 2, .contacts = 4, .touched = 2, .bodies = 2};
  EXPECT_EQ(field_count(shape), 15u);
  EXPECT_EQ(frame_fields(shape)[9].dims, (std::vector<hsize_t>{12}));
  {
    Recorder recorder(path("plain.h5"), "plain", k_text, small_model());
    recorder.write({.frames = {fake_row(shape, 0, 0)}, .checkpoint = {}, .events = {fake_event(0, 0)}});
    recorder.finish("completed", "{}");
  }
  const Handle file(H5Fopen(path("plain.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  EXPECT_EQ(H5Lexists(file, "frames/anchor", H5P_DEFAULT), 0);
  EXPECT_EQ(H5Lexists(file, "model/anchors", H5P_DEFAULT), 0);
  const Handle events(H5Dopen2(file, "events", H5P_DEFAULT), H5Dclose);
  const Handle stored(H5Dget_type(events), H5Tclose);
  const Handle kind(H5Tget_member_type(stored, 1), H5Tclose);
  EXPECT_EQ(H5Tget_nmembers(kind), 6);
  const Recording recording(path("plain.h5"));
  EXPECT_TRUE(same(recording.frame(0), fake_row(shape, 0, 0)));
  EXPECT_EQ(recording.events().size(), 1u);
}

}  // namespace
}  // namespace topple::io::testing
