// Gives a harness every file of the folders and files that are named, every beginning of the small ones, and
// these with one byte changed.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "fuzz.h"

namespace {

namespace fs = std::filesystem;

constexpr std::size_t k_small = 300;  // bytes

void try_bytes(const std::string& bytes) {
  LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
}

void try_file(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  try_bytes(bytes);
  if (bytes.size() > k_small) return;
  for (std::size_t size = 0; size < bytes.size(); ++size) try_bytes(bytes.substr(0, size));
  for (std::size_t k = 0; k < bytes.size(); ++k)
    for (int bit = 0; bit < 8; ++bit) {
      std::string changed = bytes;
      changed[k] = static_cast<char>(changed[k] ^ (1 << bit));
      try_bytes(changed);
    }
}

}  // namespace

int main(int argc, char** argv) {
  int files = 0;
  for (int i = 1; i < argc; ++i) {
    if (!fs::is_directory(argv[i])) {
      try_file(argv[i]);
      ++files;
      continue;
    }
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(argv[i]))
      if (entry.is_regular_file()) {
        try_file(entry.path());
        ++files;
      }
  }
  std::printf("%d files\n", files);
  return files > 0 ? 0 : 1;
}
