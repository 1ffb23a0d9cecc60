#include <fmt/format.h>

#include "bench/engines/rooms.h"
#include "solver/io/scene/scene.h"
#include "solver/study/common/refinement.h"

namespace topple::bench {
namespace {

/// The shelf of the scene bookshelf, loaded, `along` x `across` of them with `gap` between their faces.
std::string shelves(int along, int across, double gap) {
  constexpr double depth = 0.3, width = 0.9, post = 0.03;  // m, outside
  std::string copies;
  for (int i = 0; i < along; ++i)
    for (int j = 0; j < across; ++j)
      copies += fmt::format("[{}, {}, 0], ", i * (depth + gap), j * (width + gap));
  return fmt::format(
      "topple = 1\n[run]\nduration = \"6 s\"\ntime_step = \"auto\"\nwant = [\"motion\"]\n"
      "[[shake]]\ntype = \"sine\"\nfrequency = \"1 Hz\"\namplitude = \"300 gal\"\ndirection = [1, 0, 0]\n"
      "[contact]\nfriction = 0.5\n[floor]\n"
      "[[material]]\nname = \"wood\"\nyoung = \"6 GPa\"\npoisson = 0.3\ndensity = \"650 kg/m^3\"\n"
      "[[section]]\nname = \"post\"\nshape = \"solid\"\nsize = [{2}, {2}]\n"
      "[[cabinet]]\nname = \"shelf\"\nsize = [{0}, {1}, 1.77]\nmass = \"150 kg\"\ninertia = \"solid\"\n"
      "section = \"post\"\nmaterial = \"wood\"\nshelves = 3\npanel_thickness = \"15 mm\"\n"
      "copies = [{3}]\n",
      depth - post, width - post, post, copies);
}

Setup as_frames(const Setup& own) {
  Setup setup = own;
  setup.parameters.models.assign(setup.model.bodies.size(), BodyModel::frame);
  return setup;
}

}  // namespace

std::vector<Room> rooms() {
  constexpr const char* frames = "frames";
  constexpr const char* finer = "half the step, a tenth of the tolerance";
  return {
      {"row", "eight loaded shelves one behind the other, 20 mm apart, 1 Hz, 300 gal along the row",
       io::parse_scene(shelves(8, 1, 0.02), "row").setup, finer, study::refined},
      {"twelve", "twelve such shelves back to back and side by side, 2 x 6, 5 mm apart, 1 Hz, 300 gal",
       io::parse_scene(shelves(2, 6, 0.005), "twelve").setup, finer, study::refined},
      {"dominoes", "the scene: eight cabinets, the first let go beyond its balance",
       io::load_scene("dominoes").setup, frames, as_frames},
      {"stack", "the scene: ten boxes on each other, 2 Hz, 150 gal", io::load_scene("stack").setup, frames,
       as_frames},
  };
}

}  // namespace topple::bench
