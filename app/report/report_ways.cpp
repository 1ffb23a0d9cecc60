// Section of the report page: whether people still get out, and a plan of the room as it lies.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/report/report_parts.h"
#include "solver/run/ways.h"

namespace topple::app {
namespace {

using nlohmann::ordered_json;

constexpr double k_width = 720, k_most_height = 620;  // px
constexpr double k_bar = 22;                          // px, of the scale
constexpr double k_margin = 0.35;                     // m, around all that is drawn
constexpr double k_far_wall = 10;                     // m, from the middle of what stands there: not drawn
constexpr double k_moved = 0.02;                      // m, from which on the start is drawn as well

constexpr const char* k_fallen = "fill=\"#c9926b\" stroke=\"#6b2f10\" stroke-width=\"1.5\"";
constexpr const char* k_standing = "fill=\"#e9ecef\" stroke=\"#555\" stroke-width=\"1\"";
constexpr const char* k_start = "fill=\"none\" stroke=\"#777\" stroke-width=\"0.8\" stroke-dasharray=\"3 2\"";
constexpr const char* k_way_before = "fill=\"none\" stroke=\"#a9bdd3\" stroke-width=\"5\"";
constexpr const char* k_way = "fill=\"none\" stroke=\"#12355b\" stroke-width=\"1.8\"";
constexpr const char* k_wall = "stroke=\"#222\" stroke-width=\"5\"";
constexpr double k_thick = 5;  // px, of it
constexpr const char* k_door = "stroke=\"#222\" stroke-width=\"1\"";
constexpr const char* k_hit = "fill=\"none\" stroke=\"#b0471c\" stroke-width=\"2.5\"";
constexpr const char* k_person =
    "fill=\"#fff\" fill-opacity=\"0.75\" stroke=\"#12355b\" stroke-width=\"1.2\"";
constexpr const char* k_cross = "stroke=\"#12355b\" stroke-width=\"1.8\"";

/// A part of the plan that is drawn, m.
struct View {
  Vec2 least = Vec2::Constant(1e9), most = Vec2::Constant(-1e9);
  double scale = 1;  // px/m
  double left = 0;   // px
  void take(const Vec2& point) {
    least = least.cwiseMin(point);
    most = most.cwiseMax(point);
  }
  void close() {
    least -= Vec2::Constant(k_margin);
    most += Vec2::Constant(k_margin);
    scale = std::min(k_width / (most - least).x(), k_most_height / (most - least).y());
    left = (k_width - scale * (most - least).x()) / 2;
  }
  double height() const { return scale * (most - least).y(); }
  double x(const Vec2& p) const { return left + scale * (p - least).x(); }
  double y(const Vec2& p) const { return scale * (most - p).y(); }
  std::string at(const Vec2& p) const { return fmt::format("{:.1f},{:.1f}", x(p), y(p)); }
  std::string points(const std::vector<Vec2>& list) const {
    std::string out;
    for (const Vec2& p : list) out += (out.empty() ? "" : " ") + at(p);
    return out;
  }
};

std::string line(const View& view, const Vec2& a, const Vec2& b, const char* how) {
  return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n", view.x(a),
                     view.y(a), view.x(b), view.y(b), how);
}

std::string ring(const View& view, const Vec2& at, double radius, const char* how) {
  return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" {}/>\n", view.x(at), view.y(at),
                     view.scale * radius, how);
}

/// Within the drawing, as far as letters are no wider than most are.
std::string words_at(const View& view, const Vec2& at, double down, const std::string& words) {
  const double half = 3.4 * static_cast<double>(words.size());  // px
  return fmt::format(
      "<text class=\"halo\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\" font-size=\"11\">{}</text>\n",
      std::clamp(view.x(at), half, std::max(half, k_width - half)), view.y(at) + down, escaped(words));
}

/// The outline of a footprint: its core grown, with arcs of eight parts to a quarter.
std::vector<Vec2> outline(const Footprint& print) {
  constexpr int k_parts = 32;
  std::vector<Vec2> points;
  for (const Vec2& corner : print.core)
    for (int n = 0; n < k_parts; ++n) {
      const double turn = 2 * k_pi * n / k_parts;
      points.emplace_back(corner + print.radius * Vec2(std::cos(turn), std::sin(turn)));
    }
  return convex_hull(std::move(points));
}

struct Plan {
  const ReportPage& page;
  const Room& room;
  const Model& model;
  RoomPlan before, after;
  std::vector<Way> ways_before, ways_after;

  const ordered_json& outcome(std::size_t place) const { return page.report().summary["ways"][place]; }
  bool fell(int body) const {
    return page.bodies()[static_cast<std::size_t>(body)]["overturned"].get<bool>();
  }
};

View view_of(const Plan& plan) {
  View view;
  for (const RoomPlan* lying : {&plan.before, &plan.after})
    for (const Footprint& print : lying->lying)
      for (const Vec2& corner : print.core) view.take(corner);
  for (const Room::Place& place : plan.room.places) view.take(place.at);
  for (const Room::Door& door : plan.room.doors)
    for (const int end : {0, 1}) view.take(plan.room.jamb(door, end));
  const Vec2 middle = (view.least + view.most) / 2;
  for (const Room::Wall& wall : plan.room.walls)
    if (const double before = Room::before(wall, middle); before < k_far_wall)
      view.take(middle - before * wall.normal);
  view.close();
  return view;
}

/// Of a wall, what is in view, as far as to the backs of the walls that end it.
std::string wall(const View& view, const Room& room, const Room::Wall& of, const Vec2& from, const Vec2& to) {
  const Vec2 along = to - from;
  double begin = 0, end = 1;
  const auto keep = [&](double at_from, double rate) {  // where at_from + rate t >= 0
    if (rate == 0 && at_from < 0) end = 0;
    if (rate > 0) begin = std::max(begin, -at_from / rate);
    if (rate < 0) end = std::min(end, -at_from / rate);
  };
  for (const Room::Wall& other : room.walls)
    if (&other != &of) keep(Room::before(other, from) + k_thick / view.scale, other.normal.dot(along));
  for (int k = 0; k < 2; ++k) {
    keep(from[k] - view.least[k], along[k]);
    keep(view.most[k] - from[k], -along[k]);
  }
  const Vec2 back = -k_thick / 2 / view.scale * of.normal;
  return begin < end ? line(view, from + begin * along + back, from + end * along + back, k_wall) : "";
}

std::string walls_and_doors(const View& view, const Room& room) {
  std::string out;
  for (std::size_t w = 0; w < room.walls.size(); ++w)
    for (const Convex& face : faces(room, w)) out += wall(view, room, room.walls[w], face[0], face[1]);
  for (const Room::Door& door : room.doors) {
    const Vec2 a = room.jamb(door, 0), b = room.jamb(door, 1);
    const Vec2 back = -k_thick / view.scale * room.walls[static_cast<std::size_t>(door.wall)].normal;
    out += line(view, a, b, k_door) + line(view, a + back, b + back, k_door);
    out += words_at(view, (a + b) / 2 + 3.5 * back, 4, door.name);
  }
  return out;
}

/// m, mean of its nodes as it lies.
double height(const Plan& plan, int body) {
  double sum = 0;
  int count = 0;
  for (std::size_t n = 0; n < plan.model.node_body.size(); ++n)
    if (plan.model.node_body[n] == body) sum += plan.page.report().nodes_at_end[n].z(), ++count;
  return sum / std::max(1, count);
}

std::string bodies(const View& view, const Plan& plan) {
  std::string start, standing;
  std::vector<std::pair<double, std::string>> fallen;  // what lies higher covers what lies below it
  const auto shape = [&](const Footprint& print, const char* how) {
    return "<polygon points=\"" + view.points(outline(print)) + "\" " + how + "/>\n";
  };
  for (std::size_t k = 0; k < plan.after.lying.size(); ++k) {
    const int body = plan.after.body[k];
    const Footprint& print = plan.after.lying[k];
    if (plan.fell(body))
      fallen.emplace_back(height(plan, body), shape(print, k_fallen));
    else
      standing += shape(print, k_standing);
    const auto was = std::ranges::find(plan.before.body, body);
    if (was == plan.before.body.end()) continue;
    const Footprint& then = plan.before.lying[static_cast<std::size_t>(was - plan.before.body.begin())];
    if ((middle(then.core) - middle(print.core)).norm() > k_moved) start += shape(then, k_start);
  }
  std::ranges::stable_sort(fallen, {}, &std::pair<double, std::string>::first);
  for (const auto& [height, drawn] : fallen) standing += drawn;
  return standing + start;
}

/// Of what fell, beside the people on whom it lies.
std::string names(const View& view, const Plan& plan) {
  std::string out;
  for (std::size_t k = 0; k < plan.after.lying.size(); ++k) {
    if (!plan.fell(plan.after.body[k])) continue;
    Vec2 at = middle(plan.after.lying[k].core);
    const double clear = plan.room.person / 2 + 0.15;
    if (std::ranges::any_of(plan.room.places, [&](const Room::Place& place) {
          return (place.at - at).cwiseAbs().maxCoeff() < clear;
        }))
      at.y() += clear;
    out += words_at(view, at, 4, plan.model.bodies[static_cast<std::size_t>(plan.after.body[k])].name);
  }
  return out;
}

std::string way(const View& view, const Plan& plan, const RoomPlan& lying, std::size_t place, const Way& of,
                const char* how) {
  if (!of.open) return "";
  const auto shortest = shortest_way(plan.room, lying, static_cast<int>(place), of.door);
  return shortest ? "<polyline points=\"" + view.points(shortest->line) + "\" stroke-linejoin=\"round\" " +
                        how + "/>\n"
                  : "";
}

std::string person(const View& view, const Room& room, const Vec2& at, bool shut, bool hit) {
  const double radius = room.person / 2;
  std::string out = ring(view, at, radius, k_person);
  if (hit) out += ring(view, at, radius + 3.5 / view.scale, k_hit);
  const double arm = radius * 0.6;
  if (!shut) return out + ring(view, at, 2.5 / view.scale, "fill=\"#12355b\"");
  return out + line(view, at + Vec2(-arm, -arm), at + Vec2(arm, arm), k_cross) +
         line(view, at + Vec2(-arm, arm), at + Vec2(arm, -arm), k_cross);
}

/// Below the plan.
std::string scale_bar(const View& view) {
  return fmt::format(
      "<path d=\"M {0:.1f},{1:.1f} v 6 h {2:.1f} v -6\" fill=\"none\" stroke=\"#222\" stroke-width=\"2\"/>\n"
      "<text x=\"{3:.1f}\" y=\"{4:.1f}\" font-size=\"11\">1 m</text>\n",
      view.left + 8, view.height() + 8, view.scale, view.left + 14 + view.scale, view.height() + 16);
}

std::string drawing(const Plan& plan) {
  const View view = view_of(plan);
  std::string out = fmt::format(
      "<svg class=\"chart\" viewBox=\"0 0 {:.0f} {:.0f}\" role=\"img\" font-size=\"12\" fill=\"#222\">\n",
      k_width, view.height() + k_bar);
  out += bodies(view, plan) + walls_and_doors(view, plan.room);
  const std::size_t places = plan.room.places.size();
  for (std::size_t p = 0; p < places; ++p)
    out += way(view, plan, plan.before, p, plan.ways_before[p], k_way_before);
  for (std::size_t p = 0; p < places; ++p) out += way(view, plan, plan.after, p, plan.ways_after[p], k_way);
  for (std::size_t p = 0; p < places; ++p) {
    const Room::Place& place = plan.room.places[p];
    const bool shut = plan.ways_after[p].door >= 0 && !plan.ways_after[p].open;
    out += person(view, plan.room, place.at, shut, !plan.outcome(p)["hit_by"].empty());
    out += words_at(view, place.at, view.scale * plan.room.person / 2 + 13, place.name);
  }
  return out + names(view, plan) + scale_bar(view) + "</svg>\n";
}

std::string key(const std::string& drawn, const std::string& words) {
  return "<span><svg viewBox=\"0 0 46 16\">" + drawn + "</svg>" + words + "</span>\n";
}

std::string keys(const ReportPage& page) {
  const auto box = [](const char* how) {
    return fmt::format("<rect x=\"6\" y=\"2\" width=\"34\" height=\"12\" {}/>", how);
  };
  const auto stroke = [](const char* how) { return fmt::format("<polyline points=\"0,8 46,8\" {}/>", how); };
  View view;
  view.least = Vec2::Zero(), view.most = Vec2(46, 16);
  const Vec2 middle = view.most / 2;
  Room small;
  small.person = 7;
  return "<div class=\"keys\">\n" + key(box(k_fallen), page.say(words::k_key_fallen)) +
         key(box(k_standing), page.say(words::k_key_standing)) +
         key(box(k_start), page.say(words::k_key_start)) +
         key(stroke(k_way_before), page.say(words::k_key_way_before)) +
         key(stroke(k_way), page.say(words::k_key_way)) +
         key(person(view, small, middle, true, false), page.say(words::k_key_shut)) +
         key(person(view, small, middle, false, true), page.say(words::k_key_hit)) + "</div>\n";
}

std::string listed(const ordered_json& list) {
  std::string out;
  for (const ordered_json& name : list) out += (out.empty() ? "" : ", ") + escaped(name.get<std::string>());
  return out.empty() ? "\u2013" : out;
}

std::string table(const ReportPage& page, const ordered_json& ways) {
  std::vector<std::vector<std::string>> rows;
  for (const ordered_json& way : ways) {
    std::string hits;
    for (const ordered_json& hit : way["hit_by"])
      hits += (hits.empty() ? "" : ", ") + page.say(words::k_hit_at, hit["body"].get<std::string>(),
                                                    shown(hit["time_s"].get<double>(), 2));
    const bool any = !way["open"].is_null();
    rows.push_back({escaped(way["place"].get<std::string>()), way_in_words(page, way),
                    any ? escaped(way["door"].get<std::string>()) : "\u2013",
                    with_error(way["before"]["widest_m"], nullptr, 1, 3),
                    with_error(way["widest_m"], nullptr, 1, 3), with_error(way["length_m"], nullptr, 1, 1),
                    any ? listed(way["blocked_by"]) : "\u2013", hits.empty() ? "\u2013" : hits});
  }
  return "<div class=\"ways\">" +
         page.table({page.say(words::k_place), page.say(words::k_way), page.say(words::k_door),
                     page.say(words::k_wide_before), page.say(words::k_wide), page.say(words::k_long),
                     page.say(words::k_blocked_by), page.say(words::k_hit_by)},
                    rows, false) +
         "</div>\n";
}

}  // namespace

std::string way_in_words(const ReportPage& page, const ordered_json& way) {
  if (way["open"].is_null()) return "\u2013";
  return page.say(way["open"].get<bool>() ? words::k_open_way : words::k_no_way);
}

std::string ways_section(ReportPage& page) {
  const Report& report = page.report();
  const Setup& setup = report.scene->setup;
  const Room& room = setup.room;
  Plan plan{page,
            room,
            setup.model,
            room_plan(room, setup.model, report.nodes_at_start),
            room_plan(room, setup.model, report.nodes_at_end),
            {},
            {}};
  plan.ways_before = ways(room, plan.before);
  plan.ways_after = ways(room, plan.after);
  return page.section(
      words::k_ways,
      page.paragraph(page.say(words::k_ways_text, short_shown(room.person), shown(k_head_height, 1),
                              shown(k_person_height, 1))) +
          table(page, report.summary["ways"]) +
          page.figure(drawing(plan) + keys(page), page.say(words::k_plan_figure, page.next_figure())) +
          (room.walls.size() < 4 ? page.paragraph(page.say(words::k_open_sides), "note") : ""));
}

}  // namespace topple::app
