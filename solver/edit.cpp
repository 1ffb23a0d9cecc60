#include "solver/edit.h"

#include <algorithm>
#include <cmath>

#include "solver/contact_law.h"
#include "solver/excitation.h"

namespace topple {
namespace {

// Periods of the slowest bounce. Over a single one, an alpha made 25 times as great still lifts what stands
// on the floor off it; over two, one made 100 times as great does not.
constexpr double k_contact_passage = 2;

constexpr double k_record_period = 1;  // s, what a record is taken to have; it has none of its own

double period(const Shake& shake, double t) {
  switch (shake.kind) {
    case Shake::Kind::sine:
    case Shake::Kind::sweep:
      return 1 / shake_frequency(shake, t);
    case Shake::Kind::pulse:
      return shake.duration;
    case Shake::Kind::record:
      return k_record_period;
  }
  return 0;
}

void start_passage(Shake& shake, double t) {
  if (t <= shake.start) return;
  shake.amplitude_before = shake_amplitude(shake, t);
  shake.scale_before = shake_scale(shake, t);
  shake.passage = {t, period(shake, t) / 4};
}

void start_contact_passage(const ContactLaw& law, const Model& model, double t, Parameters& parameters) {
  const ContactLaw before = contact_law(parameters, t);
  const double period = std::max(contact_period(model, before, parameters.gravity),
                                 contact_period(model, law, parameters.gravity));
  parameters.contact = law;
  parameters.contact_before = before;
  parameters.contact_passage = {t, k_contact_passage * period};
}

}  // namespace

std::vector<std::pair<Edit::Key, int>> editable(const Parameters& parameters) {
  std::vector<std::pair<Edit::Key, int>> keys;
  for (int i = 0; i < static_cast<int>(parameters.shakes.size()); ++i) {
    const Shake::Kind kind = parameters.shakes[i].kind;
    if (kind == Shake::Kind::record) {
      keys.emplace_back(Edit::Key::scale, i);
      continue;
    }
    if (kind == Shake::Kind::sine) keys.emplace_back(Edit::Key::frequency, i);
    keys.emplace_back(Edit::Key::amplitude, i);
    keys.emplace_back(Edit::Key::direction, i);
  }
  for (const Edit::Key key : {Edit::Key::alpha, Edit::Key::q, Edit::Key::friction}) keys.emplace_back(key, 0);
  if (parameters.contact.kind == ContactLawKind::coulomb) keys.emplace_back(Edit::Key::restitution, 0);
  for (int i = 0; i < static_cast<int>(parameters.anchors.size()); ++i)
    keys.emplace_back(Edit::Key::anchor, i);
  keys.emplace_back(Edit::Key::time_step, 0);
  return keys;
}

Vec3 edited_value(const Parameters& parameters, Edit::Key key, int shake) {
  const auto number = [](double x) { return Vec3(x, 0, 0); };
  switch (key) {
    case Edit::Key::frequency:
      return number(parameters.shakes[shake].frequency);
    case Edit::Key::amplitude:
      return number(parameters.shakes[shake].amplitude);
    case Edit::Key::direction:
      return parameters.shakes[shake].direction;
    case Edit::Key::scale:
      return number(parameters.shakes[shake].scale);
    case Edit::Key::alpha:
      return number(parameters.contact.alpha);
    case Edit::Key::q:
      return number(parameters.contact.q);
    case Edit::Key::friction:
      return number(parameters.contact.friction);
    case Edit::Key::restitution:
      return number(parameters.contact.restitution);
    case Edit::Key::anchor:
      return number(parameters.anchors[shake] ? 1 : 0);
    case Edit::Key::time_step:
      return number(parameters.time_step);
  }
  return Vec3::Zero();
}

void apply(const Edit& edit, const Model& model, double t, Parameters& parameters) {
  ContactLaw law = parameters.contact;
  const double value = edit.value.x();
  switch (edit.key) {
    case Edit::Key::frequency: {
      Shake& shake = parameters.shakes[edit.shake];
      if (t > shake.start) {
        shake.turns = shake_turns(shake, t);
        shake.turned = t - shake.start;
      }
      shake.frequency = value;
      return;
    }
    case Edit::Key::amplitude:
      start_passage(parameters.shakes[edit.shake], t);
      parameters.shakes[edit.shake].amplitude = value;
      return;
    case Edit::Key::direction:
      start_passage(parameters.shakes[edit.shake], t);
      parameters.shakes[edit.shake].direction = edit.value.stableNormalized();
      return;
    case Edit::Key::scale:
      start_passage(parameters.shakes[edit.shake], t);
      parameters.shakes[edit.shake].scale = value;
      return;
    case Edit::Key::anchor:
      parameters.anchors[edit.shake] = value != 0;
      return;
    case Edit::Key::time_step:
      parameters.time_step = value;
      parameters.adaptive = false;
      return;
    case Edit::Key::alpha:
      law.alpha = value;
      break;
    case Edit::Key::q:
      law.q = value;
      break;
    case Edit::Key::friction:
      law.friction = value;
      break;
    case Edit::Key::restitution:
      law.restitution = value;
      break;
  }
  start_contact_passage(law, model, t, parameters);
}

double contact_period(const Model& model, int index, const ContactLaw& law, const Vec3& gravity) {
  const Body& body = model.bodies[index];
  if (model.planes.empty() || gravity.isZero(0) || body.contact_point_count == 0) return 0;
  const double points = static_cast<double>(std::max<std::size_t>(1, body.base_points.size()));
  const ContactPoint& point = model.contact_points[body.first_contact_point];
  const double width = model.planes.front().width > 0 ? model.planes.front().width : point.width;
  const double L = (point.width + width) / 2, g = gravity.norm();
  const double depth = std::pow(body.mass * g / (points * law.alpha), 1 / law.q);
  return 2 * k_pi * std::sqrt(L * depth / (law.q * g));
}

double contact_period(const Model& model, const ContactLaw& law, const Vec3& gravity) {
  double longest = 0;
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b)
    longest = std::max(longest, contact_period(model, b, law, gravity));
  return longest;
}

}  // namespace topple
