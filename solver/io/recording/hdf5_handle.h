// The few things that all HDF5 code here shares: handles that close themselves, errors, and silence.
#pragma once

#include <hdf5.h>

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace topple::io {

/// A call of the HDF5 library failed; what() is its innermost cause, without a file name.
struct Hdf5Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Innermost cause on the calling thread's HDF5 error stack: the system's message where there is one
/// ("No space left on device"), else HDF5's own.
std::string hdf5_cause();

/// Passes a result of the library on. Throws Hdf5Error when it is negative.
template <typename T>
T checked(T result) {
  if (result < 0) throw Hdf5Error(hdf5_cause());
  return result;
}

/// While it lives, HDF5 prints nothing on this thread; what was set before comes back afterwards. The first
/// one in a process, before any other use of HDF5, also keeps HDF5 from working on files that are still open
/// at exit: a file whose writing failed, or that was damaged, could bring that to a crash. Files are closed
/// by their owners.
class QuietHdf5 {
 public:
  QuietHdf5();
  ~QuietHdf5();
  QuietHdf5(const QuietHdf5&) = delete;
  QuietHdf5& operator=(const QuietHdf5&) = delete;

 private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

/// Owner of one HDF5 identifier.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle() = default;
  /// Throws Hdf5Error when `id` is negative, that is, when the call that made it failed.
  Handle(hid_t id, Close close) : id_(checked(id)), close_(close) {}
  ~Handle() { reset(); }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  /// Closes; negative on failure, and closed all the same as far as this program goes.
  herr_t reset() {
    const hid_t id = std::exchange(id_, H5I_INVALID_HID);
    return id < 0 ? 0 : close_(id);
  }
  /// Gives the identifier up without closing it.
  void release() { id_ = H5I_INVALID_HID; }
  operator hid_t() const { return id_; }

 private:
  hid_t id_ = H5I_INVALID_HID;
  Close close_ = nullptr;
};

/// How files are made: data go to the file when they are written. Small data sets would wait until they are
/// closed, where a write that fails is not told.
Handle unbuffered_access();

/// CRC-32C (Castagnoli, as in iSCSI) of `bytes`, continuing from `before`.
std::uint32_t crc32c(std::span<const std::byte> bytes, std::uint32_t before = 0);

/// Fixed-length string type, NUL-padded, of at least one byte.
Handle text_type(std::size_t length);

/// Attributes of an object. The string has a fixed length, as SWMR asks for.
void write_attribute(hid_t object, const char* name, std::string_view text);
void write_attribute(hid_t object, const char* name, std::int32_t number);
bool has_attribute(hid_t object, const char* name);
std::string read_text_attribute(hid_t object, const char* name);
std::int32_t read_int_attribute(hid_t object, const char* name);

/// Writes a data set of fixed size with its checksum as attribute "crc32c". `type`: in memory and in the
/// file.
void write_fixed(hid_t group, const char* name, hid_t type, const std::vector<hsize_t>& dims,
                 const void* data, std::string_view units = {}, std::string_view columns = {});

/// Bytes of a data set written by write_fixed. Throws Hdf5Error when they do not have their checksum.
std::vector<std::byte> read_fixed(hid_t group, const char* name);

}  // namespace topple::io
