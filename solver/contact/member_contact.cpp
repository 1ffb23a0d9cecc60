#include "solver/contact/member_contact.h"

#include <algorithm>
#include <cmath>

#include "solver/contact/coulomb.h"
#include "solver/contact/panel_place.h"

namespace topple {
namespace {

// How the moving of the nearest points changes the tangent: mixed derivatives of half the squared distance by
// the nodes and the free ones of s, t, times `factor` and the inverse of the second derivatives by the
// latter, times the same.
void add_sliding(const MemberTouch& touch, const PairVector& x, double factor, PairTangent& tangent) {
  const Vec3 da = x[1] - x[0], db = x[3] - x[2], d = touch.l * touch.input.normal;
  PairVector by_s, by_t;
  for (int k = 0; k < 6; ++k) {
    by_s[k] = touch.share[k] * da;
    by_t[k] = -touch.share[k] * db;
  }
  by_s[0] -= d;
  by_s[1] += d;
  by_t[2] += d;
  by_t[3] -= d;
  double ss = touch.s_free ? da.squaredNorm() : 1, tt = touch.t_free ? db.squaredNorm() : 1,
         st = touch.s_free && touch.t_free ? -da.dot(db) : 0;
  const double determinant = ss * tt - st * st;
  const auto add = [&](const PairVector& left, double of_s, double of_t) {
    PairTangent::Product& product = tangent.products[tangent.product_count++];
    product.left = left;
    for (int k = 0; k < 6; ++k) product.right[k] = factor / determinant * (of_s * by_s[k] + of_t * by_t[k]);
  };
  if (touch.s_free) add(by_s, tt, -st);
  if (touch.t_free) add(by_t, -st, ss);
}

// How the turning and bending of a panel under a tip change the tangent: by D and C, which say how the foot
// moves and its normal n turns with the nodes,  sum_m (D_m C_m^T + C_m D_m^T),
//   C_m = N'_m n,  D_m = sum_o H^-1_mo (share F_o + l/2 C_o).
void add_turning_panel(const MemberTouch& touch, const PairVector& x, double force, PairTangent& tangent) {
  const Vec3& n = touch.input.normal;
  const PanelPlace at = panel_place(x[touch.place - 1], {x[2], x[3], x[4], x[5]});
  const Eigen::Matrix2d inverse = at.inverse();
  std::array<PairVector, 2> along, turn;
  for (int m = 0; m < 2; ++m)
    for (int k = 0; k < 6; ++k) {
      turn[m][k] = k < 2 ? Vec3::Zero() : Vec3(at.change[k - 2][m] * n);
      along[m][k] = touch.share[k] * at.along[m] + touch.l / 2 * turn[m][k];
    }
  for (int m = 0; m < 2; ++m) {
    PairVector moved;
    for (int k = 0; k < 6; ++k)
      moved[k] = force * (inverse(m, 0) * along[0][k] + inverse(m, 1) * along[1][k]);
    tangent.products[tangent.product_count++] = {moved, turn[m]};
    tangent.products[tangent.product_count++] = {turn[m], moved};
  }
}

bool slips(const ContactLaw& law, const MemberTouch& touch) {
  constexpr double k_rounding = 1e-9;
  const Vec3& v = touch.input.velocity;
  const double along = (v - touch.input.normal.dot(v) * touch.input.normal).squaredNorm();
  return !(touch.out.tangential.norm() <
           (1 - k_rounding) * friction_coefficient(law, along) * touch.out.normal);
}

}  // namespace

NearestShares nearest_shares(const MemberPair& pair, const PairVector& x) {
  NearestShares found;
  if (pair.panel == nullptr) {
    const NearestPoints at = nearest_points(x[0], x[1], x[2], x[3]);
    found.count = 1;
    found.at[0] = {{1 - at.s, at.s, at.t - 1, -at.t}, at.between, at.between.norm() - pair.L};
    return found;
  }
  found.count = 0;
  for (int end = 0; end < 2; ++end) {
    if (!pair.tip[end]) continue;
    const NearestOnPanel on = nearest_on_panel(x[end], {x[2], x[3], x[4], x[5]});
    NearestShares::At& at = found.at[found.count++];
    at = {{}, on.between, on.between.norm() - pair.L};
    at.share[end] = 1;
    for (int k = 0; k < 4; ++k) at.share[2 + k] = -on.share[k];
  }
  return found;
}

double nearest_gap(const MemberPair& pair, const PairVector& x) {
  const NearestShares near = nearest_shares(pair, x);
  return near.count == 1 ? near.at[0].gap : std::min(near.at[0].gap, near.at[1].gap);
}

Vec3 relative(const MemberTouch& touch, const MemberPair& pair, std::span<const Vec3> x) {
  Vec3 sum = Vec3::Zero();
  for (int k = 0; k < pair.nodes(); ++k) sum += touch.share[k] * x[pair.node[k]];
  return sum;
}

void add_forces(const MemberContacts& contacts, std::span<const MemberPair> pairs, std::span<Vec3> force) {
  for (const MemberTouch& touch : contacts.touches) {
    const MemberPair& pair = pairs[touch.pair];
    for (int k = 0; k < pair.nodes(); ++k) force[pair.node[k]] += touch.share[k] * touch.out.force;
  }
  for (const MemberBlend& blend : contacts.blends) {
    const MemberPair& pair = pairs[blend.pair];
    for (int k = 0; k < pair.nodes(); ++k)
      force[pair.node[k]] -= blend.slope * blend.surplus * blend.by_sine[k];
  }
}

PairTangent touch_tangent(const ContactLaw& law, const MemberTouch& touch, const MemberPair& pair,
                          std::span<const Vec3> position, double velocity_factor) {
  PairTangent tangent;
  tangent.pair = touch.pair;
  tangent.share = touch.share;
  tangent.product_count = 0;
  Mat3 by_position, by_velocity;
  contact_force(weighted(law, touch), touch.input, by_position, by_velocity);
  tangent.local = -by_position - velocity_factor * by_velocity;
  const Vec3& n = touch.input.normal;
  const Mat3 across = Mat3::Identity() - n * n.transpose();
  tangent.stick.setZero();
  if (traits(law).sticks && !slips(law, touch)) tangent.stick = across * tangent.local * across;
  if (pair.panel != nullptr) {
    add_turning_panel(touch, gather(pair, position), touch.out.normal, tangent);
  } else if (touch.l > k_thin * pair.L) {
    tangent.local -= touch.out.normal / touch.l * across;
    add_sliding(touch, gather(pair, position), touch.out.normal / touch.l, tangent);
  }
  return tangent;
}

PairTangent blend_tangent(const MemberBlend& blend) {
  PairTangent tangent;
  tangent.pair = blend.pair;
  tangent.share.fill(0);
  tangent.local.setZero();
  tangent.stick.setZero();
  tangent.product_count = 2;
  for (int k = 0; k < 6; ++k) {
    tangent.products[0].left[k] = blend.by_sine[k];
    tangent.products[0].right[k] =
        blend.curvature * blend.surplus * blend.by_sine[k] + blend.slope * blend.by_surplus[k];
    tangent.products[1].left[k] = blend.by_surplus[k];
    tangent.products[1].right[k] = blend.slope * blend.by_sine[k];
  }
  return tangent;
}

void add_tangent(const ContactLaw& law, const MemberContacts& contacts, std::span<const MemberPair> pairs,
                 std::span<const Vec3> position, double velocity_factor,
                 const std::function<void(int i, int j, const Mat3& block)>& add) {
  const auto add_all = [&](const PairTangent& tangent) {
    const MemberPair& pair = pairs[tangent.pair];
    for (int k = 0; k < pair.nodes(); ++k)
      for (int m = 0; m < pair.nodes(); ++m) {
        Mat3 block = tangent.share[k] * tangent.share[m] * tangent.local;
        for (int p = 0; p < tangent.product_count; ++p)
          block += tangent.products[p].left[k] * tangent.products[p].right[m].transpose();
        add(pair.node[k], pair.node[m], block);
      }
  };
  for (const MemberTouch& touch : contacts.touches)
    add_all(touch_tangent(law, touch, pairs[touch.pair], position, velocity_factor));
  for (const MemberBlend& blend : contacts.blends) add_all(blend_tangent(blend));
}

void keep_sticks(const ContactLaw& law, MemberContacts& contacts, std::span<MemberPair> pairs) {
  for (MemberPair& pair : pairs) pair.stick.fill(Vec3::Zero());
  for (MemberTouch& touch : contacts.touches) {
    pairs[touch.pair].stick[touch.place] = touch.input.stick = touch.out.stick;
    if (traits(law).sticks && slips(law, touch)) touch.out = contact_force(weighted(law, touch), touch.input);
  }
}

double stored_energy(const ContactLaw& law, const MemberContacts& contacts,
                     std::span<const MemberPair> pairs) {
  double sum = 0;
  for (const MemberTouch& touch : contacts.touches) {
    if (traits(law).stores_energy)
      sum += touch.weight * penalty_energy(law, touch.input.depth, pairs[touch.pair].L, true);
    sum += touch.out.stick_energy;
  }
  return sum;
}

int passed_unseen(const MemberContacts& at_end, std::span<const MemberPair> pairs,
                  std::span<const Vec3> start, std::span<const Vec3> end) {
  for (const MemberTouch& touch : at_end.touches)
    if (!(touch.l > 0)) return touch.pair;
  for (int k = 0; k < static_cast<int>(pairs.size()); ++k)
    if (moved_unseen(pairs[k], start, end)) return k;
  return -1;
}

bool moved_unseen(const MemberPair& pair, std::span<const Vec3> start, std::span<const Vec3> end) {
  const PairVector x0 = gather(pair, start), x1 = gather(pair, end);
  // no relative motion of two places is greater than one of the ends
  double most = 0;
  for (int a = 0; a < 2; ++a)
    for (int b = 2; b < pair.nodes(); ++b)
      most = std::max(most, (x1[a] - x0[a] - x1[b] + x0[b]).squaredNorm());
  if (4 * most <= pair.L * pair.L) return false;
  const NearestShares before = nearest_shares(pair, x0), after = nearest_shares(pair, x1);
  for (int i = 0; i < before.count; ++i) {
    double travel = std::sqrt(most);
    if (pair.panel != nullptr) {  // there the place is known
      Vec3 way = Vec3::Zero();
      for (int n = 0; n < 6; ++n) way += before.at[i].share[n] * (x1[n] - x0[n]);
      travel = way.norm();
    }
    if (travel > pair.L / 2 && std::min(before.at[i].gap, after.at[i].gap) < travel) return true;
  }
  return false;
}

}  // namespace topple
