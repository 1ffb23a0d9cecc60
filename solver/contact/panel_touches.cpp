// Which tips touch panels, and with what forces.
#include <algorithm>
#include <cmath>

#include "solver/contact/member_contact.h"
#include "solver/contact/panel_place.h"
#include "solver/math/pack.h"

namespace topple {
namespace {

constexpr double k_reach = 0.5;  // of L, from the members in a panel: where it carries all

std::array<Vec3, 4> corners(const PairVector& x) {
  return {x[2], x[3], x[4], x[5]};
}

// 1 or -1: on which side of the panel the tip was where the step began.
double side_at_start(const PairVector& start, int end) {
  const PanelPlace at = panel_place(start[end], corners(start));
  return at.between.dot(at.normal()) < 0 ? -1 : 1;
}

// -U dw/dx.
MemberBlend blend_of(const ContactLaw& law, const MemberTouch& touch, const MemberPair& pair,
                     const PanelPlace& at, const PanelShare& share) {
  MemberBlend blend;
  blend.pair = touch.pair;
  blend.slope = law.member_share;
  blend.curvature = 0;
  blend.surplus = penalty_energy(law, touch.input.depth, pair.L, true);
  const double force = penalty_force(law, touch.input.depth, true);
  const Eigen::Vector2d by_place = at.inverse() * Eigen::Vector2d(share.change[0], share.change[1]);
  for (int k = 0; k < 6; ++k) {
    Vec3& by = blend.by_sine[k];
    by.setZero();
    for (int m = 0; m < 2; ++m) {
      by += by_place[m] * touch.share[k] * at.along[m];
      if (k > 1) by += by_place[m] * at.change[k - 2][m] * at.between;
    }
    blend.by_surplus[k] = -force * touch.share[k] * touch.input.normal;
  }
  return blend;
}

class TipFinder {
 public:
  TipFinder(const ContactLaw& law, std::span<const MemberPair> pairs, std::span<const Vec3> position,
            std::span<const Vec3> velocity, std::span<const Vec3> start, bool with_forces, bool merged,
            MemberContacts& found)
      : law_(law),
        pairs_(pairs),
        position_(position),
        velocity_(velocity),
        start_(start),
        with_forces_(with_forces),
        merged_(merged),
        found_(found) {}

  void look_at(int index) {
    for (int end = 0; end < 2; ++end) {
      if (!pairs_[index].tip[end]) continue;
      ahead_[count_++] = {index, end};
      if (count_ == 4) look();
    }
  }
  // Those ahead of which the tip may be over its panel and near enough, by a rounding or two.
  void look() {
    constexpr double k_rounding = 1e-9;  // of the sides
    if (count_ == 0) return;
    std::array<std::array<int, 4>, 5> node;  // of the tips and corners
    Four reach;
    for (int k = 0; k < 4; ++k) {
      const auto [index, end] = ahead_[k < count_ ? k : 0];
      const MemberPair& pair = pairs_[index];
      node[0][k] = pair.node[end];
      for (int corner = 0; corner < 4; ++corner) node[1 + corner][k] = pair.node[2 + corner];
      reach.set(k, pair.L + pair.ahead);
    }
    const auto at = [&](int i) { return gather(position_.data(), node[i]); };
    const PackVector<Four> origin = at(1), a = at(2) - origin, b = at(4) - origin, p = at(0) - origin,
                           twist = at(3) - origin - a - b;
    const Four aa = dot(a, a), bb = dot(b, b), ab = dot(a, b), pa = dot(p, a), pb = dot(p, b);
    const Four inverse = Four(1) / (aa * bb - ab * ab), u = inverse * (bb * pa - ab * pb),
               v = inverse * (aa * pb - ab * pa);
    const PackVector<Four> between = p - u * a - v * b;
    const Four least(-k_rounding), most(1 + k_rounding);
    const auto near =
        (least < u) & (u < most) & (least < v) & (v < most) & (dot(between, between) < most * reach * reach);
    const auto straight = dot(twist, twist) < Four(k_rounding * k_rounding) * (aa + bb);
    const unsigned may_touch = bits(near | ~straight);
    for (int k = 0; k < count_; ++k)
      if (may_touch >> k & 1) touch(ahead_[k].index, ahead_[k].end);
    count_ = 0;
  }

 private:
  void touch(int index, int end) {
    const MemberPair& pair = pairs_[index];
    const PairVector x = topple::gather(pair, position_);
    double approach2 = pair.way * pair.way;
    if (!merged_) {
      double moved = 0;
      for (int k = 2; k < 6; ++k) moved = std::max(moved, (x[k] - pair.start[k]).squaredNorm());
      approach2 = 2 * (moved + (x[end] - pair.start[end]).squaredNorm());
      if (is_beyond(pair, approach2)) return;
    }
    const PanelPlace at = panel_place(x[end], corners(x));
    const double square = at.between.squaredNorm(), reach = pair.L + pair.ahead;
    if (!(square < reach * reach) || !at.within()) return;
    const PanelShare share = panel_share(*pair.panel, at, k_reach * pair.L);
    if (!(share.share > 0)) return;
    MemberTouch touch;
    touch.pair = index;
    touch.place = 1 + end;
    touch.share[end] = 1;
    for (int k = 0; k < 4; ++k) touch.share[2 + k] = -at.share[k];
    touch.weight = law_.member_share * share.share;
    touch.s = end;
    touch.t = at.r[0];
    touch.u = at.r[1];
    touch.s_free = touch.t_free = false;
    ContactInput& in = touch.input;
    in.normal = at.normal();
    touch.l = at.between.dot(in.normal);
    // a tip that has come no nearer than its distance has not passed the sheet
    const double side = square > approach2
                            ? std::copysign(1., touch.l)
                            : side_at_start(merged_ ? topple::gather(pair, start_) : pair.start, end);
    in.normal *= side;
    touch.l *= side;
    in.depth = 1 - touch.l / pair.L;
    in.L = pair.L;
    in.velocity = relative(touch, pair, velocity_);
    in.stick = pair.stick[touch.place] + relative(touch, pair, position_) - relative(touch, pair, start_);
    in.mass = pair.mass;
    in.between_members = true;
    if (with_forces_) touch.out = contact_force(weighted(law_, touch), in);
    if (!(square < pair.L * pair.L)) {
      found_.ahead.push_back(touch);
      return;
    }
    found_.touches.push_back(touch);
    if (!(share.share < 1) || !traits(law_).stores_energy) return;
    found_.blends.push_back(blend_of(law_, touch, pair, at, share));
    found_.blends.back().touch = static_cast<int>(found_.touches.size()) - 1;
  }

  struct Tip {
    int index, end;
  };
  const ContactLaw& law_;
  const std::span<const MemberPair> pairs_;
  const std::span<const Vec3> position_, velocity_, start_;
  const bool with_forces_, merged_;
  MemberContacts& found_;
  std::array<Tip, 4> ahead_;
  int count_ = 0;
};

}  // namespace

void find_panel_touches(const ContactLaw& law, std::span<const MemberPair> pairs, PairList list,
                        std::span<const Vec3> position, std::span<const Vec3> velocity,
                        std::span<const Vec3> start, bool with_forces, bool merged, MemberContacts& found) {
  TipFinder finder(law, pairs, position, velocity, start, with_forces, merged, found);
  for (int k = 0; k < list.count; ++k)
    if (pairs[list[k]].panel != nullptr) finder.look_at(list[k]);
  finder.look();
}

}  // namespace topple
