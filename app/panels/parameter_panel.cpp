#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "app/chart/lane.h"
#include "app/panels/computed.h"
#include "app/panels/panels.h"
#include "app/panels/precision_words.h"
#include "app/picture/furnish_words.h"
#include "app/support/terms.h"
#include "solver/body/model_level.h"
#include "solver/io/common/units.h"
#include "solver/io/edit/edit_text.h"
#include "solver/io/scene/scene.h"
#include "solver/model/accelerogram.h"
#include "solver/model/excitation.h"

namespace topple::app {
namespace {

using namespace window_words;

/// How a parameter is shown. The slider covers what is usual, `low` to `high` in `unit` or, for a relative
/// one, as factors of the scene's value; typing (Ctrl+click) reaches all that is legal.
struct Slider {
  Edit::Key key;
  Phrase label, about;  ///< about: of {0}, what the scene reference says
  const char* unit;
  const char* format;
  double low, high;
  bool relative = false, logarithmic = false;
  int component = 0;  ///< of Edit::value
};

constexpr Slider k_sliders[] = {
    {Edit::Key::frequency, k_frequency, k_frequency_about, "Hz", "%.3g Hz", 0.1, 10, false, true},
    {Edit::Key::amplitude, k_amplitude, k_amplitude_about, "gal", "%.0f gal", 0, 1000},
    {Edit::Key::direction, k_direction, k_direction_about, "", "%.0f°", -180, 180},
    {Edit::Key::duration, k_duration, k_duration_about, "s", "%.3g s", 0.05, 60, false, true},
    {Edit::Key::scale, k_scale, k_scale_about, "", "× %.2f", 0, 3},
    {Edit::Key::alpha, k_alpha, k_alpha_about, "kgf", "%.4g kgf", 1. / 50, 1000, true, true},
    {Edit::Key::q, k_q, k_q_about, "", "%.2f", 0.5, 4},
    {Edit::Key::friction, k_friction, k_friction_about, "", "%.2f", 0, 1.5},
    {Edit::Key::friction_static, k_friction_static, k_friction_static_about, "", "%.2f", 0, 1.5},
    {Edit::Key::restitution, k_restitution, k_restitution_about, "", "%.2f", 0, 1},
    {Edit::Key::damping, k_damping, k_damping_about, "", "%.3f", 0, 0.2},
    {Edit::Key::time_step, k_time_step, k_time_step_about, "ms", "%.3g ms", 0.05, 20, false, true},
};
// Of a sweep, whose frequency has two values.
constexpr Slider k_sweep[] = {
    {Edit::Key::frequency, k_sweep_from, k_frequency_about, "Hz", "%.3g Hz", 0.1, 10, false, true},
    {Edit::Key::frequency, k_sweep_to, k_frequency_about, "Hz", "%.3g Hz", 0.1, 10, false, true, 1},
};

constexpr Phrase k_as_in_scenes{"{0}", "{0}"};

/// A parameter without a row above is called as in scenes, and all that is legal is usual.
Slider slider_of(Edit::Key key) {
  const auto* const own = std::ranges::find(k_sliders, key, &Slider::key);
  if (own != std::end(k_sliders)) return *own;
  const io::Key& of = io::key_of(key);
  const double unit = io::unit_value(of.unit, of.dimension);
  return {key,
          {of.name.data(), of.name.data()},
          k_as_in_scenes,
          of.unit.data(),
          "%.3g",
          of.least / unit,
          of.most / unit};
}

constexpr float k_no_exponent = 1000;  // from here on four digits would get one

constexpr float k_nothing = std::numeric_limits<float>::lowest();  // typed

/// The number that is read where `x` is shown by all its digits: 1.32, not 1.3200000524520874.
double decimal(float x) {
  return std::stod(fmt::format("{}", x));
}

double azimuth(const Vec3& direction) {
  return std::atan2(direction.y(), direction.x()) * k_degrees;
}

/// Of the same slope, turned to `degrees` about the vertical.
Vec3 turned(const Vec3& direction, double degrees) {
  const double across = std::max(std::hypot(direction.x(), direction.y()), 1e-6), a = degrees / k_degrees;
  return {across * std::cos(a), across * std::sin(a), direction.z()};
}

/// One parameter: its label, what sets it, and the way back to the scene's value.
class Row {
 public:
  Row(Player& player, Edit::Key key, int index, std::string& refused)
      : player_(player),
        key_(io::key_of(key)),
        edit_{key, index, edited_value(player.parameters(), key, index)},
        scene_value_(edited_value(player.scene().setup.parameters, key, index)),
        refused_(refused) {}

  void slider(const Slider& look) {
    begin(say(look.label));
    const double unit = io::unit_value(look.unit, key_.dimension);
    const auto shown = [&](const Vec3& value) {
      return look.key == Edit::Key::direction ? azimuth(value) : value[look.component] / unit;
    };
    const auto from_shown = [&](double number) {
      if (look.key == Edit::Key::direction) return turned(edit_.value, number);
      Vec3 value = edit_.value;
      value[look.component] = io::in_si(number, unit);
      return value;
    };
    ImGui::SetNextItemWidth(-1.9f * ImGui::GetFrameHeight());
    // An adaptive run takes other steps than the one that is kept for when it ends to be one.
    const bool adaptive = look.key == Edit::Key::time_step && player_.parameters().adaptive;
    const std::optional<double> taken = adaptive ? step_taken(player_) : std::nullopt;
    float number = static_cast<float>(taken      ? *taken / unit
                                      : adaptive ? player_.parameters().time_step / unit
                                                 : shown(edit_.value));
    std::string format = adaptive ? say(taken ? k_step_auto : k_step_auto_unknown) : look.format;
    if (number >= k_no_exponent && !adaptive) format = std::string("%.0f ") + look.unit;
    const bool auto_in_scene = look.key == Edit::Key::time_step && player_.scene().setup.parameters.adaptive;
    const auto [low, high] = range(look, number, auto_in_scene ? number : shown(scene_value_), unit);
    const ImGuiSliderFlags flags = look.logarithmic ? ImGuiSliderFlags_Logarithmic : 0;
    const bool changed =
        ImGui::SliderScalar("##value", ImGuiDataType_Float, &number, &low, &high, format.c_str(), flags);
    if (ImGui::IsItemActivated()) player_.begin_edit();
    if (ImGui::IsItemHovered() && !ImGui::IsItemActive())
      ImGui::SetTooltip("%s", (adaptive ? say(k_step_auto_about) : about(look)).c_str());
    // While somebody types, what stands there so far is no value yet.
    ImGuiStorage& typed = *ImGui::GetStateStorage();
    const ImGuiID item = ImGui::GetID("typed");
    if (changed && ImGui::GetIO().WantTextInput)
      typed.SetFloat(item, number);
    else if (changed)
      post(from_shown(decimal(number)));
    if (ImGui::IsItemDeactivated()) {
      const float last = typed.GetFloat(item, k_nothing);
      typed.SetFloat(item, k_nothing);
      if (last != k_nothing) {  // another may have been begun with the click that ends this one
        post_anew(from_shown(decimal(last)));
        player_.begin_edit();
      }
    }
    end();
  }

  /// One of the choices of the key whose numbers are legal.
  template <class F>
  void choice(const std::string& label, const Phrase& tip, F&& legal) {
    begin(label);
    ImGui::SetNextItemWidth(-1.9f * ImGui::GetFrameHeight());
    const int now = static_cast<int>(edit_.value.x());
    const auto word = [&](int number) { return say(phrase_of_choice(*io::choice_of(key_, number))); };
    const std::string shown = word(now);
    const float room = ImGui::CalcItemWidth() - ImGui::GetFrameHeight();
    const bool narrow = ImGui::CalcTextSize(shown.c_str()).x + ImGui::GetStyle().FramePadding.x > room;
    if (ImGui::BeginCombo("##value", shown.c_str(), narrow ? ImGuiComboFlags_NoArrowButton : 0)) {
      for (const int number : key_.numbers)
        if (legal(number) && list_entry(word(number), number == now) && number != now)
          post_anew(Vec3(number, 0, 0));
      ImGui::EndCombo();
    } else if (ImGui::IsItemHovered()) {
      ImGui::SetTooltip("%s", say(k_key_about, name(), say(tip, key_.about)).c_str());
    }
    end();
  }

  /// `also`: others of the same key, which are set with it.
  void tick(const std::string& label, const std::string& tooltip, std::vector<int> also = {}) {
    also_ = std::move(also);
    bool on = edit_.value.x() != 0;
    ImGui::PushID(label.c_str());
    ImGui::PushID(io::edit_key(edit_).c_str());
    if (ImGui::Checkbox(label.c_str(), &on)) post_anew(Vec3(on ? 1 : 0, 0, 0));
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", say(k_key_about, name(), tooltip).c_str());
    end(ImGui::GetWindowContentRegionMax().x - 1.9f * ImGui::GetFrameHeight() +
        ImGui::GetStyle().ItemSpacing.x);
  }

  void button(const Phrase& label, double value, const Phrase& tooltip, bool enabled) {
    ImGui::PushID(io::edit_key(edit_).c_str());
    ImGui::BeginDisabled(!enabled);
    if (ImGui::Button(say(label).c_str())) post_anew(Vec3(value, 0, 0));
    ImGui::EndDisabled();
    if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
      ImGui::SetTooltip("%s", say(tooltip).c_str());
    ImGui::PopID();
  }

 private:
  void begin(const std::string& label) {
    ImGui::PushID(label.c_str());
    ImGui::PushID(io::edit_key(edit_).c_str());
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(label.c_str());
    ImGui::SameLine(6.2f * ImGui::GetFontSize());
  }
  std::string name() const { return io::scene_key(edit_, player_.scene().setup.model); }
  // What slider() covers: the usual within the legal, and the value itself.
  std::pair<float, float> range(const Slider& look, float number, double in_scene, double unit) const {
    const double scale = look.relative ? in_scene : 1;
    double low = look.low * scale, high = look.high * scale;
    if (look.key != Edit::Key::direction) {
      low = std::max(low, key_.least / unit);
      high = std::min(high, key_.most / unit);
    }
    return {std::min(static_cast<float>(low), number), std::max(static_cast<float>(high), number)};
  }
  std::string about(const Slider& look) const {
    if (look.key == Edit::Key::direction) return say(k_key_about, name(), say(look.about));
    const Edit in_scene{edit_.key, edit_.index, scene_value_};
    return say(k_slider_about, name(), say(look.about, key_.about), io::range_text(key_),
               io::edit_value_text(in_scene, io::EditSpelling::shown));
  }
  void end(float at = 0) {
    ImGui::SameLine(at);
    ImGui::BeginDisabled(edit_.value == scene_value_);
    if (ImGui::Button("×", {1.4f * ImGui::GetFrameHeight(), 0})) post_anew(scene_value_);
    ImGui::EndDisabled();
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", say(k_back_to_scene).c_str());
    ImGui::PopID();
    ImGui::PopID();
  }
  void post_anew(const Vec3& value) {
    player_.begin_edit();
    post(value);
  }
  void post(const Vec3& value) {
    try {
      player_.edit({edit_.key, edit_.index, value});
      for (const int index : also_) player_.edit({edit_.key, index, value});
      refused_.clear();
    } catch (const io::InputError& error) {
      refused_ = error.what();
    }
  }

  Player& player_;
  const io::Key& key_;
  const Edit edit_;
  const Vec3 scene_value_;
  std::string& refused_;
  std::vector<int> also_;
};

/// One that is edited, and where the refusal of an edit goes.
struct Parameter {
  Player& player;
  Edit::Key key;
  int index;
  std::string& refused;

  Row row() const { return {player, key, index, refused}; }
  const Model& model() const { return player.scene().setup.model; }
};

void draw_slider(const Parameter& of) {
  of.row().slider(slider_of(of.key));
}

void draw_type(const Parameter& of) {
  Row row = of.row();
  row.choice(say(k_type), k_type_about,
             [](int number) { return traits(static_cast<Shake::Kind>(number)).has_amplitude; });
  const bool ended = of.player.can_edit() && !of.player.is_live(of.player.shown_branch());
  row.button(k_shake_once, static_cast<int>(Shake::Kind::pulse),
             ended ? k_shake_once_ended : k_shake_once_about, !ended);
}

/// What is computed, below what is asked for.
void write_below(const std::string& words) {
  ImGui::PushTextWrapPos(0);
  ImGui::TextDisabled("%s", words.c_str());
  ImGui::PopTextWrapPos();
}

/// What no row follows is said at once, not when the run is over.
void draw_frequency(const Parameter& of) {
  const Shake& shake = of.player.parameters().shakes[static_cast<std::size_t>(of.index)];
  if (!traits(shake.kind).sweeps)
    draw_slider(of);
  else
    for (const Slider& look : k_sweep) of.row().slider(look);
  const double output_rate = of.player.scene().setup.run.output_rate;
  if (!rows_follow(shake, output_rate)) write_below(say(k_too_fast_for_rows, output_rate));
}

/// How strong the record is then, which its factor does not tell.
void draw_scale(const Parameter& of) {
  draw_slider(of);
  const Shake& shake = of.player.parameters().shakes[static_cast<std::size_t>(of.index)];
  Vec3 along = Vec3::Zero();
  for (const AccelerogramComponent& component : shake.record->components)
    along += component.direction.cwiseAbs();
  std::string axes;
  for (int k = 0; k < 3; ++k)
    if (along[k] > 0) axes += (axes.empty() ? "" : ", ") + std::string(1, "xyz"[k]);
  write_below(
      say(shake.building ? k_ground_peak : k_record_peak, shake.scale * shake.record->peak / k_gal, axes));
}

void draw_model(const Parameter& of) {
  ImGui::TextUnformatted(of.model().bodies[static_cast<std::size_t>(of.index)].name.c_str());
  of.row().choice(say(k_model), k_model_about, [&](int number) {
    const auto model = static_cast<BodyModel>(number);
    return traits(model).by_edit && can_be(of.model(), of.index, model);
  });
  const ImVec2 line{1, ImGui::GetTextLineHeight()};
  if (!ImGui::IsRectVisible(line)) return ImGui::Dummy(line);  // of very many bodies
  write_below(computed_in_words(of.player, static_cast<std::size_t>(of.index)));
}

void draw_integrator(const Parameter& of) {
  of.row().choice(say(k_integrator), k_integrator_about, [](int) { return true; });
  if (const std::string words = integrators_in_words(of.player); !words.empty()) write_below(words);
}

/// All points of a fixing have one box, at the first of them.
void draw_anchor(const Parameter& of) {
  const std::vector<Anchor>& anchors = of.model().anchors;
  const auto index = static_cast<std::size_t>(of.index);
  const Anchor& anchor = anchors[index];
  const auto is_of_same = [&](std::size_t k) {
    return anchor.fixing_number > 0 && anchors[k].fixing_number == anchor.fixing_number;
  };
  if (index > 0 && is_of_same(index - 1)) return;
  std::vector<int> also;
  for (std::size_t k = index + 1; k < anchors.size() && is_of_same(k); ++k)
    also.push_back(static_cast<int>(k));
  const std::string called = also.empty() ? anchor.name : anchor.name.substr(0, anchor.name.rfind('-'));
  const auto name = [&](int body) { return of.model().bodies[static_cast<std::size_t>(body)].name; };
  const auto row = of.player.row();
  std::size_t broke = 0;
  for (std::size_t k = index; row && k <= index + also.size(); ++k)
    broke += row->anchor[k].state == io::k_anchor_broken;
  const bool all = broke > also.size();
  const std::string& to = anchor.other.body < 0 ? anchor.leads_to : name(anchor.other.body);
  of.row().tick(broke == 0 ? called
                : all      ? say(k_anchor_broke, called)
                           : say(k_anchor_broke_in_part, called, broke, also.size() + 1),
                to.empty() ? say(k_anchor_about, name(anchor.body))
                           : say(k_anchor_between_about, name(anchor.body), to),
                also);
}

/// What is fixed before the run, for good.
void write_stoppers(const Setup& setup) {
  if (setup.model.anchors.empty() && !setup.wedges.empty())
    ImGui::TextDisabled("%s", say(furnish_words::k_fixings).c_str());
  for (const Wedge& wedge : setup.wedges)
    write_below(say(wedge.in_place() ? k_stopper_line : k_stopper_away_line, wedge.name,
                    setup.model.bodies[static_cast<std::size_t>(wedge.body)].name));
}

/// What sets a parameter; one without a row has a slider.
struct Control {
  Edit::Key key;
  void (*draw)(const Parameter&);
};
constexpr Control k_controls[] = {
    {Edit::Key::on, [](const Parameter& of) { of.row().tick(say(k_on), say(k_on_about)); }},
    {Edit::Key::type, draw_type},
    {Edit::Key::frequency, draw_frequency},
    {Edit::Key::scale, draw_scale},
    {Edit::Key::law,
     [](const Parameter& of) { of.row().choice(say(k_law), k_law_about, [](int) { return true; }); }},
    {Edit::Key::model, draw_model},
    {Edit::Key::anchor, draw_anchor},
    {Edit::Key::integrator, draw_integrator},
    {Edit::Key::want,
     [](const Parameter& of) { of.row().tick(say(k_stresses_wanted), say(k_stresses_wanted_about)); }},
};

void draw_row(const Parameter& of) {
  const auto* const own = std::ranges::find(k_controls, of.key, &Control::key);
  (own == std::end(k_controls) ? draw_slider : own->draw)(of);
}

/// False: what stands below it is folded away.
bool draw_heading(Edit::Of of, int index, const Parameters& parameters, const Model& model) {
  constexpr std::size_t k_few = 2;  // bodies, whose rows need no folding
  const bool by_name =
      std::ranges::all_of(model.anchors, [](const Anchor& one) { return one.fixing_number > 0; });
  switch (of) {
    case Edit::Of::shake:
      ImGui::TextDisabled(
          "%s", (parameters.shakes.size() == 1 ? say(k_floor) : say(k_floor_shake, index + 1)).c_str());
      return true;
    case Edit::Of::body:
      return ImGui::CollapsingHeader((say(k_bodies) + "##bodies").c_str(),
                                     parameters.models.size() <= k_few ? ImGuiTreeNodeFlags_DefaultOpen : 0);
    default:
      ImGui::TextDisabled("%s", say(of == Edit::Of::contact  ? k_contact
                                    : of != Edit::Of::anchor ? k_integration
                                    : by_name                ? furnish_words::k_fixings
                                                             : k_anchors_heading)
                                    .c_str());
      return true;
  }
}

bool draw_precision_button() {
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + 6.2f * ImGui::GetFontSize());
  const bool pressed = ImGui::Button((say(k_precision) + "##precision").c_str());
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", say(k_precision_about).c_str());
  return pressed;
}

}  // namespace

bool draw_parameters(Player& player, std::string& refused) {
  const Parameters& parameters = player.parameters();
  const Setup& setup = player.scene().setup;
  ImGui::BeginDisabled(!player.can_edit());
  std::optional<std::pair<Edit::Of, int>> heading;
  bool open = true, precision = false, stoppers_due = true;
  for (const auto& [key, index] : editable(setup.model, parameters)) {
    if (is_static(setup) && traits(key).dynamic) continue;
    const Edit::Of of = traits(key).of;
    if (of == Edit::Of::contact && !can_touch(setup.model)) continue;
    const std::pair below{of, of == Edit::Of::shake ? index : 0};
    if (of == Edit::Of::run && std::exchange(stoppers_due, false)) write_stoppers(setup);
    if (heading != below) open = draw_heading(of, index, parameters, setup.model);
    heading = below;
    if (open) draw_row({player, key, index, refused});
    if (key == Edit::Key::time_step) precision = draw_precision_button();
  }
  ImGui::EndDisabled();
  if (!heading)
    text_wrapped(say(k_no_parameters));
  else if (!player.can_edit() && !player.way().empty())
    text_wrapped(say(k_past_values));
  return precision;
}

}  // namespace topple::app
