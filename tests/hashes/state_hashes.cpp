// Hashes of the states that scenes come by: what two systems, compilers or processors must agree on.
//   state_hashes [SCENE...]              the last state of the beginning of each (of all built-in ones)
//   state_hashes --steps FROM TO SCENE   each step of one
// A line: scene, step, time in s, hash.
#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "solver/io/scene/scene.h"
#include "solver/math/processor.h"
#include "solver/run/run.h"

namespace {

using topple::Run;

/// Simulated, s: rooms take long under an emulated processor.
const char* beginning_of(const std::string& scene) {
  for (const char* room : {"dominoes", "stack", "classroom", "office"})
    if (scene == room) return "run.duration=0.1";
  return "run.duration=1";
}

topple::io::Scene beginning(const std::string& scene) {
  return topple::io::load_scene(scene, scene == "portal-pushover"
                                           ? std::vector<std::string>{}
                                           : std::vector{std::string(beginning_of(scene))});
}

void print(const std::string& scene, const Run& run) {
  std::printf("%s %" PRId64 " %.9g %016" PRIx64 "%s\n", scene.c_str(), run.step(), run.time(),
              hash(run.state()), run.status().ok() ? "" : " failed");
}

}  // namespace

int main(int argc, char** argv) try {
  std::vector<std::string> arguments(argv + 1, argv + argc);
  std::fprintf(stderr, "state_hashes: solver for %s\n", topple::instruction_set());
  if (arguments.size() == 4 && arguments[0] == "--steps") {
    const std::int64_t from = std::atoll(arguments[1].c_str()), to = std::atoll(arguments[2].c_str());
    const topple::io::Scene scene = beginning(arguments[3]);
    Run run(scene.setup);
    while (true) {
      if (run.step() >= from) print(arguments[3], run);
      if (run.over() || run.step() >= to) return 0;
      run.advance();
    }
  }
  if (arguments.empty())
    for (const topple::io::BuiltinScene& scene : topple::io::builtin_scenes())
      arguments.emplace_back(scene.name);
  for (const std::string& name : arguments) {
    const topple::io::Scene scene = beginning(name);
    Run run(scene.setup);
    while (!run.over()) run.advance();
    print(name, run);
    std::fflush(stdout);
  }
} catch (const std::exception& error) {
  std::fprintf(stderr, "state_hashes: %s\n", error.what());
  return 2;
}
