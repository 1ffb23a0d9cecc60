#include "solver/study/validate/granite_rigid.h"

#include <fmt/format.h>

#include <cmath>

#include "solver/io/scene/scene.h"

namespace topple::study {
namespace {

constexpr double k_mass = 353.8;       // kg
constexpr double k_half_width = 0.38;  // m, of the base across the motion: half of the mesh's extent
constexpr double k_friction = 1.5;     // the most that scenes allow
constexpr double k_least_rate =
    1e-3;  // rad/s, of a landing: below, contacts that give way turn it to and fro

std::string scene_text(const RockTraits& traits, const Rock& rock, double duration) {
  constexpr double k_width = 0.03;  // m, contact
  const double base = k_width / 2, inertia = k_mass * traits.inertia_over_mass * rock.inertia;
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

Setup setup_of(const RockTraits& traits, const Rock& rock, const GraniteTest& test) {
  const double duration = test.motion->duration + k_after_record;
  Setup setup = io::parse_scene(scene_text(traits, rock, duration), "rock").setup;
  Shake shake;
  shake.kind = Shake::Kind::record;
  shake.record = test.motion;
  setup.parameters.shakes = {shake};
  return setup;
}

}  // namespace

RigidRock::RigidRock(const RockTraits& traits, const Rock& rock, const GraniteTest& test)
    : setup_(setup_of(traits, rock, test)), restitution_(rock.restitution), run_(std::in_place, setup_) {}

double RigidRock::tilt() const {
  const Quat& q = run_->point().state.bodies.front().rotation;
  return 2 * std::atan2(q.y(), q.w());
}

double RigidRock::rate() const {
  return run_->point().state.bodies.front().angular_velocity.y();
}

void RigidRock::advance() {
  const double before = tilt();
  if (!run_->advance().ok() || restitution_ == 1 || !(before * tilt() < 0) || std::abs(rate()) < k_least_rate)
    return;
  RunPoint point = run_->point();  // contacts hold an edge, so that all of the motion is a rotation about it
  BodyState& body = point.state.bodies.front();
  body.velocity *= restitution_, body.angular_velocity *= restitution_;
  EnergyLedger& energy = point.state.energy;
  const double lost = (1 - restitution_ * restitution_) * energy.kinetic;
  energy.kinetic -= lost, energy.damping += lost;
  run_.emplace(setup_, std::move(point));
}

bool RigidRock::over() const {
  return !run_->status().ok() || run_->over();
}

bool RigidRock::fell() const {
  return run_->outcome().bodies().front().beyond_since.has_value();
}

bool rigid_falls(const RockTraits& traits, const Rock& rock, const GraniteTest& test,
                 const std::function<bool()>& give_up) {
  RigidRock rigid(traits, rock, test);
  while (!rigid.over() && !give_up()) rigid.advance();
  return rigid.fell();
}

}  // namespace topple::study
