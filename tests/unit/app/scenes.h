// Short scenes for the tests of the program.
#pragma once

#include <string>

namespace topple::app {

inline const std::string k_library = R"(
[[material]]
name = "steel"
young = "205 GPa"
poisson = 0.3
density = "7850 kg/m^3"
[[section]]
name = "post"
shape = "box"
size = ["30 mm", "30 mm"]
thickness = "1 mm"
)";

inline const std::string k_cabinet = R"(
[[cabinet]]
name = "free"
size = ["380 mm", "880 mm", "1790 mm"]
mass = "40 kg"
section = "post"
material = "steel"
base = "edges"
)";

/// A cabinet that is shaken for 0.3 s, with one probe.
inline const std::string k_shaken = R"(topple = 1
title = "A cabinet for tests"
[run]
duration = "0.3 s"
[[shake]]
name = "table"
frequency = "2 Hz"
amplitude = "400 gal"
[contact]
alpha = "50 kgf"
restitution = 0.5
[floor]
width = "90 mm"
)" + k_library + k_cabinet +
                                    R"(
[[probe]]
name = "middle"
body = "free"
)";

/// The same held by a strap that breaks at its first pull, and one that does not. Appended to k_shaken.
inline const std::string k_straps = R"(
[[anchor]]
name = "weak"
body = "free"
point = [-0.19, 0.44, 1.79]
to = [-0.19, 0.44, 2.2]
stiffness = "50 kN/m"
strength = "1 N"
[[anchor]]
name = "strong"
body = "free"
point = [-0.19, -0.44, 1.79]
to = [-0.19, -0.44, 2.2]
stiffness = "50 kN/m"
)";

/// A clamped beam under a load that central-difference cannot step at 1 ms.
inline const std::string k_beam = R"(topple = 1
[run]
duration = "0.1 s"
settle = false
gravity = [0, 0, 0]
)" + k_library + R"(
[[frame]]
name = "beam"
nodes = [[0, 0, 0], [1, 0, 0]]
members = [{ nodes = [0, 1], section = "post", material = "steel" }]
supports = [{ node = 0, fix = "xyzXYZ" }]
loads = [{ node = 1, force = [0, 0, "-100 N"] }]
)";

/// Shelves full of books, which bend more than 1 % of their critical angle, on a floor of 600 gal.
inline std::string shelves_of_books(int count) {
  std::string text =
      "topple = 1\n[run]\nduration = 0.02\nwant = [\"motion\"]\n[floor]\n[[shake]]\ntype = "
      "\"sine\"\nfrequency = 1\n"
      "amplitude = \"600 gal\"\n";
  for (int k = 0; k < count; ++k)
    text +=
        "[[furniture]]\nname = \"shelf-" + std::to_string(k) +
        "\"\nkind = \"bookshelf\"\nsize = [0.35, 0.9, 2.1]\nmass = 40\ncontents = { mass = 400 }\nat = [0, " +
        std::to_string(2 * k) + "]\n";
  return text;
}

}  // namespace topple::app
