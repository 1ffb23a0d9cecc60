// Recordings that may come from anywhere.
#pragma once

#include <string>
#include <string_view>

#include "solver/io/recording/recording.h"

namespace topple::app {

/// Opens a recording after a process of its own has read every row of it, within limits: memory of 1 GiB and
/// four times the file, processor time of 10 s and 1 s for each 10 MB. A file that brings the HDF5 library to
/// a crash, an endless loop or a demand for all memory ends that process alone. Throws io::InputError with
/// one line. `program`: this one, to be started as that process.
io::Recording open_foreign_recording(const std::string& path, const std::string& program = "/proc/self/exe");

/// First argument of the program when it is that process; the second is the path.
inline constexpr std::string_view k_read_apart = "--read-apart";

/// What that process does. Exit code.
int read_apart(const std::string& path);

}  // namespace topple::app
