// The parts of the window around the scene. Each draws into the Dear ImGui frame under way.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/live/player.h"
#include "app/panels/appearance.h"
#include "app/panels/subject.h"
#include "app/panels/ways_lines.h"
#include "app/picture/picture_settings.h"
#include "render/output/stage.h"
#include "render/scene/font.h"

struct ImDrawList;

namespace topple::app {

/// A rectangle of the window, in Dear ImGui's coordinates.
struct Box {
  float left = 0, top = 0, width = 0, height = 0;
  bool contains(float x, float y) const {
    return x >= left && x < left + width && y >= top && y < top + height;
  }
};

/// Sets fonts and style of the current Dear ImGui context, in the language of `appearance`. `scale`: 1 for
/// 720 lines, times that of `appearance`. `scene`: whose names are shown; null: none. Throws
/// std::runtime_error without the font.
render::OverlayFonts set_up_interface(render::Stage& stage, float scale, const Appearance& appearance,
                                      const io::Scene* scene);

/// An entry of a list that drops down, which Return takes as Space and a click do.
bool list_entry(const std::string& label, bool chosen);

/// Begins a window that fills `box` and does nothing else; ImGui::End() ends it. Keys move among what is in
/// it. What lies under it is seen through: the colour of surface_with_scene, which a software context
/// clears faster than it fills a window.
void begin_panel(const char* name, const Box& box);

/// The whole window, in the colour of panels where the scene is not.
render::Surface surface_with_scene(const Box& scene);

/// What a person asks of the shell around the viewer (shell.h).
enum class ShellRequest { none, scenes, save, export_view, furnish, new_room, shake };

/// Buttons for play, pause, steps, speed, loop, restart, branches, undo and redo, and for the shell, in as
/// many rows as the width of the box asks for; `height`: that they need.
ShellRequest draw_transport_bar(Player& player, const Box& box, float& height);

/// Another run beside the one shown.
struct GhostCurves {
  std::span<const RowPtr> way;
  std::vector<int> body;  ///< per piece of furniture of the run shown, the index of its own; -1: it has none
};

/// Tilts of each piece of furniture over Player::way(), kept from frame to frame.
class TiltHistory {
 public:
  void follow(const Player& player);

  bool shares() const { return shares_; }  ///< of the critical angle, cut in shown(); else degrees
  const std::vector<double>& greatest() const { return greatest_; }  ///< of each piece
  double shown(std::size_t row, std::size_t piece) const { return shown_[row * greatest_.size() + piece]; }

 private:
  bool shares_ = false;
  std::vector<double> greatest_;
  std::vector<float> shown_;  // row by row
  RowPtr first_, last_;       // rows that it has begun and ended with
};

/// Greatest acceleration of the floor along an axis, m/s^2: of the rows, or where a peak that a single shake
/// has in the scene lies between two of them, that one.
double floor_peak(const std::vector<RowPtr>& rows, const std::vector<Shake>& shakes, double output_rate);

/// Floor acceleration (statics: load factor) and tilt over time (statics: over the load path), with marks for
/// events, edits and forks; dragging scrubs.
/// `ghost`: the run that is drawn pale.
void draw_timeline(Player& player, const Box& box, TiltHistory& tilts, const GhostCurves& ghost = {});

/// Of a static run: load factor over the displacement of one place, with where stability is lost and the
/// present step. A click goes to the load step nearest to it.
void draw_load_path(Player& player, const Box& box);

/// Sliders of what may be edited. What was refused, and why, is left in `refused`. True when the chart of
/// error against cost is asked for.
bool draw_parameters(Player& player, std::string& refused);

/// Colours by another quantity; a fixed range, which had the unit of the last one, becomes that of the run.
void choose_colour(PictureSettings& settings, BeamQuantity colour);

/// Theme, language and scale. True when one was changed.
bool draw_appearance(Appearance& appearance);

/// Colours, deformation and what is shown beside bodies. `maximum`: where the colours end now, in the
/// quantity's unit. True when anything changed.
bool draw_picture_settings(PictureSettings& settings, double maximum);

/// A value that is plotted over time.
struct PlottedValue {
  Subject subject;
  std::size_t value;  ///< of values_of(subject.kind)
  bool operator==(const PlottedValue&) const = default;
};

/// What the inspector shows.
struct Inspection {
  std::optional<Subject> picked;
  std::vector<Subject> pinned;
  std::optional<std::size_t> component;  ///< as Diagram::component
  std::vector<PlottedValue> plots;
  WaysLines ways;
};

/// Values of what is picked and pinned, at `row`. True when what the picture shows of it has changed.
bool draw_inspector(const Player& player, const io::FrameRow& row, Histories& histories,
                    Inspection& inspection);

/// What a person asks of the plots.
enum class PlotRequest { none, csv, png };

/// Plotted values over the timeline's time, in a box as high as plots_height; dragging scrubs.
PlotRequest draw_plots(Player& player, Histories& histories, Inspection& inspection, const Box& box);
/// Of all plots, in lines of text.
float plots_height(const Inspection& inspection);

/// Only the lanes of the plots, with their axis, for a picture.
void draw_plot_lanes(ImDrawList& list, const Player& player, Histories& histories,
                     const Inspection& inspection, const Box& box);
/// A line for each recorded frame: time and plotted values, in the units shown.
std::string plots_csv(const Player& player, Histories& histories, const Inspection& inspection);

}  // namespace topple::app
