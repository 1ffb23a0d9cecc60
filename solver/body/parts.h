// All parts of a model, as its bodies are computed now.
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "solver/body/island_part.h"
#include "solver/body/islands.h"
#include "solver/body/part.h"
#include "solver/body/planar_body.h"

namespace topple {

/// Greatest stable step of central differences, s, and what sets it.
struct ExplicitLimit {
  double step;
  int body, node, element;
};

/// The bodies of a model, divided into parts for one step.
class Parts {
 public:
  explicit Parts(const Model& model);

  /// Divides by the levels of bodies and the candidate pairs of `state`; where one of an island is a frame,
  /// none is elastic. Planar, rigid and elastic bodies that are alone, of which some make one part, come
  /// first, then those that are not, then frames with the rigid bodies near them.
  void arrange(const State& state);
  const std::vector<std::shared_ptr<Part>>& all() const { return parts_; }
  /// f() while each part has its own stick springs between members. Around what changes them.
  template <class F>
  void with_sticks(State& state, F f) {
    take_sticks(model_, sticks_of_, state);
    f();
    give_sticks(model_, sticks_of_, state);
  }
  /// Per body: its steps are those of frames.
  const std::vector<char>& with_frames() const { return with_frames_; }
  /// Whether a step moves nodes: there are frames.
  bool moves_nodes() const { return moves_nodes_; }
  /// Of the candidate pairs of `state`; those that the parts are arranged for.
  const std::vector<Island>& islands(const State& state);
  const std::vector<Island>& islands() const { return divided_; }

  /// Part::balance of those that are marked; of all.
  BodyEnergy balance(const Parameters& parameters, const StepInputs& now, const std::vector<char>& marked,
                     State& state);
  BodyEnergy balance(const Parameters& parameters, const StepInputs& now, State& state);
  /// Part::find_forces of all, with those between members where one of its bodies is marked.
  void find_forces(const StepInputs& now, const State& state, const std::vector<char>& marked);
  /// Energies of all bodies at `state`, for which they are arranged.
  BodyEnergy energy(const StepInputs& now, const State& state);
  /// Longest step that the motion at `state` allows, s, at least 2 k_least_step: look_ahead()
  /// (step_control.h), and of each part T_contact/20 of a body that touches, max(time to touch, L/(4 v))
  /// where a contact closes, 0.1 rad/|omega| (step_limits.h).
  double time_limit(const Parameters& parameters, const State& state);
  /// Part::explicit_reach of all frames; 0 without.
  double explicit_reach(const Parameters& parameters);
  /// Least over the frames of `state`, each alone with all contacts closed, with the stiffer of the two laws
  /// between which an edit changes; none without frames.
  /// `damped`: by as much of their damping.
  std::optional<ExplicitLimit> explicit_limit(const Parameters& parameters, const State& state,
                                              double damped = 1);

  /// One body as a rigid or elastic one, with the anchors of `state`; as a frame.
  ReducedBody& reduced(const State& state, int body);
  BodySystem& alone(int body) { return *islands_.alone(body); }
  PlanarBody& planar(int body);
  /// Before other parameters are given.
  void forget_parameters();

  /// Per element of the model, as the newest step or balance left them; of elastic bodies as find_sections()
  /// did; zero of bodies without stresses.
  std::vector<SectionForces> sections;
  /// Those of an elastic body at `state`, under the forces that were found last.
  void find_sections(const State& state, int body);
  /// Sets those of a body to zero: it has no stresses from here on.
  void clear_sections(int body);

 private:
  std::vector<Island> without_mixed(const Island& island) const;

  const Model& model_;
  Islands islands_;
  std::vector<std::unique_ptr<ReducedBody>> reduced_;  // per body, once it was one
  std::vector<std::unique_ptr<PlanarBody>> planar_;    // likewise
  std::vector<Island> divided_;                        // by pairs_ and tied_
  CandidatePairs pairs_;                               // of the last call of islands()
  std::vector<TiedBodies> tied_;                       // likewise
  std::vector<ModelLevel> levels_;                     // per body, of parts_; empty: there are none
  std::vector<char> with_frames_;                      // per body
  std::vector<std::shared_ptr<Part>> parts_;
  // Those of parts_ with several bodies that are no frames, and the levels of these.
  struct Coupled {
    Island island;
    std::vector<ModelLevel> levels;
    std::shared_ptr<IslandPart> part;
  };
  std::vector<Coupled> coupled_;
  std::vector<MemberSticks*> sticks_of_;  // per body: of its part; null: it has no pairs
  bool moves_nodes_ = false;
  const std::vector<char> all_bodies_;
};

/// The floor's velocity jumps by `floor`, m/s: bodies keep their own, so that they move the other way in the
/// floor's frame. Returns the kinetic energy that they gain there, J.
double jump_floor(const Model& model, const Vec3& floor, State& state);

}  // namespace topple
