// Titles of the built-in scenes: as they are written in them, and in the other languages of the window.
#pragma once

#include "app/support/language.h"

namespace topple::app::title_words {

inline constexpr Phrase k_title_changed{"{0} (changed)", "{0}（変更あり）"};
inline constexpr Phrase k_titles[] = {
    {"Sine of 0.5 Hz, 190 gal: two straps hold a cabinet to the wall (assumed sizes)",
     "正弦波 0.5 Hz、190 gal：2本のベルトで壁に固定したキャビネット（寸法は仮定）"},
    {"A cabinet on a floor of beams: 2 Hz, 350 gal", "梁の床に立つキャビネット：2 Hz、350 gal"},
    {"A bookshelf before a wall on a high floor: only one way to fall",
     "高層階の壁際の本棚：倒れる向きは一つだけ"},
    {"A loaded cabinet falls on its edge and breaks", "荷を載せたキャビネットが角から落ちて壊れる"},
    {"A bookshelf falls when its brittle connectors part", "もろい連結金具が外れて倒れる本棚"},
    {"A full steel cabinet under a slow sine just beyond its static limit",
     "静的な限界をわずかに超える緩やかな正弦波で揺れる満載の鋼製キャビネット"},
    {"A cantilever under a sudden tip load", "先端に急に荷重がかかる片持ち梁"},
    {"A school chair tips backwards under 0.8 Hz and 500 gal", "0.8 Hz、500 gal で後ろへ倒れる学校の椅子"},
    {"A classroom beside a fault: what stands at the back falls on the last row",
     "断層近くの教室：後ろの家具が最後列に倒れる"},
    {"Two loaded cabinets fall against each other and yield",
     "荷を載せた2台のキャビネットがぶつかり合って倒れ、降伏する"},
    {"An office desk slides under 1 Hz and 450 gal", "1 Hz、450 gal で滑る事務机"},
    {"Eight cabinets knock each other over", "8台のキャビネットの将棋倒し"},
    {"High floor of a tall building: a synthetic long-period record, 230 and 140 gal",
     "高層ビルの上階：合成した長周期の記録波、230 gal と 140 gal"},
    {"A table's legs fold under a falling cabinet", "倒れてきたキャビネットの下で折れるテーブルの脚"},
    {"A cabinet let go at half of its critical angle", "限界角の半分の傾きから放したキャビネット"},
    {"Moving in: what stands on shelves comes down", "引っ越し：棚の上の物が落ちる"},
    {"Beside a fault: a synthetic pulse of 78 cm/s", "断層の近く：合成した 78 cm/s のパルス"},
    {"An office on a high floor: two cabinets are strapped to the wall, one is not",
     "高層階のオフィス：ベルトで壁に固定した2台のキャビネットと、固定していない1台"},
    {"Sine of 0.5 Hz, 190 gal: a cabinet free and one beside a wall (assumed sizes)",
     "正弦波 0.5 Hz、190 gal：単独のキャビネットと壁際のキャビネット（寸法は仮定）"},
    {"Sine of 2 Hz, 700 gal: a cabinet lying and one beside a wall (assumed sizes)",
     "正弦波 2 Hz、700 gal：寝かせたキャビネットと壁際のキャビネット（寸法は仮定）"},
    {"Portal pushed sideways until a hinge is at each corner",
     "四隅にヒンジができるまで横に押した門形ラーメン"},
    {"A refrigerator slides on a smooth floor beside a fault", "断層の近くの滑りやすい床を滑る冷蔵庫"},
    {"Held and not held on the sixth floor of a building", "建物の6階：固定した家具と固定していない家具"},
    {"A stack of ten boxes on a shaking floor", "揺れる床に積んだ10個の箱"},
    {"A cabinet tumbling in free flight", "宙を自由に回るキャビネット"},
    {"A tall wardrobe rocks under 2 Hz and 500 gal and stands",
     "2 Hz、500 gal で揺れても倒れない背の高い洋服だんす"},
    {"A rack comes down in its weak storey", "弱い段からつぶれるラック"},
    {"Wedged between a wall and a neighbour: 1 Hz, 250 gal",
     "壁と隣の家具に挟まれたキャビネット：1 Hz、250 gal"},
    {"A loaded cabinet falls on its edge and yields", "荷を載せたキャビネットが角から落ちて降伏する"},
};

}  // namespace topple::app::title_words
