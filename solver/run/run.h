// A run: a model that is stepped, observed, and knows when it is over.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "solver/model/model.h"
#include "solver/model/parameters.h"
#include "solver/model/room.h"
#include "solver/run/edit.h"
#include "solver/run/overturn.h"
#include "solver/run/place_hits.h"
#include "solver/state/state.h"
#include "solver/step/statics.h"
#include "solver/step/step.h"

namespace topple {

/// Of an interval between recorded rows: time is a sum of rounded steps.
inline constexpr double k_row_slack = 1e-6;

enum class Analysis { dynamic, statics, modes };
enum class StopWhen { never, all_overturned, at_rest };

/// What a scene asks of a run besides its mechanics.
struct RunSettings {
  Analysis analysis = Analysis::dynamic;
  StaticSettings statics = {};
  double duration = 10;      ///< s; statics: 1, the whole path
  bool settle = true;        ///< start from rest under gravity and the loads at t = 0
  double output_rate = 100;  ///< Hz, of recorded rows
  StopWhen stop_when = StopWhen::never;
};

/// What the summary reports the motion of: a node, or with node -1 the body's centre of gravity and rotation.
struct Probe {
  std::string name;
  int body;
  int node;  ///< index into the model
};

/// What lifts corners of a body's base off the floor: contact points that reach lower.
struct Wedge {
  std::string name;
  int body;
  std::vector<int> nodes = {};  ///< none: it is not in place
  double lift = 0;              ///< m

  bool in_place() const { return !nodes.empty(); }
};

/// All that a run needs.
struct Setup {
  Model model;
  Parameters parameters;
  std::vector<BodyStart> starts;  ///< one per body
  RunSettings run;
  std::vector<Probe> probes;
  Room room = {};
  std::vector<Wedge> wedges = {};  ///< as they are told; the contact points have their heights
};

/// Motion of one probe so far. Displacements from the reference pose, m, floor's frame; rotation vector, rad.
struct ProbeOutcome {
  Vec3 displacement = Vec3::Zero();
  Vec3 rotation = Vec3::Zero();
  Vec3 peak = Vec3::Zero();       ///< of each component the value of greatest size
  Vec3 peak_time = Vec3::Zero();  ///< s
};

/// Where a run is and what became of it so far: a run made from it goes on bit for bit.
struct RunPoint {
  State state;
  Parameters parameters;
  Outcome outcome;
  std::vector<ProbeOutcome> probes;
  std::int64_t newton_iterations = 0, rejected_steps = 0;
  std::optional<double> rest_since = {};  ///< s
  bool stopped_early = false;
  std::vector<LoadStep> load_steps = {};  ///< statics
  std::vector<PlaceOutcome> places = {};  ///< one per place of the room
  double counted_from = 0;                ///< s, since when the outcome is known
};

/// A state of a run, and what acts there.
struct Snapshot {
  const State& state;  ///< with all nodes placed
  const std::vector<ContactForce>& contacts;
  const std::vector<MemberForce>& between_members;
  const std::vector<SectionForces>& sections;
};

/// A run in progress. The setup is shared and never changes; it must outlive the run.
class Run {
 public:
  /// Settles when asked to; `status()` tells what became of it.
  explicit Run(const Setup& setup) : Run(setup, setup.parameters) {}
  /// The same from the start with other parameters.
  Run(const Setup& setup, Parameters parameters);
  /// Continues from a checkpoint of the same setup; the outcome is counted from there. Over at once, with its
  /// status, when a number of it or of the parameters is not finite.
  Run(const Setup& setup, State state, Parameters parameters);
  Run(const Setup& setup, RunPoint point);

  /// As of Workspace.
  void share(ParallelFor parallel) { workspace_.share(std::move(parallel)); }
  Profile& profile() { return workspace_.profile(); }

  /// One accepted step, of time or of the loads. Must not be called when over().
  StepStatus advance();
  /// Changes parameters from the present state on; after it a step that failed may be tried again. Before the
  /// first step the run starts anew with them, bit for bit as with a setup that says so; where that does not
  /// settle, `status()` tells it and the state stays.
  void edit(std::span<const Edit> edits);
  void edit(const Edit& edit) { this->edit({&edit, 1}); }
  /// Time is up, a stop condition holds or the last step failed.
  bool over() const;
  bool stopped_early() const { return now_.stopped_early; }

  const Setup& setup() const { return *setup_; }
  const RunPoint& point() const;
  /// With all nodes placed.
  const State& state() const { return point().state; }
  double time() const { return now_.state.time; }  ///< s
  std::int64_t step() const { return now_.state.step; }
  const EnergyLedger& energy() const { return now_.state.energy; }
  const Parameters& parameters() const { return now_.parameters; }
  const StepStatus& status() const { return status_; }
  const Outcome& outcome() const { return now_.outcome; }
  const std::vector<ProbeOutcome>& probes() const { return now_.probes; }
  const std::vector<PlaceOutcome>& places() const { return now_.places; }
  const std::vector<Event>& events() const { return events_; }
  const std::vector<LoadStep>& load_steps() const { return now_.load_steps; }
  double counted_from() const { return now_.counted_from; }
  const std::vector<ContactForce>& contacts() const { return now_acting_.contacts; }
  const std::vector<MemberForce>& member_contacts() const { return now_acting_.between_members; }
  const std::vector<SectionForces>& sections() const { return snapshot().sections; }
  /// Of state().
  Snapshot snapshot() const;
  /// At `time` within the newest step that was taken (state_between), until the next call.
  Snapshot snapshot(double time) const;
  std::int64_t newton_iterations() const { return now_.newton_iterations; }
  std::int64_t rejected_steps() const { return now_.rejected_steps; }
  /// Longest with which its integrator is stable, once it has stepped, s; none where all are.
  std::optional<double> stable_step();

 private:
  void start();
  bool is_static() const { return setup_->run.analysis == Analysis::statics; }
  void advance_load();
  // What acts at a state, as snapshots show it.
  struct Acting {
    std::vector<ContactForce> contacts;
    std::vector<MemberForce> between_members;
    std::vector<SectionForces> sections;
    bool sections_found = true;  // until there are contacts
    bool stressed = true;        // some of them may not be zero
  };
  void find_acting(const std::vector<ContactForce>& contacts, Acting& acting) const;
  // Its sections and the snapshot, while the contacts of `state` are those found last.
  Snapshot view(const State& state, Acting& acting) const;
  // Sets within_ and what acts there; nodes of bodies that are no frames are not placed.
  void look_within(double time) const;
  void observe();
  void observe(const std::vector<ContactForce>& contact_forces);
  void observe_stresses();
  // At the recorded times within the newest step, which began at `start`, s.
  void observe_stresses_since(double start);
  void observe_peaks();

  const Setup* setup_;
  mutable RunPoint now_;  // nodes are placed when somebody looks
  mutable bool placed_ = true;
  mutable Workspace workspace_;
  std::optional<LoadPath> path_;  // static runs
  StepStatus status_;
  std::vector<Event> events_;
  mutable Acting now_acting_;
  mutable State within_;  // of snapshot(time)
  mutable Acting within_acting_;
};

}  // namespace topple
