// A recording for ParaView and whatever else reads VTK: a file a frame.
#pragma once

#include <string>

#include "solver/io/export/exported_values.h"
#include "solver/io/host/staged_file.h"
#include "solver/io/recording/recording.h"

namespace topple::io {

/// Writes the way to the newest branch into an existing folder: frame-000000.vtp and so on (VTK's XML with
/// raw binary data), and frames.pvd, which gives each its time. Lines are the elements between nodes, where
/// the nodes are; fields are those of each_field() (exported_values.h), and on elements the numbers of body
/// and member. They all appear whole or not at all; false, and
/// none does, when `proceed` gave it up. Throws WriteError, InputError.
bool export_vtk(const Recording& recording, const host::Target& folder, const Proceed& proceed = {});

}  // namespace topple::io
