#include "solver/io/scene/scene_file.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>

#include "solver/io/builtin/builtin.h"
#include "solver/math/ranges.h"

namespace topple::io {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t k_most_bytes = 256u << 20;

std::string known_records() {
  std::string names;
  for (const BuiltinScene& record : builtin_records())
    names += (names.empty() ? "" : ", ") + std::string(record.name);
  return names;
}

std::string read_whole_file(const std::string& path) {
  std::error_code status;
  if (!fs::exists(path, status)) throw InputError(path + ": no such file");
  if (fs::is_directory(path, status)) throw InputError(path + ": is a folder");
  if (!fs::is_regular_file(path, status)) throw InputError(path + ": is not a regular file");
  if (const auto size = fs::file_size(path, status); !status && size > k_most_bytes)
    throw InputError(path + ": has " + std::to_string(size >> 20) + " MiB; more than " +
                     std::to_string(k_most_bytes >> 20) + " MiB are not read");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(path + ": cannot be opened");
  std::string bytes(std::istreambuf_iterator<char>(file), {});
  if (file.bad()) throw InputError(path + ": cannot be read");
  return bytes;
}

std::optional<std::string> builtin_record(const std::string& name) {
  for (const BuiltinScene& record : builtin_records())
    if (record.name == name) return std::string(record.text);
  return std::nullopt;
}

}  // namespace

ReadSceneFile files_beside(const std::string& origin) {
  return [folder = fs::path(origin).parent_path()](const std::string& name) {
    const std::string path = (folder / name).string();
    std::error_code status;
    if (!fs::exists(path, status)) {
      if (std::optional<std::string> record = builtin_record(name)) return *std::move(record);
      throw InputError(path + ": no such file" +
                       (name.ends_with(".toml") ? "" : "; built-in records: " + known_records()));
    }
    return read_whole_file(path);
  };
}

ReadSceneFile builtin_files() {
  return [](const std::string& name) {
    if (std::optional<std::string> record = builtin_record(name)) return *std::move(record);
    return files_beside("")(name);
  };
}

ReadSceneFile kept_files(const Scene& scene) {
  return [&scene](const std::string& name) {
    for (const SceneFile& file : scene.files)
      if (file.name == name) return file.bytes;
    throw InputError(name + ": is not among the files of the scene");
  };
}

const std::string& bytes_of(const std::string& name, const ReadSceneFile& read,
                            std::vector<SceneFile>& files) {
  auto file = ranges::find(files, name, &SceneFile::name);
  if (file == files.end()) file = files.insert(files.end(), {name, read(name)});
  return file->bytes;
}

}  // namespace topple::io
