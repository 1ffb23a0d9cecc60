// Bodies made as large and heavy as the furniture that they are.
#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/io/builtin/stock.h"
#include "solver/io/common/units.h"
#include "solver/io/scene/furniture_piece.h"
#include "solver/io/scene/scene_read.h"
#include "solver/io/scene/scene_words.h"
#include "solver/math/ranges.h"
#include "solver/model/block.h"
#include "solver/model/body_builder.h"
#include "solver/model/cabinet.h"
#include "solver/model/mass_fit.h"

namespace topple::io {
namespace {

constexpr const char* k_axes[] = {"depth", "width", "height"};

Node vector_node(const Vec3& v, const Place& place) {
  return numbers_node({v.x(), v.y(), v.z()}, place);
}

/// Where the entry says something of its own, else the body of its kind, else the entry.
Place place_of(const Piece& piece, std::string_view key, std::string_view body_key) {
  if (const Node* const node = piece.entry.node()->find(key)) return node->place;
  const Node* const node = piece.body.find(body_key);
  return node ? node->place : piece.entry.place();
}
Place place_of(const Piece& piece, std::string_view key) {
  return place_of(piece, key, key);
}

/// The size between centre lines, half of a width within the outer one.
Vec3 size_within(const Piece& piece, double width) {
  for (int k = 0; k < 3; ++k)
    if (!(piece.size[k] > width))
      piece.entry.fail("size", std::string("the ") + k_axes[k] + ", " + topple::millimetres(piece.size[k]) +
                                   ", is not more than the " + topple::millimetres(width) +
                                   " of its members");
  return piece.size - Vec3::Constant(width);
}

/// Inertia of a uniform box about its middle, kg m^2 per kg.
Vec3 box_inertia(const Vec3& size) {
  const Vec3 square = size.cwiseProduct(size);
  return (Vec3::Constant(square.sum()) - square) / 12;
}

/// Of contents about their centre, kg m^2: a uniform box about it that reaches the nearer sides.
Vec3 contents_inertia(const Piece& piece) {
  Vec3 size;
  for (int k = 0; k < 3; ++k) {
    const double from = k < 2 ? piece.contents_cg[k] + piece.size[k] / 2 : piece.contents_cg[k];
    size[k] = 2 * std::min(from, piece.size[k] - from);
  }
  return piece.contents_mass * box_inertia(size);
}

/// Mass, centre of gravity and diagonal of the inertia of the piece with its contents.
struct Filled {
  double mass;
  Vec3 cg, inertia;
};

/// `cg`, from the middle of the outer base, and `inertia` about it: of the empty piece.
Filled filled(const Piece& piece, const Vec3& cg, const Vec3& inertia) {
  Filled all;
  all.mass = piece.mass + piece.contents_mass;
  all.cg = (piece.mass * cg + piece.contents_mass * piece.contents_cg) / all.mass;
  const auto moved = [&](const Vec3& from, double mass) -> Vec3 {
    const Vec3 r2 = (from - all.cg).cwiseAbs2();
    return mass * (Vec3::Constant(r2.sum()) - r2);
  };
  all.inertia = inertia + moved(cg, piece.mass) + contents_inertia(piece) +
                moved(piece.contents_cg, piece.contents_mass);
  return all;
}

double cabinet_width(const Entry& body, const SectionWidth& width) {
  return width(body.text("section"));
}

Vec3 outer_cabinet(const Entry& body, const SectionWidth& width) {
  return body.vector("size") + Vec3::Constant(cabinet_width(body, width));
}

void fit_cabinet(Piece& piece) {
  const Entry body = piece.body_entry();
  const double width = cabinet_width(body, piece.width);
  const double before = body.vector("size").z();
  CabinetSpec empty;
  empty.size = size_within(piece, width);
  empty.mass = piece.mass;
  empty.cg_height = empty.size.z() / 2;
  if (body.has("cg_height"))
    empty.cg_height = piece.entry.has("cg_height") ? body.number("cg_height")
                                                   : body.number("cg_height") * empty.size.z() / before;
  const bool given = !body.is_word("inertia");
  if (!given) empty.inertia = body.chosen("inertia", k_inertias);
  Vec3 cg(0, 0, empty.cg_height + width / 2);
  if (body.has("cg_offset"))
    for (int k = 0; k < 2; ++k)
      cg[k] = body.numbers("cg_offset")[k] *
              (piece.entry.has("cg_offset") ? 1 : empty.size[k] / body.vector("size")[k]);
  const Filled all = filled(piece, cg, given ? Vec3::Zero() : inertia_of(empty));

  const bool filled_up = piece.contents_mass > 0;
  const bool symmetric = all.cg.head<2>().isZero(0) && body.word("front") == "closed";
  const auto place = [&](std::string_view key) {
    return place_of(piece, piece.entry.has(key) ? key : "contents", key);
  };
  const Place of_height = place("cg_height"), of_offset = place("cg_offset"), of_inertia = place("inertia");
  if (filled_up || body.has("cg_height"))
    set_key(piece.body, "cg_height", number_node(all.cg.z() - width / 2, of_height));
  if (!symmetric) set_key(piece.body, "cg_offset", numbers_node({all.cg.x(), all.cg.y()}, of_offset));
  if (filled_up && !given && !piece.entry.has("inertia"))
    set_key(piece.body, "inertia", vector_node(all.inertia, of_inertia));
  set_key(piece.body, "size", vector_node(empty.size, place_of(piece, "size")));
  set_key(piece.body, "mass", number_node(all.mass, place_of(piece, "mass")));
}

/// contact_width_of() the block that is left within this outer size, m.
double width_by_default(const Vec3& outer) {
  // w = min(share (outer - w), most): the rule is known by its values on small and on large blocks
  const double share = contact_width_of(Vec3::Constant(1e-3)) / 1e-3,
               most = contact_width_of(Vec3::Constant(1e3));
  return std::min(outer.minCoeff() * share / (1 + share), most);
}

Vec3 outer_block(const Entry& body, const SectionWidth&) {
  const Vec3 size = body.vector("size");
  return size + Vec3::Constant(body.has("width") ? body.number("width") : contact_width_of(size));
}

void fit_block(Piece& piece) {
  const Entry body = piece.body_entry();
  const double width = body.has("width") ? body.number("width") : width_by_default(piece.size);
  const Vec3 before = body.vector("size");
  BlockSpec empty;
  empty.size = size_within(piece, width);
  empty.mass = piece.mass;
  empty.cg = Vec3(0, 0, empty.size.z() / 2);
  if (body.has("cg")) {
    empty.cg = body.vector("cg");
    if (!piece.entry.has("cg")) empty.cg = empty.cg.cwiseProduct(empty.size).cwiseQuotient(before);
  }
  const bool given = !body.is_word("inertia");
  const Vec3 base(0, 0, width / 2);
  const Filled all = filled(piece, empty.cg + base, given ? Vec3::Zero() : inertia_of(empty));

  set_key(piece.body, "size", vector_node(empty.size, place_of(piece, "size")));
  set_key(piece.body, "width", number_node(width, place_of(piece, "width")));
  set_key(piece.body, "mass", number_node(all.mass, place_of(piece, "mass")));
  if (piece.contents_mass > 0 || body.has("cg"))
    set_key(piece.body, "cg", vector_node(all.cg - base, place_of(piece, "contents", "cg")));
  if (piece.contents_mass > 0 && !given)
    set_key(piece.body, "inertia", vector_node(all.inertia, place_of(piece, "contents")));
}

/// Half of the contact width of the widest member at each node of a frame, m.
std::vector<double> half_widths(const Entry& body, const SectionWidth& width) {
  std::vector<double> half(body.vectors("nodes").size(), 0);
  for (const Entry& member : body.entries("members"))
    for (const int node : member.integers("nodes"))
      if (static_cast<std::size_t>(node) < half.size())  // else the frame is refused where it is built
        half[node] = std::max(half[node], width(member.text("section")) / 2);
  return half;
}

/// Of an axis: from the least of x - half to the greatest of x + half.
std::pair<double, double> extent(const std::vector<Vec3>& nodes, const std::vector<double>& half, int axis) {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    least = std::min(least, nodes[i][axis] - half[i]);
    most = std::max(most, nodes[i][axis] + half[i]);
  }
  return {least, most};
}

Vec3 size_of(const std::vector<Vec3>& nodes, const std::vector<double>& half) {
  Vec3 size;
  for (int k = 0; k < 3; ++k) {
    const auto [least, most] = extent(nodes, half, k);
    size[k] = most - least;
  }
  return size;
}

Vec3 outer_frame(const Entry& body, const SectionWidth& width) {
  return size_of(body.vectors("nodes"), half_widths(body, width));
}

Vec3 lines_of_frame(const Entry& body) {
  const std::vector<Vec3> nodes = body.vectors("nodes");
  return size_of(nodes, std::vector<double>(nodes.size(), 0));
}

Vec3 lines_of_box(const Entry& body) {
  return body.vector("size");
}

/// Factor on the coordinates of an axis with which it reaches over `size`: of each two nodes the one that
/// would, and the least of all. None: members of this width are wider than that.
std::optional<double> stretch(const std::vector<Vec3>& nodes, const std::vector<double>& half, int axis,
                              double size) {
  double factor = std::numeric_limits<double>::infinity();
  for (std::size_t a = 0; a < nodes.size(); ++a)
    for (std::size_t b = 0; b < nodes.size(); ++b) {
      const double apart = nodes[a][axis] - nodes[b][axis];
      if (apart > 0) factor = std::min(factor, (size - half[a] - half[b]) / apart);
    }
  if (!std::isfinite(factor)) return 1;  // flat: as thick as its members
  return factor > 0 ? std::optional(factor) : std::nullopt;
}

Node nodes_node(const std::vector<Vec3>& nodes, const Place& place) {
  std::vector<Node> list;
  for (const Vec3& x : nodes) list.push_back(vector_node(x, place));
  return list_node(std::move(list), place);
}

/// Masses on the nodes of a frame with the centre of gravity of the contents.
Node contents_masses(const Piece& piece, const std::vector<Vec3>& nodes, const Place& place) {
  constexpr double k_least = 1e-6;  // of an equal share
  const auto count = static_cast<Eigen::Index>(nodes.size());
  MomentProblem problem;
  problem.moments = Eigen::MatrixXd::Ones(4, count);
  for (Eigen::Index i = 0; i < count; ++i)
    problem.moments.col(i).tail<3>() = nodes[static_cast<std::size_t>(i)] - piece.contents_cg;
  problem.target = Eigen::Vector4d(piece.contents_mass, 0, 0, 0);
  problem.nominal = Eigen::VectorXd::Constant(count, piece.contents_mass / static_cast<double>(count));
  problem.least = k_least * problem.nominal;
  problem.count = Eigen::VectorXd::Ones(count);
  const auto masses = fit_masses(problem);
  if (!masses)
    piece.entry.fail("contents", "its nodes cannot carry a centre of gravity at " +
                                     topple::millimetres(piece.contents_cg.x()) + ", " +
                                     topple::millimetres(piece.contents_cg.y()) + ", " +
                                     topple::millimetres(piece.contents_cg.z()));
  std::vector<Node> list;
  for (Eigen::Index i = 0; i < count; ++i) {
    Node mass;
    mass.place = place;
    Node number = number_node(static_cast<double>(i), place);
    number.kind = Node::Kind::integer;
    number.integer = i;
    set_key(mass, "node", std::move(number));
    set_key(mass, "mass", number_node((*masses)[i], place));
    list.push_back(std::move(mass));
  }
  return list_node(std::move(list), place);
}

void fit_frame(Piece& piece) {
  const Entry body = piece.body_entry();
  std::vector<Vec3> nodes = body.vectors("nodes");
  const std::vector<double> half = half_widths(body, piece.width);
  for (int k = 0; k < 3; ++k) {
    const auto factor = stretch(nodes, half, k, piece.size[k]);
    if (!factor)
      piece.entry.fail("size", std::string("the ") + k_axes[k] + ", " + topple::millimetres(piece.size[k]) +
                                   ", is not more than the width of its members");
    for (Vec3& x : nodes) x[k] *= *factor;
    const auto [least, most] = extent(nodes, half, k);
    for (Vec3& x : nodes) x[k] -= k < 2 ? (least + most) / 2 : least;
  }
  set_key(piece.body, "nodes", nodes_node(nodes, place_of(piece, "size")));
  set_key(piece.body, "mass", number_node(piece.mass + piece.contents_mass, place_of(piece, "mass")));
  if (piece.contents_mass == 0) return;
  const Place place = place_of(piece, "contents");
  Node masses = contents_masses(piece, nodes, place);
  if (const Node* const own = piece.body.find("masses"))
    masses.items.insert(masses.items.begin(), own->items.begin(), own->items.end());
  set_key(piece.body, "masses", std::move(masses));
}

void put_box(Piece& piece, const Stand& stand) {
  const Place place = place_of(piece, "at");
  set_key(piece.body, "at", vector_node(stand.at, place));
  set_key(piece.body, "yaw", number_node(stand.yaw, place));
}

void put_frame(Piece& piece, const Stand& stand) {
  const Entry body = piece.body_entry();
  const Vec3 across = Vec3::UnitZ().cross(stand.front);
  const auto turned = [&](const Vec3& x) -> Vec3 {
    return x.x() * stand.front + x.y() * across + Vec3(0, 0, x.z());
  };
  std::vector<Vec3> nodes = body.vectors("nodes");
  for (Vec3& x : nodes) x = stand.at + turned(x);
  std::vector<std::pair<std::size_t, Vec3>> ups;
  const std::vector<Entry> members = body.entries("members");
  for (std::size_t k = 0; k < members.size(); ++k)
    if (members[k].has("up")) ups.emplace_back(k, turned(members[k].vector("up")));
  set_key(piece.body, "nodes", nodes_node(nodes, place_of(piece, "at")));
  for (const auto& [k, up] : ups) {
    Node& member = piece.body.find_item("members")->value.items[k].value;
    set_key(member, "up", vector_node(up, member.find("up")->place));
  }
}

/// What a table of bodies needs to hold furniture.
struct BodyFit {
  std::string_view table;
  Vec3 (*outer)(const Entry& body, const SectionWidth& width);
  Vec3 (*lines)(const Entry& body);  ///< size between centre lines
  void (*fit)(Piece&);
  void (*put)(Piece&, const Stand&);
};
/// A row for each of k_furniture_bodies.
constexpr BodyFit k_fits[] = {{"cabinet", outer_cabinet, lines_of_box, fit_cabinet, put_box},
                              {"frame", outer_frame, lines_of_frame, fit_frame, put_frame},
                              {"block", outer_block, lines_of_box, fit_block, put_box}};

const BodyFit& fit_of(std::string_view table) {
  return *ranges::find(k_fits, table, &BodyFit::table);
}

}  // namespace

SectionWidth section_widths(std::vector<Node> sections, const std::string& origin) {
  return [sections = std::move(sections), origin](const std::string& name) {
    constexpr double k_poisson = 0.3;  // the width does not depend on it
    const auto width = [&](const Node& table) {
      const Entry entry(origin, "section", "section." + name, &table, table.place);
      Section section = read_section(entry);
      complete_section(section, k_poisson);
      return section.width;
    };
    for (const Node& table : sections)
      if (table.find("name")->text == name) return width(table);
    const std::optional<Node> stock = stock_section(name, {});
    return stock ? width(*stock) : 0.;
  };
}

Vec3 outer_size(const std::string& table, const Entry& body, const SectionWidth& width) {
  return fit_of(table).outer(body, width);
}

void check_inside(const Entry& contents, const Vec3& cg, const Vec3& size) {
  for (int k = 0; k < 3; ++k) {
    const double from = k < 2 ? -size[k] / 2 : 0, to = from + size[k];
    if (!(cg[k] > from) || !(cg[k] < to))
      contents.fail("cg", std::string("along the ") + k_axes[k] + ", " + topple::millimetres(cg[k]) +
                              " is not inside the piece, which reaches from " + topple::millimetres(from) +
                              " to " + topple::millimetres(to));
  }
}

void fit(Piece& piece) {
  if (piece.contents_mass > 0) check_inside(piece.entry.entry("contents"), piece.contents_cg, piece.size);
  fit_of(piece.kind.table).fit(piece);
}

Vec3 rocking_size(const Piece& piece) {
  Piece fitted = piece;
  fit(fitted);
  return fit_of(piece.kind.table).lines(fitted.body_entry());
}

void put(Piece& piece, const Stand& stand) {
  fit_of(piece.kind.table).put(piece, stand);
}

}  // namespace topple::io
