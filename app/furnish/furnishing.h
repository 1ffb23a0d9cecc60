// The room that is being furnished: its scene's text, what it means, and the way back.
#pragma once

#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/picture/room_piece.h"
#include "solver/io/scene/scene.h"

namespace topple::app {

/// The text of a changed room; room_edits.h has them. May throw io::InputError.
using RoomEdit = std::function<std::string(const io::Scene&)>;

class Furnishing {
 public:
  /// `origin`: what errors call the scene, beside which its files lie. Throws io::InputError where the text
  /// of the scene does not load.
  Furnishing(const io::Scene& scene, std::string origin);
  Furnishing(const Furnishing&) = delete;
  Furnishing& operator=(const Furnishing&) = delete;

  /// The room as it is. Its bodies are rigid where they may be: it is to be looked at and checked, not run.
  const io::Scene& scene() const { return *scene_; }
  const std::string& text() const { return scene_->text; }
  const std::vector<RoomPiece>& pieces() const { return pieces_; }
  /// The body's; null: there is none of this name.
  const RoomPiece* piece(const std::string& name) const;

  /// Makes it where the reader of scenes has nothing against it. False: the room is as it was, and refused()
  /// says why.
  bool change(const RoomEdit& edit);
  /// In the words of the reader: "furniture.desk: the bodies ... overlap at the start"; empty after a change.
  const std::string& refused() const { return refused_; }
  void refuse(const std::string& words) { refused_ = words; }
  void forget_refusal() { refused_.clear(); }
  /// Why the change would be refused; empty: it would not.
  std::string objection(const RoomEdit& edit) const;

  /// Looks at a change on a thread of its own. What was asked before it and has not begun is dropped.
  void ask(RoomEdit edit);
  /// Nobody wants the answer any more.
  void forget_question();
  /// Takes in answers. True when there is a new one.
  bool update();
  /// objection() to what was asked last, as far as it is known; nothing: not yet.
  const std::optional<std::string>& answer() const { return answer_; }

  bool can_undo() const { return at_ > 0; }
  bool can_redo() const { return at_ + 1 < texts_.size(); }
  void undo();
  void redo();

  /// Loads the whole scene, as a run needs it; on any thread. Throws io::InputError.
  std::function<io::Scene()> loader() const;

  /// What an error says, without the file and line of the room itself.
  std::string words_of(const io::InputError& error) const;

 private:
  using ScenePtr = std::shared_ptr<const io::Scene>;
  ScenePtr read(const std::string& text) const;
  void show(ScenePtr scene);
  void go_to(std::size_t at);

  std::string origin_;
  std::vector<io::SceneFile> files_;  ///< that the scene came with
  ScenePtr scene_;
  std::vector<RoomPiece> pieces_;
  std::vector<std::string> texts_;  ///< all that it was, and may become again
  std::size_t at_ = 0;
  std::string refused_;
  std::future<std::string> running_;
  std::optional<RoomEdit> next_;
  bool wanted_ = false;  ///< the answer of running_
  std::optional<std::string> answer_;
};

}  // namespace topple::app
