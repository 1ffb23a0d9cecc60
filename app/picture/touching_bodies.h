// Who leans on whom: what floors, walls and other bodies do to a body at a recorded instant.
#pragma once

#include <string>
#include <vector>

#include "solver/io/recording/frame_row.h"
#include "solver/model/model.h"

namespace topple::app {

/// What a plane or another body does to a body.
struct BodyTouch {
  std::string by;             ///< name of the plane or body
  Vec3 force = Vec3::Zero();  ///< N, on the body, floor's frame
  Vec3 place = Vec3::Zero();  ///< m, the mean of where it acts, by |force|, floor's frame
};

/// Planes first, then bodies, in the model's order; those without a force are left out. A row holds the
/// resultant of what touches each element and panel, not by whom: each is taken to touch the part of another
/// body that is nearest to where it acts, and forces between parts are the least that agree with all
/// resultants by action and reaction. What these leave open, as where three bodies touch each other, is
/// shared out so.
std::vector<BodyTouch> touches(const Model& model, const io::FrameRow& row, std::size_t body);

/// Of `count` rows of `stride` numbers from `first` on, as far as a frame has them: one is not zero.
bool any_force(const std::vector<float>& of, int first, int count, int stride);

/// Another body touches it, or it another.
bool touches_another(const Body& body, const io::FrameRow& row);

}  // namespace topple::app
