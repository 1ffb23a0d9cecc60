// Rigid bodies that touch each other, or may within a step, advanced by impulses (contact_impulses.h): they
// move freely for half a step, contacts there say with what velocities they go on, and they move freely for
// the other half,
//   x = x0 + h/2 u0 + h/2 u1,  R with its angular momentum kept (Lie midpoint),
// and a look at the end tells what acts there. It is of second order while no contact opens, closes or slips.
// Its length is 7.5 tolerance sqrt(reach/g), up to six times that where bodies are slow against what they
// touch; blows are resolved.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "solver/frame/step_span.h"
#include "solver/math/block_lu.h"
#include "solver/reduced/contact_impulses.h"
#include "solver/reduced/member_coupling.h"
#include "solver/reduced/reduced_body.h"
#include "solver/state/member_sticks.h"

namespace topple {

/// Whether rigid bodies that meet are moved so where nothing holds them: steps follow a tolerance of 1e-3 or
/// more, below which substeps (coupled_bodies.h) are cheaper, and contacts stick by springs.
bool takes_impulses(const Parameters& parameters);

/// All bodies of a MemberCoupling, on the level rigid.
class RigidIsland {
 public:
  /// They outlive this.
  RigidIsland(const std::vector<ModelBody>& bodies, MemberCoupling& coupling);

  /// Whether a step from one law to the other may be taken so: takes_impulses, and no edit of contacts,
  /// anchor or pull acts in it.
  bool takes(const Parameters& parameters, const ContactLaw& before, const ContactLaw& after,
             const State& state) const;
  /// Longest step from `state`, s.
  double time_limit(const Parameters& parameters, const State& state) const;
  /// Takes the step; the contacts of the bodies with planes have been found. newton_diverged, passed_through:
  /// it is too long, and `next` is undefined.
  StepStatus::Kind advance(const StepSpan& span, State& next, MemberSticks& sticks, StepEnergy& booked);

  /// What touches between members after the newest step, and whether that is at `state`.
  const MemberContacts& contacts() const { return now_; }
  bool knows(const ContactLaw& law, const State& state) const;
  /// The coupling was used otherwise.
  void forget() { law_.reset(); }

 private:
  // BodyPair bodies whose members may touch; `second` -1: floors and walls of members.
  struct BodyPair {
    int first, second;
    std::vector<int> pairs;
    double least_L = std::numeric_limits<double>::infinity();  // m, of the pairs
    // Bounds of the way by which they have come nearer, m: so far, and in the newest step.
    double closed = 0, way = 0;
    double least = 0;                      // of `closed`, m: before it no pair touches
    double ahead = 0, ahead_before = 0;    // m, by which they may come nearer; in the look before
    std::vector<const MemberTouch*> near;  // what touches, or may
  };
  // Bodies that touch each other, and what is kept for them from step to step.
  struct TouchingBodies {
    std::vector<int> bodies;
    BlockLu matrix;
    ContactImpulses impulses;
    std::vector<std::pair<const MemberTouch*, int>> contacts;  // and their numbers in `impulses`
  };
  // For what a body's contacts are known.
  struct Known {
    Vec3 position, velocity, angular_velocity;
    Quat rotation;
    double substep;
    bool operator==(const Known&) const = default;
  };

  static Known known_of(const BodyState& s) {
    return {s.position, s.velocity, s.angular_velocity, s.rotation, s.substep};
  }
  double relative_speed(const BodyPair& both, const State& state) const;
  double coming(const BodyPair& both, const State& state, double h) const;
  double came(const BodyPair& both, const std::vector<Known>& there) const;
  void start(const State& state, const MemberSticks& sticks);
  void go_to(const State& state);
  void look(const ContactLaw& law, const State& state, double h);
  void find_bounds();
  void take_gaps(std::span<const int> which);
  TouchingBodies& together(const std::vector<int>& bodies);
  void drop_sets();
  bool solve(const StepSpan& span, const State& state);
  void add_bodies(const StepSpan& span, const State& state, TouchingBodies& set);
  Vec3 turning_of(const MemberTouch& touch) const;
  void add_contacts(const PreparedLaw& law, const BodyPair& both, TouchingBodies& set);
  void move(double h, State& state, StepEnergy& booked);
  bool missed() const;
  bool passed() const;
  void take_sticks();
  struct Held {
    double all, sticks;  // J, by contacts; of that by stick springs between members
  };
  Held held(const ContactLaw& law) const;
  void book(const StepSpan& span, const State& next, StepEnergy& booked);
  void finish(const StepSpan& span, State& next, MemberSticks& sticks);
  std::vector<double> speeds(const State& state) const;
  double next_step(const Parameters& parameters, double h, const State& state) const;

  const std::vector<ModelBody>& bodies_;
  MemberCoupling& coupling_;
  std::vector<BodyPair> body_pairs_;
  std::vector<int> body_pair_of_;   // per pair
  std::vector<double> open_until_;  // m, per pair: it is open while BodyPair::closed is less
  std::vector<double> seen_;        // m, per pair: BodyPair::closed when that was found
  std::vector<std::unique_ptr<TouchingBodies>> sets_;
  std::vector<std::vector<BodyContacts::TouchBuffer>> buffers_;  // per body
  // What is known, where and with what.
  std::vector<Known> here_;  // per body
  std::optional<ContactLaw> law_;
  Held held_;  // with the law, by now_ and the contacts with planes
  MemberContacts now_;
  PairPlaces places_;
  std::vector<int> which_;  // pairs looked at, in order; as bits
  std::vector<std::uint64_t> chosen_;
  // Of a step.
  MemberContacts last_;              // where bodies were looked at before
  std::vector<int> at_start_;        // per place of each pair: of last_.touches; -1: none
  std::vector<Vec3> start_, from_;   // m, per node of the coupling: of stick springs; before the newest move
  std::vector<BodyState> start_of_;  // per body
  std::vector<TouchingBodies*> used_;
  std::vector<ContactImpulses::Velocity> velocity_;  // per body
  std::vector<BodyVelocity> blends_;                 // per body, what MemberContacts::blends do: held
  ContactImpulses::Work work_;
  bool bounces_ = false;    // something struck
  std::vector<int> place_;  // per body, within its set
  std::vector<int> stale_;  // pairs whose gaps are to be found anew
  // per pair: at which places now_ lists it, as bits; last_
  std::vector<std::uint8_t> found_, found_before_;
};

}  // namespace topple
