#include "solver/contact/member_pairs.h"

#include <array>
#include <map>

namespace topple {
namespace {

struct Segment {
  int element, count;
  std::array<int, 2> node;  // index into the model
};

Segment segment_of(const Model& model, int e, bool by_elements) {
  const Element& element = model.elements[e];
  if (by_elements) return {e, 1, {element.node[0], element.node[1]}};
  const Member& member = model.members[element.member];
  const int last = member.first_element + member.element_count - 1;
  return {member.first_element,
          member.element_count,
          {model.elements[member.first_element].node[0], model.elements[last].node[1]}};
}

}  // namespace

std::vector<MemberPair> member_pairs(const Model& model, std::span<const ElementPair> candidates,
                                     const PairRules& rules) {
  const auto body_of = [&](int element) { return model.members[model.elements[element].member].body; };
  std::map<ElementPair, std::array<Segment, 2>> segments;
  for (const auto& [a, b] : candidates) {
    const int of_a = body_of(a), of_b = body_of(b);
    const std::array<Segment, 2> both{segment_of(model, a, rules.by_elements(of_a, of_b)),
                                      segment_of(model, b, rules.by_elements(of_b, of_a))};
    segments.emplace(ElementPair{both[0].element, both[1].element}, both);
  }
  std::vector<MemberPair> pairs;
  for (const auto& [elements, both] : segments) {
    MemberPair& pair = pairs.emplace_back();
    pair.elements = elements;
    pair.L = contact_length(model, elements);
    double inverse = 0;
    for (int k = 0; k < 2; ++k) {
      pair.count[k] = both[k].count;
      for (int end = 0; end < 2; ++end) pair.node[2 * k + end] = rules.number(both[k].node[end]);
      inverse += rules.inverse_mass(body_of(both[k].element));
    }
    pair.mass = 1 / inverse;
    pair.start.fill(Vec3::Zero());
    pair.stick.fill(Vec3::Zero());
  }
  return pairs;
}

}  // namespace topple
