// Every write of the program fails once, in turn: exit code 1 and one line, what was recorded before is
// sound, and nothing is left half-written. TOPPLE_EVERY_WRITE: tries each one instead of some.
#include <algorithm>

#include "solver/io/recording/recording_format.h"
#include "unit/app/program.h"
#include "unit/app/scenes.h"

namespace topple::app {
namespace {

class FailingWriteTest : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write_bytes("s.toml", k_shaken);
    ASSERT_EQ(topple({"run", "s.toml", "-o", "a.h5"}).code, 0);
  }

  static Circumstances failing(int write, const std::string& failure) {
    const char* const options = getenv("ASAN_OPTIONS");
    return {
        .set = {{"LD_PRELOAD", TOPPLE_FAILING_WRITES},
                {"TOPPLE_FAILING_WRITE", std::to_string(write)},
                {"TOPPLE_FAILURE", failure},
                {"TOPPLE_WRITES_COUNTED", "count"},
                {"MESA_SHADER_CACHE_DISABLE", "true"},
                {"ASAN_OPTIONS", (options ? std::string(options) + ":" : "") + "verify_asan_link_order=0"}}};
  }

  /// Calls the program with its first, second, ... write failing, to the last; `expect` looks at what became
  /// of each. Some writes alone, the first ones among them, unless all are asked for.
  template <typename Expect>
  static void each_write(const std::vector<std::string>& call, const std::string& failure, Expect expect) {
    const bool every = getenv("TOPPLE_EVERY_WRITE") != nullptr;
    int tried = 0, writes = 0;
    for (int write = 1; !HasFailure(); write += every ? 1 : std::max(1, write / 4)) {
      SCOPED_TRACE(failure + " of write " + std::to_string(write));
      const Ended ended = topple(call, failing(write, failure));
      writes = std::atoi(bytes_of("count").c_str());
      std::filesystem::remove("count");
      if (ended.code == 0 && write > writes) break;
      ++tried;
      expect(ended);
    }
    EXPECT_GT(tried, 2);
    std::cout << call[0] << ": " << failure << " of " << tried << " of " << writes << " writes\n";
  }

  static void expect_told(const Ended& ended, const std::string& file) {
    EXPECT_EQ(ended.code, 1);
    EXPECT_EQ(ended.out, "");
    EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
    EXPECT_TRUE(ended.err.starts_with("topple: ")) << ended.err;
    EXPECT_NE(ended.err.find(file), std::string::npos) << ended.err;
  }

  static bool same_rows(const io::FrameRow& a, const io::FrameRow& b) {
    const auto left = io::field_bytes(a), right = io::field_bytes(b);
    for (std::size_t i = 0; i < left.size(); ++i)
      if (!std::ranges::equal(left[i], right[i])) return false;
    return a.branch == b.branch && a.step == b.step && a.time == b.time;
  }
  /// The frames of `file` are the first ones of a.h5.
  static std::int64_t expect_first_rows(const std::string& file) {
    const io::Recording whole("a.h5"), some(file);
    EXPECT_LE(some.frame_count(), whole.frame_count());
    for (std::int64_t i = 0; i < some.frame_count(); ++i) {
      EXPECT_TRUE(same_rows(some.frame(i), whole.frame(i))) << i;
    }
    return some.frame_count();
  }
};

TEST_F(FailingWriteTest, whichever_write_of_a_run_fails_the_rows_before_are_kept) {
  const std::vector<std::string> before = files();
  std::int64_t most = 0;
  for (const char* failure : {"EIO", "ENOSPC"})
    each_write({"run", "s.toml", "-o", "b.h5"}, failure, [&](const Ended& ended) {
      if (ended.code == 0) {  // HDF5 wrote it again
        EXPECT_EQ(expect_first_rows("b.h5"), io::Recording("a.h5").frame_count());
        EXPECT_EQ(io::Recording("b.h5").status(), "completed");
        return;
      }
      expect_told(ended, "b.h5: cannot ");
      if (!std::filesystem::exists("b.h5")) {
        EXPECT_EQ(files(), before);
        return;
      }
      EXPECT_EQ(files().size(), before.size() + 1);
      most = std::max(most, expect_first_rows("b.h5"));
      const Ended recovered = topple({"recover", "b.h5", "-o", "r.h5"});
      EXPECT_EQ(recovered.code, 0) << recovered.err;
      if (std::filesystem::exists("r.h5")) {
        EXPECT_EQ(expect_first_rows("r.h5"), io::Recording("b.h5").frame_count());
      }
      std::filesystem::remove("b.h5");
      std::filesystem::remove("r.h5");
    });
  EXPECT_EQ(most, io::Recording("a.h5").frame_count());  // the last writes are those of the result
}

TEST_F(FailingWriteTest, whichever_write_is_cut_short_the_recording_is_whole) {
  each_write({"run", "s.toml", "-o", "b.h5"}, "short", [&](const Ended& ended) {
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_EQ(expect_first_rows("b.h5"), io::Recording("a.h5").frame_count());
    EXPECT_EQ(io::Recording("b.h5").status(), "completed");
  });
}

TEST_F(FailingWriteTest, whichever_write_of_other_results_fails_they_appear_whole_or_not_at_all) {
  struct Result {
    std::vector<std::string> call;
    std::vector<std::string> made;  ///< all that it may leave
    const char* message;
  };
  std::vector<std::string> vtk = {"vtk"};
  for (int i = 0; i < 31; ++i)
    vtk.push_back(std::string("vtk/frame-0000") + (i < 10 ? "0" : "") + std::to_string(i) + ".vtp");
  vtk.push_back("vtk/frames.pvd");
  const Result results[] = {
      {{"export", "a.h5", "--csv", "data"},
       {"data", "data/bodies.csv", "data/elements.csv", "data/energy.csv", "data/floor.csv",
        "data/nodes.csv"},
       "data"},
      {{"export", "a.h5", "--xdmf", "a.xdmf"}, {"a.xdmf", "a.xdmf.h5"}, "a.xdmf"},
      {{"export", "a.h5", "--vtk", "vtk"}, vtk, "vtk"},
      {{"export", "a.h5", "--gltf", "a.glb"}, {"a.glb"}, "a.glb"},
      {{"run", "s.toml", "--json", "b.json"}, {"b.json"}, "b.json"},
      {{"render", "a.h5", "--still", "a.png", "--at", "0", "--size", "96x64"}, {"a.png"}, "a.png"},
      {{"recover", "cut.h5", "-o", "r.h5"}, {"r.h5"}, "r.h5"}};
  if (const pid_t child = fork(); child == 0) {
    const io::Scene scene = io::parse_scene(k_shaken, "s.toml");
    io::Recorder recorder("cut.h5", scene.name, scene.text, scene.setup.model);
    const io::Recording whole("a.h5");
    for (int i = 0; i < 10; ++i) recorder.write({.frames = {whole.frame(i)}, .checkpoint = {}, .events = {}});
    recorder.flush();
    raise(SIGKILL);
  } else {
    ASSERT_EQ(wait_for(child), 1000 + SIGKILL);
  }
  const std::vector<std::string> before = files();
  for (const Result& result : results) {
    SCOPED_TRACE(result.call[0] + " " + result.call[2]);
    const auto clear = [&] {
      for (auto made = result.made.rbegin(); made != result.made.rend(); ++made)
        std::filesystem::remove_all(*made);
    };
    ASSERT_EQ(topple(result.call).code, 0);
    std::vector<std::pair<std::string, std::string>> whole;
    for (const std::string& made : result.made)
      if (!std::filesystem::is_directory(made)) whole.emplace_back(made, bytes_of(made));
    clear();
    each_write(result.call, "EIO", [&](const Ended& ended) {
      if (ended.code != 0) {
        EXPECT_EQ(ended.code, 1);
        EXPECT_NE(ended.err.find(result.message), std::string::npos) << ended.err;
      }
      for (const auto& [file, content] : whole) {
        if (!std::filesystem::exists(file)) {
          EXPECT_NE(ended.code, 0) << file;
        } else if (file == "b.json") {  // it has the time that the run took
          EXPECT_EQ(json_of(bytes_of(file))["status"], "completed");
        } else if (file == "r.h5") {
          EXPECT_EQ(expect_first_rows(file), 10);
        } else {
          EXPECT_TRUE(bytes_of(file) == content) << file;
        }
      }
      clear();
      EXPECT_EQ(files(), before);
    });
    clear();
  }
}

}  // namespace
}  // namespace topple::app
