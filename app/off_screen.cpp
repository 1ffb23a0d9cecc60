#include "app/off_screen.h"

#include <string>

#include "app/log.h"

namespace topple::app {

std::unique_ptr<render::Context> open_off_screen(render::Renderer renderer, bool say_note) {
  std::string note;
  std::unique_ptr<render::Context> context = render::make_off_screen_context(renderer, note);
  if (say_note && !note.empty()) say(note);
  return context;
}

}  // namespace topple::app
