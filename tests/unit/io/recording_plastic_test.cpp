// Recordings of runs in which steel flows and breaks.
#include <sstream>

#include "recording_fixture.h"
#include "solver/element/plasticity.h"
#include "solver/io/export/export_csv.h"

namespace topple::io::testing {
namespace {

/// Two posts clamped at one end: the load bends one past yield and lets go of it, the other breaks.
constexpr const char* k_strong = R"(
topple = 1
title = "One bends, one breaks"
[run]
duration = "0.3 s"
settle = false
gravity = [0, 0, 0]
output_rate = "1000 Hz"
[[material]]
name = "tough"
young = "205 GPa"
poisson = 0.3
density = "7850 kg/m^3"
yield = "235 MPa"
[[material]]
name = "brittle"
young = "205 GPa"
poisson = 0.3
density = "7850 kg/m^3"
yield = "235 MPa"
fracture_strain = 0.002
[[section]]
name = "post"
shape = "box"
size = ["30 mm", "30 mm"]
thickness = "1 mm"
[[frame]]
name = "bends"
nodes = [[0, 0, 0], [1, 0, 0]]
members = [{ nodes = [0, 1], section = "post", material = "tough" }]
supports = [{ node = 0, fix = "xyzXYZ" }]
masses = [{ node = 1, mass = "5 kg" }]
loads = [{ node = 1, force = [0, 0, "-400 N"], history = [["0 s", 0], ["0.08 s", 1], ["0.12 s", 0]] }]
[[frame]]
name = "breaks"
nodes = [[0, 1, 0], [1, 1, 0]]
members = [{ nodes = [0, 1], section = "post", material = "brittle" }]
supports = [{ node = 0, fix = "xyzXYZ" }]
masses = [{ node = 1, mass = "5 kg" }]
loads = [{ node = 1, force = [0, 0, "-400 N"], history = [["0 s", 0], ["0.08 s", 1], ["0.12 s", 0]] }]
)";

class PlasticRecordingTest : public RecordingTest {
 protected:
  /// Records a run of k_strong and calls `see` at each recorded instant.
  template <typename See>
  void record(See see) {
    topple::Run run(scene_.setup);
    Recorder recorder(path("a.h5"), scene_.name, scene_.text, scene_.setup.model);
    Observer observer;
    const auto write = [&](const Observation& observation) {
      if (!observation.frames.empty()) see(run);
      recorder.write(observation);
    };
    write(observer.observe(run));
    while (!run.over()) {
      const StepStatus status = run.advance();
      ASSERT_TRUE(status.ok()) << status.message(scene_.setup.model);
      write(observer.observe(run));
    }
    write(observer.last(run));
    recorder.finish("completed", "{}");
    events_ = run.events();
    outcome_ = run.outcome().bodies();
  }
  const Scene scene_ = parse_scene(k_strong, "test");
  std::vector<Event> events_;
  std::vector<BodyOutcome> outcome_;
};

TEST_F(PlasticRecordingTest, plastic_energy_is_a_column_and_the_ledger_adds_up_row_by_row) {
  std::vector<EnergyLedger> ledger;
  record([&](const topple::Run& run) { ledger.push_back(run.state().energy); });
  const Recording recording(path("a.h5"));
  ASSERT_EQ(recording.frame_count(), static_cast<std::int64_t>(ledger.size()));
  double before = 0;
  for (std::size_t i = 0; i < ledger.size(); ++i) {
    const std::vector<double> e = recording.frame(static_cast<std::int64_t>(i)).energy;
    ASSERT_EQ(e.size(), 12u);
    EXPECT_EQ(e[8], ledger[i].plastic) << i;
    const double dissipated = e[5] + e[6] + e[7] + e[8] + e[9];
    EXPECT_EQ(e[10], 0) << i;
    EXPECT_NEAR(std::abs(e[1] + e[2] + e[3] + e[4] + dissipated - e[0] - ledger[i].start_total),
                e[11] * ledger[i].largest, 1e-12 * (1 + ledger[i].largest))
        << i;
    EXPECT_GE(e[8], before - 1e-12) << i;
    before = e[8];
  }
  EXPECT_GT(before, 0.1);
}

TEST_F(PlasticRecordingTest, energies_are_exported_with_their_names) {
  State state;
  record([&](const topple::Run& run) { state = run.state(); });
  const EnergyLedger& last = state.energy;
  export_csv(Recording(path("a.h5")), path("csv"));
  std::istringstream text(bytes_of(path("csv/energy.csv")));
  std::string line, newest;
  std::getline(text, line);
  EXPECT_EQ(line,
            "time_s,input_J,kinetic_J,strain_J,gravity_J,contact_J,friction_J,normal_damping_J,numerical_J,"
            "plastic_J,damping_J,model_switch_J,balance_error");
  while (std::getline(text, line)) newest = line;
  std::vector<double> values;
  std::istringstream fields(newest);
  for (std::string field; std::getline(fields, field, ',');)
    values.push_back(std::strtod(field.c_str(), nullptr));
  EXPECT_NEAR(values[0], state.time, 1e-12);  // a sum of steps; a multiple of the output interval
  values[0] = state.time;
  EXPECT_EQ(values,
            (std::vector<double>{state.time, last.input, last.kinetic, last.strain, last.gravity,
                                 last.contact, last.friction, last.normal_damping, last.numerical,
                                 last.plastic, last.damping, last.model_switch, last.balance_error()}));
}

TEST_F(PlasticRecordingTest, hinge_and_fracture_events_come_back_and_are_those_that_the_outcome_counts) {
  record([](const topple::Run&) {});
  const std::vector<RecordedEvent> read = Recording(path("a.h5")).events();
  ASSERT_EQ(read.size(), events_.size());
  const Model& model = scene_.setup.model;
  std::vector<int> hinges(model.bodies.size()), fractures(model.bodies.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    const Event &back = read[i].event, &sent = events_[i];
    EXPECT_EQ(back.kind, sent.kind);
    EXPECT_EQ(read[i].step, sent.step);
    EXPECT_EQ(read[i].time, sent.time);
    EXPECT_EQ(back.body, sent.body);
    EXPECT_EQ(back.value, sent.value);
    EXPECT_EQ(back.element, sent.element);
    if (back.kind != Event::Kind::hinge && back.kind != Event::Kind::fracture) continue;
    const Element& element = model.elements.at(static_cast<std::size_t>(back.element));
    EXPECT_EQ(model.members.at(static_cast<std::size_t>(element.member)).body, back.body);
    EXPECT_EQ(back.value == static_cast<double>(Hinge::broken), back.kind == Event::Kind::fracture);
    ++(back.kind == Event::Kind::hinge ? hinges : fractures).at(static_cast<std::size_t>(back.body));
  }
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    EXPECT_EQ(hinges[b], outcome_[b].hinges) << model.bodies[b].name;
    EXPECT_EQ(fractures[b], outcome_[b].fractures) << model.bodies[b].name;
    EXPECT_GT(hinges[b], 0) << model.bodies[b].name;
  }
  EXPECT_EQ(fractures, (std::vector<int>{0, 1}));  // "bends", "breaks"
}

TEST_F(PlasticRecordingTest, element_tables_are_those_of_the_solver) {
  struct Expected {
    double time, yield_ratio, s;
    int hinge;
  };
  std::vector<Expected> expected;
  const Model& model = scene_.setup.model;
  record([&](const topple::Run& run) {
    for (std::size_t e = 0; e < model.elements.size(); ++e) {
      const Element& element = model.elements[e];
      const ElementState& state = run.state().elements[e];
      double f = -1;
      for (const double end : {-1., 1.})
        f = std::max(
            f, yield_function(element, forces_along(run.sections()[e], element.length, element.s, end)));
      const bool flowed = !state.offset.kappa.isZero(0) || !state.offset.gamma.isZero(0);
      int hinge = static_cast<int>(state.hinge);
      if (state.hinge == Hinge::none && flowed) hinge = k_flowed_first;  // clamped at the first end
      const double s = state.hinge == Hinge::first ? 1 : state.hinge == Hinge::second ? -1 : element.s;
      expected.push_back({run.state().time, std::sqrt(f + 1), s, hinge});
    }
  });
  export_csv(Recording(path("a.h5")), path("csv"));
  std::istringstream text(bytes_of(path("csv/elements.csv")));
  std::string line;
  std::getline(text, line);
  std::size_t row = 0;
  std::vector<int> seen(7);
  for (; std::getline(text, line); ++row) {
    ASSERT_LT(row, expected.size());
    std::vector<std::string> fields;
    std::istringstream parts(line);
    for (std::string field; std::getline(parts, field, ',');) fields.push_back(field);
    ASSERT_EQ(fields.size(), 15u) << line;
    const Expected& e = expected[row];
    EXPECT_NEAR(std::stod(fields[0]), e.time, 1e-12);
    // from section forces in single precision, taken along the element
    EXPECT_NEAR(std::stod(fields[11]), e.yield_ratio, 1e-5 * (1e-2 + e.yield_ratio)) << line;
    EXPECT_EQ(std::stof(fields[12]), static_cast<float>(e.s)) << line;
    EXPECT_EQ(std::stoi(fields[13]), e.hinge) << line;
    ++seen.at(static_cast<std::size_t>(e.hinge));
  }
  EXPECT_EQ(row, expected.size());
  for (const int code : {0, 1, 3, 5}) EXPECT_GT(seen[static_cast<std::size_t>(code)], 0) << code;
}

}  // namespace
}  // namespace topple::io::testing
