// [[fixing]] of a scene: anchors by name, which find their points.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "solver/contact/panel_place.h"
#include "solver/io/scene/fixing_kinds.h"
#include "solver/io/scene/scene_fittings.h"
#include "solver/io/scene/scene_read.h"
#include "solver/math/ranges.h"
#include "solver/run/bearer.h"

namespace topple::io {
namespace {

constexpr double k_off_body = 0.1;       // m, from `at` to the body
constexpr double k_upper = 0.05;         // of a body's height: what counts as its top
constexpr double k_same = 1e-3;          // m: nodes as near as that are equally near
constexpr double k_least_gap = 1e-6;     // m
constexpr double k_turned_least = 1e-9;  // rad
constexpr double k_above = 100;          // m, any place above a body

/// What a fixing leads to: a plane, or a body.
struct Target {
  std::string name;
  Vec3 point = Vec3::Zero(), normal = Vec3::UnitZ();  // of a plane
  int body = -1;
  bool wall = false, floor = false, ceiling = false;

  Vec3 on(const Vec3& x) const { return x - distance(x) * normal; }
  double distance(const Vec3& x) const { return normal.dot(x - point); }
};

Target wall_of(const Entry& wall) {
  const std::vector<double> at = wall.numbers("at");
  Target target;
  target.name = wall.name(), target.wall = true;
  target.point = Vec3(at[0], at[1], 0), target.normal = wall.direction("normal");
  return target;
}

class Fixing {
 public:
  Fixing(const Entry& root, const Entry& entry, const State& start, int number, Setup& setup)
      : root_(root),
        entry_(entry),
        start_(start),
        number_(number),
        setup_(setup),
        kind_(kind_of(entry)),
        body_(find_body(entry, setup.model)) {
    if (body().ground) entry.fail("body", "\"" + body().name + "\" is no furniture");
    target_ = find_target();
    if (target_.body == body_) entry.fail("to", "is the fixing's own body");
  }

  static const FixingTraits& kind_of(const Entry& entry) { return traits(entry.chosen("kind", k_fixings)); }

  // Raises the corners of the base that are farthest from the wall, by contact points that reach lower there:
  // the body starts as it leans on them, or on the wall if it comes to lean there first, and what stands on
  // it leans with it.
  void lift() {
    if (!entry_.flag("on")) {
      setup_.wedges.push_back({entry_.name(), body_});
      return;
    }
    for (const char* key : {"at", "stiffness", "strength", "preload"})
      if (entry_.has(key))
        entry_.fail(key, "a stopper has none: it bears and rubs as the feet of its body do");
    const Target wall = nearest_wall();
    const std::vector<int> corners = feet();
    const auto distance = [&](int node) { return wall.distance(x(node)); };
    const auto [back, front] = ranges::minmax_element(corners, {}, distance);
    const double depth = distance(*front) - distance(*back);
    if (target_.wall && distance(*back) > kind_.reach)
      entry_.fail("to", "is " + millimetres(distance(*back)) + " from \"" + body().name +
                            "\": a stopper leans it towards a wall within " + millimetres(kind_.reach));
    double above = std::numeric_limits<double>::infinity();  // of the floor
    for (const Plane& plane : setup_.model.planes)
      if (plane.normal.z() > 0.5) above = std::min(above, plane.normal.dot(x(*back) - plane.point));
    constexpr double k_stands = 0.1;  // m
    if (std::isfinite(above) && above > k_stands)
      entry_.fail("body", "\"" + body().name + "\" stands " + millimetres(above) +
                              " above the floor: a stopper lifts the front edge of what stands on it");
    if (!setup_.starts[body_].rotation.isZero(0) || !(depth > k_same))
      entry_.fail("body",
                  "\"" + body().name + "\" does not stand level on a base as deep as a stopper needs");
    const std::vector<int> leaning = stack();
    const Vec3 pivot = x(*back);
    const double most = std::asin(std::min(1., kind_.lift / depth));
    const auto room_of = [&](const std::vector<int>& bodies) {
      return leaning_angle(bodies, wall, pivot, most);
    };
    const double angle = room_of(leaning);
    for (const int b : leaning)
      if (!(angle > 0) && !(room_of({b}) > 0))
        entry_.fail("body", "\"" + model().bodies[b].name + "\" touches \"" + wall.name +
                                "\": a stopper leans it back, which takes a gap");
    for (const int b : leaning) {
      setup_.starts[b].pivot = pivot;
      setup_.starts[b].rotation = angle * wall.normal.cross(Vec3::UnitZ());
    }
    Wedge wedge{entry_.name(), body_, {}, depth * std::sin(angle)};
    for (const int node : corners)
      if (distance(node) > distance(*front) - k_same) wedge.nodes.push_back(node);
    each_contact_point(body_, [&](ContactPoint& point) {
      if (ranges::find(wedge.nodes, point.node) != wedge.nodes.end()) point.width += 2 * wedge.lift;
    });
    setup_.wedges.push_back(std::move(wedge));
  }

  void add() {
    if (entry_.has("at") && kind_.place == FixingPlace::feet)
      entry_.fail("at", "a " + std::string(kind_.word) + " finds the corners of the base by itself");
    if (entry_.has("at")) return add_one(entry_.vector("at"), entry_.name());
    if (kind_.place == FixingPlace::top && body().solid)
      return add_one(nearest_on_block(body(), start_centre() + k_above * Vec3::UnitZ()), entry_.name());
    const std::vector<int> nodes = find_nodes();
    for (std::size_t k = 0; k < nodes.size(); ++k)
      add_one(start_.position[nodes[k]],
              entry_.name() + (nodes.size() > 1 ? "-" + std::to_string(k + 1) : ""));
  }

 private:
  const Model& model() const { return setup_.model; }
  const Body& body() const { return model().bodies[body_]; }
  const Vec3& x(int node) const { return start_.position[node]; }
  // Of the body's nodes.
  Vec3 start_centre() const {
    Vec3 sum = Vec3::Zero();
    for (int i = body().first_node; i < body().first_node + body().node_count; ++i) sum += x(i);
    return sum / body().node_count;
  }

  Target find_target() const {
    const std::string name = entry_.text("to");
    std::string known;
    const auto is = [&](const std::string& other) {
      known += (known.empty() ? "" : ", ") + other;
      return name == other;
    };
    std::optional<Target> found;
    if (root_.entry("floor").present() && is("floor")) {
      found.emplace();
      found->floor = true;
    }
    if (const Entry ceiling = root_.entry("ceiling"); ceiling.present() && is("ceiling")) {
      found.emplace();
      found->ceiling = true;
      found->point.z() = ceiling.number("at"), found->normal = -Vec3::UnitZ();
    }
    for (const Entry& wall : root_.entries("wall"))
      if (is(wall.name())) found = wall_of(wall);
    for (int b = 0; b < model().furniture_total(); ++b)
      if (is(model().bodies[b].name)) {
        found.emplace();
        found->body = b;
      }
    if (!found)
      entry_.fail("to", "there is no wall, body, floor or ceiling \"" + name + "\"; known: " + known +
                            (name == "ceiling" ? "; [ceiling] at = HEIGHT makes one" : ""));
    const bool goes = (found->wall && kind_.to_wall) || (found->floor && kind_.to_floor) ||
                      (found->ceiling && kind_.to_ceiling) || (found->body >= 0 && kind_.to_body);
    if (!goes)
      entry_.fail("to", "a " + std::string(kind_.word) + " " + kind_.about + "; it leads to " + targets() +
                            ", not to \"" + name + "\"");
    found->name = name;
    return *found;
  }

  std::string targets() const {
    std::string words;
    for (const auto& [may, word] :
         {std::pair(kind_.to_wall, "a wall"), std::pair(kind_.to_floor, "the floor"),
          std::pair(kind_.to_ceiling, "the ceiling"), std::pair(kind_.to_body, "a body")})
      if (may) words += (words.empty() ? "" : ", ") + std::string(word);
    return words;
  }

  // The nodes for which `far` is least, of equally good ones that for which `then` is.
  template <class Far, class Then>
  int best(const std::vector<int>& of, Far far, Then then) const {
    return *ranges::min_element(of, [&](int a, int b) {
      const double fa = far(a), fb = far(b);
      if (std::abs(fa - fb) > k_same) return fa < fb;
      const double ta = then(a), tb = then(b);
      return std::abs(ta - tb) > k_same ? ta < tb : a < b;
    });
  }

  std::vector<int> nodes_of_body(int index, bool upper) const {
    const Body& of = model().bodies[index];
    double low = x(of.first_node).z(), high = low;
    for (int i = of.first_node; i < of.first_node + of.node_count; ++i)
      low = std::min(low, x(i).z()), high = std::max(high, x(i).z());
    std::vector<int> nodes;
    for (int i = of.first_node; i < of.first_node + of.node_count; ++i)
      if (!upper || x(i).z() >= high - k_upper * (high - low)) nodes.push_back(i);
    return nodes;
  }

  // Corners of the base.
  std::vector<int> feet() const {
    if (body().support_polygon.empty()) entry_.fail("body", "\"" + body().name + "\" has no base");
    std::vector<int> nodes;
    for (const Vec3& corner : body().support_polygon) {
      int nearest = -1;
      for (const int point : body().base_points) {
        const int node = model().contact_points[point].node;
        const auto far = [&](int other) { return (model().node_position[other] - corner).norm(); };
        if (nearest < 0 || far(node) < far(nearest)) nearest = node;
      }
      if (ranges::find(nodes, nearest) == nodes.end()) nodes.push_back(nearest);
    }
    return nodes;
  }

  template <class F>
  void each_contact_point(int index, F f) const {
    const Body& of = model().bodies[index];
    for (int p = 0; p < of.contact_point_count; ++p)
      f(setup_.model.contact_points[of.first_contact_point + p]);
  }

  // The body and what stands level on it.
  std::vector<int> stack() const {
    const std::vector<Bearer> bearers = bearers_of(model(), setup_.starts);
    std::vector<int> bodies{body_};
    for (std::size_t k = 0; k < bodies.size(); ++k)
      for (int b = 0; b < static_cast<int>(bearers.size()); ++b)
        if (bearers[b].body == bodies[k] && setup_.starts[b].rotation.isZero(0)) bodies.push_back(b);
    return bodies;
  }

  // By which bodies can be turned about `pivot` towards the wall until one touches it, rad, `most` at most.
  double leaning_angle(const std::vector<int>& bodies, const Target& wall, const Vec3& pivot,
                       double most) const {
    const auto room = [&](double angle) {
      double least = std::numeric_limits<double>::infinity();
      for (const int b : bodies)
        each_contact_point(b, [&](const ContactPoint& point) {
          const Vec3 arm = x(point.node) - pivot;
          least = std::min(least, wall.distance(pivot) + wall.normal.dot(arm) * std::cos(angle) -
                                      arm.z() * std::sin(angle) - point.width / 2);
        });
      return least;
    };
    if (room(most) >= 0) return most;
    double free = 0;
    for (double step = most / 2; step > k_turned_least; step /= 2)
      if (room(free + step) >= 0) free += step;
    return free;
  }

  Target nearest_wall() const {
    if (target_.wall) return target_;
    std::optional<Target> nearest;
    for (const Entry& entry : root_.entries("wall")) {
      const Target wall = wall_of(entry);
      if (!nearest || wall.distance(body().centre_of_gravity) < nearest->distance(body().centre_of_gravity))
        nearest = wall;
    }
    if (!nearest) entry_.fail("kind", "a stopper leans its body towards a wall, and there is none");
    return *nearest;
  }

  std::vector<int> find_nodes() const {
    const auto from_middle = [&](int node) { return (x(node) - body().centre_of_gravity).head<2>().norm(); };
    switch (kind_.place) {
      case FixingPlace::feet:
        return feet();
      case FixingPlace::top:
        return {best(nodes_of_body(body_, true), from_middle, [](int node) { return node; })};
      case FixingPlace::near:
        break;
    }
    if (target_.wall) return upper_corners();
    if (target_.body >= 0) {
      const std::vector<int> others = nodes_of_body(target_.body, false);
      const auto far = [&](int node) {
        double least = (x(node) - x(others.front())).norm();
        for (const int other : others) least = std::min(least, (x(node) - x(other)).norm());
        return least;
      };
      return {best(nodes_of_body(body_, false), far, [&](int node) { return -x(node).z(); })};
    }
    return {best(
        nodes_of_body(body_, false), [&](int node) { return target_.distance(x(node)); }, from_middle)};
  }

  // Of the side that is nearest to the wall; a body that touches it in a point has one.
  std::vector<int> upper_corners() const {
    std::vector<int> nodes = nodes_of_body(body_, true);
    const auto far = [&](int node) { return target_.distance(x(node)); };
    const double least = far(*ranges::min_element(nodes, {}, far));
    std::erase_if(nodes, [&](int node) { return far(node) > least + k_same; });
    const Vec3 along = Vec3::UnitZ().cross(target_.normal);
    const auto place = [&](int node) { return along.dot(x(node)); };
    const auto [least_at, most_at] = ranges::minmax_element(nodes, {}, place);
    const int first = *least_at, last = *most_at;
    if (place(last) - place(first) < k_same) return {first};
    return {first, last};
  }

  // Of a block, whose faces are as good as its corners.
  Vec3 nearest_on_block(const Body& block, const Vec3& point) const {
    const Quat& turned = start_.rotation[block.first_node];
    const Vec3& corner = model().node_position[block.first_node];
    Eigen::AlignedBox3d box;
    for (int i = block.first_node; i < block.first_node + block.node_count; ++i)
      box.extend(model().node_position[i] - corner);
    const Vec3 inside = turned.conjugate() * (point - x(block.first_node));
    return x(block.first_node) + turned * inside.cwiseMax(box.min()).cwiseMin(box.max());
  }

  // Of its panels.
  std::optional<Vec3> nearest_on_panels(int of, const Vec3& point) const {
    std::optional<Vec3> nearest;
    for (const Panel& panel : model().panels) {
      if (panel.body != of) continue;
      const NearestOnPanel on =
          nearest_on_panel(point, {x(panel.node[0]), x(panel.node[1]), x(panel.node[2]), x(panel.node[3])});
      const Vec3 foot = point - on.between;
      if (!nearest || (foot - point).norm() < (*nearest - point).norm()) nearest = foot;
    }
    return nearest;
  }

  // Of the other body: `point` itself where that is on it, else what of it is nearest: of a block a point of
  // its faces, of others a node, and for feet a point of a panel.
  Vec3 point_of_other(const Vec3& point) const {
    if (kind_.pin && entry_.has("at")) return point;
    if (const Body& other = model().bodies[target_.body]; other.solid) return nearest_on_block(other, point);
    const std::vector<int> others = nodes_of_body(target_.body, false);
    const Vec3 nearest = x(best(
        others, [&](int node) { return (x(node) - point).norm(); }, [&](int node) { return -x(node).z(); }));
    if (kind_.place != FixingPlace::feet) return nearest;
    const std::optional<Vec3> face = nearest_on_panels(target_.body, point);
    return face && (*face - point).norm() < (nearest - point).norm() - k_same ? *face : nearest;
  }

  void check_reach(const char* key, int of, const Vec3& point) const {
    if (const Body& body = model().bodies[of];
        body.solid && (nearest_on_block(body, point) - point).norm() <= k_off_body)
      return;
    if (const std::optional<Vec3> face = nearest_on_panels(of, point);
        face && (*face - point).norm() <= k_off_body)
      return;
    const auto [member, distance] = nearest_member(model(), of, start_, point);
    if (distance > k_off_body)
      entry_.fail(key, "finds no point of \"" + model().bodies[of].name + "\" within " +
                           millimetres(k_off_body) + ": the nearest member, \"" +
                           model().members[member].name + "\", is " + millimetres(distance) + " away");
  }

  void add_one(Vec3 point, const std::string& name) {
    if (ranges::find(model().anchors, name, &Anchor::name) != model().anchors.end())
      entry_.fail("name", "\"" + name + "\" is that of a point of another fixing too");
    Anchor anchor;
    anchor.name = name;
    anchor.fixing = kind_.word;
    anchor.leads_to = target_.name;
    anchor.fixing_number = number_;
    anchor.body = body_;
    anchor.type = kind_.type;
    anchor.stiffness = entry_.has("stiffness") ? entry_.number("stiffness") : kind_.stiffness;
    anchor.strength = entry_.has("strength") ? entry_.number("strength") : kind_.strength;
    const double preload = entry_.has("preload") ? entry_.number("preload") : kind_.preload;
    check_reach("at", body_, point);
    if (target_.body >= 0) {
      anchor.other.body = target_.body;
      anchor.to = point_of_other(point);
    } else {
      anchor.to = target_.on(point);
    }
    if (const double below = -target_.distance(point); target_.ceiling && below > 0)
      entry_.fail("to", "is " + millimetres(below) + " below the point of \"" + body().name +
                            "\" from which a " + kind_.word + " leads there");
    const double gap = (point - anchor.to).norm();
    if (gap > kind_.reach)
      entry_.fail("to", "finds no point within " + millimetres(kind_.reach) + ": from \"" + body().name +
                            "\" to \"" + target_.name + "\" it is " + millimetres(gap) +
                            (target_.body >= 0 ? " between centre lines; `at` says where it is" : ""));
    if (target_.body >= 0) check_reach("to", target_.body, anchor.to);
    if (kind_.pin) point = anchor.to = target_.body >= 0 ? Vec3((point + anchor.to) / 2) : point;
    if (!kind_.pin && kind_.type != Anchor::Type::bracket && !((point - anchor.to).norm() > k_least_gap))
      entry_.fail("to", "\"" + target_.name + "\" is where its point is: a " + kind_.word + " has a length");
    add_anchor(entry_, start_, point, preload, std::move(anchor), setup_);
  }

  const Entry &root_, &entry_;
  const State& start_;
  const int number_;
  Setup& setup_;
  const FixingTraits& kind_;
  const int body_;
  Target target_;
};

}  // namespace

void read_fixings(const Entry& root, Setup& setup) {
  const std::vector<Entry> entries = root.entries("fixing");
  if (entries.empty()) return;
  State start = start_state(setup.model, setup.starts);
  const auto each = [&](bool lifts, auto add) {
    for (std::size_t k = 0; k < entries.size(); ++k)
      if ((Fixing::kind_of(entries[k]).lift > 0) == lifts) {
        Fixing fixing(root, entries[k], start, static_cast<int>(k) + 1, setup);
        add(fixing);
      }
  };
  each(true, [](Fixing& fixing) { fixing.lift(); });
  start = start_state(setup.model, setup.starts);
  each(false, [](Fixing& fixing) { fixing.add(); });
}

}  // namespace topple::io
