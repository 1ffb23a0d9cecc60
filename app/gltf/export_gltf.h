// A recording as an animated model: glTF, for 3D viewers and Blender.
#pragma once

#include "solver/io/export/exported_values.h"
#include "solver/io/host/staged_file.h"
#include "solver/io/recording/recording.h"

namespace topple::app {

/// Writes the way to the newest branch as a binary glTF 2.0 file: m, s, y up. The floor and each body are
/// nodes that move as pictures show them; members of a body that deforms are skinned to its nodes, the
/// joints. Members are coloured by stress as in pictures, at their colour places (run_motion.h), by morph
/// targets of COLOR_0, a channel each; without morphing of colours they have that of their greatest stress.
/// Keys are left out where interpolation stays within 0.1 mm along each axis, 0.1 mrad and 1/500 of a colour
/// channel. Of a run so long that its tracks would take more than k_most_row_bytes (thinning.h), every second
/// row is taken, or third, and so on, and the last. Rows that are not finite are left out. The file appears
/// whole or not at all; false, and it does not, when `proceed` gave it up. Throws WriteError, and InputError
/// when no row can be drawn.
bool export_gltf(const io::Recording& recording, const host::Target& target, const io::Proceed& proceed = {});

}  // namespace topple::app
