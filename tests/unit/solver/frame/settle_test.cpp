#include "solver/frame/settle.h"

#include <gtest/gtest.h>

#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

struct Settled {
  Model model = steel_model();
  Parameters parameters;
  State state;
  StepStatus status;
};

Settled settled(const CabinetSpec& spec, Parameters parameters, bool floor = true) {
  Settled s;
  const BodyStart start = add_cabinet(s.model, spec);
  if (floor) s.model.planes.push_back(ground());
  s.parameters = std::move(parameters);
  s.state = start_state(s.model, {start});
  Workspace workspace(s.model);
  s.status = settle(s.model, s.parameters, s.state, workspace);
  if (s.status.ok()) prepare(s.model, s.parameters, s.state, workspace);
  return s;
}

// Greatest force that the balance lacks on a node, and greatest moment over 1 m, N.
double imbalance(const Settled& s) {
  double worst = 0;
  for (int i = 0; i < s.model.node_total(); ++i) {
    worst = std::max(worst, s.model.node_mass[i] * s.state.acceleration[i].norm());
    worst = std::max(worst, (s.model.node_inertia[i] * s.state.angular_acceleration[i]).norm());
  }
  return worst;
}

TEST(Settle, leaves_a_billionth_of_the_weight_out_of_balance) {
  for (double alpha : {30., 50., 1000.})
    for (double q : {1., 2.})
      for (auto pose : {CabinetSpec::Pose::upright, CabinetSpec::Pose::on_back, CabinetSpec::Pose::on_side}) {
        SCOPED_TRACE(testing::Message()
                     << "alpha " << alpha << " kgf, q " << q << ", pose " << static_cast<int>(pose));
        Parameters p;
        p.contact.alpha = alpha * k_g;
        p.contact.q = q;
        CabinetSpec spec = tall_cabinet();
        spec.pose = pose;
        const Settled s = settled(spec, p);
        ASSERT_TRUE(s.status.ok()) << s.status.message(s.model);
        const double weight = 40 * k_g;
        // plus the rounding of 2e8 N/m bars at 1 m, 4e-7 N
        EXPECT_LT(imbalance(s), 1e-9 * weight + 4e-7);
        for (const Vec3& v : s.state.velocity) EXPECT_EQ(v, Vec3(Vec3::Zero()));
      }
}

TEST(Settle, laws_without_stick_springs_rest_at_the_same_depth) {
  const Settled coulomb = settled(tall_cabinet(), {});
  for (auto kind : {ContactLawKind::paper, ContactLawKind::printed}) {
    Parameters p;
    p.contact.kind = kind;
    const Settled other = settled(tall_cabinet(), p);
    ASSERT_TRUE(other.status.ok());
    for (std::size_t i = 0; i < other.state.position.size(); ++i)
      EXPECT_EQ(other.state.position[i], coulomb.state.position[i]);
  }
}

TEST(Settle, floor_carries_the_weight_and_nothing_sideways) {
  Settled s = settled(tall_cabinet(), {});
  ASSERT_TRUE(s.status.ok());
  Workspace workspace(s.model);
  Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
  const Vec3 centre = centre_of_mass(s.model, s.state);
  for (const ContactForce& f : contact_forces(s.model, s.parameters, s.state, workspace)) {
    sum += f.force;
    moment += (s.state.position[s.model.contact_points[f.point].node] - centre).cross(f.force);
  }
  EXPECT_LT((sum - Vec3(0, 0, 40 * k_g)).norm(), 1e-5);
  EXPECT_LT(moment.norm(), 1e-5);
}

TEST(Settle, stays_where_it_settled) {
  Settled s = settled(tall_cabinet(), {});
  ASSERT_TRUE(s.status.ok());
  Workspace workspace(s.model);
  const std::vector<Vec3> before = s.state.position;
  for (int i = 0; i < 500; ++i) ASSERT_TRUE(step(s.model, s.parameters, s.state, workspace).ok());
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_LT((s.state.position[i] - before[i]).norm(), 1e-9);
  EXPECT_LT(s.state.energy.kinetic, 1e-12);
}

TEST(Settle, small_lean_comes_upright) {
  CabinetSpec spec = tall_cabinet();
  spec.tilt = 0.02;
  const Settled s = settled(spec, {});
  ASSERT_TRUE(s.status.ok());
  EXPECT_LT(log_quaternion(s.state.rotation[0]).norm(), 5e-3);
}

TEST(Settle, never_ends_balanced_on_an_edge) {
  // Newton finds the balance at the critical angle, 0.179, as readily as a stable one
  for (double alpha : {50., 2000.})
    for (double tilt : {0.05, 0.1, 0.15, 0.17, 0.179, 0.19, 0.21, 0.3, -0.17, -0.2, -0.3}) {
      SCOPED_TRACE(testing::Message() << "alpha " << alpha << " kgf, tilt " << tilt);
      CabinetSpec spec = tall_cabinet();
      spec.tilt = tilt;
      Parameters p;
      p.contact.alpha = alpha * k_g;
      const Settled s = settled(spec, p);
      if (s.status.ok()) {
        EXPECT_LT(log_quaternion(s.state.rotation[0]).norm(), 0.02);
      } else {
        EXPECT_EQ(s.status.kind, StepStatus::Kind::not_settled);
      }
    }
}

TEST(Settle, floor_too_soft_for_a_tall_body_lets_it_tip_over) {
  // six contacts of stiffness alpha/L stand half a depth from the middle: upright is a balance only while
  // 6 (alpha/L) b^2 > m g h, here alpha > 11.6 kgf
  const double least = 40 * 1.05 * 0.06 / (6 * 0.19 * 0.19);
  EXPECT_NEAR(least, 11.6, 0.1);
  Parameters p;
  p.contact.alpha = 0.8 * least * k_g;
  const Settled s = settled(tall_cabinet(), p);
  EXPECT_EQ(s.status.kind, StepStatus::Kind::not_settled);
  EXPECT_NE(s.status.no_rest, NoRest::not_found);
  p.contact.alpha = 1.3 * least * k_g;
  EXPECT_TRUE(settled(tall_cabinet(), p).status.ok());
}

TEST(Settle, free_sliding_is_no_reason_to_refuse) {
  Parameters p;
  p.contact.friction = 0;
  const Settled s = settled(tall_cabinet(), p);
  EXPECT_TRUE(s.status.ok()) << s.status.message(s.model);
}

TEST(Settle, body_that_leans_too_far_floats_or_has_no_floor_is_not_settled) {
  CabinetSpec leaning = tall_cabinet();
  leaning.tilt = 0.3;
  CabinetSpec upright = tall_cabinet();
  for (const Settled& s : {settled(leaning, {}), settled(upright, {}, false)}) {
    EXPECT_EQ(s.status.kind, StepStatus::Kind::not_settled);
    EXPECT_NE(s.status.no_rest, NoRest::not_found);
    EXPECT_EQ(s.status.body, 0);
    EXPECT_NE(s.status.message(s.model).find("\"cabinet\""), std::string::npos);
  }
  Model model = steel_model();
  add_cabinet(model, upright);
  model.planes.push_back(ground());
  model.planes[0].point.z() = -2;
  State state = start_state(model, {BodyStart{}});
  Workspace workspace(model);
  EXPECT_EQ(settle(model, {}, state, workspace).kind, StepStatus::Kind::not_settled);
}

TEST(Settle, supported_frame_sags_as_the_static_solution) {
  Model model =
      cantilever(plain_section(3e-4, 4e-8, 9e-8, 6e-8, 0.7, 0.6), steel(), 1, 2, Vec3::Zero(), Vec3::Zero());
  Parameters p;
  State state = start_state(model, {BodyStart{}});
  Workspace workspace(model);
  ASSERT_TRUE(settle(model, p, state, workspace).ok());
  BodySystem system(model, 0);
  BodyMotion motion = reference_motion(model);
  ASSERT_GT(solve_statics(system, p, 0, motion), 0);
  for (int i = 0; i < model.node_total(); ++i)
    EXPECT_LT((state.position[i] - motion.position[i]).norm(), 1e-9);
  EXPECT_LT(state.position[2].z(), -1e-6);
}

// A beam that carries 5 N at its tip, of a load with `history`.
Model loaded_beam(std::vector<std::pair<double, double>> history) {
  Model model = cantilever(plain_section(3e-4, 4e-8, 9e-8, 6e-8, 0.7, 0.6), steel(), 1, 2, Vec3(0, 1, -5),
                           Vec3::Zero());
  for (Load& load : model.loads) load.history = history;
  return model;
}

TEST(Settle, constant_loads_are_carried_from_the_start) {
  const Model model = loaded_beam({});
  const Parameters p;
  State state = start_state(model, {BodyStart{}});
  Workspace workspace(model);
  ASSERT_TRUE(settle(model, p, state, workspace).ok());
  BodySystem system(model, 0);
  BodyMotion motion = reference_motion(model);
  ASSERT_GT(solve_statics(system, p, 0, motion), 0);
  for (int i = 0; i < model.node_total(); ++i)
    EXPECT_LT((state.position[i] - motion.position[i]).norm(), 1e-9);
  EXPECT_GT(state.position[2].y(), 1e-6);
  prepare(model, p, state, workspace);
  const Vec3 tip = state.position[2];
  for (int i = 0; i < 200; ++i) ASSERT_TRUE(step(model, p, state, workspace).ok());
  EXPECT_LT((state.position[2] - tip).norm(), 1e-9);
  EXPECT_LT(state.energy.kinetic, 1e-12);
}

TEST(Settle, loads_with_a_history_act_as_at_the_start) {
  const auto settled_tip = [](const Model& model) {
    State state = start_state(model, {BodyStart{}});
    Workspace workspace(model);
    EXPECT_TRUE(settle(model, {}, state, workspace).ok());
    return state.position[2];
  };
  const Vec3 full = settled_tip(loaded_beam({})), none = settled_tip(loaded_beam({{0, 0}, {1, 1}}));
  EXPECT_NEAR(none.y(), 0, 1e-12);
  EXPECT_LT((settled_tip(loaded_beam({{0, 1}, {1, 0}})) - full).norm(), 1e-12);
  EXPECT_NEAR(settled_tip(loaded_beam({{0, 0.5}, {1, 1}})).y() / full.y(), 0.5, 1e-4);
}

// A beam of 30 mm held at both ends that carries a mass in its middle. Its hinges bear 8 Mp/L = 2373 N.
Model loaded_shelf(double mass) {
  Model model = steel_model();
  model.materials[0].yield = 235e6;
  FrameSpec spec;
  spec.name = "shelf";
  spec.nodes = {Vec3::Zero(), Vec3(0.5, 0, 0), Vec3(1, 0, 0)};
  spec.members = {{{0, 1}, 0, 0}, {{1, 2}, 0, 0}};
  spec.supports = {{0, k_clamped}, {2, k_clamped & ~1u}};
  spec.masses = {{1, mass}};
  add_frame(model, spec);
  return model;
}

TEST(Settle, what_weight_makes_yield_has_flowed_before_the_first_step) {
  Model model = loaded_shelf(150);
  model.supports[1].fixed = 0x0f & ~1u;  // free to turn: first yield at 16 Mp/3L, 1582 N, collapse at 1780 N
  model.node_mass[1] += 18;
  const Parameters p;
  State state = start_state(model, {BodyStart{}});
  Workspace workspace(model);
  const StepStatus status = settle(model, p, state, workspace);
  ASSERT_TRUE(status.ok()) << status.message(model);
  int hinges = 0;
  for (const ElementState& element : state.elements) hinges += element.hinge != Hinge::none;
  EXPECT_EQ(hinges, 1);
  EXPECT_EQ(state.elements[0].hinge, Hinge::first);
  prepare(model, p, state, workspace);
  const Vec3 middle = state.position[1];
  for (int i = 0; i < 200; ++i) ASSERT_TRUE(step(model, p, state, workspace).ok());
  EXPECT_LT((state.position[1] - middle).norm(), 1e-9);
  EXPECT_LT(state.energy.kinetic, 1e-12);
}

TEST(Settle, a_body_that_collapses_under_its_own_weight_is_told_with_element_and_time) {
  Model model = loaded_shelf(150);
  model.supports[1].fixed = 0;  // a cantilever: yields at 60 kg
  State state = start_state(model, {BodyStart{}});
  Workspace workspace(model);
  const StepStatus status = settle(model, {}, state, workspace);
  EXPECT_EQ(status.kind, StepStatus::Kind::not_settled);
  EXPECT_EQ(status.body, 0);
  ASSERT_GE(status.element, 0);
  const std::string text = status.message(model);
  for (const char* part : {"at 0 s", "body \"shelf\"", "member \"member-1\"", "(element "})
    EXPECT_NE(text.find(part), std::string::npos) << text;
}

// Two members along x between a pin and a roller, which leave all turning about y free, with a moment there
// on the first node.
Model turned_at_its_end(double moment) {
  Model model = steel_model();
  model.sections[0] = plain_section(3e-4, 4e-8, 9e-8, 6e-8, 0.7, 0.6);
  FrameSpec spec;
  spec.name = "beam";
  for (int i = 0; i < 3; ++i) spec.nodes.emplace_back(0.5 * i, 0, 0);
  spec.members = {{{0, 1}, 0, 0}, {{1, 2}, 0, 0}};
  spec.supports = {{0, 0b001111}, {2, 0b000110}};
  spec.loads = {{0, Vec3::Zero(), Vec3(0, moment, 0), {}}};
  add_frame(model, spec);
  return model;
}

TEST(Settle, moment_on_a_pinned_end_turns_it_by_M_L_over_3_EI) {
  const double moment = 1;
  const Model model = turned_at_its_end(moment);
  const Parameters p = weightless();
  State state = start_state(model, {BodyStart{}});
  Workspace workspace(model);
  ASSERT_TRUE(settle(model, p, state, workspace).ok());
  const double bending = 205e9 * 4e-8, shear = 0.6 * 205e9 / 2.6 * 3e-4;
  // shear: the reactions M/L turn the whole by M/(L G A)
  const double near = moment / (3 * bending) + moment / shear, far = -moment / (6 * bending) + moment / shear;
  // exact at the nodes; turns of 4e-5 rad bend by their square
  EXPECT_NEAR(log_quaternion(state.rotation[0]).y(), near, 1e-7 * near);
  EXPECT_NEAR(log_quaternion(state.rotation[2]).y(), far, 1e-7 * near);
}

TEST(Settle, supports_hold_the_directions_that_they_name_and_no_others) {
  Model model = turned_at_its_end(0);
  const Vec3 force(1, 2, 3), moment(0.01, 0.02, 0.03);
  for (unsigned fixed = 0; fixed < 64; ++fixed) {
    model.supports = {{0, fixed}};
    model.loads = {{0, force, moment, {}}};
    State state = start_state(model, {BodyStart{}});
    Workspace workspace(model);
    prepare(model, weightless(), state, workspace);  // nothing is strained yet: loads alone accelerate
    const Vec3 pulled = model.node_mass[0] * state.acceleration[0],
               turned = model.node_inertia[0] * state.angular_acceleration[0];
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(pulled[k], fixed >> k & 1 ? 0 : force[k], 1e-12) << fixed;
      EXPECT_NEAR(turned[k], fixed >> (3 + k) & 1 ? 0 : moment[k], 1e-14) << fixed;
    }
  }
}

}  // namespace
}  // namespace topple::test
