// Which members touch, and with what forces: four at a time.
#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/contact/coulomb.h"
#include "solver/contact/member_contact.h"
#include "solver/contact/nearest_places.h"
#include "solver/contact/penalty.h"
#include "solver/math/ranges.h"

namespace topple {
namespace {

constexpr double k_aligned = 1e-6;  // of k_parallel: there is no nearest point, and kappa is below 1e-11

using Points = PackVector<Four>;
using Nodes = std::array<std::array<int, 4>, 4>;  // per end, of four pairs

// sin^2 of the angle of two lines by their ends.
std::array<Vec3, 4> sine2_by_end(const PairVector& x) {
  const Vec3 da = x[1] - x[0], db = x[3] - x[2];
  const double la = da.norm(), lb = db.norm();
  const Vec3 u = da / la, v = db / lb;
  const double cosine = u.dot(v);
  const Vec3 by_a = -2 * cosine / la * (v - cosine * u), by_b = -2 * cosine / lb * (u - cosine * v);
  return {Vec3(-by_a), by_a, Vec3(-by_b), by_b};
}

// From the point on b to that on a where `place` of two lines is nearest, m.
Vec3 between_at(int place, const PairVector& x) {
  switch (place) {
    case 0:
      return nearest_points(x[0], x[1], x[2], x[3]).between;
    case 1:
    case 2:
      return nearest_points(x[place - 1], x[2], x[3]).between;
    default:
      return -nearest_points(x[place - 1], x[0], x[1]).between;
  }
}

class TouchFinder {
 public:
  /// merged: see find_merged_contacts; null: each pair has its own touches.
  TouchFinder(const ContactLaw& law, std::span<const MemberPair> pairs, std::span<const Vec3> position,
              std::span<const Vec3> velocity, std::span<const Vec3> start, bool with_forces,
              PairPlaces* merged, MemberContacts& found)
      : law_(law),
        with_forces_(with_forces),
        in_packs_(traits(law).in_packs),
        stores_energy_(traits(law).stores_energy),
        loss_(normal_loss(law.restitution)),
        pairs_(pairs),
        position_(position),
        velocity_(velocity),
        start_(start),
        merged_(merged),
        found_(found) {
    if (merged_ == nullptr) return;
    merged_->all.clear();
    merged_->newest.assign(position.size(), -1);
  }

  void look_at(int i) {
    const MemberPair& pair = pairs_[i];
    double approach2 = 0;
    if (merged_ == nullptr) {
      approach2 = greatest_approach2(pair);
      if (is_beyond(pair, approach2)) return;
    }
    ahead_[ahead_count_] = i;
    approach2_[ahead_count_++] = approach2;
    if (ahead_count_ == 4) look();
  }
  /// After the last one.
  void end() {
    look();
    if (merged_ != nullptr)
      for (PairPlace& place : merged_->all) {
        const double way = pairs_[place.pair].way;
        place.approach2 = way * way;
        if (place.root > 0) place.mass = place.root * place.root / place.weight;
        evaluate(place);
      }
    touch();
    complete_blends();
  }

 private:
  struct FourPlaces {
    std::array<PairPlace, 4> at;
    int count = 0;

    bool full() const { return count == 4; }
    void push_back(const PairPlace& place) { at[count++] = place; }
    // f(place) of each lane; what is not there repeats the first
    template <class F>
    Four each(F f) const {
      Four out;
      for (int k = 0; k < 4; ++k) out.set(k, f(at[k < count ? k : 0]));
      return out;
    }
    unsigned lanes() const { return (1u << count) - 1; }
  };

  // Bound of the square by which they have come nearer since the start, m^2.
  double greatest_approach2(const MemberPair& pair) const {
    const auto moved = [&](int k) { return (position_[pair.node[k]] - pair.start[k]).squaredNorm(); };
    return 2 * (std::max(moved(0), moved(1)) + std::max(moved(2), moved(3)));
  }

  // pair: per lane
  template <class F>
  Nodes nodes(F pair) const {
    Nodes out;
    for (int k = 0; k < 4; ++k)
      for (int end = 0; end < 4; ++end) out[end][k] = pairs_[pair(k)].node[end];
    return out;
  }

  // Where the pairs ahead may touch.
  void look() {
    if (ahead_count_ == 0) return;
    for (int k = ahead_count_; k < 4; ++k) ahead_[k] = ahead_[0];
    const Nodes n = nodes([&](int k) { return ahead_[k]; });
    const Vec3* const x = position_.data();
    const Points a0 = gather(x, n[0]), b0 = gather(x, n[2]);
    const Points u = gather(x, n[1]) - a0, v = gather(x, n[3]) - b0, r = a0 - b0;
    Four reach;
    for (int k = 0; k < 4; ++k) reach.set(k, pairs_[ahead_[k]].L + pairs_[ahead_[k]].ahead);
    const auto is_near = [&](Four s, Four t) {
      const Points between = r + s * u - t * v;
      return bits(dot(between, between) < reach * reach);
    };
    const auto [s, t] = nearest_places(u, v, r);
    const unsigned near = is_near(s, t) & ((1u << ahead_count_) - 1);
    if (near != 0) {
      const Points across = cross(u, v);
      const Four uu = dot(u, u), vv = dot(v, v);
      const Four exact = dot(across, across) / (uu * vv * Four(k_parallel)),
                 sine = choose(exact < Four(1), exact, Four(1));
      std::array<Four, 5> at_s{s, Four(0), Four(1), Four(0), Four(0)},
          at_t{t, Four(0), Four(0), Four(0), Four(1)};
      std::array<unsigned, 5> near_at{near, 0, 0, 0, 0};
      if ((bits(sine < Four(1)) & near) != 0)
        for (int place = 1; place < 5; ++place) {
          Four &own_s = at_s[place], &own_t = at_t[place];
          if (place < 3)
            own_t = within_segment(dot(r + own_s * u, v) / vv);
          else
            own_s = within_segment(dot(own_t * v - r, u) / uu);
          near_at[place] = is_near(own_s, own_t) & near;
        }
      for (int k = 0; k < ahead_count_; ++k) {
        if (!(near >> k & 1)) continue;
        const double kappa = kappa_of(sine[k]), share = law_.member_share;
        PairPlace at{ahead_[k], 0, 0, 0, 0, approach2_[k], pairs_[ahead_[k]].mass};
        for (int place = kappa > 0 ? 0 : 1; place < (kappa < 1 ? 5 : 1); ++place) {
          if (!(near_at[place] >> k & 1)) continue;
          at.place = place;
          at.weight = place == 0 ? share * kappa : share * (1 - kappa) / 4;
          at.s = at_s[place][k];
          at.t = at_t[place][k];
          add(at);
        }
        if (kappa > 0 && kappa < 1 && stores_energy_) add_blend(at.pair, sine[k]);
      }
    }
    ahead_count_ = 0;
  }

  static double kappa_of(double sine) { return sine < k_aligned ? 0 : sine * sine * (3 - 2 * sine); }

  void add_blend(int pair, double sine) {
    const double share = law_.member_share;
    MemberBlend& blend = found_.blends.emplace_back();
    blend.pair = pair;
    blend.by_sine.fill(Vec3::Zero());
    blend.by_surplus.fill(Vec3::Zero());
    blend.slope = share * 6 * sine * (1 - sine) / k_parallel;
    blend.curvature = share * (6 - 12 * sine) / (k_parallel * k_parallel);
    blend.surplus = 0;
  }

  void add(PairPlace place) {
    if (merged_ == nullptr)
      evaluate(place);
    else if (!merge(place))
      merged_->all.push_back(place);
  }

  void evaluate(const PairPlace& place) {
    places_.push_back(place);
    if (places_.full()) touch();
  }

  // Of stick springs the damping adds up, which goes with this.
  static double root_of(const PairPlace& place) { return std::sqrt(place.weight * place.mass); }

  // Whether another pair has that place already; else it is known at its node, if it is at one.
  bool merge(PairPlace& place) {
    const MemberPair& pair = pairs_[place.pair];
    const int a = place.s == 0   ? pair.node[0]
                  : place.s == 1 ? pair.node[1]
                                 : -1,
              b = place.t == 0   ? pair.node[2]
                  : place.t == 1 ? pair.node[3]
                                 : -1;
    if (a < 0 && b < 0) return false;
    place.other = a < 0 ? ~pair.elements.a : b < 0 ? ~pair.elements.b : b;
    std::vector<PairPlace>& all = merged_->all;
    int& newest = merged_->newest[a < 0 ? b : a];
    for (int k = newest; k >= 0; k = all[k].before) {
      PairPlace& there = all[k];
      if (there.other != place.other || pairs_[there.pair].L != pair.L) continue;
      found_.same.push_back({place.pair, place.place, place.weight, there.same});
      there.same = static_cast<int>(found_.same.size()) - 1;
      if (there.root == 0) there.root = root_of(there);
      there.root += root_of(place);
      there.weight += place.weight;
      return true;
    }
    place.before = std::exchange(newest, static_cast<int>(all.size()));
    return false;
  }

  // What touches at the places found.
  void touch() {
    FourPlaces& places = places_;
    if (places.count == 0) return;
    const Nodes n = nodes([&](int k) { return places.at[k < places.count ? k : 0].pair; });
    const Vec3* const x = position_.data();
    const Points a0 = gather(x, n[0]), a1 = gather(x, n[1]), b0 = gather(x, n[2]), b1 = gather(x, n[3]);
    const Points u = a1 - a0, v = b1 - b0, r = a0 - b0;
    const Four s = places.each([](const PairPlace&of) { return of.s; }),
               t = places.each([](const PairPlace&of) { return of.t; });
    const Points between = r + s * u - t * v;
    const Four L = places.each([&](const PairPlace& of) { return pairs_[of.pair].L; });
    const Four square = dot(between, between);
    const unsigned touching = bits(square < L * L) & places.lanes();
    Four l = sqrt(square);
    Points normal = Four(1) / l * between;
    tell_sides(places, between, l, normal);
    const std::array<Four, 4> share{1 - s, s, t - 1, -t};
    const auto by_share = [&](auto at) {
      return share[0] * at(0) + share[1] * at(1) + share[2] * at(2) + share[3] * at(3);
    };
    const Vec3 *const x0 = start_.data(), *const v0 = velocity_.data();
    const Points now[4] = {a0, a1, b0, b1};
    const Points travel = by_share([&](int k) { return now[k] - gather(x0, n[k]); });
    const Points speed = by_share([&](int k) { return gather(v0, n[k]); });
    add_touches(touching, s, t, share, l, normal, L, speed, travel);
    places.count = 0;
  }

  PairVector start_of(const MemberPair& pair) const {
    return merged_ != nullptr ? topple::gather(pair, start_) : pair.start;
  }

  // Ends that have come no nearer than the distance have not passed each other; the sides of the others are
  // those of the start.
  void tell_sides(const FourPlaces& places, const Points& between, Four& l, Points& normal) const {
    for (int k = 0; k < places.count; ++k) {
      if (l[k] * l[k] > places.at[k].approach2) continue;
      const Vec3 now = lane(between, k),
                 before = between_at(places.at[k].place, start_of(pairs_[places.at[k].pair]));
      const double distance = now.norm();
      l.set(k, now.dot(before) < 0 ? -distance : distance);
      set_lane(normal, k, distance > 0 ? Vec3(now / l[k]) : Vec3(before.normalized()));
    }
  }

  // Of a place of several pairs: as long as their springs together pull.
  Vec3 stick_at(const PairPlace& at) const {
    Vec3 stick = pairs_[at.pair].stick[at.place];
    if (at.same < 0) return stick;
    double rest = at.weight;
    Vec3 sum = Vec3::Zero();
    for (int k = at.same; k >= 0; k = found_.same[k].next) {
      const SameTouch& same = found_.same[k];
      sum += same.weight * pairs_[same.pair].stick[same.place];
      rest -= same.weight;
    }
    return (sum + rest * stick) / at.weight;
  }

  void add_touches(unsigned touching, Four s, Four t, const std::array<Four, 4>& share, Four l,
                   const Points& normal, Four L, const Points& speed, Points stick) {
    const FourPlaces& places = places_;
    const std::size_t first = found_.touches.size();
    const Four depth = 1 - l / L;
    Points before;
    for (int k = 0; k < 4; ++k) set_lane(before, k, stick_at(places.at[k < places.count ? k : 0]));
    stick = before + stick;
    const auto normals = lanes(normal), speeds = lanes(speed), sticks = lanes(stick);
    for (int k = 0; k < places.count; ++k) {
      const PairPlace& at = places.at[k];
      MemberTouch& touch = (touching >> k & 1 ? found_.touches : found_.ahead).emplace_back();
      touch.pair = at.pair;
      touch.place = at.place;
      for (int end = 0; end < 4; ++end) touch.share[end] = share[end][k];
      touch.weight = at.weight;
      touch.same = at.same;
      touch.s = s[k];
      touch.t = t[k];
      touch.s_free = (at.place == 0 || at.place > 2) && s[k] > 0 && s[k] < 1;
      touch.t_free = at.place < 3 && t[k] > 0 && t[k] < 1;
      touch.l = l[k];
      ContactInput& in = touch.input;
      store_three(in.normal.data(), normals[k]);
      in.depth = depth[k];
      in.L = L[k];
      store_three(in.velocity.data(), speeds[k]);
      store_three(in.stick.data(), sticks[k]);
      in.mass = at.mass;
      in.between_members = true;
      if (with_forces_ && !in_packs_) touch.out = contact_force(weighted(law_, touch), in);
    }
    if (with_forces_ && in_packs_ && touching != 0) respond(touching, first, depth, L, normal, speed, stick);
  }

  // contact_force of the coulomb law.
  void respond(unsigned touching, std::size_t first, Four depth, Four L, const Points& normal,
               const Points& speed, const Points& stick) {
    const FourPlaces& places = places_;
    Four::Mask mask;
    for (int k = 0; k < 4; ++k) mask[k] = touching >> k & 1 ? -1 : 0;
    depth = choose(mask, depth, Four(0));
    const Four alpha = law_.alpha * places.each([](const PairPlace& of) { return of.weight; });
    Four p = alpha * penalty_power(depth, law_.q);
    for (int k = 0; k < places.count; ++k)
      if (depth[k] > k_hardening_depth) p.set(k, alpha[k] / law_.alpha * penalty_force(law_, depth[k], true));
    const StickSpring<Four> spring(alpha, L, places.each([](const PairPlace& of) { return of.mass; }));
    const auto f =
        coulomb_force(law_, loss_, law_.excess() > 0, normal, speed, stick, mask, p, spring.k, spring.c);
    const Points tangential = -f.scale * f.trial, force = f.normal * normal + tangential;
    const Four travel2 = dot(f.stick, f.stick), energy = stick_energy(spring.k, travel2, f.limit);
    const Points held = held_share(spring.k, travel2, f.limit, mask) * f.stick;
    const auto forces = lanes(force), tangentials = lanes(tangential), helds = lanes(held);
    MemberTouch* touch = &found_.touches[first];
    for (int k = 0; k < places.count; ++k) {
      if (!(touching >> k & 1)) continue;
      ContactOutput& out = touch++->out;
      store_three(out.force.data(), forces[k]);
      out.normal = f.normal[k];
      out.conservative = p[k];
      store_three(out.tangential.data(), tangentials[k]);
      store_three(out.stick.data(), helds[k]);
      out.stick_energy = energy[k];
    }
  }

  void complete_blends() {
    for (MemberBlend& blend : found_.blends) {
      const MemberPair& pair = pairs_[blend.pair];
      const auto at = [&](int k) { return position_[pair.node[k]]; };
      ranges::copy(sine2_by_end({at(0), at(1), at(2), at(3)}), blend.by_sine.begin());
    }
    if (found_.blends.empty()) return;
    for (std::size_t k = 0; k < found_.touches.size(); ++k)
      found_.each_place(found_.touches[k], [&](int pair, int place) {
        const auto blend =
            std::lower_bound(found_.blends.begin(), found_.blends.end(), pair,
                             [](const MemberBlend& one, int number) { return one.pair < number; });
        if (blend != found_.blends.end() && blend->pair == pair) add_to_blend(*blend, place, k);
      });
  }

  // A touch of the blend's pair, at the same two places as its own.
  void add_to_blend(MemberBlend& blend, int place, std::size_t number) {
    const MemberTouch& touch = found_.touches[number];
    const MemberPair &pair = pairs_[blend.pair], &listed = pairs_[touch.pair];
    if (blend.touch < 0) blend.touch = static_cast<int>(number);
    const double part = place == 0 ? 1 : -0.25;
    blend.surplus += part * penalty_energy(law_, touch.input.depth, pair.L, true);
    const double force = part * penalty_force(law_, touch.input.depth, true);
    for (int k = 0; k < 4; ++k) {
      const int side = k < 2 ? 0 : 2;
      for (int m = side; m < side + 2; ++m)
        if (listed.node[m] == pair.node[k])
          blend.by_surplus[k] -= force * touch.share[m] * touch.input.normal;
    }
  }

  const ContactLaw& law_;
  const bool with_forces_, in_packs_, stores_energy_;
  const double loss_;
  const std::span<const MemberPair> pairs_;
  const std::span<const Vec3> position_, velocity_, start_;
  PairPlaces* const merged_;
  MemberContacts& found_;
  std::array<int, 4> ahead_;  // pairs that are looked at next
  std::array<double, 4> approach2_;
  int ahead_count_ = 0;
  FourPlaces places_;
};

void find_contacts_of(PairList list, const ContactLaw& law, std::span<const MemberPair> pairs,
                      std::span<const Vec3> position, std::span<const Vec3> velocity,
                      std::span<const Vec3> start, bool with_forces, PairPlaces* merged,
                      MemberContacts& found) {
  found.clear();
  TouchFinder finder(law, pairs, position, velocity, start, with_forces, merged, found);
  for (int k = 0; k < list.count; ++k)
    if (pairs[list[k]].panel == nullptr) finder.look_at(list[k]);
  finder.end();
  find_panel_touches(law, pairs, list, position, velocity, start, with_forces, merged != nullptr, found);
}

}  // namespace

void find_member_contacts(const ContactLaw& law, std::span<const MemberPair> pairs,
                          std::span<const Vec3> position, std::span<const Vec3> velocity,
                          std::span<const Vec3> start, MemberContacts& found) {
  find_contacts_of({nullptr, static_cast<int>(pairs.size())}, law, pairs, position, velocity, start, true,
                   nullptr, found);
}

void find_merged_contacts(const ContactLaw& law, std::span<const MemberPair> pairs,
                          std::span<const int> which, std::span<const Vec3> position,
                          std::span<const Vec3> velocity, std::span<const Vec3> start, bool with_forces,
                          PairPlaces& places, MemberContacts& found) {
  find_contacts_of({which.data(), static_cast<int>(which.size())}, law, pairs, position, velocity, start,
                   with_forces, &places, found);
}

}  // namespace topple
