// A room as it is before it is shaken, and its pieces as shapes that can be put elsewhere.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "app/furnish/snap.h"
#include "app/picture/room_piece.h"
#include "render/scene/camera.h"
#include "render/scene/scene_frame.h"

namespace topple::app {

/// The scene as it starts, without words and colours of stresses. Throws io::InputError.
render::SceneFrame start_frame(const io::Scene& scene);

/// What is drawn of one body, as it would be at the Spot {}.
struct PieceShape {
  std::vector<render::Profile> profiles;
  std::vector<render::Station> stations;
  std::vector<render::Tube> tubes;
  std::vector<render::Panel> panels;
};

/// The shape of a body of the model that stands at `spot`.
PieceShape shape_of(const render::SceneFrame& frame, const Model& model, const RoomPiece& piece);
/// Leaves the body out.
void hide_body(const Model& model, std::size_t body, render::SceneFrame& frame);
/// Puts the shape there as `body`; `colour`: of all of it, absent: as it is.
void add_shape(const PieceShape& shape, const Spot& spot, double floor, std::size_t body,
               const std::optional<render::Float4>& colour, render::SceneFrame& frame);

/// Lines on the floor around a piece, with a mark where its front looks.
void add_footprint(const Footprint& of, double floor, const render::Float4& colour,
                   render::SceneFrame& frame);

/// A line of sight, m.
struct Sightline {
  Eigen::Vector3d from, direction;
};
/// Through pixel x, y of a picture of width x height px.
Sightline sightline(const render::Camera& camera, float width, float height, float x, float y);
/// Where it meets the level `height` in front of the eye, m; nothing: it does not, or beyond 100 m.
std::optional<Vec2> on_level(const Sightline& sight, double height);
/// The ground that is seen there; nothing: none.
std::optional<std::size_t> ground_at(const Sightline& sight, const std::vector<render::Ground>& grounds);
/// The pixel at which a place is seen; nothing: it lies behind the eye.
std::optional<Eigen::Vector2f> pixel_of(const render::Camera& camera, float width, float height,
                                        const Eigen::Vector3f& place);

}  // namespace topple::app
