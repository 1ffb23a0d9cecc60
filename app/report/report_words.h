// Every sentence of the report page, in its languages: one table.
#pragma once

#include <utility>

#include "app/support/language.h"
#include "solver/model/parameters.h"

namespace topple::app {

namespace words {

inline constexpr Phrase k_report{"Report on the tipping of furniture", "家具の転倒に関する解析報告書"};
inline constexpr Phrase k_origin{"scene {0} · topple {1}", "シーン {0} · topple {1}"};

// what it comes to
inline constexpr Phrase k_result{"Result", "結果の要約"};
inline constexpr Phrase k_falls{"“{0}” overturns {1} s after the start of the run.",
                                "「{0}」が計算開始から{1}秒後に転倒する。"};
inline constexpr Phrase k_many_fall{
    "{0} of {1} bodies overturn; the first is “{2}”, {3} s after the start of the run.",
    "{1}体のうち{0}体が転倒する。最初は「{2}」で、計算開始から{3}秒後。"};
inline constexpr Phrase k_nothing_falls{
    "Nothing overturns. “{0}” comes nearest to it: it tilts by {1}° of the {2}° at which it would.",
    "転倒する家具はない。最も転倒に近いのは「{0}」で、最大傾斜角{1}°（転倒限界角 {2}°）。"};
inline constexpr Phrase k_nothing_falls_held{
    "Nothing overturns. “{0}” comes nearest to it: it tilts by {1}°; without what holds it, it would "
    "overturn "
    "from {2}° on.",
    "転倒する家具はない。最も転倒に近いのは「{0}」で、最大傾斜角{1}°（固定しない場合の転倒限界角 {2}°）。"};
inline constexpr Phrase k_nothing_stays_over{
    "Nothing overturns. “{0}” comes nearest to it: it tilts by {1}°, beyond the {2}° at which it would "
    "alone, and comes back.",
    "転倒する家具はない。最も転倒に近いのは「{0}」で、最大傾斜角{1}°"
    "（単独での転倒限界角 {2}°を超えて戻る）。"};
inline constexpr Phrase k_error_reaches{
    "The numerical error of that, ±{0}°, is greater than what was left: the verdict is not certain.",
    "数値誤差（±{0}°）は余裕より大きく、この判定は確かではない。"};
inline constexpr Phrase k_nothing_falls_far{"Nothing overturns. “{0}” tilts most, by {1}°.",
                                            "転倒する家具はない。最も大きく傾くのは「{0}」で、最大{1}°。"};
inline constexpr Phrase k_is_hit{"“{0}” is hit by “{1}” after {2} s.", "「{0}」に{2}秒で「{1}」が当たる。"};
inline constexpr Phrase k_is_shut_in{"“{0}” has no way out any more: {1}.",
                                     "「{0}」から扉まで通れなくなる（{1}）。"};
inline constexpr Phrase k_is_caught{"“{0}” cannot leave: blocked where they are by {1}.",
                                    "「{0}」の居場所に{1}がかかり、動けない。"};
inline constexpr Phrase k_ways_stay{"Every place keeps a way out; the narrowest is {0} m wide, from “{1}”.",
                                    "どの場所からも出口まで通れる（最も狭い経路は「{1}」から、幅 {0} m）。"};
inline constexpr Phrase k_until{
    "All on this page is until {0} s, where the scene's condition stopped the run; what comes later is not "
    "known.",
    "この報告書の結果は、シーンの条件により計算が終了した{0}秒までのもの（その後は不明）。"};
inline constexpr Phrase k_live_page{"Live page: change the shake or the furniture, and see what falls",
                                    "条件を変えて計算できるページ"};
inline constexpr Phrase k_replay_page{"Page that replays this run", "この計算結果を再生するページ"};
inline constexpr Phrase k_others_stay{"Not overturned: {0} of {1} bodies.", "{1}体のうち{0}体は転倒しない。"};
inline constexpr Phrase k_sensitive{
    "The outcome turns on small differences in the shaking: read the probabilities in section {0}, not the "
    "single run.",
    "この結果は揺れのわずかな違いで変わる。1回の計算結果ではなく、第{0}節の確率で判断すること。"};
inline constexpr Phrase k_open{
    "A finer computation takes another course (section {0}): this one run does not settle when, or whether, "
    "“{1}” falls.",
    "計算の刻みを細かくすると経過が変わる（第{0}節）。「{1}」については1回の計算結果だけでは判断できない。"};
inline constexpr Phrase k_not_validated{
    "Not validated against experiment. The program is checked against theory and published numbers "
    "(topple verify); no shaking-table test stands behind this page.",
    "実験による妥当性確認は行っていない。プログラムは理論解および公表値と照合している（topple "
    "verify）が、この報告書の結果を裏付ける振動台実験はない。"};
inline constexpr Phrase k_figure_overturned{"bodies overturned", "転倒する家具"};
inline constexpr Phrase k_of{"{0} of {1}", "{0}/{1}体"};
inline constexpr Phrase k_first_fall{"first overturning", "最初の転倒"};
inline constexpr Phrase k_greatest_tilt{"greatest tilt", "最大傾斜角"};
inline constexpr Phrase k_tilt_of_nearest{"tilt of what comes nearest to overturning",
                                          "最も転倒に近い家具の傾斜角"};
inline constexpr Phrase k_peak_floor{"peak floor acceleration", "床の最大加速度"};
inline constexpr Phrase k_degree_figure{"JMA {0}", "震度{0}相当"};
inline constexpr Phrase k_instrumental{"intensity of the floor motion, instrumental {0}",
                                       "床の揺れの計測震度相当値 {0}"};

// the floor
inline constexpr Phrase k_floor{"How the floor shakes", "床の揺れ"};
inline constexpr Phrase k_no_shake{"The floor does not shake. The bodies move from how they are let go.",
                                   "床は揺れない。家具は初期状態から動き始める。"};
inline constexpr Phrase k_sine{"Sine of {0} Hz, {1} gal, along {2}, from {3} s, {4}",
                               "正弦波 {0} Hz、{1} gal、方向 {2}、{3}秒から、{4}"};
inline constexpr Phrase k_cycles{"{0} cycles", "{0}波"};
inline constexpr Phrase k_endless{"until the end of the run", "計算終了まで"};
inline constexpr Phrase k_sweep{"Sweep from {0} to {1} Hz, {2} gal, along {3}, from {4} s for {5} s",
                                "スイープ波 {0}～{1} Hz、{2} gal、方向 {3}、{4}秒から{5}秒間"};
inline constexpr Phrase k_pulse{"{0} pulse, {1} gal, along {2}, from {3} s for {4} s",
                                "{0}パルス、{1} gal、方向 {2}、{3}秒から{4}秒間"};
/// Shapes of pulses that have a name besides their word.
inline constexpr std::pair<Shake::Shape, Phrase> k_shapes[] = {
    {Shake::Shape::half_sine, {"Half-sine", "半正弦波"}},
    {Shake::Shape::full_sine, {"Full-sine", "1周期正弦波"}},
    {Shake::Shape::rectangle, {"Rectangular", "矩形"}},
};
inline constexpr Phrase k_record{"Record of {0} s, components: {1}, peak {2} gal (scale {3}), from {4} s",
                                 "加速度記録 {0}秒、{1}成分、最大 {2} gal（倍率 {3}）、{4}秒から"};
inline constexpr Phrase k_in_building{
    "; on floor {0} of {1} of a building of period {2} s and damping {3}, whose ground moves like that",
    "。地動として、固有周期{2}秒、減衰定数{3}の建物（{1}層）の{0}層目の床に入力"};
inline constexpr Phrase k_in_modes{
    "; on a floor of a building of {0} modes, the longest of {1} s, whose ground moves like that",
    "。地動として、{0}個のモード（最長周期{1}秒）をもつ建物の床に入力"};
inline constexpr Phrase k_jump{
    "The floor starts with a jump of velocity, which the chart and the intensity do not contain.",
    "床は初速度（速度の跳び）をもって動き始める。図と計測震度相当値にはこの跳びを含まない。"};
inline constexpr Phrase k_floor_chart{
    "Figure {0}: acceleration of the floor. x: depth of a cabinet at yaw 0; z: up.",
    "図{0}：床の加速度。xは向き0°のキャビネットの奥行方向、zは鉛直上向き。"};
inline constexpr Phrase k_time{"time, s", "時間 [s]"};
inline constexpr Phrase k_gal_along{"{0}, gal", "{0} [gal]"};
inline constexpr Phrase k_peak_along{"peak acceleration along {0}", "{0}方向の最大加速度"};
inline constexpr Phrase k_peak_vector{"peak acceleration, components together", "最大加速度（成分合成）"};
inline constexpr Phrase k_a_value{"a: filtered acceleration reached for 0.3 s in all",
                                  "a：フィルター後の合成加速度が合計0.3秒以上となる値"};
inline constexpr Phrase k_i_value{"instrumental intensity I = 2 log₁₀ a + 0.94",
                                  "計測震度相当値 I = 2 log₁₀ a + 0.94"};
inline constexpr Phrase k_degree{"degree of the JMA scale", "気象庁震度階級（相当）"};
inline constexpr Phrase k_intensity_note{
    "Intensity by the procedure of the Japan Meteorological Agency (three components filtered in the "
    "frequency "
    "domain, added as vectors; two decimals rounded, then cut to one), from the floor motion of the scene "
    "between 0 and {0} "
    "s. The agency states intensities of the ground; this one is of the floor that the furniture stands on.",
    "気象庁の計測震度算出方法（"
    "3成分を周波数領域でフィルター処理し、ベクトル合成。小数第3位を四捨五入し、小数第2位を切り捨て）を"
    "、シーンの床の動き（0～{0}秒）"
    "に適用した値。気象庁の震度は地表などの観測値であり、ここでは家具が立つ床の揺れに対する相当値を示す。"};

// what falls
inline constexpr Phrase k_falling{"What falls, and when", "何が、いつ転倒するか"};
inline constexpr Phrase k_body{"body", "家具"};
inline constexpr Phrase k_verdict{"verdict", "判定"};
inline constexpr Phrase k_overturns{"● overturns", "● 転倒"};
inline constexpr Phrase k_stays{"○ stays", "○ 転倒せず"};
inline constexpr Phrase k_comes_back{"○ leans over, comes back", "○ 傾いて戻る"};
inline constexpr Phrase k_overturn_time{"overturns at, s", "転倒時刻 [s]"};
inline constexpr Phrase k_uplift{"first uplift, s", "最初の浮上り [s]"};
inline constexpr Phrase k_impacts{"impacts", "衝突回数"};
inline constexpr Phrase k_tilt{"peak tilt, °", "最大傾斜角 [°]"};
inline constexpr Phrase k_critical{"critical angle, °", "転倒限界角 [°]"};
inline constexpr Phrase k_slide{"base moved, mm", "底面中心の移動 [mm]"};
inline constexpr Phrase k_stress{"peak stress, MPa", "最大応力 [MPa]"};
inline constexpr Phrase k_table_note{
    "Overturns: the tilt passes the critical angle (centre of gravity, with what stands on the body, above "
    "the edge of the base) for good "
    "before the run ends; its column tells that of the direction in which the body leaned when it came "
    "nearest "
    "to it, which may be another instant than that of the peak tilt; an edge's where it leaned across one, "
    "and "
    "the nearest edge's of a body that leaned by less than {1}°. "
    "Base moved: the middle of the base along the floor or the piece that it stands on, at most; of what "
    "tips it grows with the tilt, too. Uplift: one "
    "side of the base "
    "carries less than "
    "{0} % of the weight while it turns by {1}° or more, and an impact ends it. ±: stated error of the time "
    "integration alone, section {2}.",
    "転倒：傾斜角が転倒限界角（載っている物を含めた重心が底面の縁の真上に来る角度）を超え、計算終了まで戻らな"
    "いこと。限界角は、それに最も"
    "近づいた時刻に傾いていた側の値（最大傾斜角の時刻とは異なることがある。傾斜角が{1}"
    "°未満の場合は最も近い縁の値）。底面中心の移動："
    "床または載っている家具に沿った底面中央の移動量の最大値（傾くと、傾斜によっても増える）。"
    "浮上り：底面の一辺が支える力が重量の{0} %を下回り、{1}°以上回転すること。衝突はその終わり。"
    "±は時間積分のみの推定誤差（第{2}節）。"};
inline constexpr Phrase k_stress_note{
    "Stresses are elastic: the scene's material does not yield, so that impacts reach values at which a real "
    "one would flow or break.",
    "応力は弾性計算による値である。シーンの材料は降伏しないため、衝突時には実際の材料なら降伏または破壊する値"
    "になることがある。"};
inline constexpr Phrase k_flow_note{
    "Plastic hinges formed: of a section that flows the stress is told as if it were elastic, N/A + M/W, and "
    "may be "
    "above yield, of a solid bar 1.5 times.",
    "塑性ヒンジができた。降伏した断面の応力は弾性とみなした N/A + M/W の値で、降伏応力を超えることがある（"
    "中実断面では 1.5 倍まで）。"};
inline constexpr Phrase k_tilt_chart{"Figure {0}: tilt of the bodies.{1} Diamond: overturned from here on.",
                                     "図{0}：家具の傾斜角。{1}◇：この時刻以降、転倒。"};
inline constexpr Phrase k_tilt_chart_standing{"Figure {0}: tilt of the bodies.{1}",
                                              "図{0}：家具の傾斜角。{1}"};
inline constexpr Phrase k_most_tilted_only{" The {0} that tilt most.", "最大傾斜角の大きい{0}体。"};
inline constexpr Phrase k_tilt_axis{"tilt, °", "傾斜角 [°]"};
inline constexpr Phrase k_critical_level{"critical angle {0}°", "転倒限界角 {0}°"};
inline constexpr Phrase k_pictures{
    "Figure {0}: key instants. Floor grid: 1 m bold, 0.1 m fine. Deformations to scale.",
    "図{0}：主な時点の状態。床の格子は太線1 m、細線0.1 m。変形は実寸。"};
inline constexpr Phrase k_at_start{"Start, {0} s", "開始 {0}秒"};
inline constexpr Phrase k_at_fall{"{0} s: “{1}” is falling, tilt {2}°", "{0}秒：「{1}」が転倒中、傾斜角{2}°"};
inline constexpr Phrase k_at_most{"{0} s, about when it tilts most: “{1}”, {2}°",
                                  "{0}秒：「{1}」の傾斜角が最大になる頃、{2}°"};
inline constexpr Phrase k_at_end{"End, {0} s", "終了 {0}秒"};

// ways out
inline constexpr Phrase k_ways{"The way out", "避難経路"};
inline constexpr Phrase k_ways_text{
    "For each place whether a person, a disc {0} m wide, still reaches a door at the end of the run. What "
    "lies "
    "higher than {1} m is walked under; pieces are taken as their convex outline in plan. The width is that "
    "of "
    "the widest disc that passes, at most the door's; the length is that of the shortest way of a person. "
    "Hit "
    "is who has a piece overlap the disc below {2} m, even if only for a moment.",
    "各位置の人（直径{0} "
    "mの円で表す）が計算終了時に出口まで到達できるかを示す。高さ{1} "
    "mより上にある物の下は通れるものとし、家具は平面上の凸包で表す。通路幅は通過できる最大の円の直径（扉の幅"
    "以下）、長さは人の最短経路の長さである。高さ{2} "
    "mより下で家具が一度でも円に重なった人を「家具が当たる」とする。"};
inline constexpr Phrase k_place{"place", "位置"};
inline constexpr Phrase k_way{"way", "経路"};
inline constexpr Phrase k_door{"door", "扉"};
inline constexpr Phrase k_wide_before{"width before, m", "揺れる前の幅 [m]"};
inline constexpr Phrase k_wide{"width after, m", "揺れた後の幅 [m]"};
inline constexpr Phrase k_long{"length, m", "長さ [m]"};
inline constexpr Phrase k_blocked_by{"blocked by", "塞ぐ家具"};
inline constexpr Phrase k_hit_by{"hit by", "当たる家具"};
inline constexpr Phrase k_hit_at{"{0} ({1} s)", "{0}（{1}秒）"};
inline constexpr Phrase k_open_way{"open", "通れる"};
inline constexpr Phrase k_no_way{"closed", "通れない"};
inline constexpr Phrase k_open_in{"way out open in", "出口まで通れる"};
inline constexpr Phrase k_broke_in{"broke in", "破断した計算"};
inline constexpr Phrase k_plan_figure{"Figure {0}: the room in plan at the end of the run, to scale.",
                                      "図{0}：計算終了時の部屋の平面図（縮尺どおり）。"};
inline constexpr Phrase k_key_fallen{"overturned, as it is at the end", "転倒した家具（終了時）"};
inline constexpr Phrase k_key_standing{"standing, at the end", "立っている家具（終了時）"};
inline constexpr Phrase k_key_start{"where it stood before", "揺れる前の位置"};
inline constexpr Phrase k_key_way_before{"way before", "揺れる前の経路"};
inline constexpr Phrase k_key_way{"way after", "揺れた後の経路"};
inline constexpr Phrase k_key_shut{"no way out", "出られない人"};
inline constexpr Phrase k_key_hit{"hit", "家具が当たる人"};
inline constexpr Phrase k_open_sides{
    "Where the scene has no wall the room is open: people walk there, but leave by doors only.",
    "壁のない側は開いているものとする。そこを歩くことはできるが、出るのは扉からに限る。"};

// anchors
inline constexpr Phrase k_anchors{"With and without anchors", "固定具の有無による違い"};
inline constexpr Phrase k_anchors_away{"Anchors, none of them in place", "固定具（すべて取り外した状態）"};
inline constexpr Phrase k_lifted_by{"floor, {0} mm higher", "床（{0} mm 高い）"};
inline constexpr Phrase k_anchors_text{"The same run with all of them removed:",
                                       "すべて取り外した場合との比較を示す。"};
inline constexpr Phrase k_holding_breaks{"What holds the furniture does not last: {0}.",
                                         "固定具が破断する：{0}。"};
inline constexpr Phrase k_one_breaks{"{0} breaks at {1} s", "{0}（{1}秒）"};
inline constexpr Phrase k_anchor_name{"fixing", "固定具"};
inline constexpr Phrase k_anchor_of{"body", "家具"};
inline constexpr Phrase k_anchor_to{"tied to", "取付先"};
inline constexpr Phrase k_anchor_kind{"kind", "種類"};
inline constexpr Phrase k_anchor_stiffness{"stiffness, kN/m", "剛性 kN/m"};
inline constexpr Phrase k_anchor_strength{"strength, N", "強度 N"};
inline constexpr Phrase k_anchor_peak{"greatest force, N", "最大力 N"};
inline constexpr Phrase k_anchor_share{"of its strength", "強度比"};
inline constexpr Phrase k_anchor_broke{"breaks at {0} s", "{0}秒で破断"};
inline constexpr Phrase k_anchor_away{"not in place", "取り外し"};
inline constexpr Phrase k_anchor_frame{"wall, floor or ceiling", "壁・床・天井"};
inline constexpr Phrase k_assumed_fixings{
    "Fixings by name have the stiffness and strength that the scene gives; where it gives none, assumed ones "
    "that stand "
    "for no product.",
    "名称で指定した固定具の剛性と強度は、入力にあればその値、なければ仮定値であり、特定の製品を表すものではな"
    "い。"};
inline constexpr Phrase k_unheld_differ{
    "Nothing holds {0}: what differs there comes of knocks by what they hold, or of small differences that "
    "grow; the "
    "probabilities tell more.",
    "{0}は固定されていない。この違いは、固定された家具との衝突か、成長したわずかな差によるものであり、"
    "確率の方が信頼できる。"};
inline constexpr Phrase k_with{"with anchors", "固定あり"};
inline constexpr Phrase k_without{"without anchors", "固定なし"};
inline constexpr Phrase k_without_failed{"The run without anchors failed: {0}",
                                         "固定なしの計算は失敗した：{0}"};

// how certain
inline constexpr Phrase k_certain{"How certain this is", "結果の確かさ"};
inline constexpr Phrase k_probability{"Probability of overturning for shaking within ±{0} %",
                                      "入力±{0} %の範囲での転倒確率"};
inline constexpr Phrase k_probability_text{
    "The run was repeated {0} times with the floor motion multiplied by evenly spaced factors from {1} to "
    "{2}. After several "
    "impacts a rocking body may follow one path or another on the slightest difference; the share of runs in "
    "which it "
    "overturns is then what can be relied on.",
    "床の揺れに{1}から{2}までの等間隔の倍率を掛け、計算を{0}"
    "回繰り返した。衝突を何度か経たロッキングはわずかな違いで挙動が分かれるため、"
    "1回の軌跡ではなく、転倒した計算の割合が信頼できる指標となる。"};
inline constexpr Phrase k_runs_failed{
    "{0} of {1} runs failed and are left out: with the input times {2}. A run of the scene with it says why.",
    "{1}回のうち{0}回（入力{2}倍）は計算が失敗したため除外した。その倍率で計算すると理由が示される。"};
inline constexpr Phrase k_overturned_in{"overturned in", "転倒した計算"};
inline constexpr Phrase k_runs{"{0} of {1} runs", "{1}回中{0}回"};
inline constexpr Phrase k_share{"share", "割合"};
inline constexpr Phrase k_interval{"95 % interval (Wilson)", "95 %信頼区間（Wilson法）"};
inline constexpr Phrase k_interval_note{
    "Wilson's score interval for a proportion. It takes the runs as random draws, which evenly spaced "
    "factors are "
    "not strictly: read it as the order of the uncertainty.",
    "Wilsonのスコア区間。各計算を無作為抽出とみなしており、等間隔の倍率では厳密には成り立たない。不確かさの目"
    "安として読むこと。"};
inline constexpr Phrase k_dots{"Figure {0}: each run. Filled: overturns; open: stays.",
                               "図{0}：各計算の結果。●：転倒、○：転倒せず。"};
inline constexpr Phrase k_factor{"factor on the floor motion", "床の揺れの倍率"};
inline constexpr Phrase k_fragility{"Fragility over the floor's peak acceleration",
                                    "床の最大加速度に対するフラジリティ"};
inline constexpr Phrase k_fragility_text{
    "{0} runs of motion alone, as planar blocks, at {1} levels of the peak acceleration from {2} to {3} gal, "
    "the motion scaled "
    "to "
    "each. Varied from run to run: {4}. Sliding counts from {5} mm on. A lognormal distribution is fitted; "
    "its "
    "median is the peak acceleration at which the chance is one half, β the standard deviation of its "
    "logarithm.",
    "揺れを最大加速度 {2}～{3} gal の {1} 段階に合わせ、運動だけを平面剛体ブロックとして計 {0} "
    "回計算した。計算ごとに変えたもの：{4}。{5} mm "
    "を超える移動を滑りとする。対数正規分布を当てはめた。中央値は確率が1/"
    "2となる最大加速度、βは対数標準偏差である"
    "。"};
inline constexpr Phrase k_state{"state", "状態"};
inline constexpr Phrase k_state_uplift{"lifts a side", "浮き上がり"};
inline constexpr Phrase k_state_slide{"slides", "滑り"};
inline constexpr Phrase k_state_overturn{"overturns", "転倒"};
inline constexpr Phrase k_any_body{"any body", "いずれかの家具"};
inline constexpr Phrase k_median{"median, gal", "中央値 [gal]"};
inline constexpr Phrase k_median_interval{"95 % interval, gal", "95 %信頼区間 [gal]"};
inline constexpr Phrase k_in_no_run{"in no run", "該当なし"};
inline constexpr Phrase k_jumps{"a step within", "急変"};
inline constexpr Phrase k_rises_and_falls{"rises and falls within", "増減する範囲"};
inline constexpr Phrase k_no_curve{"no curve", "当てはめ不可"};
inline constexpr Phrase k_of_west{"West, gal", "West [gal]"};
inline constexpr Phrase k_of_ishiyama{"Ishiyama, gal", "石山 [gal]"};
inline constexpr Phrase k_of_evaluation{"A_R50, gal", "A_R50 [gal]"};
inline constexpr Phrase k_corner{"corner frequency, Hz", "境界振動数 [Hz]"};
inline constexpr Phrase k_criteria_note{
    "West: lifts above it. Ishiyama: below it does not overturn. A_R50: half overturn by the Japanese "
    "evaluation, "
    "by velocity above the corner frequency. Peak acceleration over 2π times peak velocity of this motion: "
    "{0} Hz.",
    "West：超えると浮き上がる。石山：下回れば転倒しない。A_R50："
    "日本の評価法で半数が転倒する加速度（境界振動数を超えると速度で評価）。この揺れの最大加速度と最大速度の比"
    "から求"
    "めた振動数：{0} Hz。"};
inline constexpr Phrase k_peak_acceleration{"peak acceleration of the floor, gal", "床の最大加速度 [gal]"};
inline constexpr Phrase k_chance{"probability", "確率"};
inline constexpr Phrase k_fragility_figure{"Figure {0}: fitted probability over the peak acceleration, {1}.",
                                           "図{0}：最大加速度に対する確率の当てはめ（{1}）。"};
inline constexpr Phrase k_no_probability{
    "The floor does not shake, so there is no input to vary; no probability is given.",
    "床が揺れないため、変化させる入力がなく、確率は求めない。"};
inline constexpr Phrase k_error{"Numerical error", "数値誤差"};
inline constexpr Phrase k_halved{"half the step ({0} ms, and half the parts of rigid and elastic bodies)",
                                 "半分の時間刻み（{0} ms。剛体・弾性体の内部刻みも半分）"};
inline constexpr Phrase k_tightened{
    "a hundredth of the tolerance ({0}, and a quarter of the parts of rigid and elastic bodies)",
    "100分の1の許容誤差（{0}。剛体・弾性体の内部刻みは4分の1）"};
inline constexpr Phrase k_error_text{
    "The run was repeated with {0}. The stated error, ± in section {1} and of the greatest forces of "
    "fixings, is {2} times the difference between "
    "the two: "
    "the error of a method of first order, to which contacts that open and close bring any. It is an "
    "estimate of the time "
    "stepping alone, not of the model. None is stated for the stress of what fell and the forces on it, nor "
    "for the stress of a frame that lands in long fixed steps: a blow follows no order; nor for forces on a "
    "rigid body: that it does not bend decides more.",
    "計算を{0}で繰り返した。第{1}節と固定具の最大力の±は両者の差の{2}倍である（"
    "接触の開閉があると、どの解法も1次精度となるため）。"
    "これは時間積分の誤差の推定であり、モデル化の誤差を含まない。"
    "転倒した家具の応力とその固定具の力、長い固定刻みのまま着地した骨組の応力の誤差は示さない"
    "（衝突時の誤差には次数がないため）。剛体の固定具の力の誤差も示さない（曲がらないことの影響の方が大きいた"
    "め）。"};
inline constexpr Phrase k_error_open{"The two runs part, so no number can be given for it: {0}.",
                                     "両者の経過が異なるため、誤差を数値で示すことはできない：{0}。"};
inline constexpr Phrase k_open_falls{"“{0}” overturns at {1} s, but stays standing in the finer run",
                                     "「{0}」は{1}秒で転倒するが、細かい計算では転倒しない"};
inline constexpr Phrase k_open_impacts{
    "“{0}” overturns at {1} s after another number of impacts than in the finer run",
    "「{0}」は{1}秒で転倒するが、それまでの衝突回数が細かい計算と異なる"};
inline constexpr Phrase k_open_stays{"“{0}” stays standing, but overturns in the finer run",
                                     "「{0}」は転倒しないが、細かい計算では転倒する"};
inline constexpr Phrase k_error_parted{
    "{0}: one course of many, of whose peaks the stated errors tell little.",
    "{0}：経過は一通りに定まらず、最大値の誤差は目安にすぎない。"};
inline constexpr Phrase k_error_failed{"The finer run failed ({0}); the error is not known.",
                                       "細かい計算が失敗したため（{0}）、誤差は不明である。"};
inline constexpr Phrase k_balance{"Energy that nothing explains: {0} % of the largest energy exchanged.",
                                  "説明のつかないエネルギー：交換された最大エネルギーの{0} %。"};
inline constexpr Phrase k_warnings{"The program warns:", "プログラムの警告（英語）："};
inline constexpr Phrase k_warnings_without{"The program warns of the run without anchors:",
                                           "固定なしの計算に対するプログラムの警告（英語）："};

// assumptions
inline constexpr Phrase k_assumptions{"What the model assumes", "モデルの仮定"};
inline constexpr Phrase k_as_given{
    "Sizes, masses, centres of gravity and materials are those of the scene file, taken as given; nothing of "
    "them is measured or "
    "checked here.",
    "寸法・質量・重心・材料はシーンファイルの値をそのまま用いた。実測や確認は行っていない。"};
inline constexpr Phrase k_contents{
    "Contents do not move; doors and drawers stay shut; casters and carpets are not modelled.",
    "収納物は動かず、扉・引き出しは閉じたままとする。脚、キャスター、カーペット、マットは考慮しない。"};
inline constexpr Phrase k_rigid_floor{
    "Floor and walls are rigid planes that move together; the furniture does not act back on the building.",
    "床と壁は一体に動く剛な平面とし、家具から建物への影響は考慮しない。"};
inline constexpr Phrase k_beam_floor{
    "Floor or walls of beams bend; their ends move with the building, on which the furniture does not act "
    "back.",
    "梁でモデル化した床・壁は変形する。その端部は建物とともに動き、家具から建物への影響は考慮しない。"};
inline constexpr Phrase k_rigid_friction{
    "Contact of a planar block is rigid: a landing leaves the angular rate that angular momentum about the "
    "new "
    "edge gives (Housner), times the restitution of the piece; one coefficient of friction holds at all "
    "speeds, {0}.",
    "面内ブロックの接触は剛とする。着地後の角速度は新しい辺まわりの角運動量（Housner）から求めた値に家具の反"
    "発係数を"
    "乗じ、摩擦係数は速度によらず一定（{0}）とする。"};
inline constexpr Phrase k_friction{
    "Contact is a spring against penetration with one coefficient of friction at all speeds, {0}.",
    "接触は貫入に抵抗するばねで表し、摩擦係数は速度によらず一定（{0}）とする。"};
inline constexpr Phrase k_frames_elastic{"The material does not yield or break.",
                                         "材料は降伏も破断もしない。"};
inline constexpr Phrase k_frames_plastic{
    "Members whose material has a yield stress yield as perfectly plastic hinges at the ends of their "
    "elements{0}.",
    "降伏応力をもつ材料の部材は、要素端の完全塑性ヒンジとして降伏する{0}。"};
inline constexpr Phrase k_frames_break{" and may break", "（破断を含む）"};
inline constexpr Phrase k_no_anchors{
    "No anchor, strap or pole holds the furniture: the scene has none in place.",
    "家具を固定するもの（ベルト、金具、突っ張り棒など）はない。"};
inline constexpr Phrase k_ends{
    "What would happen after {0} s is not seen. People and objects that the scene does not name are absent.",
    "{0}秒より後に起こることは計算していない。シーンにない人や物は存在しない。"};

// settings
inline constexpr Phrase k_settings{"Settings of the computation", "計算条件"};
inline constexpr Phrase k_simulated{"simulated time", "計算した時間"};
inline constexpr Phrase k_stopped{"{0} s (stopped by the scene's condition)",
                                  "{0} s（シーンの条件により終了）"};
inline constexpr Phrase k_integrator{"time integration", "時間積分法"};
inline constexpr Phrase k_of_models{"{0} ({1})", "{0}（{1}）"};
inline constexpr Phrase k_model_from{"from {1} s {0} ({2})", "{1} s から{0}（{2}）"};
inline constexpr Phrase k_model_times{"from {1} s {3} times {0} ({2})", "{1} s から{3}回{0}（{2}）"};
inline constexpr Phrase k_step{"time step", "時間刻み"};
inline constexpr Phrase k_steps{"{0} steps, {1} rejected", "{0}ステップ、棄却{1}"};
inline constexpr Phrase k_adaptive{"adaptive, tolerance {0}, mean {1} ms", "可変、許容誤差 {0}、平均 {1} ms"};
inline constexpr Phrase k_contact{"contact law", "接触則"};
inline constexpr Phrase k_no_springs{"{0}, rigid: a planar block has no springs",
                                     "{0}（剛。面内ブロックにはばねがない）"};
inline constexpr Phrase k_alpha{"penalty coefficient α", "ペナルティ係数 α"};
inline constexpr Phrase k_member_share{"share of α between members", "部材間での α の割合"};
inline constexpr Phrase k_q{"penalty index q", "ペナルティ指数 q"};
inline constexpr Phrase k_mu{"friction coefficient μ", "摩擦係数 μ"};
inline constexpr Phrase k_restitution{"restitution", "反発係数"};
inline constexpr Phrase k_normal_speed{"normal speed of the contact law", "接触則の法線速度"};
inline constexpr Phrase k_gravity{"gravity", "重力加速度"};
inline constexpr Phrase k_bodies{"{0}: mass, computed as", "{0}：質量、計算モデル"};
inline constexpr Phrase k_more_bodies{"{0} further bodies", "ほか{0}体"};
inline constexpr Phrase k_rigid{"rigid body", "剛体"};
inline constexpr Phrase k_planar{"rigid block in a vertical plane, exact between its events",
                                 "鉛直面内の剛体（事象間は厳密）"};
inline constexpr Phrase k_elastic{"rigid motion with elastic modes", "剛体運動+弾性モード"};
inline constexpr Phrase k_frame{"frame of beam elements (ASI-Gauss family)", "はり要素骨組（ASI-Gauss系）"};
inline constexpr Phrase k_overrides{"changed from the scene file", "シーンファイルからの変更"};
inline constexpr Phrase k_version{"program", "プログラム"};
inline constexpr Phrase k_repeat{"Made by {0}", "作成コマンド：{0}"};

// degrees of the JMA scale
inline constexpr Phrase k_degrees_of_intensity[] = {
    {"0", "0"},         {"1", "1"},         {"2", "2"},         {"3", "3"},         {"4", "4"},
    {"5-lower", "5弱"}, {"5-upper", "5強"}, {"6-lower", "6弱"}, {"6-upper", "6強"}, {"7", "7"}};

}  // namespace words
}  // namespace topple::app
