// What somebody who mistyped a name may have meant.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace topple::io {

/// Least number of letters to insert, drop, replace or exchange with their neighbour, each place touched
/// once, that makes `b` of `a`.
int edit_distance(std::string_view a, std::string_view b);

/// The first of `known` that is nearest to `word`: at most a third of the letters of `word` apart, or begun
/// with three letters or more. Empty: none is near.
std::string nearest_name(std::string_view word, const std::vector<std::string>& known);

}  // namespace topple::io
