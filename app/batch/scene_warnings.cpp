#include "app/batch/scene_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "app/batch/run_warnings.h"
#include "app/batch/warning_words.h"
#include "solver/body/anchors.h"
#include "solver/body/model_level.h"
#include "solver/contact/contact_default.h"
#include "solver/contact/nearest_places.h"
#include "solver/contact/proximity.h"
#include "solver/io/edit/edit_text.h"
#include "solver/reduced/tipping.h"
#include "solver/study/common/alone.h"
#include "solver/study/common/standing.h"

namespace topple::app {
namespace {

constexpr double k_corner = 0.2;    // of an edge, from its ends: there it hardly bends
constexpr double k_within = 1e-3;   // m, a wall
constexpr double k_early = 0.05;    // of the acceleration that lifts a side
constexpr double k_hardly = 0.02;   // of it
constexpr double k_upright = 0.7;   // of the normal of a floor
constexpr double k_pressed = 3e-3;  // m, of bodies beside each other

/// Of the member of a body that is nearest to a point, and where along it, 0..1.
struct Place {
  int member = -1;
  double along = 0, distance = std::numeric_limits<double>::infinity();
};
Place nearest_member(const Model& model, const State& start, const Body& body, const Vec3& point) {
  Place nearest;
  for (int m = body.first_member; m < body.first_member + body.member_count; ++m) {
    const Member& member = model.members[m];
    const Vec3& a = start.position[model.elements[member.first_element].node[0]];
    const Vec3& b = start.position[model.elements[member.first_element + member.element_count - 1].node[1]];
    const NearestPoints found = nearest_points(point, a, b);
    if (found.between.norm() < nearest.distance) nearest = {m, found.t, found.between.norm()};
  }
  return nearest;
}

void warn_of_anchors(const Setup& setup, const State& start, std::vector<std::string>& list) {
  const Model& model = setup.model;
  const std::vector<AnchorForce> forces = anchor_forces(model, start);
  for (std::size_t k = 0; k < forces.size(); ++k)
    if (const Anchor& anchor = model.anchors[k]; std::abs(forces[k].tension) > anchor.strength)
      list.push_back(fmt::format(
          "anchor \"{}\" is put in with {:.4g} N, above its strength of {:.4g} N: unless it slackens as "
          "its body settles, it breaks at once",
          anchor.name, std::abs(forces[k].tension), anchor.strength));
  for (const Anchor& anchor : model.anchors) {
    const ModelLevel level = base_level(model, setup.parameters, anchor.body).level;
    if (level != ModelLevel::elastic && level != ModelLevel::frame) continue;
    const Vec3 point = start.position[anchor.node] + start.rotation[anchor.node] * anchor.arm;
    const Body& body = model.bodies[anchor.body];
    const Place at = nearest_member(model, start, body, point);
    if (at.along < k_corner || at.along > 1 - k_corner) continue;
    list.push_back(
        fmt::format("anchor \"{}\" holds \"{}\" in the middle of its member \"{}\", which bends there and "
                    "gives way before the anchor does; at a corner it is stiffer",
                    anchor.name, body.name, model.members[at.member].name));
  }
}

/// Where a wall pushes a body away as the run begins.
void warn_of_walls(const Setup& setup, const State& start, std::vector<std::string>& list) {
  const Model& model = setup.model;
  for (int b = 0; b < model.furniture_total(); ++b)
    for (const Plane& plane : model.planes) {
      if (plane.normal.z() > k_upright) continue;
      const Body& body = model.bodies[b];
      double deepest = 0;
      for (int p = body.first_contact_point; p < body.first_contact_point + body.contact_point_count; ++p) {
        const ContactPoint& point = model.contact_points[p];
        deepest =
            std::max(deepest, point.width / 2 - plane.normal.dot(start.position[point.node] - plane.point));
      }
      if (deepest > k_within)
        list.push_back(fmt::format("\"{}\" starts {:.3g} mm within \"{}\", which pushes it away at once",
                                   body.name, 1e3 * deepest, plane.name));
    }
}

void warn_of_falls(const Setup& setup, const State& start, std::vector<std::string>& list) {
  const Model& model = setup.model;
  if (setup.parameters.gravity.isZero(0)) return;
  const bool floor =
      std::ranges::any_of(model.planes, [](const Plane& plane) { return plane.normal.z() > k_upright; });
  for (int b = 0; b < model.furniture_total(); ++b) {
    const Body& body = model.bodies[b];
    const bool held =
        std::ranges::any_of(model.supports,
                            [&](const Support& support) { return model.node_body[support.node] == b; }) ||
        std::ranges::any_of(model.anchors, [&](const Anchor& anchor) { return anchor.body == b; });
    if (held) continue;
    const double bottom = heights(model, start.position, b).low;
    const Below under = below(model, start.position, b, floor);
    const std::string what =
        under.body < 0 ? "the floor" : '"' + model.bodies[static_cast<std::size_t>(under.body)].name + '"';
    if (!std::isfinite(under.top))
      list.push_back(
          fmt::format("\"{}\" stands on nothing, as the scene has no [floor]: it falls", body.name));
    else if (bottom - under.top > k_hangs)
      list.push_back(fmt::format(
          "\"{}\" stands on nothing: it hangs {:.4g} mm{} above {}{}", body.name, 1e3 * (bottom - under.top),
          under.body < 0 ? "" : " or more", what,
          setup.run.settle ? "; settling brings it down where that is little, else the run does not "
                             "begin; settle = false lets it fall"
                           : " and falls when the run begins"));
    else if (under.body >= 0 && bottom > k_hangs && under.top - bottom < k_top_of && under.aside > 0)
      list.push_back(fmt::format("the centre of gravity of \"{}\" is {:.4g} mm beside {}, on which it stands",
                                 body.name, 1e3 * under.aside, what));
  }
}

/// Bodies beside each other whose members press on each other before anything moves.
void warn_of_overlaps(const Setup& setup, const State& start, std::vector<std::string>& list) {
  const Model& model = setup.model;
  std::map<std::pair<int, int>, double> deepest;  // m, of two bodies
  NearSearch search(model);
  for (const ElementPair& pair : search.find(start.position, 0)) {
    if (panel_of(model, pair.b) != nullptr) continue;
    const auto end = [&](int element, int k) -> const Vec3& {
      return start
          .position[static_cast<std::size_t>(model.elements[static_cast<std::size_t>(element)].node[k])];
    };
    const Vec3 between =
        nearest_points(end(pair.a, 0), end(pair.a, 1), end(pair.b, 0), end(pair.b, 1)).between;
    const double within = contact_length(model, pair) - between.norm();
    if (within < k_pressed || std::abs(between.z()) > k_upright * between.norm()) continue;
    double& most = deepest[{body_of(model, pair.a), body_of(model, pair.b)}];
    most = std::max(most, within);
  }
  for (const auto& [bodies, within] : deepest)
    list.push_back(
        fmt::format("\"{}\" and \"{}\" start {:.2g} mm within each other: contact pushes them apart, and "
                    "settling may find no rest",
                    model.bodies[static_cast<std::size_t>(bodies.first)].name,
                    model.bodies[static_cast<std::size_t>(bodies.second)].name, 1e3 * within));
}

/// To two digits.
double rounded_up(double value) {
  const double unit = std::pow(10, std::floor(std::log10(value)) - 1);
  return std::ceil(value / unit) * unit;
}

/// Greatest part of the steady acceleration that tips a body on a rigid floor by which it tips earlier here,
/// as far as its weight on one edge tells, or exactly where it stands freely.
std::optional<double> early_tipping(const Model& model, const Parameters& p) {
  const auto on_hard_floor = [](BodyModel body) { return body == BodyModel::planar; };
  if (!p.models.empty() && std::ranges::all_of(p.models, on_hard_floor)) return std::nullopt;
  std::optional<double> early = early_uplift(model, p.contact, p.gravity);
  if (!early || *early <= k_early) return early;
  for (int b = 0; b < model.furniture_total(); ++b) {
    if (!study::why_not_standing(model, b).empty()) continue;
    const study::Standing body = study::standing(model, p, b);
    early = std::max(*early, 1 - study::tipping_limit(body, p.contact) / study::stiff_limit(body, p.contact));
  }
  return early;
}

/// Least alpha, N, with which that part is k_hardly.
double alpha_for_tipping(const Model& model, const Parameters& p) {
  const double early = early_uplift(model, p.contact, p.gravity).value_or(0);
  double alpha = p.contact.alpha * std::pow(early / k_hardly, p.contact.q);
  for (int b = 0; b < model.furniture_total(); ++b)
    if (study::why_not_standing(model, b).empty())
      alpha = std::max(alpha, study::alpha_for_tipping(study::standing(model, p, b), p.contact, k_hardly));
  return alpha;
}

}  // namespace

std::optional<Said> soft_contact(const Setup& setup, const Parameters& p) {
  if (setup.run.analysis != Analysis::dynamic) return std::nullopt;
  const std::optional<double> early = early_tipping(setup.model, p);
  if (!early || !rigid_alpha(setup.model, p.contact, p.gravity) || *early <= k_early) return std::nullopt;
  return said(warning_words::k_soft, p.contact.alpha / k_standard_gravity, std::min(100 * *early, 100.));
}

std::string soft_contact_warning(const Setup& setup, const Parameters& p) {
  const Model& model = setup.model;
  const std::optional<Said> soft = soft_contact(setup, p);
  if (!soft) return "";
  const std::optional<double> rigid = rigid_alpha(model, p.contact, p.gravity);
  const double most = io::key_of(Edit::Key::alpha).most, enough = alpha_for_tipping(model, p);
  std::string words = soft->english + "; ";
  if (enough < most)
    words += fmt::format("{:.0f} kgf keeps that of a steady push below {:g} %; ",
                         rounded_up(enough / k_standard_gravity), 100 * k_hardly);
  return words + (*rigid < most ? fmt::format("no alpha at all takes {:.0f} kgf, with which it lands as on a "
                                              "rigid floor too",
                                              rounded_up(*rigid / k_standard_gravity))
                                : fmt::format("no alpha at all takes {:.0f} kgf, the greatest there is",
                                              most / k_standard_gravity));
}

std::string bending_warning(const Setup& setup) {
  constexpr int k_room = 5;  // bodies, of which the cost is felt
  const Parameters& p = setup.parameters;
  int bending = 0;
  double most = 0;
  for (int b = 0; b < setup.model.furniture_total(); ++b) {
    if (base_level(setup.model, p, b).reason != LevelReason::bending) continue;
    ++bending;
    most = std::max(most, rigid_error(setup.model, p, b));
  }
  if (bending < k_room) return "";
  return fmt::format(
      "{} bodies bend too much to be rigid at run.accuracy = {:g}, the most by {:.2g} of the critical angle: "
      "they are elastic, and frames where they strike something, which takes many times as long; "
      "run.accuracy = "
      "{:g} lets them be rigid, model = \"rigid\" makes them so",
      bending, p.accuracy, most, std::ceil(100 * most + 1) / 100);
}

std::vector<std::string> scene_warnings(const Setup& setup) {
  std::vector<std::string> list;
  if (setup.run.analysis != Analysis::dynamic) return list;
  const State start = start_state(setup.model, setup.starts);
  warn_of_anchors(setup, start, list);
  warn_of_walls(setup, start, list);
  warn_of_falls(setup, start, list);
  warn_of_overlaps(setup, start, list);
  for (std::string words : {soft_contact_warning(setup, setup.parameters), bending_warning(setup)})
    if (!words.empty()) list.push_back(std::move(words));
  std::vector<Said> of_shakes;
  warn_of_shakes(setup.parameters.shakes, setup.run.output_rate, of_shakes);
  for (Said& words : of_shakes) list.push_back(std::move(words.english));
  return list;
}

}  // namespace topple::app
