#pragma once

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

namespace topple::bench {

inline void write(const std::filesystem::path& path, const std::string& content) {
  std::ofstream file(path, std::ios::binary);
  file << content;
  if (!file.flush()) throw std::runtime_error(path.string() + ": cannot be written");
}

}  // namespace topple::bench
