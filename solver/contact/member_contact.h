// Penalty contact between members of different bodies: Eqs. 2 and 3 with the normal read as geometric.
//
// Two elements a and b hold the energy
//   E = kappa U(l) + (1 - kappa)/4 (sum of U at the two ends of a over b and of b over a),
// U the energy of Eq. 2 with hardening (contact_law.h), l the distance where the centre lines are nearest,
// kappa = x^2 (3 - 2 x), x = sin^2 of their angle over k_parallel. Side by side they touch at two places with
// half weights; forces are derivatives of E, kappa's included, so that nothing but damping and friction takes
// energy. Forces act on centre lines.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "solver/contact/contact_law.h"
#include "solver/contact/proximity.h"
#include "solver/math/block_lu.h"

namespace topple {

inline constexpr double k_parallel = 1e-2;  ///< of sin^2: less is blended

/// A stick spring between members: tangential travel since sticking began, m. Part of State.
struct MemberStick {
  ElementPair elements;
  int place;  ///< see MemberTouch
  Vec3 stick;
};

/// Two elements that may touch, within a system.
struct MemberPair {
  ElementPair elements;
  std::array<int, 4> node;    ///< ends of a, then of b, numbered within the system
  double L;                   ///< m
  double mass;                ///< kg, share of the bodies that a contact carries
  std::array<Vec3, 4> start;  ///< m, of the nodes where the step began: on which side they were
  std::array<Vec3, 5> stick;  ///< m, per place, where the step began
};

/// Contact of two elements at one place.
struct MemberTouch {
  int pair;   ///< within the system
  int place;  ///< 0: where they are nearest; 1, 2: first and second end of a over b; 3, 4: of b over a
  std::array<double, 4> share;  ///< of the ends: motion of a's point relative to b's is sum share x
  double weight;                ///< of its energy in the pair's
  NearestPoints at;
  std::array<Vec3, 4> ends;  ///< m, of a, then of b
  Vec3 normal;               ///< unit, from b to a; keeps its side while l goes through zero
  double l;                  ///< m, along the normal; <= 0: they went through each other
  double depth;              ///< 1 - l/L
  ContactInput input;
  ContactOutput out;
};

/// Part of the force that turns two nearly parallel elements: -kappa' (U - sum U/4) d(sin^2)/dx.
struct MemberBlend {
  int pair;
  double slope, curvature;                  ///< of kappa by sin^2
  double surplus;                           ///< J, U where they are nearest less that of the four ends
  std::array<Vec3, 4> by_sine, by_surplus;  ///< derivatives by the nodes
};

struct MemberContacts {
  std::vector<MemberTouch> touches;
  std::vector<MemberBlend> blends;

  void clear() {
    touches.clear();
    blends.clear();
  }
};

/// Relative motion of a touch: sum share x over the nodes of its pair.
Vec3 relative(const MemberTouch& touch, const MemberPair& pair, std::span<const Vec3> x);

/// What touches at `position` and `velocity` (per node of the system), with forces; `start`: positions where
/// the sticks of `pairs` are from.
void find_member_contacts(const ContactLaw& law, std::span<const MemberPair> pairs,
                          std::span<const Vec3> position, std::span<const Vec3> velocity,
                          std::span<const Vec3> start, MemberContacts& found);

/// Adds the forces on the nodes.
void add_forces(const MemberContacts& contacts, std::span<const MemberPair> pairs, std::span<Vec3> force);

/// Adds -d(force)/d(position) - velocity_factor d/d(velocity), but for the turning of kappa's derivative.
void add_tangent(const ContactLaw& law, const MemberContacts& contacts, std::span<const MemberPair> pairs,
                 double velocity_factor, BlockLu& lu);

/// J, held in normal springs (not that of the printed law) and stick springs.
double stored_energy(const ContactLaw& law, const MemberContacts& contacts,
                     std::span<const MemberPair> pairs);

/// First pair that went through each other, or moved more than half of L relative to each other while near:
/// the step from `start` to `end` is too long to see what happened between. -1: none, as below a relative
/// speed of L/(2 h).
int passed_unseen(const MemberContacts& at_end, std::span<const MemberPair> pairs,
                  std::span<const Vec3> start, std::span<const Vec3> end);

}  // namespace topple
