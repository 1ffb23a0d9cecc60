// Edits of a running simulation as Python writes them.
#pragma once

#include <string>

#include "solver/model/parameters.h"
#include "solver/run/edit.h"

namespace topple::python {

/// `key` as of io::edit_key, `value` as of --set: "150 gal", "newmark", "[1, 0, 0]". An edit that can be
/// applied. Throws io::InputError.
Edit read_edit(const std::string& key, const std::string& value, const Parameters& parameters,
               const Model& model);

}  // namespace topple::python
