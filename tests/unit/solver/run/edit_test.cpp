#include "solver/run/edit.h"

#include <gtest/gtest.h>

#include <set>

#include "solver/body/body_pose.h"
#include "solver/body/model_level.h"
#include "solver/contact/contact_law.h"
#include "solver/contact/contact_period.h"
#include "solver/model/accelerogram.h"
#include "solver/model/excitation.h"
#include "solver/reduced/elastic_basis.h"
#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

Parameters shaken_parameters(double amplitude, double frequency) {
  Parameters p;
  p.shakes.emplace_back();
  p.shakes[0].amplitude = amplitude;
  p.shakes[0].frequency = frequency;
  return p;
}

/// Greatest change of the floor's acceleration between instants a microsecond apart, m/s^2.
double roughest(const Parameters& p, double from, double to) {
  constexpr double h = 1e-6;
  double most = 0;
  for (double t = from; t < to; t += h)
    most = std::max(most, (floor_acceleration(p.shakes, t + h) - floor_acceleration(p.shakes, t)).norm());
  return most;
}

TEST(Edit, of_the_frequency_keeps_the_phase_and_spaces_the_zeros_by_the_new_period) {
  const Parameters before = shaken_parameters(2, 0.5);
  Parameters after = before;
  constexpr double t = 1.3;
  apply(set(Edit::Key::frequency, 4), {}, t, after);
  apply(set(Edit::Key::frequency, 3), {}, 1.4, after);
  // 1e-14: rounding of a few operations on numbers of size 2
  EXPECT_NEAR(floor_acceleration(after.shakes, 1.4).x(), 2 * std::sin(2 * k_pi * (0.65 + 0.4)), 1e-14);
  Parameters once = before;
  apply(set(Edit::Key::frequency, 4), {}, t, once);
  EXPECT_NEAR(floor_acceleration(once.shakes, t).x(), floor_acceleration(before.shakes, t).x(), 1e-14);
  // turns 0.65 at t: zeros at 1, 1.5, 2, ...
  for (int k = 0; k < 20; ++k) {
    const double zero = t + (1 + 0.5 * k - 0.65) / 4;
    EXPECT_NEAR(floor_acceleration(once.shakes, zero).x(), 0, 1e-12) << k;
    EXPECT_GT(std::abs(floor_acceleration(once.shakes, zero + 0.0625).x()), 1.99) << k;
  }
}

TEST(Edit, of_the_frequency_before_the_shake_starts_changes_nothing_but_the_frequency) {
  Parameters edited = shaken_parameters(2, 0.5), fresh = shaken_parameters(2, 3);
  edited.shakes[0].start = fresh.shakes[0].start = 1;
  apply(set(Edit::Key::frequency, 3), {}, 0.4, edited);
  for (double t = 0; t < 3; t += 0.01)
    EXPECT_EQ(floor_acceleration(edited.shakes, t), floor_acceleration(fresh.shakes, t)) << t;
}

TEST(Edit, of_the_frequency_keeps_cycles_and_taper_as_counts_of_turns) {
  Parameters p = shaken_parameters(2, 1);
  p.shakes[0].cycles = 3;
  p.shakes[0].taper = 1;
  apply(set(Edit::Key::frequency, 5), {}, 2, p);
  EXPECT_NE(floor_acceleration(p.shakes, 2.15).norm(), 0);
  EXPECT_EQ(floor_acceleration(p.shakes, 2.2001).norm(), 0);  // one turn more, at 5 Hz
}

TEST(Edit, of_amplitude_and_direction_takes_a_quarter_of_a_period_without_a_jump) {
  const Parameters before = shaken_parameters(2, 0.5);
  const double t = 0.6, over = 0.5, smooth = roughest(before, 0, 0.01);
  for (const Edit& edit : {set(Edit::Key::amplitude, 6), turn_to({0, 3, 0})}) {
    Parameters after = before;
    apply(edit, {}, t, after);
    EXPECT_EQ(floor_acceleration(after.shakes, t), floor_acceleration(before.shakes, t));
    // the amplitude's own way adds at most pi/2 |change| / over to the slope of the sine, here that of 6
    // m/s^2
    EXPECT_LT(roughest(after, t - 0.01, t + over + 0.01), 1e-6 * (k_pi / 2 * 4 / over) + 3 * smooth);
    Parameters fresh = before;
    (edit.key == Edit::Key::amplitude) ? void(fresh.shakes[0].amplitude = 6)
                                       : void(fresh.shakes[0].direction = Vec3::UnitY());
    EXPECT_NE(floor_acceleration(after.shakes, t + over / 2), floor_acceleration(fresh.shakes, t + over / 2));
    for (double later : {t + over, t + 0.7, t + 3})
      EXPECT_LT((floor_acceleration(after.shakes, later) - floor_acceleration(fresh.shakes, later)).norm(),
                1e-14);
  }
}

TEST(Edit, of_amplitude_and_direction_before_the_start_holds_at_once) {
  Parameters p = shaken_parameters(2, 0.5);
  p.shakes[0].start = 1;
  apply(set(Edit::Key::amplitude, 5), {}, 0.9, p);
  apply(turn_to({0, 0, 2}), {}, 1, p);
  EXPECT_EQ(shake_amplitude(p.shakes[0], 1), Vec3(0, 0, 5));
}

TEST(Edit, of_a_pulse_takes_a_quarter_of_its_length) {
  Parameters p = shaken_parameters(2, 1);
  p.shakes[0].kind = Shake::Kind::pulse;
  p.shakes[0].shape = Shake::Shape::rectangle;
  p.shakes[0].duration = 0.8;
  apply(set(Edit::Key::amplitude, 4), {}, 0.1, p);
  EXPECT_NEAR(floor_acceleration(p.shakes, 0.1).x(), 2, 1e-14);
  EXPECT_NEAR(floor_acceleration(p.shakes, 0.2).x(), 3, 1e-14);
  EXPECT_NEAR(floor_acceleration(p.shakes, 0.3).x(), 4, 1e-14);
}

TEST(Edit, of_the_amplitude_of_a_sweep_takes_a_quarter_of_the_period_it_is_at) {
  Parameters p = shaken_parameters(2, 0.5);
  p.shakes[0].kind = Shake::Kind::sweep;
  p.shakes[0].last_frequency = 2;
  p.shakes[0].duration = 10;
  apply(set(Edit::Key::amplitude, 6), {}, 5, p);  // at 1 Hz
  EXPECT_EQ(shake_amplitude(p.shakes[0], 5).x(), 2);
  EXPECT_NEAR(shake_amplitude(p.shakes[0], 5.125).x(), 4, 1e-14);
  EXPECT_EQ(shake_amplitude(p.shakes[0], 5.25).x(), 6);
}

TEST(Edit, of_the_scale_of_a_record_takes_a_quarter_of_a_second_without_a_jump) {
  Parameters p;
  Shake& shake = p.shakes.emplace_back();
  shake.kind = Shake::Kind::record;
  shake.record = make_accelerogram({{Vec3::UnitX(), 100, {2, 2}}});
  shake.start = 1;
  apply(set(Edit::Key::scale, 1.5), {}, 0.5, p);  // before it starts: at once
  EXPECT_EQ(floor_acceleration(p.shakes, 1).x(), 3);
  apply(set(Edit::Key::scale, -0.5), {}, 2, p);
  EXPECT_EQ(floor_acceleration(p.shakes, 2).x(), 3);
  EXPECT_NEAR(floor_acceleration(p.shakes, 2.125).x(), 1, 1e-14);
  EXPECT_EQ(floor_acceleration(p.shakes, 2.25).x(), -1);
  // the share's slope is at most pi/2 over its length
  EXPECT_LT(roughest(p, 1.9, 2.4), 1.01 * 4 * k_pi / 2 / 0.25 * 1e-6);
  // from within the ramp
  apply(set(Edit::Key::scale, 1), {}, 2.3, p);
  apply(set(Edit::Key::scale, 2), {}, 2.425, p);
  EXPECT_NEAR(floor_acceleration(p.shakes, 2.425).x(), 0.5, 1e-13);
  EXPECT_EQ(floor_acceleration(p.shakes, 2.7).x(), 4);
}

TEST(Edit, of_a_record_is_of_its_scale_alone) {
  Parameters p;
  p.shakes.emplace_back().kind = Shake::Kind::record;
  for (const auto& [key, shake] : editable({}, p))
    EXPECT_TRUE(key != Edit::Key::amplitude && key != Edit::Key::frequency && key != Edit::Key::direction);
  EXPECT_EQ(editable({}, p)[0].first, Edit::Key::on);
  EXPECT_EQ(editable({}, p)[1].first, Edit::Key::scale);
}

TEST(Edit, within_the_ramp_of_another_goes_on_without_a_jump) {
  Parameters p = shaken_parameters(2, 0.5);
  const double smooth = roughest(p, 0, 0.01);
  apply(set(Edit::Key::amplitude, 6), {}, 0.6, p);
  const Parameters first = p;
  apply(turn_to({0, 1, 0}), {}, 0.8, p);
  EXPECT_LT((floor_acceleration(p.shakes, 0.8) - floor_acceleration(first.shakes, 0.8)).norm(), 1e-14);
  const Parameters second = p;
  apply(set(Edit::Key::amplitude, 1), {}, 0.95, p);
  EXPECT_LT((floor_acceleration(p.shakes, 0.95) - floor_acceleration(second.shakes, 0.95)).norm(), 1e-14);
  EXPECT_LT(roughest(p, 0.95, 1.5), 1e-6 * (k_pi / 2 * 8.5 / 0.5) + 3 * smooth);
  EXPECT_EQ(shake_amplitude(p.shakes[0], 1.46), Vec3(0, 1, 0));

  const Model model = shaken(1).model;
  Parameters c;
  apply(set(Edit::Key::alpha, 500 * k_g), model, 1, c);
  const ContactLaw at_first = contact_law(c, 1.05);
  apply(set(Edit::Key::friction, 0.1), model, 1.05, c);
  EXPECT_DOUBLE_EQ(contact_law(c, 1.05).alpha, at_first.alpha);
  EXPECT_DOUBLE_EQ(contact_law(c, 1.05).friction, at_first.friction);
}

TEST(Edit, of_the_contact_law_passes_over_two_periods_of_the_slowest_bounce) {
  const Model model = shaken(1).model;
  const Parameters before;
  const ContactLaw old = before.contact;
  const struct {
    Edit::Key key;
    double value, ContactLaw::*number;
  } cases[] = {{Edit::Key::alpha, 2 * k_g, &ContactLaw::alpha},
               {Edit::Key::q, 2, &ContactLaw::q},
               {Edit::Key::friction, 0.1, &ContactLaw::friction},
               {Edit::Key::restitution, 0.9, &ContactLaw::restitution}};
  for (const auto& c : cases) {
    Parameters p = before;
    apply(set(c.key, c.value), model, 3, p);
    ContactLaw law = old;
    law.*c.number = c.value;
    const double over =
        2 * std::max(contact_period(model, old, p.gravity), contact_period(model, law, p.gravity));
    EXPECT_EQ(contact_law(p, 3).*c.number, old.*c.number);
    EXPECT_EQ(contact_law(p, 3 + over).*c.number, c.value);
    const double middle =
        c.key == Edit::Key::alpha ? std::sqrt(old.*c.number * c.value) : (old.*c.number + c.value) / 2;
    EXPECT_NEAR(contact_law(p, 3 + over / 2).*c.number, middle, 1e-12 * std::abs(middle));
    double last = old.*c.number;
    for (int i = 1; i <= 100; ++i) {
      const double now = contact_law(p, 3 + over * i / 100).*c.number;
      EXPECT_EQ(now > last, c.value > old.*c.number) << i;
      last = now;
    }
  }
}

TEST(Edit, sets_the_value_that_is_read_back) {
  Model model = shaken(1).model;
  model.bodies[0].first_frequency = 100;
  Parameters p = shaken_parameters(2, 0.5);
  p.shakes.resize(4);
  p.shakes[1].kind = Shake::Kind::sweep;
  p.shakes[2].kind = Shake::Kind::pulse;
  p.shakes[3].kind = Shake::Kind::record;
  p.shakes[3].record = make_accelerogram({{Vec3::UnitX(), 100, {2, 2}}});
  p.models = {BodyModel::frame};
  p.damping = {0.1};
  p.anchors = {true};
  std::set<Edit::Key> seen;
  for (const auto& [key, shake] : editable(model, p)) {
    Edit edit{.key = key, .index = shake, .value = edited_value(p, key, shake)};
    switch (key) {
      case Edit::Key::direction:
        edit.value = Vec3(0, 0, 1);
        break;
      case Edit::Key::on:
      case Edit::Key::anchor:
      case Edit::Key::want:
        edit.value.x() = 1 - edit.value.x();
        break;
      case Edit::Key::type:
        edit.value.x() = 2 - edit.value.x();
        break;
      case Edit::Key::law:
        continue;  // decides what can be edited
      case Edit::Key::model:
        edit.value.x() = 1;
        break;
      case Edit::Key::integrator:
        edit.value.x() = 3;
        break;
      default:
        edit.value *= 1.25;
    }
    if (key == Edit::Key::friction_static) edit.value.x() = 1;
    Parameters edited = p;
    apply(edit, model, 1, edited);
    EXPECT_EQ(edited_value(edited, key, shake), edit.value) << static_cast<int>(key);
    seen.insert(key);
  }
  EXPECT_EQ(seen.size(), static_cast<std::size_t>(Edit::Key::time_step));  // all but the law
}

TEST(Edit, of_the_type_begins_the_shake_anew_from_no_acceleration) {
  Parameters p = shaken_parameters(2, 0.5);
  p.shakes[0].cycles = 40;
  for (const Shake::Kind kind : {Shake::Kind::pulse, Shake::Kind::sine, Shake::Kind::sweep}) {
    apply(set(Edit::Key::type, static_cast<int>(kind)), {}, 3.3, p);
    EXPECT_EQ(shake_acceleration(p.shakes[0], 3.3), Vec3(Vec3::Zero()));
    EXPECT_GT(shake_acceleration(p.shakes[0], 3.4).x(), 0);
  }
  // a pulse of half the sine's period
  p = shaken_parameters(2, 0.5);
  apply(set(Edit::Key::type, 2), {}, 1, p);
  EXPECT_EQ(shake_end(p.shakes[0]), 2);
  EXPECT_NEAR(shake_acceleration(p.shakes[0], 1.5).x(), 2, 1e-15);
  // both frequencies of a sweep, from its new start on
  p = shaken_parameters(2, 0.5);
  apply(set(Edit::Key::type, 1), {}, 1, p);
  EXPECT_EQ(shake_frequency(p.shakes[0], 11), 5);
  apply({.key = Edit::Key::frequency, .value = Vec3(2, 2, 0)}, {}, 4, p);
  EXPECT_EQ(shake_turns(p.shakes[0], 7), 6);
}

TEST(Edit, switches_a_shake_off_and_on_again_without_a_jump) {
  Parameters p = shaken_parameters(2, 0.5);
  const double smooth = roughest(p, 0, 0.01);
  apply(set(Edit::Key::on, 0), {}, 0.6, p);
  EXPECT_LT(roughest(p, 0.55, 1.2), 1e-6 * (k_pi / 2 * 2 / 0.5) + 3 * smooth);
  EXPECT_EQ(floor_acceleration(p.shakes, 1.1).x(), 0);
  apply(set(Edit::Key::on, 1), {}, 1.3, p);
  EXPECT_LT(roughest(p, 1.25, 2), 1e-6 * (k_pi / 2 * 2 / 0.5) + 3 * smooth);
  EXPECT_NEAR(floor_acceleration(p.shakes, 2.3).x(), 2 * std::sin(2 * k_pi * 0.5 * 2.3), 1e-12);
}

TEST(Edit, of_model_law_and_integrator_keeps_the_energy_in_the_middle_of_a_run) {
  topple::Setup setup = shaken(2, 0.05);
  setup.model.bodies[0].elastic = elastic_basis(setup.model, 0);
  setup.parameters.models = {BodyModel::rigid};
  setup.parameters.time_step = 2e-4;
  topple::Run run(setup);
  const auto go_on = [&](Edit::Key key, double value) {
    run.edit(set(key, value));
    for (int i = 0; i < 1000; ++i) {
      ASSERT_TRUE(run.advance().ok());
      ASSERT_LT(run.state().energy.balance_error(), 2e-3);
    }
  };
  const auto level = [&] { return run.state().bodies[0].level; };
  go_on(Edit::Key::law, static_cast<int>(ContactLawKind::paper));
  EXPECT_EQ(run.state().law, ContactLawKind::paper);
  go_on(Edit::Key::law, static_cast<int>(ContactLawKind::coulomb));
  EXPECT_EQ(level(), ModelLevel::rigid);
  go_on(Edit::Key::model, static_cast<int>(BodyModel::elastic));
  EXPECT_EQ(level(), ModelLevel::elastic);
  go_on(Edit::Key::model, static_cast<int>(BodyModel::frame));
  EXPECT_EQ(level(), ModelLevel::frame);
  go_on(Edit::Key::integrator, 3);  // newmark
  go_on(Edit::Key::law, static_cast<int>(ContactLawKind::printed));
}

TEST(Edit, can_ask_for_no_model_that_a_body_cannot_be) {
  topple::Setup setup = shaken(1);
  EXPECT_TRUE(can_be(setup.model, 0, BodyModel::rigid));
  EXPECT_TRUE(can_be(setup.model, 0, BodyModel::frame));
  EXPECT_FALSE(can_be(setup.model, 0, BodyModel::elastic));
  setup.model.bodies[0].elastic = elastic_basis(setup.model, 0);
  EXPECT_TRUE(can_be(setup.model, 0, BodyModel::elastic));
  setup.model.loads.push_back({0, Vec3::UnitX(), Vec3::Zero(), {}});
  EXPECT_FALSE(can_be(setup.model, 0, BodyModel::rigid));
  EXPECT_TRUE(can_be(setup.model, 0, BodyModel::frame));
}

TEST(Edit, depends_on_its_arguments_only) {
  const Model model = shaken(1).model;
  const auto law_and_floor = [&](double first, double second) {
    Parameters p = shaken_parameters(2, 0.5);
    apply(set(Edit::Key::alpha, 300 * k_g), model, first, p);
    apply(set(Edit::Key::frequency, 2), model, first, p);
    apply(set(Edit::Key::q, 1.5), model, second, p);
    apply(set(Edit::Key::amplitude, 3), model, second, p);
    const ContactLaw law = contact_law(p, second + 0.01);
    const Vec3 floor = floor_acceleration(p.shakes, second + 0.01);
    return std::vector<double>{law.alpha, law.q, floor.x(), p.shakes[0].turns, p.contact_ramp.over};
  };
  EXPECT_EQ(law_and_floor(0.7, 0.75), law_and_floor(0.7, 0.75));
}

TEST(Edit, without_gravity_or_planes_holds_at_once) {
  Model model = shaken(1).model;
  Parameters p = weightless();
  apply(set(Edit::Key::alpha, 1), model, 2, p);
  EXPECT_EQ(contact_law(p, 2).alpha, 1);
  model.planes.clear();
  EXPECT_EQ(contact_period(model, ContactLaw{}, Parameters{}.gravity), 0);
}

TEST(Edit, contact_period_is_that_of_a_mass_on_its_springs_and_of_a_real_bounce) {
  topple::Setup setup = shaken(1);
  setup.parameters.contact.restitution = 1;  // no loss: with q = 1 a linear spring
  const double period = contact_period(setup.model, setup.parameters.contact, setup.parameters.gravity);
  // 40 kg on 9 contacts of 50 kgf, L = 60 mm: 2 pi sqrt(L (40/450)/g)
  EXPECT_NEAR(period, 0.147, 0.02 * 0.147);
  State state = topple::Run(setup).state();
  for (Vec3& v : state.velocity) v.z() = 0.02;  // a twelfth of what would lift it off
  topple::Run run(setup, state, setup.parameters);
  std::vector<double> turns;  // of the centre, up and down
  double before = 0.02, height = 0;
  while (!run.over()) {
    const double was = centre_of_mass(setup.model, run.state()).z();
    ASSERT_TRUE(run.advance().ok());
    height = centre_of_mass(setup.model, run.state()).z();
    const double speed = (height - was) / setup.parameters.time_step;
    if ((speed > 0) != (before > 0)) turns.push_back(run.state().time);
    before = speed;
  }
  ASSERT_GE(turns.size(), 8u);
  const double measured = 2 * (turns.back() - turns.front()) / static_cast<double>(turns.size() - 1);
  EXPECT_NEAR(measured, period, 0.02 * period);
}

/// How far the centre of a cabinet that stands rises, m, and whether the floor carries it all the time.
struct Rise {
  double height = 0;
  bool carried = true;
};
Rise rise(topple::Run run) {
  const Model& model = run.setup().model;
  const double start = centre_of_mass(model, run.state()).z();
  Rise result;
  while (!run.over()) {
    EXPECT_TRUE(run.advance().ok());
    result.height = std::max(result.height, centre_of_mass(model, run.state()).z() - start);
    result.carried = result.carried && !run.contacts().empty() && run.events().empty();
  }
  return result;
}

TEST(Edit, of_alpha_lets_a_standing_cabinet_rise_without_leaving_the_floor) {
  topple::Setup setup = shaken(1);
  setup.parameters.contact.restitution = 0.5;
  topple::Run edited(setup);
  ASSERT_TRUE(edited.advance().ok());
  edited.edit(set(Edit::Key::alpha, 25 * setup.parameters.contact.alpha));
  Parameters hard = setup.parameters;
  hard.contact.alpha *= 25;
  const Rise gentle = rise(topple::Run(setup, edited.point()));
  State jumped = edited.state();  // with energies of the harder law from the start: nothing is lost
  Workspace workspace(setup.model);
  prepare(setup.model, hard, jumped, workspace);
  const Rise thrown = rise(topple::Run(setup, jumped, hard));
  // what it sank into nine contacts of 50 kgf, less what it sinks into harder ones
  const double released = 0.06 * 40 / 450 * (1 - 1. / 25);
  EXPECT_TRUE(gentle.carried);
  EXPECT_LT(gentle.height, 1.1 * released);
  EXPECT_GT(gentle.height, 0.9 * released);
  EXPECT_FALSE(thrown.carried);
  EXPECT_GT(thrown.height, 4 * released);
}

TEST(Edit, keeps_the_energy_balance_of_a_rocking_cabinet) {
  topple::Setup setup = shaken(4);
  shake(setup, 3, 2);
  topple::Run run(setup);
  const std::pair<double, Edit> edits[] = {
      {0.5, set(Edit::Key::alpha, 200 * k_g)}, {0.9, set(Edit::Key::q, 1.5)},
      {1.3, set(Edit::Key::friction, 0.3)},    {1.7, set(Edit::Key::amplitude, 4)},
      {2.1, set(Edit::Key::frequency, 3)},     {2.5, turn_to({1, 1, 0})},
      {2.9, set(Edit::Key::time_step, 5e-4)},  {3.3, set(Edit::Key::alpha, 50 * k_g)},
      {3.5, set(Edit::Key::restitution, 0.9)}};
  double worst = 0, tilt = 0;
  const auto* next = std::begin(edits);
  while (!run.over()) {
    ASSERT_TRUE(run.advance().ok());
    worst = std::max(worst, run.state().energy.balance_error());
    tilt = std::max(tilt, topple::tilt(body_pose(setup.model, run.state(), 0)));
    if (next == std::end(edits) || run.state().time < next->first) continue;
    EXPECT_GT(tilt, 0.004) << "does not rock before " << run.state().time << " s";
    tilt = 0;
    run.edit((next++)->second);
  }
  EXPECT_EQ(next, std::end(edits));
  EXPECT_LT(worst, 1e-3);
}

}  // namespace
}  // namespace topple::test
