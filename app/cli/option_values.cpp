#include "app/cli/option_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <vector>

#include "app/support/errors.h"

namespace topple::app {
namespace {

constexpr int k_least_side = 64, k_most_side = 8192;  // px
constexpr std::string_view k_kinds[] = {".png",  ".jpg", ".jpeg", ".gif", ".bmp", ".tif", ".tiff", ".webp",
                                        ".svg",  ".ppm", ".mp4",  ".avi", ".mov", ".mkv", ".webm", ".wmv",
                                        ".mpeg", ".mpg", ".pdf",  ".ps",  ".eps", ".html"};
constexpr float k_farthest = 1e4;  // of the camera, m or degrees

}  // namespace

std::optional<double> share_in(std::string_view text) {
  const bool percent = text.ends_with('%');
  if (percent) text.remove_suffix(1);
  const std::optional<double> value = number_in<double>(text);
  const double share = value.value_or(0) / (percent ? 100 : 1);
  return share > 0 && share < 1 ? std::optional(share) : std::nullopt;
}

std::string not_empty(const std::string& text) {
  return text.empty() ? "is empty" : "";
}

std::string seconds(const std::string& text) {
  const std::optional<double> value = number_in<double>(text);
  return value && std::isfinite(*value) ? "" : "\"" + text + "\" is not a number of seconds";
}

std::string share(const std::string& text) {
  return share_in(text) ? "" : "\"" + text + "\" is not between 0% and 100%";
}

std::function<std::string(const std::string&)> whole_number_in(int least, int most) {
  return [least, most](const std::string& text) {
    const std::optional<int> value = number_in<int>(text);
    return value && *value >= least && *value <= most
               ? ""
               : fmt::format("\"{}\" is not a whole number in {}..{}", text, least, most);
  };
}

std::string_view ending_of(std::string_view name) {
  const std::size_t dot = name.rfind('.');
  return dot == name.npos ? "" : name.substr(dot);
}

std::function<std::string(const std::string&)> not_of_another_kind(std::string_view ending) {
  return [ending](const std::string& name) {
    std::string own(ending_of(name));
    std::ranges::transform(own, own.begin(), [](unsigned char c) { return std::tolower(c); });
    const bool other = own != ending && std::ranges::find(k_kinds, own) != std::end(k_kinds);
    return other ? fmt::format("\"{}\" ends in {}, but what is written is {}", name, own, ending) : "";
  };
}

void read_size(const std::string& text, bool video, RenderOptions& options) {
  const std::size_t cross = std::min(text.find('x'), text.size());
  const auto side = [](std::string_view digits) {
    const int value = number_in<int>(digits).value_or(0);
    return value >= k_least_side && value <= k_most_side ? value : 0;
  };
  options.width = side(std::string_view(text).substr(0, cross));
  options.height = side(std::string_view(text).substr(std::min(cross + 1, text.size())));
  if (options.width == 0 || options.height == 0)
    throw BadInput(
        fmt::format("--size: \"{}\" is not WIDTHxHEIGHT with {}..{} each", text, k_least_side, k_most_side));
  if (video && (options.width % 2 != 0 || options.height % 2 != 0))
    throw BadInput("--size: a video needs an even width and height");
}

void read_camera(const std::string& text, RenderOptions& options) {
  std::string camera = text;
  if (const std::size_t at = camera.find("follow");
      at == 0 || (at < camera.size() && camera[at - 1] == ',')) {
    const std::string body = camera.substr(at + std::strlen("follow"));
    if (body.empty() || (body.front() == ':' && body.size() > 1)) {
      options.follow = body.empty() ? "" : body.substr(1);
      camera = at == 0 ? "iso" : camera.substr(0, at - 1);
    }
  }
  if (const auto view = render::view_named(camera)) {
    options.view = *view;
    return;
  }
  std::vector<float> numbers;
  for (std::size_t at = 0; at <= camera.size();) {
    const std::size_t end = std::min(camera.find(',', at), camera.size());
    const auto number = number_in<float>(std::string_view(camera).substr(at, end - at));
    numbers.push_back(number.value_or(std::numeric_limits<float>::quiet_NaN()));
    at = end + 1;
  }
  const bool good = numbers.size() == 6 &&
                    std::ranges::all_of(numbers, [](float x) { return std::abs(x) <= k_farthest; }) &&
                    std::abs(numbers[1]) <= 90 && numbers[2] > 0;
  if (!good)
    throw BadInput(
        "--camera: \"" + text +
        "\" is not one of front, side, top, iso, follow, nor AZIMUTH,ELEVATION,DISTANCE,X,Y,Z with an "
        "elevation of -90..90 and a distance above 0");
  if (options.ui) throw BadInput("--camera: with --ui, one of front, side, top, iso, follow");
  constexpr float radians = std::numbers::pi_v<float> / 180;
  options.orbit = render::Orbit{.target = {numbers[3], numbers[4], numbers[5]},
                                .distance = numbers[2],
                                .sight = {numbers[0] * radians, numbers[1] * radians}};
}

render::Renderer renderer_named(const std::string& name) {
  if (name != "osmesa" && name != "egl")
    throw BadInput("--renderer: \"" + name + "\" is not one of osmesa, egl");
  return name == "egl" ? render::Renderer::egl : render::Renderer::osmesa;
}

Language language_named(const std::string& name) {
  if (name != "en" && name != "ja") throw BadInput("--lang: \"" + name + "\" is not one of en, ja");
  return name == "ja" ? Language::japanese : Language::english;
}

void read_picture(const PictureWords& words, PictureSettings& picture) {
  const auto quantity = beam_quantity_named(words.colour);
  if (!quantity)
    throw BadInput("--colour: \"" + words.colour +
                   "\" is not one of stress, yield-ratio, axial, moment, torsion, displacement");
  picture.colour = *quantity;
  const auto map = render::colour_map_named(words.map);
  if (!map || *map == render::ColourMap::diverging)
    throw BadInput("--map: \"" + words.map + "\" is not one of viridis, cividis");
  picture.map = *map;
  picture.range = words.range == "run"       ? RangePolicy::run
                  : words.range == "instant" ? RangePolicy::instant
                                             : RangePolicy::fixed;
  if (picture.range == RangePolicy::fixed) {
    const auto number = number_in<double>(words.range);
    if (!number || !(*number >= k_least_maximum && *number <= k_most_maximum))
      throw BadInput("--range: \"" + words.range + "\" is not run, instant or a number from 1e-6 to 1e12");
    picture.maximum = *number;
  }
  const auto factor = number_in<double>(words.exaggerate);
  if (!factor || !(*factor >= 1 && *factor <= k_most_exaggeration))
    throw BadInput("--exaggerate: \"" + words.exaggerate + "\" is not a number from 1 to 200");
  picture.exaggeration = *factor;
  picture.panels = !words.no_panels;
  if (!words.trails.empty() && words.trails != "second" && words.trails != "run")
    throw BadInput("--trails: \"" + words.trails + "\" is not one of second, run");
  picture.trails = words.trails.empty() ? Trails::none : words.trails == "run" ? Trails::run : Trails::second;
}

}  // namespace topple::app
