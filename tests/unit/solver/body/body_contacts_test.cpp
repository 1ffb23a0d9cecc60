// Contacts of bodies of few unknowns beside what each point alone does.
#include "solver/reduced/body_contacts.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "solver/reduced/elastic_basis.h"
#include "solver/reduced/reduced_body.h"
#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

const Vec3 k_tilted = Vec3(0.2, -0.3, 1).normalized();

/// A cabinet in any pose, pressed into a floor; on the level elastic with its modes at work.
struct Pressed {
  Model model = steel_model();
  BodyState state;
  PackMat3 rotation;
  std::vector<Vec3> stick;
  PreparedLaw law{ContactLaw{}};
  BodyVelocity velocity;
  int modes = 0;

  explicit Pressed(std::mt19937& rng, const Vec3& normal = k_tilted, ModelLevel level = ModelLevel::elastic) {
    add_cabinet(model, tall_cabinet());
    Body& body = model.bodies[0];
    body.elastic = elastic_basis(model, 0);
    modes = level == ModelLevel::elastic ? body.elastic->modes : 0;
    model.planes.push_back({"floor", Vec3(0.1, 0.2, 0), normal, 0.09});
    state.level = level;
    state.rotation = random_rotation(rng);
    for (int k = 0; k < modes; ++k) state.amplitude[k] = 1e-3 * random_vector(rng)[0];
    // so deep that some points touch and others do not
    state.position = model.planes[0].point + 0.3 * normal;
    rotation = rotation_matrix(packed(state.rotation));
    for (std::size_t i = 0; i < model.contact_points.size(); ++i)
      stick.push_back(random_vector(rng, i % 2 == 0 ? 1e-5 : 1e-2));  // sticks, slips
    velocity = {packed(random_vector(rng, 0.2)), packed(random_vector(rng, 0.2)), Amplitudes::Zero()};
    for (int k = 0; k < modes; ++k) velocity.rate[k] = random_vector(rng)[0];
  }
};

constexpr int k_rows = 6 + k_modes;
using Loads = Eigen::Matrix<double, k_rows, 1>;

Loads loads_at(BodyContacts& contacts, const Pressed& at, int direction, double step) {
  BodyVelocity u = at.velocity;
  double* const of[6] = {&u.linear.x, &u.linear.y, &u.linear.z, &u.angular.x, &u.angular.y, &u.angular.z};
  (direction < 6 ? *of[direction] : u.rate[direction - 6]) += step;
  const ContactLoads loads = contacts.evaluate_forces<false>(at.law, u, 0);
  Amplitudes on_modes = Amplitudes::Zero();
  contacts.modal_loads(at.modes, on_modes);
  Loads all;
  all << unpacked(loads.force), unpacked(loads.moment), on_modes.matrix();
  return all;
}

TEST(BodyContacts, slopes_are_the_derivatives_of_the_loads_by_the_velocity) {
  std::mt19937 rng(11);
  for (int trial = 0; trial < 20; ++trial) {
    const Pressed at(rng, trial % 2 == 0 ? k_tilted : Vec3::UnitZ(),
                     trial % 4 < 2 ? ModelLevel::elastic : ModelLevel::rigid);
    BodyContacts contacts(at.model, 0);
    contacts.find(at.state, at.rotation, at.stick);
    ASSERT_TRUE(contacts.any());
    contacts.evaluate_forces<true>(at.law, at.velocity, 0);
    ModeMatrix matrix{};
    contacts.add_slope_of_modes(1, at.modes, matrix);
    const ContactSlope slope = contacts.slope();
    const PackMat3 blocks[2][2] = {{slope.force_linear, slope.force_angular},
                                   {slope.moment_linear, slope.moment_angular}};
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) {
        const PackVec3& row = blocks[i / 3][j / 3].row[i % 3];
        matrix[i][j] = Vec3(row.x, row.y, row.z)[j % 3];
      }
    const int rows = 6 + at.modes;
    Eigen::MatrixXd expected(rows, rows);
    const double h = 1e-6;
    for (int j = 0; j < rows; ++j)
      expected.col(j) = ((loads_at(contacts, at, j, h) - loads_at(contacts, at, j, -h)) / (2 * h)).head(rows);
    // the law bends over speeds of 1e-2 m/s: (h/1e-2)^2, and rounding 1e-16/h
    const double tolerance = 1e-6 * expected.cwiseAbs().maxCoeff();
    for (int i = 0; i < rows; ++i)
      for (int j = 0; j < rows; ++j)
        EXPECT_NEAR(matrix[i][j], expected(i, j), tolerance) << trial << ": " << i << ", " << j;
  }
}

TEST(BodyContacts, sideways_a_point_gives_way_by_the_mean_of_its_compliance_along_the_plane) {
  std::mt19937 rng(12);
  const Pressed at(rng);
  BodyContacts contacts(at.model, 0);
  contacts.find(at.state, at.rotation, at.stick);
  const Vec3 n = at.state.rotation.conjugate() * at.model.planes[0].normal, t = n.unitOrthogonal(),
             across = n.cross(t);
  int touching = 0;
  contacts.each([&](const BodyContacts::Touch& touch, int lane, int point, std::size_t) {
    const int node = at.model.contact_points[point].node;
    const Mat3 give = at.model.bodies[0].elastic->residual_shape.block<3, 3>(6 * node, 3 * node);
    const double scale = give.norm();
    EXPECT_NEAR(touch.give[lane], n.dot(give * n), 1e-12 * scale);
    EXPECT_NEAR(touch.give_across[lane], (t.dot(give * t) + across.dot(give * across)) / 2, 1e-12 * scale);
    ++touching;
  });
  EXPECT_GT(touching, 3);
}

// In series: 1/(1/k + give) beside k = dP/d(depth)/L where the contact bears a quarter of the weight.
TEST(BodyContacts, alpha_is_that_of_both_springs_at_a_quarter_of_the_weight) {
  for (const double q : {1., 1.5, 2.}) {
    std::mt19937 rng(13);
    Pressed at(rng);
    ContactLaw law;
    law.q = q;
    at.law = PreparedLaw(law);
    BodyContacts contacts(at.model, 0);
    contacts.find(at.state, at.rotation, at.stick);
    ASSERT_TRUE(contacts.any());
    contacts.evaluate_forces<false>(at.law, at.velocity, 0);
    const double share = at.model.bodies[0].mass * k_g / 4;
    double low = 0, high = 10;  // of the depth, by bisection
    while (high - low > 1e-14) (penalty_force(law, (low + high) / 2) < share ? low : high) = (low + high) / 2;
    contacts.each([&](const BodyContacts::Touch& touch, int lane, int, std::size_t) {
      const double k = penalty_stiffness(law, low, contacts.length(touch, lane));
      EXPECT_NEAR(touch.alpha[lane] / law.alpha, 1 / (1 + k * touch.give[lane]), 1e-10) << q;
    });
  }
}

/// Heavy on one side, so that its centre of gravity is off the middle in every direction.
Model lopsided() {
  Model model = steel_model();
  FrameSpec spec;
  spec.name = "lopsided";
  spec.nodes = {{0, 0, 0}, {0.6, 0.1, 0}, {0.1, 1.4, 0.2}, {0.2, 0.3, 0.9}};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < i; ++j) spec.members.push_back({{i, j}, 0, 0});
  spec.masses.push_back({0, 30, Vec3::Constant(0.1)});
  add_frame(model, spec);
  model.planes.push_back({"floor", Vec3::Zero(), Vec3::UnitZ(), 0.09});
  return model;
}

TEST(BodyContacts, no_point_below_a_face_is_overlooked_in_any_pose) {
  std::mt19937 rng(14);
  const Model model = lopsided();
  BodyContacts contacts(model, 0);
  const std::vector<Vec3> stick(model.contact_points.size(), Vec3::Zero());
  for (int trial = 0; trial < 200; ++trial) {
    BodyState s;
    s.level = ModelLevel::rigid;
    s.rotation = random_rotation(rng);
    double lowest = 1e300;
    const auto height = [&](const ContactPoint& point) {
      return (s.rotation * (model.node_position[point.node] - model.bodies[0].centre_of_gravity)).z() -
             point.width / 2;
    };
    for (const ContactPoint& point : model.contact_points) lowest = std::min(lowest, height(point));
    s.position = Vec3(0, 0, -lowest - 1e-3);
    const auto below =
        std::count_if(model.contact_points.begin(), model.contact_points.end(),
                      [&](const ContactPoint& point) { return height(point) + s.position.z() < 0; });
    contacts.find(s, rotation_matrix(packed(s.rotation)), stick);
    int found = 0;
    contacts.each([&](const BodyContacts::Touch&, int, int, std::size_t) { ++found; });
    EXPECT_EQ(found, below) << trial;
  }
}

TEST(BodyContacts, each_plane_has_its_own_width_and_springs) {
  Model model = lopsided();
  model.planes.push_back({"wall", Vec3::Zero(), Vec3::UnitX(), 0.05});
  model.planes.push_back({"side", Vec3::Zero(), Vec3::UnitY(), 0.07});
  BodyContacts contacts(model, 0);
  const std::size_t planes = model.planes.size();
  const std::vector<Vec3> stick(model.contact_points.size() * planes, Vec3::Zero());
  BodyState s;
  s.level = ModelLevel::rigid;
  s.position = model.bodies[0].centre_of_gravity - Vec3::Constant(3);  // all points beyond all faces
  contacts.find(s, rotation_matrix(packed(s.rotation)), stick);
  std::vector<int> met(stick.size(), 0);
  contacts.each([&](const BodyContacts::Touch& touch, int lane, int point, std::size_t spring) {
    const double width = model.contact_points[point].width, L = (width + model.planes[touch.plane].width) / 2;
    EXPECT_NEAR(contacts.length(touch, lane), L, 1e-15);
    const double gap =
        model.node_position[model.contact_points[point].node].dot(model.planes[touch.plane].normal) - 3 -
        width / 2;
    EXPECT_NEAR(touch.depth[lane], -gap / L, 1e-12 / L);
    EXPECT_EQ(spring, point * planes + touch.plane);
    ++met[spring];
  });
  EXPECT_EQ(met, std::vector<int>(stick.size(), 1));
}

TEST(BodyContacts, bound_of_their_stiffness_does_not_depend_on_the_unit_of_length) {
  const Model model = lopsided();
  Model twice = model;
  for (Vec3& x : twice.node_position) x *= 2;
  for (ContactPoint& point : twice.contact_points) point.width *= 2;
  twice.planes[0].width *= 2;
  Body& body = twice.bodies[0];
  body.centre_of_gravity *= 2;
  body.inertia *= 4;
  body.reach *= 2;
  const double bound = BodyContacts(model, 0).stiffest();
  EXPECT_NEAR(2 * BodyContacts(twice, 0).stiffest(), bound, 1e-12 * bound);  // 1/(kg m)
}

TEST(BodyContacts, landing_is_foreseen_by_the_parabola_of_the_lowest_point) {
  const Model model = lopsided();
  const BodyContacts contacts(model, 0);
  double lowest = 1e300;
  for (const ContactPoint& point : model.contact_points)
    lowest = std::min(lowest, model.node_position[point.node].z() - point.width / 2);
  for (const double gap : {1e-3, 0.2, 3.})
    for (const double fall : {-0.5, 0., 0.7})
      for (const double g : {0., k_g}) {
        if (g == 0 && fall <= 0) continue;
        SCOPED_TRACE(testing::Message() << gap << " m, " << fall << " m/s, " << g << " m/s^2");
        BodyState s;
        s.level = ModelLevel::rigid;
        s.position = model.bodies[0].centre_of_gravity + Vec3(0, 0, gap - lowest);
        s.velocity = Vec3(0.3, 0.1, -fall);
        const double exact = g == 0 ? gap / fall : (-fall + std::sqrt(fall * fall + 2 * g * gap)) / g;
        const Vec3 gravity(0, 0, -g);
        EXPECT_NEAR(contacts.next_landing(s, gravity, Vec3::Zero(), 10), exact, 1e-12 * (1 + exact));
        EXPECT_TRUE(std::isinf(contacts.next_landing(s, gravity, Vec3::Zero(), 0.99 * exact)));
      }
}

/// Spins about an axis that is none of inertia, without any force, above a floor.
struct Spinning {
  Model model = lopsided();
  BodyState state;
  Spinning() {
    state.level = ModelLevel::rigid;
    state.angular_velocity = Vec3(2.5, 1.5, 3);
  }
  double lowest() const {
    double least = 1e300;
    for (const ContactPoint& point : model.contact_points)
      least = std::min(
          least,
          (state.rotation * (model.node_position[point.node] - model.bodies[0].centre_of_gravity)).z() -
              point.width / 2);
    return least + state.position.z();
  }
  /// Euler's equations, by Runge and Kutta.
  void turn(double t) {
    const Mat3 inertia = model.bodies[0].inertia, inverse = inertia.inverse();
    const auto rate = [&](const Vec3& w) -> Vec3 { return inverse * (inertia * w).cross(w); };
    const int steps = 100;
    const double h = t / steps;
    for (int i = 0; i < steps; ++i) {
      Vec3& w = state.angular_velocity;
      const Vec3 k1 = rate(w), k2 = rate(w + h / 2 * k1), k3 = rate(w + h / 2 * k2), k4 = rate(w + h * k3);
      state.rotation = state.rotation * exp_quaternion(h * (w + h / 2 * k2));
      w += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
  }
};

// One of its posts touches: to turn about that hardly moves a contact.
TEST(BodyContacts, what_they_deflect_does_not_turn_a_body_about_the_post_that_touches_a_wall) {
  topple::Setup setup = paper_cabinet(BodyModel::elastic);
  Model& model = setup.model;
  State state = start_state(model, setup.starts);
  BodyState& s = state.bodies[0];
  s.level = ModelLevel::elastic;
  s.rotation = Eigen::AngleAxisd(1e-3, Vec3::UnitZ()) * Eigen::AngleAxisd(-1.4e-4, Vec3::UnitY());
  s.position.z() -= 1e-4;
  place_nodes(model, state);
  double back = 0;
  for (const ContactPoint& point : model.contact_points)
    back = std::min(back, state.position[point.node].x() - point.width / 2);
  model.planes.push_back({"wall", Vec3(back + 3e-4, 0, 0), Vec3::UnitX(), 0});
  const std::vector<Vec3> stick(2 * model.contact_points.size(), Vec3::Zero());
  setup.parameters.contact.alpha = 1e4;
  ReducedBody body(model, 0);
  body.balance(setup.parameters, StepInputs(setup.parameters, 0), s, stick);
  const std::vector<Vec3> before = state.position;
  body.add_residual(s, state);
  // 100 N at a post deflect this cabinet by some millimetres
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_LT((state.position[i] - before[i]).norm(), 0.02);
}

TEST(BodyContacts, landing_of_a_spinning_body_is_foreseen_to_the_third_order) {
  // its lowest point comes down by as much in t as it is above the floor
  double error[2];
  for (int k = 0; k < 2; ++k) {
    const double t = k == 0 ? 0.02 : 0.01;
    Spinning later, now;
    later.turn(t);
    now.state.position.z() = -later.lowest();
    ASSERT_GT(now.lowest(), 0);
    ReducedBody body(now.model, 0);
    ContactLaw law;
    law.alpha = 1e9;  // so that nothing but the landing decides
    const Parameters still = weightless();
    const std::vector<Vec3> stick(now.model.contact_points.size(), Vec3::Zero());
    body.balance(still, StepInputs(still, 0), now.state, stick);
    error[k] = std::abs(body.look_ahead(still, law, now.state) - t);
    EXPECT_LT(error[k], 0.01 * t);  // (4 rad/s t)^2/6
  }
  EXPECT_LT(error[1], error[0] / 5);
}

TEST(BodyContacts, resting_body_goes_on_with_its_substep) {
  Model model = lopsided();
  ReducedBody body(model, 0);
  BodyState s;
  s.level = ModelLevel::rigid;
  s.position = model.bodies[0].centre_of_gravity;
  const Parameters p;
  const std::vector<Vec3> stick(model.contact_points.size(), Vec3::Zero());
  body.balance(p, StepInputs(p, 0), s, stick);
  s.substep = 0;
  EXPECT_GT(body.look_ahead(p, p.contact, s), 2e-3);  // none was yet: no limit
  s.substep = 1e-3;
  EXPECT_EQ(body.look_ahead(p, p.contact, s), 1e-3);
}

}  // namespace
}  // namespace topple::test
