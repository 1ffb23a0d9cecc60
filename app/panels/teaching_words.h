// Texts of what the window teaches.
#pragma once

#include "app/panels/shell_words.h"

namespace topple::app::window_words {

// amplitude over frequency
inline constexpr Phrase k_body{"body", "家具"};
inline constexpr Phrase k_no_standing_body{
    "No body here stands freely on the floor, so the criteria say nothing.",
    "床に自立する家具がないため、判定基準は適用できません。"};
inline constexpr Phrase k_no_edge_across{
    "No body that stands freely here has an edge square to the shake, so the criteria say nothing.",
    "加振方向に直交する底辺を持つ自立家具がないため、判定基準は適用できません。"};
inline constexpr Phrase k_shaken_askew{"{0} (no edge is square to the shake)",
                                       "{0}（加振が底辺に直交しない）"};
inline constexpr Phrase k_stands_not_freely{"{0} (held, on another, or bears one)",
                                            "{0}（固定・家具の上・家具を載せている）"};
inline constexpr Phrase k_slides_before{"{0} (slides before it lifts)", "{0}（浮き上がる前に滑る）"};
inline constexpr Phrase k_slides_first{
    "{0} slides before it can lift: friction is below b/h = {1:.2f}. The criteria, which are of blocks that "
    "do "
    "not slip, say nothing of it.",
    "{0} は浮き上がる前に滑ります（摩擦係数が b/h = {1:.2f} 未満）。滑らない剛体の判定基準は"
    "適用できません。"};
inline constexpr Phrase k_no_floor_shake{"The floor does not shake here.", "このシーンでは床は揺れません。"};
inline constexpr Phrase k_building_between{
    "A building stands between the ground that is set here and the floor: the criteria, which are for the "
    "shake of the floor itself, say nothing.",
    "設定した地盤の揺れと床の間に建物があります。"
    "判定基準は床自体の揺れに対するものなので、ここでは適用できません。"};
inline constexpr Phrase k_frequency_axis{"frequency, Hz", "周波数 [Hz]"};
inline constexpr Phrase k_amplitude_axis{"amplitude, gal", "加速度振幅 [gal]"};
inline constexpr Phrase k_west{"West", "West"};
inline constexpr Phrase k_ishiyama{"Ishiyama", "石山"};
inline constexpr Phrase k_stays{"stays", "動かない"};
inline constexpr Phrase k_rocks{"rocks", "ロッキング"};
inline constexpr Phrase k_may_overturn{"may overturn", "転倒の恐れ"};
inline constexpr Phrase k_verdict{"By the criteria, {0:.3g} Hz, {1:.4g} gal: {2}.",
                                  "判定基準では {0:.3g} Hz、{1:.4g} gal：{2}。"};
inline constexpr Phrase k_verdict_record{
    "Record, peak {1:.4g} gal; peak acceleration over peak velocity as of {0:.3g} Hz; by the criteria: {2}.",
    "加速度記録、最大 {1:.4g} gal。最大加速度と最大速度の比から {0:.3g} Hz 相当。判定基準では{2}。"};
inline constexpr Phrase k_limits{
    "West: it lifts above {0:.4g} gal. Ishiyama: below a floor velocity of {1:.3g} cm/s it does not "
    "overturn; here "
    "{2:.3g} cm/s.",
    "West の式：{0:.4g} gal を超えると浮き上がる。石山の式：床の速度が {1:.3g} cm/s 未満なら転倒しない（現在 "
    "{2:.3g} cm/s）。"};
inline constexpr Phrase k_soft_limits{
    "Both are for a steady push on the soft contacts of this scene: a shake may lift it at less, or not at "
    "more. ",
    "どちらもこのシーンの柔らかい接触に一定の力が続く場合の値で、揺れではより小さくても浮き上がり、"
    "より大きくても浮き上がらないことがある。"};
inline constexpr Phrase k_west_formula{
    "On a rigid floor West has g b/h = {0:.4g} gal, the centre of gravity b = {1:.0f} mm from the edge, h = "
    "{2:.0f} mm up.",
    "剛な床では West の式は g b/h = {0:.4g} gal（重心：縁から b = {1:.0f} mm、高さ h = {2:.0f} mm）。"};
inline constexpr Phrase k_is_held{
    "But {0} is held by {1}: the criteria are of a body that nothing holds; the run says what it does held.",
    "ただし {0} は {1} で固定されています。判定基準は固定のない家具のもので、固定の効果は計算が示します。"};
inline constexpr Phrase k_is_leaned{
    "But {0} leans back on {1}: the criteria are of a body that stands upright; the run says what it does "
    "so.",
    "ただし {0} は {1} で後ろに傾けてあります。判定基準は直立した家具のもので、その効果は計算が示します。"};
inline constexpr Phrase k_run_differs{
    "In this run {0} has {1}. The criteria are for one push on a body alone that is at rest before",
    "この計算では {0} は{1}。判定基準は、静止した単独の家具への一度の押しに対するものです"};
inline constexpr Phrase k_has_lifted{"lifted all the same", "それでも浮き上がった"};
inline constexpr Phrase k_has_overturned{"overturned all the same", "それでも転倒した"};
inline constexpr Phrase k_differs_soft{"; here soft contacts let it sway higher with each swing",
                                       "。ここでは柔らかい接触のため揺れるたびに振れが大きくなります"};
inline constexpr Phrase k_differs_changed{"; here parameters were changed while it ran",
                                          "。ここでは途中でパラメーターが変更されました"};
inline constexpr Phrase k_differs_others{"; here another body touched it",
                                         "。ここではほかの家具が接触しました"};
inline constexpr Phrase k_has_not_lifted{
    "In this run {0} has not lifted so far: on soft contacts a push has to last.",
    "この計算では {0} はまだ浮き上がっていません。柔らかい接触では力が続かないと浮き上がりません。"};
inline constexpr Phrase k_full_stop{".", "。"};
inline constexpr Phrase k_long_period{"long period, small acceleration", "長周期・小さい加速度"};
inline constexpr Phrase k_short_period{"short period, large acceleration", "短周期・大きい加速度"};
inline constexpr Phrase k_preset_about{"{0:g} Hz, {1:g} gal, from now on", "現時刻から {0:g} Hz、{1:g} gal"};
inline constexpr Phrase k_sine_only{
    "Only where the floor itself, not the ground of a building, can shake as a sine, at the newest instant",
    "床自体を正弦波で加振できるシーン（建物なし）の、最新の時刻でのみ使えます"};

// overturning map
inline constexpr Phrase k_overturning_map{"Overturning map", "転倒マップ"};
inline constexpr Phrase k_map_again{"Compute again", "再計算"};
inline constexpr Phrase k_map_close{"Close the map", "マップを閉じる"};
inline constexpr Phrase k_map_about{
    "Computes the scene as it is now from its start, beside the window,\nat 24 by 24 frequencies (of a "
    "pulse: durations) and amplitudes",
    "現在の設定のシーンを、周波数（パルスでは継続時間）と\n加速度振幅を24×24通りに変えて最初から計算する"};
inline constexpr Phrase k_map_needs{"Only where furniture is shaken first by a sine or a pulse",
                                    "最初の加振が正弦波またはパルスで、家具があるシーンでのみ使えます"};
inline constexpr Phrase k_map_progress{"Map: {0} of {1} runs", "マップ：{0}/{1} 件を計算"};
inline constexpr Phrase k_map_failed{"No map: {0}", "マップを作成できません：{0}"};
inline constexpr Phrase k_map_rigid{
    "In the map {0} is a rigid block; in the run it bends, and may lift where the map has it still.",
    "マップでは{0}"
    "を剛なブロックとしています。実行中の計算では変形するため、マップで静止するところでも浮くことがあります"
    "。"};
inline constexpr Phrase k_map_cannot_follow{
    "The map that follows the sliders is of blocks that move in a plane, which they do not here; from whole "
    "runs it can be computed.",
    "スライダーに追従するマップは面内で動くブロックのもので、ここでは使えません。計算を最後まで行うマップは作"
    "れます。"};
inline constexpr Phrase k_map_stale{"Other parameters have changed since; compute it again.",
                                    "ほかのパラメーターが変更されました。再計算してください。"};
inline constexpr Phrase k_map_cell{"{0:.3g} {1}, {2:.4g} {3}: {4}", "{0:.3g} {1}、{2:.4g} {3}：{4}"};
inline constexpr Phrase k_map_first_at{", the first at {0:.2f} s", "（最初は {0:.2f} s）"};
inline constexpr Phrase k_map_unsure{
    "uncertain, neighbours disagree: a body overturns in {0} of {1} runs within this cell, probability "
    "{2:.0f} % "
    "({3:.0f} to {4:.0f} %)",
    "不確か（周囲で結果が分かれる）：このマス内の {1} 件中 {0} 件で転倒、確率 {2:.0f} %（{3:.0f}～{4:.0f} "
    "%）"};
inline constexpr Phrase k_map_doubt{"uncertain within", "マス内で不確か"};
inline constexpr Phrase k_map_all_fall{"; neighbours disagree, all {0} runs within this cell overturn",
                                       "。周囲で結果が分かれるが、このマス内の {0} 件はすべて転倒"};
inline constexpr Phrase k_map_all_stand{"; neighbours disagree, none of {0} runs within this cell overturns",
                                        "。周囲で結果が分かれるが、このマス内の {0} 件に転倒はない"};
inline constexpr Phrase k_map_follows{"The map follows the sliders.", "マップはスライダーに追従します。"};
inline constexpr Phrase k_map_here{
    "The nearest cell: {0}. The shake is at {1:.3g} {2}, {3:.4g} {4} now and may end otherwise.",
    "最も近いマス：{0}。現在の加振は {1:.3g} {2}、{3:.4g} {4} で、結果は異なることがあります。"};
inline constexpr Phrase k_map_here_exact{"The cell of the shake as it is now: {0}.",
                                         "現在の加振のマス：{0}。"};
inline constexpr Phrase k_map_outside{"The present shake is outside of the map.",
                                      "現在の加振はマップの範囲外です。"};
inline constexpr Phrase k_map_click{
    "A click shakes like this from now on; R, then Space runs it from the start.\n"
    "Without run.accuracy the map allows 5 %, a run 1 %.",
    "クリックすると現時刻からこの加振に変更。R の後 Space で最初から計算します。\n"
    "run.accuracy の指定がなければ、許容誤差はマップ 5 %、実行 1 %。"};
inline constexpr Phrase k_map_of_ground{
    "The shake of a building's ground is set in the scene alone: the floor's was computed from it.",
    "建物の地動はシーンでのみ設定できます（床の揺れは地動から計算済み）。"};
inline constexpr Phrase k_map_no_click{"Only the newest instant can be shaken otherwise: End, or C.",
                                       "加振を変更できるのは最新の時刻だけです（End または C）。"};
inline constexpr Phrase k_map_lines{"Lines: {0} alone on the floor", "線：床に自立する {0}"};
inline constexpr Phrase k_map_soft{
    "They are for a rigid floor; on the soft contacts of this scene a steady push of {0:.4g} gal tips it.",
    "剛な床に対する値です。このシーンの柔らかい接触では {0:.4g} gal の一定の力で倒れます。"};
inline constexpr Phrase k_map_no_lines{"The criteria do not hold here, so the map has no lines: {0}.",
                                       "判定基準を適用できないため、線はありません：{0}。"};
// as study::criteria says why
inline constexpr Phrase k_lines_several{"there are several shakes", "加振が複数あります"};
inline constexpr Phrase k_lines_building{"a building stands between the ground and the floor",
                                         "地盤と床の間に建物があります"};
inline constexpr Phrase k_lines_steep{"the shake is not level", "加振が水平ではありません"};
inline constexpr Phrase k_lines_moving{"nothing starts at rest on a level floor",
                                       "水平な床で静止から始まる家具がありません"};
inline constexpr Phrase k_lines_no_block{
    "no body stands freely on the floor, bears nothing, has edges across the shake and lifts before it "
    "slides",
    "床に自立し、何も載せず、加振に直交する底辺を持ち、滑る前に浮き上がる家具がありません"};
inline constexpr Phrase k_present{"now", "現在"};
inline constexpr Phrase k_duration_axis{"duration, s", "継続時間 [s]"};
inline constexpr Phrase k_one_cycle{"one cycle alone, exact", "1周期のみ（厳密解）"};
inline constexpr Phrase k_one_pulse{"this pulse, exact", "このパルス（厳密解）"};
inline constexpr Phrase k_all_overturn{"all overturn", "すべて転倒"};
inline constexpr Phrase k_some_overturn{"some overturn", "一部が転倒"};
inline constexpr Phrase k_stands_still{"does not lift", "浮き上がらない"};
inline constexpr Phrase k_run_failed{"run failed", "計算失敗"};
inline constexpr Phrase k_not_computed{"not computed", "未計算"};

// guided demos
inline constexpr Phrase k_demo_opens{"They open {0}; what is open now stays recorded.",
                                     "{0} を開きます。現在の計算は記録されています。"};
inline constexpr Phrase k_back_to{"Back to {0}", "{0} に戻る"};
inline constexpr Phrase k_demos{"Guided demos", "解説付きデモ"};
inline constexpr Phrase k_demo_gentle{"long and gentle", "ゆっくり大きな揺れ"};
inline constexpr Phrase k_demo_violent{"short and violent", "速く激しい揺れ"};
inline constexpr Phrase k_next{"Next", "次へ"};
inline constexpr Phrase k_previous{"Previous", "前へ"};
inline constexpr Phrase k_quit_demo{"Quit", "終了"};
inline constexpr Phrase k_demo_step{"{0}, step {1} of {2}", "{0}（{1}/{2}）"};
inline constexpr Phrase k_gentle_start{
    "The floor will swing slowly and far: 0.5 Hz at 190 gal. Such shaking comes from long-period earthquakes "
    "in the "
    "upper floors of tall buildings.",
    "床が 0.5 Hz、190 gal でゆっくり大きく揺れます。長周期地震動による高層階の揺れに相当します。"};
inline constexpr Phrase k_gentle_uplift{
    "An edge of the base has left the floor, since 190 gal are above West's line. From here on the body "
    "turns "
    "about its other edge.",
    "190 gal は West の線を超えるため、底面の一端が浮き上がりました。ここから反対側の縁を中心に回転します。"};
inline constexpr Phrase k_gentle_critical{
    "The centre of gravity now stands over the edge. Half a period takes a whole second, and all that time "
    "the "
    "floor has pushed the same way.",
    "重心が縁の真上に達しました。半周期が1秒と長く、床はその間ずっと同じ向きに加速し続けました。"};
inline constexpr Phrase k_gentle_end{
    "It falls, at an acceleration of less than a fifth of gravity. What counts is not only how hard the "
    "floor "
    "is shaken but for how long it pushes one way.",
    "重力加速度の5分の1に満たない加速度でも転倒しました。重要なのは揺れの強さだけでなく、同じ向きに押し続ける"
    "時間です。"};
inline constexpr Phrase k_violent_start{
    "Now 2 Hz at 700 gal: nearly four times the acceleration, but it pushes one way for a quarter of the "
    "time.",
    "今度は 2 Hz、700 gal。加速度は約4倍ですが、同じ向きに押す時間は4分の1です。"};
inline constexpr Phrase k_violent_uplift{
    "The body lifts at once, since 700 gal is far above West's line. Yet a quarter of a second after it "
    "began the push turns round.",
    "700 gal は West の線を大きく超えるため、すぐに浮き上がります。しかし押す向きは4分の1秒で変わります。"};
inline constexpr Phrase k_violent_impact{
    "It strikes the floor on its other side and loses energy. Each blow takes away some of what the floor "
    "has put "
    "in.",
    "反対側の縁が床に衝突し、エネルギーを失います。衝突のたびに床から受けたエネルギーの一部が失われます。"};
inline constexpr Phrase k_violent_end{
    "This is how the cabinet without a wall stands now. This shake is as far beyond the line of the velocity "
    "criterion as the slow one: the line says what may overturn, not what does. Here the push turned round "
    "in time. The one before a wall is thrown back by it.",
    "壁のない書庫の現在の状態です。この揺れも、ゆっくりした揺れと同じくらい速度の判定基準を超えていますが、"
    "基準は転倒の可能性を示すだけです。今回は押す向きが間に合って変わりました。壁際の書庫は壁に跳ね返されます"
    "。"};
inline constexpr Phrase k_did_not_come{
    "The run ended before this came about. The scene, or the parameters as they are now, differ from those "
    "the demo "
    "is about.",
    "この現象が起きる前に計算が終わりました。シーンまたはパラメーターがデモの想定と異なります。"};

// accuracy
inline constexpr Phrase k_how_accurate{"How accurate is this?", "この計算の精度は？"};
inline constexpr Phrase k_how_accurate_about{
    "Computes the scene as it is now twice beside the window: at its steps, and at half of them or, where "
    "they adapt, at a hundredth of the tolerance",
    "現在の設定のシーンを2回計算して比べる：通常の刻みと、半分の刻み（自動刻みでは100分の1の許容誤差）"};
inline constexpr Phrase k_estimating{"Computing: {0:.0f} %", "計算中：{0:.0f} %"};
inline constexpr Phrase k_estimate_failed{"No estimate: {0}", "精度を評価できません：{0}"};
inline constexpr Phrase k_sure_fall{"{0}: overturns at {1:.3f} s, ± {2:.3f} s.",
                                    "{0}：{1:.3f} s に転倒（誤差 ±{2:.3f} s）。"};
inline constexpr Phrase k_sure_stay{"{0}: does not overturn; peak tilt {1:.2f}°, ± {2:.2f}°.",
                                    "{0}：転倒しない。最大傾斜 {1:.2f}°（誤差 ±{2:.2f}°）。"};
inline constexpr Phrase k_other_course{
    "{0}: does not overturn; peak tilt {1:.2f}°, but it meets the floor {2} times, {3} times when computed "
    "finer: one course of many.",
    "{0}：転倒しない。最大傾斜 {1:.2f}°。ただし床との衝突が {2} 回、刻みを細かくすると {3} "
    "回で、経過は一通りに"
    "定まりません。"};
inline constexpr Phrase k_unsure{
    "{0}: a finer computation takes another course, so whether it overturns stays open.",
    "{0}：刻みを細かくすると経過が変わるため、転倒するかどうかは決められません。"};
inline constexpr Phrase k_estimate_note{
    "Errors of the time stepping alone, of the run from the start with what was set when you asked.",
    "評価を始めたときのパラメーターで開始時から計算した場合の、時間積分による誤差のみを示します。"};

}  // namespace topple::app::window_words
