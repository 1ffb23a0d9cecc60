// Small scenes for the tests of the reader.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "solver/io/scene/scene.h"

namespace topple::io {

/// Line 1 of every sample; the parts below follow it.
inline const std::string k_head = "topple = 1\n";

inline const std::string k_library =
    "[[material]]\n"
    "name = \"steel\"\n"
    "young = \"205 GPa\"\n"
    "poisson = 0.3\n"
    "density = \"7850 kg/m^3\"\n"
    "[[section]]\n"
    "name = \"post\"\n"
    "shape = \"box\"\n"
    "size = [\"30 mm\", \"30 mm\"]\n"
    "thickness = \"1 mm\"\n";

inline const std::string k_beam =
    "[[frame]]\n"
    "name = \"beam\"\n"
    "nodes = [[0, 0, 0], [1, 0, 0]]\n"
    "members = [{ nodes = [0, 1], section = \"post\", material = \"steel\" }]\n"
    "supports = [{ node = 0, fix = \"xyzXYZ\" }]\n";

inline const std::string k_cabinet =
    "[[cabinet]]\n"
    "name = \"free\"\n"
    "section = \"post\"\n"
    "material = \"steel\"\n";

/// A beam, 16 lines; what is appended begins in line 17.
inline const std::string k_scene = k_head + k_library + k_beam;

/// A cabinet, 15 lines; what is appended belongs to it and begins in line 16.
inline const std::string k_cabinet_scene = k_head + k_library + k_cabinet;

/// The error of a scene, or "no error".
inline std::string error_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    parse_scene(text, "s.toml", overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

/// The error of line 17 and on of a scene with a beam.
inline std::string after_beam(const std::string& lines) {
  return error_of(k_scene + lines);
}

/// The error of line 16 and on of a scene with a cabinet, within it.
inline std::string in_cabinet(const std::string& lines) {
  return error_of(k_cabinet_scene + lines);
}

/// `text` with `to` in place of `from`, which must be there.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

}  // namespace topple::io
