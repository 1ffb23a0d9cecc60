// What a file of an accelerogram holds, and what of it is accepted.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace topple::io {

inline constexpr double k_most_samples = 1e7;        ///< of one component
inline constexpr double k_shortest_interval = 1e-5;  ///< s between samples
inline constexpr double k_longest_interval = 1;      ///< s
inline constexpr double k_highest_peak = 5;          ///< g; above it the unit is taken to be wrong

/// Units of samples that scenes and files may name.
inline constexpr std::string_view k_sample_units[] = {"g", "gal", "m/s^2", "cm/s^2"};

/// Components that were sampled together.
struct AccelerogramFile {
  enum class Format { at2, knet, csv };
  Format format = Format::at2;
  double interval = 0;                          ///< s between samples
  std::vector<std::vector<double>> components;  ///< m/s^2, two samples or more; csv: one to three, else one
};

/// What the scene says of a file.
struct AccelerogramNotes {
  std::string unit;                ///< symbol of an acceleration; empty: the file has to tell
  std::optional<double> interval;  ///< s, of a csv without a column of times
};

}  // namespace topple::io
