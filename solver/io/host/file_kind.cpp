#include "solver/io/host/file_kind.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <string>

namespace topple::host {
namespace {

constexpr std::size_t k_head = 4096;

/// Commas outside of quotation marks.
std::ptrdiff_t commas(std::string_view line) {
  bool quoted = false;
  return std::ranges::count_if(line, [&](char c) {
    quoted ^= c == '"';
    return c == ',' && !quoted;
  });
}

bool is_table(std::string_view head) {
  const std::size_t end = std::min(head.find('\n'), head.size());
  const std::ptrdiff_t columns = commas(head.substr(0, end));
  if (columns == 0 || end + 1 >= head.size()) return columns > 0;
  const std::string_view rest = head.substr(end + 1);
  const std::size_t second = rest.find('\n');
  return second == std::string_view::npos || commas(rest.substr(0, second)) == columns;
}

FileKind markup_kind(std::string_view head) {
  std::string lower(head);
  std::ranges::transform(lower, lower.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto has = [&](const char* tag) { return lower.find(tag) != std::string::npos; };
  if (lower.starts_with("<!doctype html") || lower.starts_with("<html")) return FileKind::html;
  if (has("<vtkfile")) return FileKind::vtk;
  if (has("<xdmf")) return FileKind::xdmf;
  return has("<svg") ? FileKind::svg : FileKind::text;
}

bool is_binary(unsigned char c) {
  return (c < 0x20 &&
          std::string_view("\t\n\r\f\x1b").find(static_cast<char>(c)) == std::string_view::npos) ||
         c == 0x7f;
}

}  // namespace

FileKind kind_of_bytes(std::string_view head) {
  constexpr std::string_view k_byte_order_mark = "\xef\xbb\xbf";
  if (head.empty()) return FileKind::any;
  if (head.starts_with("\x89HDF\r\n\x1a\n")) return FileKind::hdf5;
  if (head.starts_with("\x89PNG\r\n\x1a\n")) return FileKind::png;
  if (head.starts_with("glTF")) return FileKind::gltf;
  if (head.size() >= 8 && head.substr(4, 4) == "ftyp") return FileKind::mp4;
  if (head.starts_with(k_byte_order_mark)) head.remove_prefix(k_byte_order_mark.size());
  head.remove_prefix(std::min(head.find_first_not_of(" \t\r\n"), head.size()));
  if (head.starts_with('<'))
    if (const FileKind kind = markup_kind(head); kind != FileKind::text) return kind;
  if (std::ranges::any_of(head, is_binary)) return FileKind::data;
  if (head.starts_with('{')) return FileKind::json;
  return is_table(head) ? FileKind::csv : FileKind::text;
}

FileKind kind_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return FileKind::data;
  std::string head(k_head, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  return file.bad() ? FileKind::data : kind_of_bytes(head);
}

std::string_view in_words(FileKind kind) {
  switch (kind) {
    case FileKind::any:
      return "nothing";
    case FileKind::hdf5:
      return "HDF5 data";
    case FileKind::png:
      return "a PNG picture";
    case FileKind::mp4:
      return "an MP4 video";
    case FileKind::svg:
      return "an SVG picture";
    case FileKind::html:
      return "an HTML page";
    case FileKind::xdmf:
      return "an XDMF file";
    case FileKind::vtk:
      return "a VTK file";
    case FileKind::gltf:
      return "a glTF file";
    case FileKind::json:
      return "JSON";
    case FileKind::csv:
      return "a CSV table";
    case FileKind::text:
      return "text";
    case FileKind::data:
      break;
  }
  return "data of another kind";
}

}  // namespace topple::host
