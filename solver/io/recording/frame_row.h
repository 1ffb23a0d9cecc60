// One recorded instant.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "solver/model/model.h"
#include "solver/state/state.h"

namespace topple::io {

inline constexpr std::uint8_t k_flowed_first = 5, k_flowed_second = 6,
                              k_flowed_both = 8;  ///< of FrameRow::hinge
/// The hinges that such a code tells of; whether they flow now: else they did before.
inline Hinge hinge_of(std::uint8_t code) {
  return code == k_flowed_first    ? Hinge::first
         : code == k_flowed_second ? Hinge::second
         : code == k_flowed_both   ? Hinge::both
                                   : static_cast<Hinge>(code);
}
inline bool flows_now(std::uint8_t code) {
  return static_cast<std::uint8_t>(hinge_of(code)) == code;
}

/// Values of AnchorNumbers::state. slack: in place, without force.
inline constexpr float k_anchor_away = 0, k_anchor_slack = 1, k_anchor_holds = 2, k_anchor_broken = 3;
/// "away", "slack", "holds", "broken".
const char* anchor_word(float state);
/// Whether it may stand in place without a force and hold nothing: a bracket pulls and pushes.
inline bool can_slacken(const Anchor& anchor) {
  return anchor.type != Anchor::Type::bracket;
}

/// A body at one instant.
struct BodyNumbers {
  double x, y, z;         ///< m, centre of gravity, floor's frame
  double qw, qx, qy, qz;  ///< rotation from the reference pose
  double tilt, slide;     ///< rad, m
  double energy;          ///< J, kinetic, strain and gravity, the last relative to the reference pose
  double critical_angle;  ///< rad, 0: none

  bool operator==(const BodyNumbers&) const = default;
  Vec3 centre() const { return {x, y, z}; }
  Quat rotation() const { return Quat(qw, qx, qy, qz); }
};
/// Its numbers in their order.
using BodyArray = std::array<double, 11>;
static_assert(sizeof(BodyNumbers) == sizeof(BodyArray));

/// An anchor at one instant.
struct AnchorNumbers {
  float tension;         ///< N, negative: it pushes
  float energy;          ///< J
  float natural_length;  ///< m
  float state;           ///< k_anchor_away, ...
  bool operator==(const AnchorNumbers&) const = default;
};
/// Its state as the anchor is one: what cannot slacken holds without force, too.
float anchor_state(const Anchor& anchor, const AnchorNumbers& now);
using AnchorArray = std::array<float, 4>;
static_assert(sizeof(AnchorNumbers) == sizeof(AnchorArray));

/// Columns of FrameRow::energy: J, but for the balance error, which is relative; the last two with anchors.
enum EnergyColumn : std::size_t {
  k_input,
  k_kinetic,
  k_strain,
  k_gravity,
  k_contact,
  k_friction,
  k_normal_damping,
  k_numerical,
  k_plastic,
  k_damping,
  k_model_switch,
  k_balance_error,
  k_anchor,
  k_released
};
struct EnergyTraits {
  EnergyColumn kind;
  const char* name;  ///< in recordings and exports
  const char* unit;
  double (*value)(const EnergyLedger&);
};
/// In the order of the columns; the last two where there are anchors.
std::span<const EnergyTraits> energy_columns(bool anchors);

/// One recorded instant. Array shapes: n nodes, e elements, c contact points x planes (index: point times
/// planes plus plane), b bodies, a anchors, t elements and p panels that other bodies can touch: all, or 0 of
/// a single body, and of panels without Model::surfaces.
struct FrameRow {
  std::int32_t branch = 0;
  std::int64_t step = 0;
  double time = 0;                    ///< s
  std::vector<float> position;        ///< n x 3, m, floor's frame
  std::vector<float> rotation;        ///< n x 4, w x y z
  std::vector<float> section_force;   ///< e x 6: N, Vy, Vz, T, My, Mz at the stress point, N and N m
  std::vector<float> s;               ///< e, integration point, -r of Eq. 1
  std::vector<std::uint8_t> hinge;    ///< e: 0 none, 1 at the first end, 2 at the second, 3 broken,
                                      ///< 4 in the middle, 7 at both ends; 5, 6, 8: none now, flowed at
                                      ///< the first, the second, both
  std::vector<float> contact_depth;   ///< c, 1 - l/L; 0: open
  std::vector<float> contact_force;   ///< c x 3, N, on the point, floor's frame
  std::vector<float> member_contact;  ///< t x 4: resultant of what members of other bodies do to the element,
                                      ///< N, and where it acts, 0..1 from the first node to the second
  std::vector<float> panel_contact;  ///< p x 5: the same of what touches a panel, N, and where, PanelPlace::r
  std::vector<double> energy;        ///< EnergyColumn
  std::vector<BodyNumbers> body;     ///< b
  std::vector<std::uint8_t> level;   ///< b: ModelLevel
  double floor_acceleration[3] = {};  ///< m/s^2
  double floor_displacement[3] = {};  ///< m, high-passed
  double load_factor = 0;             ///< of static runs
  std::vector<AnchorNumbers> anchor;  ///< a
  bool knows_contacts = true;         ///< else forces of contacts are not known, and zero here
};

/// The body was not rigid then.
bool has_stresses(const FrameRow& row, int body);

/// No NaN, no infinity in it.
bool is_finite(const FrameRow& row);

/// Sizes that all rows of one recording share.
struct RowShape {
  std::size_t nodes = 0, elements = 0, contacts = 0, touched = 0, panels = 0, bodies = 0, anchors = 0;
};
/// Of a model's rows.
RowShape row_shape(const Model& model);

/// A row of zeros with arrays of the right sizes.
FrameRow blank_row(const RowShape& shape);

}  // namespace topple::io
