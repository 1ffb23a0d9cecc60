// Derivatives of the forces of BodyContacts.
#include <span>
#include <type_traits>
#include <utility>

#include "solver/reduced/body_contacts.h"

namespace topple {
namespace {

// Sums of slopes  nn n n^T - identity I  of points in one plane; with the arm r and m = r x n:
//   force by angular velocity  nn n m^T + identity [r],  moment by it  nn m m^T + identity (r r^T - r^2 I)
class PlaneSlope {
 public:
  template <class Normal>
  [[gnu::always_inline]] void add(Four nn, Four identity, const Normal& n, const PackVector<Four>& r) {
    const auto m = cross(r, n), nn_m = nn * m;
    const PackVector<Four> identity_r = identity * r;
    nn_ += nn;
    identity_ += identity;
    identity_r_ = identity_r_ + identity_r;
    square_ = mul_add(identity_r.z, r.z, mul_add(identity_r.y, r.y, mul_add(identity_r.x, r.x, square_)));
    const auto both = [&](Four mi, Four mj, Four ri, Four rj, Four sum) {
      return mul_add(mi, mj, mul_add(ri, rj, sum));
    };
    nn_m_.x += nn_m.x;
    nn_m_.y += nn_m.y;
    xx_ = both(nn_m.x, m.x, identity_r.x, r.x, xx_);
    yy_ = both(nn_m.y, m.y, identity_r.y, r.y, yy_);
    xy_ = both(nn_m.x, m.y, identity_r.x, r.y, xy_);
    if constexpr (std::is_same_v<Normal, Upwards>) {
      zz_ = mul_add(identity_r.z, r.z, zz_);
      xz_ = mul_add(identity_r.x, r.z, xz_);
      yz_ = mul_add(identity_r.y, r.z, yz_);
    } else {
      nn_m_.z += nn_m.z;
      zz_ = both(nn_m.z, m.z, identity_r.z, r.z, zz_);
      xz_ = both(nn_m.x, m.z, identity_r.x, r.z, xz_);
      yz_ = both(nn_m.y, m.z, identity_r.y, r.z, yz_);
    }
  }
  [[gnu::always_inline]] ContactSlope total(const PackVec3& n) const {
    const Four by_n = sums(nn_, nn_m_.x, nn_m_.y, nn_m_.z),
               by_r = sums(identity_, identity_r_.x, identity_r_.y, identity_r_.z),
               diagonals = sums(xx_, yy_, zz_, square_), others = sums(xy_, xz_, yz_, Four(0));
    const double a = by_r[0], xx = diagonals[0] - diagonals[3], yy = diagonals[1] - diagonals[3],
                 zz = diagonals[2] - diagonals[3], xy = others[0], xz = others[1], yz = others[2];
    const PackMat3 turned =
        outer(n, PackVec3{by_n[1], by_n[2], by_n[3]}) + skew(PackVec3{by_r[1], by_r[2], by_r[3]});
    return {outer(by_n[0] * n, n) - diagonal(PackVec3{a, a, a}), turned, transposed(turned),
            PackMat3{{{xx, xy, xz}, {xy, yy, yz}, {xz, yz, zz}}}};
  }

 private:
  Four nn_{0}, identity_{0}, square_{0}, xx_{0}, yy_{0}, zz_{0}, xy_{0}, xz_{0}, yz_{0};
  PackVector<Four> nn_m_ = in_all_lanes(Vec3::Zero()), identity_r_ = nn_m_;
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
        const auto [nn, identity] = nn_and_identity(*touch);
        sum.add(nn, identity, n, touch->arm);
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

// slope_of(touch): derivative of the force by the velocity.
template <class F>
void BodyContacts::add_modes(double factor, int m, ModeMatrix& matrix, F slope_of) const {
  Four left[k_modes][6], top[6][k_modes], corner[k_modes][k_modes];
  for (int k = 0; k < m; ++k) {
    for (int i = 0; i < 6; ++i) left[k][i] = top[i][k] = Four(0);
    for (int j = 0; j < m; ++j) corner[k][j] = Four(0);
  }
  const Points* shape = shapes_.data();
  for (const Touch& touch : now_.list()) {
    const PackMatrix<Four> by_velocity = slope_of(touch);
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

PackMatrix<Four> BodyContacts::stick_slope(const Touch& touch) const {
  const Points n = normal(touch);
  return outer(touch.drag * n, n) - diagonal(Points{touch.drag, touch.drag, touch.drag});
}

void BodyContacts::add_slope_of_modes(double factor, int m, ModeMatrix& matrix) const {
  add_modes(factor, m, matrix, [this](const Touch& touch) { return slope(touch); });
}

void BodyContacts::add_stick_slope_of_modes(double factor, int m, ModeMatrix& matrix) const {
  add_modes(factor, m, matrix, [this](const Touch& touch) { return stick_slope(touch); });
}

}  // namespace topple
