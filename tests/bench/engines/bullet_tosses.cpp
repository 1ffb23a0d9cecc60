#include <btBulletDynamicsCommon.h>
#include <fmt/format.h>

#include "bench/engines/tosses.h"

namespace topple::bench {
namespace {

struct Options {
  double h, friction, restitution;
  int iterations;
};

btVector3 vector_of(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

class World {
 public:
  World(const study::Toss& toss, double offset, const Options& options)
      : h_(options.h),
        floor_(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &ground_)),
        cube_(btRigidBody::btRigidBodyConstructionInfo(
            study::TossedCube::mass, nullptr, &box_,
            btVector3(study::TossedCube::inertia, study::TossedCube::inertia, study::TossedCube::inertia))) {
    world_.setGravity(btVector3(0, 0, -9.80665));
    world_.getSolverInfo().m_numIterations = options.iterations;
    world_.getSolverInfo().m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
    floor_.setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(0, 0, offset - 1)));
    const study::CubePose& first = toss.rows.front();
    const Quat& q = first.rotation;
    cube_.setWorldTransform(btTransform(btQuaternion(q.x(), q.y(), q.z(), q.w()), vector_of(first.place)));
    cube_.setInterpolationWorldTransform(cube_.getWorldTransform());
    cube_.setLinearVelocity(vector_of(toss.velocity));
    cube_.setAngularVelocity(vector_of(toss.angular_velocity));
    for (btRigidBody* body : {&floor_, &cube_}) {  // products count
      body->setFriction(body == &cube_ ? options.friction : 1);
      body->setRestitution(body == &cube_ ? options.restitution : 1);
      body->setActivationState(DISABLE_DEACTIVATION);
      world_.addRigidBody(body);
    }
  }
  ~World() {
    world_.removeRigidBody(&cube_);
    world_.removeRigidBody(&floor_);
  }
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  study::CubePose step() {
    world_.stepSimulation(h_, 0);
    const btTransform& at = cube_.getWorldTransform();
    const btQuaternion q = at.getRotation();
    return {
        0, {at.getOrigin().x(), at.getOrigin().y(), at.getOrigin().z()}, Quat(q.w(), q.x(), q.y(), q.z())};
  }

 private:
  double h_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase pairs_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &pairs_, &solver_, &configuration_};
  btBoxShape ground_{btVector3(10, 10, 1)};
  btBoxShape box_{
      btVector3(study::TossedCube::half_edge, study::TossedCube::half_edge, study::TossedCube::half_edge)};
  btRigidBody floor_, cube_;
};

}  // namespace

std::vector<TossSetting> bullet_toss_settings() {
  std::vector<TossSetting> all;
  for (const double h : k_toss_steps)
    for (const int iterations : {10, 50})
      for (const double restitution : {0., 0.125, 0.25})
        for (const double friction : k_toss_frictions) {
          const Options options{h, friction, restitution, iterations};
          all.push_back({"Bullet",
                         fmt::format("{:g} ms, friction {:g}, restitution {:g}, {} iterations", 1e3 * h,
                                     friction, restitution, iterations),
                         [options](const study::Toss& toss, double offset) {
                           World world(toss, offset, options);
                           return stepped_toss(toss, options.h, [&] { return world.step(); });
                         }});
        }
  return all;
}

}  // namespace topple::bench
