// Forces of all elements of a system, four at a time.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "solver/element/beam_kernel.h"
#include "solver/element/plasticity.h"
#include "solver/element/section_forces.h"
#include "solver/math/block_lu.h"
#include "solver/model/model.h"

namespace topple {

/// An element between two nodes of a system.
struct OwnElement {
  int element;  ///< index into Model::elements
  int i, j;
};

/// Force and moment on a node, N and N m, world axes; the fourth number pads.
struct NodeForce {
  double force[4], moment[4];
};

/// Motion of the nodes of a system.
struct NodeMotion {
  std::span<const Vec3> position, velocity;  ///< m, m/s
  std::span<const Quat> rotation;
  std::span<const Vec3> angular_velocity;  ///< rad/s, material axes
};

/// rad, turn of the ends of an element against each other at which it tears.
inline constexpr double k_torn = 5;

/// The elements of a system in their order, four to a pack; those that fill up the last have no stiffness.
class BeamPacks {
 public:
  BeamPacks(const Model& model, std::span<const OwnElement> own, const BlockLu& lu);

  /// Copies hinges and offsets. `elements`, here and below: one per own element.
  void remember(std::span<const ElementState> elements);
  /// Sets damping_time, s, of the own elements `first` to `last` - 1.
  void damp(std::size_t first, std::size_t last, double time);
  /// Subtracts BeamGradient and viscous forces of all elements from `forces`, one per node of the system; in
  /// the order of the elements, on which the bits depend.
  void subtract_gradient(std::span<const ElementState> elements, const NodeMotion& motion,
                         std::span<NodeForce> forces);
  /// The same, and adds the tangent to `lu`: beam_tangent, and `velocity_factor` (1/s) times the derivative
  /// of viscous forces by velocities.
  void subtract_gradient(std::span<const ElementState> elements, const NodeMotion& motion,
                         double velocity_factor, std::span<NodeForce> forces, BlockLu& lu);
  /// Whether some element was beyond k_torn in the latest subtract_gradient.
  bool tears() const { return tears_; }
  /// Work that viscous forces take from one motion to another, by the trapezoidal rule, J.
  double viscous_work(std::span<const ElementState> elements, const NodeMotion& start,
                      const NodeMotion& end) const;
  /// As energy(), from the latest subtract_gradient without tangent; only where no element can yield.
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
    bool yields;                              ///< some of them can
    bool flowed;                              ///< some of them flowed or are broken
    std::array<Four, 4> inverse_square;       ///< of Element::capacity
    std::array<Four, 2> arm;                  ///< m, from the stress points to the hinge places
    Four damping;                             ///< s, damping_time
    PackSection<Four> section;                ///< of the latest gradient
  };

  using Responses = std::array<SectionResponse, 4>;
  /// False where all are elastic; else takes the forces that sections bear for those of `section`.
  bool respond_to(std::span<const ElementState> elements, std::size_t pack, const PackStrain<Four>& strain,
                  PackSection<Four>& section, Responses& responses) const;
  PackSection<Four> viscous(std::span<const ElementState> elements, const NodeMotion& motion,
                            std::size_t pack, const PackStrain<Four>& strain) const;
  Four damping(std::span<const ElementState> elements, std::size_t pack) const;
  PackFlowing<Four> flowing_stiffness(std::size_t pack, const Responses& responses,
                                      const PackStiffness<Four>& elastic) const;
  static void store_sections(const Pack& pack, const PackSection<Four>& section,
                             std::vector<SectionForces>& sections);

  const Model* model_;
  std::vector<Pack> packs_;
  std::vector<PackStrain<Four>> strains_;  // scratch
  double latest_energy_ = 0;
  bool damped_ = false, tears_ = false;
};

}  // namespace topple
