#include "solver/reduced/coupled_bodies.h"

#include <algorithm>
#include <cmath>
#include <deque>

#include "solver/math/ranges.h"
#include "solver/math/rotation.h"

namespace topple {
namespace {

constexpr double k_least_part = 0.01;  // of a correction of Newton's
constexpr double k_passed_error = 8;   // counts as this error: members moved too far to see them meet

}  // namespace

CoupledBodies::CoupledBodies(std::span<const ModelBody> all, std::vector<int> which, MemberCoupling& coupling)
    : which_(std::move(which)),
      coupling_(coupling),
      place_(all.size(), -1),
      buffers_(which_.size()),
      substeps_(which_.size()),
      matrix_(0, {}),
      sticks_(0, {}) {
  for (const int body : which_) {
    place_[body] = static_cast<int>(bodies_.size());
    bodies_.push_back(all[body]);
  }
}

// Rows and columns of the matrices, for the levels that the bodies are on.
void CoupledBodies::shape_matrices() {
  std::vector<int> row{0};
  std::vector<std::pair<int, int>> coupled;
  for (const int body : which_) row.push_back(row.back() + MemberCoupling::groups(coupling_.modes(body)));
  const auto couple = [&](int a, int b) {
    for (int i = row[a]; i < row[a + 1]; ++i)
      for (int j = row[b]; j < row[b + 1]; ++j)
        if (i != j) coupled.emplace_back(std::max(i, j), std::min(i, j));
  };
  for (int b = 0; b < static_cast<int>(bodies_.size()); ++b) couple(b, b);
  for (const MemberPair& pair : pairs_) {
    const auto [a, b] = coupling_.bodies_of(pair);
    if (a >= 0 && b >= 0) couple(place_[a], place_[b]);
  }
  coupling_.ties().each_in_place([&](int a, int b) {
    if (place_[a] >= 0 && place_[b] >= 0) couple(place_[a], place_[b]);
  });
  ranges::sort(coupled);
  coupled.erase(std::unique(coupled.begin(), coupled.end()), coupled.end());
  side_.assign(6 * row.back(), 0);
  if (row == row_ && coupled == coupled_) return;
  row_ = std::move(row);
  coupled_ = std::move(coupled);
  matrix_ = BlockLu(row_.back(), coupled_);
  sticks_ = BlockLu(row_.back(), coupled_);
}

double CoupledBodies::first(const ContactLaw& law) const {
  double least = std::min(first_substep(law, pairs_), coupling_.ties().first_substep());
  for (const ModelBody& b : bodies_) least = std::min(least, b.body->first_substep(law));
  return least;
}

// The bodies have been placed.
double CoupledBodies::next_kink(double within) {
  double soonest = within;
  for (const ModelBody& b : bodies_)
    soonest = std::min(soonest, b.body->next_kink(next_->bodies[b.index], soonest));
  soonest = std::min(soonest, coupling_.next_touch(pairs_, soonest));
  return soonest < within ? soonest : std::numeric_limits<double>::infinity();
}

void CoupledBodies::find(const ContactLaw& law) {
  find_member_contacts(law, pairs_, coupling_.position(), coupling_.velocity(), start_position_, now_);
}

// f(substep, its part of side_).
template <class F>
void CoupledBodies::each_body(F f) {
  for (std::size_t b = 0; b < bodies_.size(); ++b) f(*substeps_[b], &side_[6 * row_[b]]);
}

namespace {

// Group (i, j) of a body's own matrix; a mode that is not there stays as it is.
Mat6 group(const ModeMatrix& matrix, int modes, int i, int j) {
  Mat6 block = Mat6::Zero();
  for (int r = 0; r < 6; ++r)
    for (int c = 0; c < 6; ++c) {
      const int row = 6 * i + r, column = 6 * j + c;
      if (row < 6 + modes && column < 6 + modes)
        block(r, c) = matrix[row][column];
      else if (row == column)
        block(r, c) = 1;
    }
  return block;
}

}  // namespace

// Newton's matrices where the bodies are.
void CoupledBodies::factor(const SubstepSpan& span, const ContactLaw& law) {
  matrix_.set_zero();
  sticks_.set_zero();
  ModeMatrix own;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const ImplicitSubstep& substep = *substeps_[b];
    const int modes = substep.modes(), groups = MemberCoupling::groups(modes);
    const auto add = [&](BlockLu& lu) {
      for (int i = 0; i < groups; ++i)
        for (int j = 0; j < groups; ++j) lu.add(row_[b] + i, row_[b] + j, group(own, modes, i, j));
    };
    substep.fill(own);
    add(matrix_);
    substep.fill_with_sticks(own);
    add(sticks_);
  }
  const double square = span.gamma_dt * span.gamma_dt;
  const auto add = [&](int a, int i, int b, int j, const Mat6& block, const Mat6& of_stick) {
    if (place_[a] < 0) return;  // anchors of other bodies of the coupling
    const int row = row_[place_[a]] + i, column = row_[place_[b]] + j;
    matrix_.add(row, column, Mat6(square * block));
    sticks_.add(row, column, Mat6(square * of_stick));
  };
  coupling_.each_block(law, now_, pairs_, 1 / span.gamma_dt, std::ref(add));
}

// Takes `part` of corrections, of which there are as many as unknowns, off the velocities.
void CoupledBodies::correct(std::span<const double> corrections, double part) {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    BodyVelocity by = taken(&corrections[6 * row_[b]], substeps_[b]->modes());
    by.linear = part * by.linear;
    by.angular = part * by.angular;
    by.rate *= part;
    substeps_[b]->correct(by);
  }
}

// Newton for the velocities of a stage. A correction after which the next one is larger went too far: most of
// it is taken back (natural monotonicity, Deuflhard 1974).
bool CoupledBodies::solve_stage(const SubstepSpan& span, const PreparedLaw& law, StageNewton& newton) {
  newton.begin_stage();
  double taken_part = 1;  // of the last correction
  for (int iteration = 0; iteration < k_newton_iterations; ++iteration) {
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      ImplicitSubstep& substep = *substeps_[b];
      substep.reach(newton.fresh);
      coupling_.place(which_[b], substep.pose(), substep.rotation(), substep.velocity());
    }
    find(law);
    const std::vector<BodyVelocity>& loads = coupling_.loads(now_, pairs_);
    for (std::size_t b = 0; b < bodies_.size(); ++b) substeps_[b]->add(loads[which_[b]]);
    each_body(
        [](const ImplicitSubstep& substep, double* to) { put(substep.residual(), substep.modes(), to); });
    if (newton.fresh) {
      factor(span, law);
      if (matrix_.factor() >= 0 || sticks_.factor() >= 0) return false;
    }
    matrix_.solve(side_.data());
    double size = 0, over = 0;
    each_body([&](const ImplicitSubstep& substep, const double* from) {
      const double own = substep.size_of(taken(from, substep.modes()));
      size = std::max(size, own);
      over = std::max(over, own / substep.scale());
      if (!std::isfinite(own)) size = over = own;
    });
    if (size > newton.last && taken_part > k_least_part) {
      const double less = taken_part * std::clamp(newton.last / (2 * size), 0.1, 0.5);
      correct(correction_, less - taken_part);
      taken_part = less;
      newton.fresh = true;
      continue;
    }
    correct(side_, 1);
    correction_ = side_;
    taken_part = 1;
    const double rate = newton.rate(size, law);
    if (over * rate <= StageNewton::error(span.parameters.tolerance)) {
      newton.fresh = false;
      return true;
    }
    if (!std::isfinite(size)) return false;
    newton.go_on(size, rate, iteration);
  }
  return false;
}

// What normal damping and friction between members take.
ContactPower CoupledBodies::power() const {
  ContactPower power{0, 0};
  for (const MemberTouch& touch : now_.touches) {
    const Vec3& v = touch.input.velocity;
    power.damping -= (touch.out.normal - touch.out.conservative) * touch.input.normal.dot(v);
    power.friction -= touch.out.tangential.dot(v);
  }
  return power;
}

// Work between members; what the bodies book themselves, and what the law's change did to springs.
void CoupledBodies::book(const SubstepSpan& span, const std::array<ContactPower, 3>& powers) {
  const auto& [start, first, second] = powers;
  booked_->normal_damping += span.integral(start.damping, first.damping, second.damping);
  booked_->friction += span.integral(start.friction, first.friction, second.friction);
  for (const MemberTouch& touch : start_.touches) booked_->friction += touch.out.stick_energy;
  for (const MemberTouch& touch : now_.touches) booked_->friction -= touch.out.stick_energy;
  const ContactLaw &before = span.start.law, &after = span.end.law;
  if (before.alpha == after.alpha && before.q == after.q) return;
  LawChange change(before, after, *booked_);
  for (const MemberTouch& touch : start_.touches)
    change.book_start(touch.input.depth, pairs_[touch.pair].L, touch.out.stick_energy, touch.weight, true);
  for (const MemberTouch& touch : now_.touches)
    change.book_end(touch.input.depth, pairs_[touch.pair].L, touch.out.stick_energy, touch.weight, true);
}

ImplicitOutcome CoupledBodies::substep(const SubstepSpan& span) {
  // what hits a body moves it: its errors are measured by the motion that goes on, by speed and by energy
  double fastest = 0, most = 0;
  for (const ModelBody& b : bodies_) {
    const double speed = ImplicitSubstep::speed_of(*b.body, next_->bodies[b.index]);
    fastest = std::max(fastest, speed);
    most = std::max(most, b.body->mass() * speed * speed);
  }
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const auto& [index, body] = bodies_[b];
    const double speed = std::max(ImplicitSubstep::speed_of(*body, next_->bodies[index]),
                                  std::min(fastest, std::sqrt(most / body->mass())));
    substeps_[b].emplace(*body, span, next_->bodies[index], next_->stick, speed);
  }
  std::array<ContactPower, 3> powers{power()};
  std::swap(start_, now_);
  const auto give_up = [&](double error) {
    each_body([](ImplicitSubstep& substep, double*) { substep.give_up(); });
    for (std::size_t b = 0; b < bodies_.size(); ++b)
      coupling_.place(which_[b], next_->bodies[bodies_[b].index]);
    std::swap(start_, now_);
    return ImplicitOutcome::given_up(error);
  };
  StageNewton newton;
  const PreparedLaw* const laws[2] = {&span.middle.law, &span.end.law};
  for (int stage = 0; stage < 2; ++stage) {
    if (!solve_stage(span, *laws[stage], newton)) return give_up(ImplicitOutcome::k_no_stage);
    powers[1 + stage] = power();
    each_body([](ImplicitSubstep& substep, double*) { substep.end_stage(); });
  }
  each_body([](const ImplicitSubstep& substep, double* to) { put(substep.error(), substep.modes(), to); });
  sticks_.solve(side_.data());
  double error = 0;
  each_body([&](const ImplicitSubstep& substep, const double* from) {
    const double own = substep.over_allowed(taken(from, substep.modes()));
    if (!(own <= error)) error = own;
  });
  if (!(error <= 1)) return give_up(error);
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    substeps_[b]->arrive();
    coupling_.place(which_[b], substeps_[b]->pose());
  }
  find(span.end.law);
  if (passed_unseen(now_, pairs_, start_position_, coupling_.position()) >= 0) return give_up(k_passed_error);
  each_body([&](ImplicitSubstep& substep, double*) { substep.finish(*booked_); });
  book(span, powers);
  // springs that slipped are shorter now: the next substep starts from the forces with these
  keep_sticks(span.end.law, now_, pairs_);
  start_position_ = coupling_.position();
  coupling_.go_on(pairs_);
  const std::vector<BodyVelocity>& loads = coupling_.loads(now_, pairs_);
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    BodyState& s = next_->bodies[bodies_[b].index];
    add_load(loads[which_[b]], s);
    coupling_.place(which_[b], s);
  }
  return {SubstepEnd::reached, error};
}

// Of advance_by_substeps.
struct AllTogether {
  CoupledBodies& all;

  double first(const ContactLaw& law) const { return all.first(law); }
  double next_kink(double within) { return all.next_kink(within); }
  double wanted() const {
    double least = 0;
    for (const ModelBody& b : all.bodies_)
      if (const double own = all.next_->bodies[b.index].substep; own > 0 && !(least > 0 && least < own))
        least = own;
    return least;
  }
  void want(double size) {
    for (const ModelBody& b : all.bodies_) all.next_->bodies[b.index].substep = size;
  }
  ImplicitOutcome substep(const SubstepSpan& span) { return all.substep(span); }
};

StepStatus::Kind CoupledBodies::advance(const StepSpan& span, std::vector<MemberPair> pairs, State& next,
                                        StepEnergy& booked) {
  pairs_ = std::move(pairs);
  next_ = &next;
  booked_ = &booked;
  std::deque<BodyContacts::ScratchLease> leases;
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    leases.emplace_back(bodies_[b].body->contacts(), buffers_[b]);
  shape_matrices();
  start_position_ = coupling_.position();
  find(span.start.law);
  AllTogether system{*this};
  return advance_by_substeps(system, span.parameters, span.start, span.end, span.h);
}

}  // namespace topple
