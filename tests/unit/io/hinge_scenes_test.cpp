// Built-in scenes in which many sections yield: what flow takes is the work of the end moments over the turns
// of the hinges, and steps are not shortened by it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>

#include "solver/element/plasticity.h"
#include "solver/element/section_forces.h"
#include "solver/io/scene/scene.h"
#include "solver/run/run.h"

namespace topple::test {
namespace {

struct HingeScene {
  const char* name;
  double duration;     ///< s
  double flow;         ///< J, less than what flows
  int flowed, broken;  ///< fewer elements than did, and are
};

class HingeScenes : public testing::TestWithParam<HingeScene> {};

topple::Setup setup_of(const HingeScene& scene, const std::vector<std::string>& overrides = {}) {
  std::vector<std::string> all = overrides;
  all.push_back("run.duration=" + std::to_string(scene.duration));
  return io::load_scene(scene.name, all).setup;
}

BeamStrain strain_in(const Element& element, const State& state) {
  const auto [i, j] = element.node;
  return beam_strain(element,
                     beam_ends(state.position[i], state.rotation[i], state.position[j], state.rotation[j]));
}

/// Normal and end forces of an element, and what it holds elastically.
struct ElementForces {
  SectionForces all;
  std::array<Vec3, 2> moment;
  double energy;
};

ElementForces forces_in(const Element& element, const State& state, std::size_t e) {
  ElementForces out{{Vec3::Zero(), Vec3::Zero()}, {Vec3::Zero(), Vec3::Zero()}, 0};
  if (state.elements[e].hinge == Hinge::broken) return out;
  const BeamStrain elastic = elastic_strain(state.elements[e], strain_in(element, state));
  out.all = section_forces(element, elastic);
  out.energy = beam_energy(element, elastic);
  for (int k = 0; k < 2; ++k)
    out.moment[k] = forces_along(out.all, element.length, element.s, element.hinge_place[k]).moment;
  return out;
}

/// Work of the mean forces over the flow of one step: elongation and twist of the element, turns of its ends.
/// The flow is that of the element's one integration point, at the distances `arm` from the hinges: their sum
/// turns it, and shears it by the arms.
double hinge_work(const Element& element, const ElementForces& before, const ElementForces& after,
                  const BeamStrain& flow) {
  const double l = element.length, arm[2] = {l / 2 * (element.hinge_place[0] + element.s),
                                             l / 2 * (element.hinge_place[1] + element.s)};
  const auto mean = [&](int k, int axis) { return (before.moment[k][axis] + after.moment[k][axis]) / 2; };
  double work = l / 2 *
                ((before.all.normal.x() + after.all.normal.x()) * flow.gamma.x() +
                 (before.all.moment.x() + after.all.moment.x()) * flow.kappa.x());
  for (const auto& [axis, shear, sign] : {std::tuple(1, 2, 1.), std::tuple(2, 1, -1.)}) {
    const double all = l * flow.kappa[axis], sheared = sign * l * flow.gamma[shear];
    const double second = (sheared - arm[0] * all) / (arm[1] - arm[0]);
    work += mean(0, axis) * (all - second) + mean(1, axis) * second;
  }
  return work;
}

TEST_P(HingeScenes, flow_takes_the_work_of_end_moments_over_turns_of_hinges) {
  const topple::Setup setup = setup_of(GetParam());
  topple::Run run(setup);
  const std::vector<Element>& elements = setup.model.elements;
  State before = run.state();
  double work = 0;
  while (!run.over()) {
    run.advance();
    const State& after = run.state();
    for (std::size_t e = 0; e < elements.size(); ++e) {
      const ElementState &was = before.elements[e], &is = after.elements[e];
      const ElementForces forces = forces_in(elements[e], before, e);
      if (is.hinge == Hinge::broken && was.hinge != Hinge::broken) {
        // it is without forces at the end of the step: half of their work within it, and what it held
        const BeamStrain from = strain_in(elements[e], before), to = strain_in(elements[e], after);
        work += forces.energy + elements[e].length / 2 *
                                    (forces.all.normal.dot(to.gamma - from.gamma) +
                                     forces.all.moment.dot(to.kappa - from.kappa));
      } else if (is.hinge != Hinge::broken) {
        work += hinge_work(elements[e], forces, forces_in(elements[e], after, e),
                           {is.offset.gamma - was.offset.gamma, is.offset.kappa - was.offset.kappa});
      }
    }
    before = after;
  }
  ASSERT_TRUE(run.status().ok()) << run.status().message(setup.model);
  EXPECT_LT(run.energy().balance_error(), 1e-3);
  EXPECT_GT(run.energy().plastic, GetParam().flow);
  // halved steps are seen from end to end here
  EXPECT_NEAR(work / run.energy().plastic, 1, run.rejected_steps() > 0 ? 1e-2 : 1e-9);
  int flowed = 0, broken = 0;
  for (const ElementState& element : before.elements) {
    flowed += element.offset.gamma.isZero(0) && element.offset.kappa.isZero(0) ? 0 : 1;
    broken += element.hinge == Hinge::broken ? 1 : 0;
  }
  EXPECT_GT(flowed, GetParam().flowed);
  EXPECT_GT(broken, GetParam().broken);
}

/// Steps that are taken to the end, and those that were rejected.
std::int64_t steps_of(const topple::Setup& setup) {
  topple::Run run(setup);
  while (!run.over()) run.advance();
  EXPECT_TRUE(run.status().ok()) << run.status().message(setup.model);
  return run.step() + run.rejected_steps();
}

TEST_P(HingeScenes, steps_are_not_shortened_more_than_tenfold) {
  const topple::Setup yields = setup_of(GetParam());
  topple::Setup elastic = yields;
  for (Element& element : elastic.model.elements)
    element.capacity.setConstant(std::numeric_limits<double>::infinity());
  EXPECT_LE(steps_of(yields), 10 * steps_of(elastic));
}

INSTANTIATE_TEST_SUITE_P(BuiltIn, HingeScenes,
                         testing::Values(HingeScene{"weak-storey", 4, 5000, 8, -1},
                                         HingeScene{"folding-leg", 3, 500, 4, -1},
                                         HingeScene{"brittle-connector", 1, 1, 1, 1}),
                         [](const auto& of) {
                           std::string name = of.param.name;
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

// A cantilever of 1 m, deeper than wide, under a load at its tip: elastic up to Mp/L, a mechanism there; its
// softest elastic mode is sideways.
TEST(CollapseOfACantilever, is_a_mechanism_that_goes_with_its_load) {
  const topple::Setup setup = io::parse_scene(R"(topple = 1
[run]
analysis = "static"
gravity = [0, 0, 0]
load_steps = 40
[[material]]
name = "steel"
young = "200 GPa"
poisson = 0.3
density = 7850
yield = "250 MPa"
[[section]]
name = "bar"
shape = "solid"
size = ["20 mm", "30 mm"]
[[frame]]
name = "beam"
nodes = [[0, 0, 0], [1, 0, 0]]
members = [{ nodes = [0, 1], section = "bar", material = "steel" }]
supports = [{ node = 0, fix = "xyzXYZ" }]
loads = [{ node = 1, force = [0, 0, "-2 kN"] }]
)",
                                              "beam.toml")
                                  .setup;
  topple::Run run(setup);
  while (!run.over() && run.advance().ok()) {
  }
  const double collapse = 250e6 * 0.02 * 0.03 * 0.03 / 4 / 2e3;  // Mp/L over the load
  EXPECT_NEAR(run.state().load_factor, collapse, 2e-3 * collapse);
  const Stability& lost = run.status().stability;
  EXPECT_EQ(lost.loss, Stability::Loss::mechanism);
  EXPECT_LT(lost.direction.z(), -0.99);
}

}  // namespace
}  // namespace topple::test
