// What exports compute from the rows of a recording.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "solver/io/recording/recording.h"
#include "solver/run/run.h"

namespace topple::io {

struct ElementLoading {
  double stress;      ///< Pa, equivalent_stress() at the stress point
  double peak;        ///< Pa, greatest at the element's ends
  float yield_ratio;  ///< sqrt(f + 1) (plasticity.h), greatest of the element's ends; 0 where it cannot yield
};
ElementLoading element_loading(const Model& model, const FrameRow& row, std::size_t element);

/// Of every node, three numbers each: what it moved, m, and its rotation vector, rad.
struct NodeMotion {
  std::vector<double> displacement, rotation;
  NodeMotion(const Model& model, const FrameRow& row);
};

/// A force on a body: of a plane on a contact point, or of all other bodies on one of its elements or panels.
struct ContactForce {
  int body;
  std::string part;     ///< "node 3", from 0 in each body; the name of a member; "panel 2", likewise
  std::string against;  ///< the plane; empty: other bodies
  Vec3 place, force;    ///< m and N, floor's frame
};
std::vector<ContactForce> contact_forces(const Model& model, const FrameRow& row);

/// Of every node what touches it, an element or a panel at it, three numbers each, N, floor's frame.
std::vector<double> contact_on_nodes(const Model& model, const FrameRow& row);

/// By element: the two nodes of each, its member and its body.
struct ElementPlaces {
  std::vector<std::int32_t> nodes, member, body;
  explicit ElementPlaces(const Model& model);
};

enum class FieldPlace { nodes, elements };

/// Calls field(name, place, values, columns) for each field of a frame as ParaView gets it; `columns` numbers
/// belong to each node or element. On nodes, from the reference pose: displacement_m, rotation_rad (rotation
/// vector), contact_N (contact_on_nodes). On elements: N_N, Vy_N, Vz_N, T_Nm, My_Nm, Mz_Nm and stress_Pa at
/// the stress point, yield_ratio, s, hinge (FrameRow::hinge), peak_stress_Pa of the ends.
template <class Field>
void each_field(const Model& model, const FrameRow& row, Field field) {
  const NodeMotion motion(model, row);
  field("displacement_m", FieldPlace::nodes, motion.displacement, 3);
  field("rotation_rad", FieldPlace::nodes, motion.rotation, 3);
  field("contact_N", FieldPlace::nodes, contact_on_nodes(model, row), 3);
  constexpr std::array k_forces = {"N_N", "Vy_N", "Vz_N", "T_Nm", "My_Nm", "Mz_Nm"};
  const std::size_t elements = model.elements.size();
  for (std::size_t k = 0; k < k_forces.size(); ++k) {
    std::vector<float> values(elements);
    for (std::size_t e = 0; e < elements; ++e) values[e] = row.section_force[6 * e + k];
    field(k_forces[k], FieldPlace::elements, values, 1);
  }
  std::vector<double> stress, peak;
  std::vector<float> yield_ratio;
  for (std::size_t e = 0; e < elements; ++e) {
    const ElementLoading loading = element_loading(model, row, e);
    stress.push_back(loading.stress);
    peak.push_back(loading.peak);
    yield_ratio.push_back(loading.yield_ratio);
  }
  field("stress_Pa", FieldPlace::elements, stress, 1);
  field("yield_ratio", FieldPlace::elements, yield_ratio, 1);
  field("s", FieldPlace::elements, row.s, 1);
  field("hinge", FieldPlace::elements, row.hinge, 1);
  field("peak_stress_Pa", FieldPlace::elements, peak, 1);
}

/// Asked before each frame that is exported; false gives the export up.
using Proceed = std::function<bool()>;

/// Indices of the frames on the way to the newest branch that are rows of its run: all but those with which
/// branches begin between two multiples of the output interval.
std::vector<std::int64_t> exported_frames(const Recording& recording, const Setup& setup);
/// Calls `each` with every one of them. False when `proceed`, where there is one, gave it up. Throws
/// InputError when a frame is not of the setup's model.
bool each_frame(const Recording& recording, const Setup& setup, const Proceed& proceed,
                const std::function<void(const FrameRow&)>& each);

/// The shortest text that reads back as the same number.
std::string shortest(double value);

}  // namespace topple::io
