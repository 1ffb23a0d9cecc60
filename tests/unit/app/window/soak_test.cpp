// Hours of use in short: at full speed with edits, branches, exports and changes of scene, memory and file
// handles stay where they are. TOPPLE_SOAK: seconds that it takes.
#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <random>

#include "app/window/export_job.h"
#include "unit/app/shell_fixture.h"

namespace topple::app {
namespace {

using Clock = std::chrono::steady_clock;

struct Sample {
  double at;      ///< s
  double memory;  ///< MB
  std::size_t files;
};

double memory_in_use() {
  malloc_trim(0);
  long all = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> all >> resident;
  return static_cast<double>(resident * sysconf(_SC_PAGESIZE)) / 1e6;
}

std::size_t open_files() {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator("/proc/self/fd"), {}));
}

class SoakTest : public ShellTest {
 protected:
  SoakTest() {
    if (const char* const seconds = std::getenv("TOPPLE_SOAK")) seconds_ = std::atof(seconds);
    ImGui::GetIO().DisplaySize = {640, 360};
  }
  double now() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }

  void open_scene() {
    shell_->open("paper-a");
    ASSERT_TRUE(until([&] { return ready() && !shell_->opening(); }));
    while (player().speed() < k_most_speed) player().faster();
  }
  void play_for(double seconds) {
    player().play();
    for (const double end = now() + seconds; now() < end;) {
      frame();
      if (player().status().kind == LiveStatus::Kind::over) player().restart();
      if (player().can_edit() && !player().playing()) player().play();
    }
  }
  void change_amplitude() {
    if (!player().can_edit()) return;
    player().begin_edit();
    const double amplitude = std::uniform_real_distribution(3., 9.)(random_);
    player().edit({Edit::Key::amplitude, 0, Vec3(amplitude, 0, 0)});
    ++edits_;
  }
  void branch_off() {
    player().pause();
    frame();
    player().scrub(std::uniform_real_distribution(0., player().end())(random_));
    if (!player().can_continue()) return;
    player().continue_from_here();
    ASSERT_TRUE(until([&] { return player().can_edit(); }));
    ++branches_;
  }
  void export_picture() {
    const std::string recording = shell_->session()->recording(), picture = (scratch_ / "a.png").string();
    ExportJob job(TOPPLE_PROGRAM, {"render", recording, "--at", "0", "--still", picture, "--size", "320x180"},
                  picture);
    ASSERT_TRUE(until([&] { return job.update() && job.done(); }));
    EXPECT_EQ(job.failure(), "");
    ++exports_;
  }
  void use(double seconds, std::vector<Sample>& samples) {
    play_for(seconds / 2);
    change_amplitude();
    play_for(seconds / 2);
    branch_off();
    change_amplitude();
    samples.push_back({now(), memory_in_use(), open_files()});
  }

  double seconds_ = 8;
  const Clock::time_point begin_ = Clock::now();
  std::mt19937 random_{1};
  int edits_ = 0, branches_ = 0, exports_ = 0, scenes_ = 0;
};

/// Of the later samples over the middle ones: the first third fills what is kept in memory.
double growth(const std::vector<Sample>& samples) {
  const auto most = [&samples](std::size_t from, std::size_t to) {
    double found = 0;
    for (std::size_t i = from; i < to; ++i) found = std::max(found, samples[i].memory);
    return found;
  };
  const std::size_t n = samples.size();
  return most(2 * n / 3, n) - most(n / 3, 2 * n / 3);
}

TEST_F(SoakTest, memory_and_file_handles_stay_where_they_are) {
  std::vector<Sample> one_scene, many_scenes;
  open_scene();
  while (now() < seconds_ / 2) use(2, one_scene);
  while (now() < seconds_) {
    const std::string left = shell_->session()->recording();
    open_scene();
    ++scenes_;
    ASSERT_TRUE(until([&] { return io::Recording(left).status() == "stopped"; }));
    fs::remove(left);
    std::vector<Sample> samples;
    use(1, samples);
    export_picture();
    many_scenes.insert(many_scenes.end(), samples.begin(), samples.end());
  }
  for (const auto* samples : {&one_scene, &many_scenes}) {
    ASSERT_GE(samples->size(), 1u);
    const auto [fewest, most] = std::ranges::minmax(*samples, {}, &Sample::files);
    EXPECT_LE(most.files - fewest.files, 2u) << "an export at work has a terminal";
    std::printf("%zu samples: %.0f MB first, %.0f MB last, %.0f MB most, growth %.1f MB, %zu to %zu files\n",
                samples->size(), samples->front().memory, samples->back().memory,
                std::ranges::max(*samples, {}, &Sample::memory).memory, growth(*samples), fewest.files,
                most.files);
    // Shorter ones do not fill the rows that are kept. What the allocator keeps back varies by a few MB.
    if (seconds_ >= 300) {
      EXPECT_LE(growth(*samples), 0.05 * samples->back().memory);
    }
  }
  std::printf("%d edits, %d branches, %d pictures, %d scenes\n", edits_, branches_, exports_, scenes_);
}

}  // namespace
}  // namespace topple::app
