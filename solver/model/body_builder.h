// Builds a body from lines of members, for cabinets, frames and grids.
#pragma once

#include <array>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "solver/model/model.h"

namespace topple {

/// A description that no body can be built from; what() is one sentence without file and line, `key` the
/// scene key at fault ("cg_height").
struct BuildError : std::runtime_error {
  BuildError(std::string key_at_fault, const std::string& what)
      : std::runtime_error(what), key(std::move(key_at_fault)) {}
  std::string key;
};

/// "12.5 mm", for errors.
std::string millimetres(double metres);

/// Appends one body to a model: construct, add lines, masses and contact points, then close. Node positions
/// that agree within k_same_place are one node.
class BodyBuilder {
 public:
  static constexpr double k_same_place = 1e-7;  ///< m
  static constexpr double k_flat = 1e-3;  ///< of a sheet's diagonals, by how much they may pass each other

  BodyBuilder(Model& model, const std::string& name);

  /// The node at `position` (m, world, reference pose), new if there is none: index into the model, as below.
  int node(const Vec3& position);
  /// `members` equal members of `elements` elements each between two points, m. `up`: direction near the
  /// local z axis; zero: z, or x for a vertical line. Returns the nodes along the line. Throws BuildError:
  /// `up` is parallel to the line, or a yielding section has no plastic moduli.
  std::vector<int> line(const std::string& name, const Vec3& from, const Vec3& to, int members, int elements,
                        int section, int material, const Vec3& up);
  /// Adds to the nodes of every member its mass rho A and rotary inertia rho (Iy + Iz, Iy, Iz) per length,
  /// with Simpson weights 1/6 : 2/3 : 1/6 over each two elements.
  void add_material_mass();
  void add_contact_point(int node, double width);  ///< width: m
  /// A sheet between four nodes in order around it, at which members end. Throws BuildError: it is not flat
  /// (k_flat), or no members lie along a side. Members are added before it.
  void add_panel(const std::array<int, 4>& nodes);
  /// Fills mass, centre of gravity, inertia, reach, box, width, base (the lowest contact points) and support
  /// polygon.
  void close();

  Body& body() { return model_.bodies[body_]; }

 private:
  Model& model_;
  int body_;
  std::map<std::tuple<long long, long long, long long>, int> places_;  // node by position/k_same_place
  std::set<int> tips_;                                                 // nodes at which members end
};

}  // namespace topple
