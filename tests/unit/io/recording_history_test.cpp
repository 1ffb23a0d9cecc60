// Branches and edits in a recording: what is written is read, along one way, and damage is seen.
#include <cstring>
#include <sstream>

#include "recording_fixture.h"
#include "solver/io/export/export_csv.h"

namespace topple::io::testing {
namespace {

FrameRow row_of(std::int32_t branch, std::int64_t step) {
  FrameRow row = fake_row(k_small, 1000 * branch + step, 0.01 * static_cast<double>(step));
  row.branch = branch;
  row.step = step;
  return row;
}

LoggedEdit edit_of(std::int32_t branch, std::int64_t step, Edit::Key key, const Vec3& value, int shake = 0) {
  return {branch, step, 0.01 * static_cast<double>(step), {key, shake, value}};
}

class HistoryRecordingTest : public RecordingTest {
 protected:
  static void append_rows(RecordingWriter& writer, std::int32_t branch, std::int64_t first,
                          std::int64_t last) {
    for (std::int64_t step = first; step <= last; ++step) {
      if (step % 10 == 0 && step > first) {
        RecordedEvent event = fake_event(step, 0.01 * static_cast<double>(step));
        event.branch = branch;
        writer.append(event);
      }
      writer.append(row_of(branch, step));
    }
  }
  /// 0 has the steps 0 to 50, 1 leaves it at 20 and has those up to 40, 2 leaves 1 at 30.
  void record_forked(const std::string& file) const {
    RecordingWriter writer(file, "fake", k_text, small_model(), k_small);
    append_rows(writer, 0, 0, 50);
    writer.append(edits_[0]);
    writer.append(Branch{1, 0, 20});
    writer.append(edits_[1]);
    append_rows(writer, 1, 20, 40);
    writer.flush();
    writer.append(Branch{2, 1, 30});
    writer.append(edits_[2]);
    append_rows(writer, 2, 30, 35);
    writer.finish("stopped", "{}");
  }
  void record_edit(const LoggedEdit& edit) const {
    RecordingWriter writer(path("a.h5"), "fake", k_text, small_model(), k_small);
    writer.append(row_of(0, 0));
    writer.append(edit);
    writer.finish("completed", "{}");
  }
  /// Changes the newest record of a closed file, checksum included.
  template <typename Record, typename Change>
  void change_record(const char* set_name, Change change) const {
    const Handle file(H5Fopen(path("a.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
    const Handle set(H5Dopen2(file, set_name, H5P_DEFAULT), H5Dclose);
    const Handle type = record_type<Record>();
    const Handle space(H5Dget_space(set), H5Sclose);
    std::vector<Record> records(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
    checked(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, records.data()));
    change(records.back());
    records.back() = sealed(records.back());
    checked(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, records.data()));
  }
  std::string a_error() const {
    const std::string error = read_error(path("a.h5")), start = path("a.h5") + ": cannot read: ";
    return error.starts_with(start) ? error.substr(start.size()) : error;
  }

  const LoggedEdit edits_[3] = {edit_of(0, 50, Edit::Key::alpha, Vec3(1000, 0, 0)),
                                edit_of(1, 20, Edit::Key::amplitude, Vec3(0.1 + 0.2, 0, 0), 11),
                                edit_of(2, 31, Edit::Key::direction, Vec3(0.5, -0.25, 1e-3), 1)};
};

TEST_F(HistoryRecordingTest, branches_and_edits_read_back_to_the_last_bit) {
  record_forked(path("a.h5"));
  const Recording recording(path("a.h5"));
  const History& history = recording.history();
  ASSERT_EQ(history.branches.size(), 3u);
  const Branch expected[] = {{0, -1, 0}, {1, 0, 20}, {2, 1, 30}};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(history.branches[i].id, expected[i].id);
    EXPECT_EQ(history.branches[i].parent, expected[i].parent);
    EXPECT_EQ(history.branches[i].fork_step, expected[i].fork_step);
  }
  ASSERT_EQ(history.edits.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(history.edits[i].branch, edits_[i].branch);
    EXPECT_EQ(history.edits[i].step, edits_[i].step);
    EXPECT_EQ(history.edits[i].time, edits_[i].time);
    EXPECT_EQ(history.edits[i].edit.key, edits_[i].edit.key);
    EXPECT_EQ(history.edits[i].edit.index, edits_[i].edit.index);
    EXPECT_EQ(history.edits[i].edit.value, edits_[i].edit.value);
  }
  EXPECT_EQ(recording.newest_branch(), 2);
}

TEST_F(HistoryRecordingTest, the_way_to_a_branch_shows_each_instant_once) {
  record_forked(path("a.h5"));
  const Recording recording(path("a.h5"));
  const auto shown = [&](std::int32_t branch) {
    std::vector<std::pair<std::int32_t, std::int64_t>> out;
    for (const std::int64_t i : recording.frames_on_way_to(branch)) {
      const FrameKey& instant = recording.index()[static_cast<std::size_t>(i)];
      out.emplace_back(instant.branch, instant.step);
      EXPECT_TRUE(same(recording.frame(i), row_of(instant.branch, instant.step)));
    }
    return out;
  };
  std::vector<std::pair<std::int32_t, std::int64_t>> expected;
  for (std::int64_t step = 0; step <= 35; ++step)
    expected.emplace_back(step < 20 ? 0 : step < 30 ? 1 : 2, step);
  EXPECT_EQ(shown(2), expected);
  EXPECT_EQ(shown(1).size(), 41u);
  EXPECT_EQ(shown(0).size(), 51u);
  EXPECT_THROW(recording.frames_on_way_to(3), std::invalid_argument);
  std::vector<std::pair<std::int32_t, std::int64_t>> events;
  for (const RecordedEvent& e : recording.events_on_way_to(2)) events.emplace_back(e.branch, e.step);
  EXPECT_EQ(events, (std::vector<std::pair<std::int32_t, std::int64_t>>{{0, 10}, {0, 20}, {1, 30}}));
}

TEST_F(HistoryRecordingTest, tables_follow_the_newest_branch) {
  record_forked(path("a.h5"));
  write_csv(Recording(path("a.h5")), small_setup(), path("csv"));
  const std::string floor = bytes_of(path("csv/floor.csv"));
  EXPECT_EQ(std::count(floor.begin(), floor.end(), '\n'), 37);
  EXPECT_NE(floor.find("\n0.29,"), std::string::npos);
  EXPECT_EQ(floor.find("\n0.36,"), std::string::npos);
}

// A branch begins where it was forked, which is a row of the run only at a multiple of the output interval.
TEST_F(HistoryRecordingTest, tables_have_even_rows_where_a_branch_begins_between_two) {
  const auto times = [this](bool goes_on) {
    {
      RecordingWriter writer(path("a.h5"), "fake", k_text, small_model(), k_small);
      append_rows(writer, 0, 0, 3);
      writer.append(Branch{1, 0, 3});
      FrameRow first = row_of(1, 3);
      first.time = 0.025;
      writer.append(first);
      if (goes_on) append_rows(writer, 1, 4, 5);
      writer.finish("stopped", "{}");
    }
    write_csv(Recording(path("a.h5")), small_setup(), path("csv"));
    std::string out;
    std::istringstream floor(bytes_of(path("csv/floor.csv")));
    for (std::string line; std::getline(floor, line);) out += line.substr(0, line.find(',')) + " ";
    return out;
  };
  EXPECT_EQ(times(true), "time_s 0 0.01 0.02 0.04 0.05 ");
  EXPECT_EQ(times(false), "time_s 0 0.01 0.02 0.025 ");  // there it is now
}

TEST_F(HistoryRecordingTest, a_reader_follows_edits_and_branches_as_they_are_written) {
  RecordingWriter writer(path("a.h5"), "fake", k_text, small_model(), k_small);
  append_rows(writer, 0, 0, 25);
  writer.flush();
  Recording recording(path("a.h5"));
  EXPECT_EQ(recording.newest_branch(), 0);
  EXPECT_FALSE(recording.refresh());
  writer.append(edit_of(0, 25, Edit::Key::q, Vec3(2, 0, 0)));
  writer.flush();
  EXPECT_TRUE(recording.refresh());
  ASSERT_EQ(recording.history().edits.size(), 1u);
  EXPECT_EQ(recording.history().edits[0].edit.key, Edit::Key::q);
  writer.append(Branch{1, 0, 20});
  append_rows(writer, 1, 20, 22);
  writer.flush();
  EXPECT_TRUE(recording.refresh());
  EXPECT_EQ(recording.newest_branch(), 1);
  EXPECT_EQ(recording.frames_on_way_to(1).size(), 23u);
  EXPECT_TRUE(same(recording.frame(28), row_of(1, 22)));
}

// The writer forks at every third row and edits at every row, and is killed at some moment.
TEST_F(HistoryRecordingTest, a_killed_writer_leaves_no_row_without_its_branch_and_edits) {
  for (const int life : {1, 2, 7, 30, 100}) {
    const int result = in_child([&] {
      RecordingWriter writer(path("a.h5"), "fake", k_text, small_model(), k_small);
      std::int32_t branch = 0;
      for (std::int64_t step = 0; step < life; ++step) {
        if (step % 3 == 2) writer.append(Branch{++branch, branch - 1, step});
        writer.append(edit_of(branch, step, Edit::Key::q, Vec3(1, 0, 0)));
        writer.append(row_of(branch, step));
        if (step % 2 == 0) writer.flush();
      }
      return 0 * raise(SIGKILL);
    });
    ASSERT_EQ(result, -SIGKILL);
    const Recording recording(path("a.h5"));
    const auto frames = static_cast<std::size_t>(recording.frame_count());
    EXPECT_GE(frames, static_cast<std::size_t>(life) - 1);
    EXPECT_GE(recording.history().edits.size(), frames);
    EXPECT_EQ(recording.frames_on_way_to(recording.index().back().branch).size(), frames);
  }
}

TEST_F(HistoryRecordingTest, a_changed_byte_in_edits_or_branches_is_seen) {
  record_forked(path("whole.h5"));
  const std::string whole = bytes_of(path("whole.h5"));
  const BranchRecord branch = sealed(BranchRecord{.branch = 2, .parent = 1, .fork_step = 30});
  const std::string_view branch_bytes(reinterpret_cast<const char*>(&branch),
                                      offsetof(BranchRecord, checksum));
  const std::pair<std::string_view, std::string> cases[] = {
      {"shake.12.amplitude", "edits is damaged (checksum differs)"},
      {branch_bytes, "branches is damaged (checksum differs)"}};
  for (const auto& [pattern, error] : cases) {
    const std::size_t place = whole.find(pattern);
    ASSERT_NE(place, std::string::npos) << error;
    for (const std::size_t at : {std::size_t{0}, pattern.size() / 2, pattern.size() - 1}) {
      std::string changed = whole;
      changed[place + at] = static_cast<char>(changed[place + at] ^ 4);
      write_bytes(path("a.h5"), changed);
      EXPECT_EQ(a_error(), error) << at;
    }
  }
}

TEST_F(HistoryRecordingTest, edits_that_nobody_could_have_made_are_refused) {
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  record_edit(edit_of(0, 1, Edit::Key::friction, Vec3(2.4, 0, 0)));
  EXPECT_EQ(a_error(), "edits is damaged (edit 0 says contact.friction: 2.4 is outside 0..1.5)");
  record_edit(edit_of(0, 1, Edit::Key::alpha, Vec3(nan, 0, 0)));
  EXPECT_EQ(a_error(), "edits is damaged (edit 0 says contact.alpha: nan is not a finite number)");
  record_edit(edit_of(0, 1, Edit::Key::direction, Vec3::Zero()));
  EXPECT_EQ(a_error(), "edits is damaged (edit 0 says shake.1.direction: a zero vector has no direction)");
  LoggedEdit nowhere = edit_of(0, 1, Edit::Key::q, Vec3(1, 0, 0));
  for (const double time : {nan, infinity, -1.}) {
    nowhere.time = time;
    record_edit(nowhere);
    EXPECT_EQ(a_error(), "edits is damaged (edit 0 has no place in time)");
  }
  record_edit(edit_of(3, 1, Edit::Key::q, Vec3(1, 0, 0)));
  EXPECT_EQ(a_error(), "edits is damaged (edit 0 belongs to no branch)");
  record_edit(edit_of(0, 1, Edit::Key::q, Vec3(1, 0, 0)));
  EXPECT_EQ(a_error(), "");
  for (const std::string key :
       {"", "contact.slip_speed", "shake.0.frequency", "contact.q\n", "shake.1.amplitude.x"}) {
    change_record<EditRecord>("edits", [&](EditRecord& r) {
      key.copy(r.key, sizeof r.key);
      std::memset(r.key + key.size(), 0, sizeof r.key - key.size());
    });
    EXPECT_EQ(a_error(), "edits is damaged (edit 0 has a key that this version does not know)") << key;
  }
  change_record<EditRecord>("edits", [](EditRecord& r) { std::memset(r.key, 'x', sizeof r.key); });
  EXPECT_EQ(a_error(), "edits is damaged (edit 0 has a key that this version does not know)");
  change_record<EditRecord>("edits", [](EditRecord& r) { r.kind = 1; });
  EXPECT_EQ(a_error(), "edits is damaged (edit 0 is of a kind that this version does not know)");
}

TEST_F(HistoryRecordingTest, branches_that_cannot_be_are_refused) {
  const auto record_branch = [&](const Branch& branch, std::int32_t row_branch) {
    RecordingWriter writer(path("a.h5"), "fake", k_text, small_model(), k_small);
    writer.append(row_of(0, 0));
    writer.append(branch);
    writer.append(row_of(row_branch, 1));
    writer.finish("completed", "{}");
    return a_error();
  };
  EXPECT_EQ(record_branch({1, 0, 1}, 1), "");
  EXPECT_EQ(record_branch({5, 0, 1}, 5), "");
  EXPECT_EQ(record_branch({1, 0, 1}, 2), "frames/index is damaged (branch 2 does not exist)");
  EXPECT_EQ(record_branch({0, 0, 1}, 0), "branches is damaged (branch 1 is there twice)");
  for (const Branch& alone : {Branch{1, 2, 1}, Branch{1, 1, 1}, Branch{1, -1, 1}, Branch{1, 0, -1}})
    EXPECT_EQ(record_branch(alone, 1), "branches is damaged (branch 1 has no place among the others)");
  record_branch({1, 0, 1}, 0);
  change_record<BranchRecord>("branches", [](BranchRecord& r) { r.branch = k_not_written; });
  EXPECT_EQ(a_error(), "");  // allocated when the writer died, never written
}

}  // namespace
}  // namespace topple::io::testing
