#include <imgui.h>

#include <algorithm>

#include "app/panels/panels.h"
#include "app/picture/furnish_words.h"
#include "app/picture/window_words.h"

namespace topple::app {
namespace {

using namespace window_words;

float label_width() {
  return 6.1f * ImGui::GetTextLineHeight();
}

/// A label, and room for what follows up to the panel's edge.
void label(const Phrase& text) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(say(text).c_str());
  ImGui::SameLine(label_width());
  ImGui::SetNextItemWidth(-1);
}

/// True when another one was chosen.
bool choose(const char* id, const Phrase* names, std::size_t count, std::size_t& chosen) {
  bool changed = false;
  if (!ImGui::BeginCombo(id, say(names[chosen]).c_str())) return false;
  for (std::size_t i = 0; i < count; ++i)
    if (list_entry(say(names[i]), i == chosen) && i != chosen) {
      chosen = i;
      changed = true;
    }
  ImGui::EndCombo();
  return changed;
}

template <typename Choice, std::size_t n>
bool choose(const char* id, const Phrase (&names)[n], Choice& choice) {
  auto chosen = static_cast<std::size_t>(choice);
  const bool changed = choose(id, names, n, chosen);
  choice = static_cast<Choice>(chosen);
  return changed;
}

}  // namespace

bool list_entry(const std::string& label, bool chosen) {
  if (ImGui::Selectable(label.c_str(), chosen)) return true;
  // Dear ImGui before 1.90 takes Space alone
  if (!ImGui::IsItemFocused() || !ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Enter))) return false;
  ImGui::CloseCurrentPopup();
  return true;
}

void choose_colour(PictureSettings& settings, BeamQuantity colour) {
  settings.colour = colour;
  if (settings.range == RangePolicy::fixed) settings.range = RangePolicy::run;
}

bool draw_picture_settings(PictureSettings& settings, double maximum) {
  bool changed = false;
  label(k_colour);
  std::vector<Phrase> names;
  for (const BeamQuantityTraits& quantity : beam_quantities()) names.push_back(quantity.name);
  std::size_t colour = place_of(settings.colour);
  if (choose("##colour", names.data(), names.size(), colour)) {
    choose_colour(settings, beam_quantities()[colour].kind);
    changed = true;
  }
  label(k_map);
  ImGui::BeginDisabled(traits(settings.colour).is_signed);
  if (traits(settings.colour).is_signed) {
    const Phrase only[] = {k_diverging};
    std::size_t first = 0;
    choose("##map", only, 1, first);
  } else {
    static constexpr Phrase k_maps[] = {{"viridis", "viridis"}, {"cividis", "cividis"}};
    changed |= choose("##map", k_maps, settings.map);
  }
  ImGui::EndDisabled();
  label(k_range);
  static constexpr Phrase k_ranges[] = {k_this_instant, k_whole_run, k_fixed};
  if (choose("##range", k_ranges, settings.range)) {
    settings.maximum = std::clamp(maximum, k_least_maximum, k_most_maximum);
    changed = true;
  }
  if (settings.range == RangePolicy::fixed) {
    label(k_maximum);
    double typed = settings.maximum;
    if (ImGui::InputDouble("##maximum", &typed, 0, 0, "%.4g", ImGuiInputTextFlags_EnterReturnsTrue) &&
        typed >= k_least_maximum && typed <= k_most_maximum) {
      settings.maximum = typed;
      changed = true;
    }
    if (ImGui::IsItemHovered())
      ImGui::SetTooltip("%s", say(k_enter_takes, traits(settings.colour).unit).c_str());
  }
  label(k_deformation);
  const double one = 1;
  double factor = settings.exaggeration;
  if (ImGui::SliderScalar("##exaggeration", ImGuiDataType_Double, &factor, &one, &k_most_exaggeration,
                          "×%.3g", ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp)) {
    settings.exaggeration = factor;
    changed = true;
  }
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", say(k_deformation_about).c_str());
  label(furnish_words::k_draw_bodies);
  changed |= choose("##bodies", furnish_words::k_draw_bodies_as, settings.bodies);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", say(furnish_words::k_draw_bodies_about).c_str());
  label(k_trails);
  static constexpr Phrase k_spans[] = {k_none, k_last_second, k_since_start};
  changed |= choose("##trails", k_spans, settings.trails);
  changed |= ImGui::Checkbox(say(k_contact_forces).c_str(), &settings.contact_forces);
  ImGui::SameLine(0, 2 * ImGui::GetStyle().ItemSpacing.x);
  changed |= ImGui::Checkbox(say(k_panels).c_str(), &settings.panels);
  changed |= ImGui::Checkbox(say(k_words).c_str(), &settings.words);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", say(k_words_about).c_str());
  return changed;
}

bool draw_appearance(Appearance& appearance) {
  const Appearance before = appearance;
  static constexpr Phrase k_themes[] = {k_light, k_dark}, k_languages[] = {k_english, k_japanese};
  label(k_theme);
  choose("##theme", k_themes, appearance.dark);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("Ctrl+D");
  label(k_language);
  ImGui::BeginDisabled(!render::has_japanese_font());
  choose("##language", k_languages, appearance.language);
  ImGui::EndDisabled();
  if (!render::has_japanese_font() && ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
    ImGui::SetTooltip("%s", say(k_needs_font).c_str());
  label(k_letters);
  if (ImGui::Button("-##smaller")) appearance.scale = next_scale(appearance.scale, -1);
  ImGui::SameLine();
  ImGui::Text("%.0f %%", 100 * appearance.scale);
  ImGui::SameLine();
  if (ImGui::Button("+##larger")) appearance.scale = next_scale(appearance.scale, 1);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", say(k_letters_about).c_str());
  return appearance != before;
}

}  // namespace topple::app
