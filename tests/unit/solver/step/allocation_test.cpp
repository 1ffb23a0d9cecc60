// Steps use the memory that the first one took.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "solver/model/accelerogram.h"
#include "solver/model/excitation.h"
#include "solver/reduced/elastic_basis.h"
#include "unit/solver/fixtures.h"

namespace {
std::atomic<long> allocations{0};
}

// The whole family, as Eigen calls malloc itself. Sanitizers have it for themselves and leave `new`.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);

void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  ++allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* memory, std::size_t size) {
  ++allocations;
  return __libc_realloc(memory, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  ++allocations;
  return __libc_memalign(alignment, size);
}
}
#else
namespace {
void* counted(std::size_t size, std::size_t alignment) {
  ++allocations;
  void* const memory = alignment > alignof(std::max_align_t)
                           ? std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment)
                           : std::malloc(size);
  if (!memory) throw std::bad_alloc();
  return memory;
}
}  // namespace

void* operator new(std::size_t size) {
  return counted(size, 1);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  return counted(size, static_cast<std::size_t>(alignment));
}
// Not inlined, where GCC would take free for a mismatch of new.
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}
#endif

namespace topple::test {
namespace {

// Of `steps` steps after the first; contacts open and close on the way.
long allocations_of(const Setup& setup, Integrator integrator, double h, int steps) {
  Simulation sim(setup.model, setup.starts, setup.parameters, setup.run.settle);
  sim.parameters.integrator = integrator;
  sim.parameters.time_step = h;
  EXPECT_TRUE(sim.advance().ok());
  const long before = allocations;
  std::size_t least = 100, most = 0;
  for (int i = 0; i < steps; ++i) {
    if (!sim.advance().ok()) ADD_FAILURE() << "a step failed";
    if (i % 50 != 0) continue;
    const long own = allocations;
    least = std::min(least, sim.contacts().size());
    most = std::max(most, sim.contacts().size());
    allocations = own;
  }
  EXPECT_LT(least, most);
  return allocations - before;
}

TEST(Allocation, counter_counts) {
  const long before = allocations;
  std::vector<int> plain(3);
  const std::vector<Four> aligned(3);
  [[maybe_unused]] const void* volatile used = aligned.data();  // else compilers may do without them
  used = plain.data();
  EXPECT_EQ(allocations, before + 2);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  plain.resize(static_cast<std::size_t>(Eigen::VectorXd::Zero(plain.size()).eval().size()));
  EXPECT_EQ(allocations, before + 3);
#endif
}

TEST(Allocation, a_record_shakes_the_floor_without_taking_memory) {
  Shake shake;
  shake.kind = Shake::Kind::record;
  shake.record = make_accelerogram({{Vec3::UnitX(), 0.01, std::vector<double>(1000, 2.)}});
  const std::vector<Shake> shakes{shake};
  const long before = allocations;
  double sum = 0;
  for (int i = 0; i < 1000; ++i) sum += floor_acceleration(shakes, 0.00999 * i).x();
  EXPECT_NEAR(sum, 2000, 1e-9);
  EXPECT_EQ(allocations, before);
}

TEST(Allocation, no_explicit_step_after_the_first_takes_memory) {
  topple::Setup setup = shaken(1);
  shake(setup, 7, 2);
  EXPECT_EQ(allocations_of(setup, Integrator::central_difference, 2e-5, 20000), 0);
}

TEST(Allocation, no_implicit_step_after_the_first_takes_memory) {
  topple::Setup setup = shaken(2);
  shake(setup, 7, 2);
  EXPECT_EQ(allocations_of(setup, Integrator::generalized_alpha, 1e-3, 2000), 0);
}

TEST(Allocation, no_step_with_anchors_after_the_first_takes_memory) {
  for (const BodyModel body : {BodyModel::frame, BodyModel::elastic, BodyModel::rigid}) {
    topple::Setup setup = shaken(2);
    for (const int side : {-1, 1}) {
      Anchor anchor{.name = "strap",
                    .body = 0,
                    .node = 0,
                    .arm = Vec3(0, 0, 1.7),
                    .to = Vec3(side, 0, 1.7),
                    .other = {},
                    .type = Anchor::Type::strap,
                    .stiffness = 1e4,
                    .length = 0};
      anchor.length = (setup.model.node_position[0] + anchor.arm - anchor.to).norm();
      if (side < 0) anchor.strength = 20;  // breaks on the way
      setup.model.anchors.push_back(anchor);
    }
    setup.model.bodies[0].elastic = elastic_basis(setup.model, 0);
    setup.parameters.models = {body};
    setup.parameters.anchors = {true, true};
    shake(setup, 7, 2);
    EXPECT_EQ(allocations_of(setup, Integrator::generalized_alpha, 1e-3, 1500), 0) << static_cast<int>(body);
  }
}

TEST(Allocation, no_step_in_which_hinges_form_takes_memory) {
  topple::Setup setup;
  setup.model = steel_model();
  setup.model.materials[0].yield = 20e6;
  CabinetSpec spec = tall_cabinet();
  spec.tilt = 0.5;
  setup.starts.push_back(add_cabinet(setup.model, spec));
  setup.model.planes.push_back(ground());
  Simulation sim(setup.model, setup.starts, setup.parameters);
  ASSERT_TRUE(sim.advance().ok());
  const long before = allocations;
  ASSERT_TRUE(sim.advance(1000));
  EXPECT_EQ(allocations, before);
  EXPECT_GT(sim.state.energy.plastic, 0);
}

/// A cabinet that rocks on the floor and against a wall, computed as `model`.
topple::Setup rocking(BodyModel model, bool adaptive) {
  topple::Setup setup = shaken(4);
  setup.model.planes.push_back({"wall", Vec3(-0.22, 0, 0), Vec3::UnitX(), 0.09});
  if (model != BodyModel::frame) setup.model.bodies[0].elastic = elastic_basis(setup.model, 0);
  setup.parameters.models = {model};
  setup.parameters.adaptive = adaptive;
  setup.parameters.contact.alpha = 2000;
  setup.parameters.contact.restitution = 0.5;
  shake(setup, 4, 2);
  return setup;
}

std::string in_words(const ::testing::TestParamInfo<std::tuple<BodyModel, bool>>& given) {
  const auto [model, adaptive] = given.param;
  return std::string(model == BodyModel::rigid     ? "rigid"
                     : model == BodyModel::elastic ? "elastic"
                                                   : "frame") +
         (adaptive ? "_adaptive" : "_fixed");
}

class RockingAllocation : public ::testing::TestWithParam<std::tuple<BodyModel, bool>> {};

TEST_P(RockingAllocation, no_step_after_the_first_takes_memory_but_for_its_events) {
  const auto [model, adaptive] = GetParam();
  const topple::Setup setup = rocking(model, adaptive);
  topple::Run run(setup);
  ASSERT_TRUE(run.status().ok()) << run.status().message(setup.model);
  ASSERT_TRUE(run.advance().ok());
  int planes = 0;  // bits: touched ones
  std::size_t least = 100, most = 0;
  for (int i = 0; i < 1000 && !run.over(); ++i) {
    const long before = allocations;
    const std::size_t events = run.events().size();
    ASSERT_TRUE(run.advance().ok()) << run.status().message(setup.model);
    if (run.events().size() == events) {
      ASSERT_EQ(allocations, before) << "step " << i << " to " << run.time() << " s";
    }
    least = std::min(least, run.contacts().size());
    most = std::max(most, run.contacts().size());
    for (const ContactForce& force : run.contacts()) planes |= 1 << force.plane;
  }
  EXPECT_LT(least, most);
  EXPECT_EQ(planes, 3);
}

TEST(Allocation, no_step_of_a_planar_block_takes_memory_but_for_its_events) {
  topple::Setup setup = shaken(4);
  CabinetSpec spec = tall_cabinet();
  spec.base = CabinetSpec::Base::corners;
  setup.model = steel_model();
  setup.starts = {add_cabinet(setup.model, spec)};
  setup.model.planes.push_back(ground());
  setup.parameters.models = {BodyModel::planar};
  shake(setup, 4, 1);
  topple::Run run(setup);
  ASSERT_TRUE(run.advance().ok());
  std::size_t most = 0;
  while (!run.over()) {
    const long before = allocations;
    const std::size_t events = run.events().size();
    ASSERT_TRUE(run.advance().ok());
    if (run.events().size() == events) {
      ASSERT_EQ(allocations, before) << run.time();
    }
    most = std::max(most, run.events().size());
  }
  EXPECT_EQ(run.state().bodies[0].level, ModelLevel::planar);
  EXPECT_GT(most, 4u);
}

// A cabinet falls on another. Who comes near, or leaves, takes memory.
TEST(Allocation, bodies_that_lie_on_each_other_take_no_memory) {
  topple::Setup setup = shaken(3);
  CabinetSpec spec = tall_cabinet();
  spec.name = "falling";
  spec.at = Vec3(0.05, 0.1, 1.9);
  setup.starts.push_back(add_cabinet(setup.model, spec));
  setup.parameters.contact.alpha = 2000;
  Simulation sim(setup.model, setup.starts, setup.parameters, false);
  ASSERT_TRUE(sim.advance(1000));
  int steps = 0;
  for (int i = 0; i < 1000; ++i) {
    const CandidatePairs near = sim.state.candidate_pairs;
    const long before = allocations;
    ASSERT_TRUE(sim.advance().ok());
    if (near.empty() || !(sim.state.candidate_pairs == near)) continue;
    ASSERT_EQ(allocations, before) << "step " << i;
    ++steps;
  }
  EXPECT_GT(steps, 500);
}

INSTANTIATE_TEST_SUITE_P(Levels, RockingAllocation,
                         ::testing::Combine(::testing::Values(BodyModel::rigid, BodyModel::elastic,
                                                              BodyModel::frame),
                                            ::testing::Bool()),
                         in_words);

}  // namespace
}  // namespace topple::test
