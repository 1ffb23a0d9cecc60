// What the window says while a room is furnished.
#pragma once

#include "app/picture/window_words.h"

namespace topple::app::furnish_words {

// what is refused
inline constexpr Phrase k_is_anchored{
    "{0} is held by the anchor \"{1}\", which has its own place: take that away first",
    "{0} は固定具「{1}」で留められています。先に固定具を外してください"};
inline constexpr Phrase k_copy_is_held{
    "{0} is one of several copies, and a fixing, anchor or probe names {1}: take that away first",
    "{0} は複製の一つで、{1} を参照する固定具または測定点があります。先にそれを外してください"};
inline constexpr Phrase k_frame_turns_not{
    "{0} is a [[frame]] whose nodes have their own places: it cannot be turned",
    "{0} は節点座標で書かれた [[frame]] なので回転できません"};
inline constexpr Phrase k_frame_copied{
    "{0} is one of several copies of a [[frame]]: write more of them in the file",
    "{0} は [[frame]] の複製です。追加はファイルに書いてください"};
inline constexpr Phrase k_copies_share_name{"{0} is one of several copies, which share one name",
                                            "{0} は複製の一つで、名前を共有しています"};
inline constexpr Phrase k_wall_too_short{
    "a wall of {0:.0f} mm has no length: choose two places 100 mm apart or more",
    "長さ {0:.0f} mm の壁は作れません。100 mm 以上離れた2点を選んでください"};
inline constexpr Phrase k_no_wall{"a door stands in a wall, and this room has none",
                                  "扉を付ける壁がありません"};
inline constexpr Phrase k_no_room_for_copy{"there is no room for a second one beside {0}",
                                           "{0} の隣に置く場所がありません"};
inline constexpr Phrase k_not_to_there{"a {0} does not lead to {1}", "{0} は {1} には取り付けられません"};
inline constexpr Phrase k_only_shaken{"only a scene that is shaken can be furnished",
                                      "家具を配置できるのは加振するシーンだけです"};

// what to do
inline constexpr Phrase k_furnish{"Furnish", "配置"};
inline constexpr Phrase k_furnish_about{"Place, move and fix furniture in this room (F2)",
                                        "この部屋の家具を配置・移動・固定する（F2）"};
inline constexpr Phrase k_key_furnish{"furnish the room", "部屋の家具を配置"};
inline constexpr Phrase k_shake_it{"Shake it", "揺らす"};
inline constexpr Phrase k_shake_it_about{
    "A run of this room from the beginning, under the shake as it is set now (Space)",
    "現在の加振の設定で、この部屋を最初から計算する（Space）"};
inline constexpr Phrase k_new_room{"New room", "新しい部屋"};
inline constexpr Phrase k_new_room_about{"A floor, two walls and a bookshelf to begin with",
                                         "床・2面の壁・本棚から始める"};
inline constexpr Phrase k_back{"Back", "戻る"};
inline constexpr Phrase k_back_about{
    "To the run as it was, of the room before the changes; the room stays as it is here (F2)",
    "変更前の部屋の計算に戻る。ここでの配置は残る（F2）"};
inline constexpr Phrase k_run_before_changes{
    "the run of the room before it was changed; F2, then Space, runs the changed room",
    "変更前の部屋の計算です。変更後の部屋は F2、Space で計算します"};
inline constexpr Phrase k_undo_furnish{"Takes the last change back (Ctrl+Z)",
                                       "直前の変更を取り消す（Ctrl+Z）"};
inline constexpr Phrase k_redo_furnish{"Makes it again (Ctrl+Y)", "取り消した変更をやり直す（Ctrl+Y）"};

inline constexpr Phrase k_hint_select{
    "Click a piece to select it, drag it to move it. Choose one at the right and click where it is to stand.",
    "クリックで選択、ドラッグで移動。右の一覧から選び、置く場所をクリックします。"};
inline constexpr Phrase k_hint_selected{
    "{0}: drag or arrows move it, Q and E turn it, Ctrl+D copies it, Del removes it.",
    "{0}：ドラッグまたは矢印で移動、Q・E で回転、Ctrl+D で複製、Del で削除。"};
inline constexpr Phrase k_hint_place{
    "Click where the {0} is to stand; Q and E turn it, Esc lets go. With Shift: several.",
    "{0} を置く場所をクリック。Q・E で回転、Esc で中止、Shift で続けて配置。"};
inline constexpr Phrase k_hint_wall_from{"A wall: click one place that it goes through.",
                                         "壁：通る点をクリックしてください。"};
inline constexpr Phrase k_hint_wall_to{"A wall: click a second place. Its face will look at the furniture.",
                                       "壁：もう1点をクリック。表面は家具の側を向きます。"};
inline constexpr Phrase k_hint_door{"A door: click where it is in a wall.",
                                    "扉：壁の位置をクリックしてください。"};
inline constexpr Phrase k_hint_person{
    "A person: click where they are when the shake begins, on the floor or a bed.",
    "人：揺れ始めにいる場所（床またはベッドの上）をクリックしてください。"};
inline constexpr Phrase k_hint_fixing_from{"{0}: click the piece that it holds.",
                                           "{0}：固定する家具をクリックしてください。"};
inline constexpr Phrase k_hint_fixing_to{"{0}: click what it holds {1} to: {2}.",
                                         "{0}：{1} の取り付け先（{2}）をクリックしてください。"};
inline constexpr Phrase k_hint_to_wall{"a wall", "壁"};
inline constexpr Phrase k_hint_to_floor{"the floor", "床"};
inline constexpr Phrase k_hint_to_piece{"another piece", "別の家具"};
inline constexpr Phrase k_hint_or{"{0} or {1}", "{0}・{1}"};
inline constexpr Phrase k_checking{"checking …", "確認中…"};
inline constexpr Phrase k_furnishing{"furnishing", "配置中"};

inline constexpr Phrase k_ghost_before{"pale: the run before the room was changed",
                                       "淡色：変更前の部屋の計算"};
inline constexpr Phrase k_ghost_before_edited{
    "pale: the run before the room was changed; on its way it was given other values: {0}",
    "淡色：変更前の部屋の計算（途中で値を変更：{0}）"};

// the panel
inline constexpr Phrase k_tab_kinds{"Furniture", "家具"};
inline constexpr Phrase k_tab_piece{"Selected", "選択中"};
inline constexpr Phrase k_tab_room{"Room", "部屋"};
inline constexpr Phrase k_own_kind{"a file of your own, \"my-shelf.toml\"",
                                   "自作のファイル（my-shelf.toml）"};
inline constexpr Phrase k_nothing_selected{"Nothing is selected. Click a piece in the room.",
                                           "選択されていません。部屋の家具をクリックしてください。"};
inline constexpr Phrase k_name{"name", "名前"};
inline constexpr Phrase k_depth{"depth, mm", "奥行 [mm]"};
inline constexpr Phrase k_width{"width, mm", "幅 [mm]"};
inline constexpr Phrase k_height{"height, mm", "高さ [mm]"};
inline constexpr Phrase k_mass{"mass, empty, kg", "質量（空）[kg]"};
inline constexpr Phrase k_contents{"contents, kg", "内容物 [kg]"};
inline constexpr Phrase k_feet_friction{"friction of feet", "脚の摩擦係数"};
inline constexpr Phrase k_material{"material", "材料"};
inline constexpr Phrase k_of_kind{"by kind", "種類の既定"};
inline constexpr Phrase k_x{"x, m", "x [m]"};
inline constexpr Phrase k_y{"y, m", "y [m]"};
inline constexpr Phrase k_turned{"turned, °", "向き [°]"};
inline constexpr Phrase k_all_copies{"one of {0} copies, which share these", "{0} 個の複製で共通"};
inline constexpr Phrase k_reset_about{"as the kind has it", "種類の既定に戻す"};
inline constexpr Phrase k_in_file{"Its size and mass are written in the file.",
                                  "寸法と質量はファイルに書かれています。"};
inline constexpr Phrase k_walls{"Walls", "壁"};
inline constexpr Phrase k_add_wall{"Wall through two places", "2点を通る壁"};
inline constexpr Phrase k_ceiling{"ceiling, m", "天井 [m]"};
inline constexpr Phrase k_fixings{"Fixings", "固定具"};
inline constexpr Phrase k_fixings_about{"Choose one, then click a piece and what it is held to.",
                                        "種類を選び、家具と取り付け先を順にクリックします。"};
inline constexpr Phrase k_fixing_line{"{0}: {1} to {2}", "{0}：{1} → {2}"};
inline constexpr Phrase k_fixing_off_line{"{0}: {1} to {2}, not in place", "{0}：{1} → {2}（取り外し）"};
inline constexpr Phrase k_way_out{"Doors, people", "扉・人"};
inline constexpr Phrase k_way_out_about{"The run then tells who is hit and whose way out is blocked.",
                                        "計算結果に、誰に当たるか、避難経路が塞がるかを表示します。"};
inline constexpr Phrase k_add_door{"Door", "扉"};
inline constexpr Phrase k_add_person{"Person", "人"};
inline constexpr Phrase k_door_width{"{0}, mm wide", "{0}の幅 [mm]"};
inline constexpr Phrase k_person_line{"{0}: x {1:.2f} m, y {2:.2f} m", "{0}：x {1:.2f} m、y {2:.2f} m"};
inline constexpr Phrase k_fixings_went{
    "What was fixed to {0} is not fixed any more, and doors in it are gone; Ctrl+Z brings them back.",
    "{0}に固定していた家具の固定も、{0}のドアもなくなりました。Ctrl+Z で元に戻ります。"};
inline constexpr Phrase k_remove_about{"Takes it away", "取り除く"};

// the picture of a run
inline constexpr Phrase k_draw_bodies{"bodies", "物体"};
inline constexpr Phrase k_draw_bodies_as[] = {{"beams", "骨組"}, {"solid", "外観"}, {"both", "両方"}};
inline constexpr Phrase k_draw_bodies_about{
    "beams: as computed, coloured; solid: as it looks in a room, without stresses (S)",
    "骨組: 計算どおりに色付きで表示。外観: 応力を示さず、部屋で見える姿で表示（S）"};
inline constexpr Phrase k_key_solid{"beams, solid furniture, or both", "骨組／家具の外観／両方"};

inline constexpr Phrase k_keep{"keep what falls in the picture", "倒れた物も画面に収める"};
inline constexpr Phrase k_keep_about{"The camera goes back and aside when a body would leave the picture (K)",
                                     "物体が画面から出そうになると、カメラが下がり、横へ動きます（K）"};
inline constexpr Phrase k_key_keep{"keep what falls in the picture, or not",
                                   "倒れた物を画面に収める／収めない"};

inline constexpr Phrase k_key_hide{"the scene alone, for a projector",
                                   "シーンだけを表示（プロジェクター用）"};
inline constexpr Phrase k_key_full_screen{"full screen", "全画面表示"};

// keys
inline constexpr Phrase k_arrow_keys{"arrows", "矢印"};
inline constexpr Phrase k_key_move{"move by 10 mm, with Shift by 100 mm", "10 mm 移動（Shift で 100 mm）"};
inline constexpr Phrase k_key_turn_piece{"turn by 15°, with Shift by 1°", "15° 回転（Shift で 1°）"};
inline constexpr Phrase k_key_delete{"remove the selected piece", "選択した家具を削除"};
inline constexpr Phrase k_key_copy{"a second one beside it", "隣に複製"};
inline constexpr Phrase k_key_undo_room{"undo", "元に戻す"};
inline constexpr Phrase k_key_redo_room{"redo", "やり直す"};
inline constexpr Phrase k_key_shake{"shake the room", "部屋を揺らす"};
inline constexpr Phrase k_key_back{"back to the run, and here again", "計算と配置の切り替え"};
inline constexpr Phrase k_key_views{"views, all of the room", "視点、全体表示"};
inline constexpr Phrase k_key_drag{"drag a piece: move it; the room: turn the view",
                                   "家具をドラッグ：移動、背景：視点の回転"};
inline constexpr Phrase k_key_let_go_room{"let go", "選択・操作の解除"};

// kinds of furniture, by their names in scenes
inline constexpr Phrase k_kinds[] = {{"bed", "ベッド"},
                                     {"bookshelf", "本棚"},
                                     {"cabinet", "書庫"},
                                     {"chair", "椅子"},
                                     {"chest", "たんす"},
                                     {"cupboard", "食器棚"},
                                     {"desk", "事務机"},
                                     {"filing-cabinet", "書類整理庫"},
                                     {"locker", "ロッカー"},
                                     {"piano", "ピアノ"},
                                     {"refrigerator", "冷蔵庫"},
                                     {"school-chair", "学校用椅子"},
                                     {"school-desk", "学校用机"},
                                     {"server-rack", "サーバーラック"},
                                     {"shelf-rack", "スチールラック"},
                                     {"table", "テーブル"},
                                     {"television", "テレビ"},
                                     {"wardrobe", "洋服だんす"},
                                     {"washing-machine", "洗濯機"}};
inline constexpr Phrase k_fixing_kinds[] = {{"L-bracket", "L型金具"},  {"strap", "ベルト"},
                                            {"pole", "突っ張り棒"},    {"mat", "粘着マット"},
                                            {"stopper", "ストッパー"}, {"connector", "連結金具"}};

/// The word of a table in the language of the window; as it is where the table does not have it.
template <std::size_t n>
std::string in_words(const Phrase (&table)[n], const std::string& word) {
  for (const Phrase& one : table)
    if (one.english == word) return say(one);
  return word;
}

}  // namespace topple::app::furnish_words
