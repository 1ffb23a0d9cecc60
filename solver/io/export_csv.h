// The tables of interface 4 from a recording and the model it was made with.
#pragma once

#include <string>

#include "solver/io/recording.h"

namespace topple::io {

/// export_csv with the model given. `node` and `element` count from 0 within the body and within the member;
/// numbers are the shortest that read back the same. Throws WriteError, InputError when the model is not that
/// of the rows.
void write_csv(const Recording& recording, const Model& model, const std::string& folder);

}  // namespace topple::io
