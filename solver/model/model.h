// What is simulated: bodies made of members, members made of elements, elements between nodes.
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "solver/math/types.h"
#include "solver/model/section.h"
#include "solver/model/table.h"

namespace topple {

/// Angle by which a body turns after a side has let go for that to count as uplift, and its closing as an
/// impact, rad: 0.05 degrees, 0.3 mm below a base of 0.3 m. A body that bends sheds the load of a side for
/// some milliseconds at hundredths of a degree.
inline constexpr double k_uplift_angle = 0.05 * k_pi / 180;

/// Linear Timoshenko beam element with one integration point (Eq. 1). Reference configuration.
struct Element {
  int node[2];
  int member;
  double length;           ///< m
  double s;                ///< place of the integration point in the elastic state, -1..1; stresses at r = -s
  Mat3 triad;              ///< columns: local x, y, z in world axes
  Vec3 normal_stiffness;   ///< EA, kGAy, kGAz, N
  Vec3 bending_stiffness;  ///< GJ, EIy, EIz, N m^2
  /// N0, N, and Mx0, My0, Mz0, N m, of the fully plastic section; infinite: elastic.
  Eigen::Vector4d capacity = Eigen::Vector4d::Constant(std::numeric_limits<double>::infinity());
  /// Where its section may flow, -1..1 along it; the same twice: there alone.
  double hinge_place[2] = {-1, 1};
};

/// A straight member: an even number of elements of one section and one material. Each two of them place
/// their integration points together (SchemeTraits::s).
struct Member {
  std::string name;  ///< "post-1", "brace-front-a"; unique within its body
  int body;
  int first_element;
  int element_count;
  int section;   ///< index into Model::sections
  int material;  ///< index into Model::materials
  bool tip[2];   ///< whether its first and last node touch panels; of members that meet the first does
};

/// A flat sheet between four nodes of a body. It is drawn and may bear anchors; in a model with `surfaces`
/// tips of members touch it from both sides.
struct Panel {
  using Place = Eigen::Vector2d;  ///< m, in its plane, reference pose
  int body;
  std::array<int, 4> node;  ///< in order around it
  double width;             ///< m, contact width, half of it on either side of the middle plane
  std::array<Place, 4> corner;
  /// Members that lie in it, its sides among them: ends. There they are touched, not the sheet.
  std::vector<std::array<Place, 2>> members;
};

/// Fixed directions of a node, world axes; bit k: translation along axis k, bit 3 + k: rotation about it.
struct Support {
  int node;
  unsigned fixed;
};

/// Dead load on a node, world axes, times a factor that is piecewise linear in time (load_factor).
struct Load {
  int node;
  Vec3 force;                                      ///< N
  Vec3 moment;                                     ///< N m
  std::vector<std::pair<double, double>> history;  ///< (s, factor), increasing times; empty: 1
};

/// A node that can touch floors and walls.
struct ContactPoint {
  int node;
  double width;  ///< m, contact width of its member
};

struct ElasticBasis;

/// Connected members that move together.
struct Body {
  std::string name;
  int first_node, node_count;
  int first_element, element_count;
  int first_member, member_count;
  int first_contact_point, contact_point_count;
  int first_panel, panel_count;
  double mass;              ///< kg
  Vec3 centre_of_gravity;   ///< m, world, reference pose
  double reach = 0;         ///< m, greatest distance of a node from the centre of gravity
  Eigen::AlignedBox3d box;  ///< m, of its nodes, from the centre of gravity, world axes, reference pose
  double width = 0;         ///< m, greatest contact width of its members
  Mat3 inertia;             ///< kg m^2 about the centre of gravity, world axes, reference pose
  std::vector<Vec3> support_polygon;  ///< convex hull of the base's contact points, counter-clockwise seen
                                      ///< from above, world, reference pose; empty when it has no base
  std::vector<int> base_points;       ///< contact points (global index) on the base
  Vec3 base_centre;  ///< mid-point of the base (no base: centre of gravity), world, reference pose
  std::shared_ptr<const ElasticBasis> elastic;  ///< null: the body is never on the level elastic
  /// rad/s, angular, of its first elastic mode (damping.h); 0: not known, it has no damping.
  double first_frequency = 0;
  /// Of its base while it is a planar block: factor on the rate that an impact leaves by Housner's condition.
  double restitution = 1;
  double grip = 1;      ///< of its contact points on planes: factor on the law's frictions
  bool ground = false;  ///< a floor or wall made of members, not furniture; such bodies come last
  bool solid = false;   ///< a block: its members are its edges, it is never elastic nor a frame
};

/// A plane floor or wall. Its centre line lies width/2 behind its face, so that l = L is surface touch.
struct Plane {
  std::string name;
  Vec3 point;    ///< m, on the face
  Vec3 normal;   ///< unit, towards the bodies
  double width;  ///< m, contact width; 0: that of the touching member
};

/// Contact width of a plane where `point` touches it, m.
inline double contact_width(const ContactPoint& point, const Plane& plane) {
  return plane.width > 0 ? plane.width : point.width;
}
/// L of Eq. 2 for a point and a plane: the mean of their contact widths, m.
inline double contact_length(const ContactPoint& point, const Plane& plane) {
  return (point.width + contact_width(point, plane)) / 2;
}

enum class Scheme { asi_gauss, asi, midpoint };

/// |s| of the integration points for which the stress points r = -s (Eq. 1) of two equal elements are the
/// Gauss points of the member: 2/sqrt(3) - 1.
inline constexpr double k_gauss_shift = 0.15470053837925152;

/// Where integration points of a member's elements stand.
struct SchemeTraits {
  Scheme kind;
  const char* word;     ///< in scenes
  double s[2];          ///< elastic, of the first and second of each two elements, -1..1
  bool hinges_at_ends;  ///< of the elements (plasticity.h); false: in the middle
  const char* about;    ///< a line for legends
};
/// A new one is a Scheme and a row here.
inline constexpr SchemeTraits k_schemes[] = {
    {Scheme::asi_gauss,
     "asi-gauss",
     {k_gauss_shift, -k_gauss_shift},
     true,
     "ASI-Gauss: stresses at the Gauss points of two elements, hinges at ends"},
    {Scheme::asi, "asi", {0, 0}, true, "ASI: stresses at midpoints, hinges at ends"},
    {Scheme::midpoint, "midpoint", {0, 0}, false, "midpoint: stresses and hinges at midpoints"},
};
constexpr const SchemeTraits& traits(Scheme scheme) {
  return row_of(k_schemes, scheme);
}

/// A point of a body, rigidly joined to a node of it.
struct AnchorEnd {
  int body = -1;            ///< -1: none, the floor's frame
  int node = -1;            ///< of the body, the nearest to the point
  Vec3 arm = Vec3::Zero();  ///< m, from the node to the point, reference axes
};

/// A spring along the line from a point fixed to the floor's frame, or to another body, to a point of a body
/// (anchor.h).
struct Anchor {
  enum class Type { strap, bracket, pole };
  std::string name;
  int body;
  int node;          ///< of the body, the nearest to the attached point, which is rigidly joined to it
  Vec3 arm;          ///< m, from the node to the attached point, reference axes
  Vec3 to;           ///< m, floor's frame; of an anchor to another body where the point starts
  AnchorEnd other;   ///< the other body's point
  Type type;         ///< strap: pulls only; bracket: both ways; pole: pushes only
  double stiffness;  ///< N/m
  double strength = std::numeric_limits<double>::infinity();  ///< N, |tension| above which it breaks
  /// m, natural: that at the start, less what preload stretches it by; 0: a pin, which holds in all
  /// directions
  double length;
  /// Of a [[fixing]], that it stands for: its kind, what it leads to, its number, from 1; else empty and 0.
  std::string fixing = {}, leads_to = {};
  int fixing_number = 0;
  AnchorEnd own() const { return {body, node, arm}; }
};

/// Everything that stays as built. Reference pose: the stress-free bodies in their starting place,
/// before `tilt`; world axes, z up. Nodes of one body are consecutive, and so are its elements and panels.
struct Model {
  Scheme scheme = Scheme::asi_gauss;  ///< set before members are added
  std::vector<Material> materials;
  std::vector<Section> sections;
  std::vector<Vec3> node_position;  ///< m, reference
  std::vector<double> node_mass;    ///< kg
  std::vector<Mat3> node_inertia;   ///< kg m^2, about the node, world axes in the reference pose
  std::vector<int> node_body;
  std::vector<Element> elements;
  std::vector<Member> members;
  std::vector<Body> bodies;
  std::vector<Support> supports;
  std::vector<Load> loads;
  std::vector<ContactPoint> contact_points;
  std::vector<Plane> planes;
  std::vector<Panel> panels;
  std::vector<Anchor> anchors;
  bool surfaces = true;  ///< panels touch; false: members alone, as in the paper

  int node_total() const { return static_cast<int>(node_position.size()); }
  /// Bodies that are not ground: the first ones.
  int furniture_total() const {
    int count = static_cast<int>(bodies.size());
    while (count > 0 && bodies[count - 1].ground) --count;
    return count;
  }
};

/// How a body starts: a rigid rotation of its reference pose about a line, then velocities.
struct BodyStart {
  Vec3 pivot = Vec3::Zero();             ///< m, a point of the rotation axis
  Vec3 rotation = Vec3::Zero();          ///< rotation vector, rad, world
  Vec3 velocity = Vec3::Zero();          ///< m/s, of the centre of gravity
  Vec3 angular_velocity = Vec3::Zero();  ///< rad/s, world
};

}  // namespace topple
