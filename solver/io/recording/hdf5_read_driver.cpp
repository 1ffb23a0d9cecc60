#include "solver/io/recording/hdf5_read_driver.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <limits>
#include <new>

#include "solver/io/recording/hdf5_handle.h"

namespace topple::io {
namespace {

constexpr haddr_t k_last_address = static_cast<haddr_t>(std::numeric_limits<off_t>::max());

#ifdef H5FD_CLASS_VERSION
// Known to this program alone.
constexpr H5FD_class_value_t k_driver_value = H5_VFD_RESERVED + 144;
#endif

struct ReadFile {
  H5FD_t common;  ///< HDF5's part, first
  int descriptor;
  haddr_t allocated;
};
ReadFile* mine(H5FD_t* file) {
  return reinterpret_cast<ReadFile*>(file);
}
const ReadFile* mine(const H5FD_t* file) {
  return reinterpret_cast<const ReadFile*>(file);
}

H5FD_t* open_file(const char* name, unsigned flags, hid_t, haddr_t) {
  if ((flags & (H5F_ACC_RDWR | H5F_ACC_TRUNC | H5F_ACC_CREAT)) != 0) return nullptr;
  const int descriptor = ::open(name, O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return nullptr;
  auto* file = new (std::nothrow) ReadFile{};
  if (file == nullptr) {
    ::close(descriptor);
    return nullptr;
  }
  file->descriptor = descriptor;
  return &file->common;
}

herr_t close_file(H5FD_t* file) {
  ::close(mine(file)->descriptor);
  delete mine(file);
  return 0;
}

herr_t query(const H5FD_t*, unsigned long* flags) {
  *flags = H5FD_FEAT_DATA_SIEVE | H5FD_FEAT_SUPPORTS_SWMR_IO | H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
  return 0;
}

haddr_t allocated(const H5FD_t* file, H5FD_mem_t) {
  return mine(file)->allocated;
}

herr_t set_allocated(H5FD_t* file, H5FD_mem_t, haddr_t address) {
  mine(file)->allocated = address;
  return 0;
}

haddr_t size(const H5FD_t* file, H5FD_mem_t) {
  struct stat status;
  return fstat(mine(file)->descriptor, &status) == 0 ? static_cast<haddr_t>(status.st_size) : HADDR_UNDEF;
}

// What lies behind the end reads as zeros, as with HDF5's own driver: blocks are allocated before they are
// written.
herr_t read_bytes(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t address, size_t count, void* to) {
  auto* bytes = static_cast<char*>(to);
  while (count > 0) {
    const ssize_t got = pread(mine(file)->descriptor, bytes, count, static_cast<off_t>(address));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return -1;
    if (got == 0) break;
    bytes += got;
    count -= static_cast<size_t>(got);
    address += static_cast<haddr_t>(got);
  }
  std::memset(bytes, 0, count);
  return 0;
}

herr_t write_bytes(H5FD_t*, H5FD_mem_t, hid_t, haddr_t, size_t, const void*) {
  return -1;
}

H5FD_class_t driver_class() {
  H5FD_class_t driver{};   // without `cmp`, no two opens are the same file
#ifdef H5FD_CLASS_VERSION  // from HDF5 1.14 on
  driver.version = H5FD_CLASS_VERSION;
  driver.value = k_driver_value;
#endif
  driver.name = "topple-read";
  driver.maxaddr = k_last_address;
  driver.fc_degree = H5F_CLOSE_STRONG;
  driver.open = open_file;
  driver.close = close_file;
  driver.query = query;
  driver.get_eoa = allocated;
  driver.set_eoa = set_allocated;
  driver.get_eof = size;
  driver.read = read_bytes;
  driver.write = write_bytes;
  constexpr H5FD_mem_t kinds[H5FD_MEM_NTYPES] = H5FD_FLMAP_DICHOTOMY;
  std::memcpy(driver.fl_map, kinds, sizeof kinds);
  return driver;
}

}  // namespace

void use_read_driver(hid_t access) {
  static const H5FD_class_t driver = driver_class();
  static const hid_t id = checked(H5FDregister(&driver));
  checked(H5Pset_driver(access, id, nullptr));
}

}  // namespace topple::io
