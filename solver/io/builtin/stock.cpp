#include "solver/io/builtin/stock.h"

#include <algorithm>
#include <memory>

#include "solver/io/common/digits.h"
#include "solver/math/ranges.h"
#include "solver/model/section.h"

namespace topple::io {
namespace {

struct StockMaterial {
  std::string_view name;
  double young, poisson, density;  // Pa, -, kg/m^3
  double yield;                    // Pa; 0: elastic
};
// Yield: steel of 16 to 40 mm of JIS G 3101 SS400, stainless steel SUS304 of JIS G 4303, aluminium A6063S-T5
// of JIS H 4100. Wood is plywood and particle board, plastic ABS; the numbers of both are assumed.
constexpr StockMaterial k_materials[] = {{"aluminium", 69e9, 0.33, 2700, 110e6},
                                         {"plastic", 2.2e9, 0.35, 1050, 0},
                                         {"stainless steel", 193e9, 0.3, 7930, 205e6},
                                         {"steel", 205e9, 0.3, 7850, 235e6},
                                         {"wood", 6e9, 0.3, 650, 0}};

constexpr double k_poisson = 0.3;  // of shear coefficients of a sheet

using Sizes = std::vector<double>;  // m

void add_box(Node& table, const Sizes& sizes) {
  const Place place = table.place;
  set_key(table, "size", numbers_node({sizes[0], sizes[sizes.size() - 2]}, place));
  set_key(table, "thickness", number_node(sizes.back(), place));
}

void add_solid(Node& table, const Sizes& sizes) {
  set_key(table, "size", numbers_node({sizes.front(), sizes.back()}, table.place));
}

void add_pipe(Node& table, const Sizes& sizes) {
  set_key(table, "size", numbers_node({sizes[0]}, table.place));
  set_key(table, "thickness", number_node(sizes[1], table.place));
}

void add_sheet(Node& table, const Sizes& sizes) {
  Section sheet;
  sheet.shape = Section::Shape::solid;
  sheet.size_y = sizes[0];
  sheet.size_z = sizes[1];
  complete_section(sheet, k_poisson);
  add_solid(table, sizes);
  const std::pair<const char*, double> numbers[] = {
      {"area", sheet.area}, {"iy", sheet.iy}, {"iz", sheet.iz}, {"j", sheet.j},   {"ky", sheet.ky},
      {"kz", sheet.kz},     {"zy", sheet.zy}, {"zz", sheet.zz}, {"zt", sheet.zt}, {"width", sizes[1]}};
  for (const auto& [key, value] : numbers) set_key(table, key, number_node(value, table.place));
}

struct StockShape {
  std::string_view word, shape;  // shape: of [[section]]
  std::size_t least, most;       // sizes
  void (*add)(Node& table, const Sizes& sizes);
};
constexpr StockShape k_shapes[] = {{"box", "box", 2, 3, add_box},
                                   {"solid", "solid", 1, 2, add_solid},
                                   {"pipe", "pipe", 2, 2, add_pipe},
                                   {"sheet", "custom", 2, 2, add_sheet}};
constexpr const char* k_forms =
    "\"box 30x1\", \"box 40x20x1.2\", \"solid 30\", \"solid 40x20\", \"pipe 25x1.2\", \"sheet 700x25\"";

/// "30x1" in metres; empty: it is no such text.
Sizes sizes_of(std::string_view text) {
  constexpr double k_millimetre = 1e-3, k_largest = 1e4;  // mm, as the range of [[section]] size
  Sizes sizes;
  const char *at = text.data(), *const end = at + text.size();
  while (at != end) {
    double value = 0;
    const auto [behind, error] = read_digits(at, end, value, true);
    const bool more = behind != end;
    if (error != std::errc() || !(value > 0) || value > k_largest || (more && *behind != 'x')) return {};
    sizes.push_back(value * k_millimetre);
    at = behind + (more ? 1 : 0);
    if (more && at == end) return {};
  }
  return sizes;
}

Node named_table(std::string_view name, const Place& place) {
  Node table;
  table.place = place;
  set_key(table, "name", text_node(std::string(name), place));
  return table;
}

std::vector<std::string> names_in(const Node& root, std::string_view kind) {
  std::vector<std::string> names;
  if (const Node* const list = root.find(kind))
    for (const Item& item : list->items) names.push_back(item.value.find("name")->text);
  return names;
}

}  // namespace

std::optional<Node> stock_material(std::string_view name, const Place& place) {
  const auto* const row = ranges::find(k_materials, name, &StockMaterial::name);
  if (row == std::end(k_materials)) return std::nullopt;
  Node table = named_table(name, place);
  set_key(table, "young", number_node(row->young, place));
  set_key(table, "poisson", number_node(row->poisson, place));
  set_key(table, "density", number_node(row->density, place));
  if (row->yield > 0) set_key(table, "yield", number_node(row->yield, place));
  return table;
}

std::optional<Node> stock_section(std::string_view name, const Place& place) {
  const std::size_t space = std::min(name.find(' '), name.size());
  const auto* const row = ranges::find(k_shapes, name.substr(0, space), &StockShape::word);
  if (row == std::end(k_shapes) || space == name.size()) return std::nullopt;
  const Sizes sizes = sizes_of(name.substr(space + 1));
  if (sizes.size() < row->least || sizes.size() > row->most) return std::nullopt;
  Node table = named_table(name, place);
  set_key(table, "shape", text_node(std::string(row->shape), place));
  row->add(table, sizes);
  return table;
}

std::string no_such_stuff(std::string_view kind, const std::string& name,
                          const std::vector<std::string>& known) {
  std::string text = "there is no [[" + std::string(kind) + "]] \"" + name + "\"";
  if (known.empty()) text += " nor any other";
  for (const std::string& other : known) text += (&other == &known.front() ? "; known: " : ", ") + other;
  text += "; built in: ";
  if (kind == "section") return text + k_forms;
  for (const StockMaterial& row : k_materials)
    text += (&row == k_materials ? "" : ", ") + std::string(row.name);
  return text;
}

void find_stuff(Node& entry, std::string_view table, const std::string& path,
                const std::function<void(std::string_view, Node&, const std::string&)>& found) {
  if (table == "frame") {
    Item* const members = entry.find_item("members");
    for (std::size_t k = 0; members && k < members->value.items.size(); ++k)
      find_stuff(members->value.items[k].value, "frame.members",
                 path + ".members." + entry_label(members->value, k), found);
    return;
  }
  for (const std::string_view kind : {"section", "material"})
    if (Item* const name = entry.find_item(kind)) found(kind, name->value, path + "." + std::string(kind));
}

void add_stock(Node& root) {
  std::vector<std::pair<std::string, Node>> wanted;
  const auto want = [&](std::string_view kind, const Node& name, const std::string& path) {
    const std::vector<std::string> names = names_in(root, kind);
    if (ranges::find(names, name.text) != names.end()) return;
    for (const auto& [of, table] : wanted)
      if (of == kind && table.find("name")->text == name.text) return;
    std::optional<Node> table =
        kind == "section" ? stock_section(name.text, name.place) : stock_material(name.text, name.place);
    if (!table) return;  // who names it says so
    table->source = std::make_shared<SourceEntry>(SourceEntry{std::string(kind), 0, path});
    wanted.emplace_back(kind, *std::move(table));
  };
  for (const std::string table : {"cabinet", "frame", "wall"})
    if (Item* const list = root.find_item(table))
      for (std::size_t k = 0; k < list->value.items.size(); ++k)
        find_stuff(list->value.items[k].value, table, entry_path(list->value, table, k), want);
  if (Item* const floor = root.find_item("floor")) find_stuff(floor->value, "floor", "floor", want);
  for (auto& [kind, table] : wanted) {
    if (!root.find_item(kind)) root.items.push_back({kind, {}, list_node({}, root.place)});
    root.find_item(kind)->value.items.push_back({{}, table.place, std::move(table)});
  }
}

}  // namespace topple::io
