// What the window says of the path of a static run.
#pragma once

#include "app/picture/window_words.h"

namespace topple::app::window_words {

inline constexpr Phrase k_node_way{"{0} node {1}, {2}", "{0} 節点{1}、{2}"};
inline constexpr Phrase k_probe_way{"{0}, {1}", "{0}、{1}"};
inline constexpr Phrase k_stable{"stable", "安定"};
inline constexpr Phrase k_unstable{"unstable", "不安定"};
inline constexpr Phrase k_stability_unknown{"stability not known", "安定性は不明"};
inline constexpr Phrase k_limit_point{"limit point", "極限点"};
inline constexpr Phrase k_buckles{"buckles sideways", "横に座屈"};
inline constexpr Phrase k_mechanism{"mechanism", "崩壊機構"};
inline constexpr Phrase k_section_breaks{"a section breaks", "断面の破断"};
inline constexpr Phrase k_moves_most{"{0}: {1}; {2} of {3} moves most", "{0}：{1}、{3} の{2}が最も動く"};
inline constexpr Phrase k_node{"node {0}", "節点{0}"};
inline constexpr Phrase k_inside_of{"the inside of {0}", "{0} の中間"};

}  // namespace topple::app::window_words
