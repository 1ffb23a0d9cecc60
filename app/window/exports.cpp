#include "app/window/exports.h"

#include <imgui.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "app/panels/shell_words.h"
#include "app/support/files.h"
#include "app/window/desktop.h"

namespace topple::app {
namespace {

namespace fs = std::filesystem;
namespace ww = window_words;

constexpr std::chrono::milliseconds k_recorded{200};  // more than a recording lags behind its run

}  // namespace

void Exports::add(std::vector<std::string> words, std::string result, ExportJob::Makes makes) {
  std::erase_if(all_, [](const Export& one) { return one.ended; });
  all_.push_back({std::move(words), std::move(result), makes, std::chrono::steady_clock::now() + k_recorded});
}

bool Exports::busy() const {
  return std::ranges::any_of(all_, [](const Export& one) { return !one.ended; });
}

bool Exports::makes(const std::string& result) const {
  return std::ranges::any_of(all_,
                             [&](const Export& one) { return !one.ended && same_file(one.result, result); });
}

void Exports::begin(Export& one) {
  try {
    one.job = std::make_unique<ExportJob>(program_, one.words, one.result, one.makes);
  } catch (const std::runtime_error& error) {
    end(one, error.what());
  }
}

void Exports::end(Export& one, const std::string& failure) {
  one.ended = true;
  one.failure = failure;
  one.job.reset();
  news_ = failure.empty() ? say(ww::k_written, one.result) : say(ww::k_not_written, failure);
}

bool Exports::update() {
  bool news = false;
  for (auto one = all_.begin(); one != all_.end();) {
    const auto next = std::next(one);
    if (!one->ended && !one->job && std::chrono::steady_clock::now() >= one->due) begin(*one);
    if (one->job && one->job->update()) {
      news = true;
      if (one->job->done() && one->job->cancelled() && !one->job->failure().empty())
        all_.erase(one);
      else if (one->job->done())
        end(*one, std::string(one->job->failure()));
    }
    one = next;
  }
  return news;
}

std::string Exports::in_words() const {
  int count = 0;
  double part = 0;
  for (const Export& one : all_) {
    count += !one.ended;
    if (one.job) part += one.job->part();
  }
  return count > 0 ? say(ww::k_exports, count, 100 * part / count) : "";
}

void Exports::draw(const Box& scene, const render::OverlayFonts& fonts) {
  if (all_.empty()) return;
  const float unit = fonts.small->FontSize / 14;
  // A click ends what the status line said, which may give the scene another height: not under the mouse.
  if (!ImGui::IsMouseDown(0) && !ImGui::IsMouseReleased(0))
    corner_ = {scene.left + 14 * unit, scene.top + scene.height - 14 * unit};
  ImGui::SetNextWindowPos({corner_[0], corner_[1]}, ImGuiCond_Always, {0, 1});
  ImGui::SetNextWindowSize({std::min(360 * unit, scene.width - 28 * unit), 0});
  ImGui::Begin("exports", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoNav | ImGuiWindowFlags_AlwaysAutoResize);
  int number = 0;
  for (auto one = all_.begin(); one != all_.end(); ++number) {
    const auto next = std::next(one);
    if (number > 0) ImGui::Separator();
    if (draw_one(*one, "##" + std::to_string(number))) all_.erase(one);
    one = next;
  }
  ImGui::End();
}

/// `id` makes its buttons differ from those of others. True when it is to leave the list.
bool Exports::draw_one(Export& one, const std::string& id) {
  const std::string name = fs::path(one.result).filename().string();
  const std::string words = !one.ended            ? say(ww::k_exporting, name)
                            : one.failure.empty() ? say(ww::k_written, name)
                                                  : say(ww::k_not_written, one.failure);
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(words.c_str());
  ImGui::PopTextWrapPos();
  if (!one.ended) {
    const std::string progress = one.job ? one.job->progress() : "";  // tables are not counted
    ImGui::ProgressBar(one.job ? static_cast<float>(one.job->part()) : 0, {-1, 0},
                       progress.empty() ? "…" : progress.c_str());
    const bool cancelled = ImGui::SmallButton((say(ww::k_cancel) + id).c_str());
    if (cancelled && one.job) one.job->cancel();
    return cancelled && !one.job;
  }
  if (one.failure.empty()) {
    if (ImGui::SmallButton((say(ww::k_show_folder) + id).c_str())) {
      try {
        std::error_code ignored;
        show_folder(fs::absolute(one.result, ignored).parent_path().string());
      } catch (const std::runtime_error& error) {
        news_ = error.what();
      }
    }
    ImGui::SameLine();
  }
  return ImGui::SmallButton((say(ww::k_close) + id).c_str());
}

}  // namespace topple::app
