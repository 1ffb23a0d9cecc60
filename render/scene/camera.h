// Where a picture is seen from.
//
// A cabinet at yaw 0 is deep along x, wide along y, and stands up along z; its front faces +x. A
// wall behind it stands at smaller x and faces +x.
#pragma once

#include <optional>
#include <string_view>

#include <Eigen/Core>

#include "render/scene/scene_frame.h"

namespace topple::render {

/// front  looks along -x at the cabinet's front: y to the right, z up
/// side   looks along +y, in the plane in which it rocks: x to the right, z up
/// top    looks along -z: x to the right, y up
/// iso    from the side and a little from the front and above (azimuth -62 degrees, elevation 16):
///        x mostly to the right, walls behind the cabinets are seen from their face
/// front and side look down by 4 degrees, so that the floor is a surface and not a line.
enum class NamedView { front, side, top, iso };

/// The view of that name, or nothing.
std::optional<NamedView> view_named(std::string_view name);

/// A perspective camera. Eye coordinates: x right, y up, z towards the viewer.
struct Camera {
  Eigen::Matrix4f view;        ///< picture's frame to eye coordinates
  Eigen::Matrix4f projection;  ///< eye coordinates to clip coordinates (OpenGL, z in -1..1)
  Eigen::Vector3f eye;         ///< m
};

/// Vertical field of view, radians; narrow, so that upright edges stay nearly parallel.
inline constexpr float k_vertical_fov = 0.42f;

/// Camera at `eye` whose right, up and towards-the-viewer directions are the rows of `axes`.
/// near, far: planes, m, 0 < near < far.
Camera camera_at(const Eigen::Vector3f& eye, const Eigen::Matrix3f& axes, float aspect, float near,
                 float far);

/// Camera at `eye` that looks at `target`. `up` must not be parallel to the line of sight.
/// near, far: planes, m, 0 < near < far.
Camera look_at(const Eigen::Vector3f& eye, const Eigen::Vector3f& target, const Eigen::Vector3f& up,
               float aspect, float near, float far);

/// View direction, as that of the line from the target to the eye, radians. At an elevation of a
/// right angle the azimuth still says which way is up in the picture.
struct Sight {
  float azimuth;    ///< about z, 0 on the +x side, positive towards +y
  float elevation;  ///< above the floor's plane
};
Sight sight_of(NamedView view);

/// Rows: right, up, and towards the viewer.
Eigen::Matrix3f sight_axes(const Sight& sight);

/// Part of a picture that the bodies may take, in normalized device coordinates (-1..1).
struct Room {
  float left, right, bottom, top;
};

/// The nearest camera with these axes that shows the whole box low..high inside the room, and centred
/// in it.
Camera fit_box(const Eigen::Matrix3f& axes, const Eigen::Vector3f& low, const Eigen::Vector3f& high,
               const Room& room, float aspect);

/// The same camera, translated `by`, m.
Camera carried(const Camera& camera, const Eigen::Vector3f& by);

/// Whether all its numbers are finite.
bool finite(const Camera& camera);

/// The named camera, as near as it can be with the frame's whole bounds between the title, the
/// legend, and the trace and note of its overlay. aspect: width / height, > 0. Bounds that are not
/// finite are taken as the default ones.
Camera fit_camera(NamedView view, const SceneFrame& frame, float aspect);

}  // namespace topple::render
