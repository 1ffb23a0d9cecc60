// What run_warnings() says.
#pragma once

#include "app/support/language.h"

namespace topple::app::warning_words {

inline constexpr Phrase k_went_on{
    "it went on from a recording: peaks, impacts, falls and anchors are counted from {:.3f} s on",
    "記録の途中から計算を続けたため、最大値・衝突・転倒・固定具の力は {:.3f} s 以降のもの"};
inline constexpr Phrase k_sank{
    "body \"{}\" sank to {:.2f} contact widths: the centre line of a member passed that of the floor or "
    "wall; a larger alpha or width holds it",
    "「{}」が接触幅の {:.2f} 倍まで沈み、部材の中心線が床または壁の中心線を越えた（α または幅を大きくす"
    "ると防げる）"};
inline constexpr Phrase k_pinched_member{
    "a member of body \"{}\" came within {:.1e} contact widths of another's centre line; a larger alpha "
    "keeps them apart",
    "「{}」の部材が別の部材の中心線まで接触幅の {:.1e} 倍に近づいた（α を大きくすると離れたままになる）"};
inline constexpr Phrase k_pieces{
    "{} of the {} nodes of \"{}\" fell through the floor or a wall with pieces that broke off: they meet "
    "it at {} points of the body alone; its tilt and slide are means over all",
    "破断した部分とともに、{1}節点中{0}節点が床または壁を突き抜けた（「{2}」。接触するのは本体の{3}点だけ"
    "で、傾斜とすべりは全体の平均）"};
inline constexpr Phrase k_not_stable{
    "from load factor {:.6g} on the equilibrium is not stable: under loads that stay it is left; "
    "run.stop_at = \"instability\" ends the path there",
    "荷重係数 {:.6g} から先の釣り合いは不安定で、荷重が一定なら保てない（run.stop_at = \"instability\" で"
    "そこで終わる）"};
inline constexpr Phrase k_few_elements{
    "member \"{}\" of \"{}\" bears {:.4g} kN on {} elements, {:.1f} in a half wave of the line that "
    "buckles under it: it bends too little, buckles at 10 % more than in theory with 4, at up to 2.3 "
    "times that with 2, with fewer later or not at all; elements = {} is within 2.4 %",
    "部材「{0}」（{1}）は{3}要素で {2:.4g} kN を受け、座屈の半波長に{4:.1f}要素しかないため曲がりにくい（"
    "座屈荷重は半波長に4要素で理論値の 10 % 増、2要素で最大 2.3 倍、それより少ないと座屈しないこともある"
    "。elements = {5} なら 2.4 % 以内）"};
inline constexpr Phrase k_beyond_yield{
    "the stress in body \"{}\", {:.4g} MPa, is beyond yield while the body was elastic, a section bore "
    "{:.3g} of its strength: a real one would bend there and stay bent, this one springs back; model = "
    "\"frame\" lets it yield",
    "「{}」は弾性体のまま {:.4g} MPa となり降伏を超えた（断面は耐力の {:.3g} "
    "倍。実物ならそこで曲がったままになるが、"
    "この計算では元に戻る。model = \"frame\" なら降伏する）"};
inline constexpr Phrase k_beyond_strength{
    "the stress in body \"{}\", {:.4g} MPa, is beyond what its material bears: \"{}\" has no `yield`, and "
    "metals "
    "and wood bear less than a hundredth of Young's modulus, here {:.4g} MPa; with a `yield` it forms hinges",
    "「{}」の応力 {:.4g} MPa は材料「{}」の限度を超えている（`yield` "
    "がなく、金属や木材が耐えるのは弾性係数の1/100、ここでは {:.4g} MPa 未満。`yield` "
    "を与えるとヒンジができる）"};
inline constexpr Phrase k_breaks{
    "{} sections broke in load step {}: when one breaks the path leaps to the next equilibrium, and what "
    "lies between is not seen; more run.load_steps, or run.control by a displacement, may stop there",
    "荷重ステップ {1} で{0}断面が破断した。破断すると次の釣り合いに飛び、その間は見えない（"
    "run.load_steps を増やすか、run.control で変位を制御すると間で止まることがある）"};
inline constexpr Phrase k_longer{"longer", "伸び"}, k_shorter{"shorter", "縮み"};
inline constexpr Phrase k_stretched{
    "element {} of member \"{}\" of \"{}\" became {:.0f} % {}, which no steel does: what is computed "
    "from there on is no prediction; with a fracture_strain of its material it breaks",
    "要素 {}（部材「{}」、{}）が {:.0f} % {}、鋼ではありえない。それ以降の計算は予測にならない（材料に "
    "fracture_strain を与えると破断する）"};
inline constexpr Phrase k_record_step{
    "time_step {:g} ms is longer than the {:g} ms between the samples of a record: what lies between "
    "steps is not seen",
    "時間刻み {:g} ms が地震記録の間隔 {:g} ms より長く、刻みの間の揺れは見えない"};
inline constexpr Phrase k_bounce{
    "a bounce on the contacts takes {:.2g} ms, {:.2g} steps: impacts are not resolved; try a time_step "
    "below {:.2g} ms, or \"auto\"",
    "接触での跳ね返りは {:.2g} ms（{:.2g}ステップ）しかなく、衝突を表せない（時間刻みを {:.2g} ms 未満か "
    "\"auto\" に）"};
inline constexpr Phrase k_chatter{
    "time_step {:g} ms is longer than 2 slip_speed/(friction g) = {:.3g} ms: friction changes sides from "
    "step to step",
    "時間刻み {:g} ms が 2 slip_speed/(μ g) = {:.3g} ms より長く、摩擦の向きが刻みごとに変わる"};
inline constexpr Phrase k_law{
    "law = \"{}\" holds bodies back where they part and lets them sink at rest: verdicts with it mean "
    "nothing; \"coulomb\" and \"paper\" do neither",
    "接触則 \"{}\" は離れるときに引き止め、静止中に沈むため、判定に意味がない（\"coulomb\" と \"paper\" "
    "にはない）"};
inline constexpr Phrase k_try_tolerance{"try a smaller tolerance or a fixed time_step",
                                        "許容誤差を小さくするか、時間刻みを固定するとよい"},
    k_try_fixed_step{
        "try a fixed time_step below the mean one: an explicit integrator's steps follow no tolerance",
        "平均より小さい固定の時間刻みにするとよい（陽解法の刻みは許容誤差によらない）"},
    k_try_step{"try time_step = \"auto\" or a smaller one", "時間刻みを \"auto\" にするか小さくするとよい"},
    k_try_alpha_method{"gamma above 1/2 damps rigid motion too, generalized-alpha does not",
                       "1/2 を超える γ は剛体運動も減衰させる。一般化α法ならしない"};
inline constexpr Phrase k_balance{
    "energy balance error {:.1e} (of the {:.2g} J exchanged) is above {:.0e}; {}",
    "エネルギー収支の誤差 {:.1e}（やりとりした {:.2g} J に対し）が {:.0e} を超えた（{}）"};
inline constexpr Phrase k_got{"got", "得た"}, k_lost{"lost", "失った"};
inline constexpr Phrase k_switched{
    "bodies that changed their model {} {:.3g} J, {:.0f} % of the largest energy exchanged; model = "
    "\"frame\" follows them through it",
    "モデルが切り替わった家具がエネルギーを{}（{:.3g} J、やりとりの最大値の {:.0f} %。model = \"frame\" "
    "なら切り替わらない）"};
inline constexpr Phrase k_took{"took", "奪った"}, k_gave{"gave", "与えた"};
inline constexpr Phrase k_numerical{
    "the time integration {} {:.3g} J, {:.0f} % of the largest energy exchanged; {}",
    "時間積分がエネルギーを{}（{:.3g} J、やりとりの最大値の {:.0f} %）。{}"};
inline constexpr Phrase k_too_fast{
    "shake {} of {:.4g} Hz is too fast for rows at {:.4g} Hz: the floor is drawn and exported as another "
    "motion; run.output_rate = \"{:.4g} Hz\" follows it",
    "加振 {} の {:.4g} Hz は出力間隔 {:.4g} Hz には速すぎ、床が別の動きとして描かれる（run.output_rate = "
    "\"{:.4g} Hz\" なら追える）"};
inline constexpr Phrase k_too_strong{
    "shake {} has {:.4g} gal, {:.3g} times gravity; a number without a unit is in m/s^2",
    "加振 {} は {:.4g} gal で重力の {:.3g} 倍（単位のない数値は m/s²）"};
inline constexpr Phrase k_soft{
    "contact.alpha = {:.4g} kgf is soft: under a steady push a body lifts a side, and may tip, at up to "
    "{:.0f} % less acceleration than on a rigid floor, in a shake at still less",
    "α = {:.4g} kgf は軟らかく、一定の力で押すと剛な床より最大 {:.0f} % 小さい加速度で片側が浮き、転倒し"
    "うる（揺れではさらに小さい加速度で）"};

}  // namespace topple::app::warning_words
