// Derivatives of the forces that BodyContacts presses with.
#include <span>
#include <type_traits>
#include <utility>

#include "solver/body/body_contacts.h"

namespace topple {
namespace {

// Sums of slopes  lead n n^T - across I  of points in one plane; with the arm r and m = r x n:
//   force by angular velocity  lead n m^T + across [r],  moment by it  lead m m^T + across (r r^T - r^2 I)
class PlaneSlope {
 public:
  template <class Normal>
  [[gnu::always_inline]] void add(Four lead, Four across, const Normal& n, const PackVector<Four>& r) {
    const auto m = cross(r, n), lead_m = lead * m;
    const PackVector<Four> across_r = across * r;
    lead_ += lead;
    across_ += across;
    across_r_ = across_r_ + across_r;
    square_ = mul_add(across_r.z, r.z, mul_add(across_r.y, r.y, mul_add(across_r.x, r.x, square_)));
    const auto both = [&](Four mi, Four mj, Four ri, Four rj, Four sum) {
      return mul_add(mi, mj, mul_add(ri, rj, sum));
    };
    lead_m_.x += lead_m.x;
    lead_m_.y += lead_m.y;
    xx_ = both(lead_m.x, m.x, across_r.x, r.x, xx_);
    yy_ = both(lead_m.y, m.y, across_r.y, r.y, yy_);
    xy_ = both(lead_m.x, m.y, across_r.x, r.y, xy_);
    if constexpr (std::is_same_v<Normal, Upwards>) {
      zz_ = mul_add(across_r.z, r.z, zz_);
      xz_ = mul_add(across_r.x, r.z, xz_);
      yz_ = mul_add(across_r.y, r.z, yz_);
    } else {
      lead_m_.z += lead_m.z;
      zz_ = both(lead_m.z, m.z, across_r.z, r.z, zz_);
      xz_ = both(lead_m.x, m.z, across_r.x, r.z, xz_);
      yz_ = both(lead_m.y, m.z, across_r.y, r.z, yz_);
    }
  }
  [[gnu::always_inline]] ContactSlope total(const PackVec3& n) const {
    const Four by_n = sums(lead_, lead_m_.x, lead_m_.y, lead_m_.z),
               by_r = sums(across_, across_r_.x, across_r_.y, across_r_.z),
               diagonals = sums(xx_, yy_, zz_, square_), others = sums(xy_, xz_, yz_, Four(0));
    const double a = by_r[0], xx = diagonals[0] - diagonals[3], yy = diagonals[1] - diagonals[3],
                 zz = diagonals[2] - diagonals[3], xy = others[0], xz = others[1], yz = others[2];
    const PackMat3 turned =
        outer(n, PackVec3{by_n[1], by_n[2], by_n[3]}) + skew(PackVec3{by_r[1], by_r[2], by_r[3]});
    return {outer(by_n[0] * n, n) - diagonal(PackVec3{a, a, a}), turned, transposed(turned),
            PackMat3{{{xx, xy, xz}, {xy, yy, yz}, {xz, yz, zz}}}};
  }

 private:
  Four lead_{0}, across_{0}, square_{0}, xx_{0}, yy_{0}, zz_{0}, xy_{0}, xz_{0}, yz_{0};
  PackVector<Four> lead_m_ = in_all_lanes(Vec3::Zero()), across_r_ = lead_m_;
};

}  // namespace

template <class F>
[[gnu::always_inline]] inline ContactSlope BodyContacts::sum_slopes(F nn_and_identity) const {
  const std::span<const Touch> all = now_.list();
  auto touch = all.begin();
  const auto of_next_plane = [&] {
    const int plane = touch->plane;
    return with_normal(*touch, [&](const auto& n) {
      PlaneSlope sum;
      for (; touch != all.end() && touch->plane == plane; ++touch) {
        const auto [lead, across] = nn_and_identity(*touch);
        sum.add(lead, across, n, touch->arm);
      }
      return sum.total(packed(model_.planes[plane].normal));
    });
  };
  if (all.empty()) return {};
  ContactSlope total = of_next_plane();
  while (touch != all.end()) {
    const ContactSlope more = of_next_plane();
    total.force_linear = total.force_linear + more.force_linear;
    total.force_angular = total.force_angular + more.force_angular;
    total.moment_linear = total.moment_linear + more.moment_linear;
    total.moment_angular = total.moment_angular + more.moment_angular;
  }
  return total;
}

ContactSlope BodyContacts::slope() const {
  ContactSlope total =
      sum_slopes([](const Touch& touch) { return std::pair(touch.tangent_nn, touch.tangent_identity); });
  for (const Touch& touch : now_.list()) {
    if (!touch.has_tangent_rest) continue;
    const PackMatrix<Four> turned = times_skew(touch.tangent_rest, touch.arm);
    total.force_linear = total.force_linear + sum(touch.tangent_rest);
    total.force_angular = total.force_angular - sum(turned);
    total.moment_linear = total.moment_linear + sum(skew_times(touch.arm, touch.tangent_rest));
    total.moment_angular = total.moment_angular - sum(skew_times(touch.arm, turned));
  }
  return total;
}

ContactSlope BodyContacts::stick_slope() const {
  return sum_slopes([](const Touch& touch) { return std::pair(touch.drag, touch.drag); });
}

PackMatrix<Four> BodyContacts::slope(const Touch& touch) const {
  const Points n = normal(touch);
  const PackMatrix<Four> plain =
      outer(touch.tangent_nn * n, n) -
      diagonal(Points{touch.tangent_identity, touch.tangent_identity, touch.tangent_identity});
  return touch.has_tangent_rest ? plain + touch.tangent_rest : plain;
}

Mat3 BodyContacts::slope(const Touch& touch, int lane) const {
  const PackMatrix<Four> all = slope(touch);
  Mat3 one;
  for (int row = 0; row < 3; ++row) one.row(row) = topple::lane(all.row[row], lane);
  return one;
}

void BodyContacts::add_slope_of_modes(double factor, int m, ModeMatrix& matrix) const {
  Four left[k_modes][6], top[6][k_modes], corner[k_modes][k_modes];
  for (int k = 0; k < m; ++k) {
    for (int i = 0; i < 6; ++i) left[k][i] = top[i][k] = Four(0);
    for (int j = 0; j < m; ++j) corner[k][j] = Four(0);
  }
  const Points* shape = shapes_.data();
  for (const Touch& touch : now_.list()) {
    const PackMatrix<Four> by_velocity = slope(touch);
    for (int k = 0; k < m; ++k) {
      const Points f = by_velocity * shape[k], moment = cross(touch.arm, f);
      top[0][k] += f.x;
      top[1][k] += f.y;
      top[2][k] += f.z;
      top[3][k] += moment.x;
      top[4][k] += moment.y;
      top[5][k] += moment.z;
      for (int j = 0; j < m; ++j) corner[j][k] += dot(shape[j], f);
      // the transpose's product: forces of the rigid columns on this mode
      const Points b = transposed_times(by_velocity, shape[k]), turned = cross(touch.arm, b);
      left[k][0] += b.x;
      left[k][1] += b.y;
      left[k][2] += b.z;
      left[k][3] += turned.x;
      left[k][4] += turned.y;
      left[k][5] += turned.z;
    }
    shape += m;
  }
  for (int k = 0; k < m; ++k) {
    for (int i = 0; i < 6; ++i) {
      matrix[i][6 + k] += factor * sum(top[i][k]);
      matrix[6 + k][i] += factor * sum(left[k][i]);
    }
    for (int j = 0; j < m; ++j) matrix[6 + k][6 + j] += factor * sum(corner[k][j]);
  }
}

}  // namespace topple
