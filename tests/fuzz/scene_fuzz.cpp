// Any text is a scene or refused with one line; what is read is written as it was meant.
#include <cmath>
#include <string_view>

#include "fuzz.h"
#include "solver/io/scene/scene.h"

using namespace topple;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto no_file = [](const std::string& name) -> std::string {
    throw io::InputError(name + ": there is no such file");
  };
  try {
    const io::Scene scene = io::parse_scene(text, "s.toml", {}, no_file);
    for (const Vec3& x : scene.setup.model.node_position)
      promise(x.allFinite(), "nodes of a scene have places");
    for (const double mass : scene.setup.model.node_mass)
      promise(std::isfinite(mass) && mass >= 0, "nodes of a scene have masses");
    const io::Scene again = io::parse_scene(scene.text, "s.toml", {}, no_file);
    promise(again.setup.model.node_total() == scene.setup.model.node_total(),
            "the text that a recording keeps gives the same model");
  } catch (const io::InputError& error) {
    promise_one_line(error.what());
  }
  return 0;
}
