#include "app/panels/subject.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/picture/anchor_picture.h"
#include "app/picture/annotations.h"
#include "app/picture/row.h"
#include "app/picture/touching_bodies.h"
#include "app/picture/window_words.h"
#include "app/picture/words.h"
#include "app/support/terms.h"
#include "solver/math/rotation.h"
#include "solver/model/table.h"
#include "solver/run/overturn.h"

namespace topple::app {
namespace {

constexpr double k_no_value = std::numeric_limits<double>::quiet_NaN();

/// The value of greatest magnitude at the ends of a member's elements: between them it is linear, or less.
/// None of a body that is computed without stresses.
template <typename At>
double greatest(const FrameContext& now, std::size_t index, At at) {
  const Member& member = now.model.members[index];
  if (!io::has_stresses(now.row, member.body)) return k_no_value;
  double most = 0;
  for (int e = member.first_element; e < member.first_element + member.element_count; ++e)
    for (const double xi : {-1., 1.}) {
      const double value = at(static_cast<std::size_t>(e), forces_at(now.model, now.row, e, xi));
      if (std::abs(value) > std::abs(most)) most = value;
    }
  return most;
}

template <BeamQuantity quantity>
double beam_value(const FrameContext& now, std::size_t index) {
  return greatest(now, index,
                  [&](std::size_t e, const SectionForces& forces) {
                    return traits(quantity).value(now.model, e, forces);
                  }) /
         traits(quantity).per_unit;
}

double yield_ratio(const FrameContext& now, std::size_t index) {
  const Element& element = now.model.elements[now.model.members[index].first_element];
  return std::isfinite(element.capacity[0]) ? beam_value<BeamQuantity::yield_ratio>(now, index) : k_no_value;
}

template <std::size_t component>
double force_value(const FrameContext& now, std::size_t index) {
  return greatest(now, index,
                  [](std::size_t, const SectionForces& forces) { return component_of(forces, component); });
}

double tilt_value(const FrameContext& now, std::size_t index) {
  return now.row.body[index].tilt * k_degrees;
}

/// What supports hold does not slide.
double slide_value(const FrameContext& now, std::size_t index) {
  const std::vector<Support>& supports = now.model.supports;
  if (std::any_of(supports.begin(), supports.end(), [&](const Support& support) {
        return now.model.node_body[support.node] == static_cast<int>(index);
      }))
    return k_no_value;
  return 1e3 * now.row.body[index].slide;
}

/// Of the turn between the neighbours; at an end as the means of the last two intervals go on.
double angular_velocity(const FrameContext& now, std::size_t index) {
  if (!now.moves) return k_no_value;
  const auto mean = [index](const io::FrameRow& a, const io::FrameRow& b) -> Vec3 {
    return log_quaternion(b.body[index].rotation() * a.body[index].rotation().conjugate()) /
           (b.time - a.time);
  };
  if (now.before && now.after) return mean(*now.before, *now.after).norm();
  const io::FrameRow* const neighbour = now.before ? now.before : now.after;
  if (!neighbour) return k_no_value;
  const Vec3 near = mean(*neighbour, now.row);
  if (!now.further) return near.norm();
  const Vec3 beyond = mean(*now.further, *neighbour);
  return (near + (near - beyond) * (now.row.time - neighbour->time) / (now.row.time - now.further->time))
      .norm();
}

double kinetic_value(const FrameContext& now, std::size_t index) {
  return io::kinetic_energy(now.model, now.gravity, now.row, static_cast<int>(index));
}

Stack stack_of(const FrameContext& now, std::size_t index) {
  std::vector<BodyPose> poses;
  for (const io::BodyNumbers& body : now.row.body) poses.push_back({body.centre(), body.rotation()});
  std::vector<Stack> stacks;
  find_stacks(now.model, now.bearers, poses, stacks);
  return stacks[index];
}

OverturnBarrier barrier(const FrameContext& now, std::size_t index) {
  const io::BodyNumbers& body = now.row.body[index];
  return overturn_barrier(now.model, static_cast<int>(index), {body.centre(), body.rotation()},
                          stack_of(now, index), now.gravity.norm());
}

double margin_value(const FrameContext& now, std::size_t index) {
  const double left = barrier(now, index).left;
  return std::isfinite(left) ? left : k_no_value;
}

double margin_share(const FrameContext& now, std::size_t index) {
  const OverturnBarrier b = barrier(now, index);
  return std::isfinite(b.whole) && b.whole > 0 ? 100 * b.left / b.whole : k_no_value;
}

double displacement_value(const FrameContext& now, std::size_t index) {
  if (!io::has_stresses(now.row, static_cast<int>(index))) return k_no_value;
  const Body& body = now.model.bodies[index];
  const RigidFit fit = rigid_fit(now.model, now.row);
  double most = 0;
  for (int i = body.first_node; i < body.first_node + body.node_count; ++i)
    most = std::max(most, displacement(now.model, now.row, fit, i).norm());
  return most / traits(BeamQuantity::displacement).per_unit;
}

template <float io::AnchorNumbers::*number>
double anchor_value(const FrameContext& now, std::size_t index) {
  return now.row.anchor[index].*number;
}

double stretch_value(const FrameContext& now, std::size_t index) {
  const io::AnchorNumbers& anchor = now.row.anchor[index];
  if (anchor.state == io::k_anchor_away || anchor.state == io::k_anchor_broken) return k_no_value;
  const Vec3 span = attached_point(now.model, now.row, Vec3::Zero(), index) -
                    far_point(now.model, now.row, Vec3::Zero(), index);
  return 1e3 * (span.norm() - anchor.natural_length);
}

constexpr SubjectValue k_member_values[] = {
    {window_words::k_short_stress, "MPa", beam_value<BeamQuantity::stress>},
    {window_words::k_yield_ratio, "", yield_ratio},
    {window_words::k_normal_force, "N", force_value<0>},
    {window_words::k_shear_y, "N", force_value<1>},
    {window_words::k_shear_z, "N", force_value<2>},
    {window_words::k_torque, "N m", force_value<3>},
    {window_words::k_moment_y, "N m", force_value<4>},
    {window_words::k_moment_z, "N m", force_value<5>}};
constexpr SubjectValue k_body_values[] = {{window_words::k_tilt, "°", tilt_value},
                                          {window_words::k_slide, "mm", slide_value},
                                          {window_words::k_angular_velocity, "rad/s", angular_velocity},
                                          {window_words::k_kinetic, "J", kinetic_value},
                                          {window_words::k_left_to_overturn, "J", margin_value},
                                          {window_words::k_share_left, "%", margin_share},
                                          {window_words::k_own_deformation, "mm", displacement_value}};
constexpr SubjectValue k_anchor_values[] = {
    {window_words::k_force, "N", anchor_value<&io::AnchorNumbers::tension>},
    {window_words::k_stretch, "mm", stretch_value},
    {window_words::k_energy, "J", anchor_value<&io::AnchorNumbers::energy>}};

// What its kind makes of a subject; `index` is that of Subject.
struct SubjectTraits {
  Subject::Kind kind;
  std::string (*name)(const Model& model, std::size_t index);
  std::size_t (*body)(const Model& model, std::size_t index);
  void (*highlight)(const Model& model, std::size_t index, render::SceneFrame& frame);
  std::vector<std::string> (*about)(const FrameContext& now, std::size_t index);
  std::span<const SubjectValue> values;
};

std::vector<std::string> about_member(const FrameContext& now, std::size_t index) {
  const Member& member = now.model.members[index];
  double length = 0;
  for (int e = member.first_element; e < member.first_element + member.element_count; ++e)
    length += now.model.elements[e].length;
  const Material& material = now.model.materials[member.material];
  std::vector<std::string> lines{
      say(window_words::k_member_line, now.model.sections[member.section].name, material.name, 1e3 * length)};
  const double stress = beam_value<BeamQuantity::stress>(now, index) * traits(BeamQuantity::stress).per_unit;
  if (material.yield > 0 && std::abs(stress) > material.yield && yield_ratio(now, index) < 1)
    lines.push_back(
        say(window_words::k_fibre_yields, material.yield / traits(BeamQuantity::stress).per_unit));
  return lines;
}

std::vector<std::string> about_body(const FrameContext& now, std::size_t index) {
  const Body& body = now.model.bodies[index];
  const std::string level = say(window_words::phrase_of(static_cast<ModelLevel>(now.row.level[index])));
  std::vector<std::string> lines{body.solid
                                     ? say(window_words::k_block_line, body.mass, level)
                                     : say(window_words::k_body_line, body.mass, body.member_count, level)};
  if (const double mass = stack_of(now, index).mass; mass > body.mass)
    lines.push_back(say(window_words::k_with_its_load, mass));
  for (const BodyTouch& touch : touches(now.model, now.row, index))
    lines.push_back(say(window_words::k_touched_by, touch.by, value_text(touch.force.norm()),
                        value_text(touch.force.z()), touch.place.z()));
  for (std::size_t k = 0; k < now.model.anchors.size(); ++k)
    if (const Anchor& anchor = now.model.anchors[k];
        static_cast<std::size_t>(anchor.body) == index || anchor.other.body == static_cast<int>(index))
      lines.push_back(anchor_in_words(now.model, now.row, k));
  return lines;
}

std::vector<std::string> about_anchor(const FrameContext& now, std::size_t index) {
  const Anchor& anchor = now.model.anchors[index];
  std::vector<std::string> lines{
      say(window_words::k_anchor_line, anchor_type_in_words(anchor), now.model.bodies[anchor.body].name,
          anchor.stiffness / 1e3, 1e3 * now.row.anchor[index].natural_length),
      anchor_in_words(now.model, now.row, index)};
  const bool breaks = std::isfinite(anchor.strength);
  std::string words = breaks ? say(window_words::k_anchor_strength, value_text(anchor.strength)) : "";
  if (index < now.anchor_peaks.size()) {
    const double peak = now.anchor_peaks[index];
    words += (words.empty() ? "" : say(window_words::k_comma)) +
             say(window_words::k_anchor_peak, value_text(peak)) +
             (breaks ? say(window_words::k_of_strength, percent_of(peak, anchor.strength)) : "");
  }
  if (!words.empty()) lines.push_back(words);
  return lines;
}

constexpr SubjectTraits k_subjects[] = {
    {.kind = Subject::Kind::member,
     .name =
         [](const Model& model, std::size_t index) {
           const Member& member = model.members[index];
           return model.bodies[member.body].name + "/" + member.name;
         },
     .body = [](const Model& model,
                std::size_t index) { return static_cast<std::size_t>(model.members[index].body); },
     .highlight =
         [](const Model&, std::size_t index, render::SceneFrame& frame) {
           frame.highlighted_member = static_cast<std::int64_t>(index);
         },
     .about = about_member,
     .values = k_member_values},
    {.kind = Subject::Kind::body,
     .name = [](const Model& model, std::size_t index) { return model.bodies[index].name; },
     .body = [](const Model&, std::size_t index) { return index; },
     .highlight =
         [](const Model&, std::size_t index, render::SceneFrame& frame) {
           frame.highlighted_body = static_cast<std::int64_t>(index);
         },
     .about = about_body,
     .values = k_body_values},
    {.kind = Subject::Kind::anchor,
     .name = [](const Model& model, std::size_t index) { return model.anchors[index].name; },
     .body = [](const Model& model,
                std::size_t index) { return static_cast<std::size_t>(model.anchors[index].body); },
     .highlight =
         [](const Model& model, std::size_t index, render::SceneFrame& frame) {  // drawn after the members
           frame.highlighted_member = static_cast<std::int64_t>(model.members.size() + index);
         },
     .about = about_anchor,
     .values = k_anchor_values}};

template <typename Named>
std::string names_of(const std::vector<Named>& all, std::size_t first, std::size_t count) {
  constexpr std::size_t k_most = 30;
  std::string names;
  for (std::size_t i = first; i < first + std::min(count, k_most); ++i)
    names += (names.empty() ? "" : ", ") + all[i].name;
  return names + (count > k_most ? ", …" : "");
}

}  // namespace

std::string name_of(const Model& model, const Subject& subject) {
  return row_of(k_subjects, subject.kind).name(model, subject.index);
}

std::size_t body_of(const Model& model, const Subject& subject) {
  return row_of(k_subjects, subject.kind).body(model, subject.index);
}

void highlight(const Model& model, const Subject& subject, render::SceneFrame& frame) {
  row_of(k_subjects, subject.kind).highlight(model, subject.index, frame);
}

std::vector<std::string> about(const FrameContext& now, const Subject& subject) {
  return row_of(k_subjects, subject.kind).about(now, subject.index);
}

Subject subject_named(const Model& model, const std::string& name) {
  const std::size_t slash = name.find('/');
  const std::string body_name = name.substr(0, slash);
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    if (body.name != body_name) continue;
    if (slash == std::string::npos) return {Subject::Kind::body, b};
    const auto first = static_cast<std::size_t>(body.first_member);
    const auto count = static_cast<std::size_t>(body.member_count);
    for (std::size_t m = first; m < first + count; ++m)
      if (model.members[m].name == name.substr(slash + 1)) return {Subject::Kind::member, m};
    throw io::InputError(fmt::format("{}: {} has no such member; it has {}", name, body_name,
                                     names_of(model.members, first, count)));
  }
  throw io::InputError(fmt::format("{}: there is no body of that name; there are {}", name,
                                   names_of(model.bodies, 0, model.bodies.size())));
}

FrameContext frame_context(const Player& player, const io::FrameRow& row) {
  FrameContext now{player.scene().setup.model, player.scene().setup.parameters.gravity, player.bearers(),
                   row};
  const std::vector<RowPtr>& way = player.way();
  const auto earlier = [](const RowPtr& r, double time) { return r->time < time; };
  const auto at = std::lower_bound(way.begin(), way.end(), row.time, earlier);
  if (at != way.begin()) now.before = (at - 1)->get();
  const auto next = at != way.end() && (*at)->time == row.time ? at + 1 : at;
  if (next != way.end()) now.after = next->get();
  if (!now.after && at - way.begin() > 1) now.further = (at - 2)->get();
  if (!now.before && way.end() - next > 1) now.further = (next + 1)->get();
  now.anchor_peaks = player.anchor_peaks();
  now.moves = player.scene().setup.run.analysis == Analysis::dynamic;
  return now;
}

std::span<const SubjectValue> values_of(Subject::Kind kind) {
  return row_of(k_subjects, kind).values;
}

std::string value_text(double value) {
  constexpr double k_rounding = 1e-9;
  if (!std::isfinite(value)) return "-";
  const double size = std::abs(value);
  if (size < k_rounding) return "0";
  return size >= 999.5 && size < 1e7 ? fmt::format("{:.0f}", value) : fmt::format("{:.3g}", value);
}

bool is_approximate(const Model& model, const io::FrameRow& row, std::size_t index) {
  const Member& member = model.members[index];
  const std::size_t planes = model.planes.size();
  for (int e = member.first_element; e + 1 < member.first_element + member.element_count; e += 2)
    for (std::size_t c = 0; c < model.contact_points.size() * planes; ++c)
      if (model.contact_points[c / planes].node == model.elements[e].node[1] &&
          (row.contact_force[3 * c] != 0 || row.contact_force[3 * c + 1] != 0 ||
           row.contact_force[3 * c + 2] != 0))
        return true;
  return false;
}

const std::vector<float>& Histories::of(const Player& player, const Subject& subject, std::size_t value) {
  History& history = histories_[{subject, value}];
  const std::vector<RowPtr>& way = player.way();
  std::vector<float>& samples = history.samples;
  if (samples.size() > way.size() || samples.empty() || way.front() != history.first ||
      way[samples.size() - 1] != history.last)
    samples.clear();
  if (samples.size() == way.size()) return samples;
  if (!samples.empty()) samples.pop_back();  // it has a neighbour now
  const SubjectValue& asked = values_of(subject.kind)[value];
  for (std::size_t i = samples.size(); i < way.size(); ++i) {
    const FrameContext frame{player.scene().setup.model,
                             player.scene().setup.parameters.gravity,
                             player.bearers(),
                             *way[i],
                             i > 0 ? way[i - 1].get() : nullptr,
                             i + 1 < way.size() ? way[i + 1].get() : nullptr};
    samples.push_back(static_cast<float>(asked.at(frame, subject.index)));
  }
  if (!way.empty()) {
    history.first = way.front();
    history.last = way.back();
  }
  return samples;
}

}  // namespace topple::app
