// Threads that share the islands of a step change nothing but the time that it takes.
#include "solver/study/common/team.h"

#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "solver/reduced/elastic_basis.h"
#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

TEST(Team, does_every_task_once_and_no_worker_two_at_a_time) {
  for (const int workers : {1, 2, 3, 5}) {
    study::Team team(workers);
    const ParallelFor parallel = team.share();
    ASSERT_EQ(parallel.workers, workers);
    std::vector<int> done(40);
    std::vector<std::atomic<int>> busy(static_cast<std::size_t>(workers));
    for (int round = 0; round < 2000; ++round) {
      const int count = round % 40;
      parallel.run(count, [&](int task, int worker) {
        EXPECT_EQ(busy[worker]++, 0);
        ++done[task];
        --busy[worker];
      });
      for (int task = 0; task < 40; ++task) ASSERT_EQ(done[task], task < count ? 1 : 0) << "round " << round;
      done.assign(40, 0);
    }
  }
}

TEST(Team, wakes_up_after_a_rest) {
  study::Team team(3);
  const ParallelFor parallel = team.share();
  std::atomic<int> done{0};
  for (int round = 0; round < 5; ++round) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    parallel.run(6, [&](int, int) { ++done; });
  }
  EXPECT_EQ(done, 30);
}

/// Six cabinets on a floor and beside a wall, rocking as long as it shakes.
struct Six {
  std::vector<double> gaps;       ///< m, between neighbours, five
  std::vector<BodyModel> models;  ///< six
  bool grid = false;              ///< of members, in place of the plane floor
  bool yields = false;
  double tilt = 0.1;  ///< rad, that they are let go from, to and fro
};

topple::Setup six(const Six& what) {
  topple::Setup setup;
  setup.model = steel_model();
  if (what.yields) setup.model.materials[0].yield = 60e6;
  double x = 0;
  for (int k = 0; k < 6; ++k) {
    CabinetSpec spec = tall_cabinet();
    spec.name = "cabinet-" + std::to_string(k);
    spec.tilt = k % 2 == 0 ? what.tilt : -0.8 * what.tilt;
    spec.at.x() = x;
    if (k < 5) x += 0.38 + 0.03 + what.gaps[k];
    setup.starts.push_back(add_cabinet(setup.model, spec));
  }
  if (what.grid) {
    GridSpec floor;
    floor.name = "floor";
    floor.from[0] = -1;
    floor.to[0] = x + 1;
    floor.from[1] = -0.7;
    floor.to[1] = 0.7;
    setup.starts.push_back(add_grid(setup.model, floor));
  } else {
    setup.model.planes.push_back(ground());
    setup.model.planes.push_back({"wall", Vec3(-0.24, 0, 0), Vec3::UnitX(), 0.09});
  }
  setup.run.settle = false;
  setup.run.duration = 10;
  setup.parameters.models = what.models;
  for (int k = 0; k < 6; ++k)
    if (what.models[k] != BodyModel::frame) setup.model.bodies[k].elastic = elastic_basis(setup.model, k);
  setup.parameters.models.resize(setup.model.bodies.size(), BodyModel::frame);
  setup.parameters.contact.alpha = 2000;
  setup.parameters.contact.restitution = 0.5;
  shake(setup, 4, 2);
  return setup;
}

std::vector<BodyModel> all(BodyModel model) {
  return std::vector<BodyModel>(6, model);
}

void expect_the_same(const topple::Setup& setup, int steps, bool members_touch = false) {
  std::vector<std::uint64_t> alone;
  std::size_t touches = 0, member_touches = 0;
  for (const int workers : {1, 2, 3}) {
    study::Team team(workers);
    topple::Run run(setup);
    ASSERT_TRUE(run.status().ok()) << run.status().message(setup.model);
    if (workers > 1) run.share(team.share());
    for (int i = 0; i < steps; ++i) {
      ASSERT_TRUE(run.advance().ok()) << run.status().message(setup.model);
      touches += run.contacts().size();
      member_touches += run.member_contacts().size();
      if (i % 50 != 49) continue;
      const std::uint64_t now = hash(run.state());
      if (workers == 1)
        alone.push_back(now);
      else
        ASSERT_EQ(now, alone[static_cast<std::size_t>(i / 50)]) << workers << " workers, step " << i;
    }
  }
  EXPECT_GT(touches + member_touches, 0u);
  EXPECT_EQ(member_touches > 0, members_touch);
}

TEST(SharedSteps, frames_that_are_apart_move_as_on_one_thread) {
  topple::Setup setup = six({.gaps = {1, 1, 1, 1, 1}, .models = all(BodyModel::frame)});
  expect_the_same(setup, 300);
  setup.parameters.integrator = Integrator::central_difference;
  setup.parameters.time_step = 2e-5;
  expect_the_same(setup, 1000);
}

TEST(SharedSteps, frames_that_touch_in_pairs_move_as_on_one_thread) {
  topple::Setup setup = six({.gaps = {0.02, 1, 1, 0.02, 1}, .models = all(BodyModel::frame), .tilt = 0});
  setup.run.settle = true;
  expect_the_same(setup, 600, true);
  setup.parameters.adaptive = true;
  expect_the_same(setup, 600, true);
}

TEST(SharedSteps, frames_in_which_hinges_form_move_as_on_one_thread) {
  expect_the_same(six({.gaps = {1, 1, 1, 1, 1}, .models = all(BodyModel::frame), .yields = true}), 300);
}

TEST(SharedSteps, frames_on_members_that_are_held_move_as_on_one_thread) {
  expect_the_same(six({.gaps = {1, 1, 1, 1, 1}, .models = all(BodyModel::frame), .grid = true}), 300, true);
}

TEST(SharedSteps, rigid_and_elastic_bodies_beside_frames_move_as_on_one_thread) {
  using enum BodyModel;
  topple::Setup setup =
      six({.gaps = {1, 1, 1, 0.5, 1}, .models = {rigid, elastic, frame, rigid, elastic, automatic}});
  expect_the_same(setup, 400);
  setup.parameters.adaptive = true;
  expect_the_same(setup, 400);
}

}  // namespace
}  // namespace topple::test
