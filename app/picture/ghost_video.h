// Two motions in one picture on one clock.
#pragma once

#include <optional>
#include <string>

#include "app/picture/replay.h"
#include "solver/io/host/staged_file.h"
#include "solver/io/scene/scene.h"

namespace topple::app {

/// One of the two motions. What it refers to must outlive the drawing.
struct NamedReplay {
  std::string name;  ///< what the picture calls it: the file, or the scene's name
  const io::Scene& scene;
  const Replay& replay;
};

/// Writes a video of 1280 x 720 and 30 pictures a second, seen from the floor: A solid and blue, B
/// translucent and grey, both named, from `from` to `to`, s; absent: until the longer one ends. Returns an
/// exit code (errors.h); says why when Ctrl+C came. Throws BadInput where neither has a row between, and
/// std::runtime_error.
int draw_ghost_video(const host::Target& target, const NamedReplay& a, const NamedReplay& b,
                     std::optional<double> from, std::optional<double> to, bool quiet);

}  // namespace topple::app
