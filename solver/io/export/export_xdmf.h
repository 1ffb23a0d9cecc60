// A recording for ParaView: XDMF (XML) beside HDF5.
#pragma once

#include <string>

#include "solver/io/export/exported_values.h"
#include "solver/io/host/staged_file.h"
#include "solver/io/recording/recording.h"

namespace topple::io {

/// Writes the way to the newest branch: the frames into FILE.h5, one data set a field and frame
/// ("stress_Pa/000042"), and `target`, XDMF that refers to it by its name. Lines are the elements between
/// nodes, where the nodes are; fields are those of each_field() (exported_values.h), and on elements the
/// numbers of body and member. Both files appear whole or not at all; false, and
/// neither does, when `proceed` gave it up. Throws WriteError, InputError.
bool export_xdmf(const Recording& recording, const host::Target& target, const Proceed& proceed = {});

}  // namespace topple::io
