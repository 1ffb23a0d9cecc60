#include "solver/contact/member_pairs.h"

#include <algorithm>
#include <array>

#include "solver/math/ranges.h"

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
  const auto segments_of = [&](const ElementPair& pair) {
    const int of_a = body_of(model, pair.a), of_b = body_of(model, pair.b);
    const bool on_panel = panel_of(model, pair.b) != nullptr;
    return std::array<Segment, 2>{
        segment_of(model, pair.a, rules.by_elements(of_a, of_b)),
        on_panel ? Segment{pair.b, 1, {}} : segment_of(model, pair.b, rules.by_elements(of_b, of_a))};
  };
  std::vector<ElementPair> first;
  for (const ElementPair& candidate : candidates) {
    const auto [a, b] = segments_of(candidate);
    const ElementPair pair{a.element, b.element};
    if (first.empty() || first.back() != pair) first.push_back(pair);
  }
  ranges::sort(first);
  first.erase(std::unique(first.begin(), first.end()), first.end());
  std::vector<MemberPair> pairs;
  pairs.reserve(first.size());
  for (const ElementPair& elements : first) {
    const std::array<Segment, 2> both = segments_of(elements);
    MemberPair& pair = pairs.emplace_back();
    pair.elements = elements;
    pair.panel = panel_of(model, elements.b);
    pair.L = contact_length(model, elements);
    for (int k = 0; k < 2; ++k) pair.count[k] = both[k].count;
    for (int end = 0; end < 2; ++end) {
      pair.node[end] = rules.number(both[0].node[end]);
      const int last = end == 0 ? 0 : both[0].count - 1;
      pair.tip[end] = pair.panel != nullptr && is_tip(model, elements.a + last, end);
    }
    if (pair.panel != nullptr)
      ranges::transform(pair.panel->node, pair.node.begin() + 2, rules.number);
    else
      ranges::transform(both[1].node, pair.node.begin() + 2, rules.number);
    pair.mass =
        1 / (rules.inverse_mass(body_of(model, elements.a)) + rules.inverse_mass(body_of(model, elements.b)));
    pair.start.fill(Vec3::Zero());
    pair.stick.fill(Vec3::Zero());
  }
  return pairs;
}

}  // namespace topple
