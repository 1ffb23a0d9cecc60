#include "solver/run/shortest_way.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/math/elementary.h"
#include "solver/math/ranges.h"

namespace topple {
namespace {

constexpr double k_step = k_pi / 18;  // rad, between the corners of an arc
constexpr double k_cut = 0.99;        // of the disc's radius is kept clear
constexpr double k_behind = 1e-9;     // m, rounding of a corner on a door's line
constexpr double k_rounding = 1e-9;
constexpr int k_goals = 8;  // parts of a door's line

/// A corner of the graph, on the circle around a corner of an obstacle.
struct Corner {
  Vec2 at;
  Vec2 outward;  ///< unit, from that corner; zero: it is no such
};

class Graph {
 public:
  Graph(const Room& room, const std::vector<Convex>& faces, const std::vector<Footprint>& obstacles,
        const Vec2& from, const Room::Door& door, double width)
      : room_(room), obstacles_(obstacles), radius_(width / 2) {
    for (const Convex& face : faces) obstacles_.push_back({face, 0});
    for (const Footprint& obstacle : obstacles_) {
      kept_away_.push_back(obstacle.radius + k_cut * radius_);
      middles_.push_back(middle(obstacle.core));
      double reach = 0;
      for (const Vec2& corner : obstacle.core) reach = std::max(reach, (corner - middles_.back()).norm());
      far_.push_back((1 + k_rounding) * (reach + kept_away_.back()));
    }
    corners_.push_back({from, Vec2::Zero()});
    const Vec2 right = room.jamb(door, 0), along = (room.jamb(door, 1) - right) / door.width;
    for (int k = 0; k <= k_goals; ++k)
      corners_.push_back({right + (radius_ + k * (door.width - width) / k_goals) * along, Vec2::Zero()});
    goals_ = corners_.size();
    for (const Footprint& obstacle : obstacles_) add_arcs(obstacle);
  }

  /// E. W. Dijkstra, Numerische Mathematik 1, 1959, 269-271.
  std::optional<ShortestWay> shortest() const {
    constexpr double k_never = std::numeric_limits<double>::infinity();
    const std::size_t count = corners_.size();
    std::vector<double> length(count, k_never);
    std::vector<std::size_t> before(count, 0);
    std::vector<bool> done(count, false);
    length[0] = 0;
    while (true) {
      std::size_t at = count;
      for (std::size_t k = 0; k < count; ++k)
        if (!done[k] && length[k] < k_never && (at == count || length[k] < length[at])) at = k;
      if (at == count) return std::nullopt;
      if (at > 0 && at < goals_) return way_to(at, length[at], before);
      done[at] = true;
      for (std::size_t k = 1; k < count; ++k) {
        const double sum = length[at] + (corners_[k].at - corners_[at].at).norm();
        if (done[k] || sum >= length[k] || !is_free(corners_[at], corners_[k])) continue;
        length[k] = sum;
        before[k] = at;
      }
    }
  }

 private:
  /// Around the corners of an obstacle, those that lie free, from the normal of one side to that of the next.
  void add_arcs(const Footprint& obstacle) {
    const Convex& core = obstacle.core;
    const double radius = obstacle.radius + radius_;
    for (std::size_t k = 0; k < core.size(); ++k) {
      const Vec2 &before = core[(k + core.size() - 1) % core.size()], &after = core[(k + 1) % core.size()];
      const auto normal = [](const Vec2& side) { return Vec2(side.y(), -side.x()).normalized(); };
      const bool alone = core.size() == 1;
      const Vec2 first = alone ? Vec2(1, 0) : normal(core[k] - before);
      const Vec2 last = alone ? first : normal(after - core[k]);
      const double turn = alone ? 2 * k_pi : elementary::atan2(cross(first, last), first.dot(last));
      const double angle = turn < 0 ? turn + 2 * k_pi : turn;  // of a line's end pi, whichever its sign
      const int parts = std::max(1, static_cast<int>(std::ceil(angle / k_step - 1e-9)));
      for (int n = 0; n <= parts; ++n) {
        const auto [sine, cosine] = elementary::sin_cos(angle * n / parts);
        const Vec2 outward(cosine * first.x() - sine * first.y(), sine * first.x() + cosine * first.y());
        const Vec2 at = core[k] + radius * outward;
        if (lies_free(at)) corners_.push_back({at, outward});
      }
    }
  }

  bool lies_free(const Vec2& at) const {
    for (const Room::Wall& wall : room_.walls)
      if (Room::before(wall, at) < -k_behind) return false;
    for (std::size_t k = 0; k < obstacles_.size(); ++k)
      if ((at - middles_[k]).norm() < far_[k] && distance(obstacles_[k].core, at) < kept_away_[k])
        return false;
    return true;
  }

  /// What is longer than a radius and no tangent there is on no shortest way.
  bool touches(const Corner& corner, const Vec2& along, double length) const {
    static const double k_slack = elementary::sin(k_step);
    return length < radius_ || std::abs(corner.outward.dot(along)) <= k_slack * length;
  }

  bool is_free(const Corner& a, const Corner& b) const {
    const Vec2 along = b.at - a.at;
    const double length = along.norm();
    if (!touches(a, along, length) || !touches(b, along, length)) return false;
    const Convex line{a.at, b.at};
    for (std::size_t k = 0; k < obstacles_.size(); ++k)
      if (distance(line, middles_[k]) < far_[k] &&
          nearest_points(obstacles_[k].core, line).distance < kept_away_[k])
        return false;
    return true;
  }

  ShortestWay way_to(std::size_t at, double length, const std::vector<std::size_t>& before) const {
    ShortestWay way{length, {}};
    for (; at != 0; at = before[at]) way.line.push_back(corners_[at].at);
    way.line.push_back(corners_[0].at);
    ranges::reverse(way.line);
    return way;
  }

  const Room& room_;
  std::vector<Footprint> obstacles_;  // the faces of the walls among them
  double radius_;
  std::vector<double> kept_away_;  // m, that the disc's middle keeps from each core
  std::vector<Vec2> middles_;      // of the cores
  std::vector<double> far_;        // m from there, where the core is farther than that for certain
  std::vector<Corner> corners_;
  std::size_t goals_ = 0;  // end of the corners on the door's line, which begin behind the first
};

}  // namespace

std::optional<ShortestWay> shortest_way(const Room& room, const std::vector<Convex>& faces,
                                        const std::vector<Footprint>& obstacles, const Vec2& from,
                                        const Room::Door& door, double width) {
  if (door.width < width) return std::nullopt;
  return Graph(room, faces, obstacles, from, door, width).shortest();
}

}  // namespace topple
