// What is to be known of members, bodies and anchors.
#include "app/panels/subject.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/picture/annotations.h"
#include "app/picture/row.h"
#include "app/picture/words.h"
#include "app/support/terms.h"
#include "solver/run/overturn.h"
#include "unit/app/live.h"

namespace topple::app {
namespace {

double value(const FrameContext& now, const Subject& subject, const std::string& name) {
  for (const SubjectValue& v : values_of(subject.kind))
    if (name == v.name.english) return v.at(now, subject.index);
  ADD_FAILURE() << name;
  return 0;
}

const Subject k_member{Subject::Kind::member, 0}, k_body{Subject::Kind::body, 0};

/// A cantilever of 1 m under 10 N downwards and 20 N of pull at its tip.
struct Cantilever {
  explicit Cantilever(const std::vector<std::string>& overrides = {})
      : scene(io::parse_scene(R"(topple = 1
[run]
analysis = "static"
gravity = [0, 0, 0]
)" + k_library + R"(
[[frame]]
name = "beam"
nodes = [[0, 0, 0], [1, 0, 0]]
members = [{ nodes = [0, 1], section = "post", material = "steel" }]
supports = [{ node = 0, fix = "xyzXYZ" }]
loads = [{ node = 1, force = ["20 N", 0, "-10 N"] }]
)",
                              "beam.toml", overrides)) {
    topple::Run run(scene.setup);
    while (!run.over()) EXPECT_TRUE(run.advance().ok());
    row = io::frame_row(run);
  }
  io::Scene scene;
  io::FrameRow row;
};

const std::vector<Bearer> k_on_floor{{-1, Vec3::Zero()}};

// P L at the clamp, nothing at the tip; P and N all along. The tip turns by 1.5 mrad: 2e-3 of P more in N.
TEST(Subject, section_forces_of_a_cantilever_are_those_of_theory) {
  const Cantilever beam;
  const FrameContext now{beam.scene.setup.model, beam.scene.setup.parameters.gravity, k_on_floor, beam.row};
  EXPECT_NEAR(std::abs(value(now, k_member, "My")), 10, 0.02);
  EXPECT_NEAR(std::abs(value(now, k_member, "Vz")), 10, 0.04);
  EXPECT_NEAR(value(now, k_member, "N"), 20, 0.04);
  EXPECT_NEAR(value(now, k_member, "Mz"), 0, 1e-6);
  const Section& section = beam.scene.setup.model.sections[0];
  const double stress = 20 / section.area + 10 * section.fibre_z() / section.iy;
  EXPECT_NEAR(value(now, k_member, "stress"), stress / 1e6, 3e-3 * stress / 1e6);
  EXPECT_TRUE(std::isnan(value(now, k_member, "yield ratio")));  // it has no yield stress
  EXPECT_TRUE(std::isnan(value(now, k_body, "left to overturn")));
}

// A portal that is clamped at both feet is pushed over: it leans, but its base stays, and a path has no time.
TEST(Subject, a_bolted_body_does_not_slide_and_a_static_one_has_no_velocity) {
  const io::Scene scene = io::load_scene("portal-pushover");
  topple::Run run(scene.setup);
  const io::FrameRow before = io::frame_row(run);
  while (!run.over()) EXPECT_TRUE(run.advance().ok());
  const io::FrameRow row = io::frame_row(run);
  FrameContext now{scene.setup.model, scene.setup.parameters.gravity, k_on_floor, row, &before};
  now.moves = false;
  EXPECT_GT(value(now, k_body, "tilt"), 0.5);
  EXPECT_TRUE(std::isnan(value(now, k_body, "base moved")));
  EXPECT_TRUE(std::isnan(value(now, k_body, "angular velocity")));
}

TEST(Subject, a_stress_beyond_yield_without_a_hinge_is_explained) {
  const Cantilever elastic;
  const FrameContext before{elastic.scene.setup.model, elastic.scene.setup.parameters.gravity, k_on_floor,
                            elastic.row};
  const double stress = value(before, k_member, "stress");
  EXPECT_EQ(about(before, k_member).size(), 1u);
  const auto lines = [&](double yield) {
    const Cantilever beam({fmt::format("material.1.yield=\"{} MPa\"", yield)});
    return about({beam.scene.setup.model, beam.scene.setup.parameters.gravity, k_on_floor, beam.row},
                 k_member);
  };
  EXPECT_EQ(lines(1.2 * stress).size(), 1u);
  // a thin box bears more than a tenth more than at first yield
  ASSERT_EQ(lines(stress / 1.05).size(), 2u);
  EXPECT_TRUE(lines(stress / 1.05)[1].starts_with("The outermost fibre is beyond"));
}

TEST(Subject, a_diagram_stands_on_the_side_that_its_moment_stretches) {
  const Cantilever beam;
  render::SceneFrame frame;
  add_diagram(beam.scene.setup.model, beam.row, {0, std::nullopt}, frame);
  ASSERT_EQ(frame.bands.size(), 1u);  // no change of sign
  const render::Band& band = frame.bands[0];
  // Loaded downwards, it is stretched above: highest at the clamp, a fifth of its length, and linear.
  EXPECT_NEAR(band.edge.front()[2] - band.base.front()[2], 0.2, 1e-3);
  const std::size_t middle = band.base.size() / 2;
  EXPECT_NEAR(band.edge[middle][2] - band.base[middle][2], 0.2 * (1 - band.base[middle][0]), 2e-3);
  EXPECT_NEAR(band.edge.back()[2] - band.base.back()[2], 0, 1e-3);
  ASSERT_EQ(frame.labels.size(), 2u);
  EXPECT_TRUE(frame.labels[0].words.starts_with("My ")) << frame.labels[0].words;
}

TEST(Subject, a_diagram_is_cut_where_it_changes_its_sign) {
  Cantilever beam;
  // Moments of opposite sign at the two stress points, no shear: two steps along the member.
  for (std::size_t e = 0; e < 2; ++e) {
    for (int k = 0; k < 6; ++k) beam.row.section_force[6 * e + k] = 0;
    beam.row.section_force[6 * e + 5] = e == 0 ? 3.f : -1.f;
  }
  render::SceneFrame frame;
  add_diagram(beam.scene.setup.model, beam.row, {0, std::nullopt}, frame);
  ASSERT_EQ(frame.bands.size(), 2u);
  EXPECT_NE(frame.bands[0].colour, frame.bands[1].colour);
  EXPECT_EQ(frame.bands[0].edge.back(), frame.bands[0].base.back());
  EXPECT_EQ(frame.bands[1].edge.front(), frame.bands[1].base.front());
}

// Angular velocity is the mean between two rows 2 ms apart, of a motion whose acceleration is 2 rad/s^2 or so
// and changes little; at the end it is that of two intervals of 20 ms which go on: the mean of the last is
// 0.018 rad/s off. Energies go by the rounding of rows.
TEST(Subject, a_body_has_the_energy_and_the_angular_velocity_of_its_state) {
  for (const char* model_of_body : {"rigid", "elastic", "frame"}) {
    SCOPED_TRACE(model_of_body);
    const io::Scene scene =
        io::parse_scene(k_shaken, "s.toml", {std::string("cabinet.free.model=") + model_of_body});
    topple::Run run(scene.setup);
    std::vector<io::FrameRow> rows;
    Vec3 spin = Vec3::Zero(), last_spin = Vec3::Zero();
    double kinetic = 0;
    io::FrameRow last_but_two, last_but_one;
    for (int i = 0; i < 160; ++i) {
      ASSERT_TRUE(run.advance().ok());
      if (i >= 157) rows.push_back(io::frame_row(run));
      if (i == 119) last_but_two = io::frame_row(run);
      if (i == 139) last_but_one = io::frame_row(run);
      const BodyMomentum momentum = body_momentum(scene.setup.model, run.state(), 0);
      const Mat3 r = body_pose(scene.setup.model, run.state(), 0).rotation.toRotationMatrix();
      last_spin =
          (r * scene.setup.model.bodies[0].inertia * r.transpose()).inverse() * momentum.angular_momentum;
      if (i != 158) continue;
      spin = last_spin;
      kinetic = run.state().energy.kinetic;
    }
    const std::vector<Bearer> bearers = bearers_of(scene.setup.model, scene.setup.starts);
    const FrameContext now{scene.setup.model, scene.setup.parameters.gravity, bearers, rows[1], &rows[0],
                           &rows[2]};
    EXPECT_GT(kinetic, 0.01);
    EXPECT_NEAR(value(now, k_body, "kinetic energy"), kinetic, 1e-3 + 1e-3 * kinetic);
    EXPECT_NEAR(value(now, k_body, "angular velocity"), spin.norm(), 0.02 * spin.norm() + 1e-3);
    FrameContext end{scene.setup.model, scene.setup.parameters.gravity, bearers, rows[2], &last_but_one};
    EXPECT_GT(std::abs(value(end, k_body, "angular velocity") - last_spin.norm()), 0.015);
    end.further = &last_but_two;
    // a fifth of that is left
    EXPECT_NEAR(value(end, k_body, "angular velocity"), last_spin.norm(), 0.004);
    const double left = value(now, k_body, "left to overturn"), share = value(now, k_body, "share left");
    EXPECT_GT(left, 0);
    EXPECT_LT(share, 100);
  }
}

TEST(Subject, contacts_in_the_middle_of_a_member_are_told) {
  const io::Scene scene = io::parse_scene(k_shaken, "s.toml");
  const Model& model = scene.setup.model;
  const io::FrameRow row = io::frame_row(topple::Run(scene.setup));
  int approximate = 0;
  for (std::size_t m = 0; m < model.members.size(); ++m) {
    const bool on_floor =
        model.members[m].name.starts_with("bottom") || model.members[m].name.starts_with("brace-bottom");
    EXPECT_EQ(is_approximate(model, row, m), on_floor) << model.members[m].name;
    approximate += is_approximate(model, row, m);
  }
  EXPECT_GE(approximate, 4);
}

TEST(Subject, an_anchor_has_its_strength_and_the_greatest_force_between_rows_too) {
  const auto scene = live_scene(k_rocking + k_brackets);
  topple::Run run(scene->setup);
  while (!run.over()) ASSERT_TRUE(run.advance().ok());
  LiveRun live({.scene = scene}, [] {});
  Player player(scene, live);
  const auto work = [&] { player.update(0.01); };
  ASSERT_TRUE(eventually(work, [&] { return player.can_edit(); }));
  while (player.speed() < k_most_speed) player.faster();
  player.play();
  ASSERT_TRUE(eventually(work, [&] { return player.status().kind == LiveStatus::Kind::over; }));
  const io::FrameRow row = *player.row();
  const FrameContext now = frame_context(player, row);
  ASSERT_EQ(now.anchor_peaks.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    const double peak = run.outcome().anchors()[k].peak_force;
    EXPECT_GT(peak, 0);
    EXPECT_EQ(now.anchor_peaks[k], peak);
    EXPECT_EQ(about(now, {Subject::Kind::anchor, k}).at(2),
              fmt::format("strength 1500 N, greatest force {:.3g} N, {} of its strength", peak,
                          percent_of(peak, 1500)));
  }
  const std::vector<std::string> body = about(now, k_body);
  for (std::size_t k = 0; k < 2; ++k)
    EXPECT_NE(std::ranges::find(body, anchor_in_words(scene->setup.model, row, k)), body.end());
}

TEST(Subject, names_are_found_and_others_refused_with_what_there_is) {
  const io::Scene scene = io::parse_scene(k_shaken, "s.toml");
  const Model& model = scene.setup.model;
  EXPECT_EQ(subject_named(model, "free"), k_body);
  const Subject post = subject_named(model, "free/post-2");
  EXPECT_EQ(post.kind, Subject::Kind::member);
  EXPECT_EQ(name_of(model, post), "free/post-2");
  for (const char* name : {"fre", "free/", "free/post-9", ""}) {
    SCOPED_TRACE(name);
    EXPECT_THROW(subject_named(model, name), io::InputError);
  }
}

TEST(Histories, follow_the_run_and_its_branches) {
  LiveRun run({.scene = live_scene(), .recording = {}, .output = {}});
  Player player(live_scene(), run);
  Histories histories;
  const auto until = [&](auto done) { return eventually([&] { player.update(0.01); }, done); };
  ASSERT_TRUE(until([&] { return player.can_edit(); }));
  const auto expect_values = [&] {
    const std::vector<float>& tilt = histories.of(player, k_body, 0);
    ASSERT_EQ(tilt.size(), player.way().size());
    for (std::size_t i = 0; i < tilt.size(); ++i)
      EXPECT_FLOAT_EQ(tilt[i], static_cast<float>(player.way()[i]->body[0].tilt * 180 / k_pi));
  };
  expect_values();
  player.play();
  ASSERT_TRUE(until([&] { return player.time() > 0.4; }));
  expect_values();
  ASSERT_TRUE(until([&] { return player.status().kind == LiveStatus::Kind::over; }));
  expect_values();
  player.scrub(0.5);
  player.continue_from_here();
  ASSERT_TRUE(until([&] { return player.can_edit() && player.history().branches.size() == 2; }));
  // As many instants as before, and other ones.
  player.edit({Edit::Key::amplitude, 0, Vec3(100 * k_gal, 0, 0)});
  player.play();
  ASSERT_TRUE(until([&] { return player.status().kind == LiveStatus::Kind::over; }));
  expect_values();
}

}  // namespace
}  // namespace topple::app
