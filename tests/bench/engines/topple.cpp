#include <fmt/format.h>

#include <memory>
#include <optional>

#include "bench/engines/block.h"
#include "solver/io/scene/scene.h"
#include "solver/planar/planar_run.h"
#include "solver/run/run.h"

namespace topple::bench {
namespace {

struct Options {
  const char* model;
  double step;                            ///< s; 0: adaptive
  double tolerance;                       ///< of the adaptive step
  double alpha;                           ///< kgf; 0: the default of the scene
  double normal_speed;                    ///< m/s
  std::optional<double> spectral_radius;  ///< of generalized-alpha, which `rigid` does without
};

std::string scene_text(const Case& c, const Options& options) {
  const double x = k_size[0] / 2, y = k_size[1] / 2, z = k_size[2] / 2;
  constexpr double half_width = 0.015;  // m, of the members: the floor's face lies at z = 0
  const auto inertia = [](double a, double b) { return k_mass * (a * a + b * b) / 12; };
  std::string text = fmt::format("topple = 1\n[run]\nduration = 10\ngravity = [0, 0, {}]\nsettle = {}\n",
                                 -k_gravity, c.tilt == 0);
  if (options.spectral_radius) text += fmt::format("spectral_radius = {}\n", *options.spectral_radius);
  text += options.step > 0 ? fmt::format("time_step = {}\n", options.step)
                           : fmt::format("time_step = \"auto\"\ntolerance = {}\n", options.tolerance);
  if (c.amplitude > 0)
    text +=
        fmt::format("[[shake]]\ntype = \"sine\"\namplitude = {}\nfrequency = {}\n", c.amplitude, c.frequency);
  text += fmt::format("[contact]\nlaw = \"coulomb\"\nrestitution = 0\nfriction = {}\nnormal_speed = {}\n",
                      k_friction, options.normal_speed);
  if (options.alpha > 0) text += fmt::format("alpha = \"{} kgf\"\n", options.alpha);
  text +=
      "[floor]\ntype = \"plane\"\n"
      "[[material]]\nname = \"rigid\"\nyoung = 1e13\npoisson = 0.3\ndensity = 0.001\n"
      "[[section]]\nname = \"post\"\nshape = \"custom\"\narea = 0.1\niy = 0.01\niz = 0.01\nj = 0.01\n"
      "ky = 1\nkz = 1\n";
  text +=
      fmt::format("width = {}\n[[frame]]\nname = \"block\"\nmodel = \"{}\"\n", 2 * half_width, options.model);
  text += fmt::format(
      "nodes = [[{0}, {1}, {3}], [{0}, {2}, {3}], [{4}, {1}, {3}], [{4}, {2}, {3}], [0, 0, {5}]]\n"
      "members = [\n",
      -x, -y, y, half_width, x, z + half_width);
  for (int k = 0; k < 4; ++k)
    text += fmt::format("  {{ nodes = [{}, 4], section = \"post\", material = \"rigid\" }},\n", k);
  text += fmt::format("]\nmasses = [{{ node = 4, mass = {}, inertia = [{}, {}, {}] }}]\n", k_mass,
                      inertia(2 * y, 2 * z), inertia(2 * x, 2 * z), inertia(2 * x, 2 * y));
  if (c.tilt > 0) text += fmt::format("tilt = {}\n", c.tilt);
  return text;
}

std::string edges_text(const Case& c, double step, const std::string& more) {
  return fmt::format(
      "topple = 1\n[run]\nduration = 100\ngravity = [0, 0, {}]\ntime_step = {}\nwant = [\"motion\"]\n"
      "[[shake]]\ntype = \"sine\"\namplitude = {}\nfrequency = {}\n[contact]\nfriction = {}\n[floor]\n"
      "[[cabinet]]\nsize = [{}, {}, {}]\nmass = {}\ninertia = \"solid\"\nsection = \"box 30x1\"\n"
      "material = \"steel\"\nshelves = 3\npanel_thickness = 0.001\nbase = \"edges\"\n{}",
      -k_gravity, step, c.amplitude, c.frequency, k_friction, k_size[0], k_size[1], k_size[2], k_mass, more);
}

struct World {
  explicit World(const std::string& text) : setup(io::parse_scene(text, "block").setup) {}
  Setup setup;
  Run run{setup};
};

Simulation start(const std::string& text) {
  auto world = std::make_shared<World>(text);
  return {[world] {
            if (!world->run.status().ok() || !world->run.advance().ok()) return std::nan("");
            return world->run.outcome().bodies()[0].time;  // state() would place the nodes
          },
          [world] {
            const Vec3 axis = world->run.state().rotation[0] * Vec3::UnitZ();
            return std::atan2(axis.x(), axis.z());
          }};
}

planar::PlanarCase planar_case(const Case& c, double tolerance) {
  planar::Block block;
  block.mass = k_mass;
  block.inertia = k_mass * (k_size[0] * k_size[0] + k_size[2] * k_size[2]) / 12;
  block.left = block.right = k_size[0] / 2;
  block.height = k_size[2] / 2;
  block.static_friction = block.kinetic_friction = k_friction;
  block.gravity = k_gravity;
  return {.block = block,
          .start = planar::standing(c.tilt),
          .along = Vec3::UnitX(),
          .across = Vec3::UnitY(),
          .origin = Vec3::Zero(),
          .controls = {.tolerance = tolerance},
          .farthest = planar::k_never};
}

Shake sine(const Case& c) {
  Shake shake;
  shake.amplitude = c.amplitude, shake.frequency = c.frequency;
  return shake;
}

struct PlanarWorld {
  PlanarWorld(const Case& c, double tolerance)
      : block(planar_case(c, tolerance)), run(block, {sine(c)}, 10) {}
  const planar::PlanarCase block;
  planar::PlanarRun run;
};

Simulation start_planar(const Case& c, double tolerance) {
  auto world = std::make_shared<PlanarWorld>(c, tolerance);
  return {[world] {
            if (world->run.over()) return std::nan("");
            world->run.advance();
            return world->run.state().time;
          },
          [world] { return world->run.state().tilt; },
          [world](double time) { return planar::state_within(world->run.step(), time).tilt; }};
}

}  // namespace

Engine planar_engine() {
  Engine engine{"topple planar", TOPPLE_VERSION, "a planar block, from event to event", {}};
  for (const double tolerance : {1e-3, 1e-5, 1e-7, 1e-9, 1e-11})
    engine.grid.push_back({0, fmt::format("planar, tolerance {:g}", tolerance),
                           [=](const Case& c) { return start_planar(c, tolerance); }});
  return engine;
}

Engine topple_engine() {
  Engine engine{"topple",
                TOPPLE_VERSION,
                "four stiff members on four corners, penalty contact; as frame with generalized-alpha",
                {}};
  struct Model {
    const char* name;
    std::optional<double> spectral_radius;
  };
  for (const auto& [model, radius] : {Model{"rigid", {}}, Model{"frame", 0.8}, Model{"frame", 0.}})
    for (const double alpha : {0., 1.5e5, 5e5, 1e6})
      for (const double speed : {1e-3, 1e-2}) {
        const std::string how = (radius ? fmt::format("{}, spectral_radius {:g}, ", model, *radius)
                                        : fmt::format("{}, ", model)) +
                                (alpha > 0 ? fmt::format("alpha {:g} kgf", alpha) : "default alpha") +
                                fmt::format(", normal_speed {:g} mm/s", 1e3 * speed);
        const auto add = [&](double step, double tolerance, const std::string& more) {
          const Options options{model, step, tolerance, alpha, speed, radius};
          engine.grid.push_back(
              {step, how + more, [=](const Case& c) { return start(scene_text(c, options)); }});
        };
        for (const double h : k_steps) add(h, 0, "");
        for (const double tolerance : {1e-2, 1e-3, 1e-4})
          add(0, tolerance, fmt::format(", tolerance {:g}", tolerance));
      }
  return engine;
}

Setting cabinet_on_edges(double step, const std::string& more) {
  return {step, more, [=](const Case& c) { return start(edges_text(c, step, more)); }};
}

}  // namespace topple::bench
