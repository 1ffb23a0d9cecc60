#include "solver/run/widest_way.h"

#include <algorithm>
#include <numeric>
#include <span>

#include "solver/math/ranges.h"

namespace topple {
namespace {

constexpr double k_far = 1e4;       // m, beyond any room
constexpr double k_off_axis = 0.3;  // of half an opening, so that no symmetric room has corners on the line

/// Two obstacles, and whether the line from the middle of one to that of the other, through where they are
/// nearest, crosses the line to the door an odd number of times.
struct Link {
  double gap;  // m
  int a, b;    // obstacles; the last: what is behind the walls
  bool odd;
};

/// Whether a line from a to b crosses one from c to d; what begins on a line is on its left.
bool crosses(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const auto left = [](const Vec2& p, const Vec2& q, const Vec2& x) { return cross(q - p, x - p) >= 0; };
  return left(a, b, c) != left(a, b, d) && left(c, d, a) != left(c, d, b);
}

/// From the place through the door to far beyond.
class Line {
 public:
  Line(const Room& room, const Vec2& from, const Room::Door& door) : points_{from} {
    const Vec2 right = room.jamb(door, 0), left = room.jamb(door, 1);
    points_[1] = (right + left) / 2 + k_off_axis / 2 * (left - right);
    points_[2] = points_[1] - k_far * room.walls[static_cast<std::size_t>(door.wall)].normal;
  }
  bool is_crossed_by(const Vec2& a, const Vec2& b) const {
    return crosses(points_[0], points_[1], a, b) != crosses(points_[1], points_[2], a, b);
  }

 private:
  Vec2 points_[3];
};

std::vector<Link> links_of(const Line& line, const std::vector<Convex>& faces,
                           const std::vector<Footprint>& obstacles) {
  std::vector<Link> links;
  const int walls = static_cast<int>(obstacles.size());
  for (int i = 0; i < walls; ++i) {
    const Footprint& a = obstacles[static_cast<std::size_t>(i)];
    const Vec2 from = middle(a.core);
    for (int j = i + 1; j < walls; ++j) {
      const Footprint& b = obstacles[static_cast<std::size_t>(j)];
      const NearestPoints2 near = nearest_points(a.core, b.core);
      const bool odd = line.is_crossed_by(from, near.a) ^ line.is_crossed_by(near.a, near.b) ^
                       line.is_crossed_by(near.b, middle(b.core));
      links.push_back({std::max(near.distance - a.radius - b.radius, 0.), i, j, odd});
    }
    for (const Convex& face : faces) {
      const NearestPoints2 near = nearest_points(a.core, face);
      const bool odd = line.is_crossed_by(from, near.a) ^ line.is_crossed_by(near.a, near.b);
      links.push_back({std::max(near.distance - a.radius, 0.), i, walls, odd});
    }
  }
  ranges::stable_sort(links, {}, &Link::gap);
  return links;
}

/// Sets in which it is known whether the way between two members crosses the line.
class ParitySets {
 public:
  explicit ParitySets(std::size_t count) : above_(count), odd_(count, false) {
    std::iota(above_.begin(), above_.end(), 0);
  }
  /// False: the link closes a chain that crosses the line an odd number of times.
  bool join(const Link& link) {
    const auto [top_a, odd_a] = top(link.a);
    const auto [top_b, odd_b] = top(link.b);
    const bool odd = odd_a ^ odd_b ^ link.odd;
    if (top_a == top_b) return !odd;
    above_[static_cast<std::size_t>(top_b)] = top_a;
    odd_[static_cast<std::size_t>(top_b)] = odd;
    return true;
  }

 private:
  std::pair<int, bool> top(int k) const {
    bool odd = false;
    for (; above_[static_cast<std::size_t>(k)] != k; k = above_[static_cast<std::size_t>(k)])
      odd ^= odd_[static_cast<std::size_t>(k)];
    return {k, odd};
  }
  std::vector<int> above_;
  std::vector<bool> odd_;
};

/// The fewest obstacles of a chain of `links` that the last of them closes, breadth first over obstacles and
/// parities.
std::vector<int> chain_of(std::span<const Link> links, int count) {
  const Link& last = links.back();
  struct Seen {
    int before = -1;
    bool there = false;
  };
  const auto index = [](int obstacle, bool odd) { return 2 * obstacle + (odd ? 1 : 0); };
  std::vector<Seen> seen(static_cast<std::size_t>(2 * count));
  std::vector<int> queue{index(last.a, false)};
  seen[static_cast<std::size_t>(queue[0])].there = true;
  for (std::size_t n = 0; n < queue.size(); ++n)
    for (const Link& link : links) {
      const int at = queue[n] / 2;
      if (link.a != at && link.b != at) continue;
      const int next = index(link.a == at ? link.b : link.a, ((queue[n] & 1) != 0) ^ link.odd);
      if (seen[static_cast<std::size_t>(next)].there) continue;
      seen[static_cast<std::size_t>(next)] = {queue[n], true};
      queue.push_back(next);
    }
  std::vector<int> chain;
  for (int k = index(last.a, true); k >= 0; k = seen[static_cast<std::size_t>(k)].before) {
    const int obstacle = k / 2;
    if (obstacle < count - 1 && ranges::find(chain, obstacle) == chain.end()) chain.push_back(obstacle);
  }
  ranges::sort(chain);
  return chain;
}

}  // namespace

std::vector<Convex> faces(const Room& room, std::size_t wall) {
  const Room::Wall& of = room.walls[wall];
  std::vector<const Room::Door*> doors;
  for (const Room::Door& door : room.doors)
    if (door.wall == static_cast<int>(wall)) doors.push_back(&door);
  ranges::sort(doors, {}, [](const Room::Door* door) { return door->at; });
  std::vector<Convex> all;
  Vec2 begin = of.at - k_far * of.along();
  for (const Room::Door* door : doors) {
    all.push_back({begin, room.jamb(*door, 0)});
    begin = room.jamb(*door, 1);
  }
  all.push_back({begin, of.at + k_far * of.along()});
  return all;
}

std::vector<Convex> faces(const Room& room) {
  std::vector<Convex> all;
  for (std::size_t w = 0; w < room.walls.size(); ++w)
    for (Convex& face : faces(room, w)) all.push_back(std::move(face));
  return all;
}

WidestWay widest_way(const Room& room, const std::vector<Convex>& faces,
                     const std::vector<Footprint>& obstacles, const Vec2& from, const Room::Door& door) {
  const int count = static_cast<int>(obstacles.size()) + 1;
  const std::vector<Link> links = links_of(Line(room, from, door), faces, obstacles);
  ParitySets sets(static_cast<std::size_t>(count));
  for (std::size_t n = 0; n < links.size() && links[n].gap < door.width; ++n)
    if (!sets.join(links[n])) return {links[n].gap, chain_of(std::span(links).first(n + 1), count)};
  return {door.width, {}};
}

}  // namespace topple
