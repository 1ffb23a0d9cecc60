// Cost of a step of a frame of 36 elements, explicit and implicit, with the error that it makes beside it.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <set>
#include <vector>

#include "solver/frame/body_system.h"
#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

constexpr double k_implicit_step = 1e-3;  // s
constexpr double k_explicit_share = 0.9;  // of the greatest stable step

/// Twelve edges and one diagonal in each face, two elements each: 36 elements, 26 nodes that all may touch
/// the floor under them.
Setup box(double amplitude) {
  Setup setup;
  setup.model = steel_model();
  FrameSpec spec;
  spec.name = "box";
  spec.mass = 40;
  const Vec3 size(0.38, 0.88, 1.79);
  for (int corner = 0; corner < 8; ++corner)
    spec.nodes.emplace_back((corner & 1) * size.x(), (corner >> 1 & 1) * size.y(),
                            0.03 + (corner >> 2 & 1) * size.z());
  const int lines[18][2] = {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3}, {4, 6}, {5, 7}, {0, 4},
                            {1, 5}, {2, 6}, {3, 7}, {0, 3}, {4, 7}, {0, 5}, {2, 7}, {0, 6}, {1, 7}};
  for (const auto& line : lines) spec.members.push_back({{line[0], line[1]}, 0, 0});
  setup.starts = add_frame(setup.model, spec);
  setup.model.planes.push_back(ground(0));
  // rotary inertia as an explicit step asks for it
  for (Mat3& inertia : setup.model.node_inertia) inertia += 2e-3 * Mat3::Identity();
  if (amplitude > 0) shake(setup, amplitude, 1);
  return setup;
}

Simulation start(const Setup& setup) {
  return Simulation(setup.model, setup.starts, setup.parameters, true);
}

double greatest_distance(const State& a, const State& b) {
  double greatest = 0;
  for (std::size_t i = 0; i < a.position.size(); ++i)
    greatest = std::max(greatest, (a.position[i] - b.position[i]).norm());
  return greatest;
}

State after(const Setup& setup, double duration, double h) {
  Simulation sim = start(setup);
  sim.parameters.time_step = h;
  sim.advance(static_cast<int>(std::lround(duration / h)));
  return sim.state;
}

/// A double that counts what is done with it, for the kernels of beam_kernel.h.
struct Counted {
  static inline long operations = 0;
  double value = 0;

  Counted() = default;
  Counted(double of) : value(of) {}
  static Counted result(double of, int count = 1) {
    operations += count;
    return of;
  }
  friend Counted operator+(Counted a, Counted b) { return result(a.value + b.value); }
  friend Counted operator-(Counted a, Counted b) { return result(a.value - b.value); }
  friend Counted operator*(Counted a, Counted b) { return result(a.value * b.value); }
  friend Counted operator/(Counted a, Counted b) { return result(a.value / b.value); }
  friend Counted operator-(Counted a) { return -a.value; }
  friend Counted mul_add(Counted a, Counted b, Counted c) { return result(a.value * b.value + c.value, 2); }
  friend Counted less_product(Counted c, Counted a, Counted b) {
    return result(c.value - a.value * b.value, 2);
  }
  friend Counted with_sign_of(Counted a, Counted b) { return std::copysign(a.value, b.value); }
  friend bool any_above(Counted a, double b) { return a.value > b; }
};
[[maybe_unused]] Counted any_log_factor(const PackQuaternion<Counted>&) {
  return {};
}
[[maybe_unused]] PackAngle<Counted> any_angle(Counted, Counted) {
  return {};
}

/// Floating-point operations on one element.
struct ElementOperations {
  long forces, tangent;  ///< the latter with the former

  ElementOperations() {
    PackBeam<Counted> beam{};
    PackEnds<Counted> ends{};
    ends.x2.x = beam.length = ends.q1.w = ends.q2.w = 1;
    Counted::operations = 0;
    const PackStrain<Counted> strain = pack_strain(beam, ends);
    const PackSection<Counted> section = elastic_section(beam, strain);
    const PackGradient<Counted> gradient = pack_gradient(beam, strain, section);
    pack_energy(beam, strain, section);
    forces = Counted::operations + 12;  // added to the nodes
    pack_tangent(beam, strain, section, gradient, small_angle_slope(strain.angle.x, beam.t),
                 PackStiffness<Counted>{beam.normal_stiffness, beam.bending_stiffness});
    tangent = Counted::operations + 12 + 144;
  }
};

/// Of sparse elimination by minimum degree, a matrix of 6 x 6 blocks: products of blocks and inverses.
struct SparseOperations {
  long factor = 0, solve = 0;

  explicit SparseOperations(const BodySystem& system) {
    std::vector<std::set<int>> graph(system.count);
    for (const OwnElement& own : system.own_elements) {
      graph[own.i].insert(own.j);
      graph[own.j].insert(own.i);
    }
    std::set<int> left;
    for (int i = 0; i < system.count; ++i) left.insert(i);
    while (!left.empty()) {
      const int best = *std::min_element(left.begin(), left.end(),
                                         [&](int a, int b) { return graph[a].size() < graph[b].size(); });
      const std::set<int> rows = graph[best];
      const long n = static_cast<long>(rows.size()), product = 2 * 6 * 6 * 6;
      factor += (n + n * n + 1) * product;
      solve += (2 * n + 1) * 2 * 36;
      left.erase(best);
      for (const int i : rows) {
        graph[i].erase(best);
        for (const int j : rows)
          if (i != j) graph[i].insert(j);
      }
    }
  }
};

// Counted by hand. A node in an explicit step: half step 18, exponential 45, product and length 44, moment to
// material axes 30, accelerations 9, three passes of 48 for the gyroscopic moment, kinetic energy 29,
// work 12. In an iteration: motion 45, exponential and product 89, rate of momentum 60, residual 12,
// correction 120; in a tangent: 3 products of matrices of 45 and what goes into them 120.
constexpr long k_explicit_node = 331, k_iteration_node = 326, k_tangent_node = 255;
constexpr long k_contact = 120;  // of one point that touches
constexpr long k_look = 6;       // at one point and one plane

/// Multiply-adds on ten independent vectors of four, flops a second.
[[gnu::target("avx2,fma")]] double measured_peak() {
  using Four = double __attribute__((vector_size(32)));
  constexpr int k_rounds = 2000000, k_lanes = 10;
  Four x[k_lanes];
  for (int k = 0; k < k_lanes; ++k) x[k] = Four{1. + k, 2, 3, 4};
  Four a{0.999, 0.998, 0.997, 0.996}, b{1e-3, 2e-3, 3e-3, 4e-3};
  double best = 0;
  for (int repeat = 0; repeat < 5; ++repeat) {
    benchmark::DoNotOptimize(a);
    const auto from = std::chrono::steady_clock::now();
    for (int round = 0; round < k_rounds; ++round)
#pragma GCC unroll 10
      for (int k = 0; k < k_lanes; ++k) x[k] = Four(__builtin_ia32_vfmaddpd256(x[k], a, b));
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - from;
    for (Four& v : x) benchmark::DoNotOptimize(v);
    best = std::max(best, 8. * k_lanes * k_rounds / took.count());
  }
  return best;
}

/// Steps from 0.3 s on, under a floor that moves with so many gal from rest on. `error_m`: of the nodes,
/// against half the step. `floor`: of time, if every operation ran at the measured peak, s.
void explicit_step(benchmark::State& bench) {
  constexpr int k_steps = 2000;
  Setup setup = box(bench.range(0) * k_gal);
  setup.parameters.integrator = Integrator::central_difference;
  Simulation first = start(setup);
  first.parameters.time_step = 1e-9;
  first.advance();
  const double h = setup.parameters.time_step = k_explicit_share * *explicit_limit(first.workspace());
  const int begin = static_cast<int>(0.3 / h);
  Simulation sim = start(setup);
  sim.advance(begin);
  const State state = sim.state;
  std::size_t touching = 0;
  for (auto _ : bench) {
    sim.state = state;
    sim.advance(k_steps);
    touching += sim.contacts().size();
  }
  bench.counters["s/step"] = benchmark::Counter(
      k_steps, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  bench.counters["step"] = h;
  bench.counters["touching"] = static_cast<double>(touching) / bench.iterations();
  bench.counters["balance"] = sim.state.energy.balance_error();
  Simulation fine = start(setup);
  fine.parameters.time_step = h / 2;
  fine.advance(2 * (begin + k_steps));
  bench.counters["error_m"] = greatest_distance(sim.state, fine.state);
  const double operations = 36. * ElementOperations().forces + 26. * (k_explicit_node + 2 * k_look) +
                            2. * k_contact * bench.counters["touching"];
  bench.counters["operations"] = operations;
  bench.counters["floor"] = operations / measured_peak();
}
BENCHMARK(explicit_step)->Arg(0)->Arg(400)->Unit(benchmark::kMillisecond);

template <class F>
double seconds(F&& f) {
  const auto from = std::chrono::steady_clock::now();
  f();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - from).count();
}

/// Least time of one factorisation and one solution of a step's matrix, s.
double factor_and_solve(const Setup& setup, const State& state) {
  BodySystem system(setup.model, 0);
  BodyMotion motion;
  system.load(state, motion);
  std::vector<double> b(6 * system.count, 1.);
  double best = 1e300;
  for (int repeat = 0; repeat < 2000; ++repeat) {
    system.lu.set_zero();
    system.evaluate_with_tangent(setup.parameters, {setup.parameters, 0}, motion, state.stick,
                                 motion.position, 0);
    const double inertia = 4 / (k_implicit_step * k_implicit_step);
    for (int i = 0; i < system.count; ++i) {
      Mat6 block = inertia * setup.model.node_mass[i] * Mat6::Identity();
      block.bottomRightCorner<3, 3>() = inertia * setup.model.node_inertia[i];
      system.lu.add(i, i, block);
    }
    best = std::min(best, seconds([&] {
                      system.lu.factor();
                      system.lu.solve(b.data());
                    }));
    benchmark::DoNotOptimize(b.data());
  }
  return best;
}

/// One simulated second from rest likewise, error against an eighth of the step. `multiple`: time of a step
/// over that of a factorisation and a solution.
void implicit_second(benchmark::State& bench) {
  Setup setup = box(bench.range(0) * k_gal);
  const int steps = static_cast<int>(std::lround(1 / k_implicit_step));
  setup.parameters.time_step = k_implicit_step;
  Simulation sim = start(setup);
  const State state = sim.state;
  int iterations = 0;
  double best = 1e300;
  for (auto _ : bench) {
    sim.state = state;
    iterations = 0;
    best = std::min(best, seconds([&] {
                      for (int i = 0; i < steps; ++i) iterations += sim.advance().newton_iterations;
                    }));
  }
  bench.counters["multiple"] = best / steps / factor_and_solve(setup, sim.state);
  bench.counters["s/step"] =
      benchmark::Counter(steps, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  bench.counters["iterations"] = static_cast<double>(iterations) / steps;
  bench.counters["touching"] = static_cast<double>(sim.contacts().size());
  bench.counters["balance"] = sim.state.energy.balance_error();
  bench.counters["error_m"] = greatest_distance(sim.state, after(setup, 1, k_implicit_step / 8));
  const ElementOperations element;
  const SparseOperations sparse(BodySystem(setup.model, 0));
  const double tries = static_cast<double>(iterations) / steps;
  const double operations = 36. * (element.tangent + tries * element.forces) + sparse.factor +
                            tries * (sparse.solve + 26 * k_iteration_node) + 26 * k_tangent_node +
                            (tries + 2) * (26 * k_look + k_contact * bench.counters["touching"]);
  bench.counters["operations"] = operations;
  bench.counters["floor"] = operations / measured_peak();
}
BENCHMARK(implicit_second)->Arg(0)->Arg(400)->Unit(benchmark::kMillisecond);

void peak(benchmark::State& bench) {
  for (auto _ : bench) bench.counters["flops/s"] = measured_peak();
}
BENCHMARK(peak)->Iterations(1);

}  // namespace
}  // namespace topple::test

BENCHMARK_MAIN();
