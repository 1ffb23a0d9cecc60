// Lines of members into a model: what cabinets and frames have in common.
#pragma once

#include <map>
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

/// Appends one body to a model: open, add lines and contact points, then close. Node positions that agree
/// within k_same_place are one node.
class BodyBuilder {
 public:
  static constexpr double k_same_place = 1e-7;  ///< m

  BodyBuilder(Model& model, const std::string& name);

  int node(const Vec3& position);
  /// `members` equal members of `elements` elements each between two points. Returns the nodes along the
  /// line.
  std::vector<int> line(const std::string& name, const Vec3& from, const Vec3& to, int members, int elements,
                        int section, int material, const Vec3& up);
  /// Line mass rho A with Simpson weights, and the section's rotary inertia, of every member from its
  /// density.
  void add_material_mass();
  void add_contact_point(int node, double width);
  /// Fills mass, centre of gravity, inertia, base and support polygon.
  void close();

  Body& body() { return model_.bodies[body_]; }

 private:
  Model& model_;
  int body_;
  std::map<std::tuple<long long, long long, long long>, int> places_;
};

}  // namespace topple
