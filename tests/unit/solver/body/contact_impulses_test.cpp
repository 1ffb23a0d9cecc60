#include "solver/reduced/contact_impulses.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "solver/math/rotation.h"

namespace topple::test::contact_impulses {
namespace {

constexpr double k_mass = 20, k_h = 2e-3, k_length = 0.03;

ContactLaw stiff_law() {
  ContactLaw law;
  law.alpha = 1e6;
  return law;
}

/// A ball of radius 0.4 m, with a pull of F, N.
ContactImpulses::RigidBody ball(const Vec3& linear, const Vec3& pull, double mass = k_mass) {
  const double inertia = 0.4 * mass * 0.16;
  return {mass,           inertia,   0.4,          diagonal(PackVector<double>{inertia, inertia, inertia}),
          packed(linear), {0, 0, 0}, packed(pull), {0, 0, 0}};
}

NearContact under(const Vec3& arm, double gap, const ContactLaw& law) {
  NearContact contact{
      Vec3::UnitZ(), {arm, Vec3::Zero()}, Vec3::Zero(), -gap / k_length, k_length, law.alpha, 0, 0};
  const auto [k, c] = StickSpring(law.alpha, k_length, k_mass);
  contact.stick_stiffness = k;
  contact.stick_damping = c;
  return contact;
}

/// The root of a function that rises, in [low, high].
double root(const std::function<double(double)>& f, double low, double high) {
  for (int k = 0; k < 200; ++k) {
    const double middle = (low + high) / 2;
    (f(middle) < 0 ? low : high) = middle;
  }
  return low;
}

// One contact under the centre: the velocity along its normal solves one equation, here by bisection,
//   m (u - u0) = h (F + P(gap + theta h/2 u) (1 - u/sqrt(u^2 + eps^2))),  theta = w^2/(16 + w^2),
// and friction takes mu N h of the momentum across.
TEST(ContactImpulses, one_contact_takes_what_the_law_says) {
  const ContactLaw law = stiff_law();
  const PreparedLaw prepared(law);
  for (const double gap : {-2e-4, 0., 1e-3, 3e-3})
    for (const double speed : {0.5, 1., 2.}) {
      const Vec3 start(3, 0, -speed), pull(0, 0, -k_mass * k_standard_gravity);
      ContactImpulses impulses;
      impulses.begin(prepared, k_h);
      impulses.add(ball(start, pull), {packed(start), {0, 0, 0}});
      impulses.add(0, -1, 1, false, under(Vec3::Zero(), gap, law));
      BlockLu matrix(1, {});
      ASSERT_TRUE(impulses.solve(matrix));
      const double turn = k_h * impulses.frequency(), theta = turn * turn / (16 + turn * turn);
      EXPECT_NEAR(turn, k_h * std::sqrt(law.alpha / k_length / k_mass), 1e-12);
      const auto normal = [&](double u) {
        const double depth = std::max(0., -(gap + theta * k_h / 2 * u) / k_length);
        return law.alpha * depth * (1 - u / std::hypot(u, law.normal_speed));
      };
      const double expected =
          root([&](double u) { return k_mass * (u + speed) - k_h * (pull.z() + normal(u)); }, -3, 3);
      const PackVector<double> u = impulses.velocities()[0].linear;
      EXPECT_NEAR(u.z, expected, 1e-6 * speed) << gap;  // Newton ends at 1e-7
      const double pushed = k_mass * (u.z + speed) - k_h * pull.z();
      EXPECT_NEAR(k_mass * (start.x() - u.x), law.friction * pushed, 1e-6 * k_mass) << gap;
    }
}

// What contacts take is what the bodies lose, whatever touches: twenty boxes thrown together.
TEST(ContactImpulses, energy_and_momentum_go_where_they_are_booked) {
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> any(-1, 1);
  const auto vector = [&](double size) { return Vec3(size * Vec3(any(rng), any(rng), any(rng))); };
  const ContactLaw law = stiff_law();
  const PreparedLaw prepared(law);
  int slipped = 0;
  for (int trial = 0; trial < 20; ++trial) {
    ContactImpulses impulses;
    impulses.begin(prepared, k_h);
    std::vector<ContactImpulses::RigidBody> bodies;
    for (int b = 0; b < 3; ++b) {
      bodies.push_back(ball(vector(1), Vec3::Zero(), 10 + 10 * b));
      bodies.back().angular = packed(vector(1));
      impulses.add(bodies.back(), {bodies.back().linear, bodies.back().angular});
    }
    std::vector<int> contacts;
    for (int b = 0; b < 2; ++b)
      for (int k = 0; k < 6; ++k) {
        NearContact contact = under(vector(0.3), 1e-3 * any(rng), law);
        contact.normal = Vec3(vector(1) + Vec3(0, 0, 2)).normalized();
        contact.arm[1] = vector(0.3);
        contacts.push_back(impulses.add(b, b + 1, 1, true, contact));
      }
    BlockLu matrix(3, {{1, 0}, {2, 1}});
    ASSERT_TRUE(impulses.solve(matrix)) << trial;
    const ContactImpulses::Work work = impulses.finish();
    double lost = 0, most = 0;
    Vec3 momentum = Vec3::Zero(), before = Vec3::Zero();
    for (int b = 0; b < 3; ++b) {
      const auto& [linear, angular] = impulses.velocities()[b];
      const auto energy = [&](const PackVector<double>& v, const PackVector<double>& w) {
        return 0.5 * (bodies[b].mass * dot(v, v) + dot(w, bodies[b].inertia * w));
      };
      lost += energy(bodies[b].linear, bodies[b].angular) - energy(linear, angular);
      most += energy(bodies[b].linear, bodies[b].angular);
      momentum += bodies[b].mass * unpacked(linear);
      before += bodies[b].mass * unpacked(bodies[b].linear);
    }
    // Newton ends at 1e-7 of the speed
    EXPECT_NEAR(work.normal + work.friction, lost, 1e-6 * most) << trial;
    EXPECT_LT((momentum - before).norm(), 1e-6 * before.norm()) << trial;
    for (const int contact : contacts) slipped += impulses.stick(contact).norm() > 0 ? 1 : 0;
  }
  EXPECT_GT(slipped, 0);
}

// A spring that slipped holds mu N/k, along the way.
TEST(ContactImpulses, stick_springs_are_cut_to_what_friction_bears) {
  const ContactLaw law = stiff_law();
  const PreparedLaw prepared(law);
  ContactImpulses impulses;
  impulses.begin(prepared, k_h);
  const Vec3 start(2, 0, 0);
  impulses.add(ball(start, Vec3(0, 0, -k_mass * k_standard_gravity)), {packed(start), {0, 0, 0}});
  const NearContact contact = under(Vec3::Zero(), -1e-5, law);
  const int number = impulses.add(0, -1, 0.5, false, contact);
  BlockLu matrix(1, {});
  ASSERT_TRUE(impulses.solve(matrix));
  impulses.finish();
  const PackVector<double> u = impulses.velocities()[0].linear;
  const double normal = k_mass * (u.z / k_h + k_standard_gravity);
  const Vec3 stick = impulses.stick(number);
  EXPECT_NEAR(stick.x(), 0.5 * law.friction * normal / contact.stick_stiffness, 1e-6 * stick.x());
  EXPECT_EQ(stick.y(), 0);
  EXPECT_EQ(stick.z(), 0);
}

// Rows thrown about on stiff and soft contacts that start open and pressed in: velocities are found, of
// nearly all in the step that is asked for and of the others in an eighth of it, as steps are halved.
TEST(ContactImpulses, are_found_for_rows_of_bodies) {
  std::mt19937 rng(17);
  std::uniform_real_distribution<double> any(-1, 1);
  int in_parts = 0;
  for (int trial = 0; trial < 200; ++trial) {
    ContactLaw law = stiff_law();
    law.alpha = std::pow(10, 4.5 + 2 * any(rng));
    const PreparedLaw prepared(law);
    constexpr int k_bodies = 6;
    std::vector<ContactImpulses::RigidBody> bodies;
    std::vector<std::pair<int, int>> coupled;
    std::vector<NearContact> on_floor, between;
    for (int b = 0; b < k_bodies; ++b) {
      const Vec3 start(any(rng), 0.1 * any(rng), 0.2 * any(rng));
      bodies.push_back(ball(start, Vec3(0, 0, -k_mass * k_standard_gravity)));
      bodies.back().angular = {0, any(rng), 0.1 * any(rng)};
      for (const double x : {-0.15, 0.15})
        for (const double y : {-0.4, 0.4}) on_floor.push_back(under(Vec3(x, y, -0.9), 5e-4 * any(rng), law));
      if (b == 0) continue;
      coupled.emplace_back(b, b - 1);
      for (const double y : {-0.4, 0.4}) {
        between.push_back(under(Vec3(-0.15, y, 0.8), 1e-3 * any(rng), law));
        between.back().normal = Vec3::UnitX();
        between.back().arm[1] = Vec3(0.15, y, 0.8);
      }
    }
    BlockLu matrix(k_bodies, coupled);
    const auto found = [&](double h) {
      ContactImpulses impulses;
      impulses.begin(prepared, h);
      for (const auto& body : bodies) impulses.add(body, {body.linear, body.angular});
      for (int k = 0; k < 4 * k_bodies; ++k) impulses.add(k / 4, -1, 1, false, on_floor[k]);
      for (int k = 0; k < 2 * (k_bodies - 1); ++k) impulses.add(k / 2 + 1, k / 2, 1, true, between[k]);
      return impulses.solve(matrix);
    };
    double h = k_h;
    while (h > k_h / 16 && !found(h)) h /= 2;
    EXPECT_GT(h, k_h / 16) << trial;
    in_parts += h < k_h ? 1 : 0;
  }
  EXPECT_LT(in_parts, 30);
}

}  // namespace
}  // namespace topple::test::contact_impulses
