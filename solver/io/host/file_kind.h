// What files hold, by their first bytes.
#pragma once

#include <filesystem>
#include <string_view>

namespace topple::host {

enum class FileKind {
  any,  ///< an empty file; to be written: whatever is there
  hdf5,
  png,
  mp4,
  svg,
  html,
  xdmf,
  vtk,
  gltf,  ///< binary
  json,  ///< an object
  csv,   ///< as many commas in the second line as in the first, one at least
  text,  ///< none of these
  data   ///< neither these nor text
};

/// Of a file that begins with `head`.
FileKind kind_of_bytes(std::string_view head);

/// Of the file that is or that a link leads to; `data` when it cannot be read.
FileKind kind_of(const std::filesystem::path& path);

/// "a PNG picture".
std::string_view in_words(FileKind kind);

}  // namespace topple::host
