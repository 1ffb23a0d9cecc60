#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "app/anchor_picture.h"
#include "app/panels.h"
#include "app/words.h"

namespace topple::app {
namespace {

constexpr double k_mega = 1e-6;

/// Section forces at a place along a member.
struct Place {
  std::size_t element;
  double xi;
};

void cell(const std::string& text) {
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(text.c_str());
}

void draw_anchor(const Model& model, const io::FrameRow& row, std::size_t k) {
  const Anchor& anchor = model.anchors[k];
  const float* const values = &row.anchor[4 * k];
  const Vec3 span = attached_point(model, row, Vec3::Zero(), k) - anchor.to;
  ImGui::Text("%s", fmt::format("{} of {}", anchor.name, model.bodies[anchor.body].name).c_str());
  ImGui::TextDisabled("%s", fmt::format("{}, {:.4g} kN/m, {:.0f} mm long", anchor_type(anchor),
                                        anchor.stiffness / 1e3, 1e3 * values[2])
                                .c_str());
  if (!ImGui::BeginTable("anchor", 2, ImGuiTableFlags_SizingStretchSame | ImGuiTableFlags_RowBg)) return;
  const auto line = [](const char* name, const std::string& value) {
    cell(name);
    cell(value);
  };
  const bool limited = std::isfinite(anchor.strength);
  line("state", io::anchor_word(values[3]));
  line("force, N", fmt::format("{:.4g}", values[0]));
  line("strength, N", limited ? fmt::format("{:.4g}", anchor.strength) : "never breaks");
  line("share of strength",
       limited ? fmt::format("{:.1f} %", 100 * std::abs(values[0]) / anchor.strength) : "-");
  line("stretch, mm", fmt::format("{:.3g}", 1e3 * (span.norm() - values[2])));
  line("energy, J", fmt::format("{:.3g}", values[1]));
  ImGui::EndTable();
}

}  // namespace

void draw_inspector(const Model& model, const io::FrameRow& row, std::size_t member_index) {
  if (member_index >= model.members.size())
    return draw_anchor(model, row, member_index - model.members.size());
  const Member& member = model.members[member_index];
  const Section& section = model.sections[static_cast<std::size_t>(member.section)];
  const auto first = static_cast<std::size_t>(member.first_element);
  const std::size_t last = first + static_cast<std::size_t>(member.element_count) - 1;
  double length = 0, peak = 0;
  for (std::size_t e = first; e <= last; ++e) {
    length += model.elements[e].length;
    for (const double xi : {-1., 1.})
      peak = std::max(peak, equivalent_stress(section, forces_at(model, row, e, xi)));
  }
  ImGui::Text(
      "%s",
      fmt::format("{} of {}", member.name, model.bodies[static_cast<std::size_t>(member.body)].name).c_str());
  ImGui::TextDisabled(
      "%s", fmt::format("{}, {}, {:.0f} mm long", section.name,
                        model.materials[static_cast<std::size_t>(member.material)].name, 1e3 * length)
                .c_str());
  ImGui::Text("%s", fmt::format("greatest stress now {:.3g} MPa", peak * k_mega).c_str());

  // A member of two elements has its middle at their common node.
  const std::size_t middle = first + (last - first) / 2;
  const Place places[] = {{first, -1}, {middle, last == first ? 0. : 1.}, {last, 1}};
  SectionForces forces[3];
  for (int k = 0; k < 3; ++k) forces[k] = forces_at(model, row, places[k].element, places[k].xi);
  if (!ImGui::BeginTable("forces", 4, ImGuiTableFlags_SizingStretchSame | ImGuiTableFlags_RowBg)) return;
  for (const char* heading : {"", "start", "middle", "end"}) cell(heading);
  const auto line = [&](const char* name, auto value) {
    cell(name);
    for (const SectionForces& f : forces) cell(fmt::format("{:.3g}", value(f)));
  };
  line("stress, MPa", [&](const SectionForces& f) { return equivalent_stress(section, f) * k_mega; });
  line("N, N", [](const SectionForces& f) { return f.normal.x(); });
  line("Vy, N", [](const SectionForces& f) { return f.normal.y(); });
  line("Vz, N", [](const SectionForces& f) { return f.normal.z(); });
  line("T, N m", [](const SectionForces& f) { return f.moment.x(); });
  line("My, N m", [](const SectionForces& f) { return f.moment.y(); });
  line("Mz, N m", [](const SectionForces& f) { return f.moment.z(); });
  ImGui::EndTable();
}

}  // namespace topple::app
