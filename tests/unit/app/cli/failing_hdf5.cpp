// Preloaded into a program: the HDF5 library opens no file. TOPPLE_HDF5_FAULT says what it does in place of
// that: crash, loop, or ask for memory.
#include <hdf5.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <cstring>

extern "C" hid_t H5Fopen(const char*, unsigned, hid_t) {
  const char* const fault = std::getenv("TOPPLE_HDF5_FAULT");
  if (!fault) std::abort();
  if (std::strcmp(fault, "crash") == 0) std::raise(SIGSEGV);
  if (std::strcmp(fault, "loop") == 0)
    for (std::atomic<unsigned> turns{0};; ++turns) {
    }
  constexpr int most_blocks = 128;
  static void* volatile kept;  // or the compiler would leave the allocations out
  for (int i = 0; i < most_blocks; ++i) {
    kept = std::malloc(std::size_t{1} << 26);
    if (kept == nullptr) break;
  }
  return -1;
}
