// A body of a scene by itself.
#pragma once

#include <optional>
#include <string>

#include "solver/run/run.h"

namespace topple::study {

/// The horizontal plane that bodies stand on. None: the scene has no such floor.
std::optional<Plane> floor_of(const Model& model);

/// Why a body does not stand freely on the floor in its reference pose: "is held by supports". Empty: it
/// does.
std::string why_not_standing(const Model& model, int body);

/// Whether an anchor holds a body: its own, or of another one beside it. What stands on a body and is fixed
/// to it does not hold it.
bool holds(const Model& model, const Anchor& anchor, int body);

/// One body in its reference pose, to be settled, without the other bodies, without loads, shakes and probes.
/// `walls`: with all planes, else with the floor alone, which must exist.
Setup alone(const Setup& scene, int body, bool walls);

/// Why not all bodies of a scene can be frames: "box is a block, which is never a frame". Empty: they can.
std::string why_not_frames(const Model& model);

/// Whether two bodies differ by nothing but their name and a shift: what holds of one alone on a floor holds
/// of the other.
bool alike(const Model& model, int a, int b);

}  // namespace topple::study
