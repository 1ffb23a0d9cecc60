// A binary glTF 2.0 file while it is put together.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace topple::app {

/// What an accessor is for.
enum class GlbUse { vertices, indices, keys, matrices };

/// JSON and one buffer in a container of two chunks (Khronos, glTF 2.0, section 4.4). The same accessor,
/// given twice, is stored once.
class Glb {
 public:
  using Json = nlohmann::ordered_json;

  Json json;  ///< "accessors", "bufferViews" and "buffers" come from here

  /// Appends to one of its lists; returns the entry's number there.
  std::size_t add(const char* list, Json entry);
  /// An accessor of values in rows of `type`; returns its number. normalized: integers stand for 0..1 or
  /// -1..1. bounds: with the least and the greatest of each column.
  template <typename Number>
  std::size_t accessor(GlbUse use, const char* type, const std::vector<Number>& values,
                       bool normalized = false, bool bounds = false) {
    const std::string_view bytes(reinterpret_cast<const char*>(values.data()),
                                 values.size() * sizeof(Number));
    const std::size_t columns = columns_of(type);
    Json entry = {{"componentType", component_type<Number>()}, {"count", values.size() / columns}};
    if (normalized) entry["normalized"] = true;
    entry["type"] = type;
    if (bounds) {
      std::vector<Number> least(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(columns));
      std::vector<Number> greatest = least;
      for (std::size_t i = columns; i < values.size(); ++i) {
        least[i % columns] = std::min(least[i % columns], values[i]);
        greatest[i % columns] = std::max(greatest[i % columns], values[i]);
      }
      entry["min"] = least, entry["max"] = greatest;
    }
    return store(use, columns * sizeof(Number), bytes, std::move(entry));
  }
  /// One of `count` vectors of zeros, which take no room in the buffer.
  std::size_t zero_vectors(std::size_t count);
  /// The whole file. Throws host::FileError when it is too large for its format.
  std::string bytes() const;

 private:
  struct View {
    GlbUse use;
    std::size_t stride;
    std::string bytes;
  };
  template <typename Number>
  static constexpr int component_type() {
    if constexpr (std::is_same_v<Number, std::uint8_t>) return 5121;
    if constexpr (std::is_same_v<Number, std::int16_t>) return 5122;
    if constexpr (std::is_same_v<Number, std::uint16_t>) return 5123;
    if constexpr (std::is_same_v<Number, std::uint32_t>) return 5125;
    if constexpr (std::is_same_v<Number, float>) return 5126;
  }
  static std::size_t columns_of(std::string_view type);
  std::size_t store(GlbUse use, std::size_t stride, std::string_view bytes, Json entry);

  std::vector<View> views_;
  std::map<std::string, std::size_t> stored_;
};

}  // namespace topple::app
