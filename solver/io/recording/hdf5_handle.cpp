#include "solver/io/recording/hdf5_handle.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace topple::io {
namespace {

herr_t keep_innermost(unsigned, const H5E_error2_t* error, void* text) {
  if (error->desc != nullptr && *error->desc != '\0') *static_cast<std::string*>(text) = error->desc;
  return 0;
}

static_assert(std::endian::native == std::endian::little);

// Row k: the remainder of a byte with k bytes of zeros after it.
constexpr auto k_remainders = [] {
  std::array<std::array<std::uint32_t, 256>, 8> rows{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t crc = byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ (crc & 1 ? 0x82f63b78 : 0);
    rows[0][byte] = crc;
  }
  for (std::size_t k = 1; k < 8; ++k)
    for (std::size_t byte = 0; byte < 256; ++byte)
      rows[k][byte] = (rows[k - 1][byte] >> 8) ^ rows[0][rows[k - 1][byte] & 255];
  return rows;
}();

}  // namespace

std::string hdf5_cause() {
  std::string text;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, keep_innermost, &text);
  H5Eclear2(H5E_DEFAULT);
  // HDF5 writes a whole line of numbers around what the system said.
  constexpr std::string_view before = "error message = '";
  if (const auto begin = text.find(before); begin != std::string::npos) {
    const auto first = begin + before.size();
    text = text.substr(first, text.find('\'', first) - first);
  }
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text.empty() ? "HDF5 gave no reason" : text;
}

QuietHdf5::QuietHdf5() {
  [[maybe_unused]] static const herr_t once = H5dont_atexit();
  H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

QuietHdf5::~QuietHdf5() {
  H5Eset_auto2(H5E_DEFAULT, function_, data_);
}

std::uint32_t crc32c(std::span<const std::byte> bytes, std::uint32_t before) {
  std::uint32_t crc = ~before;
  std::size_t i = 0;
  for (; i + 8 <= bytes.size(); i += 8) {  // eight at a time
    std::uint64_t word;
    std::memcpy(&word, bytes.data() + i, 8);
    word ^= crc;
    crc = 0;
    for (int k = 0; k < 8; ++k) crc ^= k_remainders[7 - k][(word >> (8 * k)) & 255];
  }
  for (; i < bytes.size(); ++i)
    crc = (crc >> 8) ^ k_remainders[0][(crc ^ std::to_integer<std::uint8_t>(bytes[i])) & 255];
  return ~crc;
}

Handle text_type(std::size_t length) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  checked(H5Tset_size(type, std::max<std::size_t>(length, 1)));
  checked(H5Tset_strpad(type, H5T_STR_NULLPAD));
  return type;
}

void write_attribute(hid_t object, const char* name, std::string_view text) {
  const std::string padded = text.empty() ? std::string(1, '\0') : std::string(text);
  const Handle type = text_type(padded.size());
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  checked(H5Awrite(attribute, type, padded.data()));
}

void write_attribute(hid_t object, const char* name, std::int32_t number) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute(H5Acreate2(object, name, H5T_STD_I32LE, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  checked(H5Awrite(attribute, H5T_NATIVE_INT32, &number));
}

bool has_attribute(hid_t object, const char* name) {
  return checked(H5Aexists(object, name)) > 0;
}

std::string read_text_attribute(hid_t object, const char* name) {
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  const Handle type(H5Aget_type(attribute), H5Tclose);
  const Handle space(H5Aget_space(attribute), H5Sclose);
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0 ||
      H5Sget_simple_extent_npoints(space) != 1) {
    throw Hdf5Error(std::string("attribute ") + name + " is not a text of fixed length");
  }
  std::string text(H5Tget_size(type), '\0');
  checked(H5Aread(attribute, type, text.data()));
  return text.substr(0, text.find('\0'));
}

std::int32_t read_int_attribute(hid_t object, const char* name) {
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  const Handle space(H5Aget_space(attribute), H5Sclose);
  if (H5Sget_simple_extent_npoints(space) != 1)
    throw Hdf5Error(std::string("attribute ") + name + " is not a number");
  std::int32_t number = 0;
  checked(H5Aread(attribute, H5T_NATIVE_INT32, &number));
  return number;
}

Handle unbuffered_access() {
  Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  checked(H5Pset_sieve_buf_size(access, 0));
  return access;
}

void write_fixed(hid_t group, const char* name, hid_t type, const std::vector<hsize_t>& dims,
                 const void* data, std::string_view units, std::string_view columns) {
  const Handle space(H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr), H5Sclose);
  const Handle set(H5Dcreate2(group, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
  std::size_t bytes = H5Tget_size(type);
  for (const hsize_t dim : dims) bytes *= dim;
  if (bytes > 0) checked(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data));
  const std::uint32_t crc = crc32c({static_cast<const std::byte*>(data), bytes});
  write_attribute(set, "crc32c", static_cast<std::int32_t>(crc));
  if (!units.empty()) write_attribute(set, "units", units);
  if (!columns.empty()) write_attribute(set, "columns", columns);
}

std::vector<std::byte> read_fixed(hid_t group, const char* name) {
  const Handle set(H5Dopen2(group, name, H5P_DEFAULT), H5Dclose);
  const Handle type(H5Dget_type(set), H5Tclose);
  const Handle space(H5Dget_space(set), H5Sclose);
  const auto count = static_cast<std::size_t>(checked(H5Sget_simple_extent_npoints(space)));
  std::vector<std::byte> bytes(count * H5Tget_size(type));
  if (!bytes.empty()) checked(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()));
  if (crc32c(bytes) != static_cast<std::uint32_t>(read_int_attribute(set, "crc32c"))) {
    throw Hdf5Error(std::string(name) + " is damaged (checksum differs)");
  }
  return bytes;
}

}  // namespace topple::io
