// What a picture shows beside the bodies: hinges, forces at contacts, paths, and a diagram of forces.
#pragma once

#include "app/picture/picture_settings.h"
#include "app/picture/run_extent.h"
#include "render/scene/scene_frame.h"

namespace topple::app {

/// One of N, Vy, Vz, T, My, Mz.
inline constexpr std::size_t k_components = 6;
const char* component_name(std::size_t component);
const char* component_unit(std::size_t component);
double component_of(const SectionForces& forces, std::size_t component);

/// A hinge that flows is a ring in the plane in which it bends, with an arrow head: its element turns that
/// way about the node; about its first half, where the hinge is in the middle. One that has come to rest is
/// pale and has no head. `row`: as it is drawn.
void add_hinges(const Model& model, const io::FrameRow& row, render::SceneFrame& out);

/// Doors as sheets in their walls and places as rings on the floor, a person wide, with their names.
void add_doors(const Room& room, const Vec3& shift, render::SceneFrame& out);

/// Arrows of what floors, walls and members of other bodies do to bodies, from the points of contact on, at
/// `newtons` for each 0.1 m. Between two bodies there is one on each.
void add_contact_forces(const Model& model, const io::FrameRow& row, double newtons, render::SceneFrame& out);

/// m: a hand that pulls a body is a spring that bears the body's weight when it is as long as that, and no
/// more.
inline constexpr double k_hand_reach = 0.3;
/// N, that of the body of a node.
double hand_strength(const Model& model, int node);
/// Arrows from nodes that are pulled to where the hand's spring ends, and how strong it is.
void add_pulls(const Model& model, const Parameters& parameters, const io::FrameRow& row,
               render::SceneFrame& out);

/// N for each 0.1 m of an arrow, a round number, so that most forces of the run are at most a third as long
/// as what the run moves through is high. `force`: of a picture that stands alone, N; no longer than that
/// height.
double newtons_per_decimetre(const RunExtent& extent, double force = 0);

/// Where centres of gravity and tops of bodies have been, fading with age.
void add_trails(const Model& model, const RunExtent& extent, const io::FrameRow& row, bool whole_run,
                render::SceneFrame& out);

/// That of a diagram at this row.
std::size_t component_of(const Model& model, const io::FrameRow& row, const Diagram& diagram);

/// A band along a member, red where positive and blue where negative, with its least and greatest value; as
/// high at every instant. In the plane in which the force acts, moments on the side that they stretch. None
/// of a body that is computed without stresses.
void add_diagram(const Model& model, const io::FrameRow& row, const Diagram& diagram,
                 render::SceneFrame& out);

}  // namespace topple::app
