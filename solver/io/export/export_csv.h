// The tables of interface 4 from a recording and the model it was made with.
#pragma once

#include <string>

#include "solver/io/export/exported_values.h"
#include "solver/io/host/staged_file.h"
#include "solver/io/recording/recording.h"

namespace topple::io {

/// Writes bodies.csv, nodes.csv, elements.csv, floor.csv (interface 4), contacts.csv (contact_forces) and
/// energy.csv (EnergyLedger of the run), and anchors.csv where there are any, into `folder` (created when
/// missing), of the way to the newest branch. Each file appears whole or not at all; false, and none does,
/// when `proceed` gave it up. Throws WriteError, InputError.
bool export_csv(const Recording& recording, const host::Target& folder, const Proceed& proceed = {});

/// export_csv with the setup given. `node` and `element` count from 0 within the body and within the member;
/// numbers are the shortest that read back the same. Throws WriteError, InputError when the model is not that
/// of the rows.
bool write_csv(const Recording& recording, const Setup& setup, const host::Target& folder,
               const Proceed& proceed = {});

}  // namespace topple::io
