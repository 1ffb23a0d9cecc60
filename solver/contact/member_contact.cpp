#include "solver/contact/member_contact.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace topple {
namespace {

constexpr double k_aligned = 1e-6;  // of k_parallel: there is no nearest point, and kappa is below 1e-11
constexpr double k_thin = 0.02;  // of L: nearer than this the turning of the normal is left out of tangents

using Ends = std::array<Vec3, 4>;

Ends gather(const MemberPair& pair, std::span<const Vec3> x) {
  return {x[pair.node[0]], x[pair.node[1]], x[pair.node[2]], x[pair.node[3]]};
}

NearestPoints nearest_at(int place, const Ends& x) {
  switch (place) {
    case 0:
      return nearest_points(x[0], x[1], x[2], x[3]);
    case 1:
    case 2: {
      NearestPoints at = nearest_points(x[place - 1], x[2], x[3]);
      at.s = place - 1;
      return at;
    }
    default: {
      const NearestPoints at = nearest_points(x[place - 1], x[0], x[1]);
      return {at.t, double(place - 3), at.t_free, false, -at.between};
    }
  }
}

std::array<double, 4> shares(const NearestPoints& at) {
  return {1 - at.s, at.s, at.t - 1, -at.t};
}

// sin^2 of the angle of two lines with its derivatives by their ends.
struct Crossing {
  double sine2;
  std::array<Vec3, 4> by_end;
};

Crossing crossing(const Ends& x) {
  const Vec3 da = x[1] - x[0], db = x[3] - x[2];
  const double la = da.norm(), lb = db.norm();
  const Vec3 u = da / la, v = db / lb;
  const double cosine = u.dot(v);
  const Vec3 by_a = -2 * cosine / la * (v - cosine * u), by_b = -2 * cosine / lb * (u - cosine * v);
  return {u.cross(v).squaredNorm(), {Vec3(-by_a), by_a, Vec3(-by_b), by_b}};
}

ContactLaw weighted(ContactLaw law, double weight) {
  law.alpha *= weight;
  return law;
}

class PairFinder {
 public:
  PairFinder(const ContactLaw& law, const MemberPair& pair, int index, std::span<const Vec3> position,
             std::span<const Vec3> velocity, std::span<const Vec3> start, MemberContacts& found)
      : law_(law), pair_(pair), index_(index), x_(gather(pair, position)), found_(found) {
    const NearestPoints nearest = nearest_at(0, x_);
    if (!(nearest.between.squaredNorm() < pair.L * pair.L)) return;
    const Crossing lines = crossing(x_);
    const double x = std::min(lines.sine2 / k_parallel, 1.);
    const double kappa = x < k_aligned ? 0 : x * x * (3 - 2 * x);
    const std::size_t first = found.touches.size();
    if (kappa > 0) add(0, nearest, kappa, velocity, start);
    if (kappa == 1) return;
    for (int place = 1; place < 5; ++place)
      add(place, nearest_at(place, x_), (1 - kappa) / 4, velocity, start);
    if (kappa == 0 || !traits(law).stores_energy) return;
    blend(lines, x, first);
  }

 private:
  void add(int place, const NearestPoints& at, double weight, std::span<const Vec3> velocity,
           std::span<const Vec3> start) {
    const double distance = at.between.norm();
    if (!(distance < pair_.L)) return;
    MemberTouch touch;
    touch.pair = index_;
    touch.place = place;
    touch.share = shares(at);
    touch.weight = weight;
    touch.at = at;
    touch.ends = x_;
    const Vec3 before = nearest_at(place, pair_.start).between;
    const bool through = at.between.dot(before) < 0;
    touch.l = through ? -distance : distance;
    touch.normal = distance > 0 ? Vec3(at.between / touch.l) : Vec3(before.normalized());
    touch.depth = 1 - touch.l / pair_.L;
    const Ends v = gather(pair_, velocity), x0 = gather(pair_, start);
    Vec3 relative_velocity = Vec3::Zero(), stick = pair_.stick[place];
    for (int k = 0; k < 4; ++k) {
      relative_velocity += touch.share[k] * v[k];
      stick += touch.share[k] * (x_[k] - x0[k]);
    }
    touch.input = {touch.normal, touch.depth, pair_.L, relative_velocity, stick, pair_.mass, true};
    touch.out = contact_force(weighted(law_, weight), touch.input);
    found_.touches.push_back(touch);
  }

  void blend(const Crossing& lines, double x, std::size_t first) {
    MemberBlend blend;
    blend.pair = index_;
    blend.slope = 6 * x * (1 - x) / k_parallel;
    blend.curvature = (6 - 12 * x) / (k_parallel * k_parallel);
    blend.surplus = 0;
    blend.by_sine = lines.by_end;
    blend.by_surplus.fill(Vec3::Zero());
    for (std::size_t i = first; i < found_.touches.size(); ++i) {
      const MemberTouch& touch = found_.touches[i];
      const double part = touch.place == 0 ? 1 : -0.25;
      blend.surplus += part * penalty_energy(law_, touch.depth, pair_.L, true);
      const double force = part * penalty_force(law_, touch.depth, true);
      for (int k = 0; k < 4; ++k) blend.by_surplus[k] -= force * touch.share[k] * touch.normal;
    }
    found_.blends.push_back(blend);
  }

  const ContactLaw& law_;
  const MemberPair& pair_;
  const int index_;
  const Ends x_;
  MemberContacts& found_;
};

using Mat12x2 = Eigen::Matrix<double, 12, 2>;

// Mixed derivatives of half the squared distance by the nodes and the free ones of s, t, times the inverse of
// the second derivatives by the latter, times the same: what the moving of the nearest points takes off.
PairTangent sliding(const MemberTouch& touch) {
  const Ends& x = touch.ends;
  const Vec3 da = x[1] - x[0], db = x[3] - x[2], &d = touch.at.between;
  Mat12x2 mixed;
  const Vec3 by_s[4] = {-d, d, Vec3::Zero(), Vec3::Zero()}, by_t[4] = {Vec3::Zero(), Vec3::Zero(), d, -d};
  for (int k = 0; k < 4; ++k) {
    mixed.block<3, 1>(3 * k, 0) = touch.share[k] * da + by_s[k];
    mixed.block<3, 1>(3 * k, 1) = -touch.share[k] * db + by_t[k];
  }
  Eigen::Matrix2d second;
  second << da.squaredNorm(), -da.dot(db), -da.dot(db), db.squaredNorm();
  if (touch.at.s_free && touch.at.t_free) return mixed * second.inverse() * mixed.transpose();
  if (touch.at.s_free) return mixed.col(0) * mixed.col(0).transpose() / second(0, 0);
  if (touch.at.t_free) return mixed.col(1) * mixed.col(1).transpose() / second(1, 1);
  return PairTangent::Zero();
}

}  // namespace

Vec3 relative(const MemberTouch& touch, const MemberPair& pair, std::span<const Vec3> x) {
  Vec3 sum = Vec3::Zero();
  for (int k = 0; k < 4; ++k) sum += touch.share[k] * x[pair.node[k]];
  return sum;
}

void find_member_contacts(const ContactLaw& law, std::span<const MemberPair> pairs,
                          std::span<const Vec3> position, std::span<const Vec3> velocity,
                          std::span<const Vec3> start, MemberContacts& found) {
  found.clear();
  for (int i = 0; i < static_cast<int>(pairs.size()); ++i)
    PairFinder(law, pairs[i], i, position, velocity, start, found);
}

void add_forces(const MemberContacts& contacts, std::span<const MemberPair> pairs, std::span<Vec3> force) {
  for (const MemberTouch& touch : contacts.touches)
    for (int k = 0; k < 4; ++k) force[pairs[touch.pair].node[k]] += touch.share[k] * touch.out.force;
  for (const MemberBlend& blend : contacts.blends)
    for (int k = 0; k < 4; ++k)
      force[pairs[blend.pair].node[k]] -= blend.slope * blend.surplus * blend.by_sine[k];
}

void each_tangent(const ContactLaw& law, const MemberContacts& contacts, std::span<const MemberPair> pairs,
                  double velocity_factor, const std::function<void(int, const PairTangent&)>& add) {
  PairTangent stiffness;
  for (const MemberTouch& touch : contacts.touches) {
    const MemberPair& pair = pairs[touch.pair];
    Mat3 by_position, by_velocity;
    contact_force(weighted(law, touch.weight), touch.input, by_position, by_velocity);
    const bool turns = touch.l > k_thin * pair.L;
    const Mat3 turning =
        turns
            ? Mat3(touch.out.normal / touch.l * (Mat3::Identity() - touch.normal * touch.normal.transpose()))
            : Mat3(Mat3::Zero());
    const Mat3 local = -by_position - velocity_factor * by_velocity - turning;
    for (int k = 0; k < 4; ++k)
      for (int m = 0; m < 4; ++m)
        stiffness.block<3, 3>(3 * k, 3 * m) = touch.share[k] * touch.share[m] * local;
    if (turns) stiffness += touch.out.normal / touch.l * sliding(touch);
    add(touch.pair, stiffness);
  }
  for (const MemberBlend& blend : contacts.blends) {
    Eigen::Matrix<double, 12, 1> sine, surplus;
    for (int k = 0; k < 4; ++k) {
      sine.segment<3>(3 * k) = blend.by_sine[k];
      surplus.segment<3>(3 * k) = blend.by_surplus[k];
    }
    stiffness = blend.curvature * blend.surplus * sine * sine.transpose() +
                blend.slope * (sine * surplus.transpose() + surplus * sine.transpose());
    add(blend.pair, stiffness);
  }
}

void add_tangent(const ContactLaw& law, const MemberContacts& contacts, std::span<const MemberPair> pairs,
                 double velocity_factor, BlockLu& lu) {
  each_tangent(law, contacts, pairs, velocity_factor, [&](int which, const PairTangent& part) {
    const MemberPair& pair = pairs[which];
    Mat6 block = Mat6::Zero();
    for (int k = 0; k < 4; ++k)
      for (int m = 0; m < 4; ++m) {
        block.topLeftCorner<3, 3>() = part.block<3, 3>(3 * k, 3 * m);
        lu.add(pair.node[k], pair.node[m], block);
      }
  });
}

double stored_energy(const ContactLaw& law, const MemberContacts& contacts,
                     std::span<const MemberPair> pairs) {
  double sum = 0;
  for (const MemberTouch& touch : contacts.touches) {
    if (traits(law).stores_energy)
      sum += touch.weight * penalty_energy(law, touch.depth, pairs[touch.pair].L, true);
    sum += touch.out.stick_energy;
  }
  return sum;
}

int passed_unseen(const MemberContacts& at_end, std::span<const MemberPair> pairs,
                  std::span<const Vec3> start, std::span<const Vec3> end) {
  for (const MemberTouch& touch : at_end.touches)
    if (!(touch.l > 0)) return touch.pair;
  for (int k = 0; k < static_cast<int>(pairs.size()); ++k) {
    const MemberPair& pair = pairs[k];
    const Ends x0 = gather(pair, start), x1 = gather(pair, end);
    double travel = 0;
    for (int i = 0; i < 2; ++i)
      for (int j = 2; j < 4; ++j) travel = std::max(travel, (x1[i] - x0[i] - x1[j] + x0[j]).norm());
    if (travel <= pair.L / 2) continue;
    const double before = nearest_at(0, x0).between.norm(), after = nearest_at(0, x1).between.norm();
    if (std::min(before, after) < pair.L + travel) return k;
  }
  return -1;
}

}  // namespace topple
