#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/panels.h"
#include "app/words.h"
#include "solver/io/edit_text.h"
#include "solver/io/scene.h"

namespace topple::app {
namespace {

/// How a parameter is shown. The slider covers what is usual, `low` to `high` in `unit` or, for a relative
/// one, as factors of the scene's value; typing (Ctrl+click) reaches all that is legal.
struct Slider {
  Edit::Key key;
  const char* label;
  const char* unit;
  const char* format;
  double low, high;
  bool relative = false, logarithmic = false;
};

constexpr Slider k_sliders[] = {
    {Edit::Key::frequency, "frequency", "Hz", "%.3g Hz", 0.1, 10, false, true},
    {Edit::Key::amplitude, "amplitude", "gal", "%.0f gal", 0, 1000},
    {Edit::Key::direction, "direction", "", "%.0f°", -180, 180},
    {Edit::Key::scale, "scale", "", "× %.2f", 0, 3},
    {Edit::Key::alpha, "α", "kgf", "%.4g kgf", 1. / 50, 50, true, true},
    {Edit::Key::q, "q", "", "%.2f", 0.5, 4},
    {Edit::Key::friction, "μ", "", "%.2f", 0, 1.5},
    {Edit::Key::restitution, "restitution", "", "%.2f", 0, 1},
    {Edit::Key::time_step, "time step", "ms", "%.3g ms", 0.05, 20, false, true},
};

constexpr float k_nothing = std::numeric_limits<float>::lowest();  // typed

double azimuth(const Vec3& direction) {
  return std::atan2(direction.y(), direction.x()) * 180 / k_pi;
}

/// Of the same slope, turned to `degrees` about the vertical.
Vec3 turned(const Vec3& direction, double degrees) {
  const double across = std::max(std::hypot(direction.x(), direction.y()), 1e-6), a = degrees * k_pi / 180;
  return {across * std::cos(a), across * std::sin(a), direction.z()};
}

class Row {
 public:
  Row(Player& player, const Slider& slider, int shake)
      : player_(player),
        slider_(slider),
        shake_(shake),
        key_(io::key_of(slider.key)),
        unit_(io::unit_value(slider.unit, key_.dimension)),
        scene_value_(edited_value(player.scene().setup.parameters, slider.key, shake)),
        value_(edited_value(player.parameters(), slider.key, shake)) {}

  void draw(std::string& refused) {
    ImGui::PushID(slider_.label);
    ImGui::PushID(shake_);
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(slider_.label);
    ImGui::SameLine(6.2f * ImGui::GetFontSize());
    ImGui::SetNextItemWidth(-1.9f * ImGui::GetFrameHeight());
    float number = static_cast<float>(shown(value_));
    const auto [low, high] = range(number);
    const ImGuiSliderFlags flags = slider_.logarithmic ? ImGuiSliderFlags_Logarithmic : 0;
    const bool changed =
        ImGui::SliderScalar("##value", ImGuiDataType_Float, &number, &low, &high, slider_.format, flags);
    if (ImGui::IsItemActivated()) player_.begin_edit();
    if (ImGui::IsItemHovered() && !ImGui::IsItemActive()) ImGui::SetTooltip("%s", about().c_str());
    // While somebody types, what stands there so far is no value yet.
    ImGuiStorage& typed = *ImGui::GetStateStorage();
    const ImGuiID item = ImGui::GetID("typed");
    if (changed && ImGui::GetIO().WantTextInput)
      typed.SetFloat(item, number);
    else if (changed)
      post(from_shown(number), refused);
    if (ImGui::IsItemDeactivated()) {
      const float last = typed.GetFloat(item, k_nothing);
      typed.SetFloat(item, k_nothing);
      if (last != k_nothing) post(from_shown(last), refused);
    }
    ImGui::SameLine();
    ImGui::BeginDisabled(value_ == scene_value_);
    if (ImGui::Button("×", {1.4f * ImGui::GetFrameHeight(), 0})) {
      player_.begin_edit();
      post(scene_value_, refused);
    }
    ImGui::EndDisabled();
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Back to the scene's value");
    ImGui::PopID();
    ImGui::PopID();
  }

 private:
  double shown(const Vec3& value) const {
    return slider_.key == Edit::Key::direction ? azimuth(value) : value.x() / unit_;
  }
  Vec3 from_shown(double number) const {
    return slider_.key == Edit::Key::direction ? turned(value_, number) : Vec3(number * unit_, 0, 0);
  }
  /// What the slider covers: the usual within the legal, and the value itself.
  std::pair<float, float> range(float number) const {
    const double scale = slider_.relative ? shown(scene_value_) : 1;
    double low = slider_.low * scale, high = slider_.high * scale;
    if (slider_.key != Edit::Key::direction) {
      low = std::max(low, key_.least / unit_);
      high = std::min(high, key_.most / unit_);
    }
    return {std::min(static_cast<float>(low), number), std::max(static_cast<float>(high), number)};
  }
  std::string about() const {
    const std::string name = io::edit_key({slider_.key, shake_});
    if (slider_.key == Edit::Key::direction)
      return name + ": of the acceleration, counter-clockwise from x (a cabinet's depth)";
    return fmt::format("{}: {}\nallowed {}, in the scene {:.4g}{}{}\nCtrl+click to type", name, key_.about,
                       io::range_text(key_), shown(scene_value_), *slider_.unit ? " " : "", slider_.unit);
  }
  void post(const Vec3& value, std::string& refused) {
    const Edit edit{slider_.key, shake_, value};
    try {
      io::check_edit(edit, player_.scene().setup);
      player_.edit(edit);
      refused.clear();
    } catch (const io::InputError& error) {
      refused = error.what();
    }
  }

  Player& player_;
  const Slider& slider_;
  const int shake_;
  const io::Key& key_;
  const double unit_;
  const Vec3 scene_value_, value_;
};

/// Ticked: in place.
void draw_anchor(Player& player, int index, std::string& refused) {
  const Model& model = player.scene().setup.model;
  const bool scene_value = edited_value(player.scene().setup.parameters, Edit::Key::anchor, index).x() != 0;
  bool on = edited_value(player.parameters(), Edit::Key::anchor, index).x() != 0;
  const auto post = [&](bool value) {
    player.begin_edit();
    player.edit({Edit::Key::anchor, index, Vec3(value ? 1 : 0, 0, 0)});
    refused.clear();
  };
  ImGui::PushID(index);
  const Anchor& anchor = model.anchors[static_cast<std::size_t>(index)];
  if (ImGui::Checkbox(anchor.name.c_str(), &on)) post(on);
  if (ImGui::IsItemHovered())
    ImGui::SetTooltip("%s", fmt::format("{}: ties {} to the wall or floor. One that is put in place starts "
                                        "without force",
                                        io::edit_key({Edit::Key::anchor, index}),
                                        model.bodies[static_cast<std::size_t>(anchor.body)].name)
                                .c_str());
  ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - 1.9f * ImGui::GetFrameHeight() +
                  ImGui::GetStyle().ItemSpacing.x);
  ImGui::BeginDisabled(on == scene_value);
  if (ImGui::Button("×", {1.4f * ImGui::GetFrameHeight(), 0})) post(scene_value);
  ImGui::EndDisabled();
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("Back to the scene's value");
  ImGui::PopID();
}

}  // namespace

void draw_parameters(Player& player, std::string& refused) {
  const Parameters& parameters = player.parameters();
  const bool loads = is_static(player.scene().setup);
  ImGui::BeginDisabled(!player.can_edit());
  int heading = -2;
  for (const auto& [key, shake] : editable(parameters)) {
    if (loads && (key == Edit::Key::time_step || key == Edit::Key::restitution)) continue;
    const auto slider = std::find_if(std::begin(k_sliders), std::end(k_sliders),
                                     [k = key](const Slider& s) { return s.key == k; });
    const bool of_shake = key == Edit::Key::frequency || key == Edit::Key::amplitude ||
                          key == Edit::Key::direction || key == Edit::Key::scale;
    const int group = of_shake                      ? shake
                      : key == Edit::Key::time_step ? 1000
                      : key == Edit::Key::anchor    ? 999
                                                    : -1;
    if (group != heading) {
      if (group == 1000)
        ImGui::TextDisabled("Integration");
      else if (group == 999)
        ImGui::TextDisabled("Anchors");
      else if (group < 0)
        ImGui::TextDisabled("Contact");
      else
        ImGui::TextDisabled("%s", parameters.shakes.size() == 1
                                      ? "Floor"
                                      : fmt::format("Floor, shake {}", shake + 1).c_str());
      heading = group;
    }
    if (key == Edit::Key::anchor)
      draw_anchor(player, shake, refused);
    else
      Row(player, *slider, shake).draw(refused);
  }
  ImGui::EndDisabled();
  if (!player.can_edit() && !player.way().empty())
    ImGui::TextWrapped("These were the values at this instant. Continue from here (C) to change them.");
}

}  // namespace topple::app
