// A run that Python steps.
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "app/python/rows.h"
#include "app/python/scene.h"
#include "solver/run/run.h"
#include "solver/study/common/team.h"

namespace topple::python {

/// A run does not go on: a step failed, or it is over. what() is one line.
struct RunError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// One thread at a time; another one gets std::runtime_error meanwhile. Stepping is without the GIL, all else
/// with it.
class Simulation {
 public:
  /// Settles. Throws RunError, app::BadInput for a scene that takes no steps.
  explicit Simulation(ScenePtr scene) : Simulation(std::move(scene), std::nullopt) {}

  /// Throws RunError.
  void step();
  /// To the first step that is not before `time`, s, or the end. Throws RunError, Python's errors.
  void run_until(double time);
  /// Throws io::InputError.
  void edit(const std::string& key, const std::string& value);
  std::shared_ptr<Simulation> fork();

  const Model& model() const { return scene_->setup.model; }
  double time();
  std::int64_t steps();
  bool over();
  std::uint64_t state_hash();
  /// Of the present state; written anew in its place whenever Python gets the word after a step.
  std::shared_ptr<const Rows> now();
  std::string render(std::pair<int, int> size);

 private:
  Simulation(ScenePtr scene, std::optional<RunPoint> point);
  class Turn;
  /// Throws RunError when the newest step failed.
  void expect_success() const;
  void show();

  const ScenePtr scene_;
  std::optional<study::Team> team_;
  std::optional<Run> run_;
  std::shared_ptr<Rows> now_;  ///< null: nobody has looked
  std::atomic_flag busy_;
};

void add_simulation(pybind11::module_& module);

}  // namespace topple::python
