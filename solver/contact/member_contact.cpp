#include "solver/contact/member_contact.h"

#include <algorithm>
#include <cmath>

#include "solver/contact/coulomb.h"

namespace topple {
namespace {

constexpr double k_aligned = 1e-6;  // of k_parallel: there is no nearest point, and kappa is below 1e-11
constexpr double k_thin = 0.02;  // of L: nearer than this the turning of the normal is left out of tangents

using Ends = PairVector;

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
  PairVector by_end;
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
    const auto furthest = [&](int k) {
      return std::max((x_[k] - pair.start[k]).squaredNorm(), (x_[k + 1] - pair.start[k + 1]).squaredNorm());
    };
    approach2_ = 2 * (furthest(0) + furthest(2));
    if (pair.gap > 0 && approach2_ < pair.gap * pair.gap) return;
    const NearestPoints nearest = nearest_at(0, x_);
    if (!(nearest.between.squaredNorm() < pair.L * pair.L)) return;
    velocity_ = gather(pair, velocity);
    const Ends x0 = gather(pair, start);
    for (int k = 0; k < 4; ++k) travel_[k] = x_[k] - x0[k];
    const Crossing lines = crossing(x_);
    const double x = std::min(lines.sine2 / k_parallel, 1.);
    const double kappa = x < k_aligned ? 0 : x * x * (3 - 2 * x);
    const std::size_t first = found.touches.size();
    if (kappa > 0) add(0, nearest, kappa);
    if (kappa == 1) return;
    for (int place = 1; place < 5; ++place) add(place, nearest_at(place, x_), (1 - kappa) / 4);
    if (kappa == 0 || !traits(law).stores_energy) return;
    blend(lines, x, first);
  }

 private:
  void add(int place, const NearestPoints& at, double weight) {
    const double distance = at.between.norm();
    if (!(distance < pair_.L)) return;
    MemberTouch touch;
    touch.pair = index_;
    touch.place = place;
    touch.share = shares(at);
    touch.weight = weight;
    touch.at = at;
    touch.ends = x_;
    // ends that have come no nearer than the distance have not passed each other
    if (distance * distance > approach2_) {
      touch.l = distance;
      touch.normal = at.between / distance;
    } else {
      const Vec3 before = nearest_at(place, pair_.start).between;
      touch.l = at.between.dot(before) < 0 ? -distance : distance;
      touch.normal = distance > 0 ? Vec3(at.between / touch.l) : Vec3(before.normalized());
    }
    touch.depth = 1 - touch.l / pair_.L;
    Vec3 relative_velocity = Vec3::Zero(), stick = pair_.stick[place];
    for (int k = 0; k < 4; ++k) {
      relative_velocity += touch.share[k] * velocity_[k];
      stick += touch.share[k] * travel_[k];
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
  Ends velocity_, travel_;  // m/s; m, since `start`
  double approach2_;        // m^2, bound of the square by which they have come nearer since MemberPair::start
  MemberContacts& found_;
};

// How the moving of the nearest points changes the tangent: mixed derivatives of half the squared distance by
// the nodes and the free ones of s, t, times `factor` and the inverse of the second derivatives by the
// latter, times the same.
void add_sliding(const MemberTouch& touch, double factor, PairTangent& tangent) {
  const Ends& x = touch.ends;
  const Vec3 da = x[1] - x[0], db = x[3] - x[2], &d = touch.at.between;
  PairVector by_s, by_t;
  for (int k = 0; k < 4; ++k) {
    by_s[k] = touch.share[k] * da;
    by_t[k] = -touch.share[k] * db;
  }
  by_s[0] -= d;
  by_s[1] += d;
  by_t[2] += d;
  by_t[3] -= d;
  double ss = touch.at.s_free ? da.squaredNorm() : 1, tt = touch.at.t_free ? db.squaredNorm() : 1,
         st = touch.at.s_free && touch.at.t_free ? -da.dot(db) : 0;
  const double determinant = ss * tt - st * st;
  const auto add = [&](const PairVector& left, double of_s, double of_t) {
    PairTangent::Product& product = tangent.products[tangent.product_count++];
    product.left = left;
    for (int k = 0; k < 4; ++k) product.right[k] = factor / determinant * (of_s * by_s[k] + of_t * by_t[k]);
  };
  if (touch.at.s_free) add(by_s, tt, -st);
  if (touch.at.t_free) add(by_t, -st, ss);
}

bool slips(const ContactLaw& law, const MemberTouch& touch) {
  constexpr double k_rounding = 1e-9;
  const Vec3& v = touch.input.velocity;
  const double along = (v - touch.normal.dot(v) * touch.normal).squaredNorm();
  return !(touch.out.tangential.norm() <
           (1 - k_rounding) * friction_coefficient(law, along) * touch.out.normal);
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
                  double velocity_factor, const std::function<void(const PairTangent&)>& f) {
  PairTangent tangent;
  for (const MemberTouch& touch : contacts.touches) {
    tangent.pair = touch.pair;
    tangent.share = touch.share;
    tangent.product_count = 0;
    Mat3 by_position, by_velocity;
    contact_force(weighted(law, touch.weight), touch.input, by_position, by_velocity);
    tangent.local = -by_position - velocity_factor * by_velocity;
    const Mat3 across = Mat3::Identity() - touch.normal * touch.normal.transpose();
    tangent.stick.setZero();
    if (traits(law).sticks && !slips(law, touch)) tangent.stick = across * tangent.local * across;
    if (touch.l > k_thin * pairs[touch.pair].L) {
      tangent.local -= touch.out.normal / touch.l * across;
      add_sliding(touch, touch.out.normal / touch.l, tangent);
    }
    f(tangent);
  }
  tangent.share.fill(0);
  tangent.local.setZero();
  tangent.stick.setZero();
  for (const MemberBlend& blend : contacts.blends) {
    tangent.pair = blend.pair;
    tangent.product_count = 2;
    for (int k = 0; k < 4; ++k) {
      tangent.products[0].left[k] = blend.by_sine[k];
      tangent.products[0].right[k] =
          blend.curvature * blend.surplus * blend.by_sine[k] + blend.slope * blend.by_surplus[k];
      tangent.products[1].left[k] = blend.by_surplus[k];
      tangent.products[1].right[k] = blend.slope * blend.by_sine[k];
    }
    f(tangent);
  }
}

void add_tangent(const ContactLaw& law, const MemberContacts& contacts, std::span<const MemberPair> pairs,
                 double velocity_factor, const std::function<void(int i, int j, const Mat3& block)>& add) {
  const auto add_all = [&](const PairTangent& tangent) {
    const MemberPair& pair = pairs[tangent.pair];
    for (int k = 0; k < 4; ++k)
      for (int m = 0; m < 4; ++m) {
        Mat3 block = tangent.share[k] * tangent.share[m] * tangent.local;
        for (int p = 0; p < tangent.product_count; ++p)
          block += tangent.products[p].left[k] * tangent.products[p].right[m].transpose();
        add(pair.node[k], pair.node[m], block);
      }
  };
  each_tangent(law, contacts, pairs, velocity_factor, std::ref(add_all));
}

void keep_sticks(const ContactLaw& law, MemberContacts& contacts, std::span<MemberPair> pairs) {
  for (MemberPair& pair : pairs) pair.stick.fill(Vec3::Zero());
  for (MemberTouch& touch : contacts.touches) {
    pairs[touch.pair].stick[touch.place] = touch.input.stick = touch.out.stick;
    if (traits(law).sticks && slips(law, touch))
      touch.out = contact_force(weighted(law, touch.weight), touch.input);
  }
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
