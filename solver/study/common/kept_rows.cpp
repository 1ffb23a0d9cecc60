#include "solver/study/common/kept_rows.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

namespace topple::study {
namespace {

using nlohmann::ordered_json;

std::runtime_error not_written(const std::string& path) {
  return std::runtime_error(path + ": cannot be written: " + std::strerror(errno));
}

/// What is different, in words: "ensemble: 64, now 16".
std::string difference(const ordered_json& kept, const ordered_json& now) {
  constexpr std::size_t k_longest = 60;
  for (const auto& [key, value] : now.items()) {
    const ordered_json before = kept.is_object() && kept.contains(key) ? kept[key] : ordered_json(nullptr);
    if (before == value) continue;
    const std::string a = before.dump(), b = value.dump();
    return key + (std::max(a.size(), b.size()) > k_longest ? " has changed" : ": " + a + ", now " + b);
  }
  return "it has other settings";
}

}  // namespace

KeptRows::KeptRows(std::string path, const ordered_json& settings, int cases, bool resume)
    : path_(std::move(path)), rows_(static_cast<std::size_t>(cases)) {
  file_ = open(path_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (file_ < 0) throw not_written(path_);
  try {
    if (flock(file_, LOCK_EX | LOCK_NB) != 0)
      throw io::InputError(path_ + ": is being written by another sweep");
    if (!resume && ftruncate(file_, 0) != 0) throw not_written(path_);
    if (lseek(file_, 0, SEEK_END) > 0) read(settings);
    if (lseek(file_, 0, SEEK_END) == 0) append(settings.dump());
  } catch (...) {
    close(file_);
    throw;
  }
}

KeptRows::~KeptRows() {
  close(file_);
}

int KeptRows::count() const {
  return static_cast<int>(std::ranges::count_if(rows_, [](const std::string& row) { return !row.empty(); }));
}

void KeptRows::read(const ordered_json& settings) {
  std::ifstream in(path_, std::ios::binary);
  const std::string text(std::istreambuf_iterator<char>(in), {});
  std::size_t begin = 0;
  for (int number = 1;; ++number) {
    const std::size_t end = text.find('\n', begin);
    if (end == std::string::npos) break;
    const ordered_json line =
        ordered_json::parse(text.begin() + static_cast<std::ptrdiff_t>(begin),
                            text.begin() + static_cast<std::ptrdiff_t>(end), nullptr, false);
    const auto damaged = [&] {
      return io::InputError(path_ + ":" + std::to_string(number) +
                            ": is damaged; without --resume the sweep begins anew");
    };
    if (!line.is_object()) throw damaged();
    if (number == 1) {
      if (line != settings)
        throw io::InputError("--resume: " + path_ + " was begun with other settings (" +
                             difference(line, settings) + "); without --resume the sweep begins anew");
    } else {
      const int k = line.contains("case") && line["case"].is_number_integer() ? line["case"].get<int>() : -1;
      if (k < 0 || k >= static_cast<int>(rows_.size()) || !line.contains("row")) throw damaged();
      rows_[static_cast<std::size_t>(k)] = line["row"].dump();
    }
    begin = end + 1;
  }
  if (ftruncate(file_, static_cast<off_t>(begin)) != 0) throw not_written(path_);
}

void KeptRows::append(const std::string& line) {
  const std::string whole = line + "\n";
  const off_t before = lseek(file_, 0, SEEK_END);
  const ssize_t written = write(file_, whole.data(), whole.size());
  if (written == static_cast<ssize_t>(whole.size())) return;
  if (written >= 0) errno = ENOSPC;
  const int cause = errno;
  if (ftruncate(file_, before) != 0) errno = cause;
  errno = cause;
  throw not_written(path_);
}

void KeptRows::add(int k, const std::string& row) {
  append("{\"case\":" + std::to_string(k) + ",\"row\":" + row + "}");
  rows_[static_cast<std::size_t>(k)] = row;
}

ordered_json fingerprints(const std::vector<io::SceneFile>& files) {
  ordered_json out = ordered_json::object();
  for (const io::SceneFile& file : files) {
    std::uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a
    for (const char c : file.bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    out[file.name] = hash;
  }
  return out;
}

}  // namespace topple::study
