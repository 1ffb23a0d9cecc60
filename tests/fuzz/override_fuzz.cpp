// Any "--set KEY=VALUE" changes a scene or is refused with one line. Input: overrides, one a line.
#include <string_view>
#include <vector>

#include "fuzz.h"
#include "solver/io/scene/scene.h"

using namespace topple;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t k_most = 4;
  static const std::string paper = io::load_scene("paper-a").text;
  std::string_view rest(reinterpret_cast<const char*>(data), size);
  std::vector<std::string> overrides;
  while (!rest.empty() && overrides.size() < k_most) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    overrides.emplace_back(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  try {
    io::parse_scene(paper, "s.toml", overrides);
  } catch (const io::InputError& error) {
    promise_one_line(error.what());
  }
  return 0;
}
