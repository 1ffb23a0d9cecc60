#include "app/picture/solid_bodies.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "app/picture/rigid_fit.h"
#include "app/picture/room_piece.h"
#include "app/picture/row.h"
#include "solver/io/document/scene_document.h"

namespace topple::app {
namespace {

using render::Float4;

constexpr Float4 k_oak = {0.66f, 0.49f, 0.32f, 1}, k_walnut = {0.45f, 0.31f, 0.21f, 1},
                 k_beech = {0.78f, 0.64f, 0.46f, 1}, k_grey = {0.70f, 0.73f, 0.76f, 1},
                 k_green = {0.58f, 0.66f, 0.62f, 1}, k_blue = {0.48f, 0.59f, 0.70f, 1},
                 k_white = {0.92f, 0.93f, 0.94f, 1}, k_black = {0.15f, 0.16f, 0.18f, 1},
                 k_dark = {0.10f, 0.10f, 0.11f, 1}, k_metal = {0.55f, 0.58f, 0.62f, 1},
                 k_glass = {0.30f, 0.38f, 0.46f, 1}, k_carton = {0.74f, 0.60f, 0.43f, 1};
constexpr Float4 k_books[] = {{0.62f, 0.24f, 0.22f, 1}, {0.22f, 0.38f, 0.55f, 1}, {0.80f, 0.70f, 0.45f, 1},
                              {0.28f, 0.45f, 0.34f, 1}, {0.52f, 0.48f, 0.56f, 1}, {0.85f, 0.83f, 0.78f, 1}};

constexpr double k_inset = 0.015;  // m, of boards between beams: half of a usual section
constexpr double k_board = 0.020, k_seam = 0.006, k_relief = 0.003;  // m

/// What is seen of a kind.
struct KindLook {
  enum class Front { doors, shelves, books, screen, keys, porthole, mattress };
  std::string_view kind;
  Float4 colour;
  Front front;
  int rows, columns;  ///< of doors, drawers or shelves
  bool handles;
};
/// A kind that is not here is drawn as its beams.
constexpr KindLook k_kind_looks[] = {{"bed", k_oak, KindLook::Front::mattress, 1, 1, false},
                                     {"bookshelf", k_oak, KindLook::Front::books, 5, 1, false},
                                     {"cabinet", k_grey, KindLook::Front::doors, 1, 2, true},
                                     {"chest", k_walnut, KindLook::Front::doors, 4, 1, true},
                                     {"cupboard", k_beech, KindLook::Front::doors, 2, 2, true},
                                     {"filing-cabinet", k_green, KindLook::Front::doors, 4, 1, true},
                                     {"locker", k_blue, KindLook::Front::doors, 1, 3, true},
                                     {"piano", k_black, KindLook::Front::keys, 1, 1, false},
                                     {"refrigerator", k_white, KindLook::Front::doors, 2, 1, true},
                                     {"server-rack", k_black, KindLook::Front::doors, 14, 1, false},
                                     {"shelf-rack", k_metal, KindLook::Front::shelves, 4, 1, false},
                                     {"television", k_black, KindLook::Front::screen, 1, 1, false},
                                     {"wardrobe", k_walnut, KindLook::Front::doors, 1, 2, true},
                                     {"washing-machine", k_white, KindLook::Front::porthole, 1, 1, false}};

struct ColourOfMaterial {
  std::string_view material;
  Float4 colour;
};
constexpr ColourOfMaterial k_colours_of_materials[] = {{"wood", k_beech},
                                                       {"steel", k_metal},
                                                       {"stainless steel", k_grey},
                                                       {"aluminium", k_grey},
                                                       {"plastic", k_white}};

/// Boxes of a piece of this outer size about the middle of its base.
class Joinery {
 public:
  struct Piece {
    Vec3 centre, half;
    Float4 colour;
    bool round = false;
  };

  Joinery(const KindLook& look, const Vec3& size) : look_(look), size_(size) {
    switch (look.front) {
      case KindLook::Front::doors:
        box(Vec3(0, 0, size.z() / 2), size / 2, look.colour);
        fronts(0, size.z());
        break;
      case KindLook::Front::books:
      case KindLook::Front::shelves:
        shelves(look.front == KindLook::Front::books);
        break;
      case KindLook::Front::screen:
        screen();
        break;
      case KindLook::Front::keys:
        keys();
        break;
      case KindLook::Front::porthole:
        porthole();
        break;
      case KindLook::Front::mattress:
        mattress();
        break;
    }
  }

  std::vector<Piece> pieces;

 private:
  void box(const Vec3& centre, const Vec3& half, const Float4& colour) {
    pieces.push_back({centre, half, colour});
  }
  /// On the front, from y0 to y1 and z0 to z1, standing out by `out`.
  void on_front(double y0, double y1, double z0, double z1, double out, const Float4& colour) {
    box(Vec3(size_.x() / 2, (y0 + y1) / 2, (z0 + z1) / 2), Vec3(out, (y1 - y0) / 2, (z1 - z0) / 2), colour);
  }

  void fronts(double low, double high) {
    const double w = size_.y(), row = (high - low) / look_.rows, column = w / look_.columns;
    const Float4 seam = look_.colour == k_black ? k_metal : k_dark;
    for (int r = 1; r < look_.rows; ++r)
      on_front(-w / 2, w / 2, low + r * row - k_seam / 2, low + r * row + k_seam / 2, k_relief, seam);
    for (int c = 1; c < look_.columns; ++c)
      on_front(-w / 2 + c * column - k_seam / 2, -w / 2 + c * column + k_seam / 2, low, high, k_relief, seam);
    if (!look_.handles) return;
    const bool drawers = look_.columns == 1 && look_.rows > 2;
    for (int r = 0; r < look_.rows; ++r)
      for (int c = 0; c < look_.columns; ++c) {
        const double z = low + (r + 0.5) * row, y = -w / 2 + (c + 0.5) * column;
        if (drawers) {
          on_front(y - 0.12 * column, y + 0.12 * column, z - 0.010, z + 0.010, 0.018, k_metal);
        } else {
          // beside the middle of the piece, where two doors meet
          const double side = c + 0.5 < look_.columns / 2. || look_.columns == 1 ? 0.5 : -0.5;
          const double at = y + side * (column - 0.09);
          on_front(at - 0.010, at + 0.010, z - std::min(0.09, row / 4), z + std::min(0.09, row / 4), 0.018,
                   k_metal);
        }
      }
  }

  void shelves(bool books) {
    const double d = size_.x(), w = size_.y(), h = size_.z(), row = (h - k_board) / look_.rows;
    for (const double side : {-1., 1.})
      box(Vec3(0, side * (w - k_board) / 2, h / 2), Vec3(d / 2, k_board / 2, h / 2), look_.colour);
    if (books)
      box(Vec3(-(d - k_board) / 2, 0, h / 2), Vec3(k_board / 2, w / 2 - k_board, h / 2), look_.colour);
    for (int r = 0; r <= look_.rows; ++r)
      box(Vec3(0, 0, k_board / 2 + r * row), Vec3(d / 2, w / 2 - k_board, k_board / 2), look_.colour);
    const double inner = w - 2 * k_board;
    for (int r = 0; r < look_.rows; ++r) {
      const double low = k_board + r * row, space = row - k_board;
      const int count = books ? 9 : 3;
      const double each = inner / count;
      for (int i = 0; i < count; ++i) {
        const int mix = (7 * i + 5 * r + i * r) % 6;
        const double height = space * (books ? 0.68 + 0.04 * mix : 0.45 + 0.05 * mix);
        const double depth = d * (books ? 0.66 : 0.8) / 2, wide = each * (books ? 0.47 : 0.36);
        box(Vec3(books ? -0.04 * d : 0, -inner / 2 + (i + 0.5) * each, low + height / 2),
            Vec3(depth, wide, height / 2), books ? k_books[mix] : k_carton);
      }
    }
  }

  void screen() {
    const double w = size_.y(), h = size_.z(), stand = 0.4 * h;
    box(Vec3(0, 0, stand / 2), Vec3(size_.x() / 2, w / 2, stand / 2), k_walnut);
    on_front(-k_seam / 2, k_seam / 2, 0, stand, k_relief, k_dark);
    const Vec3 panel(0.04, w / 2, (h - stand - 0.04) / 2);
    box(Vec3(0, 0, stand + 0.02), Vec3(0.1, 0.16 * w, 0.02), k_metal);
    box(Vec3(0, 0, h - panel.z()), panel, k_black);
    box(Vec3(0.04, 0, h - panel.z()), Vec3(k_relief, panel.y() - 0.025, panel.z() - 0.025), k_glass);
  }

  void keys() {
    const double d = size_.x(), w = size_.y(), h = size_.z(), body = 0.55 * d;
    box(Vec3(-(d - body) / 2, 0, h / 2), Vec3(body / 2, w / 2, h / 2), look_.colour);
    box(Vec3((d - 0.45 * d) / 2, 0, 0.55 * h), Vec3(0.225 * d, w / 2, 0.07 * h), look_.colour);
    box(Vec3(0.30 * d, 0, 0.62 * h), Vec3(0.12 * d, 0.46 * w, 0.006), k_white);
    for (int i = -8; i <= 8; ++i)
      box(Vec3(0.26 * d, i * 0.052 * w, 0.625 * h), Vec3(0.075 * d, 0.010 * w, 0.008), k_dark);
    for (const double side : {-0.46, 0.46})
      box(Vec3(0.42 * d, side * w, 0.25 * h), Vec3(0.05 * d, 0.03 * w, 0.25 * h), look_.colour);
  }

  void porthole() {
    box(Vec3(0, 0, size_.z() / 2), size_ / 2, look_.colour);
    const double r = 0.30 * std::min(size_.y(), size_.z());
    const Vec3 at(size_.x() / 2, 0, 0.52 * size_.z());
    pieces.push_back({at, Vec3(0.012, r, r), k_metal, true});
    pieces.push_back({at, Vec3(0.016, 0.8 * r, 0.8 * r), k_glass, true});
    on_front(-0.42 * size_.y(), 0.42 * size_.y(), 0.88 * size_.z(), 0.95 * size_.z(), k_relief, k_grey);
  }

  void mattress() {
    const double d = size_.x(), w = size_.y(), h = size_.z();
    box(Vec3(0, 0, 0.45 * h), Vec3(d / 2, w / 2, 0.1 * h), look_.colour);
    for (const double x : {-0.47, 0.47})
      for (const double y : {-0.44, 0.44})
        box(Vec3(x * d, y * w, 0.2 * h), Vec3(0.03 * d, 0.06 * w, 0.2 * h), look_.colour);
    box(Vec3(0, 0, 0.72 * h), Vec3(0.49 * d, 0.48 * w, 0.17 * h), k_white);
    box(Vec3(-0.38 * d, 0, 0.94 * h), Vec3(0.09 * d, 0.32 * w, 0.06 * h), k_white);
    box(Vec3(0.13 * d, 0, 0.74 * h), Vec3(0.365 * d, 0.49 * w, 0.17 * h), k_blue);
  }

  const KindLook& look_;
  const Vec3 size_;
};

render::Profile outline_of(const Vec3& half, bool round) {
  const float y = static_cast<float>(half.y()), z = static_cast<float>(half.z());
  if (!round) return {.outline = {{-y, -z}, {y, -z}, {y, z}, {-y, z}}};
  constexpr int k_sides = 28;
  render::Profile profile{.outline = {}, .smooth = true};
  for (int i = 0; i < k_sides; ++i) {
    const double angle = 2 * k_pi * i / k_sides;
    profile.outline.push_back(
        {y * static_cast<float>(std::cos(angle)), z * static_cast<float>(std::sin(angle))});
  }
  return profile;
}

/// Null: a piece of no kind that looks like something.
const KindLook* look_of(const RoomPiece& piece) {
  if (piece.kind.empty() || !piece.upright) return nullptr;
  const auto* const look = std::ranges::find(k_kind_looks, io::kind_stem(piece.kind), &KindLook::kind);
  return look == std::end(k_kind_looks) ? nullptr : look;
}

}  // namespace

Bodies usual_bodies(const io::Scene& scene) {
  if (scene.setup.parameters.want_stress) return Bodies::beams;
  return std::ranges::any_of(pieces_of(scene), look_of) ? Bodies::solid : Bodies::beams;
}

SolidBodies::SolidBodies(const io::Scene& scene, Bodies bodies)
    : model_(scene.setup.model), bodies_(bodies), parts_(model_.bodies.size()) {
  const double inset = traits(bodies).beams ? k_inset : 0;
  for (const RoomPiece& piece : pieces_of(scene)) {
    const KindLook* const look = look_of(piece);
    if (!look) continue;
    const Quat turn(Eigen::AngleAxisd(piece.spot.yaw, Vec3::UnitZ()));
    const Vec3 at(piece.spot.at.x(), piece.spot.at.y(), piece.floor + inset);
    const Vec3 size = piece.size - 2 * Vec3::Constant(inset);
    for (const Joinery::Piece& one : Joinery(*look, size).pieces)
      parts_[piece.body].push_back({at + turn * one.centre, one.half, turn, one.colour, one.round});
  }
  for (const Member& member : model_.members) {
    const std::string& material = model_.materials[static_cast<std::size_t>(member.material)].name;
    const auto* const known =
        std::ranges::find(k_colours_of_materials, material, &ColourOfMaterial::material);
    of_material_.push_back(known == std::end(k_colours_of_materials) ? Float4{0, 0, 0, 0} : known->colour);
  }
}

void SolidBodies::add(const Part& part, int body, const io::FrameRow& row, render::SceneFrame& frame) const {
  const Body& of = model_.bodies[static_cast<std::size_t>(body)];
  const io::BodyNumbers& now = row.body[static_cast<std::size_t>(body)];
  const Quat rotation = now.rotation();
  const Vec3 centre = now.centre() + rotation * (part.centre - of.centre_of_gravity) + floor_shift(row);
  const Quat turn = rotation * part.turn;
  render::Tube tube;
  tube.first_station = static_cast<std::uint32_t>(frame.stations.size());
  tube.station_count = 2;
  tube.profile = static_cast<std::uint32_t>(frame.profiles.size());
  tube.member = static_cast<std::uint32_t>(of.first_member);
  tube.body = static_cast<std::uint32_t>(body);
  tube.colour = part.colour;
  frame.profiles.push_back(outline_of(part.half, part.round));
  for (const double end : {-1., 1.}) {
    const Vec3 place = centre + turn * Vec3(end * part.half.x(), 0, 0);
    frame.stations.push_back({to_float(place),
                              {static_cast<float>(turn.w()), static_cast<float>(turn.x()),
                               static_cast<float>(turn.y()), static_cast<float>(turn.z())},
                              0});
  }
  frame.tubes.push_back(tube);
}

void SolidBodies::take_beams_away(const std::vector<bool>& solid, render::SceneFrame& frame) const {
  std::erase_if(frame.tubes, [&](const render::Tube& tube) {
    return tube.member < model_.members.size() &&
           solid[static_cast<std::size_t>(model_.members[tube.member].body)];
  });
  for (render::Tube& tube : frame.tubes)
    if (tube.member < model_.members.size() && of_material_[tube.member][3] > 0 &&
        !model_.bodies[static_cast<std::size_t>(model_.members[tube.member].body)].ground)
      tube.colour = of_material_[tube.member];
  frame.legend = {};
}

void SolidBodies::dress(const io::FrameRow& row, render::SceneFrame& frame) const {
  std::vector<bool> solid(parts_.size());
  for (std::size_t b = 0; b < parts_.size(); ++b) {
    const auto codes = row.hinge.begin() + model_.bodies[b].first_element;
    solid[b] = !parts_[b].empty() && std::find(codes, codes + model_.bodies[b].element_count, k_broken) ==
                                         codes + model_.bodies[b].element_count;
  }
  if (!traits(bodies_).beams) take_beams_away(solid, frame);
  std::erase_if(frame.panels, [&](const render::Panel& panel) {
    return panel.body != render::k_no_body && solid[panel.body];
  });
  for (std::size_t b = 0; b < parts_.size(); ++b)
    if (solid[b])
      for (const Part& part : parts_[b]) add(part, static_cast<int>(b), row, frame);
}

}  // namespace topple::app
