// Which tips touch panels, and with what forces.
#include <algorithm>
#include <cmath>

#include "solver/contact/member_contact.h"
#include "solver/contact/panel_place.h"

namespace topple {
namespace {

constexpr double k_reach = 0.5;  // of L, from the members in a panel: where it carries all

std::array<Vec3, 4> corners(const PairVector& x) {
  return {x[2], x[3], x[4], x[5]};
}

// 1 or -1: on which side of the panel the tip was where the step began.
double side_at_start(const MemberPair& pair, int end) {
  const PanelPlace at = panel_place(pair.start[end], corners(pair.start));
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

}  // namespace

void find_panel_touches(const ContactLaw& law, std::span<const MemberPair> pairs, int index,
                        std::span<const Vec3> position, std::span<const Vec3> velocity,
                        std::span<const Vec3> start, bool with_forces, MemberContacts& found) {
  const MemberPair& pair = pairs[index];
  const PairVector x = gather(pair, position);
  double moved = 0;
  for (int k = 2; k < 6; ++k) moved = std::max(moved, (x[k] - pair.start[k]).squaredNorm());
  for (int end = 0; end < 2; ++end) {
    if (!pair.tip[end]) continue;
    const double approach2 = 2 * (moved + (x[end] - pair.start[end]).squaredNorm());
    if (is_beyond(pair, approach2)) continue;
    const PanelPlace at = panel_place(x[end], corners(x));
    const double square = at.between.squaredNorm(), reach = pair.L + pair.ahead;
    if (!(square < reach * reach) || !at.within()) continue;
    const PanelShare share = panel_share(*pair.panel, at, k_reach * pair.L);
    if (!(share.share > 0)) continue;
    MemberTouch touch;
    touch.pair = index;
    touch.place = 1 + end;
    touch.share[end] = 1;
    for (int k = 0; k < 4; ++k) touch.share[2 + k] = -at.share[k];
    touch.weight = law.member_share * share.share;
    touch.s = end;
    touch.t = at.r[0];
    touch.u = at.r[1];
    touch.s_free = touch.t_free = false;
    ContactInput& in = touch.input;
    in.normal = at.normal();
    touch.l = at.between.dot(in.normal);
    // a tip that has come no nearer than its distance has not passed the sheet
    const double side = square > approach2 ? std::copysign(1., touch.l) : side_at_start(pair, end);
    in.normal *= side;
    touch.l *= side;
    in.depth = 1 - touch.l / pair.L;
    in.L = pair.L;
    in.velocity = relative(touch, pair, velocity);
    in.stick = pair.stick[touch.place] + relative(touch, pair, position) - relative(touch, pair, start);
    in.mass = pair.mass;
    in.between_members = true;
    if (with_forces) touch.out = contact_force(weighted(law, touch), in);
    if (!(square < pair.L * pair.L)) {
      found.ahead.push_back(touch);
      continue;
    }
    found.touches.push_back(touch);
    if (!(share.share < 1) || !traits(law).stores_energy) continue;
    found.blends.push_back(blend_of(law, touch, pair, at, share));
    found.blends.back().touch = static_cast<int>(found.touches.size()) - 1;
  }
}

}  // namespace topple
