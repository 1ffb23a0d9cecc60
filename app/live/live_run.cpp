#include "app/live/live_run.h"

#include "app/live/live_worker.h"

namespace topple::app {

LiveRun::LiveRun(LiveSource source, std::function<void()> wake, Advance advance)
    : worker_(std::make_shared<LiveWorker>(std::move(source), std::move(wake), std::move(advance))) {
  worker_->start(worker_);
}
LiveRun::~LiveRun() {
  close("interrupted");
}
void LiveRun::go(double speed) {
  worker_->post(Go{speed});
}
void LiveRun::halt() {
  worker_->post(Halt{});
}
void LiveRun::one_step() {
  worker_->post(OneStep{});
}
void LiveRun::edit(const Edit& edit) {
  worker_->post(Edits{{edit}});
}
void LiveRun::fork(std::int32_t branch, std::int64_t step, std::vector<Edit> edits) {
  worker_->post(Fork{branch, step, std::move(edits)});
}
LiveReport LiveRun::take() {
  return worker_->take();
}
LiveStatus LiveRun::close(const std::string& status) {
  if (!worker_) return {};
  LiveStatus last = worker_->close(status);
  worker_.reset();
  return last;
}

}  // namespace topple::app
