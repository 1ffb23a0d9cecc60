// Forces of all elements of a system, four at a time.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "solver/beam_kernel.h"
#include "solver/block_lu.h"
#include "solver/model.h"
#include "solver/section_forces.h"

namespace topple {

/// An element between two nodes of a system.
struct OwnElement {
  int element;  ///< index into Model::elements
  int i, j;
};

/// Force and moment on a node, N and N m, padded to vectors of four.
struct NodeForce {
  double force[4], moment[4];
};

/// The elements of a system in their order; what fills the last pack has no stiffness.
class BeamPacks {
 public:
  BeamPacks(const Model& model, std::span<const OwnElement> own, const BlockLu& lu);

  /// Copies hinges and offsets, one per element.
  void remember(std::span<const ElementState> elements);
  /// Subtracts the gradient of the energy (BeamGradient) from `forces`, one per node of the system, in the
  /// order of the elements.
  void subtract_gradient(std::span<const ElementState> elements, std::span<const Vec3> position,
                         std::span<const Quat> rotation, std::span<NodeForce> forces);
  /// The same, and adds the tangent (beam_tangent) to `lu`.
  void subtract_gradient(std::span<const ElementState> elements, std::span<const Vec3> position,
                         std::span<const Quat> rotation, std::span<NodeForce> forces, BlockLu& lu);
  /// As energy() where subtract_gradient was called last; for elements without hinges.
  double latest_energy(std::vector<SectionForces>& sections) const;
  /// Elastic energy, J; also fills the elements' part of `sections`, one per element of the model.
  double energy(std::span<const Vec3> position, std::span<const Quat> rotation,
                std::vector<SectionForces>& sections) const;

 private:
  struct Pack {
    PackBeam<Four> beam;
    std::array<int, 4> i, j;                  ///< nodes, numbered within the system
    std::array<std::array<int, 4>, 4> block;  ///< numbers of (i, i), (i, j), (j, i), (j, j)
    std::array<int, 4> element;               ///< index into Model::elements; -1: none
    bool hinged;                              ///< some of them
    PackSection<Four> section;                ///< of the latest gradient
  };

  void respond_to(std::span<const ElementState> elements, std::size_t pack, const PackStrain<Four>& strain,
                  PackSection<Four>& section) const;
  void add_hinged_tangent(std::span<const ElementState> elements, std::span<const Vec3> position,
                          std::span<const Quat> rotation, std::size_t pack, BlockLu& lu) const;
  static void store_sections(const Pack& pack, const PackSection<Four>& section,
                             std::vector<SectionForces>& sections);

  const Model* model_;
  std::vector<Pack> packs_;
  std::vector<PackStrain<Four>> strains_;  // scratch
  double latest_energy_ = 0;
};

}  // namespace topple
