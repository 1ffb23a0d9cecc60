// What the window says around a scene: choosing, opening, saving, exporting.
#pragma once

#include "app/picture/window_words.h"

namespace topple::app::window_words {

inline constexpr Phrase k_scenes{"Scenes…", "シーン…"};
inline constexpr Phrase k_scenes_about{"Another scene or recording (Ctrl+O)",
                                       "別のシーンや記録を開く (Ctrl+O)"};
inline constexpr Phrase k_save{"Save…", "保存…"};
inline constexpr Phrase k_save_about{"The scene as it is now, as a file (Ctrl+S)",
                                     "現在のシーンをファイルに保存 (Ctrl+S)"};
inline constexpr Phrase k_export{"Export…", "書き出し…"};
inline constexpr Phrase k_export_about{"Picture, video or tables (Ctrl+E)",
                                       "画像・動画・表の書き出し (Ctrl+E)"};
inline constexpr Phrase k_loop_about{"At the end, begin again (L)", "最後まで来たら最初から繰り返す (L)"};

inline constexpr Phrase k_choose{"Choose a scene", "シーンを選ぶ"};
inline constexpr Phrase k_choose_about{"or drop a scene, a recording or an accelerogram on the window",
                                       "シーン・記録・加速度波形のファイルをウィンドウに落としても開けます"};
inline constexpr Phrase k_filter{"type to filter", "文字を入力して絞り込む"};
inline constexpr Phrase k_recent{"Recent files", "最近のファイル"};
inline constexpr Phrase k_no_recent{"Scenes and recordings that you open from files stand here.",
                                    "ファイルから開いたシーンと記録がここに並びます。"};
inline constexpr Phrase k_missing{"is not there any more", "見つかりません"};
inline constexpr Phrase k_built_in{"Built-in scenes", "組み込みのシーン"};
inline constexpr Phrase k_begin_here{"· begin here", "・最初はこれ"};
inline constexpr Phrase k_nothing_found{"Nothing is called \"{0}\".",
                                        "「{0}」に当てはまるものはありません。"};
inline constexpr Phrase k_choose_keys{"arrows: choose   Enter: open   Esc: back",
                                      "矢印: 選択   Enter: 開く   Esc: 戻る"};
inline constexpr Phrase k_opening{"opening {0} …", "{0} を開いています…"};

inline constexpr Phrase k_not_opened{"This cannot be opened", "開けません"};
inline constexpr Phrase k_kept_open{"What was open stays as it was.", "開いていたものはそのままです。"};
inline constexpr Phrase k_record_needs_scene{
    "{0}: is neither a scene nor a recording; an accelerogram is dropped on an open scene, whose first shake "
    "it becomes",
    "{0}: "
    "シーンでも記録でもありません。加速度波形は、開いているシーンの上に落とすと、その最初の加振になります"};
inline constexpr Phrase k_not_recorded{"This run is not recorded", "この計算は記録されません"};
inline constexpr Phrase k_no_state_folder{
    "No folder for recordings can be written to: $XDG_STATE_HOME/topple or ~/.local/state/topple. Name a "
    "file with -o.",
    "記録用のフォルダに書き込めません: $XDG_STATE_HOME/topple または ~/.local/state/topple。-o "
    "でファイルを指定してください。"};
inline constexpr Phrase k_record_broke_off{"The recording broke off", "記録が途切れました"};
inline constexpr Phrase k_record_kept{
    "The run goes on, but is no longer recorded. What was recorded until then can be opened.",
    "計算は続きますが、これ以降は記録されません。それまでの記録は開けます。"};
inline constexpr Phrase k_diverged{"A step failed", "計算が収束しませんでした"};
inline constexpr Phrase k_diverged_about{
    "The run stands at the last good state; where it failed is highlighted. Change a parameter and go on.",
    "直前の正しい状態で止まっています。失敗した要素は強調表示されています。パラメータを変えて続けられます。"};
inline constexpr Phrase k_path_failed_about{
    "The path stands at its last equilibrium; where it failed is highlighted.",
    "最後の釣合い状態で止まっています。失敗した要素は強調表示されています。"};
inline constexpr Phrase k_not_begun{"The run could not begin", "計算を始められませんでした"};
inline constexpr Phrase k_not_begun_about{
    "The furniture stands as the scene has it. Change the room (F2) or the scene file.",
    "家具はシーンのとおりに置かれています。部屋（F2）またはシーンファイルを変更してください。"};
inline constexpr Phrase k_program_failed{"The run ended by an error of the program",
                                         "プログラムの誤りで計算が終わりました"};
inline constexpr Phrase k_halve{"Halve the step and retry", "時間刻みを半分にして再試行"};
inline constexpr Phrase k_close{"Close", "閉じる"};
inline constexpr Phrase k_copy{"Copy", "コピー"};
inline constexpr Phrase k_cancel{"Cancel", "中止"};

inline constexpr Phrase k_save_scene{"Save scene as", "シーンを名前を付けて保存"};
inline constexpr Phrase k_save_scene_about{
    "The scene with all parameters as they are at this instant. It starts from the beginning.",
    "この時点のパラメータをすべて含むシーンです。最初から始まります。"};
inline constexpr Phrase k_file{"File", "ファイル"};
inline constexpr Phrase k_browse{"Browse…", "参照…"};
inline constexpr Phrase k_browse_about{"A scene or recording from a folder",
                                       "フォルダからシーンや記録を選びます"};
inline constexpr Phrase k_open_file{"Open a scene or a recording", "シーンか記録を開く"};
inline constexpr Phrase k_folder_above{"Up", "上へ"};
inline constexpr Phrase k_choose_file{"Choose", "選択"};
inline constexpr Phrase k_no_such_file{"{0} is not there.", "{0} はありません。"};
inline constexpr Phrase k_exists{"{0} exists already.", "{0} はすでにあります。"};
inline constexpr Phrase k_replace{"Replace it", "置き換える"};
inline constexpr Phrase k_save_now{"Save", "保存"};
inline constexpr Phrase k_written{"Written: {0}", "書き出しました: {0}"};
inline constexpr Phrase k_given_up{"Written: {0}, without {1}, which does not go with the rest in a scene",
                                   "書き出しました: {0}。シーンに書けない値: {1}"};
inline constexpr Phrase k_not_written{"Not written: {0}", "書き出せません: {0}"};

inline constexpr Phrase k_export_title{"Export", "書き出し"};
inline constexpr Phrase k_picture{"Picture", "画像"};
inline constexpr Phrase k_video{"Video", "動画"};
inline constexpr Phrase k_tables{"Tables (CSV)", "表 (CSV)"};
inline constexpr Phrase k_size{"Size", "大きさ"};
inline constexpr Phrase k_from{"From", "開始"};
inline constexpr Phrase k_to{"To", "終了"};
inline constexpr Phrase k_rate{"Pictures a second", "毎秒の枚数"};
inline constexpr Phrase k_times_real_time{"times real time", "倍速"};
inline constexpr Phrase k_folder{"Folder", "フォルダ"};
inline constexpr Phrase k_export_now{"Export", "書き出す"};
inline constexpr Phrase k_picture_about{
    "The view as it is seen now, with title, legend and time unless Picture leaves them out.",
    "現在の視点の画像。「表示」で消していなければ題名・凡例・時刻が入ります。"};
inline constexpr Phrase k_picture_of_row{"It shows {0:.3f} s, the newest instant that is recorded.",
                                         "記録済みの最新時刻 {0:.3f} s の画像です。"};
inline constexpr Phrase k_no_such_range{
    "Nothing lies between {0:.2f} and {1:.2f}; the recording has {2:.2f} to {3:.2f}.",
    "{0:.2f} から {1:.2f} の間には何もありません（記録は {2:.2f}〜{3:.2f}）。"};
inline constexpr Phrase k_no_such_size{"Sides of a picture are {0} to {1} px, not {2} × {3}.",
                                       "画像の辺は {0}〜{1} px です（{2} × {3} は描けません）。"};
inline constexpr Phrase k_odd_size{"Sides of a video are even numbers, not {0} × {1} px.",
                                   "動画の辺は偶数にしてください（{0} × {1} px）。"};
inline constexpr Phrase k_no_such_rate{"A video has 1 to {0} pictures a second, not {1}.",
                                       "動画は毎秒 1〜{0} 枚です（{1} は選べません）。"};
inline constexpr Phrase k_no_such_speed{"A video runs at {0:.4g} to {1:g} times real time, not {2:g}.",
                                        "動画の速さは実時間の {0:.4g}〜{1:g} 倍です（{2:g} は選べません）。"};
inline constexpr Phrase k_video_about{"The view as it is seen now, over a range of time.",
                                      "現在の視点の動画。時間の範囲を選べます。"};
inline constexpr Phrase k_tables_about{
    "Bodies, nodes, elements, fixings, contacts, floor and energy over time, in a new folder.",
    "物体・節点・要素・固定具・接触・床・エネルギーの時刻歴を新しいフォルダに書きます。"};
inline constexpr Phrase k_export_without_before{
    "Without the pale run of the room as it was before: that is another recording.",
    "淡色で示した変更前の部屋の計算は別の記録なので含まれません。"};
inline constexpr Phrase k_export_recorded{"Only what is recorded can be exported, and this run is not.",
                                          "書き出せるのは記録だけです。この計算は記録されていません。"};
inline constexpr Phrase k_export_too_early{"There is no instant yet that could be exported.",
                                           "書き出せる時刻がまだありません。"};
inline constexpr Phrase k_export_newest{
    "Only the newest branch, {1}, is exported; branch {0} is shown. Choose {1} in the list of branches. "
    "The values plotted of branch {0} are written by CSV above the plots.",
    "書き出せるのは最新の分岐 {1} だけです（表示中は分岐 {0}）。分岐の一覧で {1} を選んでください。"
    "グラフにした値は、表示中の分岐 {0} のものもグラフの CSV で保存できます。"};
inline constexpr Phrase k_exporting{"Exporting {0}", "{0} を書き出しています"};
inline constexpr Phrase k_export_progress{"{0:.4g} of {1:.4g} {2}, {3:.3g}/s, {4:.0f} s left",
                                          "{0:.4g}/{1:.4g}、毎秒 {3:.3g}、残り {4:.0f} 秒"};
inline constexpr Phrase k_exports{"exports at work: {0}, {1:.0f} %   ", "書き出し中: {0}件、{1:.0f} %   "};
inline constexpr Phrase k_show_folder{"Open folder", "フォルダを開く"};
inline constexpr Phrase k_no_folder_program{"No program that shows folders is installed: {0}",
                                            "フォルダを表示するプログラムがありません: {0}"};
inline constexpr Phrase k_already_there{"{0} exists already; choose another name",
                                        "{0} はすでにあります。別の名前にしてください"};

}  // namespace topple::app::window_words
