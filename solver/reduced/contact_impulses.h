// Velocities that rigid bodies have after a step in whose middle its contacts are looked at. Where they are
// and point to stays; they open, close and slide as the velocities at its end say:
//   M (u - u0) = h (F + sum_c J_c^T f_c(d_c - theta h/2 n.v_c/L, v_c + b_c/2, s_c + h/2 v_c))
//   v_c = J_c u + b_c/2,  theta = w^2/(16 + w^2),  w = h frequency()
// n, J, d, s: normal, map to the relative velocity, depth and stick spring of contact c in the middle; b:
// what the motion at the start adds to that velocity until the end (NearContact::turning); F: what else acts;
// f: the coulomb law. Where contacts are stiff for the step, forces are those of its end: none is too stiff,
// and what rests on them stays (Moreau 1988; Anitescu and Potra 1997). Where they are soft theta goes to 0,
// and the method to that of Stormer and Verlet, which is of second order and damps nothing.
#pragma once

#include <array>
#include <vector>

#include "solver/contact/contact_law.h"
#include "solver/math/block_lu.h"
#include "solver/reduced/body_contacts.h"

namespace topple {

/// One set of bodies, in one step after the other: begin, add, solve, finish.
class ContactImpulses {
 public:
  /// A body's start: velocities as BodyVelocity's, and what acts on it besides contacts, N, N m.
  struct RigidBody {
    double mass, least_inertia, reach;  ///< kg, kg m^2, m
    PackMat3 inertia;                   ///< kg m^2, floor's axes
    PackVec3 linear, angular;
    PackVec3 force, moment;
    double stiffness = 0;  ///< 1/s^2, of all its contacts
  };
  struct Velocity {
    PackVec3 linear, angular;  ///< m/s, rad/s, floor's axes
  };
  /// What contacts take from the bodies in the step, along their normals and across, J.
  struct Work {
    double normal = 0, friction = 0;
  };

  /// `law`: it sticks by springs (ContactLawTraits). h: s.
  void begin(const PreparedLaw& law, double h);
  /// `guess`: where the search for its velocity begins.
  void add(const RigidBody& body, const Velocity& guess);
  /// Between bodies by their order of addition; second -1: a plane or what is held. grip: Body::grip.
  /// hardens: as between members (penalty_force). Returns its number, for stick().
  int add(int first, int second, double grip, bool hardens, const NearContact& contact);
  /// Whether at a contact that is closed, or closes in the step, the bodies meet or part faster than `speed`,
  /// m/s.
  bool strikes(double speed) const;
  /// 1/s, of the bodies on their contacts: none is higher.
  double frequency() const;
  /// Finds the velocities; `matrix` has a row of blocks per body and couples those that contacts do. False:
  /// they are not found.
  bool solve(BlockLu& matrix);
  const std::vector<Velocity>& velocities() const { return u_; }
  /// After solve: what contacts took, and their springs at the end.
  Work finish();
  Vec3 stick(int contact) const { return lane(contacts_[contact / 4].stick, contact % 4); }  ///< m

 private:
  using Points = PackVector<Four>;
  struct FourContacts {
    Points normal, arm[2], stick, turning;
    Four depth, L, alpha, k, c;
  };
  // Contacts of the same two bodies.
  struct Touching {
    int body[2];
    PreparedLaw law;  // with their grip
    bool hardens;
    int first, count;  // pack; contacts
  };
  struct Slopes;
  struct Motion;
  struct Springs;

  enum class Sums { loads, slopes, work };  // which are found; slopes: with loads; work: with stick springs
  template <Sums sums>
  void evaluate(BlockLu* matrix);
  template <Sums sums>
  void evaluate(const Touching& of, BlockLu* matrix);
  void move(double part);
  double along_correction() const;
  void search(double before, double after);

  const PreparedLaw* law_ = nullptr;
  double h_ = 0, ahead_ = 0;  // s; and after the middle, when normal springs are
  std::vector<RigidBody> bodies_;
  std::vector<Velocity> u_;
  std::vector<FourContacts> contacts_;
  std::vector<Touching> touching_;
  std::vector<double> left_, correction_;  // six per body
  // Limits of friction that follow the normal forces make the matrix unsymmetric. Where Newton does not get
  // on with that they are held in it: a slower way, but down.
  bool holds_limits_ = false;
  Work work_;
};

}  // namespace topple
