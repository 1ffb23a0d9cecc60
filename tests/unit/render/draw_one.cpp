// Draws the synthetic cabinet into the PNG file named by its argument, in a process of its own: Mesa reads
// the number of its threads once.
#include "tests/unit/render/off_screen.h"
#include "tests/unit/render/read_png.h"
#include "tests/unit/render/synthetic_cabinet.h"

int main(int argc, char** argv) {
  using namespace topple::render;
  if (argc != 2) return 2;
  SceneFrame frame = synthetic_cabinet(6);
  add_words(frame);
  Picture picture(off_screen(), 640, 360);
  write_png(argv[1], picture.draw(frame, fit_camera(NamedView::iso, frame, picture.aspect())));
}
