#include "app/picture/room_piece.h"

#include <algorithm>
#include <cmath>

#include "solver/io/document/scene_document.h"
#include "solver/io/scene/furniture.h"
#include "solver/io/scene/scene_entry.h"

namespace topple::app {
namespace {

/// Half of the body's outer extent about `spot`, along its depth and width, and its height, m.
Vec3 reach_of(const Model& model, const State& start, const Body& body, const Spot& spot) {
  const Vec2 front(std::cos(spot.yaw), std::sin(spot.yaw)), left(-front.y(), front.x());
  Vec3 reach = Vec3::Zero();
  double low = 1e30, width = 0;
  for (int p = body.first_contact_point; p < body.first_contact_point + body.contact_point_count; ++p)
    width = std::max(width, model.contact_points[p].width);
  for (int i = body.first_node; i < body.first_node + body.node_count; ++i) {
    const Vec3& x = start.position[i];
    const Vec2 from = x.head<2>() - spot.at;
    reach.x() = std::max(reach.x(), std::abs(from.dot(front)));
    reach.y() = std::max(reach.y(), std::abs(from.dot(left)));
    reach.z() = std::max(reach.z(), x.z());
    low = std::min(low, x.z());
  }
  return reach + Vec3(width / 2, width / 2, width - low);
}

Spot middle_of(const State& start, const Body& body) {
  Vec2 low = Vec2::Constant(1e30), high = -low;
  for (int i = body.first_node; i < body.first_node + body.node_count; ++i) {
    low = low.cwiseMin(start.position[i].head<2>());
    high = high.cwiseMax(start.position[i].head<2>());
  }
  return {(low + high) / 2, 0};
}

}  // namespace

std::vector<RoomPiece> pieces_of(const io::Scene& scene) {
  const Model& model = scene.setup.model;
  const std::string origin = scene.name + ".toml";
  const io::Node root = io::parse_toml(scene.text, origin);
  const State start = start_state(model, scene.setup.starts);
  const std::vector<io::FurniturePiece> furniture = io::furniture_of(scene);
  std::vector<RoomPiece> all;
  for (const io::BodyEntry& of : io::body_entries(scene)) {
    const io::Node& node = root.find(of.table)->items.at(of.number - 1).value;
    const io::Entry entry(origin, of.table, of.table, &node, node.place);
    const bool copied = node.find("copies") != nullptr;
    const std::vector<Vec3> copies =
        copied ? entry.vectors("copies") : std::vector<Vec3>(of.bodies, Vec3::Zero());
    for (std::size_t k = 0; k < of.bodies; ++k) {
      RoomPiece piece;
      piece.table = piece.becomes = of.table;
      piece.number = of.number;
      piece.body = of.first_body + k;
      if (copied) piece.copy = k;
      piece.upright = !node.find("pose");
      const Body& body = model.bodies[piece.body];
      piece.name = body.name;
      if (of.table == "furniture") {
        const io::FurniturePiece& its = furniture.at(of.number - 1);
        piece.kind = its.kind;
        piece.becomes = its.table;
        piece.spot = {its.at.head<2>() + copies[k].head<2>(), its.yaw};
        piece.floor = its.at.z() + copies[k].z();
        piece.size = its.size;
        piece.mass = its.mass;
        piece.contents = its.contents_mass;
      } else if (of.table == "frame") {
        piece.spot = middle_of(start, body);
      } else {
        const std::vector<double> at = entry.numbers("at");
        piece.spot = {Vec2(at[0], at[1]) + copies[k].head<2>(), entry.number("yaw")};
        piece.floor = (at.size() > 2 ? at[2] : 0) + copies[k].z();
      }
      const Vec3 reach = reach_of(model, start, body, piece.spot);
      piece.half = reach.head<2>();
      if (piece.size.isZero(0)) piece.size = {2 * reach.x(), 2 * reach.y(), reach.z()};
      all.push_back(std::move(piece));
    }
  }
  return all;
}

}  // namespace topple::app
