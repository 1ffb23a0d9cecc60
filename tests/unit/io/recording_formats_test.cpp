// The recordings kept in tests/recordings: one of each format, written by the program of its time.
#include <cstring>
#include <tuple>

#include "recording_fixture.h"
#include "solver/io/export/exported_values.h"
#include "solver/io/recording/recover.h"
#include "solver/io/recording/rerun.h"
#include "solver/math/elementary.h"

namespace topple::io::testing {
namespace {

const std::string k_folder = TOPPLE_SOURCE_DIR "/tests/recordings/";

struct Kept {
  const char* name;
  std::int32_t format;
  const char* arithmetic;
  bool repeats = false;  // to the last bit: its arithmetic is this one, or its scene has nothing that differs
};
void PrintTo(const Kept& kept, std::ostream* to) {
  *to << kept.name;
}

class KeptRecordingTest : public RecordingTest, public ::testing::WithParamInterface<Kept> {
 protected:
  static std::string kept() { return k_folder + GetParam().name + ".h5"; }
  const Format& format() const { return formats().at(static_cast<std::size_t>(GetParam().format - 1)); }
  /// A copy in which bit 4 of the first byte behind `pattern` is another.
  std::string changed(std::span<const std::byte> pattern) {
    std::string bytes = bytes_of(kept());
    const auto place = bytes.find({reinterpret_cast<const char*>(pattern.data()), pattern.size()});
    EXPECT_NE(place, std::string::npos);
    bytes[place] = static_cast<char>(bytes[place] ^ 0x10);
    write_bytes(path("changed.h5"), bytes);
    return path("changed.h5");
  }
};

TEST_P(KeptRecordingTest, opens_with_all_its_rows_and_the_hashes_of_its_states) {
  const Recording recording(kept());
  EXPECT_EQ(recording.format(), GetParam().format);
  EXPECT_EQ(recording.arithmetic(), GetParam().arithmetic);
  EXPECT_EQ(recording.status(), "completed");
  EXPECT_FALSE(recording.summary_json().empty());
  EXPECT_EQ(recording.frame_count(), 7);
  ASSERT_EQ(recording.checkpoint_count(), 2);
  for (std::int64_t i = 0; i < 2; ++i) {
    const Checkpoint checkpoint = recording.checkpoint(i);
    EXPECT_EQ(hash(std::span(checkpoint.state)), checkpoint.hash);
  }
  EXPECT_TRUE(recording.events().empty());
}

TEST_P(KeptRecordingTest, tells_the_motion_and_energies_that_its_scene_has_now) {
  const Recording recording(kept());
  const Scene scene = recorded_scene(recording);
  topple::Run run(scene.setup);
  for (std::int64_t i = 0; i < recording.frame_count(); ++i) {
    const FrameRow row = recording.frame(i);
    while (run.step() < row.step) ASSERT_TRUE(run.advance().ok());
    FrameRow now = frame_row(run);
    recording.leave_out_unrecorded(now);
    expect_same_model(scene.setup.model, row);
    for (const auto& [then, again, scale] :
         {std::tuple(row.position, now.position, 1.f), std::tuple(row.rotation, now.rotation, 1.f),
          std::tuple(row.section_force, now.section_force, 100.f),
          std::tuple(row.member_contact, now.member_contact, 100.f)}) {
      ASSERT_EQ(then.size(), again.size());
      for (std::size_t k = 0; k < then.size(); ++k) EXPECT_NEAR(then[k], again[k], 1e-3f * scale) << k;
    }
    ASSERT_EQ(row.energy.size(), now.energy.size());
    for (std::size_t k = 0; k < 11; ++k) EXPECT_NEAR(row.energy[k], now.energy[k], 0.01) << i << ' ' << k;
    EXPECT_EQ(row.load_factor, now.load_factor);
    EXPECT_EQ(row.level, now.level);
  }
}

TEST_P(KeptRecordingTest, shows_a_changed_bit_of_its_frames_and_states_as_damage) {
  const Recording recording(kept());
  const auto position = recording.frame(4).position;
  EXPECT_NE(read_error(changed(std::as_bytes(std::span(position)))).find("frame 4 is damaged"),
            std::string::npos);
  const auto state = recording.checkpoint(1).state;
  EXPECT_NE(read_error(changed(std::as_bytes(std::span(state)))).find("checkpoint 1 is damaged"),
            std::string::npos);
}

TEST_P(KeptRecordingTest, repeats_or_parts_undamaged_by_the_arithmetic_that_wrote_it) {
  const Rerun again = rerun(Recording(kept()), [](std::int64_t) {});
  EXPECT_TRUE(again.damage.empty());
  EXPECT_EQ(again.differences.empty(), GetParam().repeats)
      << "whoever changes what a run gives raises arithmetic()";
  EXPECT_EQ(again.checkpoints, GetParam().repeats ? 2 : format().can_go_on ? again.checkpoints : 0);
}

// A wrong hash whose record has the right checksum.
TEST_P(KeptRecordingTest, shows_a_state_without_its_hash_as_damage_whatever_its_arithmetic) {
  const Checkpoint checkpoint = Recording(kept()).checkpoint(1);
  const std::uint64_t other = checkpoint.hash + 1;
  std::string bytes = bytes_of(kept());
  const auto place = bytes.find({reinterpret_cast<const char*>(&checkpoint.hash), sizeof checkpoint.hash});
  ASSERT_NE(place, std::string::npos);
  const auto reseal = [&](auto record) {
    const std::size_t start = place - offsetof(decltype(record), hash);
    std::memcpy(&record, bytes.data() + start, sizeof record);
    record.hash = other;
    record = sealed(record);
    std::memcpy(bytes.data() + start, &record, sizeof record);
  };
  if (GetParam().format == 1)
    reseal(StateRowRecord{});
  else
    reseal(CheckpointRecord{});
  write_bytes(path("a.h5"), bytes);
  const Rerun again = rerun(Recording(path("a.h5")), [](std::int64_t) {});
  ASSERT_EQ(again.damage.size(), 1u);
  EXPECT_EQ(again.damage[0].at.step, checkpoint.step);
}

TEST_P(KeptRecordingTest, is_copied_with_its_arithmetic_or_says_from_which_format_on) {
  const Recording recording(kept());
  const SoundRows rows = sound_rows(recording);
  if (recording.can_go_on()) {
    write_recovered(recording, rows, path("copy.h5"));
    EXPECT_EQ(Recording(path("copy.h5")).arithmetic(), GetParam().arithmetic);
    return;
  }
  try {
    write_recovered(recording, rows, path("copy.h5"));
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(), "the recording has format " + std::to_string(GetParam().format) +
                                ": it can be looked at and exported; runs go on from format 6 and later");
  }
  EXPECT_EQ(files_in_folder(), 0u);
}

INSTANTIATE_TEST_SUITE_P(
    Formats, KeptRecordingTest,
    ::testing::Values(Kept{"format-1", 1, k_system_arithmetic}, Kept{"format-2", 2, k_system_arithmetic},
                      Kept{"format-3", 3, k_system_arithmetic}, Kept{"format-4", 4, k_system_arithmetic},
                      Kept{"format-5", 5, k_system_arithmetic}, Kept{"format-6", 6, k_system_arithmetic},
                      Kept{"format-7", 7, k_system_arithmetic}, Kept{"format-7-topple-1", 7, "topple-1"},
                      Kept{"format-7-topple-2", 7, "topple-2"}, Kept{"format-8", 8, "topple-2"},
                      Kept{"format-9", 9, "topple-3"}, Kept{"format-10", 10, "topple-4"},
                      Kept{"format-10-topple-5", 10, "topple-5"}, Kept{"format-10-topple-6", 10, "topple-6"},
                      Kept{"format-10-topple-7", 10, "topple-7"}, Kept{"format-10-topple-8", 10, "topple-8"},
                      Kept{"format-10-topple-9", 10, "topple-9"},
                      Kept{"format-10-topple-10", 10, "topple-10"},
                      Kept{"format-10-topple-11", 10, "topple-11", true},
                      Kept{"format-10-topple-12", 10, "topple-12", true},
                      Kept{"format-10-topple-13", 10, "topple-13", true},
                      Kept{"format-10-topple-14", 10, "topple-14", true},
                      Kept{"format-10-topple-15", 10, "topple-15", true},
                      Kept{"format-10-topple-16", 10, "topple-16", true},
                      Kept{"format-10-topple-17", 10, "topple-17", true},
                      Kept{"format-10-topple-18", 10, "topple-18", true},
                      Kept{"format-10-topple-19", 10, "topple-19", true}),
    [](const auto& kept) {
      std::string name = kept.param.name;
      std::ranges::replace(name, '-', '_');
      return name;
    });

TEST_F(RecordingTest, a_cabinet_of_before_format_8_touches_with_edges_and_faces_too_and_so_does_its_copy) {
  const Recording kept(k_folder + "format-7-cabinet.h5");
  write_recovered(kept, sound_rows(kept), path("copy.h5"));
  const Recording copy(path("copy.h5"));
  EXPECT_EQ(kept.format(), 7);
  EXPECT_EQ(copy.format(), 10);
  for (const Recording* recording : {&kept, &copy}) {
    EXPECT_EQ(recorded_scene(*recording).setup.model.contact_points.size(), 26u);
    const Rerun again = rerun(*recording, [](std::int64_t) {});
    EXPECT_TRUE(again.damage.empty());
    EXPECT_GE(again.checkpoints, 1);  // the methods of then took other steps
  }
}

TEST_F(RecordingTest, names_the_arithmetic_that_writes_it) {
  record_small(path("a.h5"), 3);
  EXPECT_EQ(Recording(path("a.h5")).arithmetic(), arithmetic());
}

TEST(Formats, there_is_a_kept_recording_of_each) {
  for (const Format& format : formats())
    EXPECT_TRUE(std::filesystem::exists(k_folder + "format-" + std::to_string(format.version) + ".h5"));
}

}  // namespace
}  // namespace topple::io::testing
