// What a body is computed as, why, and what moves it, in both languages.
#pragma once

#include <algorithm>
#include <iterator>
#include <string_view>
#include <utility>

#include "app/support/language.h"
#include "solver/body/model_level.h"
#include "solver/math/ranges.h"

namespace topple::app::model_words {

/// Japanese of what the solver has English words for, which stand where there is no row.
template <class Kind>
struct Japanese {
  Kind kind;
  std::string_view words;
};
inline constexpr Japanese<ModelLevel> k_levels[] = {{ModelLevel::planar, "平面剛体"},
                                                    {ModelLevel::rigid, "剛体"},
                                                    {ModelLevel::elastic, "弾性"},
                                                    {ModelLevel::frame, "骨組"}};
inline constexpr Japanese<LevelReason> k_level_reasons[] = {
    {LevelReason::asked, "指定による"},
    {LevelReason::motion, "運動のみ必要"},
    {LevelReason::stress, "応力が必要"},
    {LevelReason::blow, "弾性体には硬すぎる接触に衝突する"},
    {LevelReason::yield, "断面が降伏に近い"},
    {LevelReason::deformation, "微小変形でない"},
    {LevelReason::near, "フレームの家具が近い"},
    {LevelReason::calm, "静穏に戻った"},
    {LevelReason::bending, "剛体とみなすには曲がりすぎる"},
    {LevelReason::neighbour, "壁か他の家具が近い"},
    {LevelReason::fall, "別の部分が床か壁に当たる"},
    {LevelReason::plane, "運動が鉛直面内でなくなった"},
    {LevelReason::held, "固定具または手が働く"},
    {LevelReason::contact, "接触条件の変更"},
    {LevelReason::jammed, "すべりの停止が繰り返される"},
    {LevelReason::solid, "一つの塊である"}};

template <class Table, class Kind>
Phrase phrase_of(std::string_view english, const Table& table, Kind kind) {
  const auto* const row = ranges::find_if(table, [kind](const auto& of) { return of.kind == kind; });
  return {english, row == std::end(table) ? english : row->words};
}
inline Phrase phrase_of(ModelLevel level) {
  return phrase_of(traits(level).word, k_levels, level);
}
inline Phrase phrase_of(LevelReason reason) {
  return phrase_of(name(reason), k_level_reasons, reason);
}

/// Japanese of the words that a parameter may have.
inline constexpr std::pair<std::string_view, std::string_view> k_choice_words[] = {
    {"sine", "正弦波"},
    {"sweep", "スイープ"},
    {"pulse", "パルス"},
    {"record", "加速度記録"},
    {"coulomb", "クーロン摩擦"},
    {"paper", "論文"},
    {"printed", "論文（印刷の式）"},
    {"auto", "自動"},
    {"planar", "平面剛体"},
    {"rigid", "剛体"},
    {"elastic", "弾性"},
    {"frame", "骨組"},
    {"generalized-alpha", "一般化α法"},
    {"central-difference", "中央差分法"},
    {"newmark", "Newmark 法"}};
/// A word as scenes have it, to be said; one without a row says itself.
inline Phrase phrase_of_choice(std::string_view word) {
  const auto* const row = ranges::find(k_choice_words, word, [](const auto& of) { return of.first; });
  return {word, row == std::end(k_choice_words) ? word : row->second};
}

/// What moves a body on a level without the scene's integrator, and where rigid bodies that meet have
/// impulses (integrators.h).
struct MovedBy {
  ModelLevel kind;
  Phrase words, otherwise;  ///< LevelIntegrator; without words: the scene's integrator
};
inline constexpr MovedBy k_moved_by[] = {
    {ModelLevel::planar, {"Taylor series", "テイラー級数"}, {}},
    {ModelLevel::rigid,
     {"central differences, TR-BDF2 on stiff contacts", "中央差分法、硬い接触では TR-BDF2"},
     {"central differences, TR-BDF2 on stiff contacts, impulses where bodies meet",
      "中央差分法、硬い接触では TR-BDF2、物体どうしの接触では力積"}},
    {ModelLevel::elastic, {"central differences", "中央差分法"}, {}},
    {ModelLevel::frame,
     {},
     {"generalized-alpha or, where cheaper, central differences", "一般化α法、安く済む所では中央差分法"}}};
/// otherwise: moves_otherwise() (integrators.h). Null: the scene's integrator does.
inline const Phrase* moved_by(ModelLevel level, bool otherwise) {
  const MovedBy& by = row_of(k_moved_by, level);
  const Phrase& words = otherwise ? by.otherwise : by.words;
  return words.english == std::string_view() ? nullptr : &words;
}

}  // namespace topple::app::model_words
