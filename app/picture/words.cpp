#include "app/picture/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <span>

#include "app/picture/furnish_words.h"
#include "app/picture/touching_bodies.h"
#include "app/picture/window_words.h"
#include "app/support/terms.h"
#include "app/support/titles.h"
#include "solver/io/document/scene_document.h"
#include "solver/math/ranges.h"
#include "solver/model/accelerogram.h"
#include "solver/model/excitation.h"
#include "solver/run/edit.h"

namespace topple::app {
namespace {

constexpr double k_upright = 0.1;      // degrees: less is standing
constexpr double k_lying = 60;         // degrees
constexpr double k_slid_least = 1e-3;  // m
constexpr double k_surely_lying = 87;  // degrees: also of what slides about
constexpr double k_fall = 0.5;         // m/s: what moves faster below that falls
constexpr double k_at_rest = 0.01;     // m/s: what moves slower at large rests there
constexpr std::size_t k_few_anchors = 4;

constexpr std::size_t k_few_bodies = 5;

using namespace window_words;

constexpr double k_flies = 0.2;  // m/s: what nothing touches and moves faster is in the air

enum class Stance { fallen, beyond, tipped, leaning, standing };

bool moves_faster(const Model& model, const Vec3& gravity, const io::FrameRow& row, std::size_t body,
                  double speed) {
  return io::kinetic_energy(model, gravity, row, static_cast<int>(body)) >=
         model.bodies[body].mass * speed * speed / 2;
}

Stance stance(const Model& model, const Vec3& gravity, const io::FrameRow& row, std::size_t body) {
  const double tilt = row.body[body].tilt * k_degrees, critical = row.body[body].critical_angle * k_degrees;
  const bool lies =
      tilt > k_lying && (tilt > k_surely_lying || !moves_faster(model, gravity, row, body, k_fall));
  return lies ? Stance::fallen
         : tilt > critical
             ? (moves_faster(model, gravity, row, body, k_at_rest) ? Stance::beyond : Stance::tipped)
         : tilt > k_upright ? Stance::leaning
                            : Stance::standing;
}

/// How far the foot of a body went along the floor, m: what the middle of its base would have travelled, were
/// the body set upright about what it leans on. Of one that began on another piece the travel along that.
double slip(const Model& model, const io::FrameRow& row, std::size_t index) {
  constexpr double k_off_the_floor = 0.05;  // m
  const Body& body = model.bodies[index];
  const io::BodyNumbers& now = row.body[index];
  if (body.support_polygon.empty() || body.base_centre.z() > k_off_the_floor) return now.slide;
  const auto place = [&](const Vec3& x) -> Vec3 {
    return now.centre() + now.rotation() * (x - body.centre_of_gravity);
  };
  Vec3 foot = place(body.support_polygon.front());
  for (const Vec3& corner : body.support_polygon)
    if (const Vec3 x = place(corner); x.z() < foot.z()) foot = x;
  const Quat upright = Quat::FromTwoVectors(now.rotation() * Vec3::UnitZ(), Vec3::UnitZ());
  const Vec3 middle = foot + upright * (place(body.base_centre) - foot);
  return (middle - body.base_centre).head<2>().norm();
}

/// Moves, is off all planes, and nothing touches or holds it: what trembles on an edge bears nothing at
/// times.
bool is_in_the_air(const Model& model, const Vec3& gravity, const io::FrameRow& row, std::size_t index) {
  constexpr double k_off = 5e-3;  // m
  const Body& body = model.bodies[index];
  const int planes = static_cast<int>(model.planes.size());
  const auto is_off = [&](const ContactPoint& point) {
    const std::size_t at = 3 * static_cast<std::size_t>(point.node);
    const Vec3 x(row.position[at], row.position[at + 1], row.position[at + 2]);
    return ranges::all_of(model.planes, [&](const Plane& plane) {
      return plane.normal.dot(x - plane.point) - point.width / 2 > k_off;
    });
  };
  const auto first = model.contact_points.begin() + body.first_contact_point;
  const auto is_its = [&](int node) { return model.node_body[node] == static_cast<int>(index); };
  return row.knows_contacts && moves_faster(model, gravity, row, index, k_flies) &&
         !any_force(row.contact_force, body.first_contact_point * planes, body.contact_point_count * planes,
                    3) &&
         std::all_of(first, first + body.contact_point_count, is_off) && !touches_another(body, row) &&
         ranges::none_of(model.supports, [&](const Support& one) { return is_its(one.node); }) &&
         ranges::none_of(model.anchors, [&](const Anchor& one) {
           return one.body == static_cast<int>(index) || one.other.body == static_cast<int>(index);
         });
}

/// Kinds of shakes that have words.
struct ShakeWords {
  Shake::Kind kind;
  std::string (*say_it)(const Shake&);
};
constexpr ShakeWords k_shake_words[] = {
    {Shake::Kind::sine, [](const Shake& s) { return say(k_floor_sine, s.frequency, s.amplitude / k_gal); }},
    {Shake::Kind::sweep,
     [](const Shake& s) { return say(k_floor_sweep, s.frequency, s.last_frequency, s.amplitude / k_gal); }},
    {Shake::Kind::pulse, [](const Shake& s) { return say(k_floor_pulse, s.duration, s.amplitude / k_gal); }},
    {Shake::Kind::record,
     [](const Shake& s) {
       const bool since = s.ramp.over > 0 && s.ramp.since > s.start;
       return since ? say(k_floor_record_since, s.record->duration, s.scale,
                          s.ramp.since)  // its peak may be past
                    : say(k_floor_record, s.record->duration, std::abs(s.scale) * s.record->peak / k_gal);
     }},
};

/// Of an edit that has not come to its end.
std::string change_in_words(const Shake& shake, double t) {
  if (shake.ramp.over == 0 || shake.ramp.share(t) == 1) return "";
  return traits(shake.kind).has_amplitude ? say(k_still_at, shake_amplitude(shake, t).norm() / k_gal)
                                          : say(k_still_times, shake_scale(shake, t));
}

std::string building_in_words(const Shake& shake) {
  if (!shake.building) return "";
  return shake.building->of > 0 ? say(k_on_storey, shake.building->storey, shake.building->of)
                                : say(k_in_a_building);
}

/// Of the angle at which it would topple; of a body without one, of that at which it lies.
double share_of_critical(const io::FrameRow& row, std::size_t body) {
  const double critical = row.body[body].critical_angle;
  return row.body[body].tilt / (critical > 0 ? critical : k_lying / k_degrees);
}

std::string others_in_words(const Model& model, const Vec3& gravity, const io::FrameRow& row,
                            std::span<const std::size_t> others) {
  static constexpr std::pair<Stance, const Phrase&> k_stances[] = {{Stance::fallen, k_count_fallen},
                                                                   {Stance::beyond, k_count_beyond},
                                                                   {Stance::tipped, k_count_tipped},
                                                                   {Stance::leaning, k_count_leaning},
                                                                   {Stance::standing, k_count_standing}};
  std::string counts;
  std::size_t standing = 0;
  for (const auto& [of, words] : k_stances) {
    const auto count = static_cast<std::size_t>(ranges::count_if(
        others, [&, of = of](std::size_t body) { return stance(model, gravity, row, body) == of; }));
    if (of == Stance::standing) standing = count;
    if (count > 0) counts += (counts.empty() ? "" : say(k_comma)) + say(words, count);
  }
  if (standing < others.size()) return say(k_others, others.size(), counts);
  return standing == 1 ? say(k_other_stands) : say(k_others_stand, standing);
}

/// Of one that shakes nothing now.
std::string when_in_words(const Shake& shake, double t) {
  if (t < shake.start) return say(k_shake_from, shake.start);
  return t > shake_end(shake) ? say(k_shake_over, shake_end(shake)) : "";
}

}  // namespace

std::string in_window_language(const std::string& title) {
  return title_in(window_language(), title);
}

std::string title_in_words(const io::Scene& scene, const Parameters& parameters, bool changed) {
  const Model& model = scene.setup.model;
  changed = changed || ranges::any_of(editable(model, parameters), [&](const auto& edited) {
              const auto& [key, index] = edited;
              return edited_value(parameters, key, index) != edited_value(scene.setup.parameters, key, index);
            });
  const std::string title = in_window_language(scene.title);
  return changed && !scene.title.ends_with(io::k_title_changed) ? say(title_words::k_title_changed, title)
                                                                : title;
}

std::string body_in_words(const Model& model, const Vec3& gravity, const io::FrameRow& row,
                          std::size_t body) {
  const io::BodyNumbers& now = row.body[body];
  const double tilt = now.tilt * k_degrees, critical = now.critical_angle * k_degrees;
  std::string line = model.bodies[body].name + say(k_colon);
  if (critical == 0) return line + say(k_tilted, tilt);
  if (is_in_the_air(model, gravity, row, body)) return line + say(k_in_the_air, tilt);
  switch (stance(model, gravity, row, body)) {
    case Stance::fallen:
      line += say(k_fallen, tilt);
      break;
    case Stance::beyond:
      line += say(k_beyond, tilt, critical);
      break;
    case Stance::tipped:  // at the start everything is at rest
      line += row.step == 0 ? say(k_tilted, tilt) : say(k_tipped, tilt, critical);
      break;
    case Stance::leaning:
      line += say(k_leaning, tilt, critical);
      break;
    case Stance::standing:
      line += say(k_standing);
  }
  if (const double slid = slip(model, row, body); slid > k_slid_least) line += say(k_slid, 1e3 * slid);
  return line;
}

std::vector<std::string> bodies_in_words(const Model& model, const Vec3& gravity, const io::FrameRow& row) {
  std::vector<std::size_t> bodies(static_cast<std::size_t>(model.furniture_total()));
  std::iota(bodies.begin(), bodies.end(), 0);
  std::size_t told = bodies.size();
  if (bodies.size() > k_few_bodies) {
    ranges::stable_sort(bodies, std::greater{},
                        [&](std::size_t body) { return share_of_critical(row, body); });
    const auto still = ranges::find_if(
        bodies, [&](std::size_t body) { return stance(model, gravity, row, body) == Stance::standing; });
    told = std::min(k_few_bodies, static_cast<std::size_t>(still - bodies.begin()));
  }
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < told; ++i) lines.push_back(body_in_words(model, gravity, row, bodies[i]));
  if (told == 0 && !bodies.empty()) {
    const auto slid = [&](std::size_t body) { return slip(model, row, body); };
    const std::size_t farthest = *ranges::max_element(bodies, {}, slid);
    const double slide = slid(farthest);
    lines.push_back(
        say(k_all_stand, bodies.size()) +
        (slide > k_slid_least ? say(k_slid_farthest, model.bodies[farthest].name, 1e3 * slide) : ""));
  } else if (told < bodies.size())
    lines.push_back(others_in_words(model, gravity, row, std::span(bodies).subspan(told)));
  return lines;
}

int most_lines_of_bodies(const Model& model) {
  const int bodies = model.furniture_total(), few = static_cast<int>(k_few_bodies);
  return bodies > few ? few + 1 : bodies;
}

std::string anchor_type_in_words(const Anchor& anchor) {
  if (!anchor.fixing.empty()) return furnish_words::in_words(furnish_words::k_fixing_kinds, anchor.fixing);
  static constexpr const Phrase* k_types[] = {&k_strap, &k_bracket, &k_pole};
  return say(*k_types[static_cast<std::size_t>(anchor.type)]);
}

namespace {

const Phrase& phrase_of_state(float state) {
  if (state == io::k_anchor_away) return k_away;
  if (state == io::k_anchor_slack) return k_slack;
  return state == io::k_anchor_holds ? k_holds : k_broken_anchor;
}

}  // namespace

std::string anchor_in_words(const Model& model, const io::FrameRow& row, std::size_t k) {
  const Anchor& anchor = model.anchors[k];
  const io::AnchorNumbers& now = row.anchor[k];
  const std::string type = anchor.fixing.empty() ? anchor_type(anchor) : anchor.fixing;
  const bool says_type = anchor.name.starts_with(type + "-") || anchor.name.starts_with(type + " ");
  const std::string own = anchor.name == type ? ""
                          : says_type         ? anchor.name.substr(type.size())
                                              : " " + anchor.name;
  const std::string line = anchor_type_in_words(anchor) + own + say(k_colon);
  const float state = io::anchor_state(anchor, now);
  if (state != io::k_anchor_holds || now.tension == 0) return line + say(phrase_of_state(state));
  const double force = std::abs(now.tension);
  const bool pin = anchor.length == 0;  // in any direction
  return line +
         say(pin               ? k_holds_with
             : now.tension > 0 ? k_pulls
                               : k_pushes,
             force) +
         (std::isfinite(anchor.strength) ? say(k_of_strength, percent_of(force, anchor.strength)) : "");
}

std::vector<std::string> anchors_in_words(const Model& model, const io::FrameRow& row) {
  std::vector<std::string> lines;
  if (model.anchors.size() <= k_few_anchors) {
    for (std::size_t k = 0; k < model.anchors.size(); ++k) lines.push_back(anchor_in_words(model, row, k));
    return lines;
  }
  std::string counts;
  for (const float state : {io::k_anchor_holds, io::k_anchor_slack, io::k_anchor_broken, io::k_anchor_away}) {
    int count = 0;
    for (std::size_t k = 0; k < model.anchors.size(); ++k)
      count += io::anchor_state(model.anchors[k], row.anchor[k]) == state;
    if (count > 0)
      counts +=
          fmt::format("{}{} {}", counts.empty() ? "" : say(k_comma), count, say(phrase_of_state(state)));
  }
  lines.push_back(say(k_anchors, counts));
  return lines;
}

std::string instant_in_words(const Setup& setup, const io::FrameRow& row) {
  if (is_static(setup)) return say(k_load_instant, row.step, setup.run.statics.load_steps, row.load_factor);
  const double hundredths = 100 / setup.run.output_rate;  // between rows
  return fmt::format("t = {:.{}f} s", row.time, hundredths == std::round(hundredths) ? 2 : 3);
}

std::string shake_in_words(const Parameters& parameters, double t) {
  if (parameters.shakes.empty()) return "";
  const Shake& shake = parameters.shakes.front();
  const auto* const words = ranges::find(k_shake_words, shake.kind, &ShakeWords::kind);
  const std::string one =
      (words == std::end(k_shake_words) ? traits(shake.kind).word : words->say_it(shake)) +
      change_in_words(shake, t) + building_in_words(shake) + when_in_words(shake, t);
  const std::size_t more = parameters.shakes.size() - 1;
  return more > 0 ? say(k_more_shakes, one, more) : one;
}

}  // namespace topple::app
