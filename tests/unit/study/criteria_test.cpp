// Criteria of overturning against closed forms and an independent integration.
#include "solver/study/overturn/criteria.h"

#include <gtest/gtest.h>

#include <cmath>

#include "solver/io/scene/scene.h"
#include "verification/housner.h"

namespace topple::study {
namespace {

/// A block with I = inertia m R^2 about its edge.
Standing block(double base, double height, double inertia) {
  return {.direction = Vec3::UnitX(),
          .edge = Vec3::Zero(),
          .mass = 40,
          .gravity = k_standard_gravity,
          .base = base,
          .height = height,
          .inertia_of_edge = 40 * inertia * (base * base + height * height),
          .contacts = {}};
}

TEST(Criteria, west_is_the_push_that_a_block_withstands) {
  EXPECT_DOUBLE_EQ(west_acceleration(block(0.19, 0.895, 4. / 3)), k_standard_gravity * 0.19 / 0.895);
}

// A blow that gives a uniform block the velocity v turns it at v m h/I; it passes its critical angle when
// I w^2/2 reaches m g R (1 - cos a). Ishiyama takes 0.4 of that v.
TEST(Criteria, ishiyama_is_two_fifths_of_the_blow_that_overturns) {
  for (const auto& [b, h] : {std::pair{0.19, 0.895}, {0.4, 0.6}}) {
    const Standing body = block(b, h, 4. / 3);
    const double r = std::hypot(b, h), inertia = body.inertia_of_edge;
    const double rate =
        std::sqrt(2 * 40 * k_standard_gravity * r * (1 - std::cos(body.critical())) / inertia);
    EXPECT_NEAR(ishiyama_velocity(body) / (0.4 * rate * inertia / (40 * h)), 1, 1e-12);
  }
}

// Values of rocking_block_test.cpp. 400 steps a pulse are within 1e-4 of 800.
TEST(Criteria, least_full_sines_are_those_of_housner) {
  for (const auto& [ratio, corners, uniform] : {std::tuple{2., 1.217703476, 1.220640488},
                                                {4., 1.698219757, 1.737093353},
                                                {6., 3.829277267, 4.198619003}}) {
    const auto over_limit = [ratio = ratio](const Standing& body) {
      return least_full_sine(body, ratio, 2).value() / body.rigid_limit();
    };
    EXPECT_NEAR(over_limit(block(0.2, 1, 2)) / corners, 1, 1e-4) << ratio;
    EXPECT_NEAR(over_limit(block(0.19, 0.895, 4. / 3)) / uniform, 1, 1e-4) << ratio;
  }
  EXPECT_FALSE(least_full_sine(block(0.2, 1, 2), 6, 0.5));
}

// Method 8: cosh(p t) = 1 + 1/(2 A (A - 1)), the limit of slender blocks, of which 0.02 rad is within 1e-4.
TEST(Criteria, least_rectangles_are_those_of_the_slender_limit) {
  for (const double a : {1.2, 2., 5.}) {
    const double length = std::acosh(1 + 1 / (2 * a * (a - 1)));
    const Standing body = block(0.02, 1, 4. / 3);
    EXPECT_NEAR(least_rectangle(body, length) / body.rigid_limit() / a, 1, 1e-3) << a;
  }
}

Criteria of(const std::string& scene_name, const std::string& x, const std::string& y,
            const std::vector<std::string>& set = {}) {
  const io::Scene scene = io::load_scene(scene_name, set);
  return criteria(scene.setup, parse_axis(x, scene), parse_axis(y, scene));
}

const std::string k_x = "shake.1.frequency=0.2..5:5", k_y = "shake.1.amplitude=1..10:5";

// b/h is 0.181.
TEST(Criteria, there_are_none_of_a_body_that_slides_before_it_lifts) {
  const Criteria slides = of("paper-a", k_x, k_y, {"contact.friction=0.18"});
  EXPECT_TRUE(slides.list.empty());
  EXPECT_NE(slides.why_not.find("lifts before it slides"), std::string::npos) << slides.why_not;
  EXPECT_FALSE(of("paper-a", k_x, k_y, {"contact.friction=0.182"}).list.empty());
  EXPECT_FALSE(of("paper-a", k_x, k_y, {"contact.friction=0.1", "contact.friction_static=0.2"}).list.empty());
}

TEST(Criteria, curves_are_in_the_units_of_the_axes) {
  const Criteria found = of("paper-a", k_x, k_y);
  EXPECT_EQ(found.why_not, "");
  EXPECT_EQ(found.bodies, "free, walled");
  ASSERT_EQ(found.list.size(), 3u);
  const double west = 100 * west_acceleration(found.body);
  EXPECT_NEAR(west, 177.5, 0.1);  // gal: 9.80665 0.19/1.05
  for (const Criterion& c : found.list) ASSERT_FALSE(c.y.empty()) << c.name;
  for (const double y : found.list[0].y) EXPECT_NEAR(y, west, 1e-9);
  // the sine's velocity is a/w
  const Criterion& ishiyama = found.list[1];
  for (std::size_t k = 0; k < ishiyama.x.size(); ++k)
    EXPECT_NEAR(ishiyama.y[k], 100 * 2 * k_pi * ishiyama.x[k] * ishiyama_velocity(found.body), 1e-9);
  for (const double y : found.list[2].y) EXPECT_GT(y, west);
}

Criteria of_shake(Shake::Kind kind, Shake::Shape shape) {
  io::Scene scene = io::load_scene("paper-a");
  Shake& shake = scene.setup.parameters.shakes[0];
  shake.kind = kind;
  shake.shape = shape;
  Axis x = parse_axis("shake.1.duration=0.1..2:5", scene);
  const Axis y = parse_axis(k_y, scene);
  x.entry = y.entry;  // the sine of the scene has no duration
  return criteria(scene.setup, x, y);
}

TEST(Criteria, a_pulse_from_rest_reaches_the_velocity_of_ishiyama) {
  // of amplitude 1 and duration 1, integrated
  for (const auto& [shape, velocity, name] : {std::tuple{Shake::Shape::half_sine, 2 / k_pi, "half-sine"},
                                              {Shake::Shape::full_sine, 1 / k_pi, "one-sine"},
                                              {Shake::Shape::rectangle, 1., "rectangle"}}) {
    const Criteria found = of_shake(Shake::Kind::pulse, shape);
    ASSERT_EQ(found.list.size(), 3u) << name;
    const Criterion& ishiyama = found.list[1];
    for (std::size_t k = 0; k < ishiyama.x.size(); ++k)
      EXPECT_NEAR(ishiyama.y[k] * velocity * ishiyama.x[k] / (100 * ishiyama_velocity(found.body)), 1, 1e-12);
    EXPECT_EQ(found.list[2].name, name);
  }
}

TEST(Criteria, a_motion_that_no_formula_is_known_of_has_wests_line_alone) {
  const Criteria found = of_shake(Shake::Kind::sweep, Shake::Shape::half_sine);
  EXPECT_EQ(found.why_not, "");
  ASSERT_EQ(found.list.size(), 1u);
  EXPECT_EQ(found.list[0].name, "west");
}

TEST(Criteria, where_they_do_not_hold_there_are_none) {
  EXPECT_EQ(of("paper-a", "contact.friction=0..1:3", k_y).why_not,
            "the axes are not frequency or duration, and amplitude, of one shake");
  EXPECT_EQ(of("paper-a", k_x, k_y, {"shake.1.direction=[1, 0, 1]"}).why_not, "the shake is not level");
  EXPECT_EQ(of("paper-a", k_x, k_y, {"shake.1.direction=[1, 1, 0]"}).why_not,
            "no body stands freely on the floor, bears nothing, has edges across the shake and lifts before "
            "it slides");
  // across the wide side: half of 880 mm
  const Criteria wide = of("paper-a", k_x, k_y, {"shake.1.direction=[0, 1, 0]"});
  EXPECT_NEAR(wide.body.base, 0.44, 1e-9);
}

}  // namespace
}  // namespace topple::study
