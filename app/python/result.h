// What a run came to: of this process, or from a recording.
#pragma once

#include <pybind11/pybind11.h>

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "app/picture/run_extent.h"
#include "app/python/rows.h"
#include "solver/io/scene/scene.h"
#include "solver/run/history.h"

namespace topple::python {

using ScenePtr = std::shared_ptr<const io::Scene>;

/// A state of which the hash is known.
struct KnownState {
  std::int64_t step;
  double time;  ///< s
  std::uint64_t hash;
};

/// Rows of one way from the root to a branch. It does not change.
struct Result {
  ScenePtr scene;
  History history;
  std::shared_ptr<const Rows> rows;
  std::vector<KnownState> states;
  std::string summary;  ///< JSON; empty: there is none

  /// Of all rows; computed once.
  const app::RunExtent& extent() const;
  /// Between two rows, or the first or last one.
  io::FrameRow at(double time) const;
  /// With which a row came about: those before what was changed at its own instant.
  Parameters parameters(const io::FrameRow& row) const;

 private:
  mutable std::once_flag looked_;
  mutable app::RunExtent extent_;
};

/// To its end. record: empty: no. Throws what record() (recorded_run.h) does, and Python's errors. With the
/// GIL.
std::shared_ptr<Result> run(const ScenePtr& scene, const std::filesystem::path& record);
/// Throws io::InputError. With the GIL.
std::shared_ptr<Result> open(const std::filesystem::path& recording);

void add_result(pybind11::module_& module);

}  // namespace topple::python
