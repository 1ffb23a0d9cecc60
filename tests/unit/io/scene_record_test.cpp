// Sweeps and records of a scene, and the built-in records.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <complex>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>

#include "scene_samples.h"
#include "solver/model/accelerogram.h"
#include "solver/model/excitation.h"

namespace topple::io {
namespace {

namespace fs = std::filesystem;

/// Files as a scene names them.
using Files = std::map<std::string, std::string>;

ReadSceneFile reader(const Files& files) {
  return [files](const std::string& name) {
    const auto file = files.find(name);
    if (file == files.end()) throw InputError(name + ": no such file");
    return file->second;
  };
}

const Files k_files{
    {"ns.AT2", "one\ntwo\nUNITS OF G\nNPTS= 4, DT= .5 SEC\n.1 .2 .3 .4\n"},
    {"ew.AT2", "one\ntwo\nUNITS OF G\nNPTS= 8, DT= .25 SEC\n.1 .2 .3 .4 .5 .6 .7 .8\n"},
    {"long.AT2", "one\ntwo\nUNITS OF G\nNPTS= 9, DT= .25 SEC\n.1 .2 .3 .4 .5 .6 .7 .8 .9\n"},
    {"two.csv", "time_s,ax_gal,ay_gal\n0,1,2\n0.5,3,4\n1,8,12\n1.5,0,0\n"},
    {"plain.csv", "ax\n1\n2\n5\n10\n17\n"},
    {"bad.csv", "time_s,ax_gal\n0,1\n1,x\n"},
};

Scene scene_of(const std::string& lines, const Files& files = k_files) {
  return parse_scene(k_scene + "[[shake]]\ntype = \"record\"\n" + lines, "s.toml", {}, reader(files));
}

std::string record_error(const std::string& lines) {
  try {
    scene_of(lines);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

const Accelerogram& record_of(const Scene& scene) {
  return *scene.setup.parameters.shakes.at(0).record;
}

TEST(SceneRecord, components_lie_along_x_y_z_unless_the_scene_says_otherwise) {
  const Scene scene = scene_of("files = [\"ns.AT2\", \"two.csv\"]\n");
  const Shake& shake = scene.setup.parameters.shakes.at(0);
  EXPECT_EQ(shake.kind, Shake::Kind::record);
  EXPECT_EQ(shake.scale, 1);
  EXPECT_EQ(shake.start, 0);
  ASSERT_EQ(record_of(scene).components.size(), 3u);
  for (int k = 0; k < 3; ++k)
    EXPECT_EQ(record_of(scene).components[static_cast<std::size_t>(k)].direction, Vec3::Unit(k));
  EXPECT_LT((shake_acceleration(shake, 0.5) - Vec3(0.2 * k_standard_gravity, 0.03, 0.04)).norm(), 1e-14);

  const Scene turned =
      scene_of("files = [\"two.csv\"]\ndirections = [[0, 3, 4], [-2, 0, 0]]\nscale = -2\nstart = 3\n");
  EXPECT_LT(
      (shake_acceleration(turned.setup.parameters.shakes.at(0), 4) + 2 * Vec3(-0.12, 0.048, 0.064)).norm(),
      1e-14);
}

TEST(SceneRecord, sample_times_may_differ_and_lengths_not) {
  const Scene scene = scene_of("files = [\"ns.AT2\", \"ew.AT2\"]\n");
  EXPECT_EQ(record_of(scene).components[0].interval, 0.5);
  EXPECT_EQ(record_of(scene).components[1].interval, 0.25);
  EXPECT_EQ(
      record_error("files = [\"ns.AT2\", \"long.AT2\"]\n"),
      "s.toml:19:20: shake.1.files.2: long.AT2 lasts 2.25 s (9 samples every 0.25 s), ns.AT2 2 s (4 samples "
      "every 0.5 s); the components of a record are equally long");
}

TEST(SceneRecord, keeps_the_bytes_of_every_file_once) {
  const Scene scene = scene_of(
      "files = [\"ns.AT2\", \"ns.AT2\"]\n[[shake]]\ntype = \"record\"\nfiles = [\"two.csv\", "
      "\"ns.AT2\"]\n");
  ASSERT_EQ(scene.files.size(), 2u);
  EXPECT_EQ(scene.files[0].name, "ns.AT2");
  EXPECT_EQ(scene.files[1].name, "two.csv");
  for (const SceneFile& file : scene.files) EXPECT_EQ(file.bytes, k_files.at(file.name));
  EXPECT_TRUE(parse_scene(k_scene, "s.toml").files.empty());
}

TEST(SceneRecord, mean_and_baseline_are_corrected_where_asked) {
  const auto samples = [](const std::string& keys) {
    return record_of(scene_of("files = [\"plain.csv\"]\nunit = \"m/s^2\"\ndt = 0.5\n" + keys))
        .components[0]
        .samples;
  };
  EXPECT_EQ(samples(""), (std::vector<double>{1, 2, 5, 10, 17}));
  EXPECT_EQ(samples("mean = \"kept\"\nbaseline = \"none\"\n"), (std::vector<double>{1, 2, 5, 10, 17}));
  EXPECT_EQ(samples("mean = \"removed\"\n"), (std::vector<double>{-6, -5, -2, 3, 10}));
  // they are a parabola
  for (const double a : samples("baseline = \"parabola\"\n")) EXPECT_NEAR(a, 0, 1e-12);
}

TEST(SceneRecord, errors_name_the_scene_the_key_the_file_and_its_line) {
  EXPECT_EQ(record_error("files = [\"ns.AT2\", \"bad.csv\"]\n"),
            "s.toml:19:20: shake.1.files.2: bad.csv:3: column 2: \"x\" is not a number");
  EXPECT_EQ(record_error("files = [\"no.AT2\"]\n"), "s.toml:19:10: shake.1.files.1: no.AT2: no such file");
  EXPECT_EQ(record_error("name = \"quake\"\nfiles = [\"plain.csv\"]\ndt = 1\n").substr(0, 49),
            "s.toml:20:10: shake.quake.files.1: plain.csv:1: c");
  EXPECT_EQ(record_error(""),
            "s.toml:17:1: shake.1.files: missing; type = \"record\" needs it (accelerograms: PEER "
            "AT2, K-NET or KiK-net ASCII, CSV, one to three components "
            "together, equally long; paths from the folder of the scene, or a built-in record)");
  EXPECT_EQ(record_error("files = []\n"),
            "s.toml:19:9: shake.1.files: expected a list of 1 to 3 values, found 0");
  EXPECT_EQ(record_error("files = \"ns.AT2\"\n"),
            "s.toml:19:9: shake.1.files: expected a list of 1 to 3 values, found \"ns.AT2\"");
  EXPECT_EQ(record_error("files = [3]\n"), "s.toml:19:10: shake.1.files.1: expected text, found 3");
  EXPECT_EQ(record_error("files = [\"two.csv\", \"two.csv\"]\n"),
            "s.toml:19:9: shake.1.files: hold 4 components, a record has at most 3");
  EXPECT_EQ(record_error("files = [\"two.csv\"]\ndirections = [[1, 0, 0]]\n"),
            "s.toml:20:14: shake.1.directions: found 1, the files hold 2 components");
  EXPECT_EQ(record_error("files = [\"ns.AT2\"]\ndirections = [[0, 0, 0]]\n"),
            "s.toml:20:15: shake.1.directions.1: a zero vector has no direction");
  EXPECT_EQ(record_error("files = [\"ns.AT2\"]\namplitude = 1\n"),
            "s.toml:20:1: shake.1.amplitude: belongs to type = sine or sweep or pulse, but type is record");
  EXPECT_EQ(record_error("files = [\"ns.AT2\"]\nunit = \"feet\"\n"),
            "s.toml:20:8: shake.1.unit: \"feet\" is not one of g, gal, m/s^2, cm/s^2");
  EXPECT_EQ(error_of(k_scene + "[[shake]]\nfrequency = 1\namplitude = 1\nscale = 2\n"),
            "s.toml:20:1: shake.1.scale: belongs to type = record, but type is sine");
}

TEST(SceneRecord, the_mean_of_a_knet_file_cannot_be_kept) {
  std::string knet(builtin_records().at(1).text);
  const Files files{{"a.EW", knet}};
  EXPECT_NO_THROW(scene_of("files = [\"a.EW\"]\n", files));
  EXPECT_NO_THROW(scene_of("files = [\"a.EW\"]\nmean = \"removed\"\n", files));
  EXPECT_THROW(scene_of("files = [\"a.EW\"]\nmean = \"kept\"\n", files), InputError);
}

/// A folder of its own, gone afterwards.
class SceneFolder : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("topple-scene-record-" + std::to_string(getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "records");
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string error_with(const std::string& name) {
    std::ofstream(folder_ / "s.toml")
        << k_scene + "[[shake]]\ntype = \"record\"\nfiles = [\"" + name + "\"]\n";
    try {
      load_scene((folder_ / "s.toml").string());
    } catch (const InputError& error) {
      std::string line = error.what();
      for (auto at = line.find(folder_.string()); at != std::string::npos; at = line.find(folder_.string()))
        line.replace(at, folder_.string().size() + 1, "");
      return line;
    }
    return "no error";
  }
  fs::path folder_;
};

TEST_F(SceneFolder, paths_start_at_the_folder_of_the_scene) {
  std::ofstream(folder_ / "records/ns.AT2") << k_files.at("ns.AT2");
  EXPECT_EQ(error_with("records/ns.AT2"), "no error");
  EXPECT_EQ(error_with((folder_ / "records/ns.AT2").string()), "no error");
  EXPECT_EQ(error_with("ns.AT2"),
            "s.toml:19:10: shake.1.files.1: ns.AT2: no such file; built-in records: "
            "long-period-x.AT2, long-period-y.EW, near-fault.csv");
  EXPECT_EQ(error_with("records"), "s.toml:19:10: shake.1.files.1: records: is a folder");
  EXPECT_EQ(error_with("/dev/null"), "s.toml:19:10: shake.1.files.1: /dev/null: is not a regular file");
}

TEST_F(SceneFolder, a_file_wins_over_a_built_in_record) {
  EXPECT_EQ(error_with("near-fault.csv"), "no error");
  std::ofstream(folder_ / "near-fault.csv") << "time_s,ax_gal\n";
  EXPECT_EQ(error_with("near-fault.csv"),
            "s.toml:19:10: shake.1.files.1: near-fault.csv:1: found 0 samples below it, expected 2 or more");
}

TEST_F(SceneFolder, the_generator_makes_the_built_in_records_byte_for_byte) {
  ASSERT_EQ(std::system((std::string(TOPPLE_MAKE_RECORDS) + " " + folder_.string()).c_str()), 0);
  ASSERT_EQ(builtin_records().size(), 3u);
  for (const BuiltinScene& record : builtin_records()) {
    const auto bytes_of = [&](const fs::path& file) {
      std::ifstream in(file / record.name, std::ios::binary);
      return std::string(std::istreambuf_iterator<char>(in), {});
    };
    EXPECT_EQ(bytes_of(folder_), record.text) << record.name;
    EXPECT_EQ(bytes_of(TOPPLE_SOURCE_DIR "/assets/records"), record.text) << record.name;
    EXPECT_LE(record.text.size(), 200000u);
  }
}

/// Size of the Fourier transform at a frequency.
double spectrum(const AccelerogramComponent& component, double frequency) {
  std::complex<double> sum = 0;
  for (std::size_t i = 0; i < component.samples.size(); ++i)
    sum += component.samples[i] *
           std::polar(1., -2 * k_pi * frequency * component.interval * static_cast<double>(i));
  return std::abs(sum) * component.interval;
}

TEST(BuiltinRecords, the_long_period_floor_sways_in_the_modes_of_its_building) {
  const Scene scene = load_scene("floor-long-period");
  const Accelerogram& record = record_of(scene);
  ASSERT_EQ(record.components.size(), 2u);
  const double frequency[] = {0.28, 0.36}, peak[] = {230, 140}, rate[] = {50, 100};
  for (std::size_t k = 0; k < 2; ++k) {
    SCOPED_TRACE(k);
    const AccelerogramComponent& component = record.components[k];
    EXPECT_DOUBLE_EQ(component.interval, 1 / rate[k]);
    EXPECT_EQ(component.samples.size(), 60 * rate[k]);
    double largest = 0;
    for (const double a : component.samples) largest = std::max(largest, std::abs(a));
    // the file rounds to a count or seven digits
    EXPECT_NEAR(largest, peak[k] * k_gal, 1e-3 * k_gal);
    double strongest = 0, at = 0;
    for (double f = 0.05; f < 3; f += 0.005)
      if (const double size = spectrum(component, f); size > strongest) {
        strongest = size;
        at = f;
      }
    // half-power width of 2 % damping, and the resolution of a minute
    EXPECT_NEAR(at, frequency[k], 2 * 0.02 * frequency[k] + 1. / 60);
    EXPECT_LT(spectrum(component, 2), strongest / 100);
  }
}

TEST(BuiltinRecords, the_near_fault_pulse_has_its_velocity_and_ends_at_rest) {
  const Scene scene = load_scene("near-fault");
  const AccelerogramComponent& pulse = record_of(scene).components.at(0);
  double v = 0, x = 0, fastest = 0;
  for (std::size_t i = 1; i < pulse.samples.size(); ++i) {
    const double before = v, t = static_cast<double>(i) * 0.01 - 4;
    v += 0.005 * (pulse.samples[i - 1] + pulse.samples[i]);
    x += 0.005 * (before + v);
    fastest = std::max(fastest, std::abs(v));
    // the velocity that the paper gives; the trapezoidal rule adds (w h)^2/12 of it, the file rounds to 0.001
    // gal
    const double exact = std::abs(t) <= 1 / 0.6 ? 0.45 * (1 + std::cos(2 * k_pi * 0.3 * t)) *
                                                      std::cos(2 * k_pi * 0.6 * t + k_pi / 2)
                                                : 0;
    ASSERT_NEAR(v, exact, 5e-4) << t;
  }
  EXPECT_NEAR(v, 0, 1e-4);
  EXPECT_NEAR(x, 0, 1e-3);
  EXPECT_GT(fastest, 0.7);
}

TEST(BuiltinRecords, are_found_from_any_folder) {
  for (const char* name : {"floor-long-period", "near-fault"}) {
    const Scene scene = load_scene(name);
    EXPECT_FALSE(scene.files.empty());
    EXPECT_NE(std::string(scene.text).find("synthetic"), std::string::npos);
  }
}

TEST(SceneSweep, goes_from_its_first_frequency_to_its_last) {
  const auto sweep = [](const std::string& lines) {
    return k_scene + "[[shake]]\ntype = \"sweep\"\namplitude = 2\n" + lines;
  };
  const std::string length = "duration = \"30 s\"\n";
  const Scene scene =
      parse_scene(sweep("frequency = [\"0.2 Hz\", 5]\ntaper = 1.5\nstart = 4\n" + length), "s.toml");
  const Shake& shake = scene.setup.parameters.shakes.at(0);
  EXPECT_EQ(shake.kind, Shake::Kind::sweep);
  EXPECT_EQ(shake.amplitude, 2);
  EXPECT_EQ(shake.taper, 1.5);
  EXPECT_EQ(shake_frequency(shake, 4), 0.2);
  EXPECT_NEAR(shake_frequency(shake, 19), 1, 1e-12);
  EXPECT_NEAR(shake_frequency(shake, 34), 5, 1e-12);
  EXPECT_EQ(error_of(sweep("frequency = 2\n" + length)),
            "s.toml:20:13: shake.1.frequency: expected [first, last], the frequencies of a sweep");
  EXPECT_EQ(error_of(sweep("frequency = [2, 2]\n" + length)),
            "s.toml:20:13: shake.1.frequency: does not change; write type = \"sine\"");
  EXPECT_EQ(error_of(sweep("frequency = [1, 2, 3]\n" + length)),
            "s.toml:20:13: shake.1.frequency: expected a list of 1 to 2 values, found 3");
  EXPECT_EQ(
      error_of(sweep("frequency = [1, 2]\n")),
      "s.toml:17:1: shake.1.duration: missing; type = \"sweep\" needs it (length of the pulse or sweep)");
  EXPECT_EQ(error_of(sweep("frequency = [1, 2]\ncycles = 3\n" + length)),
            "s.toml:21:1: shake.1.cycles: belongs to type = sine, but type is sweep");
  EXPECT_EQ(error_of(sweep("frequency = [1, 2]\ntaper = 30\n" + length)),
            "s.toml:21:9: shake.1.taper: rise and fall together are longer than the cycles");
  EXPECT_EQ(error_of(k_scene + "[[shake]]\nfrequency = [1, 2]\namplitude = 1\n"),
            "s.toml:18:13: shake.1.frequency: a sine has one; a sweep goes from one to another");
}

}  // namespace
}  // namespace topple::io
