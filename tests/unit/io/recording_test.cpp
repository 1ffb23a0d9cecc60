// What goes in comes out: rows, events, checkpoints, replacing, following, tables.
#include <thread>

#include "recording_fixture.h"
#include "solver/io/export/export_csv.h"

// HDF5 keeps its tables at exit (see QuietHdf5), which the leak sanitizer, where it is on, need not tell.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libhdf5";
}

namespace topple::io::testing {
namespace {

TEST_F(RecordingTest, rows_events_and_checkpoints_read_back_to_the_last_bit) {
  record_small(path("a.h5"), 250);
  const Recording recording(path("a.h5"));
  EXPECT_EQ(recording.scene_name(), "fake");
  EXPECT_EQ(recording.scene_text(), k_text);
  EXPECT_EQ(recording.status(), "completed");
  EXPECT_EQ(recording.summary_json(), "{\"a\": 1}");
  ASSERT_EQ(recording.frame_count(), 250);
  ASSERT_EQ(recording.index().size(), 250u);
  for (int i = 249; i >= 0; --i) {
    EXPECT_TRUE(same(recording.frame(i), fake_row(k_small, i, i * 0.01))) << i;
    EXPECT_EQ(recording.index()[static_cast<std::size_t>(i)].time, i * 0.01);
  }
  ASSERT_EQ(recording.checkpoint_count(), 3);
  for (int i = 0; i < 3; ++i) {
    const Checkpoint read = recording.checkpoint(i), written = fake_checkpoint(k_small, 100 * i, i);
    EXPECT_EQ(read.state, written.state);
    EXPECT_EQ(read.hash, written.hash);
    EXPECT_EQ(read.step, written.step);
  }
  const auto events = recording.events();
  ASSERT_EQ(events.size(), 25u);
  EXPECT_EQ(events[3].step, 30);
  EXPECT_EQ(events[3].event.kind, Event::Kind::impact);
  EXPECT_EQ(events[3].event.body, 1);
  EXPECT_EQ(events[3].event.value, 2.5);
}

TEST_F(RecordingTest, a_model_without_contacts_planes_or_elements_can_be_recorded) {
  const RowShape shape{.nodes = 1, .elements = 0, .contacts = 0, .bodies = 1};
  RecordingWriter writer(path("a.h5"), "", "", Model{}, shape);
  for (int i = 0; i < 70; ++i) writer.append(fake_row(shape, i, i));
  writer.finish("stopped", "");
  const Recording recording(path("a.h5"));
  ASSERT_EQ(recording.frame_count(), 70);
  for (int i = 0; i < 70; ++i) EXPECT_TRUE(same(recording.frame(i), fake_row(shape, i, i)));
  EXPECT_EQ(recording.status(), "stopped");
  EXPECT_EQ(recording.scene_text(), "");
}

TEST_F(RecordingTest, without_finish_the_status_is_interrupted_and_all_rows_are_there) {
  {
    RecordingWriter writer(path("a.h5"), "fake", k_text, small_model(), k_small);
    append_small(writer, 50);
  }
  const Recording recording(path("a.h5"));
  EXPECT_EQ(recording.status(), "interrupted");
  EXPECT_EQ(recording.summary_json(), "");
  EXPECT_EQ(recording.frame_count(), 50);
  EXPECT_EQ(files_in_folder(), 1u);
}

TEST_F(RecordingTest, a_row_of_another_size_is_refused) {
  RecordingWriter writer(path("a.h5"), "fake", k_text, small_model(), k_small);
  EXPECT_THROW(writer.append(fake_row(k_cabinet, 0, 0)), std::invalid_argument);
}

const std::string k_old = "\x89HDF\r\n\x1a\n old";  // begins as recordings do

TEST_F(RecordingTest, a_start_that_comes_to_nothing_leaves_the_old_file_alone) {
  write_bytes(path("a.h5"), k_old);
  { RecordingWriter writer(path("a.h5"), "fake", k_text, small_model(), k_small); }
  EXPECT_EQ(bytes_of(path("a.h5")), k_old);
  EXPECT_EQ(files_in_folder(), 1u);
}

TEST_F(RecordingTest, the_first_frame_replaces_the_old_file_at_once) {
  write_bytes(path("a.h5"), k_old);
  RecordingWriter writer(path("a.h5"), "fake", k_text, small_model(), k_small);
  EXPECT_EQ(bytes_of(path("a.h5")), k_old);
  writer.append(fake_row(k_small, 0, 0));
  writer.flush_if_due();
  EXPECT_TRUE(is_recording(path("a.h5")));
  EXPECT_EQ(files_in_folder(), 1u);
}

TEST_F(RecordingTest, a_link_stays_a_link) {
  write_bytes(path("real.h5"), k_old);
  std::filesystem::create_symlink(path("real.h5"), path("link.h5"));
  record_small(path("link.h5"), 3);
  EXPECT_TRUE(std::filesystem::is_symlink(path("link.h5")));
  EXPECT_TRUE(is_recording(path("real.h5")));
}

TEST_F(RecordingTest, impossible_destinations_are_named) {
  const auto error = [](const std::string& file) -> std::string {
    try {
      RecordingWriter(file, "fake", k_text, small_model(), k_small);
    } catch (const WriteError& what) {
      return what.what();
    }
    return {};
  };
  EXPECT_EQ(error(path("none/a.h5")), path("none/a.h5") + ": cannot be written: No such file or directory");
  EXPECT_EQ(error(folder_.string()), folder_.string() + ": cannot be written: is a folder");
  EXPECT_EQ(error("/dev/null"), "/dev/null: cannot be written: is not an ordinary file");
}

TEST_F(RecordingTest, a_reader_follows_a_writer_in_another_process) {
  constexpr int frames = 400;
  const pid_t writer_process = fork();
  if (writer_process == 0) {
    RecordingWriter writer(path("a.h5"), "fake", k_text, small_model(), k_small);
    for (int i = 0; i < frames; ++i) {
      if (i % 100 == 0) writer.append(fake_checkpoint(k_small, i, i));
      writer.append(fake_row(k_small, i, i));
      i % 10 == 0 ? writer.flush() : writer.flush_if_due();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    writer.finish("completed", "{}");
    std::_Exit(0);
  }
  while (!std::filesystem::exists(path("a.h5"))) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  Recording recording(path("a.h5"));
  std::int64_t seen = 0;
  int looks_that_brought_news = 0;
  for (int look = 0; look < 5000 && recording.status() != "completed"; ++look) {
    for (; seen < recording.frame_count(); ++seen) {
      EXPECT_TRUE(same(recording.frame(seen), fake_row(k_small, seen, static_cast<double>(seen)))) << seen;
    }
    const Recording fresh(path("a.h5"));
    EXPECT_GE(fresh.frame_count(), seen);
    looks_that_brought_news += recording.refresh();
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  int status = -1;
  waitpid(writer_process, &status, 0);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(recording.frame_count(), frames);
  EXPECT_EQ(recording.checkpoint_count(), 4);
  EXPECT_GT(looks_that_brought_news, 5);
}

TEST_F(RecordingTest, a_reader_in_the_same_process_sees_what_was_flushed) {
  RecordingWriter writer(path("a.h5"), "fake", k_text, small_model(), k_small);
  append_small(writer, 45);
  writer.flush();
  Recording recording(path("a.h5"));
  EXPECT_EQ(recording.frame_count(), 45);
  writer.append(fake_row(k_small, 45, 0.45));
  writer.flush();
  EXPECT_TRUE(recording.refresh());
  EXPECT_TRUE(same(recording.frame(45), fake_row(k_small, 45, 0.45)));
  writer.finish("completed", "{}");
  EXPECT_TRUE(recording.refresh());
  EXPECT_EQ(recording.status(), "completed");
}

TEST_F(RecordingTest, tables_have_the_columns_of_the_contract_and_shortest_numbers) {
  {
    RecordingWriter writer(path("a.h5"), "fake", k_text, small_model(), k_small);
    FrameRow row = blank_row(k_small);
    row.time = 0.1;
    row.position[0] = 0.1f;
    row.section_force[0] = 1000;
    row.s[1] = -0.25f;
    row.hinge[1] = 2;
    row.level.assign(row.level.size(), static_cast<std::uint8_t>(ModelLevel::frame));
    row.body[0].tilt = k_pi / 2;
    row.body[0].energy = 1.0 / 3;
    row.floor_acceleration[0] = 1.862;
    writer.append(row);
    writer.finish("completed", "{}");
  }
  write_csv(Recording(path("a.h5")), small_setup(), path("out/csv"));
  EXPECT_EQ(bytes_of(path("out/csv/bodies.csv")),
            "time_s,body,x_m,y_m,z_m,qw,qx,qy,qz,tilt_deg,slide_m,energy_J\n"
            "0.1,\"shelf, \"\"blue\"\"\",0,0,0,0,0,0,0,90,0,0.3333333333333333\n"
            "0.1,b,0,0,0,0,0,0,0,0,0,0\n");
  EXPECT_EQ(bytes_of(path("out/csv/nodes.csv")),
            "time_s,body,node,x_m,y_m,z_m,qw,qx,qy,qz\n"
            "0.1,\"shelf, \"\"blue\"\"\",0,0.1,0,0,0,0,0,0\n"
            "0.1,\"shelf, \"\"blue\"\"\",1,0,0,0,0,0,0,0\n"
            "0.1,b,0,0,0,0,0,0,0,0\n");
  EXPECT_EQ(bytes_of(path("out/csv/contacts.csv")), "time_s,body,part,against,x_m,y_m,z_m,Fx,Fy,Fz\n");
  EXPECT_EQ(bytes_of(path("out/csv/floor.csv")), "time_s,ax,ay,az,dx,dy,dz\n0.1,1.862,0,0,0,0,0\n");
  const std::string elements = bytes_of(path("out/csv/elements.csv"));
  EXPECT_TRUE(
      elements.starts_with("time_s,body,member,element,N,Vy,Vz,T,My,Mz,stress_Pa,yield_ratio,s,hinge,"
                           "peak_stress_Pa\n"
                           "0.1,\"shelf, \"\"blue\"\"\",post-1,0,1000,0,0,0,0,0,"))
      << elements;
  EXPECT_TRUE(elements.ends_with("post-1,1,0,0,0,0,0,0,0,,-0.25,2,0\n")) << elements;
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(path("out/csv")), {}), 6);
}

TEST_F(RecordingTest, tables_of_a_damaged_recording_do_not_appear_by_half) {
  record_small(path("a.h5"), 40);
  const Recording recording(path("a.h5"));
  EXPECT_THROW(write_csv(recording, topple::Setup{}, path("out")), InputError);
  EXPECT_TRUE(std::filesystem::is_empty(path("out")));
  write_bytes(path("file"), "");
  EXPECT_THROW(write_csv(recording, small_setup(), path("file/out")), WriteError);
}

}  // namespace
}  // namespace topple::io::testing
