// How recordings are read from disk.
#pragma once

#include <hdf5.h>

namespace topple::io {

/// Makes files opened with `access` go through a plain read-only driver in place of HDF5's own. HDF5 lets all
/// opens of one file within a process share their caches, by comparing devices and inodes. Then a reader
/// beside the writer sees what is not on disk, a reader after a failed write gets the writer's broken state,
/// and two readers of a growing file cannot refresh. With this driver every open stands alone. It takes no
/// file locks. Throws Hdf5Error.
void use_read_driver(hid_t access);

}  // namespace topple::io
