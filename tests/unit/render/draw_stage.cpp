// Draws the stage off screen into the PNG file named by its argument: the test of the window, which may
// not hold such a context, compares with it.
#include "tests/unit/render/off_screen.h"
#include "tests/unit/render/read_png.h"
#include "tests/unit/render/staged.h"

int main(int argc, char** argv) {
  using namespace topple::render;
  if (argc != 2) return 2;
  Staged staged(off_screen());
  staged.draw_scene(synthetic_cabinet(6), Quality::interactive);
  write_png(argv[1], staged.stage.shot(k_surface, staged.panel()));
}
