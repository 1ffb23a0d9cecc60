#include <fmt/format.h>
#include <ode/ode.h>

#include <array>
#include <memory>

#include "bench/engines/block.h"

namespace topple::bench {
namespace {

struct Options {
  int iterations;  ///< of SOR; 0: Dantzig's pivoting
  double erp, cfm;
  double layer;  ///< m, depth that is left alone
};

class World {
 public:
  World(const Case& c, double h, const Options& options) : h_(h), options_(options) {
    dWorldSetERP(world_, options.erp);
    dWorldSetCFM(world_, options.cfm);
    dWorldSetContactSurfaceLayer(world_, options.layer);
    if (options.iterations > 0) dWorldSetQuickStepNumIterations(world_, options.iterations);
    dWorldSetAutoDisableFlag(world_, 0);
    dMass mass;
    dMassSetBoxTotal(&mass, k_mass, k_size[0], k_size[1], k_size[2]);
    dBodySetMass(body_, &mass);
    dBodySetPosition(body_, c.middle_x(), 0, c.middle_z());
    dMatrix3 rotation;
    dRFromAxisAndAngle(rotation, 0, 1, 0, c.tilt);
    dBodySetRotation(body_, rotation);
    dGeomSetBody(box_, body_);
  }
  ~World() {
    dJointGroupDestroy(contacts_);
    dGeomDestroy(box_);
    dGeomDestroy(floor_);
    dWorldDestroy(world_);
  }
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  bool step(double floor) {
    dWorldSetGravity(world_, -floor, 0, -k_gravity);
    std::array<dContactGeom, 8> found;
    const int count =
        dCollide(box_, floor_, static_cast<int>(found.size()), found.data(), sizeof(dContactGeom));
    for (int k = 0; k < count; ++k) {
      dContact contact{};
      contact.surface.mode = dContactApprox1;
      contact.surface.mu = k_friction;
      contact.geom = found[static_cast<std::size_t>(k)];
      dJointAttach(dJointCreateContact(world_, contacts_, &contact), body_, nullptr);
    }
    const int done = options_.iterations > 0 ? dWorldQuickStep(world_, h_) : dWorldStep(world_, h_);
    dJointGroupEmpty(contacts_);
    return done != 0;
  }
  double tilt() const {
    const dReal* r = dBodyGetRotation(body_);  // rows of four
    return std::atan2(r[2], r[10]);
  }

 private:
  double h_;
  Options options_;
  dWorldID world_ = dWorldCreate();
  dJointGroupID contacts_ = dJointGroupCreate(0);
  dGeomID floor_ = dCreatePlane(nullptr, 0, 0, 1, 0);
  dGeomID box_ = dCreateBox(nullptr, k_size[0], k_size[1], k_size[2]);
  dBodyID body_ = dBodyCreate(world_);
};

Simulation start(const Case& c, double h, const Options& options) {
  struct Library {
    Library() {
      dInitODE2(0);
      dSetMessageHandler(
          [](int, const char*, va_list) {});  // "LCP internal error": the errors of the run show it
    }
    ~Library() { dCloseODE(); }
  };
  static const Library library;
  auto world = std::make_shared<World>(c, h, options);
  return stepped(
      c, h, [world](double floor) { return world->step(floor); }, [world] { return world->tilt(); });
}

}  // namespace

Setting ode_box(double step) {
  return {step, "", [=](const Case& c) { return start(c, step, {0, 0.2, 1e-6, 1e-4}); }};
}

Engine ode_engine() {
  Engine engine{"ODE", dODE_VERSION, "double precision, box on a plane", {}};
  for (const int iterations : {0, 20, 50})
    for (const double erp : {0.01, 0.2, 0.8})
      for (const double cfm : {1e-10, 1e-6, 1e-5})
        for (const double layer : {0., 1e-4})
          for (const double h : k_steps) {
            const Options options{iterations, erp, cfm, layer};
            engine.grid.push_back(
                {h,
                 fmt::format("{}, ERP {:g}, CFM {:g}, surface layer {:g} mm",
                             iterations > 0 ? fmt::format("quick step of {}", iterations) : "step", erp, cfm,
                             1e3 * layer),
                 [=](const Case& c) { return start(c, h, options); }});
          }
  return engine;
}

}  // namespace topple::bench
