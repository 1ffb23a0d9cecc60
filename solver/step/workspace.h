// Scratch of a step.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "solver/body/islands.h"
#include "solver/body/ladder.h"
#include "solver/body/reduced_body.h"
#include "solver/frame/body_system.h"
#include "solver/frame/generalized_alpha.h"
#include "solver/step/step.h"

namespace topple {

/// What became of a system, or of some bodies that are not frames, in a step.
struct PartOfStep {
  StepEnergy exchanged;
  BodyEnergy held;
  StepStatus status;
};

/// What Workspace keeps between steps, for the sources of the step alone.
struct Workspace::Impl {
  explicit Impl(const Model& model)
      : islands(model),
        search(model),
        reduced_bodies(model.bodies.size()),
        near(model.bodies.size()),
        new_frames(model.bodies.size()),
        sections(model.elements.size(), {Vec3::Zero(), Vec3::Zero()}) {
    moving.reserve(model.bodies.size());
    parts.reserve(model.bodies.size());
    contact_forces.reserve(model.contact_points.size() * model.planes.size());
  }
  const std::vector<BodySystem*>& systems() const { return islands.systems(); }
  // Parameters that are good.
  void meet(const Parameters& now) {
    if (parameters == now) return;
    parameters = now;
    base.clear();
    reached.reset();
    explicit_limit.reset();
  }
  // With the anchors of `state`.
  ReducedBody& reduced(const Model& model, const State& state, int body) {
    if (!reduced_bodies[body]) reduced_bodies[body] = std::make_unique<ReducedBody>(model, body);
    reduced_bodies[body]->remember(state.anchors);
    return *reduced_bodies[body];
  }

  Islands islands;
  NearSearch search;
  std::vector<std::unique_ptr<ReducedBody>>
      reduced_bodies;                              // per body, once it was on another rung than frame
  std::vector<ReducedScratch> reduced_scratch{1};  // per worker
  std::optional<Parameters> parameters;            // met last; for them hold:
  std::vector<RungChoice> base;                    //   per body
  std::optional<Instant> reached;                  //   the end of the last step that was tried
  std::optional<double> explicit_limit;            //   s, of the frames there are, and the body that sets it
  int limiting_body = -1, limiting_node = -1;
  std::vector<char> near;                       // per body: another is
  std::vector<char> new_frames;                 // per body: since the last step
  std::vector<char> new_anchors;                // per body: one was switched or broke
  std::vector<IntegratorScratch> scratches{1};  // per worker
  ParallelFor parallel;
  Profile profile;
  std::vector<int> moving;  // bodies that are not frames
  std::vector<PartOfStep> parts;
  BodyMotion motion;
  Contacts contacts;
  std::vector<ContactForce> contact_forces;
  std::vector<MemberForce> member_forces;
  std::vector<SectionForces> sections;
  State next;
  int most_iterations = 0;  // of one system in the newest step
};

}  // namespace topple
