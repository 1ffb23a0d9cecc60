// Equilibrium under loads that grow step by step.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "solver/frame/body_system.h"
#include "solver/state/step_result.h"
#include "solver/step/controlled_way.h"

namespace topple {

/// Path control: each load step goes equally far and the load factor is solved for, so that a path can be
/// followed beyond a limit point. Either one direction of a node moves in equal increments (Batoz and Dhatt
/// 1979), or the whole body along its path: an increment's part along the one before, as root mean square of
/// the nodes' displacements, is the same in each (normal planes, Riks 1979).
struct PathControl {
  int node = 0;              ///< index into the model
  int direction = 0;         ///< 0..2 translation, 3..5 rotation about world axes
  std::optional<double> to;  ///< m or rad, travel over all load steps; absent: each load step moves as far as
                             ///< its share of the loads would move the unloaded body
  bool arc_length = false;   ///< `node` tells the body alone
};

/// What a static run is asked for.
struct StaticSettings {
  int load_steps = 10;
  std::optional<PathControl> control = {};
  bool stop_at_instability = false;  ///< else what the path loses is told and it goes on
};

/// One load step of a static run.
struct LoadStep {
  double factor;  ///< of the loads: where it arrived, or where it found no equilibrium
  bool converged;
  Stability stability = {};
};

/// Walks a model through its load steps. Weight acts in full from the start, that of a member as a
/// distributed load: with its fixed-end forces and moments on the member's ends. Loads without a history grow
/// with the load factor, the others follow their history over it. Contacts as in settle() (step.h).
/// With arc length State::algorithmic_acceleration is the last increment of the nodes, m.
class LoadPath {
 public:
  LoadPath(const Model& model, const StaticSettings& settings);

  /// Balances the weight, without the loads that grow: load factor 0. `settled`: after settle().
  /// uncontrolled: the loads do not move the controlled direction.
  StepStatus start(const Parameters& parameters, bool settled, State& state);
  /// The next load step. It is halved where Newton finds no equilibrium or, with stop_at_instability, one
  /// that is not stable. no_equilibrium: not even 1/1024 of the step has one; `state` is then the last
  /// equilibrium found, and State::step counts it when it is new. State::time becomes the load factor, with
  /// displacement control the share of the load steps.
  StepStatus advance(const Parameters& parameters, State& state);
  /// Adds to section forces what the weight does between nodes, of bodies that do not yield: there it stands
  /// at the ends of each pair of elements alone.
  void add_weight(const Parameters& parameters, const State& state,
                  std::vector<SectionForces>& sections) const;
  /// Of the last equilibrium found, the least stable body's.
  const Stability& stability() const { return stability_; }

 private:
  /// Six numbers per node.
  struct NewtonStep {
    explicit NewtonStep(std::vector<double> growing) : growth(std::move(growing)), x(growth.size()) {}
    std::vector<double> growth;                              ///< derivative of the loads by the load factor
    std::vector<double> x, forces;                           ///< correction; unbalanced forces at the trial
    double change = 0;                                       ///< of the load factor
    double damping = 0;                                      ///< share of add_levenberg
    double reach = std::numeric_limits<double>::infinity();  ///< m, no correction goes further
  };
  struct Target {
    double factor;                      ///< load control
    std::optional<double> travel = {};  ///< path control
  };
  StepStatus balance(const Parameters& parameters, State& state, Target target);
  StepStatus balance_body(BodySystem& system, const Parameters& parameters, const State& state,
                          std::optional<double> travel, double& factor);
  double search_line(BodySystem& system, const Parameters& parameters, const State& state, double factor,
                     const NewtonStep& step);
  int find_correction(BodySystem& system, const Parameters& parameters, const State& state, double factor,
                      ControlledWay* way, NewtonStep& step);
  void evaluate(BodySystem& system, const Parameters& parameters, const State& state, double factor);
  std::vector<double> growing_loads(const BodySystem& system) const;
  std::vector<double> controlled_way(const BodySystem& system, const State& state) const;
  Stability what_is_lost(const Parameters& parameters, const State& state, int body);
  std::optional<double> first_travel(const Parameters& parameters, State& state);
  void accept(const Parameters& parameters, double factor, State& state);
  int controlled_body() const;

  const Model* model_;
  StaticSettings settings_;
  std::vector<std::unique_ptr<BodySystem>> systems_;
  std::vector<BodyMotion> start_, trial_;  ///< per body
  std::vector<SectionForces> sections_;
  Stability stability_;
};

}  // namespace topple
