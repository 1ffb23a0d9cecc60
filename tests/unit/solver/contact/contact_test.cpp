// Contact laws at work: impacts, rest, friction, all on a body that meets the floor flat.
#include <gtest/gtest.h>

#include "solver/contact/contact_law.h"
#include "solver/frame/central_difference.h"
#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

constexpr double k_mass = 3, k_width = 0.06;
const Integrator k_integrators[] = {Integrator::generalized_alpha, Integrator::central_difference};

// Height of the nodes when surfaces touch, l = L.
constexpr double k_touch = k_width / 2;

// For any P(x) the impact m v dv/dx = -+P (1 -+ m_n v/sqrt(v^2 + eps^2)) separates: the speeds in and out
// follow from the integral of u/(1 +- m_n u/sqrt(u^2 + eps^2)) alone.
double exact_rebound(double loss, double eps, double v_in) {
  const auto impulse = [&](double sign, double v) {
    const int n = 20000;
    double sum = 0;
    for (int i = 0; i < n; ++i) {
      const double u = (i + 0.5) * v / n;
      sum += u / (1 + sign * loss * u / std::sqrt(u * u + eps * eps));
    }
    return sum * v / n;
  };
  const double target = impulse(1, v_in);
  double low = 0, high = v_in;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (impulse(-1, middle) < target ? low : high) = middle;
  }
  return low / v_in;
}

struct Rebound {
  double ratio;
  double highest;  // m/s, greatest separating speed while touching
};

// Normal impact without gravity, 2000 steps per half period of the contact.
Rebound rebound(const ContactLaw& law, double v, Integrator integrator) {
  Parameters p = weightless();
  p.contact = law;
  p.integrator = integrator;
  const double stiffness = 3 * law.alpha / k_width;
  p.time_step = k_pi * std::sqrt(k_mass / stiffness) / 2000;
  BodyStart start;
  start.velocity = {0, 0, -v};
  Simulation sim(sled(k_mass, k_width, k_touch), {start}, p);
  Rebound result{0, -v};
  for (int i = 0; i < 20000; ++i) {
    if (!sim.advance(1)) break;
    result.highest = std::max(result.highest, sim.state.velocity[0].z());
    if (sim.state.position[0].z() > k_touch) {
      result.ratio = sim.state.velocity[0].z() / v;
      break;
    }
  }
  return result;
}

ContactLaw impact_law(ContactLawKind kind) {
  ContactLaw law;
  law.kind = kind;
  law.alpha = 500;
  law.normal_speed = law.slip_speed = 0.005;
  return law;
}

TEST(Contact, coulomb_law_returns_with_the_restitution_asked) {
  for (Integrator integrator : k_integrators)
    for (double e : {0.2, 0.5, 0.8})
      for (double q : {1., 2.}) {
        ContactLaw law = impact_law(ContactLawKind::coulomb);
        law.restitution = e;
        law.q = q;
        const double v = 20 * law.normal_speed * (q == 2 ? 5 : 1);
        SCOPED_TRACE(testing::Message() << "integrator " << static_cast<int>(integrator) << ", e " << e
                                        << ", q " << q << ", v/eps " << v / law.normal_speed);
        const double ratio = rebound(law, v, integrator).ratio;
        // the last step overshoots the surface by half its length on average: 1/2000 of the contact
        EXPECT_NEAR(ratio, exact_rebound(normal_loss(e), law.normal_speed, v), 1e-3);
        if (e >= 0.5) {
          EXPECT_NEAR(ratio, e, 0.01);
        }
      }
}

TEST(Contact, coulomb_law_tends_to_the_restitution_asked_as_eps_shrinks) {
  for (double e : {0.2, 0.5, 0.8}) {
    double last = 1;
    for (double speed : {10., 20., 100., 1000.}) {
      const double off = std::abs(exact_rebound(normal_loss(e), 1, speed) - e);
      EXPECT_LT(off, last);
      last = off;
    }
    EXPECT_LT(last, 1e-3) << e;
  }
}

TEST(Contact, paper_law_returns_with_the_root_of_1_minus_mu_over_1_plus_mu) {
  for (Integrator integrator : k_integrators)
    for (double mu : {0.3, 0.6}) {
      ContactLaw law = impact_law(ContactLawKind::paper);
      law.friction = mu;
      const double v = 50 * law.slip_speed;
      SCOPED_TRACE(testing::Message() << "integrator " << static_cast<int>(integrator) << ", mu " << mu);
      const double ratio = rebound(law, v, integrator).ratio;
      EXPECT_NEAR(ratio, exact_rebound(mu, law.slip_speed, v), 1e-3);
      EXPECT_NEAR(ratio, std::sqrt((1 - mu) / (1 + mu)), 5e-3);
    }
}

TEST(Contact, printed_law_does_not_rebound) {
  for (Integrator integrator : k_integrators) {
    const Rebound r = rebound(impact_law(ContactLawKind::printed), 0.3, integrator);
    EXPECT_EQ(r.ratio, 0);
    // braked by a force without spring: never turns back beyond rounding
    EXPECT_LT(r.highest, 1e-9);
  }
}

TEST(Contact, perfect_restitution_without_friction_keeps_the_energy) {
  ContactLaw law = impact_law(ContactLawKind::coulomb);
  law.restitution = 1;
  for (Integrator integrator : k_integrators)
    for (double q : {1., 2.}) {
      law.q = q;
      EXPECT_NEAR(rebound(law, 0.5, integrator).ratio, 1, 1e-5) << "q " << q;
    }
}

TEST(Contact, static_depth_is_the_load_share_over_alpha_to_the_power_1_over_q) {
  for (double q : {1., 2.})
    for (double alpha : {100., 500., 2000.}) {
      SCOPED_TRACE(testing::Message() << "q " << q << ", alpha " << alpha);
      Parameters p;
      p.contact.alpha = alpha;
      p.contact.q = q;
      Simulation sim(sled(k_mass, k_width, k_touch), {BodyStart{}}, p, true);
      const double exact = std::pow(k_mass * k_g / (3 * alpha), 1 / q);
      ASSERT_EQ(sim.contacts().size(), 3u);
      for (const ContactForce& f : sim.contacts()) {
        // settled to 1e-10 of the weight and the rounding of a bar of 2.4e8 N/m, 4e-8 N
        EXPECT_NEAR(f.depth, exact, 1e-8 * exact);
        EXPECT_NEAR(f.normal, k_mass * k_g / 3, 5e-8);
      }
    }
}

// Gravity turned by `angle` is an inclined plane.
Parameters inclined(double angle) {
  Parameters p;
  p.gravity = k_g * Vec3(std::sin(angle), 0, -std::cos(angle));
  p.contact.alpha = 1000;
  p.contact.friction = 0.6;
  return p;
}

TEST(Contact, nothing_creeps_on_an_inclined_plane_below_the_friction_angle) {
  for (double share : {0.5, 0.98}) {
    Parameters p = inclined(std::atan(share * 0.6));
    p.time_step = 2e-3;
    Simulation sim(sled(k_mass, k_width, k_touch), {BodyStart{}}, p, true);
    const std::vector<Vec3> before = sim.state.position;
    ASSERT_TRUE(sim.advance(5000));
    for (std::size_t i = 0; i < before.size(); ++i)
      // 10 s; what the settling left out of balance swings with 1e-10 of the static depth
      EXPECT_LT((sim.state.position[i] - before[i]).norm(), 1e-10) << "share " << share;
  }
}

TEST(Contact, a_body_breaks_away_at_the_friction_angle_and_slides_with_mu_g) {
  for (Integrator integrator : k_integrators) {
    Parameters p = inclined(0);
    p.integrator = integrator;
    p.time_step = 2e-5;
    Simulation sim(sled(k_mass, k_width, k_touch), {BodyStart{}}, p, true);
    // a horizontal push that grows to 0.97, 1.03 and 2 times mu g
    const auto push_to = [&](double from, double to, double seconds) {
      const int steps = static_cast<int>(std::lround(seconds / p.time_step));
      for (int i = 1; i <= steps; ++i) {
        sim.parameters.gravity.x() = (from + (to - from) * i / steps) * 0.6 * k_g;
        if (!sim.advance(1)) return;
      }
    };
    push_to(0, 0.97, 0.2);
    const double elastic = 0.6 * k_mass * k_g / (3 * k_stick_stiffness * 1000 / k_width);
    EXPECT_LT(sim.state.position[0].x() + 0.1, 1.05 * elastic);
    push_to(0.97, 1.03, 0.05);
    push_to(1.03, 1.03, 0.1);
    EXPECT_GT(sim.state.position[0].x() + 0.1, 1.2 * elastic);
    push_to(1.03, 2, 0.01);
    const double v0 = sim.state.velocity[0].x();
    push_to(2, 2, 0.1);
    // a slides the difference: 2 mu g - mu g
    EXPECT_NEAR((sim.state.velocity[0].x() - v0) / 0.1, 0.6 * k_g, 1e-4 * k_g);
  }
}

// Travel of one half cycle between two stops.
double slip_per_half_cycle(double a0, double w, double eta) {
  const double phi = std::asin(eta);
  double low = phi + 1e-3, high = phi + k_pi;
  for (int i = 0; i < 80; ++i) {
    const double t = (low + high) / 2;
    (std::cos(phi) - std::cos(t) > eta * (t - phi) ? low : high) = t;
  }
  const double d = low - phi;
  return a0 / (w * w) * (d * std::cos(phi) - (std::sin(low) - std::sin(phi)) - eta * d * d / 2);
}

TEST(Contact, sliding_on_a_shaken_floor_travels_as_a_rigid_block) {
  const double a0 = 7, w = 4 * k_pi;
  for (const auto& [mu, published] : {std::pair{0.6, 5.2423e-3}, std::pair{0.5, 19.109e-3}}) {
    SCOPED_TRACE(mu);
    const double exact = slip_per_half_cycle(a0, w, mu * k_g / a0);
    EXPECT_NEAR(exact, published, 5e-7);
    Parameters p;
    p.contact.alpha = 1e4;
    p.contact.friction = mu;
    p.time_step = 1e-4;
    Shake shake;
    shake.amplitude = a0;
    shake.frequency = 2;
    p.shakes.push_back(shake);
    Simulation sim(sled(k_mass, k_width, k_touch), {BodyStart{}}, p, true);
    // stops lie about the zeros of the acceleration: the second cycle's are taken
    double stops[3];
    for (int k = 0; k < 3; ++k) {
      const int until =
          static_cast<int>(std::lround((0.5 + 0.25 * k + (std::asin(mu * k_g / a0) - 0.05) / w) / 1e-4));
      ASSERT_TRUE(sim.advance(until - static_cast<int>(sim.state.step)));
      EXPECT_LT(std::abs(sim.state.velocity[0].x()), 1e-3);
      stops[k] = sim.state.position[0].x();
    }
    // the stick spring still swings by the elastic travel before breakaway, mu W/3 over its stiffness
    const double elastic = mu * k_mass * k_g / (3 * k_stick_stiffness * 1e4 / k_width);
    ASSERT_LT(2 * elastic, 4e-3 * exact);
    EXPECT_NEAR(std::abs(stops[1] - stops[0]), exact, 2 * elastic);
    EXPECT_NEAR(std::abs(stops[2] - stops[1]), exact, 2 * elastic);
    EXPECT_LT((stops[1] - stops[0]) * (stops[2] - stops[1]), 0);
  }
}

TEST(Contact, a_body_thrown_on_the_floor_only_loses_energy) {
  std::mt19937 rng(41);
  for (ContactLawKind kind : {ContactLawKind::coulomb, ContactLawKind::paper, ContactLawKind::printed})
    for (Integrator integrator : k_integrators)
      for (int trial = 0; trial < 3; ++trial) {
        SCOPED_TRACE(testing::Message() << "law " << static_cast<int>(kind) << ", integrator "
                                        << static_cast<int>(integrator) << ", trial " << trial);
        Parameters p;
        p.contact.kind = kind;
        p.integrator = integrator;
        p.time_step = 2e-5;
        BodyStart start;
        start.velocity = random_vector(rng, 1);
        Simulation sim(sled(k_mass, k_width, k_touch + 0.01), {start}, p);
        const auto total = [&] {
          return kinetic_energy(sim.model, sim.state) +
                 k_mass * k_g * centre_of_mass(sim.model, sim.state).z() + sim.state.energy.contact +
                 sim.state.energy.strain;
        };
        const double first = total();
        double last = first;
        for (int i = 0; i < 200; ++i) {
          ASSERT_TRUE(sim.advance(50));
          // the integrators' own error over 50 steps of h w = 1e-3
          ASSERT_LT(total(), last + 1e-6 * std::abs(first)) << "at " << sim.state.time;
          last = total();
        }
        EXPECT_LT(last, first - 0.05);
      }
}

}  // namespace
}  // namespace topple::test
