// A rock as a body of the rigid model: a base of four corners, its mass and inertia in one point.
#include <fmt/format.h>

#include "solver/io/scene/scene.h"
#include "solver/run/run.h"
#include "solver/study/validate/granite_study.h"

namespace topple::study {
namespace {

constexpr double k_mass = 353.8;       // kg
constexpr double k_half_width = 0.38;  // m, of the base across the motion: half of the mesh's extent
constexpr double k_friction = 1.5;     // the most that scenes allow

std::string scene_text(const RockTraits& traits, const Rock& rock, double duration) {
  constexpr double k_width = 0.03;  // m, contact
  const double base = k_width / 2, inertia = k_mass * traits.inertia_over_mass;
  return fmt::format(
      "topple = 1\n[run]\nduration = {:.6f}\nwant = [\"motion\"]\nstop_when = \"all-overturned\"\n"
      "time_step = \"auto\"\n[contact]\nfriction = {}\nrestitution = 0\n[floor]\ntype = \"plane\"\n"
      "[[shake]]\ntype = \"sine\"\nfrequency = 1\namplitude = 1\n"
      "[[material]]\nname = \"rigid\"\nyoung = 1e13\npoisson = 0.3\ndensity = 0.001\n"
      "[[section]]\nname = \"post\"\nshape = \"custom\"\narea = 0.1\niy = 0.01\niz = 0.01\nj = 0.01\nky = 1\n"
      "kz = 1\nwidth = {}\n[[frame]]\nname = \"rock\"\nmodel = \"rigid\"\n"
      "nodes = [[{:.9f},-{},{}],[{:.9f},{},{}],[{:.9f},-{},{}],[{:.9f},{},{}],[0,0,{:.6f}]]\n"
      "members = [{{nodes=[0,4],section=\"post\",material=\"rigid\"}},"
      "{{nodes=[1,4],section=\"post\",material=\"rigid\"}},"
      "{{nodes=[2,4],section=\"post\",material=\"rigid\"}},"
      "{{nodes=[3,4],section=\"post\",material=\"rigid\"}}]\n"
      "masses = [{{node=4,mass={},inertia=[{},{},{}]}}]\n",
      duration, k_friction, k_width, -rock.left, k_half_width, base, -rock.left, k_half_width, base,
      rock.right, k_half_width, base, rock.right, k_half_width, base, base + traits.height, k_mass, inertia,
      inertia, inertia);
}

}  // namespace

bool rigid_falls(const RockTraits& traits, const Rock& rock, const GraniteTest& test,
                 const std::function<bool()>& give_up) {
  const double duration = test.motion->duration + k_after_record;
  Setup setup = io::parse_scene(scene_text(traits, rock, duration), "rock").setup;
  Shake shake;
  shake.kind = Shake::Kind::record;
  shake.record = test.motion;
  setup.parameters.shakes = {shake};
  Run run(setup);
  while (run.status().ok() && !run.over() && !give_up())
    if (!run.advance().ok()) break;
  return run.outcome().bodies().front().beyond_since.has_value();
}

}  // namespace topple::study
