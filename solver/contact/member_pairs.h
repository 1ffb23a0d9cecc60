// Straight parts of bodies that may touch each other.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "solver/contact/member_contact.h"
#include "solver/contact/proximity.h"
#include "solver/model/model.h"

namespace topple {

/// What decides how the elements of candidate pairs are taken together. Bodies are indices into the model.
struct PairRules {
  /// Whether the elements of `body` touch `other` each by itself; else whole members do, which stay straight.
  std::function<bool(int body, int other)> by_elements;
  std::function<int(int node)> number;           ///< of a node, within the system
  std::function<double(int body)> inverse_mass;  ///< 1/kg, of a body's share (MemberPair::mass); 0: held
};

/// One for each of `candidates`, in the order of their elements; those of the same two members once.
std::vector<MemberPair> member_pairs(const Model& model, std::span<const ElementPair> candidates,
                                     const PairRules& rules);

}  // namespace topple
