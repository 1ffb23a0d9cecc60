#include "solver/study/overturn/factors.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "solver/io/common/units.h"
#include "solver/io/document/scene_document.h"
#include "solver/io/edit/scene_number.h"
#include "solver/io/edit/scene_save.h"
#include "solver/io/scene/furniture.h"
#include "solver/io/scene/scene_file.h"
#include "solver/math/elementary.h"
#include "solver/model/excitation.h"
#include "solver/planar/transition.h"
#include "solver/study/common/low_discrepancy.h"

namespace topple::study {
namespace {

namespace fs = std::filesystem;
using io::InputError;

constexpr const char* k_bodies = "cabinet";  // table of the bodies that are read anew
constexpr double k_cut = 3;                  // standard deviations of a normal distribution
constexpr double k_most_normal = 0.33;       // standard deviation, so that factors stay above 0
constexpr double k_most_lognormal = 2;
constexpr double k_most_factor = 100;

void scale(Shake& shake, double value) {
  shake.amplitude *= value, shake.scale *= value;
}

void turn(Shake& shake, double value) {
  if (traits(shake.kind).steady) shake.turns += value;
}

const char* no_phase(const io::Scene& scene, int index) {
  const std::vector<Shake>& shakes = scene.setup.parameters.shakes;
  bool any = false;
  for (std::size_t k = 0; k < shakes.size(); ++k) {
    if (index >= 0 && static_cast<std::size_t>(index) != k) continue;
    if (!traits(shakes[k].kind).steady) continue;
    any = true;
    if (shakes[k].building) return "the floor of a building begins at rest, not anywhere in a cycle";
    if (shakes[k].taper > 0 || shakes[k].cycles > 0 || shakes[k].initial_velocity == Shake::Start::jump)
      return "a sine that begins anywhere in its cycle has no taper, no cycles and begins at rest";
  }
  return any ? nullptr : "no shake is a sine";
}

const char* no_shake(const io::Scene& scene, int) {
  return scene.setup.parameters.shakes.empty() ? "the floor does not shake" : nullptr;
}

/// Lengths by this factor at the same mass; other things come as much nearer as the body may grow.
void grow(planar::PlanarCase& of, double value) {
  planar::Block& block = of.block;
  block.left *= value, block.right *= value, block.height *= value;
  block.inertia *= value * value;
  const double edge = std::max(block.left, block.right), R = elementary::hypot(edge, block.height);
  of.farthest -= 2 * std::max(0., R - R / value);
}

void restore(planar::PlanarCase& of, double value) {
  of.block.restitution = std::min(of.block.restitution * value, greatest_restitution(of.block));
}

constexpr FactorTraits k_factors[] = {
    {.word = "amplitude",
     .about = "amplitude or scale of every shake, together",
     .shake = scale,
     .block = nullptr,
     .edit = nullptr,
     .key = nullptr,
     .even = false,
     .why_not = no_shake},
    {.word = "phase",
     .about = "where in their cycle sines begin",
     .shake = turn,
     .block = nullptr,
     .edit = nullptr,
     .key = nullptr,
     .even = true,
     .why_not = no_phase},
    {.word = "size",
     .about = "all lengths of the bodies",
     .shake = nullptr,
     .block = grow,
     .edit = nullptr,
     .key = "size",
     .even = false,
     .why_not = nullptr},
    {.word = "mass",
     .about = "their mass",
     .shake = nullptr,
     .block = [](planar::PlanarCase& of, double value) { of.block.mass *= value, of.block.inertia *= value; },
     .edit = nullptr,
     .key = "mass",
     .even = false,
     .why_not = nullptr},
    {.word = "friction",
     .about = "static and kinetic friction",
     .shake = nullptr,
     .block = [](planar::PlanarCase& of,
                 double value) { of.block.static_friction *= value, of.block.kinetic_friction *= value; },
     .edit = [](Parameters& p,
                double value) { p.contact.friction *= value, p.contact.friction_static *= value; },
     .key = nullptr,
     .even = false,
     .why_not = nullptr},
    {.word = "restitution",
     .about = "rate that a planar block keeps at an impact; rigid: contact.restitution",
     .shake = nullptr,
     .block = restore,
     .edit = [](Parameters& p,
                double value) { p.contact.restitution = std::min(1., p.contact.restitution * value); },
     .key = nullptr,
     .even = false,
     .why_not = nullptr},
};

constexpr std::pair<const char*, Distribution::Kind> k_distributions[] = {
    {"uniform", Distribution::Kind::uniform},
    {"normal", Distribution::Kind::normal},
    {"lognormal", Distribution::Kind::lognormal}};

[[noreturn]] void refuse(const std::string& text, const std::string& message) {
  throw InputError("--vary " + text + ": " + message);
}

std::string words() {
  std::string out;
  for (const FactorTraits& one : k_factors) out += std::string(one.word) + ", ";
  return out + "records";
}

/// "0.9", "5%".
std::optional<double> number(std::string_view text) {
  const bool percent = text.ends_with('%');
  if (percent) text.remove_suffix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return percent ? value / 100 : value;
}

Distribution distribution(const std::string& text, const std::string& of) {
  constexpr const char* k_forms = "uniform:FROM..TO, normal:SD or lognormal:SD, such as normal:10%";
  const std::size_t colon = of.find(':');
  const auto* const row = std::ranges::find(k_distributions, of.substr(0, colon),
                                            [](const auto& one) { return std::string(one.first); });
  if (colon == std::string::npos || row == std::end(k_distributions))
    refuse(text, "\"" + of + "\" is not " + k_forms);
  Distribution out{row->second, 0, 0};
  const std::string numbers = of.substr(colon + 1);
  if (out.kind == Distribution::Kind::uniform) {
    const std::size_t dots = numbers.find("..");
    const auto from = number(numbers.substr(0, dots)),
               to = dots == std::string::npos ? std::nullopt : number(numbers.substr(dots + 2));
    if (!from || !to) refuse(text, "\"" + numbers + "\" is not FROM..TO");
    if (!(*from >= 0 && *from < *to && *to <= k_most_factor))
      refuse(text, fmt::format("a factor is within 0..{:g}, FROM less than TO", k_most_factor));
    out.first = *from, out.second = *to;
    return out;
  }
  const double most = out.kind == Distribution::Kind::normal ? k_most_normal : k_most_lognormal;
  const auto deviation = number(numbers);
  if (!deviation || !(*deviation > 0 && *deviation <= most))
    refuse(text, fmt::format("\"{}\" is not a standard deviation above 0 up to {:g}", numbers, most));
  out.first = *deviation;
  return out;
}

/// Index of the shake with this name or number.
int shake_named(const std::string& text, const std::string& name, const io::Scene& scene) {
  const io::Node root = io::parse_toml(scene.text, scene.name);
  if (const io::Node* const shakes = root.find("shake"))
    for (std::size_t k = 0; k < shakes->items.size(); ++k)
      if (io::entry_label(*shakes, k) == name || std::to_string(k + 1) == name) return static_cast<int>(k);
  refuse(text, scene.name + " has no shake \"" + name + "\"");
}

Factor factor(const std::string& text, const io::Scene& scene) {
  const std::size_t equals = text.find('=');
  const std::string name = text.substr(0, equals), word = name.substr(0, name.find('.'));
  const auto* const row =
      std::ranges::find(k_factors, word, [](const FactorTraits& one) { return std::string(one.word); });
  if (row == std::end(k_factors)) refuse(text, "\"" + word + "\" is not a factor; known: " + words());
  Factor out{row, -1, {}};
  if (word.size() < name.size()) {
    if (!row->shake) refuse(text, "\"" + word + "\" is not of a shake");
    out.shake = shake_named(text, name.substr(word.size() + 1), scene);
  }
  if (row->even != (equals == std::string::npos))
    refuse(text, row->even ? "takes no distribution" : "expected FACTOR=DISTRIBUTION");
  if (!row->even) out.distribution = distribution(text, text.substr(equals + 1));
  const bool grows = row->key != nullptr;
  if (grows && out.distribution.kind == Distribution::Kind::uniform && !(out.distribution.first > 0))
    refuse(text, "the factor begins above 0");
  if (row->why_not)
    if (const char* const why = row->why_not(scene, out.shake)) refuse(text, why);
  return out;
}

/// A folder's files; where there is no such folder, those that the scene keeps of it.
std::vector<std::string> files_in(const std::string& text, const std::string& path, const io::Scene& scene) {
  std::vector<std::string> out;
  std::error_code status;
  const std::string folder = (fs::path(path) / "").string();
  if (fs::is_directory(path, status)) {
    for (const fs::directory_entry& entry : fs::directory_iterator(path, status))
      if (entry.is_regular_file(status) && !entry.path().filename().string().starts_with('.'))
        out.push_back((fs::path(path) / entry.path().filename()).string());
    if (out.empty()) refuse(text, path + ": holds no file");
  } else {
    for (const io::SceneFile& file : scene.files)
      if (file.name.starts_with(folder)) out.push_back(file.name);
    if (out.empty()) out.push_back(path);
  }
  std::ranges::sort(out);
  return out;
}

std::vector<std::string> records(const std::string& text, const io::Scene& scene) {
  std::vector<std::string> out;
  std::string left = text.substr(text.find('=') + 1);
  while (!left.empty()) {
    const std::size_t comma = std::min(left.find(','), left.size());
    if (comma == 0) refuse(text, "expected FILE,FILE or a folder");
    for (std::string& file : files_in(text, left.substr(0, comma), scene)) out.push_back(std::move(file));
    left.erase(0, comma + 1);
  }
  if (out.empty()) refuse(text, "expected FILE,FILE or a folder");
  for (std::size_t k = 1; k < out.size(); ++k)
    if (std::find(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(k), out[k]) !=
        out.begin() + static_cast<std::ptrdiff_t>(k))
      refuse(text, out[k] + ": is named twice");
  return out;
}

/// A length or mass of the scene times `value`, SI, as of --set.
std::string scaled_number(const io::Scene& scene, const std::string& path, double value) {
  const io::SceneNumber number = io::number_in(scene, path);
  if (!number.value) return "";
  return fmt::format("{}={}", path, *number.value * value);
}

double length_of(const io::Node& node) {
  return node.is_number() ? node.real : io::parse_quantity(node.text, io::Dimension::length).si.value_or(0);
}

/// The same of a [[furniture]]: all that it leaves to its kind is said, because that would follow the size.
std::vector<std::string> piece_changes(const io::FurniturePiece& piece, const std::string& key,
                                       double value) {
  const std::string path = fmt::format("furniture.{}.", piece.number);
  const bool heavier = key == "mass";
  const double mass = heavier ? value : 1;
  const Vec3 size = heavier ? piece.size : Vec3(piece.size + (value - 1) * piece.rocking_size);
  const Vec3 cg = heavier ? piece.contents_cg : Vec3(value * piece.contents_cg);
  return {fmt::format("{}size=[{}, {}, {}]", path, size.x(), size.y(), size.z()),
          fmt::format("{}mass={}", path, mass * piece.mass),
          fmt::format("{}contents={{ mass = {}, cg = [{}, {}, {}] }}", path, mass * piece.contents_mass,
                      cg.x(), cg.y(), cg.z())};
}

/// Overrides that multiply the keys of all bodies.
std::vector<std::string> body_changes(const io::Scene& scene, const std::string& key, double value) {
  std::vector<std::string> out;
  const io::Node root = io::parse_toml(scene.text, scene.name);
  const io::Node* const bodies = root.find(k_bodies);
  const auto add = [&](std::string change) {
    if (!change.empty()) out.push_back(std::move(change));
  };
  for (std::size_t k = 0; bodies && k < bodies->items.size(); ++k) {
    const io::Node& body = bodies->items[k].value;
    const std::string path = fmt::format("{}.{}.", k_bodies, k + 1);
    if (key == "mass") {
      add(scaled_number(scene, path + "mass", value));
      continue;
    }
    std::string size;
    if (const io::Node* const list = body.find("size"))
      for (const io::Item& one : list->items)
        size += fmt::format("{}{}", size.empty() ? "" : ", ", length_of(one.value) * value);
    out.push_back(fmt::format("{}size=[{}]", path, size));
    if (body.find("cg_height")) add(scaled_number(scene, path + "cg_height", value));
  }
  for (const io::FurniturePiece& piece : io::furniture_of(scene))
    for (std::string& change : piece_changes(piece, key, value)) out.push_back(std::move(change));
  if (out.empty())
    throw InputError("--vary " + key + ": no [[" + std::string(k_bodies) + "]] or [[furniture]] whose " +
                     key + " the rigid model could take");
  return out;
}

}  // namespace

std::span<const FactorTraits> factor_table() {
  return k_factors;
}

double Distribution::at(double u) const {
  if (kind == Kind::uniform) return first + u * (second - first);
  if (kind == Kind::lognormal) return elementary::exp(first * normal_quantile(u));
  const double tail = normal_probability(-k_cut);
  return 1 + first * normal_quantile(tail + u * (1 - 2 * tail));
}

std::string FactorPlan::in_words() const {
  std::string out;
  for (const std::string& text : texts) {
    const bool files = text.starts_with("records=");
    out += (out.empty() ? "" : ", ") + (files ? fmt::format("{} records in turn", records.size()) : text);
  }
  return out;
}

std::vector<double> FactorPlan::draw(std::uint64_t stream, std::uint32_t index) const {
  std::vector<double> values;
  values.reserve(factors.size());
  for (const Factor& one : factors) {
    const double u =
        shifted_sobol(seed * 0x9e3779b97f4a7c15u + stream, index, static_cast<int>(values.size()));
    values.push_back(one.of->even ? u : one.distribution.at(u));
  }
  return values;
}

FactorPlan plan_factors(const std::vector<std::string>& texts, const io::Scene& scene) {
  FactorPlan plan;
  plan.texts = texts;
  for (const std::string& text : texts)
    if (text.starts_with("records=")) {
      if (!plan.records.empty()) refuse(text, "there is another one");
      plan.records = records(text, scene);
    }
  const io::Scene with_record = plan.records.empty() ? scene : scenes_of(plan, scene).front();
  for (const std::string& text : texts) {
    if (text.starts_with("records=")) continue;
    const Factor one = factor(text, with_record);
    if (std::ranges::any_of(plan.factors,
                            [&](const Factor& f) { return f.of == one.of && f.shake == one.shake; }))
      refuse(text, "there is another one");
    if (static_cast<int>(plan.factors.size()) == k_most_dimensions)
      refuse(text, fmt::format("more than {} factors", k_most_dimensions));
    plan.factors.push_back(one);
  }
  return plan;
}

std::vector<io::Scene> scenes_of(const FactorPlan& plan, const io::Scene& scene) {
  if (plan.records.empty()) return {scene};
  std::vector<io::Scene> out;
  for (const std::string& record : plan.records) {
    try {
      out.push_back(io::scene_with_record(scene, {record}));
    } catch (const InputError& error) {
      throw InputError("--vary records: " + record + ": " + error.what());
    }
    out.back().name = scene.name;
  }
  return out;
}

io::Scene with_files_of(const std::vector<io::Scene>& scenes) {
  io::Scene first = scenes.front();
  for (const io::Scene& scene : scenes)
    for (const io::SceneFile& file : scene.files)
      if (std::ranges::find(first.files, file.name, &io::SceneFile::name) == first.files.end())
        first.files.push_back(file);
  return first;
}

nlohmann::ordered_json settings_of(const FactorPlan& plan) {
  return {{"vary", plan.texts}, {"seed", plan.seed}, {"records", plan.records}};
}

void vary(const FactorPlan& plan, std::span<const double> values, std::vector<Shake>& shakes) {
  for (std::size_t k = 0; k < values.size(); ++k) {
    const Factor& one = plan.factors[k];
    if (!one.of->shake) continue;
    for (std::size_t i = 0; i < shakes.size(); ++i)
      if (one.shake < 0 || static_cast<std::size_t>(one.shake) == i) one.of->shake(shakes[i], values[k]);
  }
}

void vary(const FactorPlan& plan, std::span<const double> values, planar::PlanarCase& block) {
  for (std::size_t k = 0; k < values.size(); ++k)
    if (plan.factors[k].of->block) plan.factors[k].of->block(block, values[k]);
}

Setup varied_setup(const FactorPlan& plan, std::span<const double> values, const io::Scene& scene) {
  std::vector<std::string> changes;
  for (std::size_t k = 0; k < values.size(); ++k)
    if (const char* const key = plan.factors[k].of->key)
      for (std::string& change : body_changes(scene, key, values[k])) changes.push_back(std::move(change));
  Setup setup = changes.empty()
                    ? scene.setup
                    : io::parse_scene(scene.text, scene.name, changes, io::kept_files(scene)).setup;
  for (std::size_t k = 0; k < values.size(); ++k)
    if (plan.factors[k].of->edit) plan.factors[k].of->edit(setup.parameters, values[k]);
  return setup;
}

}  // namespace topple::study
