// Cabinets computed as rigid, elastic or frame, which the tests of model levels share.
#pragma once

#include "solver/body/body_pose.h"
#include "solver/body/model_level.h"
#include "solver/reduced/elastic_basis.h"
#include "unit/solver/fixtures.h"

namespace topple::test {

inline void compute_as(Setup& setup, BodyModel model) {
  for (std::size_t b = 0; b < setup.model.bodies.size(); ++b)
    setup.model.bodies[b].elastic = elastic_basis(setup.model, static_cast<int>(b));
  setup.parameters.models.assign(setup.model.bodies.size(), model);
}

inline Setup paper_cabinet(BodyModel model, double tilt = 0) {
  Setup setup = shaken(1, tilt);
  setup.parameters.contact.restitution = 0.5;
  compute_as(setup, model);
  return setup;
}

/// Thrown, turning about all axes, with nothing to hit.
inline Setup thrown(BodyModel model) {
  Setup setup;
  setup.model = steel_model();
  CabinetSpec spec = tall_cabinet();
  spec.velocity = Vec3(1, -0.5, 3);
  spec.angular_velocity = Vec3(2, -1, 1.5);
  setup.starts.push_back(add_cabinet(setup.model, spec));
  setup.run.settle = false;
  compute_as(setup, model);
  return setup;
}

inline Simulation simulate(const Setup& setup) {
  return {setup.model, setup.starts, setup.parameters, setup.run.settle};
}

inline double tilt_of(const Simulation& sim) {
  return tilt(body_pose(sim.model, sim.state, 0)) * k_degrees;
}

inline State placed(const Simulation& sim) {
  State state = sim.state;
  place_nodes(sim.model, state);
  return state;
}

}  // namespace topple::test
