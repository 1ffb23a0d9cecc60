#include "app/page/page_controls.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "app/page/page_words.h"
#include "app/support/terms.h"
#include "solver/io/common/digits.h"
#include "solver/io/common/units.h"
#include "solver/io/document/scene_document.h"
#include "solver/io/scene/scene_keys.h"
#include "solver/math/ranges.h"

namespace topple::app {
namespace {

using io::Node;
using Kind = PageControl::Kind;

/// What is usual for a key.
struct Usual {
  std::string_view name;
  Phrase label;
  std::string_view unit;
  double least, most;
  bool relative = false, logarithmic = false;  ///< relative: factors of the scene's value
};
constexpr Usual k_of_shakes[] = {{"frequency", window_words::k_frequency, "Hz", 0.1, 10, false, true},
                                 {"amplitude", window_words::k_amplitude, "gal", 0, 1000},
                                 {"scale", window_words::k_scale, "", 0, 3}};
constexpr Usual k_of_contact[] = {{"friction", window_words::k_friction, "", 0, 1.5},
                                  {"restitution", window_words::k_restitution, "", 0, 1},
                                  {"alpha", window_words::k_alpha, "kgf", 1. / 50, 1000, true, true}};
constexpr Usual k_of_size[] = {{"size", page_words::k_depth, "mm", 0.5, 2, true},
                               {"size", page_words::k_width, "mm", 0.5, 2, true},
                               {"size", page_words::k_height, "mm", 0.5, 2, true}};
constexpr Usual k_mass{"mass", page_words::k_mass, "kg", 0.25, 4, true, true};
constexpr Usual k_loads{"masses", page_words::k_loads, "kg", 0.25, 4, true, true};
constexpr Usual k_cg_height{"cg_height", page_words::k_cg_height, "mm", 0.4, 1.6, true};
constexpr Usual k_tilt{"tilt", page_words::k_start_tilt, "deg", -30, 30};
constexpr std::string_view k_contact_friction = "contact.friction";
constexpr double k_least_members = 1.01;  ///< mass of a frame over that of its loads

/// A number of the scene in SI; none: it is not written as one.
std::optional<double> number_of(const Node* node, io::Dimension dimension) {
  if (node == nullptr) return std::nullopt;
  if (node->is_number()) return node->real;
  if (node->kind != Node::Kind::text) return std::nullopt;
  return io::parse_quantity(node->text, dimension).si;
}

/// The list with all masses and inertias in SI, times `factor`.
Node scaled(Node list, double factor) {
  for (io::Item& entry : list.items)
    for (io::Item& item : entry.value.items) {
      const auto scale = [&](Node& node, io::Dimension dimension) {
        const double si = number_of(&node, dimension).value_or(0);
        node = io::number_node(si * factor, node.place);
      };
      if (item.key == "mass") scale(item.value, io::Dimension::mass);
      if (item.key == "inertia")
        for (io::Item& component : item.value.items) scale(component.value, io::Dimension::inertia);
    }
  return list;
}

double mass_of(const Node& list) {
  double sum = 0;
  for (const io::Item& entry : list.items)
    sum += number_of(entry.value.find("mass"), io::Dimension::mass).value_or(0);
  return sum;
}

class Controls {
 public:
  explicit Controls(const io::Scene& scene) : scene_(scene), root_(io::parse_toml(scene.text, scene.name)) {}

  std::vector<PageControl> all() {
    const Parameters& now = scene_.setup.parameters;
    each("shake", [&](const Node& entry, const std::string& path, const std::string& label) {
      shake(entry, path, label);
    });
    const bool coulomb = traits(now.contact.kind).sticks;
    if (!scene_.setup.model.planes.empty() || scene_.setup.model.bodies.size() > 1)
      for (const auto& [usual, value] : {std::pair(&k_of_contact[0], now.contact.friction),
                                         std::pair(&k_of_contact[1], now.contact.restitution),
                                         std::pair(&k_of_contact[2], now.contact.alpha)})
        if (coulomb || usual->name != "restitution")
          add(*usual, "contact", "contact", "", window_words::k_contact, value);
    for (const char* table : {"cabinet", "frame", "block", "furniture"})
      each(table, [&](const Node& entry, const std::string& path, const std::string& label) {
        piece(table, entry, path, label);
      });
    for (const char* table : {"anchor", "fixing"})
      each(table, [&](const Node& entry, const std::string& path, const std::string& label) {
        const Node* const body = entry.find("body");
        toggle(entry, path, body == nullptr ? label : label + " (" + body->text + ")", page_words::k_in_place,
               window_words::k_anchors_heading);
      });
    return std::move(found_);
  }

 private:
  template <class Visit>
  void each(const std::string& table, const Visit& visit) {
    const Node* const list = root_.find(table);
    if (list == nullptr || list->kind != Node::Kind::list) return;
    for (std::size_t k = 0; k < list->items.size(); ++k) {
      const std::string label = io::entry_label(*list, k);
      visit(list->items[k].value, table + "." + label, label);
    }
  }

  /// Null: it is left out.
  PageControl* add(const Usual& usual, const std::string& path, std::string_view table,
                   const std::string& group, const Phrase& heading, double si, int component = -1) {
    const io::Key* const key = io::find_key(table, usual.name);
    if (key == nullptr || !std::isfinite(si)) return nullptr;
    const double unit = usual.unit.empty() ? 1 : io::unit_value(usual.unit, key->dimension);
    const double value = std::stod(fmt::format("{:.12g}", si / unit)), scale = usual.relative ? value : 1;
    PageControl one{.key = path + "." + std::string(usual.name),
                    .group = group,
                    .heading = heading,
                    .label = usual.label,
                    .unit = usual.unit,
                    .value = value,
                    .logarithmic = usual.logarithmic,
                    .component = component};
    one.least = std::max(key->least / unit, std::min(value, usual.least * scale));
    one.most = std::min(key->most / unit, std::max(value, usual.most * scale));
    if (!(one.least < one.most) || (one.logarithmic && !(one.least > 0))) return nullptr;
    return &found_.emplace_back(one);
  }

  void toggle(const Node& entry, const std::string& path, const std::string& label, const Phrase& name,
              const Phrase& heading) {
    const Node* const on = entry.find("on");
    found_.push_back({.kind = Kind::toggle,
                      .key = path + ".on",
                      .group = label,
                      .heading = heading,
                      .label = name,
                      .value = on == nullptr || on->boolean ? 1. : 0.});
  }

  void shake(const Node& entry, const std::string& path, const std::string& label) {
    const auto number = static_cast<std::size_t>(shakes_++);
    const Shake& now = scene_.setup.parameters.shakes.at(number);
    const std::string group = scene_.setup.parameters.shakes.size() > 1 ? label : "";
    const Phrase& heading = window_words::k_floor;
    if (now.kind == Shake::Kind::sine) add(k_of_shakes[0], path, "shake", group, heading, now.frequency);
    if (now.kind == Shake::Kind::record) {
      add(k_of_shakes[2], path, "shake", group, heading, now.scale);
    } else {
      add(k_of_shakes[1], path, "shake", group, heading, now.amplitude);
      if (std::abs(now.direction.z()) < 1e-9)
        found_.push_back({.kind = Kind::angle,
                          .key = path + ".direction",
                          .group = group,
                          .heading = heading,
                          .label = window_words::k_direction,
                          .unit = "°",
                          .least = -180,
                          .most = 180,
                          .value = std::atan2(now.direction.y(), now.direction.x()) * k_degrees});
    }
    if (entry.find("on") != nullptr || scene_.setup.parameters.shakes.size() > 1)
      toggle(entry, path, label, window_words::k_on, heading);
  }

  void piece(const std::string& table, const Node& entry, const std::string& path, const std::string& label) {
    const std::vector<Body>& bodies = scene_.setup.model.bodies;
    const auto body = ranges::find_if(bodies, [&](const Body& of) {
      return of.name == label || of.name == table + "-" + label || of.name == label + "-1";
    });
    const std::size_t first = found_.size();
    const auto add_here = [&](const Usual& usual, double si, int component = -1) {
      return add(usual, path, table, label, window_words::k_bodies, si, component);
    };
    const Node* const size = entry.find("size");
    int tall = -1;  // control of the height
    for (int k = 0; size != nullptr && size->items.size() == 3 && k < 3; ++k)
      if (const auto metres = number_of(&size->items[k].value, io::Dimension::length);
          metres && add_here(k_of_size[k], *metres, k) != nullptr && k == 2)
        tall = static_cast<int>(found_.size()) - 1;
    const Node* const masses = entry.find("masses");
    std::optional<double> mass = number_of(entry.find("mass"), io::Dimension::mass);
    if (!mass && masses != nullptr)
      loads(*masses, path, label);
    else if (!mass && body != bodies.end() && table != "furniture")
      mass = body->mass;
    if (PageControl* const own = mass ? add_here(k_mass, *mass) : nullptr; own && masses != nullptr)
      own->least = std::clamp(k_least_members * mass_of(*masses), own->least, own->value);
    std::optional<double> height = number_of(entry.find("cg_height"), io::Dimension::length);
    const bool is_named = height.has_value();
    if (!height && table == "cabinet" && body != bodies.end() && entry.find("pose") == nullptr)
      height = body->centre_of_gravity.z() - body->base_centre.z();
    if (PageControl* const found = height ? add_here(k_cg_height, *height) : nullptr;
        found && !is_named && tall >= 0) {
      found->follows = tall;
      found->share = found->value / found_[static_cast<std::size_t>(tall)].value;
      found->value = found->share * found_[static_cast<std::size_t>(tall)].value;
    }
    if (const auto tilt = number_of(entry.find("tilt"), io::Dimension::angle)) add_here(k_tilt, *tilt);
    friction(table, entry, path, label);
    for (std::size_t i = first; i < found_.size() && body != bodies.end(); ++i)
      found_[i].body = static_cast<int>(body - bodies.begin());
  }

  void loads(const Node& masses, const std::string& path, const std::string& label) {
    const double sum = mass_of(masses);
    if (!(sum > 0)) return;
    found_.push_back({.key = path + ".masses",
                      .group = label,
                      .heading = window_words::k_bodies,
                      .label = k_loads.label,
                      .unit = k_loads.unit,
                      .least = sum * k_loads.least,
                      .most = sum * k_loads.most,
                      .value = sum,
                      .logarithmic = k_loads.logarithmic,
                      .list = std::make_shared<const Node>(scaled(masses, 1))});
  }

  /// Of pieces that name theirs, and of frames.
  void friction(const std::string& table, const Node& entry, const std::string& path,
                const std::string& label) {
    const std::optional<double> own = number_of(entry.find("friction"), io::Dimension::none);
    if (scene_.setup.model.planes.empty() || (!own && table != "frame")) return;
    const double value = own.value_or(scene_.setup.parameters.contact.friction);
    PageControl* const found = add(k_of_contact[0], path, table, label, window_words::k_bodies, value);
    if (found && !own)
      found->follows =
          static_cast<int>(ranges::find(found_, k_contact_friction, &PageControl::key) - found_.begin());
  }

  const io::Scene& scene_;
  Node root_;
  int shakes_ = 0;
  std::vector<PageControl> found_;
};

std::string written(const PageControl& control, double value) {
  const std::string digits = io::shortest_digits(value);
  if (control.list) return io::written_value(scaled(*control.list, value / control.value));
  if (control.kind == Kind::toggle) return value != 0 ? "true" : "false";
  if (control.kind == Kind::angle)
    return fmt::format("[{}, {}, 0]", io::shortest_digits(std::cos(value / k_degrees)),
                       io::shortest_digits(std::sin(value / k_degrees)));
  return control.unit.empty() ? digits : fmt::format("\"{} {}\"", digits, control.unit);
}

/// The value that it has unless it is set.
double unset(const std::vector<PageControl>& controls, const std::vector<double>& values,
             const PageControl& control) {
  const auto followed = static_cast<std::size_t>(control.follows);
  return control.follows >= 0 && followed < std::min(controls.size(), values.size()) &&
                 std::isfinite(values[followed])
             ? control.share * values[followed]
             : control.value;
}

}  // namespace

std::vector<PageControl> page_controls(const io::Scene& scene) {
  return Controls(scene).all();
}

std::vector<std::string> changes(const std::vector<PageControl>& controls,
                                 const std::vector<double>& values) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < controls.size() && i < values.size();) {
    std::size_t end = i + 1;
    while (end < controls.size() && controls[end].component > 0 && controls[end].key == controls[i].key)
      ++end;
    bool changed = false;
    std::string list;
    for (std::size_t k = i; k < end && k < values.size(); ++k) {
      changed = changed || (std::isfinite(values[k]) && values[k] != unset(controls, values, controls[k]));
      const double value = std::isfinite(values[k]) ? values[k] : controls[k].value;
      list +=
          (k > i ? ", " : "") + written(controls[k], std::clamp(value, controls[k].least, controls[k].most));
    }
    if (changed) out.push_back(controls[i].key + "=" + (controls[i].component < 0 ? list : "[" + list + "]"));
    i = end;
  }
  return out;
}

}  // namespace topple::app
