#include "solver/io/host/file_kind.h"

#include <gtest/gtest.h>

#include "tests/unit/render/scratch.h"

namespace topple::host {
namespace {

using render::Scratch;

TEST(FileKinds, first_bytes_tell_what_a_file_holds) {
  const std::pair<std::string, FileKind> heads[] = {
      {"", FileKind::any},
      {"\x89HDF\r\n\x1a\n...", FileKind::hdf5},
      {"\x89PNG\r\n\x1a\n...", FileKind::png},
      {std::string("\0\0\0\x20", 4) + "ftypisom", FileKind::mp4},
      {"<?xml version=\"1.0\"?>\n<!DOCTYPE svg PUBLIC>\n<svg width=\"9\">", FileKind::svg},
      {"\n<!DOCTYPE html>\n<html><svg/>", FileKind::html},
      {"<?xml version=\"1.0\"?>\n<!DOCTYPE Xdmf SYSTEM \"Xdmf.dtd\" []>\n<Xdmf>", FileKind::xdmf},
      {"<?xml version=\"1.0\"?>\n<VTKFile>_" + std::string(8, '\0'), FileKind::vtk},
      {std::string("glTF\2\0\0\0", 8), FileKind::gltf},
      {"{\n  \"topple\": 1}", FileKind::json},
      {"time_s,body\n0,a\n", FileKind::csv},
      {"time_s,body\n", FileKind::csv},
      {"time_s,body\n0,\"a, b\"\n", FileKind::csv},
      {"\xef\xbb\xbftime_s,body\n0,a\n", FileKind::csv},
      {"Dear all,\nthis is no table.\n", FileKind::text},
      {"[floor]\nfriction = 0.5\n", FileKind::text},
      {"<p>a, b</p>\nand more\n", FileKind::text},
      {"caf\xc3\xa9\n", FileKind::text},
      {std::string("\x7f"
                   "ELF\0\1",
                   6),
       FileKind::data},
      {std::string("a,b\0c", 5), FileKind::data}};
  for (const auto& [head, kind] : heads) EXPECT_EQ(kind_of_bytes(head), kind) << head;
}

TEST(FileKinds, a_link_is_what_it_leads_to) {
  const Scratch scratch;
  std::ofstream(scratch / "a.json") << "{}";
  std::filesystem::create_symlink("a.json", scratch / "link");
  EXPECT_EQ(kind_of(scratch / "link"), FileKind::json);
}

TEST(FileKinds, a_file_that_cannot_be_read_is_data) {
  const Scratch scratch;
  EXPECT_EQ(kind_of(scratch / "none"), FileKind::data);
}

}  // namespace
}  // namespace topple::host
