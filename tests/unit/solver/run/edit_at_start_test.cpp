// Edits before the first step.
#include <gtest/gtest.h>

#include <string>

#include "solver/body/model_level.h"
#include "solver/model/excitation.h"
#include "solver/reduced/elastic_basis.h"
#include "solver/run/edit.h"
#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

/// A shaken run of each kind of start: settled frames, an elastic body, a sweep, statics.
struct Start {
  const char* name;
  topple::Setup setup;
};
std::vector<Start> starts() {
  topple::Setup settled = shaken(1);
  shake(settled, 3, 2);
  topple::Setup elastic = settled;
  elastic.model.bodies[0].elastic = elastic_basis(elastic.model, 0);
  elastic.parameters.models = {BodyModel::elastic};
  topple::Setup delayed = settled;
  delayed.parameters.shakes[0].start = 0.05;
  topple::Setup jump = settled;
  jump.parameters.shakes[0].initial_velocity = Shake::Start::jump;
  topple::Setup sweep = settled;
  sweep.parameters.shakes[0].kind = Shake::Kind::sweep;
  sweep.parameters.shakes[0].last_frequency = 8;
  topple::Setup statics = shaken(1);
  statics.run.analysis = Analysis::statics;
  statics.model.loads.push_back({statics.model.bodies[0].node_count - 1, Vec3(20, 0, 0), Vec3::Zero(), {}});
  return {{"settled", settled}, {"elastic", elastic}, {"delayed", delayed},
          {"jump", jump},       {"sweep", sweep},     {"statics", statics}};
}

void expect_alike(topple::Run a, topple::Run b, const std::string& what) {
  for (int i = 0; i < 100; ++i) {
    ASSERT_EQ(hash(a.state()), hash(b.state())) << what << ", step " << i;
    ASSERT_EQ(a.sections().size(), b.sections().size()) << what;
    ASSERT_EQ(a.contacts().size(), b.contacts().size()) << what;
    ASSERT_EQ(a.events().size(), b.events().size()) << what;
    if (a.over()) break;
    ASSERT_EQ(a.advance().ok(), b.advance().ok()) << what;
  }
}

TEST(EditAtTheStart, is_what_the_setup_could_have_said) {
  using K = Edit::Key;
  const std::pair<Edit, void (*)(Parameters&)> cases[] = {
      {set(K::alpha, 1000 * k_g), [](Parameters& p) { p.contact.alpha = 1000 * k_g; }},
      {set(K::q, 2), [](Parameters& p) { p.contact.q = 2; }},
      {set(K::friction, 0.2), [](Parameters& p) { p.contact.friction = 0.2; }},
      {set(K::restitution, 0.5), [](Parameters& p) { p.contact.restitution = 0.5; }},
      {set(K::law, static_cast<int>(ContactLawKind::paper)),
       [](Parameters& p) { p.contact.kind = ContactLawKind::paper; }},
      {set(K::want, 0), [](Parameters& p) { p.want_stress = false; }},
      {set(K::time_step, 4e-4), [](Parameters& p) { p.time_step = 4e-4; }}};
  const std::pair<Edit, void (*)(Shake&)> shaken_cases[] = {
      {set(K::amplitude, 5), [](Shake& s) { s.amplitude = 5; }},
      {set(K::on, 0), [](Shake& s) { s.on = false; }},
      {turn_to({0, 1, 0}), [](Shake& s) { s.direction = Vec3::UnitY(); }},
      {{.key = K::frequency, .value = Vec3(3, 9, 0)},
       [](Shake& s) {
         s.frequency = 3;
         if (traits(s.kind).sweeps) s.last_frequency = 9;
       }},
      {set(K::type, static_cast<int>(Shake::Kind::pulse)), [](Shake& s) {
         if (!traits(s.kind).has_duration) s.duration = 0.5 / s.frequency;
         s.kind = Shake::Kind::pulse;
       }}};
  for (const Start& start : starts()) {
    const auto expect_said = [&](const Edit& edit, const topple::Setup& said) {
      topple::Run edited(start.setup);
      ASSERT_TRUE(edited.status().ok()) << start.name;
      edited.edit(edit);
      expect_alike(std::move(edited), topple::Run(said),
                   start.name + std::to_string(static_cast<int>(edit.key)));
    };
    for (const auto& [edit, say] : cases) {
      topple::Setup said = start.setup;
      say(said.parameters);
      expect_said(edit, said);
    }
    if (start.setup.parameters.shakes.empty()) continue;
    for (const auto& [edit, say] : shaken_cases) {
      topple::Setup said = start.setup;
      say(said.parameters.shakes[0]);
      expect_said(edit, said);
    }
  }
}

TEST(EditAtTheStart, is_taken_back_bit_for_bit) {
  for (const Start& start : starts()) {
    topple::Run run(start.setup);
    const Parameters& p = start.setup.parameters;
    std::vector<Edit> back;
    const auto change = [&](const Edit& edit) {
      back.push_back({edit.key, edit.index, edited_value(run.parameters(), edit.key, edit.index)});
      run.edit(edit);
    };
    change(set(Edit::Key::alpha, 1000 * k_g));
    change(set(Edit::Key::want, 0));
    if (!p.shakes.empty()) change(set(Edit::Key::type, 2 - static_cast<int>(p.shakes[0].kind)));
    for (auto edit = back.rbegin(); edit != back.rend(); ++edit) run.edit(*edit);
    expect_alike(std::move(run), topple::Run(start.setup), start.name);
  }
}

TEST(EditAtTheStart, that_does_not_settle_says_so_and_may_be_taken_back) {
  const topple::Setup setup = shaken(1);
  topple::Run run(setup);
  run.edit(set(Edit::Key::alpha, 1e-3));
  EXPECT_EQ(run.status().kind, StepStatus::Kind::not_settled);
  EXPECT_TRUE(run.over());
  EXPECT_EQ(hash(run.state()), hash(topple::Run(setup).state()));  // the one before
  run.edit(set(Edit::Key::alpha, setup.parameters.contact.alpha));
  expect_alike(std::move(run), topple::Run(setup), "taken back");
}

}  // namespace
}  // namespace topple::test
