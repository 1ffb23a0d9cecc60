// Theory of a rigid body on penalty contacts, and the same through the solver.
#include "solver/study/common/standing.h"

#include <gtest/gtest.h>

#include <cmath>

#include "solver/io/scene/scene.h"
#include "solver/study/common/alone.h"
#include "solver/study/penalty/contact_trials.h"
#include "solver/study/penalty/impact.h"

namespace topple::study {
namespace {

/// A block of 40 kg on three rows of three contacts, as a cabinet has.
Standing block(double base, double height) {
  Standing body{.direction = Vec3::UnitX(),
                .edge = Vec3::Zero(),
                .mass = 40,
                .gravity = k_standard_gravity,
                .base = base,
                .height = height,
                .inertia_of_edge = 40 * 4. / 3 * (base * base + height * height),
                .contacts = {}};
  for (const double x : {-base, 0., base})
    for (const double y : {-0.4, 0., 0.4}) body.contacts.push_back({x, y, 0.06, 0});
  return body;
}

ContactLaw law(double alpha_kgf, double q = 1) {
  ContactLaw out;
  out.alpha = alpha_kgf * k_standard_gravity;
  out.q = q;
  return out;
}

TEST(Standing, rests_as_deep_as_the_formula_says) {
  const Standing body = block(0.19, 1.05);
  for (const double q : {0.5, 1., 1.5, 2., 3.})
    for (const double alpha : {50., 1000., 50000.}) {
      const double expected = std::pow(body.weight() / (9 * law(alpha).alpha), 1 / q);
      EXPECT_NEAR(rest_depth(body, law(alpha, q)) / expected, 1, 1e-9) << q << " " << alpha;
    }
}

TEST(Standing, off_its_middle_leans_until_the_contacts_balance) {
  Standing body = block(0.19, 1.05);
  for (Standing::Contact& contact : body.contacts) contact.across += 0.05;
  // linear: W/9 (1 + 3/2 (0.05/0.4) (0.45 - 0.05)/0.4 ...) at the row that the centre of gravity is nearest
  // to
  const double mean = body.weight() / (9 * law(1000).alpha), slope = 0.05 / (6. / 9 * 0.4 * 0.4);
  EXPECT_NEAR(rest_depth(body, law(1000)) / mean, 1 + slope * 0.4, 1e-9);
}

TEST(Standing, bounces_with_the_frequency_of_a_mass_on_springs) {
  const Standing body = block(0.19, 1.05);
  for (const double q : {1., 2.}) {
    const ContactLaw contact = law(500, q);
    const double depth = std::pow(body.weight() / (9 * contact.alpha), 1 / q);
    const double stiffness = 9 * q * contact.alpha / 0.06 * std::pow(depth, q - 1);
    EXPECT_NEAR(bounce_frequency(body, contact), std::sqrt(stiffness / 40) / (2 * k_pi), 1e-8);
    const double period = 1 / bounce_frequency(body, contact);
    EXPECT_NEAR(alpha_for_period(body, law(1, q), period) / contact.alpha, 1, 1e-6);
  }
}

TEST(Standing, tips_as_the_closed_form_of_stiff_contact_says) {
  const double b = 0.19, h = 1.05, L = 0.06;
  const Standing body = block(b, h);
  const double lost = 0.02;
  for (const double q : {1., 1.5, 2.}) {
    const double alpha = body.weight() / 3 * std::pow(L * h / (b * b * lost), q);
    ContactLaw contact = law(1, q);
    contact.alpha = alpha;
    const double ratio = alpha_for_tipping(body, contact, lost) / alpha;
    if (q == 1) {
      EXPECT_NEAR(ratio, 1, 1e-5);
      EXPECT_NEAR(tipping_limit(body, contact) / (b / h), 1 - lost, 1e-6);
    } else {  // the greatest moment comes shortly before the row lifts
      EXPECT_LT(ratio, 1) << q;
      EXPECT_GT(ratio, 0.98) << q;
    }
  }
  EXPECT_EQ(tipping_limit(body, law(5)), 0);  // rocking stiffness below m g h
}

// A stopper lifts the side that is pushed away from: that the body leans is no matter of alpha.
TEST(Standing, one_on_a_stopper_is_as_stiff_as_contacts_are) {
  const double b = 0.19, h = 1.05, lift = 0.01, lost = 0.02;
  Standing body = block(b, h);
  for (Standing::Contact& contact : body.contacts)
    if (contact.place < -0.9 * b) contact.sunk += lift;
  const double leans = b / h - lift / (2 * b);
  ContactLaw contact = law(1, 1);
  EXPECT_NEAR(stiff_limit(body, contact), leans, 1e-5);
  contact.alpha = alpha_for_tipping(body, contact, lost);
  EXPECT_NEAR(tipping_limit(body, contact), (1 - lost) * leans, 1e-5);
  EXPECT_LT(contact.alpha, 1e4 * body.weight());
}

TEST(Standing, rigid_rocking_has_the_limits_of_slender_blocks) {
  const Standing body = block(1e-3, 1);
  EXPECT_NEAR(body.p(), std::sqrt(0.75 * k_standard_gravity), 1e-5);
  EXPECT_NEAR(fall_back_time(body) * body.p(), std::acosh(2), 1e-6);
  for (const auto& [ratio, expected] : {std::pair{2., 1.8007}, {4., 2.7908}, {6., 3.7882}})
    EXPECT_NEAR(least_half_sine(body, ratio) / 1e-3, expected, 1e-4) << ratio;
}

TEST(Standing, of_a_scene_is_what_its_body_is) {
  const topple::Setup scene = io::load_scene("paper-a").setup;
  const Standing body = standing(scene.model, scene.parameters, 0);
  EXPECT_NEAR(body.base, 0.19, 1e-9);
  EXPECT_NEAR(body.height, 1.05, 1e-9);
  EXPECT_EQ(body.contacts.size(), 9u);
  EXPECT_NEAR(std::abs(body.direction.x()), 1, 1e-12);
  for (const Standing::Contact& contact : body.contacts) {
    EXPECT_NEAR(contact.L, 0.06, 1e-12);
    EXPECT_NEAR(contact.sunk, 0, 1e-9);
  }
}

TEST(Alone, a_body_settles_as_it_does_among_others) {
  const topple::Setup scene =
      io::load_scene("paper-a", {"cabinet.free.model=frame", "cabinet.walled.model=frame"}).setup;
  const topple::Run all(scene);
  for (int b = 0; b < 2; ++b) {
    const topple::Setup own = alone(scene, b, true);
    const topple::Run one(own);
    const Body& body = scene.model.bodies[b];
    for (int i = 0; i < body.node_count; ++i)
      EXPECT_EQ(one.state().position[i], all.state().position[body.first_node + i]);
    EXPECT_EQ(own.model.planes.size(), 2u);
    EXPECT_EQ(alone(scene, b, false).model.planes.size(), 1u);
  }
}

TEST(Alone, bodies_that_differ_by_their_place_are_alike) {
  const Model a = io::load_scene("paper-a").setup.model, b = io::load_scene("paper-b").setup.model;
  EXPECT_TRUE(alike(a, 0, 1));
  EXPECT_FALSE(alike(b, 0, 1));
  EXPECT_FALSE(alike(io::load_scene("paper-a", {"cabinet.walled.mass=41"}).setup.model, 0, 1));
}

// Side by side both ends are held; of two that stand on each other the upper one is.
TEST(Alone, an_anchor_holds_both_that_stand_side_by_side_and_the_upper_of_a_stack) {
  Model model = io::load_scene("paper-a").setup.model;
  Anchor anchor{};
  anchor.body = 0;
  anchor.other.body = -1;
  EXPECT_TRUE(holds(model, anchor, 0));
  EXPECT_FALSE(holds(model, anchor, 1));
  anchor.other.body = 1;
  EXPECT_TRUE(holds(model, anchor, 0));
  EXPECT_TRUE(holds(model, anchor, 1));
  model.bodies[0].base_centre.z() += 1;
  EXPECT_TRUE(holds(model, anchor, 0));
  EXPECT_FALSE(holds(model, anchor, 1));
}

TEST(Alone, what_does_not_stand_says_why) {
  Model model = io::load_scene("paper-a").setup.model;
  EXPECT_EQ(why_not_standing(model, 0), "");
  model.supports.push_back({0, 1u});
  EXPECT_EQ(why_not_standing(model, 0), "is held by supports");
  model.supports.clear();
  model.planes[0].point.z() = -0.5;
  EXPECT_EQ(why_not_standing(model, 0), "does not touch the floor");
  model.bodies[0].centre_of_gravity.x() += 0.2;
  EXPECT_EQ(why_not_standing(model, 0), "has its centre of gravity beside its base");
  model.bodies[0].support_polygon.clear();
  EXPECT_EQ(why_not_standing(model, 0), "has no base");
  model.planes.clear();
  EXPECT_EQ(why_not_standing(model, 0), "has no level floor below it");
}

/// A cabinet of paper-a on stiff contact, and what theory says of it.
struct Stiff {
  topple::Setup body = alone(io::load_scene("paper-a", {"contact.alpha=2000 kgf"}).setup, 0, false);
  Standing theory = standing(body.model, body.parameters, 0);
};

TEST(ContactTrials, rest_bounce_and_tipping_follow_theory) {
  const Stiff s;
  const ContactLaw& contact = s.body.parameters.contact;
  EXPECT_NEAR(*settled_depth(s.body).value / rest_depth(s.theory, contact), 1, 0.012);  // the frame bends
  const double frequency = bounce_frequency(s.theory, contact);
  EXPECT_NEAR(*settled_frequency(s.body, frequency).value / frequency, 1, 0.008);
  EXPECT_NEAR(*settled_tipping_limit(s.body, s.theory).value / tipping_limit(s.theory, contact), 1, 1e-3);
  EXPECT_NEAR(*fall_back(s.body, s.theory).value / fall_back_time(s.theory), 1, 1e-3);
}

TEST(ContactTrials, soft_contact_tips_early_and_too_soft_contact_does_not_carry) {
  Stiff s;
  ContactLaw& contact = s.body.parameters.contact;
  contact = law(50);
  const double limit = *settled_tipping_limit(s.body, s.theory).value;
  EXPECT_NEAR(limit / tipping_limit(s.theory, contact), 1, 0.025);
  EXPECT_LT(limit, 0.6 * s.theory.rigid_limit());
  contact = law(5);
  EXPECT_EQ(settled_depth(s.body).status, "not settled");
  EXPECT_EQ(settled_tipping_limit(s.body, s.theory).status, "not settled");
  EXPECT_FALSE(fall_back(s.body, s.theory).value);
}

TEST(ContactTrials, half_sine_of_a_block_on_hard_contact_is_that_of_theory) {
  const topple::Setup scene = io::load_scene("verify/rocking-half-sine-4-below").setup;
  const topple::Setup body = alone(scene, 0, false);
  const Standing theory = standing(body.model, body.parameters, 0);
  const double expected = least_half_sine(theory, 4);
  const ContactTrial trial = overturning_half_sine(body, theory, 4, expected);
  ASSERT_TRUE(trial.value) << trial.status;
  EXPECT_NEAR(*trial.value / expected, 1, 0.004);
}

TEST(ContactTrials, coulomb_does_not_creep_and_the_printed_law_sinks) {
  Stiff s;
  EXPECT_LT(*creep(s.body, 1).value, 1e-9);
  s.body.parameters.contact.kind = ContactLawKind::printed;
  EXPECT_GT(*creep(s.body, 1).value, 1e-5);
}

TEST(Impact, quadrature_reaches_the_restitution_asked) {
  ContactLaw contact;
  for (const double e : {0.2, 0.5, 0.8, 1.}) {
    contact.restitution = e;
    EXPECT_NEAR(restitution(contact, 1e3 * contact.normal_speed), e, 2e-3) << e;
  }
  contact.restitution = 0.5;
  EXPECT_NEAR(restitution(contact, 10 * contact.normal_speed), 0.525, 1e-3);
  EXPECT_NEAR(restitution(contact, 2 * contact.normal_speed), 0.651, 1e-3);
  contact.kind = ContactLawKind::paper;
  EXPECT_NEAR(restitution(contact, 1e3 * contact.slip_speed), 0.5, 2e-3);
  contact.kind = ContactLawKind::printed;
  EXPECT_EQ(restitution(contact, 1), 0);
}

TEST(Impact, the_solver_returns_what_quadrature_says) {
  const ImpactMass body{40, 9, 0.06};
  Parameters parameters;
  for (const ContactLawKind kind : {ContactLawKind::coulomb, ContactLawKind::paper})
    for (const double q : {1., 2.})
      for (const double speed : {0.005, 0.05, 0.5}) {
        parameters.contact.kind = kind;
        parameters.contact.q = q;
        const ContactTrial trial = impact(body, parameters, speed);
        ASSERT_TRUE(trial.value);
        EXPECT_NEAR(*trial.value, restitution(parameters.contact, speed), 0.005) << q << " " << speed;
      }
  parameters.contact.kind = ContactLawKind::printed;
  const ContactTrial trial = impact(body, parameters, 0.5);
  EXPECT_EQ(trial.value, 0);
  EXPECT_EQ(trial.status, "does not leave the floor");
}

}  // namespace
}  // namespace topple::study
