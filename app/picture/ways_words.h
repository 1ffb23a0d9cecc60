// What is said of people: their way out, and who hits them.
#pragma once

#include "app/picture/window_words.h"

namespace topple::app::window_words {

inline constexpr Phrase k_ways{"The way out of a person {0} m wide:", "幅{0} mの人の避難経路："};
inline constexpr Phrase k_way_open{"{0}: way to {1} open, widest {2} m, shortest {3} m long",
                                   "{0}：{1}まで通れる（最も広い道の幅 {2} m、最短 {3} m）"};
inline constexpr Phrase k_way_blocked{"{0}: no way to {1}, {2} m left, blocked by {3}",
                                      "{0}：{1}まで通れない（残り {2} m、塞ぐ家具：{3}）"};
inline constexpr Phrase k_way_caught{"{0}: cannot leave, blocked where they are by {1}",
                                     "{0}：{1}が居場所にかかり、動けない"};
inline constexpr Phrase k_way_narrow{"{0}: {1} is narrower than a person", "{0}：{1}は人の幅より狭い"};
inline constexpr Phrase k_way_no_door{"{0}: there is no door", "{0}：扉がない"};
inline constexpr Phrase k_more_harms{"and {0} more (Inspect)", "ほか {0}件（「調べる」に表示）"};
inline constexpr Phrase k_way_hit{"{0}: hit by {1} at {2} s", "{0}：{2}秒に{1}が当たる"};

}  // namespace topple::app::window_words
