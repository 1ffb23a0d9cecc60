#include "solver/contact/contact_law.h"

#include <gtest/gtest.h>

#include "solver/contact/coulomb.h"
#include "solver/state/energy.h"
#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

ContactLaw random_law(std::mt19937& rng, ContactLawKind kind, double q) {
  std::uniform_real_distribution<double> u(0, 1);
  ContactLaw law;
  law.kind = kind;
  law.q = q;
  law.alpha = 100 + 900 * u(rng);
  law.friction = 0.2 + 0.6 * u(rng);
  if (kind == ContactLawKind::coulomb && u(rng) < 0.5) law.friction_static = law.friction + 0.5 * u(rng);
  law.restitution = 0.1 + 0.8 * u(rng);
  law.normal_speed = law.slip_speed = 0.05;
  return law;
}

ContactInput random_input(std::mt19937& rng, double stick) {
  std::uniform_real_distribution<double> u(0, 1);
  ContactInput in;
  in.normal = random_direction(rng);
  in.L = 0.04 + 0.04 * u(rng);
  in.depth = 0.1 + 0.8 * u(rng);
  in.velocity = random_vector(rng, 0.2);
  in.stick = random_vector(rng, stick);
  in.mass = 2;
  return in;
}

ContactInput moved(const ContactInput& in, const Vec3& shift) {
  ContactInput out = in;
  out.depth -= in.normal.dot(shift) / in.L;
  out.stick += shift;
  return out;
}

TEST(ContactLaw, penalty_force_is_equation_2) {
  ContactLaw law;
  law.alpha = 120;
  for (double q : {0.5, 1., 1.5, 2., 3.}) {
    law.q = q;
    for (double depth : {-1., -1e-9, 0., 1e-6, 0.3, 1., 1.7}) {
      SCOPED_TRACE(testing::Message() << "q " << q << ", depth " << depth);
      const double exact = depth > 0 ? 120 * std::pow(depth, q) : 0;
      EXPECT_NEAR(penalty_force(law, depth), exact, 1e-14 * 120 * std::pow(2, q));
    }
  }
}

TEST(ContactLaw, penalty_energy_is_the_work_of_the_penalty_force) {
  ContactLaw law;
  law.alpha = 120;
  const double L = 0.06;
  for (double q : {1., 1.5, 2., 3.}) {
    law.q = q;
    double work = 0;
    const int n = 4000;
    for (int i = 0; i < n; ++i) {
      // Gauss points of two: the force is smooth but for a root at 0, where the cell weighs 1e-5
      const double a = (i + 0.5 - 0.5 / std::sqrt(3.)) / n * 0.8,
                   b = (i + 0.5 + 0.5 / std::sqrt(3.)) / n * 0.8;
      work += 0.5 * (penalty_force(law, a) + penalty_force(law, b)) * 0.8 / n * L;
    }
    EXPECT_NEAR(penalty_energy(law, 0.8, L), work, 1e-9 * work) << "q " << q;
    EXPECT_EQ(penalty_energy(law, 0, L), 0);
    EXPECT_EQ(penalty_energy(law, -0.1, L), 0);
  }
}

TEST(ContactLaw, derivatives_agree_with_finite_differences) {
  std::mt19937 rng(31);
  for (const ContactLawTraits& traits : contact_laws())
    for (double q : {1., 1.5, 2.})
      for (double stick : {1e-6, 1e-2})  // sticking and slipping
        for (int trial = 0; trial < 10; ++trial) {
          SCOPED_TRACE(testing::Message()
                       << "law " << traits.word << ", q " << q << ", stick " << stick << ", trial " << trial);
          const ContactLaw law = random_law(rng, traits.kind, q);
          ContactInput in = random_input(rng, stick);
          if (stick < 1e-3) in.velocity = in.normal * 0.1 + 1e-3 * random_vector(rng);
          Mat3 by_position, by_velocity;
          const ContactOutput out = contact_force(law, in, by_position, by_velocity);
          EXPECT_EQ(out.force, contact_force(law, in).force);
          double last = 0;
          for (double h : {1e-3, 1e-4, 1e-5}) {
            double error = 0;
            for (int k = 0; k < 3; ++k) {
              Vec3 step = Vec3::Zero();
              step[k] = h * in.L * 1e-2;
              const Vec3 dx =
                  (contact_force(law, moved(in, step)).force - contact_force(law, moved(in, -step)).force) /
                  (2 * step[k]);
              step[k] = h * law.slip_speed;
              ContactInput plus = in, minus = in;
              plus.velocity += step;
              minus.velocity -= step;
              const Vec3 dv =
                  (contact_force(law, plus).force - contact_force(law, minus).force) / (2 * step[k]);
              error = std::max({error, (dx - by_position.col(k)).norm() / by_position.norm(),
                                (dv - by_velocity.col(k)).norm() / by_velocity.norm()});
            }
            if (last > 0) {
              EXPECT_LT(error, 0.02 * last + 1e-12 / h) << "step " << h;
            }
            last = error;
          }
          EXPECT_LT(last, 1e-6);
        }
}

TEST(ContactLaw, force_is_its_normal_and_tangential_parts) {
  std::mt19937 rng(32);
  for (const ContactLawTraits& traits : contact_laws())
    for (int trial = 0; trial < 20; ++trial) {
      const ContactLaw law = random_law(rng, traits.kind, 1.5);
      const ContactInput in = random_input(rng, 1e-3);
      const ContactOutput out = contact_force(law, in);
      const double size = 1 + out.force.norm();
      EXPECT_NEAR(out.force.dot(in.normal), out.normal, 1e-13 * size);
      EXPECT_NEAR(out.tangential.dot(in.normal), 0, 1e-13 * size);
      EXPECT_LT((out.normal * in.normal + out.tangential - out.force).norm(), 1e-13 * size);
    }
}

TEST(ContactLaw, paper_law_is_equations_2_and_3_with_the_geometric_normal) {
  ContactLaw law;
  law.kind = ContactLawKind::paper;
  law.alpha = 500;
  law.q = 1;
  law.friction = 0.6;
  law.slip_speed = 0;  // the bare direction v/|v|
  const ContactInput in{Vec3::UnitZ(), 0.25, 0.06, Vec3(3, 0, 4), Vec3::Zero(), 1};
  const Vec3 exact = 125 * Vec3::UnitZ() - 0.6 * 125 * Vec3(0.6, 0, 0.8);
  EXPECT_LT((contact_force(law, in).force - exact).norm(), 1e-12);
  law.kind = ContactLawKind::printed;
  EXPECT_LT((contact_force(law, in).force - Vec3(-45, 0, -125 - 60)).norm(), 1e-12);
}

TEST(ContactLaw, normal_force_of_coulomb_takes_1_plus_m_coming_in_and_1_minus_m_going_out) {
  ContactLaw law;
  law.alpha = 500;
  law.restitution = 0.5;
  law.normal_speed = 1e-9;
  ContactInput in{Vec3::UnitZ(), 0.2, 0.06, Vec3(0, 0, -1), Vec3::Zero(), 1};
  EXPECT_NEAR(contact_force(law, in).normal, 100 * 1.6, 1e-10);
  in.velocity.z() = 1;
  EXPECT_NEAR(contact_force(law, in).normal, 100 * 0.4, 1e-10);
  in.velocity.z() = 0;
  EXPECT_NEAR(contact_force(law, in).normal, 100, 1e-12);
  EXPECT_DOUBLE_EQ(normal_loss(0.5), 0.6);
  EXPECT_DOUBLE_EQ(normal_loss(1), 0);
  EXPECT_DOUBLE_EQ(normal_loss(0), 1);
}

TEST(ContactLaw, friction_falls_from_static_to_kinetic_with_the_slip_speed) {
  ContactLaw law;
  law.friction = 0.4;
  law.friction_static = 0.6;
  law.slip_speed = 0.02;
  EXPECT_DOUBLE_EQ(friction_coefficient(law, 0.), 0.6);
  EXPECT_DOUBLE_EQ(friction_coefficient(law, 0.02 * 0.02), 0.5);
  EXPECT_NEAR(friction_coefficient(law, 1.), 0.4, 0.2 * 0.02 * 0.02);
  ContactInput in{Vec3::UnitZ(), 0.2, 0.06, Vec3(0.02, 0, 0), Vec3(1, 0, 0), 1};
  EXPECT_NEAR(contact_force(law, in).tangential.x(), -0.5 * contact_force(law, in).normal, 1e-10);
  law.friction_static = 0.3;  // below the kinetic one: none of its own
  EXPECT_EQ(friction_coefficient(law, 0.), 0.4);
}

TEST(ContactLaw, at_new_velocity_is_contact_force_at_the_velocity_that_it_finds) {
  std::mt19937 rng(36);
  for (const ContactLawTraits& traits : contact_laws()) {
    if (!traits.at_new_velocity) continue;
    for (int trial = 0; trial < 200; ++trial) {
      SCOPED_TRACE(testing::Message() << "law " << traits.word << ", trial " << trial);
      ContactLaw law = random_law(rng, traits.kind, 1);
      ContactInput in = random_input(rng, 2e-3);
      double impedance = 2e4;
      if (trial % 2 == 1) {  // a light node that strikes a stiff floor
        law.alpha *= 1e3;
        law.restitution = 0;
        law.normal_speed = 1e-3;
        impedance = 1e5;
        in.velocity *= 10;
      }
      const Vec3 free = in.velocity;
      if (trial % 4 == 3) in.velocity = -free;  // the iteration begins elsewhere
      const ContactOutput out = traits.at_new_velocity(law, in, impedance, free);
      const ContactOutput at_it = contact_force(law, in);
      EXPECT_LT((impedance * (in.velocity - free) - out.force).norm(), 1e-9 * (1 + out.force.norm()));
      EXPECT_LT((at_it.force - out.force).norm(), 1e-7 * (1 + out.force.norm()));
    }
  }
}

TEST(ContactLaw, stick_spring_breaks_away_at_mu_N) {
  std::mt19937 rng(33);
  for (int trial = 0; trial < 50; ++trial) {
    const ContactLaw law = random_law(rng, ContactLawKind::coulomb, 1);
    ContactInput in = random_input(rng, 0);
    in.velocity.setZero();
    const Vec3 along = in.normal.cross(random_direction(rng)).normalized();
    const double k = k_stick_stiffness * law.alpha / in.L;
    const double limit = (law.friction + law.excess()) * penalty_force(law, in.depth);
    SCOPED_TRACE(trial);
    for (double share : {0.2, 0.999, 1.001, 3.}) {
      in.stick = share * limit / k * along;
      const ContactOutput out = contact_force(law, in);
      const double held = std::min(1., share) * limit;
      EXPECT_LT((out.tangential + held * along).norm(), 1e-12 * limit);
      EXPECT_LT((out.stick - held / k * along).norm(), 1e-12 * limit / k);
      EXPECT_NEAR(out.stick_energy, held * held / (2 * k), 1e-12 * limit * limit / k);
    }
  }
}

// Along any path of the tangential travel, with any history of the normal force: the work done on the body by
// friction over a step (force at its end) never exceeds what the stick spring gives up.
TEST(ContactLaw, friction_never_adds_energy) {
  std::mt19937 rng(34);
  std::uniform_real_distribution<double> u(0, 1);
  for (int history = 0; history < 50; ++history) {
    const ContactLaw law = random_law(rng, ContactLawKind::coulomb, 1);
    ContactInput in = random_input(rng, 0);
    const double h = std::pow(10, -5 + 3 * u(rng));
    const double scale = law.friction * law.alpha * in.depth / (k_stick_stiffness * law.alpha / in.L);
    double stored = 0, dissipated = 0;
    Vec3 stick = Vec3::Zero(), heading = random_direction(rng);
    for (int i = 0; i < 300; ++i) {
      if (u(rng) < 0.2) heading = random_direction(rng);
      const Vec3 travel =
          scale * std::pow(10, -2 + 2.5 * u(rng)) * (heading - in.normal.dot(heading) * in.normal);
      in.depth = std::clamp(in.depth + 0.1 * (u(rng) - 0.5), 0.05, 0.9);
      in.velocity = travel / h;
      in.stick = stick + travel;
      const ContactOutput out = contact_force(law, in);
      ASSERT_LE(out.tangential.norm(), (law.friction + law.excess()) * out.normal * (1 + 1e-12));
      const double lost = -out.tangential.dot(travel) - (out.stick_energy - stored);
      ASSERT_GE(lost, -1e-12 * (std::abs(out.tangential.dot(travel)) + stored))
          << "history " << history << ", step " << i;
      dissipated += lost;
      stored = out.stick_energy;
      stick = out.stick;
    }
    EXPECT_GT(dissipated, 0);
  }
}

TEST(ContactLaw, drag_of_the_paper_law_opposes_the_motion) {
  std::mt19937 rng(35);
  for (int trial = 0; trial < 100; ++trial) {
    const ContactLaw law = random_law(rng, ContactLawKind::paper, 1);
    const ContactInput in = random_input(rng, 0);
    const ContactOutput out = contact_force(law, in);
    EXPECT_LE((out.force - out.conservative * in.normal).dot(in.velocity), 0);
  }
}

// Travel and depth stay: the ledger must find all that the springs gain, and friction gives back what it
// books for stick springs by their energy alone.
TEST(LawChange, books_what_springs_gain_as_the_law_changes_and_no_more) {
  ContactLaw before, after;
  after.alpha = 3 * before.alpha;
  const double depth = 0.2, L = 0.03, stick_before = 0.4, stick_after = 3 * stick_before;
  StepEnergy booked{};
  LawChange change(before, after, booked);
  change.book_start(depth, L, stick_before);
  change.book_end(depth, L, stick_after);
  const double stick = stick_after - stick_before;
  const double normal = penalty_energy(after, depth, L) - penalty_energy(before, depth, L);
  EXPECT_NEAR(booked.friction, stick, 1e-12 * stick);
  EXPECT_NEAR(booked.input, normal + stick, 1e-12 * (normal + stick));
}

}  // namespace
}  // namespace topple::test
