#include "render/scene/overlay.h"

#include <gtest/gtest.h>
#include <imgui.h>

#include <limits>

#include "render/scene/legend.h"
#include "render/scene/text_layout.h"
#include "render/scene/ticks.h"
#include "tests/unit/render/off_screen.h"
#include "tests/unit/render/synthetic_cabinet.h"

namespace topple::render {
namespace {

void expect_tidy(const std::vector<OverlayBox>& boxes, int width, int height) {
  for (const OverlayBox& a : boxes) {
    EXPECT_GE(a.left, 0) << a.name;
    EXPECT_GE(a.top, 0) << a.name;
    EXPECT_LE(a.right, static_cast<float>(width)) << a.name;
    EXPECT_LE(a.bottom, static_cast<float>(height)) << a.name;
    for (const OverlayBox& b : boxes) {
      if (&a == &b) continue;
      const bool apart = a.right <= b.left || b.right <= a.left || a.bottom <= b.top || b.bottom <= a.top;
      EXPECT_TRUE(apart) << a.name << " overlaps " << b.name;
    }
  }
}

TEST(Overlay, parts_stay_inside_and_apart_at_every_size_with_any_length_of_text) {
  const int sizes[][2] = {{1280, 720}, {640, 360}, {1920, 1080}, {320, 180}, {720, 1280}, {64, 64}};
  for (const auto& size : sizes) {
    for (const bool verbose : {false, true}) {
      SCOPED_TRACE(testing::Message() << size[0] << " x " << size[1] << (verbose ? ", long texts" : ""));
      SceneFrame frame = synthetic_cabinet(6);
      add_words(frame);
      if (verbose) {
        const std::string much(400, 'W');
        frame.caption.title +=
            " with a title that goes on for much longer than any picture is wide, and then some " + much;
        for (int i = 0; i < 40; ++i) frame.caption.lines.push_back("line with α and β " + much);
        frame.caption.note += much + " " + frame.caption.note + frame.caption.note + much;
        frame.legend.quantity = "quantity of a rather long name that wraps " + much;
        frame.legend.unit = much;
        frame.legend.range_policy = much;
        frame.legend.mark_label = "mark with a long name too " + much;
        frame.legend.maximum = 1.5e7f;
        frame.legend.notes = {much, "deformation ×20"};
        frame.trace.label = much;
      }
      Picture picture(off_screen(), size[0], size[1]);
      picture.draw(frame, fit_camera(NamedView::iso, frame, picture.aspect()));
      expect_tidy(picture.overlay_boxes(), size[0], size[1]);
      if (size[1] >= 360 && size[0] >= 640) {
        EXPECT_EQ(picture.overlay_boxes().size(), 5u);
      }
    }
  }
}

constexpr float k_edge = 2;   // px, of letters over bodies
constexpr int k_strokes = 9;  // of such a letter: itself and its edge

TEST(Overlay, a_legend_alone_stays_in_its_room_and_fills_it) {
  ImGui::CreateContext();
  ImGui::GetIO().DisplaySize = {1280, 720};
  const OverlayFonts fonts = add_overlay_fonts(*ImGui::GetIO().Fonts, 720);
  ImGui::GetIO().Fonts->Build();
  ImGui::GetIO().IniFilename = nullptr;
  ImGui::NewFrame();
  SceneFrame frame;
  add_words(frame);
  LeftOut left_out;
  for (const float height : {200.0f, 330.0f, 600.0f}) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const int before = list.VtxBuffer.Size;
    const OverlayBox room{"", 700, 40, 880, 40 + height};
    const auto box = draw_legend_in(list, fonts, frame.legend, ColourMap::viridis, room, false, left_out);
    ASSERT_TRUE(box.has_value());
    EXPECT_EQ(box->name, "legend");
    EXPECT_NEAR(box->bottom, room.bottom, 25);
    ASSERT_GT(list.VtxBuffer.Size, before + 100);
    for (int i = before; i < list.VtxBuffer.Size; ++i) {
      const ImVec2 p = list.VtxBuffer[i].pos;
      EXPECT_TRUE(p.x >= room.left - k_edge && p.x <= room.right + k_edge && p.y >= room.top - k_edge &&
                  p.y <= room.bottom + k_edge)
          << p.x << ", " << p.y;
    }
  }
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const int before = list.VtxBuffer.Size;
  EXPECT_FALSE(
      draw_legend_in(list, fonts, frame.legend, ColourMap::viridis, {"", 0, 0, 180, 60}, false, left_out));
  EXPECT_FALSE(draw_legend_in(list, fonts, {}, ColourMap::viridis, {"", 0, 0, 180, 600}, false, left_out));
  EXPECT_EQ(left_out.legends, 0);
  frame.legend.maximum = frame.legend.minimum;
  EXPECT_FALSE(
      draw_legend_in(list, fonts, frame.legend, ColourMap::viridis, {"", 0, 0, 180, 600}, false, left_out));
  EXPECT_EQ(left_out.legends, 1);
  EXPECT_EQ(list.VtxBuffer.Size, before);
  ImGui::EndFrame();
  ImGui::DestroyContext();
}

TEST(Overlay, a_flat_legend_has_quantity_policy_ticks_mark_and_notes_in_its_room) {
  ImGui::CreateContext();
  ImGui::GetIO().DisplaySize = {1280, 720};
  const OverlayFonts fonts = add_overlay_fonts(*ImGui::GetIO().Fonts, 1440);
  ImGui::GetIO().Fonts->Build();
  ImGui::GetIO().IniFilename = nullptr;
  ImGui::NewFrame();
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const auto vertices = [&](const Legend& legend, const OverlayBox& room) {
    const int before = list.VtxBuffer.Size;
    const auto box = draw_flat_legend_in(list, fonts, legend, ColourMap::viridis, room, false);
    EXPECT_EQ(box.has_value(), list.VtxBuffer.Size > before);
    for (int i = before; i < list.VtxBuffer.Size; ++i) {
      const ImVec2 p = list.VtxBuffer[i].pos;
      EXPECT_TRUE(p.x >= box->left - k_edge && p.x <= box->right + k_edge && p.y >= box->top - k_edge &&
                  p.y <= box->bottom + k_edge)
          << p.x << ", " << p.y;
    }
    if (box) {
      EXPECT_TRUE(box->left == room.left && box->right == room.right && box->bottom == room.bottom);
      EXPECT_GE(box->top, room.top);
    }
    return list.VtxBuffer.Size - before;
  };
  const OverlayBox wide{"", 20, 100, 680, 300};
  Legend legend;
  legend.quantity = "stress";
  legend.unit = "MPa";
  legend.maximum = 18;
  const int bare = vertices(legend, wide);
  ASSERT_GT(bare, 100);
  legend.range_policy = "fixed";
  EXPECT_EQ(vertices(legend, wide), bare + k_strokes * 4 * 5);  // letters
  // 0, 5, 10, 15; a third of the width has no room for all of them, and one too narrow for anything
  legend.range_policy.clear();
  EXPECT_LT(vertices(legend, {"", 20, 100, 320, 300}), bare);
  EXPECT_EQ(vertices(legend, {"", 20, 100, 150, 300}), 0);
  EXPECT_EQ(vertices(legend, {"", 20, 270, 680, 300}), 0);
  legend.mark = 300;  // beyond the bar
  legend.mark_label = "yield";
  EXPECT_EQ(vertices(legend, wide), bare);
  legend.mark = 9;
  EXPECT_EQ(vertices(legend, wide), bare + k_strokes * 4 * 5 + 4);  // and the mark
  legend.notes = {"x5", "1 N"};
  EXPECT_EQ(vertices(legend, wide), bare + k_strokes * 4 * 5 + 4 + k_strokes * 4 * (1 + 2 + 1 + 2));
  legend.range_policy = legend.notes[0] = legend.quantity = std::string(400, 'W');
  EXPECT_GT(vertices(legend, wide), 0);
  ImGui::EndFrame();
  ImGui::DestroyContext();
}

TEST(Overlay, labels_stay_in_their_room_and_apart) {
  ImGui::CreateContext();
  ImGui::GetIO().DisplaySize = {1280, 720};
  const OverlayFonts fonts = add_overlay_fonts(*ImGui::GetIO().Fonts, 720);
  ImGui::GetIO().Fonts->Build();
  ImGui::GetIO().IniFilename = nullptr;
  ImGui::NewFrame();
  SceneFrame frame;
  for (int i = 0; i < 6; ++i)
    frame.labels.push_back({{0, 0, 1 + 0.01f * static_cast<float>(i)}, "My 12.3 N m"});
  frame.labels.push_back({{0, 0, 1e6f}, "far above"});
  frame.labels.push_back({{50, 0, 1}, "behind the eye"});
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const int before = list.VtxBuffer.Size;
  const OverlayBox room{"", 100, 50, 700, 450};
  const OverlayBox taken{"words", 100, 50, 700, 80};
  draw_labels(list, fonts, frame, look_at({10, 0, 1}, {0, 0, 1}, {0, 0, 1}, 1.5f, 0.1f, 100), room,
              room.bottom, std::span(&taken, 1));
  ASSERT_GT(list.VtxBuffer.Size, before);
  for (int i = before; i < list.VtxBuffer.Size; ++i) {
    const ImVec2 p = list.VtxBuffer[i].pos;
    EXPECT_TRUE(p.x >= room.left - 1 && p.x <= room.right + 1 && p.y >= taken.bottom - 1 &&
                p.y <= room.bottom + 1)
        << p.x << ", " << p.y;
  }
  // 60 mm are 10 px here, and each label is over 14 px high: they had to move apart
  float top = 1e9f, bottom = 0;
  for (int i = before; i < list.VtxBuffer.Size; ++i) {
    if (list.VtxBuffer[i].pos.y < taken.bottom + 30) continue;  // that of far above
    top = std::min(top, list.VtxBuffer[i].pos.y);
    bottom = std::max(bottom, list.VtxBuffer[i].pos.y);
  }
  EXPECT_GT(bottom - top, 6 * 14.f);
  ImGui::EndFrame();
  ImGui::DestroyContext();
}

/// Corners of all that is drawn of the frame's labels.
std::vector<ImVec2> labels_of(const SceneFrame& frame, const Camera& camera, const OverlayBox& room,
                              std::span<const OverlayBox> taken) {
  ImGui::CreateContext();
  ImGui::GetIO().DisplaySize = {room.right, room.bottom};
  const OverlayFonts fonts = add_overlay_fonts(*ImGui::GetIO().Fonts, 720);
  ImGui::GetIO().Fonts->Build();
  ImGui::GetIO().IniFilename = nullptr;
  ImGui::NewFrame();
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const int before = list.VtxBuffer.Size;
  draw_labels(list, fonts, frame, camera, room, room.bottom, taken);
  std::vector<ImVec2> drawn;
  for (int i = before; i < list.VtxBuffer.Size; ++i) drawn.push_back(list.VtxBuffer[i].pos);
  ImGui::EndFrame();
  ImGui::DestroyContext();
  return drawn;
}

// The picture is 1280 x 720, with 169 px for 1 m: 2.3 m are just left of the legend, 2.6 m under it.
TEST(Overlay, a_label_whose_usual_side_is_taken_by_the_legend_goes_to_the_other_and_no_line_crosses_it) {
  SceneFrame frame;
  frame.labels.push_back({{0, 4, 1}, "front door"});
  const OverlayBox room{"", 0, 0, 1280, 720}, legend{"legend", 1050, 0, 1280, 600};
  const Camera camera = look_at({-10, 0, 1}, {0, 0, 1}, {0, 0, 1}, 1280.f / 720, 0.1f, 100);
  const auto mirrored = [&](float y) {
    frame.labels[0].at[1] = y;
    return labels_of(frame, camera, room, std::span(&legend, 1));
  };
  for (const float y : {-2.3f, -2.6f, 2.3f}) {
    const std::vector<ImVec2> points = mirrored(y);
    ASSERT_FALSE(points.empty()) << y;
    for (const ImVec2& p : points) EXPECT_LE(p.x, legend.left + 1) << y << ": " << p.x << ", " << p.y;
  }
}

TEST(Overlay, a_label_keeps_off_a_body_beside_which_there_is_room) {
  SceneFrame frame;
  frame.labels.push_back({{0, 0, 1}, "aisle"});
  const OverlayBox room{"", 0, 0, 1280, 720};
  const Camera camera = look_at({-10, 0, 1}, {0, 0, 1}, {0, 0, 1}, 1280.f / 720, 0.1f, 100);
  const auto bounds = [&] {
    OverlayBox box{"", 1e9f, 1e9f, 0, 0};
    for (const ImVec2& p : labels_of(frame, camera, room, {})) {
      box.left = std::min(box.left, p.x), box.right = std::max(box.right, p.x);
      box.top = std::min(box.top, p.y), box.bottom = std::max(box.bottom, p.y);
    }
    return box;
  };
  const OverlayBox alone = bounds();
  EXPECT_GT(alone.left, 640);  // to the right of its place in the middle
  // a sheet from there to the right, 0.6 m high
  frame.panels.push_back({{{{0, -0.1f, 0.7f}, {0, -2, 0.7f}, {0, -2, 1.3f}, {0, -0.1f, 1.3f}}}, 0});
  const OverlayBox beside = bounds();
  EXPECT_LT(beside.right, 640);
  frame.panels[0].body = k_no_body;  // a door
  EXPECT_EQ(bounds().left, alone.left);
}

TEST(Overlay, ticks_are_round_and_inside) {
  const Ticks ticks = nice_ticks(0, 270, 5);
  EXPECT_EQ(ticks.values, (std::vector<double>{0, 100, 200}));
  EXPECT_EQ(ticks.decimals, 0);
  const Ticks fine = nice_ticks(-0.003, 0.003, 6);
  EXPECT_EQ(fine.decimals, 3);
  EXPECT_EQ(fine.values.size(), 7u);
  EXPECT_TRUE(nice_ticks(1, 1, 5).values.empty());
  EXPECT_TRUE(nice_ticks(0, std::numeric_limits<double>::infinity(), 5).values.empty());
}

TEST(Ticks, of_a_root_scale_are_round_and_stand_apart_on_the_bar) {
  const Ticks ticks = root_ticks(17.5);
  EXPECT_EQ(ticks.values, (std::vector<double>{10, 5, 2, 0.5, 0}));
  for (const double maximum : {0.03, 1.0, 7.0, 270.0, 1e6}) {
    SCOPED_TRACE(maximum);
    const std::vector<double> values = root_ticks(maximum).values;
    ASSERT_GE(values.size(), 3u);
    for (std::size_t i = 1; i < values.size(); ++i)
      EXPECT_GE(std::sqrt(values[i - 1] / maximum) - std::sqrt(values[i] / maximum), 0.119);
  }
  EXPECT_TRUE(root_ticks(0).values.empty());
}

class TextLayout : public testing::Test {
 protected:
  TextLayout() {
    fonts_ = add_overlay_fonts(atlas_, 720);
    atlas_.Build();
  }
  ImFontAtlas atlas_;
  OverlayFonts fonts_;
};

TEST_F(TextLayout, wrapped_lines_fit_and_keep_the_words) {
  const std::string text = "the floor moves and the cabinet answers, slowly at first";
  const std::vector<std::string> lines = wrapped(*fonts_.text, text, 160, 9);
  std::string joined;
  for (const std::string& line : lines) {
    EXPECT_LE(text_width(*fonts_.text, line), 160) << line;
    joined += (joined.empty() ? "" : " ") + line;
  }
  EXPECT_EQ(joined, text);
  EXPECT_EQ(wrapped(*fonts_.text, text, 160, 2).size(), 2u);
}

TEST_F(TextLayout, numbers_stay_whole_and_with_their_units) {
  const std::string text = "it lifts at 177.5 gal, 0.25 Hz or more";
  for (float width = 90; width < 300; width += 3)
    for (const std::string& line : wrapped(*fonts_.text, text, width, 9)) {
      EXPECT_EQ(line.find("177.5") != line.npos, line.find(" gal") != line.npos) << width << ": " << line;
      EXPECT_EQ(line.find("0.25") != line.npos, line.find(" Hz") != line.npos) << width << ": " << line;
    }
}

TEST_F(TextLayout, shortened_text_ends_with_an_ellipsis_between_letters) {
  const std::string cut = shortened(*fonts_.text, "ααααααααααααααααααααααααα", 100);
  EXPECT_LE(text_width(*fonts_.text, cut), 100);
  EXPECT_EQ(cut.size() % 2, 1u);  // two bytes a letter and three for the ellipsis
  EXPECT_EQ(cut.substr(cut.size() - 3), "…");
  EXPECT_EQ(shortened(*fonts_.text, "two\nlines", 500), "two lines");
}

TEST_F(TextLayout, captions_have_their_signs) {
  for (const ImWchar sign : {0x3b1, 0x3bc, 0xb2, 0x207b, 0x2076, 0xb0, 0xd7, 0x2212, 0x2264, 0x2026}) {
    EXPECT_NE(fonts_.text->FindGlyphNoFallback(sign), nullptr) << std::hex << sign;
  }
}

}  // namespace
}  // namespace topple::render
