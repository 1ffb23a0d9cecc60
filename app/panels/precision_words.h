// Texts of the chart of error against cost.
#pragma once

#include "app/picture/window_words.h"
#include "solver/study/precision/precision.h"

namespace topple::app::window_words {

inline constexpr Phrase k_precision{"Error against cost", "誤差と計算時間"};
inline constexpr Phrase k_precision_about{
    "Computes the scene as it is now with other integrators, steps and models\nbeside the window, and draws "
    "error against CPU time",
    "現在の設定のシーンを、ほかの積分法・時間刻み・計算モデルで計算し、\n誤差と CPU 時間の関係を描く"};
inline constexpr Phrase k_error_of{"error of", "誤差"};

template <class Kind>
struct Named {
  Kind kind;
  Phrase name;
};
inline constexpr Named<study::Measure> k_measures[] = {
    {study::Measure::tilt, {"tilt, rms over the critical angle", "傾斜（限界角に対する二乗平均）"}},
    {study::Measure::overturn_time, {"time of overturning", "転倒時刻"}},
    {study::Measure::peak_stress, {"peak stress", "最大応力"}},
    {study::Measure::energy, {"energy balance", "エネルギー収支"}}};
inline constexpr Named<study::Method> k_methods[] = {
    {study::Method::scene, {"the scene's own", "シーンの設定"}},
    {study::Method::rigid, {"rigid", "剛体"}},
    {study::Method::rigid_auto, {"rigid, by tolerance", "剛体（許容誤差）"}},
    {study::Method::elastic, {"elastic", "弾性"}},
    {study::Method::elastic_auto, {"elastic, by tolerance", "弾性（許容誤差）"}},
    {study::Method::generalized_alpha, {"frame, generalized-α", "骨組・一般化α法"}},
    {study::Method::generalized_alpha_auto,
     {"frame, generalized-α, by tolerance", "骨組・一般化α法（許容誤差）"}},
    {study::Method::newmark, {"frame, Newmark 1/4, 1/2", "骨組・Newmark 1/4, 1/2"}},
    {study::Method::newmark_damped, {"frame, Newmark 4/9, 5/6", "骨組・Newmark 4/9, 5/6"}},
    {study::Method::central_difference, {"frame, central differences", "骨組・中央差分法"}}};

inline constexpr Phrase k_error_axis{"error, %", "誤差 [%]"};
inline constexpr Phrase k_cost_axis{"CPU time per simulated second, ms", "1秒分の計算の CPU 時間 [ms]"};
inline constexpr Phrase k_with_step{"{0}, {1:.3g} ms", "{0}、{1:.3g} ms"};
inline constexpr Phrase k_with_tolerance{"{0}, tolerance {1:.2g}", "{0}、許容誤差 {1:.2g}"};
inline constexpr Phrase k_setting{"{0}: {1:.3g} ms per simulated s, off by {2:.2g} %",
                                  "{0}：1秒分 {1:.3g} ms、誤差 {2:.2g} %"};
inline constexpr Phrase k_setting_now{"Now {0}.", "現在 {0}。"};
inline constexpr Phrase k_setting_not_there{"The present setting is not among those computed.",
                                            "現在の設定は計算に含まれていません。"};
inline constexpr Phrase k_pareto{"none cheaper is as exact", "最も安価な設定"};
inline constexpr Phrase k_setting_click{"A click computes like this from now on.",
                                        "クリックすると現時刻からこの設定で計算します。"};
inline constexpr Phrase k_setting_in_scene{"Tolerances and Newmark's β and γ are set in the scene.",
                                           "許容誤差と Newmark の β、γ はシーンで設定します。"};
inline constexpr Phrase k_cheaper{"Cheaper", "より速く"};
inline constexpr Phrase k_more_exact{"More exact", "より正確に"};
inline constexpr Phrase k_along_front{"To the next setting of which none cheaper is as exact",
                                      "同じ精度で最も安価な、次の設定へ"};
inline constexpr Phrase k_precision_progress{"{0} of {1} runs", "{0}/{1} 件を計算"};
inline constexpr Phrase k_no_errors_yet{"Errors are known when two frames have been computed finely.",
                                        "誤差は、骨組の細かい計算が2件終わると求まります。"};
inline constexpr Phrase k_no_such_error{"No run of this scene has this error.",
                                        "このシーンにはこの誤差はありません。"};
inline constexpr Phrase k_precision_failed{"No chart: {0}", "図を作成できません：{0}"};
inline constexpr Phrase k_precision_reference{"Against {0}; checked by {1}, over {2:.3g} s.",
                                              "基準：{0}、照合：{1}、{2:.3g} s まで。"};

}  // namespace topple::app::window_words
