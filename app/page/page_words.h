// Texts of the live page that the window and the report do not have.
#pragma once

#include <string_view>
#include <utility>

#include "app/picture/window_words.h"
#include "app/report/report_words.h"
#include "solver/model/table.h"
#include "solver/planar/planar_case.h"

namespace topple::app::page_words {

// what can be changed
inline constexpr Phrase k_depth{"depth", "奥行"};
inline constexpr Phrase k_width{"width", "幅"};
inline constexpr Phrase k_height{"height", "高さ"};
inline constexpr Phrase k_mass{"mass", "質量"};
inline constexpr Phrase k_loads{"mass of its loads", "積載質量"};
inline constexpr Phrase k_start_tilt{"tilt at the start", "初期傾斜"};
inline constexpr Phrase k_cg_height{"height of the centre of gravity", "重心の高さ"};
inline constexpr Phrase k_in_place{"in place", "取り付け"};

// why there is no map
inline constexpr Phrase k_map_no_piece{"there is no furniture", "家具がない"};
inline constexpr Phrase k_map_no_sine{"the floor moves in another way than one sine",
                                      "床の動きが単一の正弦波ではない"};
inline constexpr Phrase k_map_vertical{"the floor moves up and down only", "床が鉛直方向にのみ動く"};
inline constexpr Phrase k_map_building{"the floor is one of a building, which does not follow the sine",
                                       "床が建物の階であり、正弦波どおりには動かない"};
struct JapaneseObstacle {
  planar::Obstacle kind;
  std::string_view japanese;  ///< of ObstacleTraits::phrase
};
inline constexpr JapaneseObstacle k_obstacles[] = {
    {planar::Obstacle::none, ""},
    {planar::Obstacle::floor, "水平な床の上に立っていないか、重力が鉛直でない"},
    {planar::Obstacle::held, "支持、荷重、手または固定具が作用している"},
    {planar::Obstacle::base, "接触幅の一様な平らな底面がない"},
    {planar::Obstacle::law, "接触則に剛な極限がない"},
    {planar::Obstacle::direction, "一つの鉛直面から外れて動く"},
    {planar::Obstacle::stands, "初めに床の上に立っていない"},
    {planar::Obstacle::symmetry, "動く面について対称でない"},
    {planar::Obstacle::edge, "底面の端が点である"},
    {planar::Obstacle::early, "転倒する前に他の接触点が床に当たる"},
    {planar::Obstacle::near, "倒れる範囲に壁または他の家具がある"},
    {planar::Obstacle::jump, "床の上下方向の速度が不連続である"},
};

// of loads that grow
inline constexpr Phrase k_greatest_load{"Greatest load factor: {0:.4g}.", "最大荷重係数：{0:.4g}。"};
inline constexpr Phrase k_load_hinges{" Plastic hinges: {0}.", "塑性ヒンジ：{0}か所。"};
inline constexpr Phrase k_load_breaks{" Broken sections: {0}.", "破断した断面：{0}か所。"};

inline constexpr Phrase k_diverged{"The computation broke off at {0} s: {1}", "計算は{0}秒で中断した：{1}"};

/// A text of the page's controls. The page calls it by its name.
struct Named {
  std::string_view name;
  Phrase phrase;
};
inline constexpr Named k_all[] = {
    {"recorded", {"recorded run", "記録した計算"}},
    {"changed", {"computed with your changes", "変更した条件で計算"}},
    {"before", {"the run before this change", "この変更の前の計算"}},
    {"computing", {"computing …", "計算中 …"}},
    {"back", {"Back to the recorded run", "記録した計算に戻す"}},
    {"play", {"Play", "再生"}},
    {"pause", {"Pause", "一時停止"}},
    {"time", {"time", "時刻"}},
    {"timeline", {"Tilt over critical angle, by time", "傾斜／転倒限界角の時刻歴"}},
    {"tilt", window_words::k_tilt_share_lane},
    {"critical", window_words::k_critical_at_one},
    {"floor", window_words::k_floor_lane},
    {"picture", {"Picture of the furniture; arrow keys turn it", "家具の3D表示。矢印キーで回転"}},
    {"views", {"View", "視点"}},
    {"front", window_words::k_front},
    {"side", window_words::k_side},
    {"top", window_words::k_top},
    {"iso", window_words::k_iso},
    {"colour", window_words::k_colour},
    {"projector", {"Projector", "プロジェクター"}},
    {"dark", window_words::k_dark},
    {"parameters", window_words::k_parameters},
    {"result", {"Who falls", "転倒する家具"}},
    {"map",
     {"What overturns a rigid block of this shape, alone and free on the floor: no walls, fixings, other "
      "pieces",
      "床に単独で固定せずに置いた同じ形の剛体ブロックの転倒（壁・固定具・他の家具は考えない）"}},
    {"map_falls", {"overturns", "転倒"}},
    {"map_rocks", {"rocks, stays", "ロッキング、転倒せず"}},
    {"map_stands", {"stands", "浮き上がらず"}},
    {"map_here", {"this shake; cells are of their middles", "この揺れ（各マスは中央の値）"}},
    {"map_piece", {"Map of", "転倒図の対象"}},
    {"map_none", {"There is no map: {0}", "転倒図なし：{0}"}},
    {"hint",
     {"Drag turns, wheel or two fingers zoom, Shift + drag moves. Space plays.",
      "ドラッグで回転、ホイールか2本指で拡大、Shift＋ドラッグで移動。Space で再生。"}},
    {"replay_only",
     {"This page replays only: a run takes about {0} s in a browser, more than the 3 s that a page may take.",
      "このページは再生のみ。1回の計算にブラウザーで約{0}秒かかり、ページでの上限3秒を超える。"}},
    {"replay_stress",
     {"This page replays only: a run takes about {0} s in a browser, more than the 3 s that a page may take. "
      "Without "
      "stresses, with run.want = [\"motion\"], it takes less.",
      "このページは再生のみ。1回の計算にブラウザーで約{0}秒かかり、ページでの上限3秒を超える。応力なし"
      "（run.want = [\"motion\"]）ならより短い。"}},
    {"replay_edits",
     {"This page replays only: parameters were changed while it ran.",
      "このページは再生のみ。計算中にパラメーターを変更した記録である。"}},
    {"replay_static",
     {"This page replays only: it shows a static run.", "このページは再生のみ。静的な計算である。"}},
    {"thinned", {"Of the recorded instants, one in {0} is kept.", "記録した時刻の{0}個に1個を収録。"}},
    {"not_validated",
     {"Computed, not measured: no test on a shaking table stands behind this page.",
      "計算による結果であり、実験による裏付けはない。"}},
    {"no_picture",
     {"This browser draws no WebGL2: still pictures of the recorded run instead.",
      "このブラウザーでは WebGL2 が使えないため、記録した計算の静止画を表示する。"}},
    {"no_engine",
     {"This browser runs no WebAssembly in a Worker: words and still pictures only.",
      "このブラウザーでは WebAssembly や Worker が使えないため、文章と静止画のみを表示する。"}},
};

}  // namespace topple::app::page_words
