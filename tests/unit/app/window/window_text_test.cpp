// Every text that the window shows, caught on its way to Dear ImGui's draw lists: none is clipped, none lies
// on another, each is large enough and has contrast enough. The linker leads ImDrawList::AddText here.
#include <gtest/gtest.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <ostream>
#include <set>

#include "app/chart/theme.h"
#include "app/furnish/room_edits.h"
#include "app/panels/precision_words.h"
#include "app/panels/teaching_words.h"
#include "app/picture/image_files.h"
#include "app/picture/window_words.h"
#include "app/window/shell.h"
#include "app/window/viewer.h"
#include "render/output/image.h"
#include "unit/app/live.h"
#include "unit/app/mouse.h"
#include "unit/render/off_screen.h"
#include "unit/render/scratch.h"

namespace {

struct Shown {
  const ImDrawList* list;
  std::string words;
  ImRect box, clip;
  ImU32 colour;
  float size;
  bool scrolls;                    ///< up and down: what is not seen can be reached
  std::optional<ImU32> edge = {};  ///< colour around its letters, where they lie over bodies
};
std::vector<Shown> shown;
bool listening = false, mute = false;

/// The strokes around letters come before these, and are no words of their own.
void take_edges() {
  constexpr std::size_t k_strokes = 8;
  constexpr float k_edge = 3;  // px
  std::vector<Shown> words;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const auto is_edge_of = [&](const Shown& text) {
      const ImVec2 a = shown[i].box.Min, b = text.box.Min;
      return text.list == shown[i].list && text.words == shown[i].words && text.colour != shown[i].colour &&
             std::abs(a.x - b.x) <= k_edge && std::abs(a.y - b.y) <= k_edge;
    };
    const auto next = shown.begin() + static_cast<std::ptrdiff_t>(i) + 1;
    const auto last = next + static_cast<std::ptrdiff_t>(std::min(k_strokes, shown.size() - i - 1));
    if (const auto text = std::find_if(next, last, is_edge_of); text != last)
      text->edge = shown[i].colour;
    else
      words.push_back(shown[i]);
  }
  shown = words;
}

/// Whether a window that is drawn later lies on it.
bool is_covered(const ImDrawList* list, const ImRect& box) {
  bool above = list == ImGui::GetBackgroundDrawList();
  for (const ImGuiWindow* window : GImGui->Windows) {
    if (window->DrawList == list) {
      above = true;
    } else if (above && window->Active && window->ParentWindow == nullptr) {
      ImRect both = window->Rect();
      both.ClipWithFull(box);
      if (both.GetArea() > 0) return true;
    }
  }
  return false;
}

/// Whether the list is of a window that scrolls, or a part of one.
bool scrolls(const ImDrawList* list) {
  for (const ImGuiWindow* window : GImGui->Windows)
    if (window->DrawList == list) return window->ScrollMax.y > 0;
  return false;
}

}  // namespace

extern "C" {
// ImDrawList::AddText(const ImFont*, float, const ImVec2&, ImU32, const char*, const char*, float, const
// ImVec4*)
void __real__ZN10ImDrawList7AddTextEPK6ImFontfRK6ImVec2jPKcS7_fPK6ImVec4(ImDrawList*, const ImFont*, float,
                                                                         const ImVec2&, ImU32, const char*,
                                                                         const char*, float, const ImVec4*);
// ImDrawList::AddText(const ImVec2&, ImU32, const char*, const char*)
void __real__ZN10ImDrawList7AddTextERK6ImVec2jPKcS4_(ImDrawList*, const ImVec2&, ImU32, const char*,
                                                     const char*);

void __wrap__ZN10ImDrawList7AddTextEPK6ImFontfRK6ImVec2jPKcS7_fPK6ImVec4(ImDrawList* list, const ImFont* font,
                                                                         float size, const ImVec2& at,
                                                                         ImU32 colour, const char* begin,
                                                                         const char* end, float wrap,
                                                                         const ImVec4* fine) {
  if (!font) font = GImGui->Font;
  if (size == 0) size = GImGui->FontSize;
  if (!end) end = begin + std::strlen(begin);
  if (listening && end > begin) {
    const ImVec2 extent = font->CalcTextSizeA(size, FLT_MAX, wrap, begin, end);
    const ImVec4 c = list->_CmdHeader.ClipRect;
    ImRect clip(c.x, c.y, c.z, c.w);
    if (fine) clip.ClipWith(ImRect(fine->x, fine->y, fine->z, fine->w));
    shown.push_back({list, std::string(begin, end), ImRect(at, {at.x + extent.x, at.y + extent.y}), clip,
                     colour, size, scrolls(list)});
  }
  if (!mute)
    __real__ZN10ImDrawList7AddTextEPK6ImFontfRK6ImVec2jPKcS7_fPK6ImVec4(list, font, size, at, colour, begin,
                                                                        end, wrap, fine);
}

void __wrap__ZN10ImDrawList7AddTextERK6ImVec2jPKcS4_(ImDrawList* list, const ImVec2& at, ImU32 colour,
                                                     const char* begin, const char* end) {
  __wrap__ZN10ImDrawList7AddTextEPK6ImFontfRK6ImVec2jPKcS7_fPK6ImVec4(
      list, list->_Data->Font, list->_Data->FontSize, at, colour, begin, end, 0, nullptr);
}
}

namespace topple::app {
namespace {

double luminance(double r, double g, double b) {
  const auto linear = [](double c) {
    c /= 255;
    return c <= 0.03928 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  };
  return 0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b);
}

/// WCAG 2.1's contrast ratio of a colour, as its alpha lets it be, on a pixel.
double contrast(ImU32 colour, const std::uint8_t* pixel) {
  const double alpha = ((colour >> IM_COL32_A_SHIFT) & 255) / 255.;
  const auto mixed = [&](int shift, int k) {
    return alpha * ((colour >> shift) & 255) + (1 - alpha) * pixel[k];
  };
  const double text =
      luminance(mixed(IM_COL32_R_SHIFT, 0), mixed(IM_COL32_G_SHIFT, 1), mixed(IM_COL32_B_SHIFT, 2));
  const double ground = luminance(pixel[0], pixel[1], pixel[2]);
  return (std::max(text, ground) + 0.05) / (std::min(text, ground) + 0.05);
}

struct Look {
  float width, height;
  Appearance appearance;
  const char* name;
};
void PrintTo(const Look& look, std::ostream* out) {
  *out << look.name;
}

class WindowText : public ::testing::TestWithParam<Look> {
 protected:
  WindowText() : interface_(ImGui::CreateContext()) {}
  ~WindowText() override {
    shell_.reset();
    viewer_.reset();
    player_.reset();
    run_.reset();
    ImGui::DestroyContext(interface_);
    window_language() = Language::english;
    window_is_dark() = false;
  }
  void start(const std::shared_ptr<const io::Scene>& scene = live_scene()) {
    const Look& look = GetParam();
    run_.emplace(LiveSource{.scene = scene, .recording = {}, .output = {}});
    player_.emplace(scene, *run_);
    stage_.emplace(render::off_screen());
    viewer_.emplace(*player_, *stage_, 1.f, render::NamedView::iso, PictureSettings{}, look.appearance);
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = {look.width, look.height};
    io.DeltaTime = 1.f / 60;
    ASSERT_TRUE(eventually([this] { frame(); }, [this] { return player_->can_edit(); }));
    for (int i = 0; i < 3; ++i) player_->faster();
    player_->play();
    ASSERT_TRUE(
        eventually([this] { frame(); }, [this] { return player_->status().kind == LiveStatus::Kind::over; }));
    for (int i = 0; i < 40; ++i) frame();
  }
  void frame() {
    shell_ ? shell_->update(1. / 60) : viewer_->update(1. / 60);
    ImGui::NewFrame();
    shell_ ? shell_->build() : viewer_->build();
  }
  render::Image shot() {
    return stage_->shot(shell_ ? shell_->surface() : viewer_->surface(), *ImGui::GetDrawData());
  }
  /// The complete window, with the chooser of scenes over it.
  void start_shell() {
    setenv("XDG_STATE_HOME", (scratch_ / "state").c_str(), 1);
    setenv("XDG_CACHE_HOME", (scratch_ / "cache").c_str(), 1);
    const Look& look = GetParam();
    stage_.emplace(render::off_screen());
    shell_.emplace(
        *stage_, 1.f, [] {}, "", look.appearance);
    ImGui::GetIO().DisplaySize = {look.width, look.height};
    ImGui::GetIO().DeltaTime = 1.f / 60;
    shell_->choose_scene();
    for (int i = 0; i < 10; ++i) frame();
  }
  void open_with(char key) {
    shell_->press({key, true, false});
    for (int i = 0; i < 5; ++i) frame();
  }
  void close_over() {
    shell_->press({render::key::escape, false, false});
    for (int i = 0; i < 5; ++i) frame();
  }

  /// Points everywhere in `box` and reads what tooltips appear; how many different ones.
  std::size_t tooltips(const ImRect& box) {
    std::set<std::string> seen_tips;
    const float scale = ImGui::GetFontSize() / 14;
    for (float y = box.Min.y + 4; y < box.Max.y; y += 13 * scale)
      for (float x = box.Min.x + 6; x < box.Max.x; x += 20 * scale) {
        ImGui::GetIO().MousePos = {x, y};
        frame();
        shown.clear();
        listening = true;
        frame();
        listening = false;
        const ImGuiWindow* const tip = ImGui::FindWindowByName("##Tooltip_00");
        if (!tip || !tip->Active) continue;
        std::string words;
        for (const Shown& text : shown)
          if (text.list == tip->DrawList) words += text.words;
        if (words == say(window_words::k_plot)) plot_place_ = ImVec2(x, y);
        if (seen_tips.insert(words).second) check("tooltip-" + words.substr(0, 12));
      }
    return seen_tips.size();
  }
  void click(const ImVec2& at) {
    ImGui::GetIO().MousePos = at;
    for (const bool down : {false, true, false}) {
      ImGui::GetIO().MouseDown[0] = down;
      frame();
      frame();
    }
  }

  void check(const std::string& what) {
    SCOPED_TRACE(std::string(GetParam().name) + ", " + what);
    for (int i = 0; i < 3; ++i) frame();
    shown.clear();
    listening = true;
    frame();
    listening = false;
    if (const char* const folder = std::getenv("TOPPLE_LOOK"))
      write_png(std::string(folder) + "/" + GetParam().name + "-" + what + ".png", shot());
    mute = true;
    frame();
    mute = false;
    const render::Image ground = shot();
    take_edges();
    EXPECT_GT(shown.size(), 10u);
    std::erase_if(shown, [](const Shown& text) { return is_covered(text.list, seen(text)); });
    EXPECT_GT(shown.size(), 2u);
    for (const Shown& text : shown) check_text(text, ground);
    for (std::size_t i = 0; i < shown.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) check_apart(shown[i], shown[j]);
  }

  static ImRect seen(const Shown& text) {
    ImRect box = text.box;
    box.ClipWithFull(text.clip);
    return box;
  }
  static void check_text(const Shown& text, const render::Image& ground) {
    SCOPED_TRACE("\"" + text.words + "\"");
    EXPECT_GE(text.size, 12);
    EXPECT_GE(text.box.Min.x, text.clip.Min.x - 0.5f);
    EXPECT_LE(text.box.Max.x, text.clip.Max.x + 0.5f) << "it is clipped at the right";
    if (!text.scrolls) {
      EXPECT_GE(text.box.Min.y, text.clip.Min.y - 1.5f);
      EXPECT_LE(text.box.Max.y, text.clip.Max.y + 1.5f) << "it is clipped below";
    }
    if (text.edge) {
      const std::uint8_t around[] = {static_cast<std::uint8_t>(*text.edge >> IM_COL32_R_SHIFT),
                                     static_cast<std::uint8_t>(*text.edge >> IM_COL32_G_SHIFT),
                                     static_cast<std::uint8_t>(*text.edge >> IM_COL32_B_SHIFT)};
      EXPECT_GE(contrast(text.colour, around), 4.5);
      return;
    }
    const ImRect box = seen(text);
    int pixels = 0, poor = 0;
    for (int y = std::max(0, static_cast<int>(box.Min.y));
         y < std::min<int>(ground.height, static_cast<int>(box.Max.y)); ++y)
      for (int x = std::max(0, static_cast<int>(box.Min.x));
           x < std::min<int>(ground.width, static_cast<int>(box.Max.x)); ++x) {
        ++pixels;
        poor +=
            contrast(text.colour,
                     &ground.rgba[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(ground.width) +
                                       static_cast<std::size_t>(x))]) < 4.5;
      }
    // a line or a grab may cross a word
    EXPECT_LE(poor, 0.15 * pixels) << "contrast below 4.5";
  }
  static void check_apart(const Shown& a, const Shown& b) {
    if (a.list != b.list) return;  // a popup covers what is below it
    ImRect both = seen(a);
    both.ClipWithFull(seen(b));
    // boxes are as high as the tallest letter of the font: neighbours may share a row or two
    EXPECT_FALSE(both.GetWidth() > 1.5f && both.GetHeight() > 0.25f * std::min(a.size, b.size))
        << "\"" << a.words << "\" lies on \"" << b.words << "\"";
  }
  ImGuiContext* interface_;
  std::optional<ImVec2> plot_place_;  // of the last sign that plots a value
  std::optional<LiveRun> run_;
  std::optional<Player> player_;
  std::optional<render::Stage> stage_;
  std::optional<Viewer> viewer_;
  const render::Scratch scratch_;
  std::optional<Shell> shell_;
};

TEST_P(WindowText, is_read_in_every_panel) {
  start();
  static constexpr const char* k_tabs[] = {"parameters", "picture", "inspect", "learn"};
  for (std::size_t tab = 0; tab < std::size(k_tabs); ++tab) {
    viewer_->show(static_cast<Viewer::Tab>(tab));
    check(k_tabs[tab]);
  }
  viewer_->inspect(Subject{Subject::Kind::member, 0});
  check("member");
  viewer_->inspect(Subject{Subject::Kind::body, 0});
  check("body");
  player_->scrub(0.4);
  check("past");
  viewer_->press({'R', false, false});
  ASSERT_TRUE(eventually([this] { frame(); },
                         [this] { return player_->history().branches.size() == 2 && player_->can_edit(); }));
  check("restarted");
  viewer_->press({render::key::f1, false, false});
  check("keys");
}

TEST_P(WindowText, is_read_beside_a_load_path) {
  start(std::make_shared<const io::Scene>(io::load_scene("portal-pushover")));
  check("loads");
}

TEST_P(WindowText, is_read_in_studies_of_the_present_scene) {
  start();
  const auto draw = [this] { frame(); };
  viewer_->show(Viewer::Tab::teach);
  ASSERT_TRUE(click_button(say(window_words::k_overturning_map) + "##map", "side/content", draw));
  const auto map = [&] { return viewer_->teaching().map.search->result(); };
  ASSERT_TRUE(eventually(draw, [&] { return map() && map()->map.run > 15; }));
  check("map-under-way");
  ASSERT_TRUE(click_button(say(window_words::k_cancel) + "##cancel-map", "side/content", draw));
  ASSERT_TRUE(eventually(draw, [&] { return viewer_->teaching().map.search->over(); }));
  check("map");
  const Box& cells = viewer_->teaching().map.cells;
  ImGui::GetIO().MousePos = {cells.left + cells.width / 2, cells.top + cells.height / 3};
  check("map-cell");
  ImGui::GetIO().MousePos = {2, 400};
  viewer_->show(Viewer::Tab::parameters);
  ASSERT_TRUE(click_button(say(window_words::k_precision) + "##precision", "side/content", draw));
  check("precision-under-way");
  ASSERT_TRUE(eventually(draw, [&] { return viewer_->precision().points.size() > 15; }));
  check("precision");
}

TEST_P(WindowText, is_read_in_the_chooser_dialogs_and_messages) {
  start_shell();
  check("chooser");
  shell_->show({.scene = live_scene(), .recording = {}, .output = (scratch_ / "a.h5").string()}, "");
  ASSERT_TRUE(eventually([this] { frame(); }, [this] { return shell_->session()->player().can_edit(); }));
  open_with('S');
  check("save");
  close_over();
  open_with('E');
  for (const auto what :
       {ExportDialog::What::picture, ExportDialog::What::video, ExportDialog::What::tables}) {
    shell_->export_dialog().what = what;
    check("export-" + std::to_string(static_cast<int>(what)));
  }
  close_over();
  const std::string broken = (scratch_ / "broken.toml").string();
  std::ofstream(broken) << "topple = 1\nnonsense = 2\n";
  shell_->drop({broken});
  ASSERT_TRUE(eventually([this] { frame(); }, [this] { return shell_->message().has_value(); }));
  check("message");
}

TEST_P(WindowText, is_read_while_a_room_is_furnished) {
  start_shell();
  shell_->furnish_new_room();
  for (int i = 0; i < 20; ++i) frame();  // a picture of the palette each
  FurnishView& room = *shell_->room();
  check("furnish-kinds");
  room.arm_kind("server-rack");
  check("furnish-armed");
  room.arm_fixing("L-bracket");
  room.show(FurnishView::Tab::room);
  check("furnish-room");
  room.change([](const io::Scene& scene) { return with_fixing(scene, "L-bracket", "bookshelf", "back"); });
  check("furnish-fixed");
  shell_->press({render::key::escape, false, false});
  room.select("bookshelf");
  check("furnish-piece");
  shell_->press({render::key::del, false, false});
  EXPECT_FALSE(room.room().refused().empty());
  check("furnish-refused");
  shell_->press({render::key::f1, false, false});
  check("furnish-keys");
}

TEST_P(WindowText, is_read_in_tooltips_of_the_panels) {
  start();
  const auto box_of = [](const char* name) {
    const ImGuiWindow* const window = ImGui::FindWindowByName(name);
    return window ? window->Rect() : ImRect();
  };
  EXPECT_GE(tooltips(box_of("transport")), 5u);
  EXPECT_GE(tooltips(box_of("timeline")), 1u);
  viewer_->show(Viewer::Tab::picture);
  EXPECT_GE(tooltips(box_of("side")), 1u);
  viewer_->show(Viewer::Tab::teach);
  tooltips(box_of("side"));
  viewer_->show(Viewer::Tab::parameters);
  EXPECT_GE(tooltips(box_of("side")), 3u);
  viewer_->inspect(Subject{Subject::Kind::member, 0});
  EXPECT_GE(tooltips(box_of("side")), 3u);
  ASSERT_TRUE(plot_place_.has_value());
  click(*plot_place_);
  EXPECT_GE(tooltips(box_of("plots")), 2u);
}

TEST_P(WindowText, is_read_in_tooltips_of_the_chooser) {
  start_shell();
  const Look& look = GetParam();
  EXPECT_GE(tooltips({0, 0, look.width, look.height}), 1u);
}

constexpr Language k_ja = Language::japanese, k_en = Language::english;

TEST_P(WindowText, lists_a_stopper_which_no_box_switches) {
  start(std::make_shared<const io::Scene>(io::parse_scene(R"(topple = 1
floor = {}
run = { duration = 0.02, want = ["motion"] }
wall = [{ name = "back", at = [0, 0], normal = [1, 0, 0] }]
furniture = [{ kind = "bookshelf", against = "back", gap = "10 mm" }]
fixing = [{ name = "stop", kind = "stopper", body = "bookshelf", to = "floor" }]
)",
                                                          "s.toml")));
  shown.clear();
  listening = true;
  const auto tells = [](const Shown& text) { return text.words.starts_with("stop"); };
  const auto told_at = [&](float scroll) {
    for (ImGuiWindow* const window : GImGui->Windows)
      if (std::string(window->Name).starts_with("side/content")) ImGui::SetScrollY(window, scroll);
    for (int i = 0; i < 3; ++i) frame();
    return std::ranges::find_if(shown, tells);
  };
  auto told = told_at(0);
  for (float scroll = 0; told == shown.end() && scroll < 2000; scroll += 100) told = told_at(scroll);
  listening = false;
  ASSERT_NE(told, shown.end());
  EXPECT_EQ(told->colour, ImGui::GetColorU32(ImGuiCol_TextDisabled));
}

/// Letters four steps larger than usual.
class LargeLetters : public WindowText {};
TEST_P(LargeLetters, cut_no_line_in_the_scene_that_has_room_for_it) {
  start(std::make_shared<const io::Scene>(io::load_scene("classroom", {"run.duration=0.02"})));
  for (int i = 0; i < 3; ++i) frame();
  shown.clear();
  listening = true;
  frame();
  listening = false;
  const auto tells = [](const Shown& text) { return text.words.find("339.3 gal") != std::string::npos; };
  EXPECT_TRUE(std::ranges::any_of(shown, tells));
}
INSTANTIATE_TEST_SUITE_P(Looks, LargeLetters,
                         ::testing::Values(Look{1280, 720, {1.75, false, k_en}, "english"},
                                           Look{1280, 720, {1.75, false, k_ja}, "japanese"}),
                         [](const auto& look) { return std::string(look.param.name); });

INSTANTIATE_TEST_SUITE_P(Looks, WindowText,
                         ::testing::Values(Look{1280, 720, {1, false, k_en}, "light"},
                                           Look{1280, 720, {2, false, k_en}, "large"},
                                           Look{1920, 1080, {3, false, k_en}, "huge"},
                                           Look{1280, 720, {3, true, k_en}, "too-large"},
                                           Look{1280, 720, {1, false, k_ja}, "japanese"},
                                           Look{1280, 720, {2, true, k_ja}, "large-dark-japanese"}),
                         [](const auto& look) {
                           std::string name = look.param.name;
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace topple::app
