#include "solver/run/edit.h"

#include <algorithm>
#include <cmath>

#include "solver/body/ladder.h"
#include "solver/contact/contact_law.h"
#include "solver/contact/contact_period.h"
#include "solver/math/elementary.h"
#include "solver/model/excitation.h"

namespace topple {
namespace {

// Periods of the slowest bounce. Over a single one, an alpha made 25 times as great still lifts what stands
// on the floor off it; over two, one made 100 times as great does not.
constexpr double k_contact_passage = 2;

constexpr double k_sweep = 10;     // s, of a sweep that was a sine, to ten times its frequency
constexpr double k_highest = 1e3;  // Hz, legal

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

std::vector<std::pair<Edit::Key, int>> editable(const Model& model, const Parameters& parameters) {
  using K = Edit::Key;
  std::vector<std::pair<K, int>> keys;
  const auto add = [&](std::initializer_list<K> all, int index = 0) {
    for (const K key : all) keys.emplace_back(key, index);
  };
  for (int i = 0; i < static_cast<int>(parameters.shakes.size()); ++i) {
    add({K::on}, i);
    switch (parameters.shakes[i].kind) {
      case Shake::Kind::sine:
        add({K::type, K::frequency, K::amplitude, K::direction}, i);
        break;
      case Shake::Kind::sweep:
        add({K::type, K::frequency, K::amplitude, K::direction, K::duration}, i);
        break;
      case Shake::Kind::pulse:
        add({K::type, K::amplitude, K::direction, K::duration}, i);
        break;
      case Shake::Kind::record:
        add({K::scale}, i);
        break;
    }
  }
  add({K::law, K::alpha, K::q, K::friction});
  if (parameters.contact.kind == ContactLawKind::coulomb) add({K::friction_static, K::restitution});
  for (int b = 0; b < model.furniture_total(); ++b) {
    if (can_be(model, b, BodyModel::rigid)) add({K::model}, b);
    if (model.bodies[b].first_frequency > 0) add({K::damping}, b);
  }
  for (int i = 0; i < static_cast<int>(parameters.anchors.size()); ++i) add({K::anchor}, i);
  add({K::integrator, K::want, K::time_step});
  return keys;
}

Vec3 edited_value(const Parameters& p, Edit::Key key, int index) {
  const auto number = [](double x) { return Vec3(x, 0, 0); };
  const auto choice = [&](auto x) { return number(static_cast<int>(x)); };
  switch (key) {
    case Edit::Key::on:
      return choice(p.shakes[index].on);
    case Edit::Key::type:
      return choice(p.shakes[index].kind);
    case Edit::Key::frequency:
      if (p.shakes[index].kind == Shake::Kind::sweep)
        return {p.shakes[index].frequency, p.shakes[index].last_frequency, 0};
      return number(p.shakes[index].frequency);
    case Edit::Key::amplitude:
      return number(p.shakes[index].amplitude);
    case Edit::Key::direction:
      return p.shakes[index].direction;
    case Edit::Key::duration:
      return number(p.shakes[index].duration);
    case Edit::Key::scale:
      return number(p.shakes[index].scale);
    case Edit::Key::law:
      return choice(p.contact.kind);
    case Edit::Key::alpha:
      return number(p.contact.alpha);
    case Edit::Key::q:
      return number(p.contact.q);
    case Edit::Key::friction:
      return number(p.contact.friction);
    case Edit::Key::friction_static:
      return number(p.contact.friction + p.contact.excess());
    case Edit::Key::restitution:
      return number(p.contact.restitution);
    case Edit::Key::model:
      return choice(p.models.empty() ? BodyModel::frame : p.models[index]);
    case Edit::Key::damping:
      return number(p.damping.empty() ? 0 : p.damping[index]);
    case Edit::Key::anchor:
      return choice(static_cast<bool>(p.anchors[index]));
    case Edit::Key::integrator:
      return number(1 + static_cast<int>(p.integrator));
    case Edit::Key::want:
      return choice(p.want_stress);
    case Edit::Key::time_step:
      return number(p.time_step);
  }
  return Vec3::Zero();
}

namespace {

void apply_to_shake(const Edit& edit, double t, Shake& shake) {
  const double value = edit.value.x();
  const auto begin_anew = [&] {
    shake.start = t;
    shake.turned = shake.turns = 0;
    shake.passage = {};
    shake.initial_velocity = Shake::Start::rest;
  };
  switch (edit.key) {
    case Edit::Key::type: {
      const Shake::Kind kind = static_cast<Shake::Kind>(static_cast<int>(value));
      if (shake.kind == Shake::Kind::sine && kind == Shake::Kind::pulse)
        shake.duration = 0.5 / shake.frequency;
      if (shake.kind == Shake::Kind::sine && kind == Shake::Kind::sweep) {
        shake.duration = k_sweep;
        shake.last_frequency = std::min(10 * shake.frequency, k_highest);
      }
      shake.kind = kind;
      begin_anew();
      break;
    }
    case Edit::Key::frequency:
      if (shake.kind == Shake::Kind::sweep) {
        shake.last_frequency = edit.value.y();
        begin_anew();
      } else if (t > shake.start) {
        shake.turns = shake_turns(shake, t);
        shake.turned = t - shake.start;
      }
      shake.frequency = value;
      break;
    case Edit::Key::duration:
      shake.duration = value;
      break;
    case Edit::Key::on:
      start_passage(shake, t);
      shake.on = value != 0;
      break;
    case Edit::Key::amplitude:
      start_passage(shake, t);
      shake.amplitude = value;
      break;
    case Edit::Key::direction:
      start_passage(shake, t);
      shake.direction = edit.value.stableNormalized();
      break;
    default:
      start_passage(shake, t);
      shake.scale = value;
  }
}

}  // namespace

void apply(const Edit& edit, const Model& model, double t, Parameters& p) {
  ContactLaw law = p.contact;
  const double value = edit.value.x();
  const int choice = static_cast<int>(value);
  switch (edit.key) {
    case Edit::Key::on:
    case Edit::Key::type:
    case Edit::Key::frequency:
    case Edit::Key::amplitude:
    case Edit::Key::direction:
    case Edit::Key::duration:
    case Edit::Key::scale:
      apply_to_shake(edit, t, p.shakes[edit.shake]);
      return;
    case Edit::Key::model:
      p.models.resize(model.bodies.size(), BodyModel::frame);
      p.models[edit.shake] = static_cast<BodyModel>(choice);
      return;
    case Edit::Key::damping:
      p.damping.resize(model.bodies.size(), 0);
      p.damping[edit.shake] = value;
      return;
    case Edit::Key::anchor:
      p.anchors[edit.shake] = value != 0;
      return;
    case Edit::Key::integrator:
      p.integrator = chosen_integrator(choice);
      return;
    case Edit::Key::want:
      p.want_stress = value != 0;
      return;
    case Edit::Key::time_step:
      p.time_step = value;
      p.adaptive = false;
      return;
    case Edit::Key::law:
      p.contact.kind = p.contact_before.kind = static_cast<ContactLawKind>(choice);
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
    case Edit::Key::friction_static:
      law.friction_static = value;
      break;
    case Edit::Key::restitution:
      law.restitution = value;
      break;
  }
  start_contact_passage(law, model, t, p);
}

}  // namespace topple
