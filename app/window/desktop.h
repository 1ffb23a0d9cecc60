// What the desktop around the window offers: its file dialogs, and its program that shows folders.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "solver/io/host/process.h"

namespace topple::app {

/// What a file is chosen for.
struct FileQuestion {
  bool saves = false;  ///< the file may be new
  std::string title;
  std::string start;                 ///< the path that is proposed
  std::vector<std::string> endings;  ///< ".toml": of files that are listed; empty: all
};

/// A file dialog of the desktop (kdialog under KDE, else zenity, else the other), in a process of its own.
class DesktopDialog {
 public:
  /// Null where no such program starts.
  static std::unique_ptr<DesktopDialog> begin(const FileQuestion& question);

  /// True when the person has answered.
  bool update() { return process_->poll().has_value(); }
  /// Of a dialog that has been answered: the path; empty: none was chosen.
  std::string answer();

 private:
  host::MemoryFile output_{"file-dialog"};
  std::optional<host::Process> process_;
};

/// Shows a folder in the desktop's program for that. Throws std::runtime_error where none is there.
void show_folder(const std::string& folder);

}  // namespace topple::app
