// Accelerograms from text: PEER AT2, K-NET and KiK-net ASCII, CSV. The content tells which.
#pragma once

#include <string>
#include <string_view>

#include "solver/io/accelerogram/accelerogram_content.h"

namespace topple::io {

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
