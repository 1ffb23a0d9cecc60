#include "solver/io/scene/furniture.h"

#include <algorithm>
#include <memory>
#include <set>

#include "solver/io/scene/furniture_kind.h"
#include "solver/io/scene/furniture_piece.h"
#include "solver/io/scene/scene_file.h"
#include "solver/io/scene/scene_keys.h"
#include "solver/math/ranges.h"

namespace topple::io {
namespace {

constexpr const char* k_furniture = "furniture";

/// Keys of [[furniture]] itself; all others are of the body.
bool is_own(std::string_view key) {
  return ranges::any_of(scene_keys(),
                        [&](const Key& row) { return row.table == k_furniture && row.name == key; });
}

void override_body(Piece& piece) {
  for (const Item& item : piece.entry.node()->items) {
    if (is_own(item.key)) continue;
    if (!find_key(piece.kind.table, item.key))
      piece.entry.fail(
          item.key, "is no key of a [[" + piece.kind.table + "]], which a " + piece.kind.name + " becomes");
    set_key(piece.body, item.key, item.value);
  }
}

/// "bookshelf", "bookshelf-2": of its kind where the entry has no name.
std::string name_of(const Piece& piece, std::set<std::string>& taken) {
  if (piece.entry.has("name")) return piece.entry.text("name");
  for (std::size_t number = 1;; ++number) {
    const std::string name = piece.kind.name + (number == 1 ? "" : "-" + std::to_string(number));
    if (taken.insert(name).second) return name;
  }
}

std::set<std::string> written_names(const Node& root) {
  std::set<std::string> names;
  for (const Item& table : root.items)
    for (const Item& entry : table.value.items)
      if (const Node* const name = entry.value.find("name")) names.insert(name->text);
  return names;
}

void read_contents(Piece& piece, double volume) {
  const Vec3 share = piece.size.cwiseQuotient(piece.kind.size);
  piece.contents_mass = piece.kind.contents_mass * volume;
  piece.contents_cg = piece.kind.contents_cg.cwiseProduct(share);
  const Entry contents = piece.entry.entry("contents");
  if (!contents.present()) return;
  if (contents.has("mass")) piece.contents_mass = contents.number("mass");
  if (contents.has("cg")) piece.contents_cg = contents.vector("cg");
}

std::vector<Piece> read_pieces(const Node& root, const std::string& origin, const ReadSceneFile& read,
                               std::vector<SceneFile>& files) {
  const Entry top(origin, "", "", &root, root.place);
  std::vector<Node> sections;
  if (const Node* const list = root.find("section"))
    for (const Item& item : list->items) sections.push_back(item.value);
  std::set<std::string> taken = written_names(root);
  std::vector<Piece> pieces;
  for (const Entry& entry : top.entries(k_furniture)) {
    const Node& kind_name = *entry.node()->find("kind");
    Piece& piece = pieces.emplace_back(Piece{
        entry, furniture_kind(kind_name.text, origin, kind_name.place, entry.path() + ".kind", read, files)});
    piece.body = piece.kind.body;
    if (!kind_name.text.ends_with(".toml")) set_place(piece.body, entry.place());
    piece.body.place = entry.place();
    override_body(piece);
    piece.name = name_of(piece, taken);
    const Node* const name = entry.node()->find("name");
    set_key(piece.body, "name", text_node(piece.name, name ? name->place : entry.place()));
    piece.size = entry.has("size") ? entry.vector("size") : piece.kind.size;
    const double volume = piece.size.prod() / piece.kind.size.prod();
    piece.mass = entry.has("mass") ? entry.number("mass") : piece.kind.mass * volume;
    read_contents(piece, volume);
    std::vector<Node> known = sections;
    known.insert(known.end(), piece.kind.sections.begin(), piece.kind.sections.end());
    piece.width = section_widths(std::move(known), origin);
  }
  return pieces;
}

void append(Node& root, const std::string& table, Node entry) {
  if (!root.find_item(table)) root.items.push_back({table, entry.place, list_node({}, entry.place)});
  root.find_item(table)->value.items.push_back({{}, entry.place, std::move(entry)});
}

std::size_t copies_in(const Node& entry) {
  const Node* const copies = entry.find("copies");
  return copies ? std::max<std::size_t>(1, copies->items.size()) : 1;
}

}  // namespace

void expand_furniture(Node& root, const std::string& origin, const ReadSceneFile& read,
                      std::vector<SceneFile>& files) {
  if (!root.find(k_furniture)) return;
  std::vector<Piece> pieces = read_pieces(root, origin, read, files);
  for (Piece& piece : pieces) fit(piece);
  place_pieces(pieces, Entry(origin, "", "", &root, root.place));
  std::set<std::string> added;
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    Piece& piece = pieces[k];
    piece.body.source = std::make_shared<SourceEntry>(SourceEntry{k_furniture, k + 1, piece.entry.path()});
    append(root, piece.kind.table, std::move(piece.body));
    if (!added.insert(piece.kind.name).second) continue;
    for (Node& material : piece.kind.materials) append(root, "material", std::move(material));
    for (Node& section : piece.kind.sections) append(root, "section", std::move(section));
  }
  std::erase_if(root.items, [](const Item& item) { return item.key == k_furniture; });
}

std::vector<FurniturePiece> furniture_of(const Scene& scene) {
  const std::string origin = scene.name + ".toml";
  const Node root = parse_toml(scene.text, origin);
  std::vector<SceneFile> files;
  std::vector<FurniturePiece> all;
  std::vector<Piece> pieces = read_pieces(root, origin, kept_files(scene), files);
  for (const Piece& piece : pieces)
    all.push_back({.name = piece.name,
                   .kind = piece.entry.text("kind"),
                   .table = piece.kind.table,
                   .number = all.size() + 1,
                   .size = piece.size,
                   .rocking_size = rocking_size(piece),
                   .mass = piece.mass,
                   .contents_mass = piece.contents_mass,
                   .contents_cg = piece.contents_cg,
                   .at = Vec3::Zero(),
                   .yaw = 0});
  place_pieces(pieces, Entry(origin, "", "", &root, root.place));
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    all[i].at = pieces[i].stand.at;
    all[i].yaw = pieces[i].stand.yaw;
  }
  return all;
}

std::vector<BodyEntry> body_entries(const Scene& scene) {
  const std::string origin = scene.name + ".toml";
  Node root = parse_toml(scene.text, origin);
  std::vector<SceneFile> files;
  expand_furniture(root, origin, kept_files(scene), files);
  std::vector<BodyEntry> all;
  std::size_t first = 0;
  for (const std::string_view table : k_furniture_bodies) {
    const Node* const list = root.find(table);
    for (std::size_t i = 0; list && i < list->items.size(); ++i) {
      const Node& entry = list->items[i].value;
      const std::size_t bodies = copies_in(entry);
      if (entry.source)
        all.push_back({entry.source->table, entry.source->number, first, bodies});
      else
        all.push_back({std::string(table), i + 1, first, bodies});
      first += bodies;
    }
  }
  return all;
}

}  // namespace topple::io
