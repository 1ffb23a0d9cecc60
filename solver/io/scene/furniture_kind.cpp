#include "solver/io/scene/furniture_kind.h"

#include <algorithm>
#include <filesystem>
#include <map>

#include "solver/io/builtin/builtin.h"
#include "solver/io/builtin/stock.h"
#include "solver/io/common/nearest_name.h"
#include "solver/io/scene/scene_check.h"
#include "solver/io/scene/scene_file.h"
#include "solver/io/scene/scene_keys.h"
#include "solver/io/scene/scene_read.h"
#include "solver/math/ranges.h"

namespace topple::io {
namespace {

namespace fs = std::filesystem;

void set_file(Node& node, const std::shared_ptr<const std::string>& file) {
  node.place.file = file;
  for (Item& item : node.items) {
    item.key_place.file = file;
    set_file(item.value, file);
  }
}

/// The kind's one body: its table.
std::string body_table(const Node& root, const std::string& origin) {
  std::string table;
  for (const Item& item : root.items) {
    const bool body = ranges::find(k_furniture_bodies, item.key) != std::end(k_furniture_bodies);
    const bool stays = item.key == "topple" || item.key == "title" || item.key == "kind" ||
                       item.key == "material" || item.key == "section";
    if (!body && !stays)
      fail(origin, item.key_place, item.key,
           "has no place in a kind of furniture, which has [kind], [[material]], [[section]] and one "
           "[[cabinet]], [[frame]] or [[block]]");
    if (body && (!table.empty() || item.value.items.size() != 1))
      fail(origin, item.value.place, item.key, "a kind of furniture has one body");
    if (body) table = item.key;
  }
  if (table.empty())
    fail(origin, root.place, "", "a kind of furniture has one [[cabinet]], [[frame]] or [[block]]");
  return table;
}

void refuse_places(const Node& body, const std::string& origin, const std::string& path) {
  for (const Item& item : body.items)
    if (item.key == "at" || item.key == "yaw" || item.key == "copies")
      fail(origin, item.key_place, path + "." + item.key, "a kind of furniture stands nowhere: leave it out");
}

/// The file's own materials or sections under the name of the kind, by the names that they had.
std::map<std::string, Node> renamed(const Node& root, const std::string& key, const std::string& kind) {
  std::map<std::string, Node> own;
  if (const Node* const list = root.find(key))
    for (const Item& item : list->items) {
      const std::string name = item.value.find("name")->text;
      Node& table = own[name] = item.value;
      table.find_item("name")->value.text = kind + "/" + name;
    }
  return own;
}

/// Reads a file; `origin` is what errors call it.
FurnitureKind read_kind(std::string_view text, const std::string& name, const std::string& origin) {
  Node root = parse_toml(text, origin);
  check_scene(root, origin);
  FurnitureKind kind;
  kind.name = name;
  kind.table = body_table(root, origin);
  const auto of_file = std::make_shared<const std::string>(origin);
  set_file(root, of_file);
  const Entry top(origin, "", "", &root, root.place), about = top.entry("kind");
  if (!about.present()) top.fail("kind", "missing; a kind of furniture has [kind] with its source");
  kind.title = top.has("title") ? top.text("title") : name;
  kind.source = about.text("source");

  kind.body = root.find(kind.table)->items.front().value;
  const std::string path = entry_path(*root.find(kind.table), kind.table, 0);
  refuse_places(kind.body, origin, path);
  const Entry body(origin, kind.table, path, &kind.body, kind.body.place);
  if (!body.has("mass")) body.fail("mass", "missing; a kind of furniture has a mass");
  if (!(body.number("mass") > 0)) body.fail("mass", "a kind of furniture has a mass above 0");
  kind.mass = body.number("mass");

  std::map<std::string, std::map<std::string, Node>> own;
  for (const char* const key : {"material", "section"}) own[key] = renamed(root, key, name);
  find_stuff(kind.body, kind.table, path, [&](std::string_view key, Node& stuff, const std::string& at) {
    const auto& known = own[std::string(key)];
    if (known.contains(stuff.text)) {
      stuff.text = name + "/" + stuff.text;
      return;
    }
    if (key == "section" ? stock_section(stuff.text, {}).has_value()
                         : stock_material(stuff.text, {}).has_value())
      return;
    std::vector<std::string> names;
    for (const auto& [of, table] : known) names.push_back(of);
    fail(origin, stuff.place, at, no_such_stuff(key, stuff.text, names));
  });
  for (auto& [of, table] : own["material"]) kind.materials.push_back(std::move(table));
  for (auto& [of, table] : own["section"]) kind.sections.push_back(std::move(table));
  std::erase_if(kind.body.items, [](const Item& item) { return item.key == "name"; });

  kind.size = outer_size(kind.table, Entry(origin, kind.table, path, &kind.body, kind.body.place),
                         section_widths(kind.sections, origin));
  const Entry contents = about.entry("contents");
  kind.contents_mass = contents.present() ? contents.number("mass") : 0;
  kind.contents_cg = contents.has("cg") ? contents.vector("cg") : Vec3(0, 0, kind.size.z() / 2);
  check_inside(contents, kind.contents_cg, kind.size);
  return kind;
}

}  // namespace

const std::vector<FurnitureKind>& furniture_kinds() {
  static const std::vector<FurnitureKind> kinds = [] {
    std::vector<FurnitureKind> all;
    for (const BuiltinScene& file : builtin_furniture())
      all.push_back(read_kind(file.text, std::string(file.name), std::string(file.name) + ".toml"));
    return all;
  }();
  return kinds;
}

FurnitureKind furniture_kind(const std::string& name, const std::string& origin, const Place& place,
                             const std::string& path, const ReadSceneFile& read,
                             std::vector<SceneFile>& files) {
  if (name.ends_with(".toml")) {
    const std::string file = (fs::path(origin).parent_path() / name).string();
    try {
      return read_kind(bytes_of(name, read, files), kind_stem(name), file);
    } catch (const InputError& error) {
      if (ranges::find(files, name, &SceneFile::name) != files.end()) throw;
      fail(origin, place, path, error.what());  // it could not be read
    }
  }
  std::vector<std::string> names;
  std::string known;
  for (const BuiltinScene& kind : builtin_furniture()) {
    names.emplace_back(kind.name);
    known += (known.empty() ? "" : ", ") + names.back();
  }
  for (const FurnitureKind& kind : furniture_kinds())
    if (kind.name == name) return kind;
  const std::string nearest = nearest_name(name, names);
  fail(origin, place, path,
       "there is no kind \"" + name + "\"; " + (nearest.empty() ? "" : "the nearest is " + nearest + "; ") +
           "known: " + known + ", or a file \"NAME.toml\"");
}

}  // namespace topple::io
