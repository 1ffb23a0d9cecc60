// Which members touch, and with what forces: four at a time.
#include <algorithm>
#include <cmath>

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
  TouchFinder(const ContactLaw& law, std::span<const MemberPair> pairs, std::span<const Vec3> position,
              std::span<const Vec3> velocity, std::span<const Vec3> start, bool with_forces,
              MemberContacts& found)
      : law_(law),
        with_forces_(with_forces),
        in_packs_(traits(law).in_packs),
        stores_energy_(traits(law).stores_energy),
        loss_(normal_loss(law.restitution)),
        pairs_(pairs),
        position_(position),
        velocity_(velocity),
        start_(start),
        found_(found) {}

  void look_at(int i) {
    const MemberPair& pair = pairs_[i];
    const double approach2 = greatest_approach2(pair);
    if (is_beyond(pair, approach2)) return;
    pairs_ahead_.push_back({i, 0, 0, 0, 0, approach2});
    if (pairs_ahead_.full()) look();
  }
  /// After the last one.
  void end() {
    look();
    touch();
    complete_blends();
  }

 private:
  // A place where a pair may touch. s, t: known where they are not found from each other.
  struct Place {
    int pair, place;
    double weight, s, t;
    double approach2;  // m^2, greatest_approach2
  };
  struct FourPlaces {
    std::array<Place, 4> at;
    int count = 0;

    bool full() const { return count == 4; }
    void push_back(const Place& place) { at[count++] = place; }
    // f(place) of each lane; what is not there repeats the first
    template <class F>
    Four each(F f) const {
      Four out;
      for (int k = 0; k < 4; ++k) out.set(k, f(at[k < count ? k : 0]));
      return out;
    }
    unsigned lanes() const { return (1u << count) - 1; }
  };

  double reach_of(const Place& place) const { return pairs_[place.pair].L + pairs_[place.pair].ahead; }

  // Bound of the square by which they have come nearer since MemberPair::start, m^2.
  double greatest_approach2(const MemberPair& pair) const {
    const auto moved = [&](int k) { return (position_[pair.node[k]] - pair.start[k]).squaredNorm(); };
    return 2 * (std::max(moved(0), moved(1)) + std::max(moved(2), moved(3)));
  }

  Nodes nodes(const FourPlaces& places) const {
    Nodes out;
    for (int k = 0; k < 4; ++k)
      for (int end = 0; end < 4; ++end)
        out[end][k] = pairs_[places.at[k < places.count ? k : 0].pair].node[end];
    return out;
  }

  // Where the pairs ahead may touch.
  void look() {
    FourPlaces& ahead = pairs_ahead_;
    if (ahead.count == 0) return;
    const Nodes n = nodes(ahead);
    const Vec3* const x = position_.data();
    const Points a0 = gather(x, n[0]), b0 = gather(x, n[2]);
    const Points u = gather(x, n[1]) - a0, v = gather(x, n[3]) - b0, r = a0 - b0;
    const auto [s, t] = nearest_places(u, v, r);
    const Points between = r + s * u - t * v;
    const Four reach = ahead.each([&](const Place& of) { return reach_of(of); });
    const unsigned near = bits(dot(between, between) < reach * reach) & ahead.lanes();
    if (near != 0) {
      const Points across = cross(u, v);
      const Four sine = dot(across, across) / (dot(u, u) * dot(v, v) * Four(k_parallel));
      for (int k = 0; k < ahead.count; ++k)
        if (near >> k & 1) add_places(ahead.at[k], std::min(sine[k], 1.), s[k], t[k]);
    }
    ahead.count = 0;
  }

  void add_places(Place at, double sine, double s, double t) {
    const double kappa = sine < k_aligned ? 0 : sine * sine * (3 - 2 * sine);
    const auto add = [&](int place, double weight, double own_s, double own_t) {
      at.place = place;
      at.weight = weight;
      at.s = own_s;
      at.t = own_t;
      places_.push_back(at);
      if (places_.full()) touch();
    };
    const double share = law_.member_share, rest = share * (1 - kappa) / 4;
    if (kappa > 0) add(0, share * kappa, s, t);
    if (kappa == 1) return;
    add(1, rest, 0, 0);
    add(2, rest, 1, 0);
    add(3, rest, 0, 0);
    add(4, rest, 0, 1);
    if (kappa == 0 || !stores_energy_) return;
    MemberBlend& blend = found_.blends.emplace_back();
    blend.pair = at.pair;
    blend.by_sine.fill(Vec3::Zero());
    blend.by_surplus.fill(Vec3::Zero());
    blend.slope = share * 6 * sine * (1 - sine) / k_parallel;
    blend.curvature = share * (6 - 12 * sine) / (k_parallel * k_parallel);
    blend.surplus = 0;
  }

  // What touches at the places found.
  void touch() {
    FourPlaces& places = places_;
    if (places.count == 0) return;
    const Nodes n = nodes(places);
    const Vec3* const x = position_.data();
    const Points a0 = gather(x, n[0]), a1 = gather(x, n[1]), b0 = gather(x, n[2]), b1 = gather(x, n[3]);
    const Points u = a1 - a0, v = b1 - b0, r = a0 - b0;
    const Four place = places.each([](const Place& of) { return of.place; });
    const Four::Mask end_of_a = (Four(0) < place) & (place < Four(3)), end_of_b = Four(2) < place;
    Four s = places.each([](const Place&of) { return of.s; }),
         t = places.each([](const Place&of) { return of.t; });
    t = choose(end_of_a, within_segment(dot(r + s * u, v) / dot(v, v)), t);
    s = choose(end_of_b, within_segment(dot(t * v - r, u) / dot(u, u)), s);
    const Points between = r + s * u - t * v;
    const Four L = places.each([&](const Place& of) { return pairs_[of.pair].L; });
    const Four square = dot(between, between),
               reach = places.each([&](const Place&of) { return reach_of(of); });
    const unsigned near = bits(square < reach * reach) & places.lanes(),
                   touching = bits(square < L * L) & near;
    if (near != 0) {
      Four l = sqrt(square);
      Points normal = Four(1) / l * between;
      tell_sides(places, near, between, l, normal);
      const std::array<Four, 4> share{1 - s, s, t - 1, -t};
      const auto by_share = [&](auto at) {
        return share[0] * at(0) + share[1] * at(1) + share[2] * at(2) + share[3] * at(3);
      };
      const Vec3 *const x0 = start_.data(), *const v0 = velocity_.data();
      const Points now[4] = {a0, a1, b0, b1};
      const Points travel = by_share([&](int k) { return now[k] - gather(x0, n[k]); });
      const Points speed = by_share([&](int k) { return gather(v0, n[k]); });
      add_touches(near, touching, s, t, share, l, normal, L, speed, travel);
    }
    places.count = 0;
  }

  // Ends that have come no nearer than the distance have not passed each other; the sides of the others are
  // those of the start.
  void tell_sides(const FourPlaces& places, unsigned near, const Points& between, Four& l,
                  Points& normal) const {
    for (int k = 0; k < places.count; ++k) {
      if (!(near >> k & 1) || l[k] * l[k] > places.at[k].approach2) continue;
      const Vec3 now = lane(between, k),
                 before = between_at(places.at[k].place, pairs_[places.at[k].pair].start);
      const double distance = now.norm();
      l.set(k, now.dot(before) < 0 ? -distance : distance);
      set_lane(normal, k, distance > 0 ? Vec3(now / l[k]) : Vec3(before.normalized()));
    }
  }

  void add_touches(unsigned near, unsigned touching, Four s, Four t, const std::array<Four, 4>& share, Four l,
                   const Points& normal, Four L, const Points& speed, Points stick) {
    const FourPlaces& places = places_;
    const std::size_t first = found_.touches.size();
    const Four depth = 1 - l / L;
    Points before;
    for (int k = 0; k < 4; ++k) {
      const Place& at = places.at[k < places.count ? k : 0];
      set_lane(before, k, pairs_[at.pair].stick[at.place]);
    }
    stick = before + stick;
    const auto normals = lanes(normal), speeds = lanes(speed), sticks = lanes(stick);
    for (int k = 0; k < places.count; ++k) {
      if (!(near >> k & 1)) continue;
      const Place& at = places.at[k];
      MemberTouch& touch = (touching >> k & 1 ? found_.touches : found_.ahead).emplace_back();
      touch.pair = at.pair;
      touch.place = at.place;
      for (int end = 0; end < 4; ++end) touch.share[end] = share[end][k];
      touch.weight = at.weight;
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
      in.mass = pairs_[at.pair].mass;
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
    const Four alpha = law_.alpha * places.each([](const Place& of) { return of.weight; });
    Four p = alpha * penalty_power(depth, law_.q);
    for (int k = 0; k < places.count; ++k)
      if (depth[k] > k_hardening_depth) p.set(k, alpha[k] / law_.alpha * penalty_force(law_, depth[k], true));
    const StickSpring<Four> spring(alpha, L,
                                   places.each([&](const Place& of) { return pairs_[of.pair].mass; }));
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
    auto touch = found_.touches.begin();
    for (MemberBlend& blend : found_.blends) {
      const MemberPair& pair = pairs_[blend.pair];
      const auto at = [&](int k) { return position_[pair.node[k]]; };
      ranges::copy(sine2_by_end({at(0), at(1), at(2), at(3)}), blend.by_sine.begin());
      while (touch != found_.touches.end() && touch->pair < blend.pair) ++touch;
      for (; touch != found_.touches.end() && touch->pair == blend.pair; ++touch) {
        const double part = touch->place == 0 ? 1 : -0.25;
        blend.surplus += part * penalty_energy(law_, touch->input.depth, pair.L, true);
        const double force = part * penalty_force(law_, touch->input.depth, true);
        for (int k = 0; k < 4; ++k) blend.by_surplus[k] -= force * touch->share[k] * touch->input.normal;
      }
    }
  }

  const ContactLaw& law_;
  const bool with_forces_, in_packs_, stores_energy_;
  const double loss_;
  const std::span<const MemberPair> pairs_;
  const std::span<const Vec3> position_, velocity_, start_;
  MemberContacts& found_;
  FourPlaces pairs_ahead_, places_;
};

// Of the pairs index(0), index(1), ...
template <class Index>
void find_contacts_of(std::size_t count, Index index, const ContactLaw& law,
                      std::span<const MemberPair> pairs, std::span<const Vec3> position,
                      std::span<const Vec3> velocity, std::span<const Vec3> start, bool with_forces,
                      MemberContacts& found) {
  found.clear();
  TouchFinder finder(law, pairs, position, velocity, start, with_forces, found);
  const int end = static_cast<int>(count);
  for (int k = 0; k < end; ++k)
    if (pairs[index(k)].panel == nullptr) finder.look_at(index(k));
  finder.end();
  for (int k = 0; k < end; ++k)
    if (pairs[index(k)].panel != nullptr)
      find_panel_touches(law, pairs, index(k), position, velocity, start, found);
}

}  // namespace

void find_member_contacts(const ContactLaw& law, std::span<const MemberPair> pairs,
                          std::span<const Vec3> position, std::span<const Vec3> velocity,
                          std::span<const Vec3> start, MemberContacts& found) {
  const auto all = [](int k) { return k; };
  find_contacts_of(pairs.size(), all, law, pairs, position, velocity, start, true, found);
}

void find_member_contacts(const ContactLaw& law, std::span<const MemberPair> pairs,
                          std::span<const int> which, std::span<const Vec3> position,
                          std::span<const Vec3> velocity, std::span<const Vec3> start, bool with_forces,
                          MemberContacts& found) {
  find_contacts_of(
      which.size(), [&](int k) { return which[k]; }, law, pairs, position, velocity, start, with_forces,
      found);
}

}  // namespace topple
