// Anchors as pictures show them.
#pragma once

#include "render/scene/scene_frame.h"
#include "solver/io/recording/observer.h"
#include "solver/model/model.h"

namespace topple::app {

/// m, in the picture's frame, which the floor's is `shift` away from.
Vec3 attached_point(const Model& model, const io::FrameRow& row, const Vec3& shift, std::size_t anchor);
/// Its other end, on the floor's frame or on another body.
Vec3 far_point(const Model& model, const io::FrameRow& row, const Vec3& shift, std::size_t anchor);

/// Straps as bands, poles and brackets as rods, in a colour of their own, with a plate on the wall and a
/// thimble on the body. One that holds is straight; a slack strap sags, a slack pole ends short of the body
/// and is grey; one that broke is two grey stumps; one that is away is not drawn. Tube::member is the number
/// of members plus that of the anchor.
void add_anchors(const Model& model, const io::FrameRow& row, const Vec3& shift, render::SceneFrame& out);

}  // namespace topple::app
