// A body on the level planar: a block that is exact between its events (solver/planar). It is asked before
// each step whether it is one until the end of the step; where not, it becomes a rigid body.
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "solver/frame/step_span.h"
#include "solver/model/model.h"
#include "solver/planar/floor_exchange.h"
#include "solver/planar/planar_case.h"
#include "solver/state/energy.h"
#include "solver/state/state.h"
#include "solver/state/step_result.h"

namespace topple {

/// Estimated error of a hard floor in place of contacts of this law, as a share of the critical angle: 0
/// where they are as stiff as those of scenes that name no alpha (contact_default.h), which stand for one;
/// else
///   30 d h/2b^2,  d = L (W/(n alpha))^(1/q), the greater of both edges
/// d: m, to which the body sinks on an edge alone; n: contact points on it. A side lifts when the body leans
/// by d/2b, which is d h/2b^2 of the critical angle, and that grows while it rocks: 10 to 50 times until it
/// lands or passes half of that angle (planar_body_test.cpp). Infinite where the centre of gravity is not
/// above the base.
double hard_floor_error(const Model& model, int body, const planar::PlanarCase& block, const ContactLaw& law);

/// Why a body that would be rigid is no planar block where a run begins: "a wall or body is within its fall";
/// empty: it is one. asked: as PlanarBody::begin.
std::string_view why_not_planar(const Model& model, const Parameters& parameters, const State& state,
                                int body, bool asked);

/// One body: its block, and where its next step leads. Parameters are looked at once, until they are
/// forgotten: who gives others calls forget_parameters() before.
class PlanarBody {
 public:
  PlanarBody(const Model& model, int body) : model_(model), body_(body) {}

  void forget_parameters() { known_ = false; }

  /// The block of a body that moves so, or none; `asked`: walls, other bodies and the law's alpha do not
  /// matter.
  std::optional<BlockState> begin(const Parameters& parameters, const State& state, bool asked);

  /// Advances `from` to the end of a step and keeps where it leads. The reason why the block is none, or does
  /// not get there.
  std::optional<LevelReason> plan(const Parameters& parameters, const StepInputs& start,
                                  const StepInputs& end, const BlockState& from);
  /// Makes `next` what plan() found; adds to `energy`.
  void take_planned(State& next, StepEnergy& energy) const;
  /// The motion at `time` within the newest step, from that of `from` at its start, and the energies of `at`
  /// there, which were between those of `from` and `end` in proportion.
  void place_within(const Parameters& parameters, const State& from, const State& end, double time,
                    State& at);

  /// Sets pose, velocity and what acts of State::bodies from State::blocks; returns the energies.
  BodyEnergy balance(const Parameters& parameters, const StepInputs& now, State& state);
  BodyEnergy energy(const State& state) const;
  /// As above.
  double hard_floor_error(const Parameters& parameters, const State& state);
  /// It rests on its base, its centre of gravity above that.
  bool stands(const Parameters& parameters, const State& state);
  /// s: to the next event, or the longest step.
  double time_limit(const Parameters& parameters, const State& state);
  /// Appends its contacts with the floor; their depth is 0.
  void list_contacts(const Parameters& parameters, const StepInputs& now, const State& state,
                     std::vector<ContactForce>& forces);
  /// It is a rigid body from here on: sinks into the springs of its contacts by what the floor bears there,
  /// so that no force jumps.
  void sink(const Parameters& parameters, const StepInputs& now, State& state);

 private:
  const planar::PlanarCase* block(const Parameters& parameters, const Vec3& along);
  bool near_wall(const planar::State& motion, double h, double push) const;
  planar::Situation situation(const StepInputs& now) const;
  bool spreads(const planar::State& motion) const;
  void divide(const ContactLaw& law, const planar::FloorForces& forces, const planar::State& motion);

  const Model& model_;
  const int body_;
  bool known_ = false;                                  // the parameters; for them hold:
  planar::PlanarCase case_;                             //   the block,
  planar::Obstacle obstacle_ = planar::Obstacle::none;  // what stands in its way,
  std::vector<planar::BaseLine> base_;                  //   contact points, from left to right,
  double error_ = 0;                                    //   hard_floor_error()
  // As divide() left them: shares of the normal force, per line of base_; where it spreads() over lines
  // between the edges, by how much the left and the right one are sunk, over what one point would be by all
  // of it, negative where it is up.
  std::vector<double> shares_;
  std::array<double, 2> sunk_;
  std::optional<std::array<double, 4>> limited_;  // motion that time_limit() was asked for last, under them,
  double limit_ = 0;                              // s, and its answer; asked twice a step
  planar::Step step_;
  BlockState planned_;
  planar::Exchanged exchanged_;
};

}  // namespace topple
