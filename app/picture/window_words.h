// Texts of the window, in its languages. Numbers are of those languages alike.
#pragma once

#include <algorithm>
#include <iterator>
#include <string_view>
#include <utility>

#include "app/support/language.h"
#include "app/support/model_words.h"
#include "solver/body/model_level.h"

namespace topple::app {

/// Of the window; English until another one is chosen.
inline Language& window_language() {
  static Language language = Language::english;
  return language;
}

/// The phrase in the language of the window.
template <class... Of>
std::string say(const Phrase& phrase, const Of&... of) {
  return say_in(window_language(), phrase, of...);
}

namespace window_words {
using namespace model_words;

// how bodies and anchors stand
inline constexpr Phrase k_tilted{"tilt {0:.1f}°", "傾斜 {0:.1f}°"};
inline constexpr Phrase k_fallen{"fallen, tilt {0:.0f}°", "転倒、傾斜 {0:.0f}°"};
inline constexpr Phrase k_beyond{"beyond critical, {0:.1f}° of {1:.1f}°",
                                 "限界超過、{0:.1f}°（限界 {1:.1f}°）"};
inline constexpr Phrase k_tipped{"tipped, rests at {0:.1f}° (critical {1:.1f}°)",
                                 "傾いて静止、{0:.1f}°（限界 {1:.1f}° 超過）"};
inline constexpr Phrase k_leaning{"leans {0:.1f}° of {1:.1f}°", "傾斜 {0:.1f}°（限界 {1:.1f}°）"};
inline constexpr Phrase k_standing{"standing", "直立"};
inline constexpr Phrase k_in_the_air{"in the air, tilt {0:.0f}°", "空中、傾斜 {0:.0f}°"};
inline constexpr Phrase k_slid{", foot slid {0:.0f} mm", "、足元のすべり {0:.0f} mm"};
inline constexpr Phrase k_title_saved{"{0}, saved as {1}", "{0}、{1} として保存済み"};
inline constexpr Phrase k_slid_farthest{", {0}'s foot slid {1:.0f} mm",
                                        "、{0}の足元が最大 {1:.0f} mm すべった"};
inline constexpr Phrase k_all_stand{"all {0} stand", "{0}体すべて直立"};
inline constexpr Phrase k_other_stands{"1 other stands", "ほか1体は直立"};
inline constexpr Phrase k_others_stand{"{0} others stand", "ほか{0}体は直立"};
inline constexpr Phrase k_others{"{0} others: {1}", "ほか{0}体：{1}"};
inline constexpr Phrase k_count_fallen{"{0} fallen", "転倒 {0}"};
inline constexpr Phrase k_count_beyond{"{0} beyond critical", "限界超過 {0}"};
inline constexpr Phrase k_count_tipped{"{0} tipped", "傾いて静止 {0}"};
inline constexpr Phrase k_count_leaning{"{0} leaning", "傾斜 {0}"};
inline constexpr Phrase k_count_standing{"{0} standing", "直立 {0}"};
inline constexpr Phrase k_comma{", ", "、"};
inline constexpr Phrase k_colon{": ", "："};
inline constexpr Phrase k_semicolon{"; ", "。"};
inline constexpr Phrase k_more{"+ {0} more", "ほか{0}体"};

inline constexpr Phrase k_strap{"strap", "ベルト"};
inline constexpr Phrase k_bracket{"bracket", "L型金具"};
inline constexpr Phrase k_pole{"pole", "突っ張り棒"};
inline constexpr Phrase k_away{"taken away", "取り外し"};
inline constexpr Phrase k_holds{"holding", "有効"};
inline constexpr Phrase k_slack{"without force", "無負荷"};
inline constexpr Phrase k_broken_anchor{"broken", "破断"};
inline constexpr Phrase k_pulls{"pulls {0:.0f} N", "引張 {0:.0f} N"};
inline constexpr Phrase k_holds_with{"holds with {0:.0f} N", "保持 {0:.0f} N"};
inline constexpr Phrase k_pushes{"pushes {0:.0f} N", "圧縮 {0:.0f} N"};
inline constexpr Phrase k_of_strength{", {0} of its strength", "（耐力の{0}）"};
inline constexpr Phrase k_anchors{"fixings: {0}", "固定具：{0}"};

// the instant, the floor
inline constexpr Phrase k_load_instant{"load step {0} of {1}, load factor {2:.4g}",
                                       "荷重ステップ {0}/{1}、荷重係数 {2:.4g}"};
inline constexpr Phrase k_on_storey{" at the ground, here storey {0} of {1}", "（地動、{1}層中{0}層）"};
inline constexpr Phrase k_in_a_building{" at the ground of a building", "（建物の地動）"};
inline constexpr Phrase k_floor_sine{"floor: {0:.4g} Hz, {1:.4g} gal", "床：{0:.4g} Hz、{1:.4g} gal"};
inline constexpr Phrase k_floor_sweep{"floor: sweep {0:.4g} to {1:.4g} Hz, {2:.4g} gal",
                                      "床：スイープ波 {0:.4g}～{1:.4g} Hz、{2:.4g} gal"};
inline constexpr Phrase k_floor_pulse{"floor: pulse {0:g} s, {1:.4g} gal", "床：パルス {0:g} s、{1:.4g} gal"};
inline constexpr Phrase k_floor_record{"floor: record {0:.3g} s, peak {1:.4g} gal",
                                       "床：加速度記録 {0:.3g} s、最大 {1:.4g} gal"};
inline constexpr Phrase k_floor_record_since{"floor: record {0:.3g} s, times {1:.3g} since {2:.2f} s",
                                             "床：加速度記録 {0:.3g} s、{2:.2f} s から {1:.3g} 倍"};
inline constexpr Phrase k_still_at{", still {0:.0f} gal", "（移行中、現在 {0:.0f} gal）"};
inline constexpr Phrase k_still_times{", still times {0:.3g}", "（移行中、現在 {0:.3g} 倍）"};
inline constexpr Phrase k_shake_from{", from {0:.4g} s on", "、{0:.4g} sから"};
inline constexpr Phrase k_shake_over{", over since {0:.4g} s", "、{0:.4g} sに終了"};
inline constexpr Phrase k_more_shakes{"{0}, and {1} more", "{0}、ほか{1}件"};
inline constexpr Phrase k_now{"{0};  now {1:+.0f} gal, {2:+.0f} mm", "{0}　現在 {1:+.0f} gal、{2:+.0f} mm"};

// status
inline constexpr Phrase k_settling{"Bringing the bodies to rest under gravity …",
                                   "重力下で静止状態を計算中 …"};
inline constexpr Phrase k_reading{"Reading the recording …", "記録を読み込み中 …"};
inline constexpr Phrase k_ended{"This session has ended: {0}. What was recorded is kept.",
                                "このセッションは終了しました：{0}。記録済みのデータは保存されています。"};
inline constexpr Phrase k_returning{"Going back to the state at this instant …",
                                    "この時刻の状態に戻しています …"};
inline constexpr Phrase k_stopped{"Stopped: {0}", "停止：{0}"};
inline constexpr Phrase k_loads_done{"All load steps are done.", "全荷重ステップが終了しました。"};
inline constexpr Phrase k_run_ended{"The run ended at {0:.2f} s.", "計算は {0:.2f} s で終了しました。"};
inline constexpr Phrase k_after_end{" R, then Space runs it again, dragging on the timeline looks back.",
                                    " R の後 Space で再計算、タイムラインのドラッグで過去を表示します。"};
inline constexpr Phrase k_warns{" Warning: {0}.", " 注意：{0}。"};
inline constexpr Phrase k_no_instants{"The recording holds no instants.", "記録に時刻のデータがありません。"};
inline constexpr Phrase k_running_loads{"Running through the load steps.", "荷重ステップを計算中。"};
inline constexpr Phrase k_running{"Running: {0:.2f} times real time asked, {1:.2f} reached.",
                                  "計算中：指定 {0:.2f} 倍速、実際 {1:.2f} 倍速。"};
inline constexpr Phrase k_running_slow{
    "Running: {0:.2f} times real time asked, {1:.2f} reached; about {2} to the end.",
    "計算中：指定 {0:.2f} 倍速、実際 {1:.2f} 倍速。終了まで約 {2}。"};
inline constexpr Phrase k_minutes{"{0} min", "{0} 分"};
inline constexpr Phrase k_seconds{"{0} s", "{0} 秒"};
inline constexpr Phrase k_paused{"Paused. Space goes on; parameters can be changed now and while it runs.",
                                 "一時停止中。Space で再開。パラメーターは計算中も変更できます。"};
inline constexpr Phrase k_restarted{
    "Back at the start, with the sliders as they are. Space runs branch {0}; the run so far is kept as "
    "branch {1}.",
    "現在のパラメーターで先頭に戻りました。Space で分岐 {0} を計算。それまでの計算は分岐 {1} に。"};
inline constexpr Phrase k_recording{"Recording", "記録を表示中"};
inline constexpr Phrase k_looking_back{"Looking back", "過去を表示中"};
inline constexpr Phrase k_played{", played", "（再生中）"};
inline constexpr Phrase k_played_at{", played at {0:g} times real time", "（{0:g} 倍速で再生中）"};
inline constexpr Phrase k_says{"{0}; {1}", "{0}：{1}"};
inline constexpr Phrase k_at_newest{
    "This is the newest instant: drag on the timeline, then C continues from there.",
    "最新の時刻です。タイムラインで戻ってから C で分岐します。"};
inline constexpr Phrase k_can_branch{"{0}. C continues from here as a new branch.",
                                     "{0}。C でここから新しい分岐を開始します。"};
inline constexpr Phrase k_can_branch_or_return{
    "{0}. C continues from here as a new branch, End returns to the newest instant.",
    "{0}。C でここから新しい分岐を開始、End で最新の時刻に戻ります。"};
inline constexpr Phrase k_refused{"Refused: {0}", "変更できません：{0}"};
inline constexpr Phrase k_no_longer_recorded{"  No longer recorded: {0}", "　記録は中断されました：{0}"};
inline constexpr Phrase k_frame_time{"{0:.0f} ms a frame   ", "描画 {0:.0f} ms　"};
inline constexpr Phrase k_f1{"F1: keys", "F1：キー一覧"};

// transport
inline constexpr Phrase k_to_start{"To the start (Home)", "先頭へ（Home）"};
inline constexpr Phrase k_one_back{"One instant back ( , )", "1コマ戻る（ , ）"};
inline constexpr Phrase k_pause{"Pause (Space)", "一時停止（Space）"};
inline constexpr Phrase k_play{"Play (Space)", "再生（Space）"};
inline constexpr Phrase k_one_on{"One instant on ( . )", "1コマ進む（ . ）"};
inline constexpr Phrase k_to_end{"To the newest instant (End)", "最新の時刻へ（End）"};
inline constexpr Phrase k_replay_restart{"To the start (R)", "先頭へ（R）"};
inline constexpr Phrase k_restart{
    "Back to the start in a new branch, with the sliders as they are;\n"
    "what is running runs again. The run so far is kept as its branch (R)",
    "現在のパラメーターで先頭に戻り、新しい分岐を開始。計算中なら最初から計算し直す。\n"
    "それまでの計算は元の分岐に残る（R）"};
inline constexpr Phrase k_slower{"Half the speed ( [ )", "速度を半分に（ [ ）"};
inline constexpr Phrase k_faster{"Twice the speed ( ] )", "速度を2倍に（ ] ）"};
inline constexpr Phrase k_load_speed{"Load paths per second, asked for", "1秒あたりの載荷過程の数（指定値）"};
inline constexpr Phrase k_speed{"Simulated seconds per second, asked for", "実時間に対する速度（指定値）"};
inline constexpr Phrase k_continue{"Continue from here", "ここから続行"};
inline constexpr Phrase k_continue_about{"A new branch begins at the instant shown (C)",
                                         "表示中の時刻から新しい分岐を開始（C）"};
inline constexpr Phrase k_branch{"branch {0}", "分岐 {0}"};
inline constexpr Phrase k_branch_live{"branch {0} (live)", "分岐 {0}（計算中）"};
inline constexpr Phrase k_branch_from_start{"{0}: from the start", "{0}：先頭から"};
inline constexpr Phrase k_branch_out_of{"{0}: goes on from branch {1}", "{0}：分岐 {1} から続く"};
inline constexpr Phrase k_branch_about{"Which branch to look at; the runs that were left are kept here",
                                       "表示する分岐。離れた計算もここに残る"};
inline constexpr Phrase k_undo{"Undo", "元に戻す"};
inline constexpr Phrase k_undo_about{"Takes the last change back, from now on (Ctrl+Z)",
                                     "直前の変更を現時刻から取り消す（Ctrl+Z）"};
inline constexpr Phrase k_redo{"Redo", "やり直す"};
inline constexpr Phrase k_redo_about{"(Ctrl+Shift+Z)", "（Ctrl+Shift+Z）"};
inline constexpr Phrase k_clock{"{0:.2f} s of {1:.6g} s", "{0:.2f} s / {1:.6g} s"};

// timeline
inline constexpr Phrase k_floor_lane{"floor, gal", "床 [gal]"};
inline constexpr Phrase k_load_factor{"load factor", "荷重係数"};
inline constexpr Phrase k_load_step{"load step", "荷重ステップ"};
inline constexpr Phrase k_load_step_number{"load step {0}", "荷重ステップ {0}"};
inline constexpr Phrase k_load_steps{"load steps", "荷重ステップ"};
inline constexpr Phrase k_up_to{"up to {0:.4g}", "最大 {0:.4g}"};
inline constexpr Phrase k_tilt_lane{"tilt, °", "傾斜 [°]"};
inline constexpr Phrase k_tilt_share_lane{"tilt / critical", "傾斜／限界角"};
inline constexpr Phrase k_critical_at_one{"1: critical", "1：限界"};
inline constexpr Phrase k_critical_and_cut{"1: critical; cut above {0}", "1：限界、{0} 超は省略"};
inline constexpr Phrase k_floor_trace{"floor acceleration, gal", "床の加速度 [gal]"};
inline constexpr Phrase k_first_shake_trace{"floor acceleration along the first shake, gal",
                                            "床の加速度（第1の揺れの方向）[gal]"};
inline constexpr Phrase k_anchor_breaks{"{0}: anchor {1} breaks at {2:.0f} N",
                                        "{0}：固定具 {1} が {2:.0f} N で破断"};
inline constexpr Phrase k_event{"{0}: {1} {2}", "{0}：{1} {2}"};
inline constexpr Phrase k_lifts{"lifts off", "浮き上がり"};
inline constexpr Phrase k_strikes{"strikes the floor", "床に衝突"};
inline constexpr Phrase k_hinges{"forms a plastic hinge", "塑性ヒンジ発生"};
inline constexpr Phrase k_breaks{"breaks a member", "部材破断"};
inline constexpr Phrase k_passes{"passes its critical angle", "転倒限界角を超過"};
inline constexpr Phrase k_computed_as{"is computed as {0} ({1})", "計算モデル {0}（{1}）に変更"};

inline constexpr Phrase k_integrators_now{"of frames; at work now: {0}", "骨組用。現在の計算：{0}"};
inline constexpr Phrase k_computed_now{"now {0} ({1}): {2}", "現在 {0}（{1}）：{2}"};
inline constexpr Phrase k_step_auto{"auto, %.3g ms", "自動、%.3g ms"};
inline constexpr Phrase k_step_auto_unknown{"auto", "自動"};
inline constexpr Phrase k_step_auto_about{"adaptive: the step taken here; one that is set stays",
                                          "可変刻み：この時点での刻み。設定すると固定になる"};

inline constexpr Phrase k_pulled_until{"pulled by hand until {0}", "{0} まで手で引く"};
inline constexpr Phrase k_edited{"{0}: {1} = {2}", "{0}：{1} = {2}"};
inline constexpr Phrase k_mark_lifts{"lifts off", "浮き上がり"};
inline constexpr Phrase k_mark_strikes{"strikes", "衝突"};
inline constexpr Phrase k_mark_hinge{"hinge", "ヒンジ"};
inline constexpr Phrase k_mark_breaks{"breaks", "破断"};
inline constexpr Phrase k_mark_passes{"beyond critical", "限界超過"};
inline constexpr Phrase k_mark_model{"model", "モデル"};
inline constexpr Phrase k_mark_edit{"change", "変更"};

// tabs and appearance
inline constexpr Phrase k_parameters{"Parameters", "パラメーター"};
inline constexpr Phrase k_picture_tab{"Picture", "表示"};
inline constexpr Phrase k_inspect{"Inspect", "詳細"};
inline constexpr Phrase k_teach{"Learn", "学習"};
inline constexpr Phrase k_theme{"theme", "配色"};
inline constexpr Phrase k_light{"light", "ライト"};
inline constexpr Phrase k_dark{"dark", "ダーク"};
inline constexpr Phrase k_language{"language", "言語"};
inline constexpr Phrase k_english{"English", "English"};
inline constexpr Phrase k_japanese{"日本語", "日本語"};
inline constexpr Phrase k_needs_font{"Japanese needs the Debian package fonts-vlgothic",
                                     "日本語表示には Debian パッケージ fonts-vlgothic が必要です"};
inline constexpr Phrase k_letters{"size", "文字の倍率"};
inline constexpr Phrase k_letters_too_large{
    "Letters of {0:.0f} % need a larger window; in this one they are {1:.0f} %.",
    "文字 {0:.0f} % には窓が狭いため、{1:.0f} % で表示しています。"};
inline constexpr Phrase k_letters_about{"Of letters and panels (Ctrl +, Ctrl -, Ctrl+0)",
                                        "文字とパネルの倍率（Ctrl +、Ctrl -、Ctrl+0）"};

// parameters
inline constexpr Phrase k_floor{"Floor", "床（加振）"};
inline constexpr Phrase k_floor_shake{"Floor, shake {0}", "床（加振 {0}）"};
inline constexpr Phrase k_contact{"Contact", "接触"};
inline constexpr Phrase k_bodies{"Bodies", "家具"};
inline constexpr Phrase k_anchors_heading{"Fixings", "固定具"};
inline constexpr Phrase k_stopper_line{
    "{0}: a stopper, which leans {1} before the run and cannot be switched in it",
    "{0}：{1} のストッパー。計算前に家具を傾けるため、計算中は切り替え不可"};
inline constexpr Phrase k_stopper_away_line{
    "{0}: a stopper of {1}, not in place; it cannot be switched in the run",
    "{0}：{1} のストッパー（取り外し）。計算中は切り替え不可"};
inline constexpr Phrase k_integration{"Integration", "時間積分"};
inline constexpr Phrase k_on{"on", "加振する"};
inline constexpr Phrase k_on_about{"shakes the floor; switched over a quarter of a period",
                                   "床を加振する。四半周期をかけて切り替わる"};
inline constexpr Phrase k_type{"type", "波形"};
inline constexpr Phrase k_shake_once{"Shake once", "1回だけ揺らす"};
inline constexpr Phrase k_shake_once_about{"A pulse from now on; of a sine, half of one period",
                                           "現時刻からパルスを加える。正弦波では半周期分"};
inline constexpr Phrase k_shake_once_ended{
    "The run has ended, so nothing would move any more.\nR goes back to its start.",
    "計算が終了しているため、揺らしても動きません。\nR で先頭に戻れます。"};
inline constexpr Phrase k_frequency{"frequency", "周波数"};
inline constexpr Phrase k_amplitude{"amplitude", "加速度振幅"};
inline constexpr Phrase k_direction{"direction", "加振方向"};
inline constexpr Phrase k_duration{"duration", "継続時間"};
inline constexpr Phrase k_scale{"scale", "倍率"};
inline constexpr Phrase k_alpha{"α", "剛性係数 α"};
inline constexpr Phrase k_q{"q", "指数 q"};
inline constexpr Phrase k_friction{"μ", "摩擦係数 μ"};
inline constexpr Phrase k_friction_static{"static μ", "静止摩擦 μ"};
inline constexpr Phrase k_restitution{"restitution", "反発係数"};
inline constexpr Phrase k_damping{"damping", "減衰定数"};
inline constexpr Phrase k_time_step{"time step", "時間刻み"};
inline constexpr Phrase k_sweep_from{"from", "開始周波数"};
inline constexpr Phrase k_sweep_to{"to", "終了周波数"};
inline constexpr Phrase k_law{"law", "接触則"};
inline constexpr Phrase k_integrator{"integrator", "積分法"};
inline constexpr Phrase k_stresses_wanted{"stresses are wanted", "応力も求める"};
inline constexpr Phrase k_stresses_wanted_about{
    "what bodies with model \"auto\" are to answer besides motion",
    "モデルが「auto」の家具について、運動に加えて応力も計算する"};
inline constexpr Phrase k_model{"model", "モデル"};
inline constexpr Phrase k_anchor_broke{"{0} (broken)", "{0}（破断）"};
inline constexpr Phrase k_anchor_broke_in_part{"{0} ({1} of {2} broken)", "{0}（{2}点中{1}点破断）"};
inline constexpr Phrase k_anchor_about{
    "ties {0} to the wall or floor. One that is put in place while it runs starts without force",
    "{0} を壁または床に固定する。計算の途中で取り付けた時点の力は0"};
inline constexpr Phrase k_anchor_between_about{
    "ties {0} to {1}. One that is put in place while it runs starts without force",
    "{0} を {1} に連結する。計算の途中で取り付けた時点の力は0"};
inline constexpr Phrase k_direction_about{"of the acceleration, counter-clockwise from x (a cabinet's depth)",
                                          "加速度の方向。x軸（家具の奥行方向）から反時計回り"};
// {0} is the scene reference's own line
inline constexpr Phrase k_type_about{"{0}", "加振波形の種類"};
inline constexpr Phrase k_frequency_about{"{0}", "加振の周波数"};
inline constexpr Phrase k_amplitude_about{"{0}", "床加速度の振幅"};
inline constexpr Phrase k_duration_about{"{0}", "加振の継続時間"};
inline constexpr Phrase k_scale_about{"{0}", "加速度記録に掛ける倍率"};
inline constexpr Phrase k_record_peak{"at most {0:.0f} gal, along {1}", "最大 {0:.0f} gal、{1} 方向"};
inline constexpr Phrase k_ground_peak{"the ground: at most {0:.0f} gal, along {1}",
                                      "地盤：最大 {0:.0f} gal、{1} 方向"};
inline constexpr Phrase k_alpha_about{"{0}", "接触のペナルティ剛性係数"};
inline constexpr Phrase k_q_about{"{0}", "接触力の指数"};
inline constexpr Phrase k_friction_about{"{0}", "動摩擦係数"};
inline constexpr Phrase k_friction_static_about{"{0}", "静止摩擦係数"};
inline constexpr Phrase k_restitution_about{"{0}", "衝突の反発係数"};
inline constexpr Phrase k_damping_about{"{0}", "家具の減衰定数"};
inline constexpr Phrase k_time_step_about{"{0}", "時間積分の刻み"};
inline constexpr Phrase k_law_about{"{0}", "接触力の計算則"};
inline constexpr Phrase k_integrator_about{"{0}", "時間積分の方法"};
inline constexpr Phrase k_model_about{"{0}", "家具の計算モデル"};
inline constexpr Phrase k_slider_about{"{0}: {1}\nallowed {2}, in the scene {3}\nCtrl+click to type",
                                       "{0}：{1}\n許容範囲 {2}、シーンの値 {3}\nCtrl+クリックで数値入力"};
inline constexpr Phrase k_key_about{"{0}: {1}", "{0}：{1}"};
inline constexpr Phrase k_back_to_scene{"Back to the scene's value", "シーンの値に戻す"};
inline constexpr Phrase k_too_fast_for_rows{
    "Too fast for rows at {0:.4g} Hz: the floor is drawn and exported as another motion. "
    "run.output_rate in the scene sets them.",
    "{0:.4g} Hzの記録間隔には速すぎる揺れです。床の動きは別の動きとして描画・出力されます。"
    "記録間隔はシーンのrun.output_rateで決まります。"};
inline constexpr Phrase k_past_values{
    "These were the values at this instant. Continue from here (C) to change them.",
    "この時刻での値です。変更するには「ここから続行」（C）を実行してください。"};
inline constexpr Phrase k_no_parameters{"This scene has no parameter that can be changed while it runs.",
                                        "このシーンには、計算中に変更できるパラメーターがありません。"};

// picture
inline constexpr Phrase k_colour{"colour", "着色"};
inline constexpr Phrase k_map{"map", "カラーマップ"};
inline constexpr Phrase k_diverging{"diverging, for signs", "正負の発散型"};
inline constexpr Phrase k_range{"range", "範囲"};
inline constexpr Phrase k_this_instant{"this instant", "この時刻"};
inline constexpr Phrase k_whole_run{"whole run", "全時刻"};
inline constexpr Phrase k_fixed{"fixed", "固定値"};
inline constexpr Phrase k_maximum{"up to", "上限"};
inline constexpr Phrase k_enter_takes{"{0}; Enter takes it", "{0}（Enter で確定）"};
inline constexpr Phrase k_deformation{"deformation", "変形倍率"};
inline constexpr Phrase k_deformation_about{
    "About the pose that fits each body best: rigid motion stays\nCtrl+click to type",
    "各家具の剛体運動からの変形だけを拡大する\nCtrl+クリックで数値入力"};
inline constexpr Phrase k_trails{"trails", "軌跡"};
inline constexpr Phrase k_none{"none", "なし"};
inline constexpr Phrase k_last_second{"last second", "直近1秒"};
inline constexpr Phrase k_since_start{"since the start", "開始から"};
inline constexpr Phrase k_contact_forces{"contact forces", "接触力"};
inline constexpr Phrase k_panels{"panels", "側板"};
inline constexpr Phrase k_words{"words", "文字"};
inline constexpr Phrase k_words_about{"Title, captions and legend; in exports the floor's curve as well",
                                      "題名、説明、凡例。書き出しでは床の曲線も"};
inline constexpr Phrase k_ghost{"ghost of the branch left", "離れた分岐の残像"};
inline constexpr Phrase k_ghost_is{"pale: branch {0}", "淡色：分岐 {0}"};
inline constexpr Phrase k_front{"Front", "正面"};
inline constexpr Phrase k_side{"Side", "側面"};
inline constexpr Phrase k_top{"Top", "上面"};
inline constexpr Phrase k_iso{"Iso", "等角"};

// legend
inline constexpr Phrase k_stress{"von Mises stress", "相当応力（von Mises）"};
inline constexpr Phrase k_fibre_yields{
    "The outermost fibre is beyond {0:g} MPa; a hinge forms where the whole section yields: yield ratio 1.",
    "最外縁が {0:g} MPa を超えています。断面全体が降伏すると（降伏比 1）ヒンジができます。"};
inline constexpr Phrase k_yield_ratio{"yield ratio", "降伏比"};
inline constexpr Phrase k_axial{"axial force, tension +", "軸力（引張+）"};
inline constexpr Phrase k_moment{"bending moment", "曲げモーメント"};
inline constexpr Phrase k_torsion{"torsional moment", "ねじりモーメント"};
inline constexpr Phrase k_displacement{"deformation from the best-fit pose", "変形（剛体運動を除く）"};
inline constexpr Phrase k_covers_run{"covers 95 % of the run", "全時刻の95 %を含む範囲"};
inline constexpr Phrase k_range_fixed{"fixed range", "固定範囲"};
inline constexpr Phrase k_range_instant{"range of this instant", "この時刻の範囲"};
inline constexpr Phrase k_yield_at{"yield {0:g} MPa", "降伏 {0:g} MPa"};
inline constexpr Phrase k_yield{"yield", "降伏"};
inline constexpr Phrase k_all_rigid{"no stresses: computed as what does not bend",
                                    "変形しない物体として計算（応力なし）"};
inline constexpr Phrase k_some_rigid{"grey: rigid, no stresses", "灰色：剛体（応力なし）"};
inline constexpr Phrase k_some_cannot_yield{"grey: cannot yield", "灰色：降伏しない部材"};
inline constexpr Phrase k_cannot_yield{"nothing here can yield", "降伏する部材なし"};
inline constexpr Phrase k_deformed{"deformation ×{0:g}", "変形倍率 ×{0:g}"};
inline constexpr Phrase k_not_finite{"not drawn: a number of this instant is not finite",
                                     "この時刻の数値が有限でないため表示できません"};
inline constexpr Phrase k_newtons{"{0:.0f} N", "{0:.0f} N"};
inline constexpr Phrase k_pulling{"Pulling {0}, at most with its weight, {1:.0f} N.",
                                  "{0}を引いています。最大でその重さの {1:.0f} N です。"};
inline constexpr Phrase k_pull_while_it_runs{
    "A body is pulled while its run is computed: press End, then Space.",
    "家具を引けるのは計算中だけです。End、続いて Space を押してください。"};
inline constexpr Phrase k_no_pull_of_loads{"Nothing is pulled while loads grow: a pull is for a run in time.",
                                           "荷重を増す計算では引けません。時間を追う計算で引けます。"};
inline constexpr Phrase k_arrow_scale{"arrows: {0:g} N per 0.1 m", "矢印 0.1 m = {0:g} N"};
inline constexpr Phrase k_note{"topple {0} · scene {1}{2} · deformation ×{3:g}",
                               "topple {0} · シーン {1}{2} · 変形倍率 ×{3:g}"};
inline constexpr Phrase k_note_contact{" · contact α = {0:g} kgf, q = {1:g}, μ = {2:g}",
                                       " · 接触 α = {0:g} kgf, q = {1:g}, μ = {2:g}"};

// inspector
inline constexpr Phrase k_short_stress{"stress", "相当応力"};
inline constexpr Phrase k_normal_force{"N", "軸力 N"};
inline constexpr Phrase k_shear_y{"Vy", "せん断力 Vy"};
inline constexpr Phrase k_shear_z{"Vz", "せん断力 Vz"};
inline constexpr Phrase k_torque{"T", "ねじり T"};
inline constexpr Phrase k_moment_y{"My", "曲げ My"};
inline constexpr Phrase k_moment_z{"Mz", "曲げ Mz"};
inline constexpr Phrase k_tilt{"tilt", "傾斜"};
inline constexpr Phrase k_slide{"base moved", "底面中心の移動"};
inline constexpr Phrase k_angular_velocity{"angular velocity", "角速度"};
inline constexpr Phrase k_kinetic{"kinetic energy", "運動エネルギー"};
inline constexpr Phrase k_left_to_overturn{"left to overturn", "転倒までの余裕"};
inline constexpr Phrase k_share_left{"share left", "余裕の割合"};
inline constexpr Phrase k_own_deformation{"deformation", "変形"};
inline constexpr Phrase k_force{"force", "力"};
inline constexpr Phrase k_stretch{"stretch", "伸び"};
inline constexpr Phrase k_energy{"energy", "エネルギー"};
inline constexpr Phrase k_unplot{"Take it off the plots", "グラフから外す"};
inline constexpr Phrase k_plot{"Plot it over time", "時刻歴グラフに表示"};
inline constexpr Phrase k_draw_along{"Draw it along the member in the scene", "部材に沿って図示する"};
inline constexpr Phrase k_integrated{"integrated", "積分点"};
inline constexpr Phrase k_stresses_at{"stresses (hinge: filled)", "応力評価点（ヒンジ：塗り）"};
inline constexpr Phrase k_s_of_elements{"s of its elements: {0}", "各要素の s：{0}"};
inline constexpr Phrase k_over_run_about{
    "At the recorded instants.\nA blow between two of them may be harder.",
    "記録された時刻での値。\nその間の衝撃はこれより大きいことがある。"};
inline constexpr Phrase k_over_run{"{0}, peak {1} {2}", "{0}、最大 {1} {2}"};
inline constexpr Phrase k_pin{"Pin", "固定表示"};
inline constexpr Phrase k_unpin{"Unpin", "固定解除"};
inline constexpr Phrase k_pin_about{"Keep it here while another one is looked at",
                                    "別の対象を見る間も表示を残す"};
inline constexpr Phrase k_member_line{"{0}, {1}, {2:.0f} mm long", "{0}、{1}、長さ {2:.0f} mm"};
inline constexpr Phrase k_body_line{"{0:.4g} kg, {1} members, {2}", "{0:.4g} kg、部材 {1}、モデル {2}"};
inline constexpr Phrase k_block_line{"{0:.4g} kg, a solid block, {1}",
                                     "{0:.4g} kg、剛なブロック、モデル {1}"};
inline constexpr Phrase k_with_its_load{"{0:.4g} kg with what stands on it",
                                        "載っている物を含めて {0:.4g} kg"};
inline constexpr Phrase k_touched_by{"by {0}: {1} N, upward {2} N, at height {3:.2f} m",
                                     "{0} から {1} N（上向き {2} N）、高さ {3:.2f} m"};
inline constexpr Phrase k_anchor_strength{"strength {0} N", "耐力 {0} N"};
inline constexpr Phrase k_anchor_peak{"greatest force {0} N", "最大 {0} N"};
inline constexpr Phrase k_anchor_line{"{0} of {1}, {2:.4g} kN/m, {3:.0f} mm long",
                                      "{1} の{0}、{2:.4g} kN/m、長さ {3:.0f} mm"};
inline constexpr Phrase k_approximate{"A contact presses on its middle node: its own bending is approximate.",
                                      "中間節点に接触力が作用しているため、この部材の曲げは近似値です。"};
inline constexpr Phrase k_all_of{"All of {0}", "{0} 全体"};
inline constexpr Phrase k_how_to_inspect{
    "Click a member or a fixing; click a member again for its body. Bodies:",
    "部材か固定具をクリックすると選択します。同じ部材をもう一度クリックすると家具全体。家具の一覧："};

// plots
inline constexpr Phrase k_plots{"Plots", "グラフ"};
inline constexpr Phrase k_csv_about{"Write these values as a table", "値を表（CSV）に保存"};
inline constexpr Phrase k_png_about{"Write these plots as a picture", "グラフを画像（PNG）に保存"};
inline constexpr Phrase k_close_all{"Close all", "すべて閉じる"};
inline constexpr Phrase k_close_plot{"Close this plot", "このグラフを閉じる"};

// keys
inline constexpr Phrase k_keys{"Keys", "キー操作"};
inline constexpr Phrase k_key_play{"play, pause", "再生、一時停止"};
inline constexpr Phrase k_key_step{"one instant back, on", "1コマ戻る、進む"};
inline constexpr Phrase k_key_speed{"half, twice the speed", "速度を半分、2倍に"};
inline constexpr Phrase k_key_start{"to the start", "先頭へ"};
inline constexpr Phrase k_key_end{"to the newest instant", "最新の時刻へ"};
inline constexpr Phrase k_key_restart{"back to the start in a new branch, with the sliders as they are",
                                      "現在のパラメーターで先頭に戻り、新しい分岐を開始"};
inline constexpr Phrase k_key_continue{"continue from here in a new branch", "ここから新しい分岐で続行"};
inline constexpr Phrase k_key_undo{"take a change of a parameter back", "パラメーターの変更を取り消す"};
inline constexpr Phrase k_key_redo{"make it again", "取り消した変更をやり直す"};
inline constexpr Phrase k_key_type{"type a value", "数値を入力"};
inline constexpr Phrase k_key_front{"seen from the front", "正面から見る"};
inline constexpr Phrase k_key_side{"from the side", "側面から見る"};
inline constexpr Phrase k_key_top{"from the top", "上から見る"};
inline constexpr Phrase k_key_corner{"from a corner", "斜めから見る"};
inline constexpr Phrase k_key_fit{"fit that view", "全体を表示"};
inline constexpr Phrase k_key_follow{"follow the body looked at, else the first; stop following",
                                     "選択中（なければ最初）の物体を追う、追うのをやめる"};
inline constexpr Phrase k_follows{"The camera follows {0}; T lets go.", "カメラは{0}を追います。T で解除。"};
inline constexpr Phrase k_key_quantity{"colour by the next quantity", "着色する量を切り替え"};
inline constexpr Phrase k_key_forces{"arrows of contact forces", "接触力の矢印"};
inline constexpr Phrase k_key_panels{"panels of cabinets", "側板の表示"};
inline constexpr Phrase k_key_turn{"turn the view; with Shift or the right button: move it",
                                   "視点の回転。Shift または右ボタンで平行移動"};
inline constexpr Phrase k_key_wheel{"nearer, farther", "拡大、縮小"};
inline constexpr Phrase k_key_click{"inspect a member; once more: its body",
                                    "部材を選択。もう一度で家具全体"};
inline constexpr Phrase k_key_pull{"pull a body while it runs", "動いている家具を引く"};
inline constexpr Phrase k_key_let_go{"let go of it", "選択を解除"};
inline constexpr Phrase k_key_panel{"to the next panel", "次のパネルへ"};
inline constexpr Phrase k_key_tab{"to the next value of the panel", "パネル内の次の値へ"};
inline constexpr Phrase k_key_arrows{"between controls of a panel; Space uses one, Enter types its value",
                                     "パネル内の移動。Space で操作、Enter で数値入力"};
inline constexpr Phrase k_key_size{"larger, smaller, usual letters", "文字を大きく、小さく、標準に"};
inline constexpr Phrase k_key_theme{"light or dark", "ライトとダークの切り替え"};
inline constexpr Phrase k_key_loop{"at the end, begin again", "最後まで来たら最初から繰り返す"};
inline constexpr Phrase k_key_scenes{"another scene or recording", "別のシーンや記録を開く"};
inline constexpr Phrase k_key_save{"save the scene as it is now", "現在のシーンを保存"};
inline constexpr Phrase k_key_export{"export a picture, a video or tables", "画像・動画・表の書き出し"};
inline constexpr Phrase k_key_table{"this table", "この一覧"};
inline constexpr Phrase k_key_quit{"close the recording and the window", "記録とウィンドウを閉じる"};
inline constexpr Phrase k_drag{"drag", "ドラッグ"};
inline constexpr Phrase k_wheel{"wheel", "ホイール"};
inline constexpr Phrase k_click{"click", "クリック"};
inline constexpr Phrase k_arrows{"arrows", "矢印キー"};
inline constexpr Phrase k_ctrl_drag{"Ctrl+drag", "Ctrl+ドラッグ"};
inline constexpr Phrase k_ctrl_click{"Ctrl+click on a slider", "スライダーを Ctrl+クリック"};

}  // namespace window_words

}  // namespace topple::app
