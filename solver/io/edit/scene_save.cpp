#include "solver/io/edit/scene_save.h"

#include <algorithm>
#include <cmath>

#include "solver/contact/contact_law.h"
#include "solver/frame/integrator.h"
#include "solver/io/document/scene_document.h"
#include "solver/io/edit/edit_text.h"
#include "solver/io/edit/scene_rewrite.h"
#include "solver/io/scene/furniture.h"
#include "solver/io/scene/scene_file.h"
#include "solver/math/ranges.h"
#include "solver/model/excitation.h"

namespace topple::io {
namespace {

constexpr int k_most_rounds = 4;  // a value that was written may change what absent ones mean

std::string toml_of(Edit edit) {
  // A sweep that does not change is refused; the number next to it is not.
  if (edit.key == Edit::Key::frequency && edit.value.y() == edit.value.x())
    edit.value.y() = std::nextafter(edit.value.y(), 1e9);
  return edit_value_text(edit, EditSpelling::in_scene);
}

class Rewriting {
 public:
  Rewriting(const Scene& scene, const Parameters& now)
      : model_(scene.setup.model),
        now_(now),
        entries_(body_entries(scene)),
        analysis_(find_key("run", "analysis")->choices[static_cast<std::size_t>(scene.setup.run.analysis)]) {
    saved_.text = scene.text;
  }

  SavedScene run(const Scene& scene) {
    take(scene.setup.parameters);
    if (scene.title.ends_with(k_title_changed) && parse_toml(saved_.text, "scene").find("title"))
      add({"title"}, written_text(scene.title.substr(0, scene.title.size() - k_title_changed.size())));
    for (int round = 0;; ++round) {
      saved_.text = rewrite_toml(saved_.text, changes_);
      changes_.clear();
      const Scene read = parse_scene(saved_.text, scene.name + ".toml", {}, files_of(scene));
      take(read.setup.parameters);
      if (changes_.empty()) return saved_;
      if (round < k_most_rounds) continue;
      for (const auto& [key, index] : different(read.setup.parameters))
        saved_.given_up.push_back(edit_key({key, index}));
      return saved_;
    }
  }

 private:
  std::vector<std::pair<Edit::Key, int>> different(const Parameters& read) const {
    std::vector<std::pair<Edit::Key, int>> keys;
    for (const auto& [key, index] : editable(model_, now_)) {
      const bool retyped = is_of_shake(key) && kind(read, index) != kind(now_, index);
      if (!retyped && edited_value(read, key, index) == edited_value(now_, key, index)) continue;
      if (key == Edit::Key::integrator && !frames_only()) continue;
      if (key == Edit::Key::friction_static && read.contact.friction_static == 0 &&
          now_.contact.excess() == 0)
        continue;  // it goes with friction
      const auto& analyses = key_of(key).analyses;
      if (!analyses.empty() && ranges::find(analyses, analysis_) == analyses.end()) continue;
      keys.emplace_back(key, index);
    }
    return keys;
  }

  void take(const Parameters& read) {
    const Node root = parse_toml(saved_.text, "scene");
    for (const auto& [key, index] : different(read)) change({key, index, edited_value(now_, key, index)});
    // chosen together with an alpha that the scene left out, and states now
    if (const double share = now_.contact.member_share;
        model_.bodies.size() > 1 && read.contact.member_share != share)
      add({"contact", "member_share"}, shortest_digits(share));
    for (std::size_t i = 0; i < now_.shakes.size(); ++i) drop_foreign(root, i);
    drop_foreign(root, read);
    if (!frames_only() && read.integrator != now_.integrator && saved_.given_up.empty())
      saved_.given_up.push_back(edit_key({Edit::Key::integrator}));
  }

  void change(const Edit& edit) {
    const std::string value = toml_of(edit);
    const Edit::Of of = traits(edit.key).of;
    if (of == Edit::Of::body) {
      const BodyEntry& entry = *ranges::find_if(entries_, [&](const BodyEntry& one) {
        return static_cast<std::size_t>(edit.index) < one.first_body + one.bodies;
      });
      for (std::size_t b = entry.first_body; b < entry.first_body + entry.bodies; ++b)
        if (edited_value(now_, edit.key, static_cast<int>(b)) != edit.value)
          throw InputError(edit_key(edit) + ": \"" + model_.bodies[b].name + "\" is a copy of the same [[" +
                           entry.table + "]] and has another; copies have the same");
      add({entry.table, std::to_string(entry.number), std::string(key_of(edit.key).name)}, value);
      return;
    }
    const Key& key = key_of(edit.key);
    if (of == Edit::Of::anchor && !model_.anchors[static_cast<std::size_t>(edit.index)].fixing.empty())
      return change_fixing(edit, value);
    if (traits(of).numbered)
      add({std::string(key.table), std::to_string(edit.index + 1), std::string(key.name)}, value);
    else
      add({std::string(key.table), std::string(key.name)}, value);
  }

  /// An anchor that a [[fixing]] stands for, with all others of it.
  void change_fixing(const Edit& edit, const std::string& value) {
    const auto index = static_cast<std::size_t>(edit.index);
    const int number = model_.anchors[index].fixing_number;
    for (std::size_t k = 0; k < model_.anchors.size(); ++k)
      if (model_.anchors[k].fixing_number == number && now_.anchors[k] != now_.anchors[index])
        throw InputError(edit_key(edit) + ": \"" + model_.anchors[k].name +
                         "\" is of the same [[fixing]] and not " + value + "; its points go together");
    add({"fixing", std::to_string(number), "on"}, value);
  }

  /// Takes out keys that belong to another choice than the one made now.
  void drop(const Node& table, const std::string& name, const std::vector<std::string>& path,
            std::string_view choice, std::string_view made) {
    for (const Item& item : table.items) {
      const Key* const key = find_key(name, item.key);
      if (!key || key->of != choice || ranges::find(key->when, made) != key->when.end()) continue;
      std::vector<std::string> all = path;
      all.push_back(item.key);
      changes_.push_back({std::move(all), std::nullopt});
    }
  }

  void drop_foreign(const Node& root, std::size_t i) {
    const Shake& shake = now_.shakes[i];
    const Node* const list = root.find("shake");
    if (!list || i >= list->items.size()) return;
    const Node& entry = list->items[i].value;
    const std::string number = std::to_string(i + 1);
    drop(entry, "shake", {"shake", number}, "type", traits(shake.kind).word);
    if (traits(shake.kind).sweeps && entry.find("taper") &&
        2 * shake.taper > shake_turns(shake, shake.start + shake.duration))
      changes_.push_back({{"shake", number, "taper"}, std::nullopt});
  }

  void drop_foreign(const Node& root, const Parameters& read) {
    if (const Node* const contact = root.find("contact"))
      drop(*contact, "contact", {"contact"}, "law", traits(now_.contact).word);
    const Node* const run = root.find("run");
    if (!run) return;
    if (frames_only() && read.integrator != now_.integrator)
      drop(*run, "run", {"run"}, "integrator", traits(now_.integrator).word);
    if (!now_.adaptive) drop(*run, "run", {"run"}, "time_step", "");
  }

  static bool is_of_shake(Edit::Key key) { return traits(key).of == Edit::Of::shake; }
  static Shake::Kind kind(const Parameters& p, int shake) {
    return p.shakes[static_cast<std::size_t>(shake)].kind;
  }

  /// A scene that names an integrator has no rigid, elastic or automatic bodies.
  bool frames_only() const {
    return ranges::all_of(now_.models, [](BodyModel m) { return m == BodyModel::frame; });
  }

  void add(std::vector<std::string> path, const std::string& value) {
    changes_.push_back({std::move(path), value});
  }

  const Model& model_;
  const Parameters& now_;
  const std::vector<BodyEntry> entries_;
  const std::string_view analysis_;
  SavedScene saved_;
  std::vector<KeyChange> changes_;
};

}  // namespace

ReadSceneFile files_of(const Scene& scene) {
  return [&scene, elsewhere = builtin_files()](const std::string& name) {
    for (const SceneFile& file : scene.files)
      if (file.name == name) return file.bytes;
    return elsewhere(name);
  };
}

SavedScene edited_scene(const Scene& scene, const Parameters& now) {
  return Rewriting(scene, now).run(scene);
}

Scene scene_with_record(const Scene& scene, const std::vector<std::string>& files) {
  std::string names;
  for (const std::string& file : files) names += (names.empty() ? "" : ", ") + written_text(file);
  std::vector<KeyChange> changes{{{"shake", "1", "type"}, "\"record\""},
                                 {{"shake", "1", "files"}, "[" + names + "]"}};
  const Node root = parse_toml(scene.text, scene.name);
  if (const Node* const shakes = root.find("shake"); shakes && !shakes->items.empty())
    for (const Item& item : shakes->items[0].value.items) {
      const Key* const key = find_key("shake", item.key);
      const bool stays = !key || key->of.empty();
      // What was said of another record does not hold for this one.
      if (!stays && item.key != "files") changes.push_back({{"shake", "1", item.key}, std::nullopt});
    }
  return parse_scene(rewrite_toml(scene.text, changes), scene.name + ".toml", {}, files_of(scene));
}

}  // namespace topple::io
