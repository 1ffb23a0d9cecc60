// Penalty contact between members of different bodies, and of members' tips with panels: Eqs. 2 and 3 with
// the normal read as geometric.
//
// Two elements a and b hold the energy
//   E = kappa U(l) + (1 - kappa)/4 (sum of U at the two ends of a over b and of b over a),
// U: penalty_energy with hardening and the law's member_share of alpha, l: distance where the centre lines
// are nearest, kappa = x^2 (3 - 2 x), with x = sin^2 of their angle over k_parallel, at most 1. So nearly
// parallel elements touch at their ends and do not chatter about one moving point. Forces are derivatives of
// E, kappa's included: only damping and friction take energy. They act on centre lines.
//
// A tip p over a panel holds the energy  E = w U(l),  l: distance from the panel's middle plane, w:
// panel_share, with which the panel gives way to the members that lie in it.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "solver/contact/contact_law.h"
#include "solver/contact/proximity.h"
#include "solver/math/types.h"

namespace topple {

inline constexpr double k_parallel = 1e-2;  ///< sin^2 of the angle below which kappa < 1
inline constexpr double k_thin = 0.02;      ///< of L, see PairTangent

/// A vector at each node of a pair.
using PairVector = std::array<Vec3, 6>;

/// A stick spring between members: tangential travel since sticking began, m. Part of State.
struct MemberStick {
  ElementPair elements;
  int place;  ///< see MemberTouch
  Vec3 stick;
};

/// Two parts that may touch, within a system.
struct MemberPair {
  ElementPair elements;
  const Panel* panel = nullptr;    ///< that b is; null: b is an element
  std::array<bool, 2> tip{};       ///< ends of a that touch the panel
  std::array<int, 6> node{};       ///< ends of a, then of b or corners of the panel, numbered in the system
  std::array<int, 2> count{1, 1};  ///< elements of a and b, from the first on, that are taken as one
  double L;                        ///< m
  double mass;                     ///< kg, for ContactInput::mass: reduced mass of the two bodies' shares
  double gap = 0;                  ///< m, between the surfaces at `start`, where it is known; 0: not
  double ahead = 0;                ///< m, by which it may be open to be found (MemberContacts::ahead)
  double way = 0;                  ///< m, by which its parts came nearer at most, for find_merged_contacts
  PairVector start;                ///< m, positions of the nodes where the step began: they tell the side
  std::array<Vec3, 5> stick;       ///< m, per place, where the step began

  int nodes() const { return panel != nullptr ? 6 : 4; }
};

/// Contact of two parts at one place.
struct MemberTouch {
  int pair;   ///< within the system
  int place;  ///< 0: where they are nearest; 1, 2: first and second end of a over b; 3, 4: of b over a
  std::array<double, 6> share{};  ///< of the nodes' motion in that of a's point relative to b's: sum share x
  double weight;                  ///< of its U in E, kappa or (1 - kappa)/4 or w, times member_share
  double s, t;                    ///< where, see NearestPoints; of a panel t and u are PanelPlace::r
  double u = 0;
  int same = -1;        ///< first of those that it stands for, in MemberContacts::same
  bool s_free, t_free;  ///< see NearestPoints
  double l;             ///< m, along the normal; <= 0: they went through each other
  ContactInput input;   ///< its normal, from b to a, keeps its side while l goes through zero
  ContactOutput out;
};

/// A place of another pair where a touch is, too: members meet in a corner.
struct SameTouch {
  int pair, place;  ///< see MemberTouch
  double weight;    ///< its part of MemberTouch::weight
  int next;         ///< in MemberContacts::same; -1: none
};

/// `law` with the touch's share of alpha.
inline ContactLaw weighted(ContactLaw law, const MemberTouch& touch) {
  law.alpha *= touch.weight;
  return law;
}

/// Part of the force of two nearly parallel elements by kappa' = d(kappa)/d(sin^2):
///   -kappa' (U - (sum of U at the ends)/4) d(sin^2)/dx
/// Of a tip over a panel by w, without the derivatives of w's slope: -U dw/dx.
struct MemberBlend {
  int pair;
  int touch = -1;                  ///< the first of the pair's that is listed; -1: none
  double slope, curvature;         ///< kappa' and kappa''; of a panel 1 and 0
  double surplus;                  ///< J, the bracket, U
  PairVector by_sine, by_surplus;  ///< derivatives of sin^2 or w, and of the bracket or U, by the nodes
};

/// All that touches between members at some instant.
struct MemberContacts {
  std::vector<MemberTouch> touches;
  std::vector<MemberBlend> blends;
  std::vector<MemberTouch> ahead;  ///< open by no more than MemberPair::ahead, without forces
  std::vector<SameTouch> same;     ///< of touches that stand for several

  void clear() {
    touches.clear();
    blends.clear();
    ahead.clear();
    same.clear();
  }
  /// f(pair, place) of a touch and of those that it stands for.
  template <class F>
  void each_place(const MemberTouch& touch, F f) const {
    f(touch.pair, touch.place);
    for (int k = touch.same; k >= 0; k = same[k].next) f(same[k].pair, same[k].place);
  }
};

/// A place where a pair may touch. s, t: see MemberTouch.
struct PairPlace {
  int pair, place;
  double weight, s, t;
  double approach2;  ///< m^2, bound of the square by which it has come nearer since the start
  double mass;       ///< kg, see ContactInput::mass; of several that with which they are damped as together
  double root = 0;   ///< kg^(1/2), of several: sum of the roots of weight and mass
  int same = -1;     ///< see MemberTouch
  int other = 0;     ///< of a place at a node the node or ~element that it is nearest to
  int before = -1;   ///< the place at the same node that was found before it; -1: none
};

/// Kept from one search for what touches to the next.
struct PairPlaces {
  std::vector<PairPlace> all;
  std::vector<int> newest;  ///< per node of the system, of `all` there; -1: none
};

/// Relative motion of a touch: sum share x over the nodes of its pair.
Vec3 relative(const MemberTouch& touch, const MemberPair& pair, std::span<const Vec3> x);

/// Where the parts of a pair with nodes at x are nearest; of a panel where each tip is nearest to it.
struct NearestShares {
  struct At {
    std::array<double, 6> share;  ///< see MemberTouch
    Vec3 between;                 ///< m, from b to a
    double gap;                   ///< m, between the surfaces
  };
  std::array<At, 2> at;
  int count;
};
NearestShares nearest_shares(const MemberPair& pair, const PairVector& x);
/// The least of their gaps, m.
double nearest_gap(const MemberPair& pair, const PairVector& x);

/// What touches at `position` and `velocity` (per node of the system), with forces. `start`: positions at the
/// instant of the stick springs of `pairs`.
void find_member_contacts(const ContactLaw& law, std::span<const MemberPair> pairs,
                          std::span<const Vec3> position, std::span<const Vec3> velocity,
                          std::span<const Vec3> start, MemberContacts& found);
/// The same of some of the pairs, in ascending order. Pairs that touch at the same two places, as those of
/// the members that meet in two corners do, have one touch with the sum of their weights: of rigid bodies it
/// moves as they do. All of `which` are looked at; `start`, since when MemberPair::way counts, tells the
/// side. with_forces false: MemberTouch::out may be missing.
void find_merged_contacts(const ContactLaw& law, std::span<const MemberPair> pairs,
                          std::span<const int> which, std::span<const Vec3> position,
                          std::span<const Vec3> velocity, std::span<const Vec3> start, bool with_forces,
                          PairPlaces& places, MemberContacts& found);

/// Pairs that are looked at, in order: those in `which`, or, where it is null, the first.
struct PairList {
  const int* which;
  int count;
  int operator[](int k) const { return which != nullptr ? which[k] : k; }
};

/// What touches panels of the pairs in `list`, added to `found`. merged: as by find_merged_contacts.
void find_panel_touches(const ContactLaw& law, std::span<const MemberPair> pairs, PairList list,
                        std::span<const Vec3> position, std::span<const Vec3> velocity,
                        std::span<const Vec3> start, bool with_forces, bool merged, MemberContacts& found);

/// Adds the forces on the nodes.
void add_forces(const MemberContacts& contacts, std::span<const MemberPair> pairs, std::span<Vec3> force);

/// -d(force)/d(position) - velocity_factor d(force)/d(velocity) of one place or blend, N/m: between the ends
/// k and m of the pair  share_k share_m local + sum of left_k right_m^T over products. The factor in 1/s;
/// without the second derivatives of sin^2 and, below l = k_thin L, without the turning of the normal.
struct PairTangent {
  struct Product {
    PairVector left, right;
  };
  int pair;
  std::array<double, 6> share;
  Mat3 local;
  Mat3 stick;  ///< part of `local` that is the stick spring with its damping; zero when it slips
  std::array<Product, 4> products;
  int product_count;
};
PairTangent touch_tangent(const ContactLaw& law, const MemberTouch& touch, const MemberPair& pair,
                          std::span<const Vec3> position, double velocity_factor);
PairTangent blend_tangent(const MemberBlend& blend);
/// Calls add(i, j, block) with their sums between each two nodes of what touches at `position`.
void add_tangent(const ContactLaw& law, const MemberContacts& contacts, std::span<const MemberPair> pairs,
                 std::span<const Vec3> position, double velocity_factor,
                 const std::function<void(int i, int j, const Mat3& block)>& add);

/// What touches leaves its stick springs in `pairs`; those of other places become zero. Springs that slipped
/// are shorter from here on, and forces those of the shorter ones.
void keep_sticks(const ContactLaw& law, MemberContacts& contacts, std::span<MemberPair> pairs);

/// Energy in normal springs (of laws that store it) and stick springs, J.
double stored_energy(const ContactLaw& law, const MemberContacts& contacts,
                     std::span<const MemberPair> pairs);

/// Nodes of a pair.
inline PairVector gather(const MemberPair& pair, std::span<const Vec3> x) {
  PairVector out;
  for (int k = 0; k < pair.nodes(); ++k) out[k] = x[pair.node[k]];
  return out;
}

/// Whether a pair whose parts have come nearer than at its start by no more than the root of `approach2`,
/// m^2, is open by more than its MemberPair::ahead.
inline bool is_beyond(const MemberPair& pair, double approach2) {
  const double way = pair.gap - pair.ahead;
  return way > 0 && approach2 < way * way;
}

/// First pair that went through each other, or moved by more than L/2 relative to each other within reach:
/// the step from `start` to `end` (positions) is too long to see what happened between. -1: none.
int passed_unseen(const MemberContacts& at_end, std::span<const MemberPair> pairs,
                  std::span<const Vec3> start, std::span<const Vec3> end);
/// The second of it, of one pair.
bool moved_unseen(const MemberPair& pair, std::span<const Vec3> start, std::span<const Vec3> end);

}  // namespace topple
