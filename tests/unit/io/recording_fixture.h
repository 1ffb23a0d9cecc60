// Rows without a solver, for the tests of recordings.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "solver/io/recording/recording.h"
#include "solver/io/recording/recording_writer.h"
#include "solver/io/scene/scene.h"

namespace topple::io::testing {

/// About a cabinet: 52 nodes, 96 elements.
inline constexpr RowShape k_cabinet{.nodes = 52, .elements = 96, .contacts = 16, .bodies = 1};
inline constexpr RowShape k_small{.nodes = 3, .elements = 2, .contacts = 4, .touched = 2, .bodies = 2};
inline constexpr const char* k_text = "topple = 1\ntitle = \"fake\"\n";

/// A cabinet that tips over within two seconds; a step of 0.7 ms divides neither 1 s nor the row interval.
inline constexpr const char* k_scene = R"(
topple = 1
title = "test"
[run]
duration = "2.3 s"
time_step = "0.7 ms"
output_rate = "60 Hz"
[[shake]]
type = "sine"
frequency = "0.5 Hz"
amplitude = "400 gal"
direction = [1, 0, 0]
[floor]
type = "plane"
width = "90 mm"
[[material]]
name = "steel"
young = "205 GPa"
poisson = 0.3
density = "7850 kg/m^3"
[[section]]
name = "post"
shape = "box"
size = ["30 mm", "30 mm"]
thickness = "1 mm"
[[cabinet]]
name = "cabinet"
size = ["380 mm", "880 mm", "1790 mm"]
mass = "40 kg"
cg_height = "1.05 m"
section = "post"
material = "steel"
)";

/// A model that has one entry of every kind that a recording keeps; its sizes are those of k_small.
inline Model small_model() {
  Model model;
  model.materials = {{"steel", 205e9, 0.3, 7850}};
  model.sections = {
      {.name = "post", .size_y = 0.03, .size_z = 0.03, .area = 1e-4, .iy = 1e-8, .iz = 1e-8, .j = 2e-8}};
  model.node_position = {Vec3(0, 0, 0), Vec3(0, 0, 1), Vec3(1, 0, 0)};
  model.node_mass = {1, 2, 3};
  model.node_inertia = {Mat3::Identity(), Mat3::Identity(), Mat3::Identity()};
  model.node_body = {0, 0, 1};
  const Element element{{0, 1}, 0, 1, 0.5, Mat3::Identity(), Vec3::Ones(), Vec3::Ones()};
  model.elements = {element, element};
  model.members = {{"post-1", 0, 0, 2, 0, 0, {true, true}}};
  Body body{};
  body.name = "shelf, \"blue\"";
  body.node_count = 2;
  body.element_count = 2;
  body.centre_of_gravity = body.base_centre = Vec3::Zero();
  model.bodies = {body, body};
  model.bodies[1].name = "b";
  model.bodies[1].first_node = 2;
  model.bodies[1].node_count = 1;
  model.contact_points = {{0, 0.1}, {1, 0.1}};
  model.planes = {{"floor", Vec3::Zero(), Vec3::UnitZ(), 0.17}, {"wall", Vec3::Zero(), Vec3::UnitX(), 0}};
  return model;
}

/// Of that model, rows 100 a second.
inline topple::Setup small_setup() {
  topple::Setup setup;
  setup.model = small_model();
  return setup;
}

/// The row number `step`: every number differs from every other.
inline FrameRow fake_row(const RowShape& shape, std::int64_t step, double time) {
  FrameRow row = blank_row(shape);
  row.step = step;
  row.time = time;
  double value = 1 + static_cast<double>(step);
  const auto fill = [&value](auto& field) {
    for (auto& number : field) {
      value += 0.37;
      number = static_cast<std::decay_t<decltype(number)>>(std::fmod(value, 200));
    }
  };
  fill(row.position);
  fill(row.rotation);
  fill(row.section_force);
  fill(row.s);
  fill(row.hinge);
  fill(row.contact_depth);
  fill(row.contact_force);
  fill(row.member_contact);
  fill(row.panel_contact);
  fill(row.energy);
  for (BodyNumbers& body : row.body) {
    BodyArray numbers;
    fill(numbers);
    body = std::bit_cast<BodyNumbers>(numbers);
  }
  for (std::size_t b = 0; b < row.level.size(); ++b)
    row.level[b] =
        static_cast<std::uint8_t>((b + static_cast<std::size_t>(step)) % std::size(k_model_levels));
  fill(row.floor_acceleration);
  fill(row.floor_displacement);
  for (AnchorNumbers& anchor : row.anchor) {
    AnchorArray numbers;
    fill(numbers);
    anchor = std::bit_cast<AnchorNumbers>(numbers);
  }
  row.load_factor = value + 0.37;
  return row;
}

inline Checkpoint fake_checkpoint(const RowShape& shape, std::int64_t step, double time) {
  Checkpoint checkpoint{0, step, time, 0xfedcba9876543210u + static_cast<std::uint64_t>(step), {}};
  // what touches differs from state to state, and so does the length
  const std::size_t count = 25 * shape.nodes + static_cast<std::size_t>(step % 7);
  for (std::size_t i = 0; i < count; ++i) checkpoint.state.push_back(std::sin(static_cast<double>(i) + time));
  return checkpoint;
}

inline RecordedEvent fake_event(std::int64_t step, double time) {
  return {0, step, time, Event{Event::Kind::impact, step, time, 1, 2.5}};
}

/// Equal to the last bit, branch, step and time included.
inline bool same(const FrameRow& a, const FrameRow& b) {
  const auto left = field_bytes(a), right = field_bytes(b);
  for (std::size_t i = 0; i < k_field_count; ++i) {
    if (!std::ranges::equal(left[i], right[i])) return false;
  }
  return a.branch == b.branch && a.step == b.step && a.time == b.time;
}

/// Writes over `old` in `bytes`, which holds it once.
inline void replace_bytes(std::string& bytes, std::span<const std::byte> old,
                          std::span<const std::byte> now) {
  const std::string_view pattern(reinterpret_cast<const char*>(old.data()), old.size());
  const std::size_t place = bytes.find(pattern);
  ASSERT_NE(place, std::string::npos);
  ASSERT_EQ(bytes.find(pattern, place + 1), std::string::npos);
  std::copy_n(reinterpret_cast<const char*>(now.data()), now.size(),
              bytes.begin() + static_cast<long>(place));
}

/// Changes the node positions of a frame in the file of a closed recording, its checksums as well.
template <typename Change>
void change_frame(const std::string& file, std::int64_t index, Change change) {
  const FrameRow before = Recording(file).frame(index);
  FrameRow after = before;
  change(after.position);
  const auto record = [](const FrameRow& row) {
    FrameRecord out{.branch = row.branch, .step = row.step, .time = row.time};
    for (const auto& bytes : field_bytes(row)) out.data_checksum = crc32c(bytes, out.data_checksum);
    return sealed(out);
  };
  const FrameRecord old = record(before), now = record(after);
  std::ifstream in(file, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(in), {}};
  replace_bytes(bytes, std::as_bytes(std::span(before.position)), std::as_bytes(std::span(after.position)));
  replace_bytes(bytes, std::as_bytes(std::span(&old, 1)), std::as_bytes(std::span(&now, 1)));
  std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

/// A folder of its own for each test, gone afterwards.
class RecordingTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("topple-recording-" + std::to_string(getpid()));
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::size_t files_in_folder() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder_), {}));
  }
  static std::string bytes_of(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  static void write_bytes(const std::string& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }
  /// A finished recording of `frames` small rows, 100 a second, a checkpoint each second, an event every 10
  /// rows.
  static void record_small(const std::string& file, int frames) {
    RecordingWriter writer(file, "fake", k_text, small_model(), k_small);
    append_small(writer, frames);
    writer.finish("completed", "{\"a\": 1}");
  }
  static void append_small(RecordingWriter& writer, int frames) {
    for (int i = 0; i < frames; ++i) {
      if (i % 100 == 0) writer.append(fake_checkpoint(k_small, i, i * 0.01));
      if (i % 10 == 0) writer.append(fake_event(i, i * 0.01));
      writer.append(fake_row(k_small, i, i * 0.01));
      if (i % 7 == 0) writer.flush();
    }
  }
  /// Reads everything. Throws InputError.
  static void read_all(const Recording& recording) {
    for (std::int64_t i = 0; i < recording.frame_count(); ++i) recording.frame(i);
    for (std::int64_t i = 0; i < recording.checkpoint_count(); ++i) recording.checkpoint(i);
    recording.events();
  }
  /// Text of the InputError that opening and reading `file` gives; empty when it reads well.
  static std::string read_error(const std::string& file) {
    try {
      const Recording recording(file);
      read_all(recording);
      return {};
    } catch (const InputError& error) {
      return error.what();
    }
  }
  /// Runs `work` in a child process, which ends as programs do, by exit(); its exit status, or -signal.
  template <typename Work>
  static int in_child(Work work) {
    const pid_t child = fork();
    if (child == 0) {
      int result = 99;
      try {
        result = work();
      } catch (const std::exception& error) {
        std::fprintf(stderr, "child: %s\n", error.what());
      }
      std::exit(result);
    }
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }

  std::filesystem::path folder_;
};

}  // namespace topple::io::testing
