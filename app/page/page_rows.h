// Rows of a run as bytes, for the live page: what it shows of them, no more.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "solver/io/recording/frame_row.h"
#include "solver/model/excitation.h"
#include "solver/model/model.h"

namespace topple::app {

/// Of all rows of a page. A run of more has every second row in it, or third, and so on, and the last.
inline constexpr std::size_t k_most_page_bytes = std::size_t{4} << 20;

/// Bytes of a row of this model.
std::size_t packed_size(const Model& model);

/// Every how many of `rows` rows of this model go into a page.
std::size_t page_stride(const Model& model, std::size_t rows);

/// Little-endian numbers without padding, row after row: of the time, floor and bodies double, of nodes,
/// section forces and anchors single precision. Contact forces and energies are left out.
std::string pack_rows(const std::vector<io::FrameRow>& rows);

/// The inverse; what was left out is zero, and FrameRow::knows_contacts false. Throws io::InputError where
/// the bytes are no rows of this model.
std::vector<io::FrameRow> unpack_rows(const Model& model, std::string_view bytes);

/// Acceleration of the floor in a row along the first of `shakes`, m/s^2; 0 without shakes.
double floor_along(const io::FrameRow& row, const std::vector<Shake>& shakes);
/// The greatest while the rows last: between them too, where they show the motion of the shakes as these are.
double floor_peak(const std::vector<io::FrameRow>& rows, const std::vector<Shake>& shakes);
/// Up to which its curve is drawn: the peak, or what makes a flat line of a floor that hardly moves, m/s^2.
double floor_scale(const std::vector<io::FrameRow>& rows, const std::vector<Shake>& shakes);

}  // namespace topple::app
