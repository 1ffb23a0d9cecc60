#include "solver/run/edit.h"

#include <algorithm>
#include <cmath>

#include "solver/body/model_level.h"
#include "solver/contact/contact_law.h"
#include "solver/contact/contact_period.h"
#include "solver/frame/integrator.h"
#include "solver/math/elementary.h"
#include "solver/model/excitation.h"

namespace topple {
namespace {

// Periods of the slowest bounce. Over a single one, an alpha made 25 times as great still lifts what stands
// on the floor off it; over two, one made 100 times as great does not.
constexpr double k_contact_ramp = 2;

/// An edit before a run has moved: what it sets is what the run starts with.
bool starts_run(double t) {
  return t <= 0;
}

void start_ramp(Shake& shake, double t) {
  if (t <= shake.start) return;
  shake.amplitude_before = shake_amplitude(shake, t);
  shake.scale_before = shake_scale(shake, t);
  shake.ramp = {t, traits(shake.kind).period(shake, t) / 4};
}

void start_contact_ramp(const ContactLaw& law, const Model& model, double t, Parameters& parameters) {
  const ContactLaw before = contact_law(parameters, t);
  const double period = std::max(contact_period(model, before, parameters.gravity),
                                 contact_period(model, law, parameters.gravity));
  parameters.contact = law;
  parameters.contact_before = before;
  parameters.contact_ramp = {t, k_contact_ramp * period};
}

void begin_anew(Shake& shake, double t) {
  if (starts_run(t)) return;
  shake.start = t;
  shake.turned = shake.turns = 0;
  shake.ramp = {};
  shake.initial_velocity = Shake::Start::rest;
}

Vec3 number(double x) {
  return {x, 0, 0};
}

template <class Kind>
Vec3 number_of(Kind kind) {
  return number(static_cast<int>(kind));
}

template <class Kind>
Kind chosen(const Edit& edit) {
  return static_cast<Kind>(static_cast<int>(edit.value.x()));
}

int one(const Model&, const Parameters&) {
  return 1;
}

bool always(const Model&, const Parameters&, int) {
  return true;
}

template <bool ShakeTraits::*has>
bool of_shakes_with(const Model&, const Parameters& p, int index) {
  return traits(p.shakes[index].kind).*has;
}

// A building's floor follows the ground as it was when the building was made.
template <bool ShakeTraits::*has>
bool of_ground_with(const Model& model, const Parameters& p, int index) {
  return !p.shakes[index].building && of_shakes_with<has>(model, p, index);
}

template <auto value>
Vec3 of_shake(const Parameters& p, int index) {
  return number(p.shakes[index].*value);
}

template <auto value>
void set_through_ramp(const Edit& edit, const Model&, double t, Parameters& p) {
  Shake& shake = p.shakes[edit.index];
  start_ramp(shake, t);
  shake.*value = edit.value.x();
}

void set_type(const Edit& edit, const Model&, double t, Parameters& p) {
  Shake& shake = p.shakes[edit.index];
  const ShakeTraits &before = traits(shake.kind), &after = traits(chosen<Shake::Kind>(edit));
  if (after.complete && before.has_frequency && !before.has_duration) after.complete(shake);
  shake.kind = after.kind;
  begin_anew(shake, t);
}

Vec3 frequencies(const Parameters& p, int index) {
  const Shake& shake = p.shakes[index];
  return {shake.frequency, traits(shake.kind).sweeps ? shake.last_frequency : 0, 0};
}

void set_frequency(const Edit& edit, const Model&, double t, Parameters& p) {
  Shake& shake = p.shakes[edit.index];
  if (traits(shake.kind).sweeps) {
    shake.last_frequency = edit.value.y();
    begin_anew(shake, t);
  } else if (t > shake.start) {
    shake.turns = shake_turns(shake, t);
    shake.turned = t - shake.start;
  }
  shake.frequency = edit.value.x();
}

void set_direction(const Edit& edit, const Model&, double t, Parameters& p) {
  start_ramp(p.shakes[edit.index], t);
  p.shakes[edit.index].direction = edit.value.stableNormalized();
}

bool has_restitution(const Model&, const Parameters& p, int) {
  return traits(p.contact).has_restitution;
}

template <double ContactLaw::*value>
Vec3 of_contact(const Parameters& p, int) {
  return number(p.contact.*value);
}

template <double ContactLaw::*value>
void set_contact(const Edit& edit, const Model& model, double t, Parameters& p) {
  ContactLaw law = p.contact;
  law.*value = edit.value.x();
  if (starts_run(t))
    p.contact = law;
  else
    start_contact_ramp(law, model, t, p);
}

// A hand takes hold and lets go about as fast.
constexpr double k_pull_ramp = 0.05;  // s

auto find_pull(auto& pulls, int node) {
  return std::lower_bound(pulls.begin(), pulls.end(), node,
                          [](const Pull& pull, int n) { return pull.node < n; });
}

Vec3 pull_on(const Parameters& p, int node) {
  const auto at = find_pull(p.pulls, node);
  return at == p.pulls.end() || at->node != node ? Vec3(Vec3::Zero()) : at->force;
}

void set_pull(const Edit& edit, const Model&, double t, Parameters& p) {
  std::erase_if(p.pulls, [&](const Pull& pull) { return pull.force.isZero(0) && pull.ramp.share(t) == 1; });
  const auto at = find_pull(p.pulls, edit.index);
  const bool held = at != p.pulls.end() && at->node == edit.index;
  if (!held && edit.value.isZero(0)) return;
  const Pull pull{edit.index, edit.value, held ? pull_force(*at, t) : Vec3(Vec3::Zero()), {t, k_pull_ramp}};
  if (held)
    *at = pull;
  else
    p.pulls.insert(at, pull);
}

using K = Edit::Key;
using Of = Edit::Of;
constexpr EditTableTraits k_tables[] = {
    {Of::shake, "shake", "shake", true,
     [](const Model&, const Parameters& p) { return static_cast<int>(p.shakes.size()); }},
    {Of::contact, "contact", "contact", false, one},
    {Of::body, "body", "cabinet", true,
     [](const Model& model, const Parameters&) { return model.furniture_total(); }},
    {Of::anchor, "anchor", "anchor", true,
     [](const Model&, const Parameters& p) { return static_cast<int>(p.anchors.size()); }},
    {Of::run, "run", "run", false, one},
    {Of::node, "node", "node", true,
     [](const Model& model, const Parameters&) { return static_cast<int>(model.node_position.size()); }},
};

constexpr EditTraits k_edits[] = {
    {K::on, Of::shake, "on", false, always, of_shake<&Shake::on>,
     [](const Edit& edit, const Model&, double t, Parameters& p) {
       start_ramp(p.shakes[edit.index], t);
       p.shakes[edit.index].on = edit.value.x() != 0;
     }},
    {K::type, Of::shake, "type", false, of_ground_with<&ShakeTraits::has_amplitude>,
     [](const Parameters& p, int index) { return number_of(p.shakes[index].kind); }, set_type},
    {K::frequency, Of::shake, "frequency", false, of_ground_with<&ShakeTraits::has_frequency>, frequencies,
     set_frequency},
    {K::amplitude, Of::shake, "amplitude", false, of_shakes_with<&ShakeTraits::has_amplitude>,
     of_shake<&Shake::amplitude>, set_through_ramp<&Shake::amplitude>},
    {K::direction, Of::shake, "direction", false, of_shakes_with<&ShakeTraits::has_amplitude>,
     [](const Parameters& p, int index) { return p.shakes[index].direction; }, set_direction},
    {K::duration, Of::shake, "duration", false, of_ground_with<&ShakeTraits::has_duration>,
     of_shake<&Shake::duration>,
     [](const Edit& edit, const Model&, double, Parameters& p) {
       p.shakes[edit.index].duration = edit.value.x();
     }},
    {K::scale, Of::shake, "scale", false,
     [](const Model&, const Parameters& p, int index) { return !traits(p.shakes[index].kind).has_amplitude; },
     of_shake<&Shake::scale>, set_through_ramp<&Shake::scale>},
    {K::law, Of::contact, "law", true, always,
     [](const Parameters& p, int) { return number_of(p.contact.kind); },
     [](const Edit& edit, const Model&, double, Parameters& p) {
       p.contact.kind = p.contact_before.kind = chosen<ContactLawKind>(edit);
     }},
    {K::alpha, Of::contact, "alpha", false, always, of_contact<&ContactLaw::alpha>,
     set_contact<&ContactLaw::alpha>},
    {K::q, Of::contact, "q", false, always, of_contact<&ContactLaw::q>, set_contact<&ContactLaw::q>},
    {K::friction, Of::contact, "friction", false, always, of_contact<&ContactLaw::friction>,
     set_contact<&ContactLaw::friction>},
    {K::friction_static, Of::contact, "friction_static", true, has_restitution,
     [](const Parameters& p, int) { return number(p.contact.friction + p.contact.excess()); },
     set_contact<&ContactLaw::friction_static>},
    {K::restitution, Of::contact, "restitution", true, has_restitution, of_contact<&ContactLaw::restitution>,
     set_contact<&ContactLaw::restitution>},
    {K::model, Of::body, "model", true,
     [](const Model& model, const Parameters&, int b) { return can_be(model, b, BodyModel::rigid); },
     [](const Parameters& p, int b) { return number_of(p.models.empty() ? BodyModel::frame : p.models[b]); },
     [](const Edit& edit, const Model& model, double, Parameters& p) {
       p.models.resize(model.bodies.size(), BodyModel::frame);
       p.models[edit.index] = chosen<BodyModel>(edit);
     },
     true},
    {K::damping, Of::body, "damping", true,
     [](const Model& model, const Parameters&, int b) { return model.bodies[b].first_frequency > 0; },
     [](const Parameters& p, int b) { return number(p.damping.empty() ? 0 : p.damping[b]); },
     [](const Edit& edit, const Model& model, double, Parameters& p) {
       p.damping.resize(model.bodies.size(), 0);
       p.damping[edit.index] = edit.value.x();
     }},
    {K::anchor, Of::anchor, "on", false, always,
     [](const Parameters& p, int index) { return number(p.anchors[index]); },
     [](const Edit& edit, const Model&, double, Parameters& p) {
       p.anchors[edit.index] = edit.value.x() != 0;
     }},
    {K::integrator, Of::run, "integrator", true, always,
     [](const Parameters& p, int) {
       const bool automatic = p.automatic_integrator && p.integrator == Integrator::generalized_alpha;
       return automatic ? number(k_automatic_integrator) : number_of(p.integrator);
     },
     [](const Edit& edit, const Model&, double, Parameters& p) {
       p.automatic_integrator = edit.value.x() == k_automatic_integrator;
       p.integrator = p.automatic_integrator ? Integrator::generalized_alpha : chosen<Integrator>(edit);
     },
     true},
    {K::want, Of::run, "want", true, always, [](const Parameters& p, int) { return number(p.want_stress); },
     [](const Edit& edit, const Model&, double, Parameters& p) { p.want_stress = edit.value.x() != 0; }},
    {K::time_step, Of::run, "time_step", true, always,
     [](const Parameters& p, int) { return number(p.adaptive ? 0 : p.time_step); },
     [](const Edit& edit, const Model&, double, Parameters& p) {
       p.adaptive = edit.value.x() == 0;
       if (!p.adaptive) p.time_step = edit.value.x();
     },
     true},
    {K::pull, Of::node, "pull", true, [](const Model&, const Parameters&, int) { return false; }, pull_on,
     set_pull},
};

}  // namespace

std::span<const EditTableTraits> edit_tables() {
  return k_tables;
}

std::span<const EditTraits> edits() {
  return k_edits;
}

std::vector<std::pair<Edit::Key, int>> editable(const Model& model, const Parameters& parameters) {
  std::vector<std::pair<Edit::Key, int>> keys;
  const auto* const end = std::end(k_edits);
  for (const auto* first = std::begin(k_edits); first != end;) {
    const auto* const last =
        std::find_if(first, end, [&](const EditTraits& row) { return row.of != first->of; });
    for (int index = 0; index < traits(first->of).count(model, parameters); ++index)
      for (const EditTraits& row : std::span(first, last))
        if (row.exists(model, parameters, index)) keys.emplace_back(row.kind, index);
    first = last;
  }
  return keys;
}

Vec3 edited_value(const Parameters& parameters, Edit::Key key, int index) {
  return traits(key).get(parameters, index);
}

void apply(const Edit& edit, const Model& model, double t, Parameters& parameters) {
  traits(edit.key).set(edit, model, t, parameters);
}

}  // namespace topple
