// Materials and sections that scenes need not define.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "solver/io/document/scene_document.h"

namespace topple::io {

/// [[material]] by name: "steel", "wood"; none: there is no such one. Sources stand beside the numbers.
std::optional<Node> stock_material(std::string_view name, const Place& place);

/// [[section]] by what it is, sizes in mm, outer sizes first, then the wall: "box 30x1", "box 40x20x1.2",
/// "solid 30", "solid 40x20", "pipe 25x1.2", and "sheet 700x25": a sheet as one member, whose contact width
/// is its thickness. None: the name is no such text.
std::optional<Node> stock_section(std::string_view name, const Place& place);

/// What is wrong with a name of `kind`, "material" or "section", that is not among `known` nor in stock.
std::string no_such_stuff(std::string_view kind, const std::string& name,
                          const std::vector<std::string>& known);

/// Calls found(kind, name, path) on every text of the entry at `path` of `table` that names a material or a
/// section, those of its members included.
void find_stuff(Node& entry, std::string_view table, const std::string& path,
                const std::function<void(std::string_view kind, Node& name, const std::string& path)>& found);

/// Adds to a checked scene what it names without defining it.
void add_stock(Node& root);

}  // namespace topple::io
