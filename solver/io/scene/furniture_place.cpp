// Where pieces of furniture stand: at a place, against a wall, beside one another.
#include <algorithm>
#include <cmath>

#include "solver/io/common/nearest_name.h"
#include "solver/io/scene/furniture_piece.h"
#include "solver/math/elementary.h"
#include "solver/math/rotation.h"
#include "solver/model/placement.h"

namespace topple::io {
namespace {

// m. Skirting boards keep furniture off walls; bodies within 50 mm of each other are computed as touching.
constexpr double k_gap_to_wall = 0.010, k_gap_to_piece = 0.060;
constexpr double k_horizontal = 1e-9;  // of a wall's unit normal

/// Outer depth and width as it stands or lies, m.
Eigen::Vector2d footprint(const Piece& piece) {
  if (!piece.body.find("pose")) return piece.size.head<2>();
  const PoseTraits& pose = row_of(k_poses, piece.body_entry().chosen("pose", k_poses));
  Mat3 turn;
  for (int k = 0; k < 3; ++k) turn.row(k) = Eigen::RowVector3d(pose.turn[k]);
  return (turn * piece.size).cwiseAbs().head<2>();
}

Stand stand_facing(const Vec3& at, const Vec3& front) {
  return {at, front, elementary::atan2(front.y(), front.x())};
}

Vec3 to_the_right(const Vec3& front) {
  return Vec3::UnitZ().cross(front);
}

double gap(const Piece& piece, double absent) {
  return piece.entry.has("gap") ? piece.entry.number("gap") : absent;
}

std::string no_such(const std::string& what, const std::string& name, const std::vector<std::string>& known) {
  std::string text = "there is no " + what + " \"" + name + "\"";
  if (const std::string nearest = nearest_name(name, known); !nearest.empty())
    text += "; the nearest is " + nearest;
  if (known.empty()) return text + " nor any other";
  for (const std::string& other : known) text += (&other == &known.front() ? "; known: " : ", ") + other;
  return text;
}

class Arrangement {
 public:
  Arrangement(std::vector<Piece>& pieces, const Entry& root)
      : pieces_(pieces), root_(root), stands_(pieces.size()), state_(pieces.size(), State::open) {}

  void run() {
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      check_choice(pieces_[i].entry);
      pieces_[i].stand = stand(i);
      put(pieces_[i], pieces_[i].stand);
    }
  }

 private:
  enum class State { open, begun, done };

  static void check_choice(const Entry& entry) {
    const char* made = nullptr;
    for (const char* const key : {"at", "against", "beside"}) {
      if (!entry.has(key)) continue;
      if (made) entry.fail(key, std::string("stands beside `") + made + "`; a piece has one of them");
      made = key;
    }
    const std::string_view place = made ? made : "at";
    const auto belongs = [&](const char* key, bool does, const char* to) {
      if (entry.has(key) && !does) entry.fail(key, std::string("belongs to ") + to);
    };
    belongs("yaw", place == "at", "`at`: against a wall or beside a piece it faces the room");
    belongs("offset", place == "against", "`against`");
    belongs("gap", place != "at", "`against` or `beside`");
  }

  const Stand& stand(std::size_t i) {
    if (state_[i] == State::done) return stands_[i];
    const Entry& entry = pieces_[i].entry;
    if (state_[i] == State::begun)
      entry.fail("beside", "\"" + pieces_[i].name + "\" stands beside itself, in a circle");
    state_[i] = State::begun;
    stands_[i] = entry.has("against") ? against(pieces_[i]) : entry.has("beside") ? beside(i) : at(entry);
    state_[i] = State::done;
    return stands_[i];
  }

  static Stand at(const Entry& entry) {
    const std::vector<double> at = entry.has("at") ? entry.numbers("at") : std::vector<double>{0, 0};
    const double yaw = entry.has("yaw") ? entry.number("yaw") : 0;
    Vec3 front = exp_quaternion(yaw * Vec3::UnitZ()) * Vec3::UnitX();
    // a quarter of a turn is one: rounding would leave a frame without its symmetry
    constexpr double k_rounding = 1e-15;
    for (int k = 0; k < 2; ++k)
      if (std::abs(front[k]) < k_rounding) front = Vec3::Unit(1 - k) * std::copysign(1., front[1 - k]);
    return {Vec3(at[0], at[1], at.size() > 2 ? at[2] : 0), front, yaw};
  }

  Stand against(const Piece& piece) const {
    const std::string name = piece.entry.text("against");
    std::vector<std::string> known;
    for (const Entry& wall : root_.entries("wall")) {
      known.push_back(wall.name());
      if (wall.name() != name) continue;
      const Vec3 normal = wall.direction("normal");
      if (std::abs(normal.z()) > k_horizontal)
        piece.entry.fail("against", "the wall \"" + name + "\" leans: its normal is not horizontal");
      const std::vector<double> face = wall.numbers("at");
      const double from_wall = gap(piece, k_gap_to_wall) + footprint(piece).x() / 2;
      return stand_facing(
          Vec3(face[0], face[1], 0) + from_wall * normal +
              (piece.entry.has("offset") ? piece.entry.number("offset") : 0) * to_the_right(normal),
          normal);
    }
    piece.entry.fail("against", no_such("[[wall]]", name, known));
  }

  Stand beside(std::size_t i) {
    const Piece& piece = pieces_[i];
    const std::string name = piece.entry.text("beside");
    std::vector<std::string> known;
    for (std::size_t k = 0; k < pieces_.size(); ++k) {
      if (k != i) known.push_back(pieces_[k].name);
      if (pieces_[k].name != name) continue;
      const Stand& other = stand(k);
      const Eigen::Vector2d own = footprint(piece), its = footprint(pieces_[k]);
      const double along = its.y() / 2 + gap(piece, k_gap_to_piece) + own.y() / 2;
      return {other.at + along * to_the_right(other.front) + (own.x() - its.x()) / 2 * other.front,
              other.front, other.yaw};
    }
    piece.entry.fail("beside", no_such("[[furniture]]", name, known));
  }

  std::vector<Piece>& pieces_;
  const Entry& root_;
  std::vector<Stand> stands_;
  std::vector<State> state_;
};

}  // namespace

void place_pieces(std::vector<Piece>& pieces, const Entry& root) {
  Arrangement(pieces, root).run();
}

}  // namespace topple::io
