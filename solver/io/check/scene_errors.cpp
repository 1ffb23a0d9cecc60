#include "solver/io/check/scene_errors.h"

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>

#include "solver/io/scene/scene_check.h"
#include "solver/math/ranges.h"

namespace topple::io {
namespace {

constexpr int k_most_errors = 200;
constexpr const char* k_there_is_no = "there is no ";
constexpr const char* k_too_large = "brings the scene to ";  // all that follows would do so as well
constexpr const char* k_overlap = " overlap at the start";
constexpr const char* k_inside = "lies inside ";
constexpr const char* k_no_kind = "there is no kind ";  // kinds do not depend on the scene

bool same(const Place& a, const Place& b) {
  return a.line == b.line && a.column == b.column && a.override_text == b.override_text;
}

/// From the root to an item: the node that holds it, and which of its items it is.
using Trail = std::vector<std::pair<Node*, std::size_t>>;

const Item& item_of(const Trail::value_type& step) {
  return step.first->items[step.second];
}

/// To the innermost item that was written at this place.
bool find_place(Node& node, const Place& place, Trail& trail) {
  for (std::size_t k = 0; k < node.items.size(); ++k) {
    Item& item = node.items[k];
    trail.emplace_back(&node, k);
    if (find_place(item.value, place, trail)) return true;
    if (same(item.key_place, place) || same(item.value.place, place)) return true;
    trail.pop_back();
  }
  return false;
}

bool is_entry(const Trail::value_type& step) {
  return step.first->kind == Node::Kind::list && item_of(step).value.kind == Node::Kind::table;
}

/// "frame.desk.members": of a key or entry.
std::string path_of(const Trail& trail) {
  std::string path;
  for (const auto& step : trail)
    path += (path.empty() ? "" : ".") +
            (is_entry(step) ? entry_label(*step.first, step.second) : item_of(step).key);
  return path;
}

/// "cabinet.free": of the entry of a list that a trail leads into; else empty.
std::string entry_path(const Trail& trail) {
  if (trail.size() < 2 || !is_entry(trail[1])) return "";
  return item_of(trail[0]).key + "." + entry_label(*trail[1].first, trail[1].second);
}

class Collector {
 public:
  Collector(Node root, const SceneSource& source) : written_(root), root_(std::move(root)), source_(source) {}

  CheckedScene collect() {
    CheckedScene result;
    for (int n = 0; n < k_most_errors; ++n) try {
        Scene scene = understand(root_, source_, source_.text);
        if (found_.empty()) result.scene = std::move(scene);
        break;
      } catch (const SceneError& error) {
        if (!leave_out(error)) break;
      } catch (const InputError& error) {
        found_.push_back({{}, error.what()});
        break;
      }
    ranges::stable_sort(found_, {},
                        [](const Found& one) { return std::tuple(one.place.line, one.place.column); });
    for (Found& one : found_)
      if (ranges::find(result.errors, one.line) == result.errors.end())
        result.errors.push_back(std::move(one.line));
    return result;
  }

 private:
  struct Found {
    Place place;
    std::string line;
  };

  /// False: it is not known where.
  bool leave_out(const SceneError& error) {
    if (error.path.empty() && !names_.empty())
      return stand_in();  // of the scene as a whole: no bodies are left
    if (!error.place.override_text && !std::string_view(error.what()).starts_with(source_.origin + ":")) {
      found_.push_back({{}, error.what()});  // of the file of a kind
      return false;
    }
    Trail trail, as_written;
    const bool there = find_place(root_, error.place, trail);
    find_place(written_, error.place, as_written);
    const std::string error_path = path_as_written(error, trail, as_written);
    if (!follows(error.message, error_path))
      found_.push_back(
          {error.place, error_line(source_.origin, error.place, error_path, without_known(error.message))});
    if (error.message.starts_with(k_too_large)) return false;
    if (!there || error.path.empty() || as_written.size() != trail.size()) return false;
    while (!is_entry(trail.back()) && trail.back().first->kind != Node::Kind::table) trail.pop_back();
    // one without a name would be another
    if (item_of(trail.back()).key == "name" && trail.size() > 1) trail.pop_back();
    as_written.resize(trail.size());
    const std::string left_out = path_of(as_written);
    moved_ = moved_ || (!error.message.ends_with(k_overlap) &&
                        (left_out.starts_with("furniture.") || left_out.starts_with("wall.")));
    Node& holder = *trail.back().first;
    const std::size_t index = trail.back().second;
    if (!is_entry(trail.back())) {
      keys_.insert(left_out);
    } else {
      const Trail list(as_written.begin(), as_written.end() - 1);
      names_.insert(entry_name(*as_written.back().first, item_of(list.back()).key, as_written.back().second));
      // a piece of furniture is called after its kind
      if (const Node* const kind = item_of(as_written.back()).value.find("kind")) names_.insert(kind->text);
      if (list.size() > 1) keys_.insert(path_of(list));
    }
    holder.items.erase(holder.items.begin() + static_cast<std::ptrdiff_t>(index));
    return true;
  }

  /// The path with the number that the entry has in the file.
  static std::string path_as_written(const SceneError& error, const Trail& now, const Trail& as_written) {
    const std::string here = entry_path(now), there = entry_path(as_written);
    const bool moved = !here.empty() && error.path.starts_with(here);
    return moved ? there + error.path.substr(here.size()) : error.path;
  }

  /// What else there is, is not known when some of it was left out.
  std::string without_known(const std::string& message) const {
    const std::size_t first = message.find('"'), last = message.find('"', first + 1);
    const bool lists = message.starts_with(k_there_is_no) && !message.starts_with(k_no_kind) &&
                       last != message.npos && !names_.empty();
    return lists ? message.substr(0, last + 1) : message;
  }

  /// A body, so that what follows the bodies is read too. False: there is one.
  bool stand_in() {
    if (std::exchange(stands_in_, true)) return false;
    const Node block = parse_toml("[[block]]\nsize = [1, 1, 1]\nmass = 1\nat = [900, 900]", "");
    std::erase_if(root_.items, [](const Item& item) { return item.key == "block"; });
    root_.items.push_back(block.items.front());
    return true;
  }

  bool follows(const std::string& message, const std::string& error_path) const {
    if (moved_ && (message.ends_with(k_overlap) || message.starts_with(k_inside)))
      return true;  // what stands where it should not
    for (const std::string& path : keys_) {
      if (path == error_path || path.starts_with(error_path + ".")) return true;  // an entry without its key
      const std::string key = path.substr(path.rfind('.') + 1);
      if (message.starts_with("belongs to ") && message.find('`' + key + '`') != std::string::npos)
        return true;
      for (const char* how : {" is ", " = "})
        if (message.find("but " + key + how) != std::string::npos) return true;
    }
    if (!message.starts_with(k_there_is_no)) return false;
    const auto is_kind = [](const std::string& path) {
      return path.starts_with("furniture.") && path.ends_with(".kind");
    };
    for (const char* what : {"[[furniture]]", "body"})
      if (message.starts_with(std::string(k_there_is_no) + what) && ranges::any_of(keys_, is_kind))
        return true;  // it may be the piece that is called after its kind
    // copies of an entry are called after it
    return ranges::any_of(names_, [&](const std::string& name) {
      return message.find('"' + name + '"') != std::string::npos ||
             message.find('"' + name + '-') != std::string::npos;
    });
  }

  Node written_, root_;
  const SceneSource& source_;
  std::vector<Found> found_;
  std::set<std::string> keys_, names_;  // left out: paths of keys, names of entries
  bool moved_ = false;                  // something of furniture or walls was left out, by which others stand
  bool stands_in_ = false;
};

}  // namespace

CheckedScene check_whole_scene(const SceneSource& source, const std::vector<std::string>& overrides) {
  CheckedScene result;
  try {
    Node root = parse_toml(source.text, source.origin);
    std::vector<std::string> refused;
    for (const std::string& change : overrides) try {
        apply_override(root, change);
      } catch (const InputError& error) {
        refused.emplace_back(error.what());
      }
    result = Collector(std::move(root), source).collect();
    result.errors.insert(result.errors.begin(), refused.begin(), refused.end());
    if (!refused.empty()) result.scene.reset();
  } catch (const InputError& error) {
    result.errors.emplace_back(error.what());
  }
  return result;
}

}  // namespace topple::io
