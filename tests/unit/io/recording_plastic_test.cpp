// Recordings of runs in which steel flows and breaks.
#include <sstream>

#include "recording_fixture.h"
#include "solver/plasticity.h"

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
      if (observation.frame) see(run);
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
    ASSERT_EQ(e.size(), 10u);
    EXPECT_EQ(e[8], ledger[i].plastic) << i;
    const double dissipated = e[5] + e[6] + e[7] + e[8];
    EXPECT_NEAR(std::abs(e[1] + e[2] + e[3] + e[4] + dissipated - e[0] - ledger[i].start_total),
                e[9] * ledger[i].largest, 1e-12 * (1 + ledger[i].largest))
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
            "plastic_J,balance_error");
  while (std::getline(text, line)) newest = line;
  std::vector<double> values;
  std::istringstream fields(newest);
  for (std::string field; std::getline(fields, field, ',');)
    values.push_back(std::strtod(field.c_str(), nullptr));
  EXPECT_EQ(values, (std::vector<double>{state.time, last.input, last.kinetic, last.strain, last.gravity,
                                         last.contact, last.friction, last.normal_damping, last.numerical,
                                         last.plastic, last.balance_error()}));
}

}  // namespace
}  // namespace topple::io::testing
