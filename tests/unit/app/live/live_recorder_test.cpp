#include "app/live/live_recorder.h"

#include "unit/app/live.h"
#include "unit/render/scratch.h"

namespace topple::app {
namespace {

// More than may wait, posted at once.
TEST(LiveRecorder, keeps_all_that_is_posted_faster_than_it_is_written) {
  const auto scene = live_scene(k_rocking, {"run.duration=3", "run.output_rate=1000"});
  topple::Run run(scene->setup);
  io::Observer observer;
  std::vector<io::Observation> rows{observer.observe(run)};
  while (!run.over() && run.advance().ok()) rows.push_back(observer.observe(run));
  ASSERT_EQ(rows.size(), 3001u);
  const render::Scratch scratch;
  LiveRecorder recorder(scratch / "fast.h5", *scene);
  for (const io::Observation& row : rows) recorder.post(row);
  recorder.finish("completed", "{}");
  EXPECT_EQ(recorder.failure(), "");
  const io::Recording recording(scratch / "fast.h5");
  EXPECT_EQ(recording.status(), "completed");
  EXPECT_EQ(recording.frame_count(), 3001);
}

}  // namespace
}  // namespace topple::app
