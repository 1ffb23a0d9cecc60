// What may be edited while it runs.
#pragma once

#include <memory>
#include <vector>

#include "solver/math/types.h"

namespace topple {

struct Accelerogram;
struct FloorResponse;

/// Contact laws (method and traits: contact_law.h). Checkpoints and recorded edits hold these numbers.
enum class ContactLawKind { coulomb = 0, paper = 1, printed = 2 };

/// Penalty contact (Eqs. 2 and 3), see contact_law.h.
struct ContactLaw {
  ContactLawKind kind = ContactLawKind::coulomb;
  double alpha = 50 * k_standard_gravity;  ///< N, penalty coefficient
  double q = 1;                            ///< penalty index
  double friction = 0.6;                   ///< mu, kinetic
  double friction_static = 0;  ///< coulomb law: static friction (friction_coefficient); not above mu: mu
  double restitution = 0;      ///< coulomb law: e, 0..1; 0 as Housner's block, which does not bounce
  double normal_speed = 0.01;  ///< m/s, eps_n of the coulomb law
  /// m/s. paper and printed law: smoothing eps of the direction v/sqrt(v^2 + eps^2). coulomb law: slip speed
  /// at which friction is half-way from static to kinetic.
  double slip_speed = 0.01;
  double member_share = 1;  ///< of alpha, between members of different bodies
  bool operator==(const ContactLaw&) const = default;
  /// Static less kinetic friction, not below 0.
  double excess() const { return friction_static > friction ? friction_static - friction : 0; }
};

/// Smooth change from old values to those of an edit during a run: a jump would put energy in.
struct ParameterRamp {
  double since = 0;  ///< s, its start
  double over = 0;   ///< s, its duration; 0: no ramp
  /// Share of the new values at time t, 0..1: (1 - cos(pi (t - since)/over))/2 within the ramp.
  double share(double t) const;
  bool operator==(const ParameterRamp&) const = default;
};

/// One acceleration of the floor (formulas: excitation.h); several add up.
struct Shake {
  /// Recorded edits hold these numbers.
  enum class Kind { sine = 0, sweep = 1, pulse = 2, record = 3 };
  enum class Shape { half_sine, full_sine, rectangle };
  enum class Start { rest, jump };
  Kind kind = Kind::sine;
  double amplitude = 0;            ///< m/s^2; not of a record
  double frequency = 1;            ///< Hz, sine; sweep: at its start
  double last_frequency = 1;       ///< Hz, sweep: at its end
  Vec3 direction = Vec3::UnitX();  ///< unit; record: of its strongest component
  double start = 0;                ///< s
  bool on = true;
  double cycles = 0;  ///< sine: number of periods; 0: until the end of the run
  double taper = 0;   ///< sine, sweep: cycles over which it smoothly rises and falls
  Start initial_velocity = Start::rest;
  Shape shape = Shape::half_sine;              ///< pulse
  double duration = 1;                         ///< s, pulse, sweep
  std::shared_ptr<const Accelerogram> record;  ///< record: not null
  double scale = 1;                            ///< record: factor
  /// The shake is the ground's, and the floor is one of this building; null: the floor is the ground. What
  /// says when and in which shape the ground moves stays as it was when this was made.
  std::shared_ptr<const FloorResponse> building;

  // Left by edits during a run (edit.h).
  double turned = 0;                     ///< s after `start`, of the latest change of `frequency`
  double turns = 0;                      ///< cycles passed by then
  Vec3 amplitude_before = Vec3::Zero();  ///< m/s^2, amplitude times direction before an edit
  double scale_before = 1;               ///< scale before it
  ParameterRamp ramp;                    ///< from them to `amplitude` times `direction` and to `scale`
  bool operator==(const Shake&) const = default;
};

/// A dead force on a node, as of a hand: it keeps its direction while the node moves.
struct Pull {
  int node;                    ///< of the model
  Vec3 force;                  ///< N
  Vec3 before = Vec3::Zero();  ///< N, at the start of the ramp
  ParameterRamp ramp;          ///< from `before` to `force`
  bool operator==(const Pull&) const = default;
};

/// N, at time t.
Vec3 pull_force(const Pull& pull, double t);

/// What a body is computed as (method: model_level.h). automatic: the cheapest level that answers what is
/// asked for. Recorded edits hold these numbers.
enum class BodyModel { automatic = 0, rigid = 1, elastic = 2, frame = 3, planar = 4 };

/// Time integration of frames (table: integrator.h). Recorded edits hold these numbers, and
/// k_automatic_integrator for "auto".
enum class Integrator { generalized_alpha = 1, central_difference = 2, newmark = 3 };
inline constexpr int k_automatic_integrator = 0;

/// Legal ranges, units and defaults of these stand in solver/io/scene/scene_keys.h, one table for scene
/// files, sliders and fuzzers.
struct Parameters {
  ContactLaw contact;
  ContactLaw contact_before;   ///< law before the latest edit
  ParameterRamp contact_ramp;  ///< from it to `contact`, see contact_law()
  std::vector<Shake> shakes;
  std::vector<BodyModel> models;  ///< one per body; empty: all frame
  std::vector<double> damping;    ///< one per body: ratio to critical at its first elastic mode; empty: 0
  std::vector<bool> anchors;      ///< one per anchor: it is in place; empty: all are
  std::vector<Pull> pulls;        ///< in the order of their nodes, one each
  bool want_stress = true;        ///< stresses are asked for; `automatic` depends on it
  double accuracy = 0.01;         ///< error that `automatic` allows, see model_level.h
  Vec3 gravity{0, 0, -k_standard_gravity};  ///< m/s^2
  Integrator integrator = Integrator::generalized_alpha;
  bool automatic_integrator = false;  ///< "auto": generalized_alpha as long as no other is chosen
  double spectral_radius = 0.8;       ///< of generalized-alpha at infinity, 0..1
  double beta = 0.25, gamma = 0.5;    ///< of newmark
  double time_step = 1e-3;            ///< s, fixed step
  bool adaptive = false;              ///< the step follows `tolerance` instead (step_control.h)
  double tolerance = 1e-3;            ///< of the adaptive step, relative to the speed (step_control.h)
  /// Explicit substeps of rigid and elastic bodies (reduced_body.h) and of frames, and the steps of adaptive
  /// central differences, are this many times shorter than stability asks for.
  double substep_refinement = 1;
  /// A step of fixed length at which a frame loses energy in a contact is taken again in parts
  /// (step.h). False: what a study of the steps themselves asks for.
  bool resolves_contacts = true;
  bool operator==(const Parameters&) const = default;
};

/// No NaN, no infinity, nothing above k_largest_number.
bool is_finite(const Parameters& parameters);

}  // namespace topple
