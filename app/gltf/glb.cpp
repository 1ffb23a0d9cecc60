#include "app/gltf/glb.h"

#include <algorithm>
#include <bit>

#include "solver/io/host/errors.h"

namespace topple::app {
namespace {

static_assert(std::endian::native == std::endian::little);

void append_word(std::string& to, std::size_t word) {
  for (int shift = 0; shift < 32; shift += 8) to += static_cast<char>(word >> shift & 0xff);
}

void pad(std::string& bytes, char with) {
  bytes.resize((bytes.size() + 3) / 4 * 4, with);
}

}  // namespace

std::size_t Glb::columns_of(std::string_view type) {
  return type == "SCALAR" ? 1 : type == "VEC2" ? 2 : type == "VEC3" ? 3 : type == "VEC4" ? 4 : 16;
}

std::size_t Glb::add(const char* list, Json entry) {
  json[list].push_back(std::move(entry));
  return json[list].size() - 1;
}

std::size_t Glb::store(GlbUse use, std::size_t stride, std::string_view bytes, Json entry) {
  if (use != GlbUse::vertices) stride = 0;
  const auto [known, is_new] = stored_.try_emplace(
      std::to_string(static_cast<int>(use)) + entry.dump() + std::string(bytes), json["accessors"].size());
  if (!is_new) return known->second;
  const auto view =
      std::ranges::find_if(views_, [&](const View& v) { return v.use == use && v.stride == stride; });
  const auto number = view - views_.begin();
  if (view == views_.end()) views_.push_back({use, stride, {}});
  std::string& to = views_[static_cast<std::size_t>(number)].bytes;
  entry["bufferView"] = number;
  entry["byteOffset"] = to.size();
  to += bytes;
  pad(to, '\0');
  return add("accessors", std::move(entry));
}

std::size_t Glb::zero_vectors(std::size_t count) {
  const std::vector<float> zero(3, 0);
  Json entry = {{"componentType", component_type<float>()}, {"count", count}, {"type", "VEC3"}};
  entry["min"] = entry["max"] = zero;
  const auto [known, is_new] = stored_.try_emplace(entry.dump(), json["accessors"].size());
  return is_new ? add("accessors", std::move(entry)) : known->second;
}

std::string Glb::bytes() const {
  constexpr int k_array_buffer = 34962, k_element_array_buffer = 34963;
  Json whole = json;
  std::string data;
  for (const View& view : views_) {
    Json entry = {{"buffer", 0}, {"byteOffset", data.size()}, {"byteLength", view.bytes.size()}};
    if (view.stride > 0) entry["byteStride"] = view.stride;
    if (view.use == GlbUse::vertices) entry["target"] = k_array_buffer;
    if (view.use == GlbUse::indices) entry["target"] = k_element_array_buffer;
    whole["bufferViews"].push_back(std::move(entry));
    data += view.bytes;
  }
  whole["buffers"] = Json::array({{{"byteLength", data.size()}}});
  std::string text = whole.dump(-1, ' ', false, Json::error_handler_t::replace);
  pad(text, ' ');
  const std::size_t length = 12 + 8 + text.size() + 8 + data.size();
  if (length > 0xffffffff) throw host::FileError("a glTF file holds no more than 4 GiB; this run takes more");
  std::string file = "glTF";
  append_word(file, 2);
  append_word(file, length);
  append_word(file, text.size());
  file += "JSON" + text;
  append_word(file, data.size());
  file.append("BIN\0", 4);
  return file + data;
}

}  // namespace topple::app
