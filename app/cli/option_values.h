// Values of options from their words on the command line.
#pragma once

#include <charconv>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "app/cli/render_command.h"
#include "app/support/language.h"

namespace topple::app {

/// The whole of `text` as a number.
template <typename Number>
std::optional<Number> number_in(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// "5%" or "0.05", between both ends of 0..1.
std::optional<double> share_in(std::string_view text);

// Checks: what is wrong with a text, or nothing.
std::string not_empty(const std::string& text);
std::string seconds(const std::string& text);
std::string share(const std::string& text);
std::function<std::string(const std::string&)> whole_number_in(int least, int most);
/// Refuses names that end as pictures, videos or pages of another kind than `ending`, ".png", which is
/// written.
std::function<std::string(const std::string&)> not_of_another_kind(std::string_view ending);

/// ".png" of "FILE.png"; empty: it has none.
std::string_view ending_of(std::string_view name);

// The following throw BadInput, which names the option.

/// --size, into width and height; `video`: they must be even.
void read_size(const std::string& text, bool video, RenderOptions& options);
/// --camera, into view, orbit and follow.
void read_camera(const std::string& text, RenderOptions& options);
/// --renderer
render::Renderer renderer_named(const std::string& name);
/// --lang
Language language_named(const std::string& name);

/// What options say about the look of pictures.
struct PictureWords {
  std::string colour = "stress", map = "viridis", range = "run", exaggerate = "1", trails;
  bool no_panels = false;
};
void read_picture(const PictureWords& words, PictureSettings& picture);

}  // namespace topple::app
