// The kinds of furniture, with their pictures.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/furnish/room_picture.h"
#include "render/output/stage.h"
#include "render/scene/font.h"
#include "solver/io/scene/scene.h"

namespace topple::app {

class Palette {
 public:
  /// A kind as it would stand.
  struct Card {
    std::string kind, about;  ///< about: its title, size and mass
    PieceShape shape;
    Vec2 half = Vec2::Zero();  ///< m, of its footprint
    Vec3 size = Vec3::Zero();  ///< m
    void* picture = nullptr;   ///< an ImTextureID
  };

  explicit Palette(render::Stage& stage);

  /// Draws one picture at most. True when there is a new one.
  bool update();
  /// True when all have theirs.
  bool complete() const { return drawn_ == cards_.size(); }
  const std::vector<Card>& cards() const { return cards_; }
  /// Of a kind; null: it is not known.
  const Card* card(const std::string& kind) const;
  /// A kind of one's own, a file beside `origin`; it joins the cards. Throws io::InputError with what is
  /// wrong with the file.
  const Card& add(const std::string& file, const std::string& origin);

  /// Cards, as many in a row as the panel holds; `armed` is marked. Returns the kind that the mouse went down
  /// on, or that has the focus of the keyboard and was chosen.
  std::optional<std::string> draw(const std::string& armed, const render::OverlayFonts& fonts) const;

 private:
  void build(Card& card, const std::string& origin) const;

  render::Stage& stage_;
  std::vector<Card> cards_;
  std::size_t drawn_ = 0;
};

}  // namespace topple::app
