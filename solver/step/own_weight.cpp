#include "solver/step/own_weight.h"

#include "solver/math/rotation.h"

namespace topple {
namespace {

// f(first element, its nodes and the end of the second one in the body); the mass of the mid node is 2/3.
template <class F>
void each_pair(const BodySystem& s, F f) {
  const Body& body = s.model.bodies[s.index];
  for (int m = body.first_member; m < body.first_member + body.member_count; ++m) {
    const Member& member = s.model.members[m];
    for (int e = member.first_element; e + 1 < member.first_element + member.element_count; e += 2)
      f(e, s.model.elements[e].node[0] - s.first, s.model.elements[e].node[1] - s.first,
        s.model.elements[e + 1].node[1] - s.first);
  }
}

}  // namespace

void distribute_weight(BodySystem& s, const Vec3& gravity, const std::vector<Vec3>& x) {
  if (s.yields) return;
  each_pair(s, [&](int, int a, int mid, int b) {
    // 2/3 stand for the whole, and the length is taken on either side of the mid node, so that every
    // derivative has a place in the tangent
    const Vec3 weight = s.model.node_mass[s.first + mid] * gravity;
    s.force[mid] -= weight;
    for (const int end : {a, b}) {
      s.force[end] += weight / 2;
      s.moment[end] += (x[mid] - x[end]).cross(weight) / 4;
      Mat6 block = Mat6::Zero();
      block.bottomLeftCorner<3, 3>() = skew(weight) / 4;
      s.lu.add(end, mid, block);
      s.lu.add(end, end, Mat6(-block));
    }
  });
}

void add_weight(const BodySystem& s, const Vec3& gravity, const State& state,
                std::vector<SectionForces>& sections) {
  if (s.yields) return;
  each_pair(s, [&](int first, int a, int mid, int b) {
    const Vec3 weight = 1.5 * s.model.node_mass[s.first + mid] * gravity,
               moment = (state.position[s.first + b] - state.position[s.first + a]).cross(weight);
    for (int half = 0; half < 2; ++half) {
      const Element& element = s.model.elements[first + half];
      const double sign = half == 0 ? 1 : -1, at_start = half == 0 ? 1. / 12 : -1. / 24;
      const double at_point = at_start - sign / 8 * (1 - element.s) / 2;
      Quat turn;
      turn.coeffs() =
          (state.rotation[element.node[0]].coeffs() + state.rotation[element.node[1]].coeffs()).normalized();
      const Mat3 to_section = (turn.toRotationMatrix() * element.triad).transpose();
      SectionForces& forces = sections[first + half];
      forces.normal += sign / 4 * to_section * weight;
      forces.moment += at_point * to_section * moment;
    }
  });
}

}  // namespace topple
