#include "solver/reduced/rigid_pair_slopes.h"

#include "solver/contact/coulomb.h"
#include "solver/contact/penalty.h"

namespace topple {
namespace {

template <class Blocks>
void set_zero(Blocks& blocks) {
  for (auto& row : blocks)
    for (PackBlock& block : row)
      for (auto& parts : block.part)
        for (PackMatrix<Four>& part : parts)
          for (PackVector<Four>& line : part.row) line = {Four(0), Four(0), Four(0)};
}

void add_to(PackMatrix<Four>& sum, const PackMatrix<Four>& more) {
  sum = sum + more;
}

}  // namespace

RigidPairSlopes::RigidPairSlopes(const ContactLaw& law, std::span<const Vec3> position,
                                 std::span<const Vec3> arm, double velocity_factor)
    : law_(law),
      position_(position),
      arm_(arm),
      scale_(velocity_factor > 0 ? velocity_factor : 1),
      gamma_dt_(1 / scale_),
      loss_(normal_loss(law.restitution)),
      with_velocity_(velocity_factor > 0),
      in_packs_(traits(law).in_packs) {
  begin();
}

void RigidPairSlopes::begin() {
  set_zero(blocks_);
  any_sticks_ = false;
}

void RigidPairSlopes::add(const MemberTouch& touch, const MemberPair& pair) {
  touch_[count_] = &touch;
  pair_[count_] = &pair;
  if (++count_ == 4) add_four();
}

void RigidPairSlopes::end() {
  if (count_ > 0) add_four();
}

Mat6 RigidPairSlopes::sum(const Blocks& blocks, int i, int j) {
  Mat6 out;
  for (int r = 0; r < 2; ++r)
    for (int c = 0; c < 2; ++c)
      out.block<3, 3>(3 * r, 3 * c) = unpacked(topple::sum(blocks[i][j].part[r][c]));
  return out;
}

// J_i^T slope J_j, J = [1, -[arm]] of the first body and the opposite of the second.
void RigidPairSlopes::add_carried(const PackMatrix<Four>& slope, const Points (&arm)[2], Blocks& to) {
  for (int j = 0; j < 2; ++j) {
    const PackMatrix<Four> turned = times_skew(slope, -arm[j]);
    for (int i = 0; i < 2; ++i) {
      const auto add = [&](int r, int c, const PackMatrix<Four>& part) {
        add_to(to[i][j].part[r][c], i == j ? part : -part);
      };
      add(0, 0, slope);
      add(0, 1, turned);
      add(1, 0, skew_times(arm[i], slope));
      add(1, 1, skew_times(arm[i], turned));
    }
  }
}

void RigidPairSlopes::add_product(const Motion& left, const Motion& right, Blocks& to) {
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) {
      auto& part = to[i][j].part;
      add_to(part[0][0], outer(left.linear[i], right.linear[j]));
      add_to(part[0][1], outer(left.linear[i], right.angular[j]));
      add_to(part[1][0], outer(left.angular[i], right.linear[j]));
      add_to(part[1][1], outer(left.angular[i], right.angular[j]));
    }
}

// Of the law alone, where touch_ is.
RigidPairSlopes::Slopes RigidPairSlopes::slopes(const Points& normal, const Four& L) const {
  const auto each = [&](auto of) {
    Four out = Four(0);
    for (int k = 0; k < count_; ++k) out.set(k, of(*touch_[k]));
    return out;
  };
  const auto each_vector = [&](auto of) {
    Points out = in_all_lanes(Vec3::Zero());
    for (int k = 0; k < count_; ++k) set_lane(out, k, of(*touch_[k]));
    return out;
  };
  Slopes out;
  if (!in_packs_) {
    for (auto& row : out.local.row) row = in_all_lanes(Vec3::Zero());
    for (int k = 0; k < count_; ++k) {
      Mat3 by_position, by_velocity;
      contact_force(weighted(law_, *touch_[k]), touch_[k]->input, by_position, by_velocity);
      set_lane(out.local, k, -by_position - (with_velocity_ ? scale_ : 0) * by_velocity);
    }
    out.any_sticks = false;
    return out;
  }
  const Four alpha = law_.alpha * each([](const MemberTouch& of) { return of.weight; });
  const Four depth = each([](const MemberTouch& of) { return of.input.depth; });
  const Four p = each([](const MemberTouch& of) { return of.out.conservative; });
  const Four::Mask touching = Four(0) < depth;
  Four stiffness = choose(touching, alpha / L * penalty_slope(depth, law_.q), Four(0));
  for (int k = 0; k < count_; ++k)
    if (depth[k] > k_hardening_depth)
      stiffness.set(k, alpha[k] / law_.alpha * penalty_stiffness(law_, depth[k], L[k], true));
  const StickSpring<Four> stick(alpha, L, each([](const MemberTouch& of) { return of.input.mass; }));
  const bool weakens = with_velocity_ && law_.excess() > 0;
  const auto f = coulomb_force(law_, loss_, law_.excess() > 0, normal,
                               each_vector([](const MemberTouch& of) { return of.input.velocity; }),
                               each_vector([](const MemberTouch& of) { return of.input.stick; }), touching, p,
                               stick.k, stick.c);
  Four along = -gamma_dt_ * stiffness * f.factor, across = gamma_dt_ * stick.k;
  if (with_velocity_) {
    along += normal_slope(law_, loss_, p, f.inverse);
    across += stick.c;
  }
  across = choose(touching, across * f.scale, Four(0));
  const PackMatrix<Four> square = outer(normal, normal),
                         unit = diagonal(PackVector<Four>{Four(1), Four(1), Four(1)});
  out.local = across * unit - (along + across) * square;
  if (f.slips) out.local = out.local - slip_slope(law_, weakens, f, normal, along, across);
  out.local = Four(scale_) * out.local;
  const Four held = choose(f.sticks, Four(scale_) * across, Four(0));
  out.any_sticks = bits(Four(0) < held) != 0;
  if (out.any_sticks) out.stick = held * (unit - square);
  return out;
}

[[gnu::flatten]] void RigidPairSlopes::add_four() {
  const auto each = [&](auto of) {  // what is not there repeats the first, with no force
    Four out;
    for (int k = 0; k < 4; ++k) out.set(k, of(*touch_[k < count_ ? k : 0]));
    return out;
  };
  const auto at = [&](std::span<const Vec3> x, int end) {
    std::array<int, 4> node;
    for (int k = 0; k < 4; ++k) node[k] = pair_[k < count_ ? k : 0]->node[end];
    return gather(x.data(), node);
  };
  Points normal;
  for (int k = 0; k < 4; ++k) set_lane(normal, k, touch_[k < count_ ? k : 0]->input.normal);
  const Four L = each([](const MemberTouch&of) { return of.input.L; }),
             l = each([](const MemberTouch&of) { return of.l; }),
             s = each([](const MemberTouch&of) { return of.s; }),
             t = each([](const MemberTouch&of) { return of.t; });
  Slopes own = slopes(normal, L);
  const Points a0 = at(arm_, 0), b0 = at(arm_, 2), u = at(position_, 1) - at(position_, 0),
               v = at(position_, 3) - at(position_, 2);
  const Points arm[2] = {mul_add(s, u, a0), mul_add(t, v, b0)};
  if (own.any_sticks) {
    if (!any_sticks_) set_zero(sticks_);
    any_sticks_ = true;
    add_carried(own.stick, arm, sticks_);
  }
  // the turning of the normal, and the nearest points that move along
  Four pull = Four(0);
  for (int k = 0; k < count_; ++k)
    if (l[k] > k_thin * L[k]) pull.set(k, touch_[k]->out.normal / l[k]);
  const PackMatrix<Four> across =
      diagonal(PackVector<Four>{Four(1), Four(1), Four(1)}) - outer(normal, normal);
  own.local = own.local - pull * across;
  add_carried(own.local, arm, blocks_);
  const Four s_free = each([](const MemberTouch&of) { return of.s_free; }),
             t_free = each([](const MemberTouch&of) { return of.t_free; });
  const Points between = l * normal;
  const Motion by_s{{u, -u}, {cross(arm[0] - between, u), -cross(arm[1], u)}};
  const Motion by_t{{-v, v}, {-cross(arm[0], v), cross(arm[1] + between, v)}};
  const Four one = Four(1), ss = choose(s_free == one, dot(u, u), one),
             tt = choose(t_free == one, dot(v, v), one), st = -s_free * t_free * dot(u, v),
             factor = pull / (ss * tt - st * st);
  const auto mixed = [](Four f, const Motion& x, Four g, const Motion& y) {
    Motion out;
    for (int i = 0; i < 2; ++i) {
      out.linear[i] = f * x.linear[i] + g * y.linear[i];
      out.angular[i] = f * x.angular[i] + g * y.angular[i];
    }
    return out;
  };
  add_product(by_s, mixed(s_free * factor * tt, by_s, -factor * st, by_t), blocks_);
  add_product(by_t, mixed(-factor * st, by_s, t_free * factor * ss, by_t), blocks_);
  count_ = 0;
}

void RigidPairSlopes::add_blend(const PairTangent& blend, const MemberPair& pair) {
  const auto motion = [&](const PairVector& at_ends) {
    Motion out;
    for (int side = 0; side < 2; ++side) {
      Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
      for (int k = side == 0 ? 0 : 2; k < (side == 0 ? 2 : pair.nodes()); ++k) {
        linear += at_ends[k];
        angular += arm_[pair.node[k]].cross(at_ends[k]);
      }
      out.linear[side] = out.angular[side] = in_all_lanes(Vec3::Zero());
      set_lane(out.linear[side], 0, linear);
      set_lane(out.angular[side], 0, angular);
    }
    return out;
  };
  for (int p = 0; p < blend.product_count; ++p)
    add_product(motion(blend.products[p].left), motion(blend.products[p].right), blocks_);
}

}  // namespace topple
