// Rows of a sweep on disk while it goes on, so that one that was interrupted can be resumed.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "solver/io/scene/scene.h"

namespace topple::study {

/// A file of lines: the settings that rows depend on, then {"case": k, "row": ...} for each case that ended,
/// in the order in which they did. One process writes it; each line is written at once, and one that was cut
/// off is no line.
class KeptRows {
 public:
  /// Begins the file anew, or with `resume` goes on with what is there; without a file it begins one. Throws
  /// io::InputError when a file cannot be resumed: it has other settings (named), is damaged, or is being
  /// written; std::runtime_error when it cannot be written.
  KeptRows(std::string path, const nlohmann::ordered_json& settings, int cases, bool resume);
  ~KeptRows();
  KeptRows(const KeptRows&) = delete;
  KeptRows& operator=(const KeptRows&) = delete;

  const std::string& path() const { return path_; }
  /// One per case, JSON; empty: it has not ended.
  const std::vector<std::string>& rows() const { return rows_; }
  int count() const;
  /// Throws std::runtime_error when the disk is full.
  void add(int k, const std::string& row);

 private:
  void read(const nlohmann::ordered_json& settings);
  void append(const std::string& line);

  std::string path_;
  int file_ = -1;
  std::vector<std::string> rows_;
};

/// A hash of each file that a scene names, for the settings that rows depend on.
nlohmann::ordered_json fingerprints(const std::vector<io::SceneFile>& files);

}  // namespace topple::study
