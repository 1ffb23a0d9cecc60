// The real program as a child process, in a folder of its own that is gone afterwards.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace topple::app {

/// What became of a call.
struct Ended {
  int code = -1;  ///< 1000 + the signal when one killed it
  std::string out, err;
};

/// How the child differs from this process.
struct Circumstances {
  rlim_t most_bytes = RLIM_INFINITY;                          ///< of a file that it writes
  std::vector<std::pair<std::string, std::string>> set = {};  ///< environment
  std::string output = {};                                    ///< where stdout goes; empty: to Ended::out
};

inline std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline void write_bytes(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

/// Begins as recordings do.
inline const std::string k_older_recording = "\x89HDF\r\n\x1a\n older";

class ProgramTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "topple-app-test-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
    ASSERT_EQ(chdir(name.c_str()), 0);  // so that the program is given short relative names
    ASSERT_EQ(setenv("TMPDIR", name.c_str(), 1), 0);
  }
  void TearDown() override {
    std::error_code ignored;
    std::filesystem::current_path(folder_.parent_path(), ignored);
    std::filesystem::remove_all(folder_, ignored);
    unsetenv("TMPDIR");
  }

  /// Starts the program; err_file and out_file are where its streams go.
  static pid_t start(const std::vector<std::string>& arguments, int out_file, int err_file,
                     const Circumstances& given = {}) {
    std::vector<char*> argv{const_cast<char*>("topple")};
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    const pid_t child = fork();
    if (child != 0) return child;
    dup2(out_file, STDOUT_FILENO);
    dup2(err_file, STDERR_FILENO);
    if (const char* leaks =
            getenv("LSAN_OPTIONS"))  // a list of known leaks is not part of what the program says
      setenv("LSAN_OPTIONS", (leaks + std::string(":print_suppressions=0")).c_str(), 1);
    for (const auto& [key, value] : given.set) setenv(key.c_str(), value.c_str(), 1);
    if (given.most_bytes != RLIM_INFINITY) {
      const rlimit bound{given.most_bytes, given.most_bytes};
      setrlimit(RLIMIT_FSIZE, &bound);
    }
    execv(TOPPLE_PROGRAM, argv.data());
    _exit(127);
  }

  static int wait_for(pid_t child) {
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
  }

  static Ended topple(const std::vector<std::string>& arguments, const Circumstances& given = {}) {
    const int out = given.output.empty() ? memory() : open(given.output.c_str(), O_WRONLY | O_CLOEXEC);
    const int err = memory();
    Ended ended;
    ended.code = wait_for(start(arguments, out, err, given));
    if (given.output.empty()) ended.out = content(out);
    ended.err = content(err);
    close(out);
    close(err);
    return ended;
  }

  static int memory() { return memfd_create("stream", MFD_CLOEXEC); }
  static std::string content(int file) {
    std::string text(static_cast<std::size_t>(std::max<off_t>(lseek(file, 0, SEEK_END), 0)), '\0');
    return pread(file, text.data(), text.size(), 0) < 0 ? std::string() : text;
  }

  /// Exit code `code`, nothing on stdout, and one line on stderr that holds `part`.
  static void expect_one_line(const std::vector<std::string>& arguments, int code, const std::string& part,
                              const Circumstances& given = {}) {
    std::string call = "topple";
    for (const std::string& argument : arguments) call += " '" + argument + "'";
    SCOPED_TRACE(call);
    const Ended ended = topple(arguments, given);
    EXPECT_EQ(ended.code, code);
    EXPECT_EQ(ended.out, "");
    EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
    EXPECT_TRUE(ended.err.starts_with("topple: ")) << ended.err;
    EXPECT_TRUE(ended.err.ends_with("\n")) << ended.err;
    EXPECT_NE(ended.err.find(part), std::string::npos) << ended.err;
  }

  /// Everything in the folder, links to folders included, in alphabetical order.
  static std::vector<std::string> files() {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::recursive_directory_iterator("."))
      names.push_back(entry.path().lexically_normal().string());
    std::sort(names.begin(), names.end());
    return names;
  }

  static nlohmann::ordered_json json_of(const std::string& text) {
    return nlohmann::ordered_json::parse(text, nullptr, false);
  }
  /// The recording as `info --json -` tells it.
  static nlohmann::ordered_json info(const std::string& recording) {
    const Ended ended = topple({"info", recording, "--json", "-"});
    EXPECT_EQ(ended.code, 0) << ended.err;
    return json_of(ended.out);
  }

 private:
  std::filesystem::path folder_;
};

}  // namespace topple::app
