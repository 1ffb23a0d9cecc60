// Accelerograms from text: PEER AT2, K-NET and KiK-net ASCII, CSV. The content tells which.
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

/// Reads
/// - PEER AT2: two lines of text, "ACCELERATION TIME SERIES IN UNITS OF G", a line with NPTS and DT in one
///   of the forms `NPTS= 4000, DT= .01000 SEC` and `3930 0.00500 NPTS, DT`, then the samples;
/// - K-NET and KiK-net ASCII (www.kyoshin.bosai.go.jp/kyoshin/man/knetform_en.html): 17 header lines, then
///   counts. The mean is removed, as `Max. Acc.` of the header has it, which the data must give;
/// - CSV (comma, semicolon or tab; lines that begin with # are skipped): a header that names the columns with
///   their units, `time_s,ax_gal` or `time (s),ax (m/s^2)`, and a row for each sample. Times go up in equal
///   steps (to a fifth of a step); the first one counts as 0.
/// Throws InputError "NAME:LINE: KEY: what was found, what is allowed" for what is none of these, and for
/// units that cannot be, gaps, wrong counts and more than k_most_samples.
AccelerogramFile read_accelerogram(std::string_view bytes, const std::string& name,
                                   const AccelerogramNotes& notes);

}  // namespace topple::io
