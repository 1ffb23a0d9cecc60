// NaN, infinity and 1e308 in any number of State or Parameters: nobody goes on from them.
#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <span>
#include <stdexcept>

#include "solver/body/model_level.h"
#include "solver/element/damping.h"
#include "solver/frame/modes.h"
#include "solver/model/accelerogram.h"
#include "solver/reduced/elastic_basis.h"
#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

const double k_bad[] = {std::nan(""), std::numeric_limits<double>::infinity(), -1e308, 1e308};

struct Way {
  const char* name;
  BodyModel model = BodyModel::frame;
  Integrator integrator = Integrator::generalized_alpha;
  bool adaptive = false;
};
const Way k_ways[] = {{"generalized-alpha"},
                      {"newmark", BodyModel::frame, Integrator::newmark},
                      {"central-difference", BodyModel::frame, Integrator::central_difference},
                      {"adaptive", BodyModel::frame, Integrator::generalized_alpha, true},
                      {"adaptive central-difference", BodyModel::frame, Integrator::central_difference, true},
                      {"rigid", BodyModel::rigid},
                      {"adaptive rigid", BodyModel::rigid, Integrator::generalized_alpha, true},
                      {"elastic", BodyModel::elastic},
                      {"adaptive elastic", BodyModel::elastic, Integrator::generalized_alpha, true}};

FrameSpec tripod(const char* name, const Vec3& at) {
  FrameSpec spec;
  spec.name = name;
  for (int k = 0; k < 3; ++k)
    spec.nodes.push_back(at + Vec3(0.3 * std::cos(2 * k), 0.3 * std::sin(2 * k), 0.015));
  spec.nodes.push_back(at + Vec3(0, 0, 0.6));
  for (int k = 0; k < 3; ++k) spec.members.push_back({{k, 3}, 0, 0});
  return spec;
}

std::shared_ptr<const Accelerogram> short_record() {
  AccelerogramComponent component;
  component.interval = 0.01;
  for (int k = 0; k < 40; ++k) component.samples.push_back(std::sin(0.3 * k));
  return make_accelerogram({component});
}

void compute_as(topple::Setup& setup, BodyModel model) {
  const int bodies = static_cast<int>(setup.model.bodies.size());
  for (int b = 0; b < bodies; ++b) {
    setup.model.bodies[b].elastic = elastic_basis(setup.model, b);
    setup.model.bodies[b].first_frequency = first_frequency(setup.model, b);
  }
  setup.parameters.models.assign(bodies, model);
  setup.parameters.damping.assign(bodies, 0.01);
}

/// A tripod that yields, on the floor and beside a wall, held by three anchors, under every kind of shake.
topple::Setup held_tripod(const Way& way) {
  topple::Setup setup;
  Model& model = setup.model;
  model = steel_model();
  model.materials[0].yield = 235e6;
  setup.starts = add_frame(model, tripod("tripod", Vec3::Zero()));
  model.planes.push_back(ground());
  model.planes.push_back({"wall", Vec3(-5, 0, 0), Vec3::UnitX(), 0.09});
  for (const auto type : {Anchor::Type::strap, Anchor::Type::bracket, Anchor::Type::pole}) {
    Anchor anchor;
    anchor.name = "anchor";
    anchor.body = 0;
    anchor.node = 3;
    anchor.arm.setZero();
    anchor.to = Vec3(1, 0, 0.6);
    anchor.type = type;
    anchor.stiffness = 1e4;
    anchor.length = (model.node_position[3] - anchor.to).norm();
    model.anchors.push_back(anchor);
  }
  Parameters& p = setup.parameters;
  p.anchors = {true, true, true};
  for (const auto kind : {Shake::Kind::sine, Shake::Kind::sweep, Shake::Kind::pulse, Shake::Kind::record}) {
    Shake s;
    s.kind = kind;
    s.amplitude = 2;
    s.frequency = 3;
    s.last_frequency = 5;
    s.cycles = 30;
    s.taper = 1;
    s.duration = 2;
    if (kind == Shake::Kind::record) s.record = short_record();
    p.shakes.push_back(s);
  }
  p.integrator = way.integrator;
  p.adaptive = way.adaptive;
  p.time_step = way.integrator == Integrator::central_difference ? 1e-6 : 1e-3;
  p.contact.friction_static = 0.7;
  compute_as(setup, way.model);
  setup.run.settle = false;
  return setup;
}

/// Two that touch each other, one of them with a broken element and a hinge.
topple::Setup touching_tripods(const Way& way) {
  topple::Setup setup = held_tripod(way);
  setup.model = steel_model();
  setup.model.materials[0].yield = 235e6;
  setup.starts = add_frame(setup.model, tripod("below", Vec3::Zero()));
  FrameSpec above = tripod("above", Vec3(0.01, 0.005, 0.028));
  above.velocity = Vec3(0.1, 0, -0.1);
  setup.starts.push_back(add_frame(setup.model, above)[0]);
  setup.model.planes.push_back(ground());
  setup.parameters.anchors.clear();
  compute_as(setup, way.model);
  return setup;
}

/// Its state after a few steps, contacts closed.
State after_steps(const topple::Setup& setup) {
  topple::Run run(setup);
  for (int i = 0; i < 5; ++i) {
    const StepStatus status = run.advance();
    EXPECT_TRUE(status.ok()) << status.message(setup.model);
  }
  return run.state();
}

struct Stepped {
  StepStatus status;
  State state;
};

/// As a run that goes on from a checkpoint does.
Stepped stepped(const topple::Setup& setup, const Parameters& parameters, const State& from) {
  topple::Run run(setup, from, parameters);
  if (!run.over()) run.advance();
  return {run.status(), run.status().ok() ? run.state() : from};
}

void expect_state_contained(const topple::Setup& setup, const State& good) {
  const std::vector<double> numbers = pack(good);
  const Stepped clean = stepped(setup, setup.parameters, unpack(setup.model, numbers));
  ASSERT_TRUE(clean.status.ok()) << clean.status.message(setup.model);
  std::size_t refused = 0;
  // the first is the count of steps, an integer
  for (std::size_t k = 1; k < numbers.size(); ++k)
    for (const double bad : k_bad) {
      SCOPED_TRACE(testing::Message() << "number " << k << " of " << numbers.size() << ", " << numbers[k]
                                      << ", becomes " << bad);
      std::vector<double> changed = numbers;
      changed[k] = bad;
      State from;
      try {
        from = unpack(setup.model, changed);
      } catch (const std::invalid_argument&) {  // a choice, a count or an index
        ++refused;
        continue;
      }
      const Stepped out = stepped(setup, setup.parameters, from);
      if (out.status.ok()) {
        EXPECT_EQ(hash(out.state), hash(clean.state)) << "accepted, and it played a part";
        continue;
      }
      ++refused;
      EXPECT_EQ(out.status.kind, StepStatus::Kind::not_finite);
      EXPECT_NE(out.status.message(setup.model), "");
    }
  EXPECT_GT(refused, numbers.size());
}

TEST(Containment, no_bad_number_in_the_state_is_stepped_on_from) {
  for (const Way& way : k_ways) {
    SCOPED_TRACE(way.name);
    const topple::Setup setup = held_tripod(way);
    expect_state_contained(setup, after_steps(setup));
  }
}

TEST(Containment, no_bad_number_in_the_state_of_bodies_that_touch_or_broke_is_stepped_on_from) {
  for (const Way& way : k_ways) {
    SCOPED_TRACE(way.name);
    const topple::Setup setup = touching_tripods(way);
    State state = after_steps(setup);
    EXPECT_FALSE(state.candidate_pairs.empty());
    EXPECT_FALSE(state.member_sticks.empty());
    state.elements[0].hinge = Hinge::broken;
    state.elements[3].hinge = Hinge::first;
    expect_state_contained(setup, state);
  }
}

// In the middle of a run only what a step uses is looked at: it is refused with the state as it was, or the
// number played no part, and all others are those of a clean step, bit for bit.
void expect_found_in_the_next_step(const topple::Setup& setup) {
  const State good = after_steps(setup);
  const std::vector<double> numbers = pack(good);
  const auto step_from = [&](State& state) {
    Workspace workspace(setup.model);
    resume(setup.model, good, workspace);
    const StepStatus status = step(setup.model, setup.parameters, state, workspace);
    if (status.ok()) place_nodes(setup.model, state);
    return status;
  };
  State clean = good;
  ASSERT_TRUE(step_from(clean).ok());
  for (std::size_t k = 1; k < numbers.size(); ++k)
    for (const double bad : k_bad) {
      SCOPED_TRACE(testing::Message() << "number " << k << " of " << numbers.size() << ", " << numbers[k]
                                      << ", becomes " << bad);
      std::vector<double> changed = numbers;
      changed[k] = bad;
      State state;
      try {
        state = unpack(setup.model, changed);
      } catch (const std::invalid_argument&) {
        continue;
      }
      const std::uint64_t before = hash(state);
      const StepStatus status = step_from(state);
      if (status.ok()) {
        std::vector<double> after = pack(state), expected = pack(clean);
        after[k] = expected[k];
        EXPECT_TRUE(std::ranges::equal(std::as_bytes(std::span(after)), std::as_bytes(std::span(expected))))
            << "accepted, and it played a part";
      } else {
        EXPECT_EQ(hash(state), before);
        EXPECT_NE(status.message(setup.model), "");
      }
    }
}

TEST(Containment, a_bad_number_that_appears_between_two_steps_is_found_in_the_next) {
  for (const Way& way : k_ways) {
    SCOPED_TRACE(way.name);
    expect_found_in_the_next_step(held_tripod(way));
    expect_found_in_the_next_step(touching_tripods(way));
  }
}

/// Every number of the parameters, by name. A new member does not compile until it is added here.
std::map<std::string, std::function<double&(Parameters&)>> numbers_of(const Parameters& all) {
  std::map<std::string, std::function<double&(Parameters&)>> out;
  const auto add_law = [&](const std::string& name, ContactLaw Parameters::*law) {
    const auto add = [&](const char* number, double ContactLaw::*of) {
      out[name + "." + number] = [law, of](Parameters& p) -> double& { return p.*law.*of; };
    };
    [[maybe_unused]] const auto& [kind, alpha, q, friction, friction_static, restitution, normal, slip,
                                  share] = all.*law;
    add("alpha", &ContactLaw::alpha);
    add("q", &ContactLaw::q);
    add("friction", &ContactLaw::friction);
    add("friction_static", &ContactLaw::friction_static);
    add("restitution", &ContactLaw::restitution);
    add("normal_speed", &ContactLaw::normal_speed);
    add("slip_speed", &ContactLaw::slip_speed);
    add("member_share", &ContactLaw::member_share);
  };
  add_law("contact", &Parameters::contact);
  add_law("contact_before", &Parameters::contact_before);
  for (std::size_t i = 0; i < all.shakes.size(); ++i) {
    const std::string name = "shake " + std::to_string(i) + ".";
    const auto add = [&](const char* number, double Shake::*of) {
      out[name + number] = [i, of](Parameters& p) -> double& { return p.shakes[i].*of; };
    };
    [[maybe_unused]] const auto& [kind, amplitude, frequency, last_frequency, direction, start, on, cycles,
                                  taper, initial_velocity, shape, duration, record, scale, building, turned,
                                  turns, amplitude_before, scale_before, ramp] = all.shakes[i];
    add("amplitude", &Shake::amplitude);
    add("frequency", &Shake::frequency);
    add("last_frequency", &Shake::last_frequency);
    add("start", &Shake::start);
    add("cycles", &Shake::cycles);
    add("taper", &Shake::taper);
    add("duration", &Shake::duration);
    add("scale", &Shake::scale);
    add("turned", &Shake::turned);
    add("turns", &Shake::turns);
    add("scale_before", &Shake::scale_before);
    for (int k = 0; k < 3; ++k) {
      out[name + "direction " + std::to_string(k)] = [i, k](Parameters& p) -> double& {
        return p.shakes[i].direction[k];
      };
      out[name + "amplitude_before " + std::to_string(k)] = [i, k](Parameters& p) -> double& {
        return p.shakes[i].amplitude_before[k];
      };
    }
    out[name + "ramp.since"] = [i](Parameters& p) -> double& { return p.shakes[i].ramp.since; };
    out[name + "ramp.over"] = [i](Parameters& p) -> double& { return p.shakes[i].ramp.over; };
  }
  [[maybe_unused]] const auto& [contact, contact_before, contact_ramp, shakes, models, damping, anchors,
                                pulls, want_stress, accuracy, gravity, integrator, automatic, spectral_radius,
                                beta, gamma, time_step, adaptive, tolerance, substep_refinement,
                                resolves_contacts] = all;
  for (std::size_t i = 0; i < all.pulls.size(); ++i) {
    const std::string name = "pull " + std::to_string(i) + " ";
    for (int k = 0; k < 3; ++k) {
      out[name + "force " + std::to_string(k)] = [i, k](Parameters& p) -> double& {
        return p.pulls[i].force[k];
      };
      out[name + "before " + std::to_string(k)] = [i, k](Parameters& p) -> double& {
        return p.pulls[i].before[k];
      };
    }
    out[name + "ramp.since"] = [i](Parameters& p) -> double& { return p.pulls[i].ramp.since; };
    out[name + "ramp.over"] = [i](Parameters& p) -> double& { return p.pulls[i].ramp.over; };
  }
  out["contact_ramp.since"] = [](Parameters& p) -> double& { return p.contact_ramp.since; };
  out["contact_ramp.over"] = [](Parameters& p) -> double& { return p.contact_ramp.over; };
  for (std::size_t b = 0; b < all.damping.size(); ++b)
    out["damping " + std::to_string(b)] = [b](Parameters& p) -> double& { return p.damping[b]; };
  for (int k = 0; k < 3; ++k)
    out["gravity " + std::to_string(k)] = [k](Parameters& p) -> double& { return p.gravity[k]; };
  const auto add = [&](const char* name, double Parameters::*of) {
    out[name] = [of](Parameters& p) -> double& { return p.*of; };
  };
  add("spectral_radius", &Parameters::spectral_radius);
  add("beta", &Parameters::beta);
  add("gamma", &Parameters::gamma);
  add("time_step", &Parameters::time_step);
  add("tolerance", &Parameters::tolerance);
  add("substep_refinement", &Parameters::substep_refinement);
  return out;
}

TEST(Containment, no_bad_number_in_the_parameters_is_stepped_with) {
  for (const Way& way : k_ways) {
    SCOPED_TRACE(way.name);
    const topple::Setup setup = held_tripod(way);
    const State good = after_steps(setup);
    for (const bool passing : {false, true}) {
      Parameters parameters = setup.parameters;
      parameters.pulls = {{.node = 0, .force = Vec3(0.1, 0, 0), .before = Vec3::Zero(), .ramp = {}}};
      if (passing) {
        parameters.contact_ramp = {good.time, 0.1};
        for (Shake& shake : parameters.shakes) shake.ramp = {good.time, 0.1};
      }
      ASSERT_TRUE(stepped(setup, parameters, good).status.ok());
      for (const auto& [name, number] : numbers_of(parameters))
        for (const double bad : k_bad) {
          SCOPED_TRACE(testing::Message() << name << " becomes " << bad);
          Parameters changed = parameters;
          number(changed) = bad;
          State state = good;
          Workspace workspace(setup.model);
          resume(setup.model, state, workspace);
          EXPECT_EQ(step(setup.model, changed, state, workspace).kind, StepStatus::Kind::bad_parameter);
          EXPECT_EQ(hash(state), hash(good));
          EXPECT_EQ(stepped(setup, changed, good).status.kind, StepStatus::Kind::bad_parameter);
        }
    }
  }
}

}  // namespace
}  // namespace topple::test
