// Cabinets, frames and grids: descriptions, and the bodies that are built from them.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "solver/model/body_builder.h"
#include "solver/model/model.h"
#include "solver/model/placement.h"

namespace topple {

/// A steel cabinet: twelve edges, shelves, and diagonals in place of its panels. Sizes are those between the
/// centre lines of the edge members, about which it rocks.
struct CabinetSpec : Placement {
  /// Inertia tensor of six thin sheets of equal thickness or of a solid box, of densities that vary linearly
  /// with height so that the centre of gravity is at cg_height; or inertia_given.
  enum class Inertia { panels, solid, given };
  /// panels: an a x b sheet of thickness t becomes two diagonals of length d, each of area
  ///   A = G t d^3 / (2 E a b),
  /// which together have its shear stiffness G t a / b. Second moments, torsion constant and shear stiffness
  /// are those of the post, of area A0, extreme fibre c0 and plastic modulus Z0. So that Z/sqrt(A I) and
  /// c/sqrt(I/A) are the post's too, c = c0 sqrt(A0/A) and Z = Z0 sqrt(A/A0). The diagonals yield at
  /// sqrt(3)/(2 (1 + nu)) (a/b + b/a) times the shear force at which the sheet would.
  enum class Bracing { panels, none };
  /// open: with Bracing::panels, no sheet and no diagonals on the side towards +x.
  enum class Front { closed, open };
  std::string name;
  Vec3 size{0.38, 0.88, 1.79};  ///< m, depth (x), width (y), height (z)
  double mass = 40;             ///< kg
  double cg_height = 0.895;     ///< m above the bottom centre lines
  /// m, of the centre of gravity off the middle along depth and width, by densities that vary linearly with
  /// both; none: as the symmetric densities give.
  std::optional<Eigen::Vector2d> cg_offset;
  Inertia inertia = Inertia::panels;
  Vec3 inertia_given = Vec3::Zero();  ///< kg m^2 about the centre of gravity
  int section = 0, material = 0;      ///< indices into the model's lists
  int shelves = 0;
  Bracing bracing = Bracing::panels;
  double panel_thickness = 0.6e-3;  ///< m, of the sheet that the diagonals replace
  Front front = Front::closed;
  int divisions = 1;  ///< members per edge; posts: from one shelf to the next
};

struct FrameMember {
  int node[2];
  int section, material;
  int elements = 2;        ///< even
  Vec3 up = Vec3::Zero();  ///< near the local z axis; zero: z, or x for a vertical member
};

/// A mass on a node, added to what it has from its members.
struct PointMass {
  int node;
  double mass;                  ///< kg
  Vec3 inertia = Vec3::Zero();  ///< kg m^2 about the node, [Ixx, Iyy, Izz] in world axes, reference pose
};

/// Anything made of straight members. Node numbers in members, supports, loads and masses count from 0 within
/// the frame.
struct FrameSpec {
  std::string name;
  std::vector<Vec3> nodes;  ///< m, world
  std::vector<FrameMember> members;
  std::vector<Support> supports;
  std::vector<Load> loads;
  std::vector<PointMass> masses;
  std::vector<std::array<int, 4>> panels;  ///< corners, BodyBuilder::add_panel
  double mass = 0;                         ///< kg, `masses` included; 0: from the densities
  std::vector<Vec3> copies;                ///< m, translations; empty: one at the origin
  double tilt = 0;  ///< rad, about the line along y through its lowest nodes, on the +x side of them;
                    ///< negative: -x side
  Vec3 velocity = Vec3::Zero();          ///< m/s, as in BodyStart
  Vec3 angular_velocity = Vec3::Zero();  ///< rad/s, likewise
};

/// A floor or wall of members: two crossing rows of straight lines, each a member of two elements that is
/// held everywhere.
struct GridSpec {
  std::string name;
  Vec3 origin = Vec3::Zero();                      ///< m, on the face that bodies touch
  Vec3 along = Vec3::UnitX(), up = Vec3::UnitY();  ///< unit, in the face
  Vec3 normal = Vec3::UnitZ();                     ///< unit, towards the bodies
  double from[2] = {-3, -3}, to[2] = {3, 3};       ///< m, extent in the two directions
  double spacing = 0.3;                            ///< m, of the lines, at whole multiples from the origin
  int section = 0, material = 0;
};

/// Adds the grid as a body of the ground, with centre lines half a contact width behind the face. Throws
/// BuildError.
BodyStart add_grid(Model& model, const GridSpec& spec);

/// Name of copy `index`, from 0, of what is called `name`: the first keeps it, the others add -2, -3, ...
std::string copy_name(const std::string& name, std::size_t index);

/// Inertia about its centre of gravity that a cabinet asks for, kg m^2, along its own axes.
Vec3 inertia_of(const CabinetSpec& spec);

/// Adds a cabinet whose lowest members touch the height of `at` with their surface. Throws BuildError.
BodyStart add_cabinet(Model& model, const CabinetSpec& spec);

/// Adds a frame, once per copy. The user's node k of copy c is `first_node + k` of body c. Throws BuildError.
std::vector<BodyStart> add_frame(Model& model, const FrameSpec& spec);

}  // namespace topple
