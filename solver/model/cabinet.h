// Builders: bodies from members.
#pragma once

#include <string>
#include <vector>

#include "solver/model/body_builder.h"
#include "solver/model/model.h"

namespace topple {

/// A steel cabinet: twelve edges, shelves, and diagonals in place of its panels. Lengths between the centre
/// lines of the edge members, which is where it rocks.
struct CabinetSpec {
  enum class Inertia { panels, solid, given };
  enum class Pose { upright, on_back, on_front, on_side };
  /// panels: two diagonals of area A = G t d^3 / (2 E a b) each have the shear stiffness G t a / b of the a x
  /// b sheet of thickness t, d their length. Second moments, torsion constant and shear stiffness are those
  /// of the post, of area A0 and plastic moduli Z0. A section with A and these second moments, as the post
  /// but for its proportions of width to wall, has its fibres at c0 sqrt(A0/A) and the moduli Z = Z0
  /// sqrt(A/A0), so that Z/sqrt(A I) and c/sqrt(I/A) are the post's:
  ///   N0 = yield A,  My0 = yield Zy,  Mz0 = yield Zz,  Mx0 = yield Zt / sqrt(3)
  /// The diagonals yield at sqrt(3)/(2 (1 + nu)) (a/b + b/a) times the shear force of the yielding sheet.
  enum class Bracing { panels, none };
  std::string name;
  Vec3 size{0.38, 0.88, 1.79};  ///< m, depth (x), width (y), height (z)
  double mass = 40;             ///< kg
  double cg_height = 0.895;     ///< m above the bottom centre lines
  Inertia inertia = Inertia::panels;
  Vec3 inertia_given = Vec3::Zero();  ///< kg m^2 about the centre of gravity
  Vec3 at = Vec3::Zero();             ///< m, centre of the footprint in its pose, and its height
  double yaw = 0;                     ///< rad
  Pose pose = Pose::upright;
  double tilt = 0;  ///< rad, about the bottom edge on the +x side before yaw; negative: -x side
  Vec3 velocity = Vec3::Zero();
  Vec3 angular_velocity = Vec3::Zero();
  int section = 0, material = 0;  ///< indices into the model's lists
  int shelves = 0;
  Bracing bracing = Bracing::panels;
  double panel_thickness = 0.6e-3;  ///< m, of the sheet that the diagonals replace
  int divisions = 1;                ///< members per edge
};

struct FrameMember {
  int node[2];
  int section, material;
  int elements = 2;        ///< even
  Vec3 up = Vec3::Zero();  ///< zero: z, or x for a vertical member
};

/// Added to what a node has from its members.
struct PointMass {
  int node;
  double mass;                  ///< kg
  Vec3 inertia = Vec3::Zero();  ///< kg m^2 about the node, [Ixx, Iyy, Izz] in world axes, reference pose
};

/// Anything made of straight members. Node numbers in supports, loads and masses count from 0 within the
/// frame.
struct FrameSpec {
  std::string name;
  std::vector<Vec3> nodes;  ///< m, world
  std::vector<FrameMember> members;
  std::vector<Support> supports;
  std::vector<Load> loads;
  std::vector<PointMass> masses;
  double mass = 0;           ///< kg, 0: from the densities
  std::vector<Vec3> copies;  ///< translations; empty: one at the origin
  double tilt = 0;  ///< rad, about the line along y through its lowest nodes, on the +x side of them;
                    ///< negative: -x side
  Vec3 velocity = Vec3::Zero();
  Vec3 angular_velocity = Vec3::Zero();
};

/// A floor or wall of members: two crossing rows of straight lines, each a member of two elements that is
/// held everywhere.
struct GridSpec {
  std::string name;
  Vec3 origin = Vec3::Zero();                      ///< m, on the face that bodies touch
  Vec3 along = Vec3::UnitX(), up = Vec3::UnitY();  ///< unit, in the face
  Vec3 normal = Vec3::UnitZ();                     ///< unit, towards the bodies
  double from[2] = {-3, -3}, to[2] = {3, 3};       ///< m, extent in the two directions
  double spacing = 0.3;                            ///< m, of the lines; they lie at its whole multiples
  int section = 0, material = 0;
};

/// Adds the grid as a body of the ground, with centre lines half a contact width behind the face. Throws
/// BuildError.
BodyStart add_grid(Model& model, const GridSpec& spec);

/// Name of copy `index`, from 0, of what is called `name`: the first keeps it, the others add -2, -3, ...
std::string copy_name(const std::string& name, std::size_t index);

/// Adds a cabinet whose members' surface touches the height of `at`. Throws BuildError.
BodyStart add_cabinet(Model& model, const CabinetSpec& spec);

/// Adds a frame, once per copy. The user's node k of copy c is `first_node + k` of body c. Throws BuildError.
std::vector<BodyStart> add_frame(Model& model, const FrameSpec& spec);

}  // namespace topple
