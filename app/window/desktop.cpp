#include "app/window/desktop.h"

#include <fmt/format.h>

#include <cstdlib>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "app/panels/shell_words.h"

namespace topple::app {
namespace {

std::string patterns(const FileQuestion& question) {
  std::string text;
  for (const std::string& ending : question.endings) text += (text.empty() ? "*" : " *") + ending;
  return text;
}

std::vector<std::string> zenity_words(const FileQuestion& question) {
  std::vector<std::string> words{"--file-selection", "--title=" + question.title,
                                 "--filename=" + question.start};
  if (question.saves) words.emplace_back("--save");
  if (!question.endings.empty()) words.push_back("--file-filter=" + patterns(question));
  return words;
}

std::vector<std::string> kdialog_words(const FileQuestion& question) {
  std::vector<std::string> words{"--title", question.title,
                                 question.saves ? "--getsavefilename" : "--getopenfilename", question.start};
  if (!question.endings.empty()) words.push_back(patterns(question));
  return words;
}

}  // namespace

std::unique_ptr<DesktopDialog> DesktopDialog::begin(const FileQuestion& question) {
  const char* const desktop = std::getenv("XDG_CURRENT_DESKTOP");
  const bool kde = desktop && std::string_view(desktop).find("KDE") != std::string_view::npos;
  std::pair<const char*, std::vector<std::string>> programs[] = {{"zenity", zenity_words(question)},
                                                                 {"kdialog", kdialog_words(question)}};
  if (kde) std::swap(programs[0], programs[1]);
  for (const auto& [program, words] : programs) {
    auto dialog = std::make_unique<DesktopDialog>();
    try {
      dialog->process_.emplace(program, words, host::Streams{.output = dialog->output_.descriptor()});
      return dialog;
    } catch (const std::system_error&) {  // it is not installed
    }
  }
  return nullptr;
}

std::string DesktopDialog::answer() {
  return process_->wait().good() ? host::last_line(output_.content()) : std::string();
}

void show_folder(const std::string& folder) {
  // setsid returns at once, and what it starts outlives this program.
  const std::string command = "command -v xdg-open >/dev/null && exec setsid --fork xdg-open \"$0\"";
  if (!host::Process("/bin/sh", {"-c", command, folder}, {}).wait().good())
    throw std::runtime_error(say(window_words::k_no_folder_program, folder));
}

}  // namespace topple::app
