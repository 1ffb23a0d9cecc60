#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <BulletDynamics/MLCPSolvers/btMLCPSolver.h>
#include <btBulletDynamicsCommon.h>
#include <fmt/format.h>

#include <memory>

#include "bench/engines/block.h"

namespace topple::bench {
namespace {

struct Options {
  int iterations;  ///< of sequential impulses; 0: Dantzig's pivoting
  double erp;
  bool both;      ///< friction in two directions, not in that of the slip alone
  bool split;     ///< depth is taken out beside the velocities
  bool touching;  ///< points that do not touch yet are left out
};

class World {
 public:
  World(const Case& c, double h, const Options& options)
      : h_(h),
        solver_(options.iterations > 0 ? std::make_unique<btSequentialImpulseConstraintSolver>()
                                       : std::make_unique<btMLCPSolver>(&dantzig_)),
        world_(&dispatcher_, &pairs_, solver_.get(), &configuration_),
        floor_(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &ground_)),
        block_(btRigidBody::btRigidBodyConstructionInfo(k_mass, nullptr, &box_, inertia())) {
    btContactSolverInfo& info = world_.getSolverInfo();
    if (options.iterations > 0) info.m_numIterations = options.iterations;
    info.m_erp2 = options.erp;
    info.m_splitImpulse = options.split;
    if (options.both) info.m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
    floor_.setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(0, 0, -1)));
    block_.setWorldTransform(
        btTransform(btQuaternion(btVector3(0, 1, 0), c.tilt), btVector3(c.middle_x(), 0, c.middle_z())));
    block_.setInterpolationWorldTransform(block_.getWorldTransform());
    for (btRigidBody* body : {&floor_, &block_}) {
      body->setFriction(body == &block_ ? k_friction : 1);  // the product counts
      body->setActivationState(DISABLE_DEACTIVATION);
      if (options.touching) body->setContactProcessingThreshold(0);
      world_.addRigidBody(body);
    }
  }
  ~World() {
    world_.removeRigidBody(&block_);
    world_.removeRigidBody(&floor_);
  }
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  bool step(double floor) {
    block_.setGravity(btVector3(-floor, 0, -k_gravity));
    world_.stepSimulation(h_, 0);
    return true;
  }
  double tilt() const {
    const btVector3 axis = block_.getWorldTransform().getBasis().getColumn(2);
    return std::atan2(axis.x(), axis.z());
  }

 private:
  btVector3 inertia() const {
    btVector3 value;
    box_.calculateLocalInertia(k_mass, value);
    return value;
  }

  double h_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase pairs_;
  btDantzigSolver dantzig_;
  std::unique_ptr<btConstraintSolver> solver_;
  btDiscreteDynamicsWorld world_;
  btBoxShape ground_{btVector3(10, 10, 1)};
  btBoxShape box_{btVector3(k_size[0] / 2, k_size[1] / 2, k_size[2] / 2)};
  btRigidBody floor_, block_;
};

}  // namespace

Engine bullet_engine() {
  const int version = btGetVersion();
  Engine engine{"Bullet",
                fmt::format("{}.{}", version / 100, version % 100),
                "double precision, box on a box, CFM 0",
                {}};
  for (const int iterations : {0, 10, 50})
    for (const double erp : {0.01, 0.2, 0.8})
      for (const bool both : {true, false})
        for (const bool split : {true, false})
          for (const bool touching : {true, false})
            for (const double h : k_steps) {
              const Options options{iterations, erp, both, split, touching};
              engine.grid.push_back(
                  {h,
                   fmt::format("{}, ERP {:g}{}, {} friction direction{}{}",
                               iterations > 0 ? fmt::format("{} iterations", iterations) : "Dantzig", erp,
                               split ? " split" : "", both ? 2 : 1, both ? "s" : "",
                               touching ? ", touching points" : ""),
                   [=](const Case& c) {
                     auto world = std::make_shared<World>(c, h, options);
                     return stepped(
                         c, h, [world](double floor) { return world->step(floor); },
                         [world] { return world->tilt(); });
                   }});
            }
  return engine;
}

}  // namespace topple::bench
