// Charts over time, as timeline and plots draw them.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include <imgui.h>

#include "app/chart/theme.h"
#include "app/live/player.h"

namespace topple::app {

/// Time, or the way through the loads, to the right; one quantity upwards.
struct Lane {
  float left, right, top, bottom;
  double length;     ///< s; statics: of the whole way
  double low, high;  ///< of the quantity
  float x(double t) const { return left + static_cast<float>(t / length) * (right - left); }
  float y(double value) const {
    return bottom - static_cast<float>((value - low) / (high - low)) * (bottom - top);
  }
};

/// Of a line with x that does not fall, those points that it needs to pass all others at most `tolerance`
/// above or below.
std::vector<ImVec2> without_straight_points(std::span<const ImVec2> points, float tolerance);

/// Value at the row of that index; not finite: none.
using ValueAt = std::function<double(std::size_t)>;

/// Of curves, px. Whole ones: others are made of three times as many triangles.
inline constexpr float k_thin_curve = 1, k_thick_curve = 2;

/// x of each row, px.
std::vector<float> places_of(const Lane& lane, std::span<const RowPtr> rows);

/// Draws at most the least and greatest value of each pixel column, with gaps where there is none.
void add_curve(ImDrawList& list, const Lane& lane, std::span<const float> places, const ValueAt& value,
               ImU32 colour, float thickness);
void add_curve(ImDrawList& list, const Lane& lane, std::span<const RowPtr> rows, const ValueAt& value,
               ImU32 colour, float thickness);

void add_text(ImDrawList& list, float x, float y, ImU32 colour, const std::string& text);
float text_width(const std::string& text);
/// Below each other in the panel, as many lines as it takes; numbers stay whole, as ImGui::TextWrapped does
/// not keep them.
void text_wrapped(const std::string& text);

/// Ticks and times below a lane; of a static run load factors, or where displacements are controlled load
/// steps, with their name at `label_left`.
void add_axis(ImDrawList& list, const Lane& lane, const Setup& setup, float label_left);

}  // namespace topple::app
