// Load-displacement paths of plastic frames for tests: one displacement is prescribed, the load factor is
// found with it, so that a path goes through collapse.
#pragma once

#include <Eigen/LU>
#include <set>

#include "solver/element/beam.h"
#include "solver/element/plasticity.h"
#include "solver/frame/hinges.h"
#include "unit/solver/fixtures.h"

namespace topple::test {

class PlasticPath {
 public:
  explicit PlasticPath(Model model_in)
      : model(std::move(model_in)),
        system(model, 0),
        state(start_state(model, std::vector<BodyStart>(1))),
        motion_(reference_motion(model)) {}

  /// Moves degree of freedom `direction` of a node by `step` under the model's loads times `factor`. False
  /// when Newton does not converge.
  bool move(int node, int direction, double step) {
    system.load_memory(state, motion_);
    const BodyMotion start = motion_;
    const double reached = displacement(node, direction) + step;
    do {
      if (!solve(start, 6 * node + direction, reached)) return false;
    } while (release_joints(system, motion_) || break_sections(system, motion_));
    dissipated += commit_hinges(system, start, motion_, state);
    return true;
  }

  double displacement(int node, int direction) const {
    if (direction < 3) return (motion_.position[node] - model.node_position[node])[direction];
    return log_quaternion(motion_.rotation[node])[direction - 3];
  }
  /// Nodes beside which a section flows; of elements that flow in their middle these.
  int hinge_count() const {
    std::set<std::pair<int, int>> places;
    for (std::size_t e = 0; e < state.elements.size(); ++e)
      for (int end = 0; end < 2; ++end)
        if (has_hinge(state.elements[e].hinge, end))
          places.insert(state.elements[e].hinge == Hinge::middle ? std::pair(static_cast<int>(e), -1)
                                                                 : std::pair(model.elements[e].node[end], 0));
    return static_cast<int>(places.size());
  }
  Hinge hinge(int element) const { return state.elements[element].hinge; }
  double stored() const {
    double sum = 0;
    for (std::size_t e = 0; e < model.elements.size(); ++e)
      sum += beam_energy(model.elements[e],
                         elastic_strain(state.elements[e], beam_strain(model.elements[e], ends(e))));
    return sum;
  }

  const Model model;
  BodySystem system;
  State state;
  double factor = 0, dissipated = 0;

 private:
  BeamEnds ends(std::size_t e) const {
    const auto [i, j] = model.elements[e].node;
    return beam_ends(motion_.position[i], motion_.rotation[i], motion_.position[j], motion_.rotation[j]);
  }

  // Newton on (unknowns, factor) with the prescribed displacement as the last equation: regular at collapse.
  bool solve(const BodyMotion& start, int control, double reached) {
    const int n = 6 * system.count;
    const double at_start = displacement(control / 6, control % 6);
    double last = 1e300;
    for (int iteration = 0; iteration < 40; ++iteration) {
      if (iteration > 0) hold_joints(system, start, motion_);
      Eigen::MatrixXd k = Eigen::MatrixXd::Zero(n + 1, n + 1);
      Eigen::VectorXd r = Eigen::VectorXd::Zero(n + 1);
      for (std::size_t e = 0; e < model.elements.size(); ++e) add_element(e, k, r);
      for (const Load& load : model.loads)
        for (int i = 0; i < 3; ++i) {
          const int row = 6 * load.node + i;
          k(row, n) -= load.force[i];
          k(row + 3, n) -= load.moment[i];
          r[row] += factor * load.force[i];
          r[row + 3] += factor * load.moment[i];
        }
      for (int i = 0; i < system.count; ++i)
        for (int d = 0; d < 6; ++d)
          if (system.fixed[i] >> d & 1) {
            k.row(6 * i + d).setZero();
            k(6 * i + d, 6 * i + d) = 1;
            r[6 * i + d] = 0;
          }
      k(n, control) = 1;
      r[n] = reached - displacement(control / 6, control % 6);
      // rows and columns to one size
      Eigen::VectorXd rows = k.cwiseAbs().rowwise().maxCoeff().cwiseInverse();
      k = rows.asDiagonal() * k;
      const Eigen::VectorXd columns = k.cwiseAbs().colwise().maxCoeff().cwiseInverse().transpose();
      k = k * columns.asDiagonal();
      Eigen::FullPivLU<Eigen::MatrixXd> lu(k);
      lu.setThreshold(1e-11);  // what a mechanism leaves undetermined stays where it is
      const Eigen::VectorXd d = columns.asDiagonal() * lu.solve(rows.asDiagonal() * r);
      for (int i = 0; i < system.count; ++i) {
        motion_.position[i] += d.segment<3>(6 * i);
        motion_.rotation[i] = (exp_quaternion(d.segment<3>(6 * i + 3)) * motion_.rotation[i]).normalized();
      }
      factor += d[n];
      const double size =
          d.head(n).cwiseAbs().maxCoeff() / std::max(std::abs(reached), std::abs(reached - at_start));
      if (!std::isfinite(size)) return false;
      if (last < 1e-7) return true;  // quadratic until rounding of the positions stops it
      last = size;
    }
    return false;
  }

  void add_element(std::size_t e, Eigen::MatrixXd& k, Eigen::VectorXd& r) const {
    const Element& element = model.elements[e];
    BeamGradient g;
    Mat12 tangent;
    beam_tangent(element, system.elements[e], ends(e), g, tangent);
    const int at[2] = {6 * element.node[0], 6 * element.node[1]};
    for (int a = 0; a < 2; ++a)
      for (int b = 0; b < 2; ++b) k.block<6, 6>(at[a], at[b]) += tangent.block<6, 6>(6 * a, 6 * b);
    r.segment<3>(at[0]) -= g.force1;
    r.segment<3>(at[0] + 3) -= g.moment1;
    r.segment<3>(at[1]) -= g.force2;
    r.segment<3>(at[1] + 3) -= g.moment2;
  }

  BodyMotion motion_;
};

/// Steel that yields at so little that displacements stay negligible against lengths.
inline Material weak_steel(double yield = 1e6) {
  Material m = steel();
  m.yield = yield;
  return m;
}

/// A frame of 50 x 100 mm members whose plastic moment about local y is the only finite capacity:
/// Mp = zy yield.
inline Section pure_bending_section() {
  Section s = plain_section(5e-3, 5e-6, 1e-6, 3e-6, 1, 1);
  s.zy = 1.25e-4;
  s.zz = s.zt = 1e6;
  return s;
}

struct PlaneFrame {
  std::vector<Vec3> nodes;
  std::vector<std::pair<int, int>> members;
  std::vector<Support> supports;
  std::vector<Load> loads;
  int elements = 2;
  Scheme scheme = Scheme::asi_gauss;

  /// In the x-z plane; N has no part in yield.
  Model build(const Section& section = pure_bending_section(), const Material& material = weak_steel(),
              bool pure = true) const {
    Model model;
    model.scheme = scheme;
    model.materials.push_back(material);
    model.sections.push_back(section);
    FrameSpec spec;
    spec.name = "frame";
    spec.nodes = nodes;
    for (const auto& [i, j] : members) spec.members.push_back({{i, j}, 0, 0, elements, Vec3::Zero()});
    spec.supports = supports;
    spec.loads = loads;
    add_frame(model, spec);
    if (pure)
      for (Element& element : model.elements) element.capacity[0] = 1e30;
    return model;
  }
};

}  // namespace topple::test
