#include "app/live/live_recorder.h"

#include <chrono>

namespace topple::app {
namespace {

constexpr std::chrono::milliseconds k_look{25};  // how often an idle recording is looked after
constexpr std::size_t k_most_waiting = 1000;     // that memory holds for a slow disk

}  // namespace

LiveRecorder::LiveRecorder(const host::Target& target, const io::Scene& scene,
                           const std::string& arithmetic) {
  thread_ = std::thread([this, target, &scene, arithmetic] { work(target, scene, arithmetic); });
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return started_ || !failure_.empty(); });
  if (started_) return;
  lock.unlock();
  thread_.join();
  throw io::WriteError(failure_);
}

LiveRecorder::~LiveRecorder() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void LiveRecorder::post(Item item) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return items_.size() < k_most_waiting || ended_ || !failure_.empty(); });
  if (ended_ || !failure_.empty()) return;
  items_.push_back(std::move(item));
  if (items_.size() == k_most_waiting) changed_.notify_all();
}

void LiveRecorder::finish(const std::string& status, const std::string& summary_json) {
  const std::lock_guard one_at_a_time(finishing_);
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    status_ = status;
    summary_ = summary_json;
    finished_ = ended_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

std::string LiveRecorder::failure() const {
  const std::lock_guard lock(mutex_);
  return failure_;
}

void LiveRecorder::work(const host::Target& target, const io::Scene& scene, const std::string& arithmetic) {
  try {
    io::Recorder recorder(target, scene.name, scene.text, scene.setup.model, scene.files, arithmetic);
    {
      const std::lock_guard lock(mutex_);
      started_ = true;
    }
    changed_.notify_all();
    write_until_ended(recorder);
    if (finished_) recorder.finish(status_, summary_);
  } catch (const std::exception& error) {
    const std::lock_guard lock(mutex_);
    failure_ = error.what();
    items_.clear();
  }
  changed_.notify_all();
}

void LiveRecorder::write_until_ended(io::Recorder& recorder) {
  for (bool last = false; !last;) {
    std::vector<Item> items;
    {
      std::unique_lock lock(mutex_);
      changed_.wait_for(lock, k_look, [this] { return ended_ || items_.size() == k_most_waiting; });
      items.swap(items_);
      last = ended_;
    }
    changed_.notify_all();
    for (const Item& item : items) std::visit([&](const auto& what) { recorder.write(what); }, item);
    recorder.flush_if_due();
  }
}

}  // namespace topple::app
