#include "solver/reduced/bodies_at_rest.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

#include "solver/contact/contact_law.h"
#include "solver/frame/find_rest.h"
#include "solver/math/ranges.h"
#include "solver/math/rotation.h"
#include "solver/reduced/elastic_basis.h"

namespace topple {
namespace {

constexpr double k_beyond_touch = 1e-6;  // of the size
constexpr double k_most = 1e-3;          // of the size, a step

Parameters without_ramp(Parameters parameters) {
  parameters.contact_ramp = {};
  return parameters;
}

// On its way to rest a body may meet walls with forces that it will not have there, and is not to slide by
// them.
Parameters with_more_friction(Parameters parameters) {
  constexpr double k_more = 10;
  parameters.contact.friction *= k_more;
  parameters.contact.friction_static *= k_more;
  return parameters;
}

}  // namespace

// Of find_rest, on the normal forces of Eq. 2 with stick springs. Unknowns of a body stand in groups of six:
// rigid motion, then modes, filled up with ones that do nothing.
class RestOfBodies {
 public:
  RestOfBodies(std::span<const ModelBody> bodies, MemberCoupling* coupling, const Parameters& parameters,
               State& state)
      : size(0),
        balanced(0),
        bodies_(bodies),
        coupling_(coupling),
        with_own_friction_(without_ramp(at_rest(parameters))),
        still_(with_more_friction(with_own_friction_)),
        now_(still_, 0),
        state_(state),
        buffers_(bodies.size()),
        matrix_(0, {}) {
    const double rounding = 8 * std::numeric_limits<double>::epsilon(),
                 stiffest = now_.law.alpha * std::max(now_.law.q, k_stick_stiffness);
    std::vector<std::pair<int, int>> coupled;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      ReducedBody& body = *bodies[b].body;
      BodyState& s = state.bodies[bodies[b].index];
      leases_.emplace_back(body.contacts_, buffers_[b]);
      s.velocity.setZero();
      s.angular_velocity.setZero();
      s.rate.setZero();
      origin_.push_back(s.position);
      size = std::max(size, body.reach_);
      const double far = rounding * (body.reach_ + s.position.norm());
      // rounding of the coordinates moves the forces of the springs
      balanced += k_balance * body.mass_ * parameters.gravity.norm();
      balanced += far * stiffest * body.contacts_.pairs() / body.contacts_.least_length();
      balanced += far * body.anchors_.greatest_stiffness();
      for (int i = 0; i < MemberCoupling::groups(body.modes(s)); ++i)
        for (int j = 0; j < i; ++j) coupled.emplace_back(rows_ + i, rows_ + j);
      row_.push_back(rows_);
      rows_ += MemberCoupling::groups(body.modes(s));
    }
    before_.resize(bodies.size());
    if (coupling) {
      for (const MemberPair& pair : coupling->pairs()) {
        const auto [a, b] = coupling->bodies_of(pair);
        balanced += rounding * (size + origin_[std::max(a, b)].norm()) * stiffest / pair.L;
        for (int i = 0; a >= 0 && b >= 0 && i < groups(a); ++i)
          for (int j = 0; j < groups(b); ++j) coupled.emplace_back(row_[a] + i, row_[b] + j);
      }
      coupling->ties().each_in_place([&](int a, int b) {
        balanced += rounding * (size + origin_[a].norm()) * coupling->ties().greatest_stiffness();
        for (int i = 0; i < groups(a); ++i)
          for (int j = 0; j < groups(b); ++j) coupled.emplace_back(row_[a] + i, row_[b] + j);
      });
    }
    matrix_ = BlockLu(rows_, coupled);
    load_.resize(6 * rows_);
  }

  double unbalance() {
    parts_.clear();
    ranges::fill(load_, 0.);
    place();
    const std::vector<BodyVelocity>* loads = nullptr;
    if (coupling_) {
      find_member_contacts(now_.law, coupling_->pairs(), coupling_->position(), coupling_->velocity(),
                           coupling_->position(), touching_);
      loads = &coupling_->loads(touching_, coupling_->pairs());
    }
    double left = 0;
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      BodyState& s = at(b);
      bodies_[b].body->balance(still_, now_, s, state_.stick);
      if (loads) add_load((*loads)[b], s);
      left = std::max(left, add_body(b));
    }
    if (coupling_)
      coupling_->each_block(now_.law, touching_, coupling_->pairs(), 0,
                            [&](int a, int i, int b, int j, const Mat6& block, const Mat6&) {
                              parts_.push_back({row_[a] + i, row_[b] + j, block});
                            });
    return left;
  }

  // A balance that tips over by itself: Newton finds it as readily as a stable one.
  Balance look() {
    if (more_friction_) {
      more_friction_ = false;
      still_ = with_own_friction_;
      now_ = StepInputs(still_, 0);
      for (std::size_t b = 0; b < bodies_.size(); ++b) hold_splay(b);
      if (!(unbalance() < balanced)) return Balance::not_final;
    }
    matrix_.set_zero();
    for (const Part& part : parts_) {
      matrix_.add(part.row, part.column, Mat6(part.stiffness / 2));
      matrix_.add(part.column, part.row, Mat6(part.stiffness.transpose() / 2));
    }
    add_inertia(1e-3 * still_.gravity.norm() / size);
    return matrix_.factor(true) < 0 && matrix_.negative() == 0 ? Balance::rest : Balance::tips_over;
  }

  std::optional<RestStep> step(double sigma) {
    matrix_.set_zero();
    for (const Part& part : parts_) matrix_.add(part.row, part.column, part.stiffness);
    add_inertia(1 / (sigma * sigma));
    if (matrix_.factor() >= 0) return std::nullopt;
    matrix_.solve(load_.data());
    RestStep out{0, 0};
    const auto length_of = [&](std::size_t b) {
      const double* const x = &load_[6 * row_[b]];
      return Vec3(x).norm() + bodies_[b].body->reach_ * Vec3(x + 3).norm();
    };
    for (std::size_t b = 0; b < bodies_.size(); ++b) out.length = std::max(out.length, length_of(b));
    if (!std::isfinite(out.length)) return std::nullopt;
    const double part = part_to_touch(k_beyond_touch * size / out.length);
    out.length *= part;
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      const double* const x = &load_[6 * row_[b]];
      BodyState& s = at(b);
      before_[b] = s;
      s.position += part * Vec3(x);
      s.rotation = (exp_quaternion(part * Vec3(x + 3)) * s.rotation).normalized();
      for (int k = 0; k < modes(b); ++k) s.amplitude[k] += part * x[6 + k];
      const double travel = (s.position - origin_[b]).norm() + part * length_of(b);
      if (travel <= out.furthest) continue;
      out.furthest = travel;
      furthest = bodies_[b].index;
    }
    if (!std::isfinite(out.furthest)) return std::nullopt;
    return out;
  }

  void follow() {
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      ReducedBody& body = *bodies_[b].body;
      const BodyState& s = at(b);
      const PackMat3 r0 = rotation_matrix(packed(before_[b].rotation)),
                     r1 = rotation_matrix(packed(s.rotation));
      body.contacts_.begin_substep();
      body.contacts_.find(s, r1, state_.stick);
      body.contacts_.follow(before_[b], r0, s, r1);
      body.respond_at<ContactSums::none>(now_.law, s);
      body.contacts_.keep_sticks(now_.law, state_.stick);
      body.found_.reset();
    }
    if (!coupling_) return;
    const std::vector<Vec3> start = coupling_->position();
    place();
    find_member_contacts(now_.law, coupling_->pairs(), coupling_->position(), coupling_->velocity(), start,
                         touching_);
    keep_sticks(now_.law, touching_, coupling_->pairs());
  }

  double size;
  double balanced;
  int furthest = -1;  // body that moved furthest, index into the model

 private:
  struct Part {
    int row, column;
    Mat6 stiffness;
  };

  BodyState& at(std::size_t b) { return state_.bodies[bodies_[b].index]; }
  int modes(std::size_t b) { return bodies_[b].body->modes(at(b)); }
  int groups(int b) { return MemberCoupling::groups(modes(b)); }
  void place() {
    for (std::size_t b = 0; coupling_ && b < bodies_.size(); ++b)
      coupling_->place(static_cast<int>(b), at(b));
  }

  // The part of the step in load_ that is taken: all of it, or little more than leads to where something
  // touches, as what goes into a wall is thrown off.
  double part_to_touch(double beyond) {
    double part = 1;
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      const double* const x = &load_[6 * row_[b]];
      BodyState moves = at(b);
      moves.velocity = Vec3(x);
      moves.angular_velocity = moves.rotation.conjugate() * Vec3(x + 3);
      moves.force.setZero();
      moves.moment.setZero();
      part = std::min(
          part, beyond + bodies_[b].body->contacts_.next_landing(moves, Vec3::Zero(), Vec3::Zero(), part));
      if (coupling_) coupling_->place(static_cast<int>(b), moves);
    }
    if (!coupling_) return part;
    coupling_->start();
    return std::min(part, beyond + coupling_->next_touch(coupling_->pairs(), part));
  }

  // A body's own forces and stiffness; its greatest unbalanced force, N.
  double add_body(std::size_t which) {
    ReducedBody& body = *bodies_[which].body;
    const BodyState& s = at(which);
    const int m = modes(which);
    double* const load = &load_[6 * row_[which]];
    Eigen::Map<Vec6>{load} << s.force, s.moment;
    const int n = 6 * MemberCoupling::groups(m);
    Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(n, n);
    double left = std::max(s.force.cwiseAbs().maxCoeff(), s.moment.cwiseAbs().maxCoeff() / size);
    for (int k = 0; k < m; ++k) {
      const double spring = body.basis_->frequency[k] * body.basis_->frequency[k];
      load[6 + k] = s.load[k] - spring * s.amplitude[k];
      stiffness(6 + k, 6 + k) = spring;
      left = std::max(left, std::abs(load[6 + k]) * std::sqrt(body.mass_));
    }
    add_contacts(body, s, m, stiffness);
    Eigen::MatrixXd of_anchors = Eigen::MatrixXd::Zero(6 + m, 6 + m);
    body.anchors_.add_stiffness(s, m, of_anchors);
    stiffness.topLeftCorner(6 + m, 6 + m) += of_anchors;
    for (int i = 0; i < n / 6; ++i)
      for (int j = 0; j < n / 6; ++j)
        parts_.push_back({row_[which] + i, row_[which] + j, stiffness.block<6, 6>(6 * i, 6 * j)});
    return left;
  }

  void add_contacts(ReducedBody& body, const BodyState& s, int m, Eigen::MatrixXd& stiffness) {
    constexpr double k_gamma_dt = 1;  // s, beside which damping is nothing
    BodyContacts& contacts = body.contacts_;
    const Mat3 r = s.rotation.toRotationMatrix();
    contacts.evaluate_forces<true>(now_.law, {{0, 0, 0}, {0, 0, 0}, Amplitudes::Zero()}, k_gamma_dt);
    contacts.each([&](const BodyContacts::Touch& touch, int which, int, std::size_t) {
      const Mat3 slope = contacts.slope(touch, which);
      const Vec3 arm = lane(touch.arm, which);
      Eigen::MatrixXd j(3, 6 + m);
      j.leftCols<3>().setIdentity();
      j.middleCols<3>(3) = -skew(arm);
      for (int k = 0; k < m; ++k) j.block<3, 1>(0, 6 + k) = r * contacts.shape(touch, which, k);
      stiffness.topLeftCorner(6 + m, 6 + m) -= j.transpose() * slope * j / k_gamma_dt;
      stiffness.block<3, 3>(3, 3) -=
          skew(contacts.force(touch, which)) * skew(arm);  // the arm turns with the body
    });
  }

  // The weight spreads the feet of an elastic body, and friction holds them together. Modes show little of
  // it: what they leave out goes into the stick springs, so that these hold what they would of a frame.
  void hold_splay(std::size_t which) {
    struct Foot {
      std::size_t spring;   // index into State::stick
      double normal;        // N
      double own, contact;  // m/N, across: of the body there, and of the contact alone
    };
    const ReducedBody& body = *bodies_[which].body;
    if (modes(which) == 0) return;
    std::vector<Foot> feet;
    std::vector<int> nodes;
    body.contacts_.each([&](const BodyContacts::Touch& touch, int lane, int point, std::size_t spring) {
      if (!touch.level) return;
      const double own = touch.give_across[lane];
      feet.push_back({spring, touch.normal[lane], own, 1 / touch.stick_stiffness[lane] - own});
      nodes.push_back(body.model_.contact_points[point].node - body.model_.bodies[body.body_].first_node);
    });
    if (feet.empty()) return;
    const auto n = static_cast<Eigen::Index>(feet.size());
    const Eigen::MatrixXd all = flexibility(*body.basis_, nodes);
    Eigen::MatrixXd across(2 * n, 2 * n);
    Eigen::VectorXd spread = Eigen::VectorXd::Zero(2 * n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < n; ++j) {
        across.block<2, 2>(2 * i, 2 * j) = all.block<2, 2>(3 * i, 3 * j);
        spread.segment<2>(2 * i) += feet[j].normal * all.block<2, 1>(3 * i, 3 * j + 2);
      }
    for (Eigen::Index i = 0; i < n; ++i) across.diagonal().segment<2>(2 * i).array() += feet[i].contact;
    const Eigen::VectorXd held = across.completeOrthogonalDecomposition().solve(-spread);
    for (Eigen::Index i = 0; i < n; ++i) {
      Vec3 left = Vec3::Zero();
      for (Eigen::Index j = 0; j < n; ++j)
        left += body.basis_->residual_shape.block<3, 3>(6 * nodes[i], 3 * nodes[j]) *
                Vec3(held[2 * j], held[2 * j + 1], feet[j].normal);
      left -= feet[i].own * Vec3(held[2 * i], held[2 * i + 1], 0);
      const Vec3 there = at(which).rotation * left;
      state_.stick[feet[i].spring] += Vec3(there.x(), there.y(), 0);
    }
  }

  // Times `factor`, 1/s^2.
  void add_inertia(double factor) {
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      const ReducedBody& body = *bodies_[b].body;
      const Mat3 r = at(b).rotation.toRotationMatrix();
      Mat6 block = Mat6::Zero();
      block.topLeftCorner<3, 3>() = factor * body.mass_ * Mat3::Identity();
      block.bottomRightCorner<3, 3>() = factor * (r * body.model_.bodies[body.body_].inertia * r.transpose());
      matrix_.add(row_[b], row_[b], block);
      for (int i = 1; i < groups(static_cast<int>(b)); ++i)
        matrix_.add(row_[b] + i, row_[b] + i, Mat6(factor * Mat6::Identity()));
    }
  }

  std::span<const ModelBody> bodies_;
  MemberCoupling* const coupling_;
  const Parameters with_own_friction_;
  Parameters still_;
  StepInputs now_;
  bool more_friction_ = true;
  State& state_;
  std::vector<std::vector<BodyContacts::TouchBuffer>> buffers_;  // per body, as all here but parts_
  std::deque<BodyContacts::ScratchLease> leases_;
  std::vector<Vec3> origin_;
  std::vector<BodyState> before_;
  std::vector<int> row_;  // first group of unknowns
  int rows_ = 0;
  MemberContacts touching_;
  std::vector<Part> parts_;  // of the stiffness
  std::vector<double> load_;
  BlockLu matrix_;
};

StepStatus settle_bodies(std::span<const ModelBody> bodies, MemberCoupling* coupling,
                         const Parameters& parameters, State& state) {
  RestOfBodies rest(bodies, coupling, parameters, state);
  StepStatus status;
  const Balance found = find_rest(rest, k_most);
  if (found == Balance::rest) return status;
  status.kind = StepStatus::Kind::not_settled;
  status.no_rest = no_rest(found);
  status.time = state.time;
  status.body = rest.furthest >= 0 ? rest.furthest : bodies.front().index;
  return status;
}

}  // namespace topple
