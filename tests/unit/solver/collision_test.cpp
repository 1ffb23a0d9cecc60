// Bodies that meet each other while they move.
#include <Eigen/LU>
#include <cmath>
#include <iostream>

#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

/// One cabinet on the floor and one above it in any orientation, thrown down.
Setup random_drop(int seed) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> u(-1, 1);
  Setup setup;
  setup.model = steel_model();
  CabinetSpec spec = tall_cabinet();
  spec.name = "under";
  setup.starts.push_back(add_cabinet(setup.model, spec));
  spec.name = "falling";
  setup.starts.push_back(add_cabinet(setup.model, spec));
  setup.model.planes.push_back(ground());
  BodyStart& start = setup.starts[1];
  const Vec3 centre = setup.model.bodies[1].centre_of_gravity;
  const Quat turn = random_rotation(rng);
  const Vec3 to(0.3 * u(rng), 0.6 * u(rng), 3.1);
  // the centre of gravity goes to `to`: a turn about the point that it leaves where it is
  const Eigen::AngleAxisd axis(turn);
  start.rotation = axis.angle() * axis.axis();
  const Mat3 rest = Mat3::Identity() - turn.toRotationMatrix();
  start.pivot = rest.fullPivLu().solve(to - turn * centre);
  start.velocity = Vec3(u(rng), u(rng), -2 + u(rng));
  start.angular_velocity = random_vector(rng, 3);
  setup.run.duration = 1.2;
  setup.run.settle = false;
  setup.parameters.adaptive = true;
  return setup;
}

TEST(Collision, random_drops) {
  const char* from = getenv("FROM");
  const char* to = getenv("TO");
  for (int seed = from ? atoi(from) : 0; seed < (to ? atoi(to) : 10); ++seed) {
    const topple::Setup setup = random_drop(seed);
    topple::Run run(setup);
    const State& state = run.state();
    const double start = state.energy.start_total;
    double greatest = 0;
    while (!run.over()) {
      run.advance();
      greatest = std::max(greatest, state.energy.balance_error());
    }
    std::cout << seed << " " << run.status().message(setup.model) << " t " << state.time << " steps "
              << state.step << " rejected " << run.rejected_steps() << " newton " << run.newton_iterations()
              << " balance " << greatest << " kin " << state.energy.kinetic << " start " << start
              << " contact " << state.energy.contact << " crossing " << std::endl;
  }
}

}  // namespace
}  // namespace topple::test
