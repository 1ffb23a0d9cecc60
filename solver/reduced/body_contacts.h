// Contacts of a rigid or elastic body with planes, four points to a pack. Vectors are in the floor's axes
// where nothing else is said.
//
// What the modes leave out of an elastic body's deflection is taken to be local: a spring of its own at each
// point, in series with the contact:
//   alpha' = alpha/(1 + alpha slope give/L),  k_stick' = k_stick/(1 + give_across k_stick)
// give, m/N: ElasticBasis::residual_shape of the point along the normal, give_across its mean across. slope:
// dP/d(depth) over alpha, 1 for q = 1, else where a contact bears a quarter of the weight.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "solver/contact/contact_law.h"
#include "solver/math/lanes.h"
#include "solver/math/upwards.h"
#include "solver/model/model.h"
#include "solver/reduced/body_unknowns.h"
#include "solver/state/energy.h"
#include "solver/state/step_result.h"

namespace topple {

/// What contacts do to a body: N, N m about the centre of gravity, W lost in normal damping and W that
/// friction and stick springs take.
struct ContactLoads {
  PackVec3 force, moment;
  double damping_power, friction_power;
};
struct ContactPower {
  double damping, friction;  ///< W
};
/// Which of them are summed; the others are undefined. loads: force and moment.
enum class ContactSums { none, loads, all };

/// Derivatives of the force and the moment of contacts by linear and angular velocity: N s/m, N s, N s and
/// N m s.
struct ContactSlope {
  PackMat3 force_linear, force_angular, moment_linear, moment_angular;
};

/// A place of a body that touches a plane or another body, or may within a step. Floor's axes.
struct NearContact {
  Vec3 normal;                            ///< unit, towards the body, the first of two
  std::array<Vec3, 2> arm;                ///< m, from the centres of gravity of the bodies
  Vec3 stick;                             ///< m, ContactInput::stick
  double depth, L;                        ///< 1 - l/L, negative while open; m
  double alpha;                           ///< N
  double stick_stiffness, stick_damping;  ///< N/m, N s/m
  /// m/s, floor's axes: what a velocity along and across the normal gains until the step ends, as the bodies
  /// turn and slide.
  Vec3 turning = Vec3::Zero();
};

/// The contact points of one body against all planes.
class BodyContacts {
 public:
  using Points = PackVector<Four>;
  /// Four points of which some touch a plane.
  struct Touch {
    int plane, group, side;  // indices into Model::planes, groups_, sides_
    bool level;              // the plane's normal is (0, 0, 1)
    Four::Mask touching;
    Four depth;                 // 1 - l/L
    Points arm;                 // m, from the centre of gravity
    Points stick;               // m, travel since sticking began
    Points travel;              // m, in the substep that led here
    Four conservative, normal;  // N: Eq. 2, and with the loss of the law
    Four limit;                 // N, of the tangential force (coulomb law)
    Points tangential;          // N
    Four give, give_across;     // m/N, local flexibility along the normal and across it (top of this file)
    Four alpha;                 // N, in series with it
    Four stick_stiffness;       // N/m, likewise
    Four stick_energy;          // J
    // N s/m, derivative of the force by the point's velocity (evaluate_forces): tangent_nn n n^T -
    // tangent_identity I, and `tangent_rest` where something slips or the law is not in packs.
    Four tangent_nn, tangent_identity;
    bool has_tangent_rest;
    PackMatrix<Four> tangent_rest;
    Four drag;  // N s/m, -d(force)/d(velocity) along the plane of what sticks, 0 of what slips
  };

  /// Memory for what touched at the start of a substep, by the number of pairs.
  struct TouchBuffer {
    std::size_t pairs;
    std::unique_ptr<Touch[]> touches;
  };
  /// Lends memory to the substeps of one body after the other. Each finds its contacts in the memory that the
  /// one before has let go, which is in the cache, and leaves its own.
  class ScratchLease {
   public:
    ScratchLease(BodyContacts& contacts, std::vector<TouchBuffer>& buffers)
        : own_(contacts.start_.all), lent_(buffer_for(contacts.pairs(), buffers)) {
      own_.swap(lent_);
    }
    ~ScratchLease() { own_.swap(lent_); }
    ScratchLease(const ScratchLease&) = delete;
    ScratchLease& operator=(const ScratchLease&) = delete;

   private:
    static std::unique_ptr<Touch[]>& buffer_for(std::size_t pairs, std::vector<TouchBuffer>& buffers) {
      for (TouchBuffer& buffer : buffers)
        if (buffer.pairs == pairs) return buffer.touches;
      buffers.push_back({pairs, std::unique_ptr<Touch[]>(new Touch[pairs / 4])});
      return buffers.back().touches;
    }

    std::unique_ptr<Touch[]>&own_, &lent_;
  };

  BodyContacts(const Model& model, int body);

  /// What touches becomes what touched at the start of a substep, for which there is a ScratchLease.
  void begin_substep() { std::swap(now_, start_); }
  /// Undoes begin_substep.
  void give_up_substep() { std::swap(now_, start_); }
  /// What touches at the pose of `s`, with rotation matrix `r` and stick springs of State::stick.
  void find(const BodyState& s, const PackMat3& r, std::span<const Vec3> stick);
  /// Calls f(NearContact) for points that touch a plane at the pose of `s`, with rotation matrix r, or are
  /// open by no more than `ahead`, m; `stick`: springs at the pose `before`, with r0. Of a rigid body.
  template <class F>
  void each_near(const PreparedLaw& law, const BodyState& before, const PackMat3& r0, const BodyState& s,
                 const PackMat3& r, std::span<const Vec3> stick, double ahead, F f) const {
    for (std::size_t k = 0; k < widest_.size(); ++k) {
      const Plane& plane = model_.planes[k];
      const double height = plane.normal.dot(s.position - plane.point);
      const Vec3 n = unpacked(transposed_times(r, packed(plane.normal)));
      if (clearance(n, height) > widest_[k] + ahead) continue;
      for (std::size_t g = 0; g < groups_.size(); ++g) {
        const Side& side = sides_[k * groups_.size() + g];
        const Four gap = dot(in_all_lanes(n), groups_[g].place) + (Four(height) - side.gap);
        for_lanes(gap < Four(ahead), [&](int i) {
          const PackVec3 place = packed(lane(groups_[g].place, i));
          const Vec3 travel = s.position - before.position + unpacked((r - r0) * place);
          f(NearContact{plane.normal,
                        {unpacked(r * place), Vec3::Zero()},
                        stick[side.spring[i]] + travel,
                        -gap[i] / side.L[i],
                        side.L[i],
                        law.alpha,
                        law.alpha * side.stick[i],
                        law.root_alpha * side.damping[i]});
        });
      }
    }
  }
  /// The springs follow the motion from `before`, with rotation matrix `r0`, to what find was given.
  void follow(const BodyState& before, const PackMat3& r0, const BodyState& s, const PackMat3& r);
  /// Forces of what touches at velocity u. with_slope: also d(force)/d(velocity) + gamma_dt
  /// d(force)/d(place), for slope() and add_slope_of_modes(). gamma_dt, s: an implicit stage moves a point by
  /// gamma_dt times its velocity; 0: the place is given.
  template <bool with_slope, ContactSums sums = ContactSums::all>
  ContactLoads evaluate_forces(const PreparedLaw& law, const BodyVelocity& u, double gamma_dt);
  /// Of the forces found last, with points that move at u.
  ContactPower power(const BodyVelocity& u) const;
  /// On the modes, N/sqrt(kg), of the forces found last.
  void modal_loads(int modes, Amplitudes& load) const;
  /// Of the forces found last with slopes; of their stick springs alone.
  ContactSlope slope() const;
  ContactSlope stick_slope() const;
  /// Adds `factor`, s, times the derivatives by rates of modes and of modal loads: to the rows and columns of
  /// the modes, which follow the body's six.
  void add_slope_of_modes(double factor, int modes, ModeMatrix& matrix) const;
  void add_stick_slope_of_modes(double factor, int modes, ModeMatrix& matrix) const;  ///< as stick_slope
  /// Writes the stick springs after slipping; those of points that touched at the start of the substep and no
  /// longer do become zero.
  void keep_sticks(const PreparedLaw& law, std::span<Vec3> stick);

  /// J, in penalty and stick springs.
  double energy(const ContactLaw& law) const;
  /// J, of stick springs, over the substep.
  double stick_energy_gained() const;
  /// Work of damping and friction over a substep, by the trapezoidal rule along the travel of the points.
  void book_travel(const Vec3& shift, const BodyState& s, const PackMat3& r, StepEnergy& booked) const;
  /// What a law that changed over a substep put into springs: input (LawChange).
  void book_law_change(const ContactLaw& before, const ContactLaw& after, StepEnergy& booked) const;

  /// Time until the next open point of the undeformed body reaches a plane, s, with these accelerations
  /// (m/s^2; rad/s^2, material axes); infinite: not within `within`, s.
  double next_landing(const BodyState& s, const Vec3& acceleration, const Vec3& angular_acceleration,
                      double within) const;
  /// Time until the next point that slips comes to rest on its plane, s, likewise; of slow ones, which stop
  /// within micrometres, none.
  double next_stop(const BodyState& s, const Vec3& acceleration, const Vec3& angular_acceleration,
                   double within) const;
  /// Longest step, s: least of contact_ahead and bounce_limit (step_limits.h; k_quiet_steps of them where the
  /// body is `quiet`) and k_longest_step.
  double look_ahead(const ContactLaw& law, bool quiet, const BodyState& s) const;

  bool any() const { return now_.count > 0; }
  /// The same for the same points on the same planes.
  std::uint64_t hash() const { return now_.hash; }
  /// Calls f(touch, lane, point, index into State::stick).
  template <class F>
  void each(F f) const {
    each_of(now_, f);
  }
  double length(const Touch& touch, int lane) const { return side(touch).L[lane]; }
  /// N, of one that touches.
  Vec3 force(const Touch& touch, int lane) const { return topple::lane(force(touch), lane); }
  /// N s/m, its derivative by the point's velocity.
  Mat3 slope(const Touch& touch, int lane) const;
  /// 1 - l/L of the contact alone, without the local spring behind it.
  double own_depth(const Touch& touch, int lane) const {
    return touch.depth[lane] -
           (gives_ ? touch.give[lane] * touch.conservative[lane] / length(touch, lane) : 0);
  }
  /// Of one that touches, reference axes: m, from the centre of gravity; 1/sqrt(kg), displacement in mode k.
  Vec3 place(const Touch& touch, int lane) const { return topple::lane(groups_[touch.group].place, lane); }
  Vec3 shape(const Touch& touch, int lane, int k) const {
    return topple::lane(groups_[touch.group].shape[k], lane);
  }
  /// 1/(kg m): over alpha, no squared frequency of the body on springs alpha/L at all contacts is greater.
  double stiffest() const { return stiffest_; }
  /// Pairs of a point and a plane, groups filled up to four points.
  std::size_t pairs() const { return sides_.size() * 4; }
  double least_length() const { return least_length_; }  ///< m, least L
  /// N/m, of the stiffest contact with a plane, where it bears a quarter of the weight; 0 without planes.
  double stiffness(const ContactLaw& law) const { return law.alpha * slope_at_rest(law) / least_length_; }
  /// kg, the share of the body that a contact carries.
  double share_of_mass() const { return contact_mass_; }
  double grip() const { return grip_; }  ///< Body::grip

 private:
  // Those that fill up the last group never touch.
  struct Group {
    Points place;               // m, from the centre of gravity, reference axes
    std::array<int, 4> point;   // index into the model
    int size = 0;               // of those that there are
    std::vector<Points> shape;  // per mode
    PackMatrix<Four> give;      // m/N, as of a touch
  };
  // Of a group and a plane.
  struct Side {
    Four gap;                   // m, of the centre line on the face
    Four L;                     // m
    Four stick;                 // 1/m, stiffness of the stick spring over alpha
    Four damping;               // its damping over sqrt(alpha)
    std::array<int, 4> spring;  // index into State::stick; where there is no point: that of the first
  };
  static constexpr std::uint64_t k_nothing = 14695981039346656037ull;  // FNV-1a
  // In the order of planes, then groups; with room for all.
  struct Touches {
    std::unique_ptr<Touch[]> all;
    std::size_t count = 0;
    std::uint64_t hash = k_nothing;
    void clear() {
      count = 0;
      hash = k_nothing;
    }
    Touch& add(int plane, int group, int side, Four::Mask touching) {
      Touch& touch = all[count++];
      touch.plane = plane;
      touch.group = group;
      touch.side = side;
      touch.touching = touching;
      hash = (hash ^ (static_cast<std::uint64_t>(plane) << 32 | static_cast<std::uint64_t>(group) << 8 |
                      bits(touching))) *
             1099511628211ull;
      return touch;
    }
    std::span<const Touch> list() const { return {all.get(), count}; }
    std::span<Touch> list() { return {all.get(), count}; }
  };

  template <class F>
  ContactSlope sum_slopes(F nn_and_identity) const;
  const Side& side(const Touch& touch) const { return sides_[touch.side]; }
  Points normal(const Touch& touch) const { return in_all_lanes(model_.planes[touch.plane].normal); }
  Points force(const Touch& touch) const { return mul_add(touch.normal, normal(touch), touch.tangential); }
  // f(n), the normal of a touch.
  template <class F>
  [[gnu::always_inline]] auto with_normal(const Touch& touch, F f) const {
    return touch.level ? f(Upwards()) : f(normal(touch));
  }
  PackMatrix<Four> slope(const Touch& touch) const;
  PackMatrix<Four> stick_slope(const Touch& touch) const;
  template <class F>
  void add_modes(double factor, int modes, ModeMatrix& matrix, F slope_of) const;
  double slope_at_rest(const ContactLaw& law) const;
  double clearance(const Vec3& n, double height) const;
  Points place(const BodyState& s, const Group& group) const;
  template <bool bends>
  void find_on(int plane, const Vec3& normal, double height, const BodyState& s, const PackMat3& r,
               std::span<const Vec3> stick);
  template <bool with_slope, bool plain, ContactSums sums>
  ContactLoads evaluate_all(const PreparedLaw& law, const BodyVelocity& u, double gamma_dt);
  template <bool with_slope, bool plain, class Normal>
  void respond(const PreparedLaw& law, const Normal& normal, const Points& velocity, double gamma_dt,
               Touch& touch) const;
  template <bool with_slope, bool plain, class Normal>
  void respond_coulomb(const PreparedLaw& law, const Normal& normal, const Points& velocity, double gamma_dt,
                       Touch& touch) const;
  Points held_stick(const PreparedLaw& law, const Touch& touch) const;
  template <class F>
  void each_of(const Touches& touches, F f) const {
    for (const Touch& touch : touches.list())
      for (int k = 0; k < 4; ++k)
        if (touch.touching[k])
          f(touch, k, groups_[touch.group].point[k],
            groups_[touch.group].point[k] * model_.planes.size() + touch.plane);
  }

  const Model& model_;
  double mass_, reach_, contact_mass_, grip_;
  bool gives_ = false;  // what find was given last is elastic
  double stiffest_ = 0, least_length_;
  std::vector<Group> groups_;
  std::vector<Side> sides_;     // per plane, then group
  Vec3 box_centre_, box_half_;  // m, of the points, from the centre of gravity, reference axes
  std::vector<double> widest_;  // m, per plane: greatest gap of centre lines on its face
  Touches now_, start_;
  int modes_ = 0;               // of what find was given last
  std::vector<Points> shapes_;  // per touch and mode, with room for all
};

}  // namespace topple
