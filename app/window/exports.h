// Exports that are at work beside the window, and what became of those that have ended.
#pragma once

#include <array>
#include <chrono>
#include <list>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/panels/panels.h"
#include "app/window/export_job.h"
#include "render/scene/font.h"

namespace topple::app {

class Exports {
 public:
  /// `program`: the one that draws; tests are not.
  explicit Exports(std::string program) : program_(std::move(program)) {}

  /// Begins `topple WORDS`, which makes `result`, as soon as all that is shown has been recorded.
  void add(std::vector<std::string> words, std::string result, ExportJob::Makes makes);
  /// Takes in how far they are. True when anything changed.
  bool update();
  bool busy() const;
  bool makes(const std::string& result) const;  ///< one at work writes there
  bool empty() const { return all_.empty(); }
  /// "2 exports: 40 %", of those at work; empty: none is.
  std::string in_words() const;
  /// What became of one since the last call; empty: nothing.
  std::string take_news() { return std::exchange(news_, {}); }
  /// The list of them, over the lower left corner of `scene`.
  void draw(const Box& scene, const render::OverlayFonts& fonts);

  struct Export {
    std::vector<std::string> words;
    std::string result;
    ExportJob::Makes makes;
    std::chrono::steady_clock::time_point due;
    std::unique_ptr<ExportJob> job = nullptr;  ///< null: before it begins, and when it has ended
    bool ended = false;
    std::string failure = {};  ///< of one that has ended; empty: it is written
  };
  const std::list<Export>& all() const { return all_; }

 private:
  void begin(Export& one);
  void end(Export& one, const std::string& failure);
  bool draw_one(Export& one, const std::string& id);

  const std::string program_;
  std::list<Export> all_;
  std::string news_;
  std::array<float, 2> corner_{};  ///< of the list, lower left
};

}  // namespace topple::app
