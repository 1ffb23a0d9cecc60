// Steps use the memory that the first one took.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "unit/solver/fixtures.h"

namespace {
std::atomic<long> allocations{0};

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
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}

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
  delete new int;
  const std::vector<Four> aligned(3);
  EXPECT_EQ(allocations, before + 2);
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

}  // namespace
}  // namespace topple::test
