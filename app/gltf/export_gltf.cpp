#include "app/gltf/export_gltf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "app/gltf/glb.h"
#include "app/gltf/key_frames.h"
#include "app/gltf/run_motion.h"
#include "app/picture/bridge.h"
#include "app/picture/replay.h"
#include "render/scene/colour_map.h"
#include "render/scene/mesh.h"

namespace topple::app {
namespace {

using Eigen::Vector3f;
using Json = Glb::Json;
using Rgb = std::array<float, 3>;  // linear

constexpr float k_place_error = 1e-4f;        // m, of what lies between keys
constexpr float k_turn_error = 1e-4f;         // rad
constexpr float k_channel_error = 1 / 500.f;  // of a colour
constexpr float k_grid = 0.5f;                // m
constexpr float k_before_sheet = 1e-3f;       // m, of grid lines

enum GltfMaterial { k_of_members, k_of_sheets, k_of_grounds, k_of_grid };

float linear(float coded) {
  return coded <= 0.04045f ? coded / 12.92f : std::pow((coded + 0.055f) / 1.055f, 2.4f);
}

Rgb linear_of(const render::Float4& coded) {
  return {linear(coded[0]), linear(coded[1]), linear(coded[2])};
}

Rgb on_map(float position) {
  const auto place = static_cast<std::size_t>(std::lround(position * (render::k_colour_map_size - 1)));
  const auto& coded = render::colour_table(render::ColourMap::viridis)[place];
  return linear_of({coded[0] / 255.f, coded[1] / 255.f, coded[2] / 255.f, 1});
}

std::uint8_t share_as_byte(float share) {
  return static_cast<std::uint8_t>(std::lround(255 * share));
}

Json gltf_material(const char* name, const render::Float4& coded) {
  const Rgb colour = linear_of(coded);
  const float alpha = coded[3];
  Json out = {{"name", name},
              {"pbrMetallicRoughness",
               {{"baseColorFactor", {colour[0], colour[1], colour[2], alpha}},
                {"metallicFactor", 0},
                {"roughnessFactor", 0.7}}}};
  if (alpha < 1) out["alphaMode"] = "BLEND", out["doubleSided"] = true;
  return out;
}

void push(std::vector<float>& to, const Vector3f& v) {
  to.insert(to.end(), v.begin(), v.end());
}

/// Of vertices, four each.
struct SkinWeights {
  std::vector<std::uint16_t> joints;
  std::vector<std::uint8_t> weights;
  void add(int first, int second, float share_of_second) {
    const std::uint8_t share = share_as_byte(share_of_second);
    const auto joint = [](int number, int weight) {
      return static_cast<std::uint16_t>(weight > 0 ? number : 0);  // as the format asks
    };
    joints.insert(joints.end(), {joint(first, 255 - share), joint(second, share), 0, 0});
    weights.insert(weights.end(), {static_cast<std::uint8_t>(255 - share), share, 0, 0});
  }
};

class GltfModel {
 public:
  GltfModel(const io::Scene& scene, const RunMotion& run)
      : scene_(scene), model_(scene.setup.model), run_(run), tubes_(model_.members.size()) {
    halve_what_breaks();
    render::LeftOut left_out;
    mesh_ = solid_mesh(reference_, left_out);
    for (std::size_t t = 0; t < reference_.tubes.size(); ++t)
      if (mesh_.tubes[t].count > 0) tubes_[reference_.tubes[t].member].push_back(t);
  }

  std::string file() {
    glb_.json["asset"] = {{"version", "2.0"}, {"generator", "topple " TOPPLE_VERSION}};
    glb_.json["scene"] = 0;
    glb_.json["scenes"] = Json::array({{{"nodes", {0}}}});
    const float half = std::sqrt(0.5f);  // a quarter turn: from z up to y up
    glb_.add("nodes", {{"name", scene_.title.empty() ? scene_.name : scene_.title},
                       {"rotation", {-half, 0, 0, half}}});
    glb_.add("materials", gltf_material("members", {1, 1, 1, 1}));
    glb_.add("materials", gltf_material("panels", {0.52f, 0.62f, 0.72f, 0.3f}));
    glb_.add("materials", gltf_material("floor and walls", k_ground_colour));
    glb_.add("materials", gltf_material("grid", {0.45f, 0.45f, 0.45f, 1}));
    glb_.add("animations", {{"name", "run"}, {"channels", Json::array()}, {"samplers", Json::array()}});
    add_floor();
    for (std::size_t b = 0; b < model_.bodies.size(); ++b) add_body(b);
    if (const render::Legend& legend = run_.legend; !legend.quantity.empty())
      glb_.json["extras"] = {
          {"quantity", legend.quantity}, {"unit", legend.unit}, {"minimum", legend.minimum},
          {"maximum", legend.maximum},   {"map", "viridis"},    {"position", "square root of the share"}};
    return glb_.bytes();
  }

 private:
  /// Both halves of an element that breaks meet in its middle.
  void halve_what_breaks() {
    const auto half_gap = [this](std::size_t s) {
      const auto at = [this](std::size_t station) {
        return Vector3f(reference_.stations[station].position.data());
      };
      return (at(s) - at(s - 1)).norm() / 2;
    };
    for (render::Tube& tube : reference_.tubes) {
      if (tube.torn_first > 0) tube.lead = half_gap(tube.first_station);
      if (tube.torn_last > 0) tube.trail = half_gap(tube.first_station + tube.station_count);
      tube.torn_first = tube.torn_last = 0;
    }
  }

  std::size_t add_node(std::size_t parent, Json node) {
    const std::size_t number = glb_.add("nodes", std::move(node));
    glb_.json["nodes"][parent]["children"].push_back(number);
    return number;
  }

  /// The node begins as the track does; it has keys where that moves, or `always`.
  void animate(std::size_t node, const char* path, const Track& track, float tolerance, bool always = false) {
    glb_.json["nodes"][node][path] = std::vector<float>(track.at(0), track.at(0) + track.columns);
    std::vector<std::size_t> keys = kept_keys(run_.times, track, tolerance);
    if (keys.size() == 1 && !always) return;
    if (keys.size() == 1 && track.size() > 1) keys.push_back(track.size() - 1);
    std::vector<float> values;
    for (const std::size_t key : keys)
      values.insert(values.end(), track.at(key), track.at(key) + track.columns);
    add_channel(node, path, keys, glb_.accessor(GlbUse::keys, track.columns == 3 ? "VEC3" : "VEC4", values));
  }

  void add_channel(std::size_t node, const char* path, const std::vector<std::size_t>& keys,
                   std::size_t output) {
    std::vector<float> times;
    for (const std::size_t key : keys) times.push_back(run_.times[key]);
    Json& run = glb_.json["animations"][0];
    run["channels"].push_back(
        {{"sampler", run["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
    run["samplers"].push_back(
        {{"input", glb_.accessor(GlbUse::keys, "SCALAR", times, false, true)}, {"output", output}});
  }

  std::size_t vectors(const std::vector<float>& values, bool bounds) {
    return glb_.accessor(GlbUse::vertices, "VEC3", values, false, bounds);
  }

  std::size_t add_mesh(const std::string& name, Json primitives) {
    return glb_.add("meshes", {{"name", name}, {"primitives", std::move(primitives)}});
  }

  void add_floor() {
    const std::size_t floor = add_node(0, {{"name", "floor"}});
    animate(floor, "translation", run_.floor, k_place_error, true);
    for (std::size_t p = 0; p < reference_.grounds.size(); ++p) {
      const std::string name = "floor/" + model_.planes[p].name;
      const Json primitives = {sheet(reference_.grounds[p]), grid(reference_.grounds[p])};
      add_node(floor, {{"name", name}, {"mesh", add_mesh(name, primitives)}});
    }
  }

  static Vector3f across(const render::Ground& ground) {
    return Vector3f(ground.normal.data()).cross(Vector3f(ground.along.data()));
  }

  Json sheet(const render::Ground& ground) {
    const Vector3f centre(ground.centre.data()), x = ground.half_length * Vector3f(ground.along.data()),
                                                 y = ground.half_width * across(ground);
    std::vector<float> corners, normals;
    for (const Vector3f& corner : std::array<Vector3f, 4>{-x - y, x - y, x + y, y - x}) {
      push(corners, centre + corner);
      push(normals, Vector3f(ground.normal.data()));
    }
    return {{"attributes", {{"POSITION", vectors(corners, true)}, {"NORMAL", vectors(normals, false)}}},
            {"indices", quads(1)},
            {"material", k_of_grounds}};
  }

  Json grid(const render::Ground& ground) {
    constexpr int k_lines = 1;
    const Vector3f centre = Vector3f(ground.centre.data()) + k_before_sheet * Vector3f(ground.normal.data());
    std::vector<float> ends;
    const auto add = [&](const Vector3f& to, float half, const Vector3f& side) {
      const float last = std::floor(half / k_grid);
      for (float i = -last; i <= last; ++i)
        for (const float end : {-1.f, 1.f}) push(ends, centre + i * k_grid * to + end * side);
    };
    const Vector3f along(ground.along.data());
    add(along, ground.half_length, ground.half_width * across(ground));
    add(across(ground), ground.half_width, ground.half_length * along);
    return {{"attributes", {{"POSITION", vectors(ends, true)}}}, {"material", k_of_grid}, {"mode", k_lines}};
  }

  /// Triangles of quadrilaterals, four corners each.
  std::size_t quads(std::uint32_t count) {
    std::vector<std::uint32_t> indices;
    for (std::uint32_t k = 0; k < 4 * count; k += 4)
      indices.insert(indices.end(), {k, k + 1, k + 2, k, k + 2, k + 3});
    return glb_.accessor(GlbUse::indices, "SCALAR", indices);
  }

  void add_body(std::size_t b) {
    const Body& body = model_.bodies[b];
    const std::size_t node = add_node(0, {{"name", body.name}});
    animate(node, "translation", run_.bodies[b].place, k_place_error, true);
    animate(node, "rotation", run_.bodies[b].turn, k_turn_error, true);
    std::optional<std::size_t> skin;
    if (run_.deforms[b]) skin = add_skin(body, node);
    for (int m = body.first_member; m < body.first_member + body.member_count; ++m)
      if (!tubes_[m].empty()) add_member(body, node, m, skin);
    if (!body.solid && body.panel_count > 0) add_panels(body, node, skin);
  }

  /// Its nodes as joints.
  std::size_t add_skin(const Body& body, std::size_t parent) {
    std::vector<std::size_t> joints;
    std::vector<float> inverse;
    for (int i = 0; i < body.node_count; ++i) {
      const int n = body.first_node + i;
      const std::size_t joint = add_node(parent, {{"name", body.name + "/node " + std::to_string(i)}});
      joints.push_back(joint);
      animate(joint, "translation", run_.nodes[n].place, k_place_error);
      animate(joint, "rotation", run_.nodes[n].turn, k_turn_error);
      Eigen::Matrix4f matrix = Eigen::Matrix4f::Identity();
      matrix.topRightCorner<3, 1>() = (body.centre_of_gravity - model_.node_position[n]).cast<float>();
      inverse.insert(inverse.end(), matrix.data(), matrix.data() + matrix.size());
    }
    return glb_.add("skins", {{"name", body.name},
                              {"inverseBindMatrices", glb_.accessor(GlbUse::matrices, "MAT4", inverse)},
                              {"joints", joints}});
  }

  void add_member(const Body& body, std::size_t parent, int m, std::optional<std::size_t> skin) {
    const std::string name = body.name + "/" + (body.solid ? "block" : model_.members[m].name);
    std::vector<float> places, normals;
    std::vector<std::uint32_t> indices;
    std::vector<int> stations;  // of vertices, counted within the member
    int first = 0;
    for (const std::size_t t : tubes_[m]) {
      add_tube(t, first, stations, indices);
      first += static_cast<int>(reference_.tubes[t].station_count);
    }
    const std::uint32_t base = *std::ranges::min_element(indices);
    for (std::uint32_t& index : indices) index -= base;
    for (std::size_t v = 0; v < stations.size(); ++v) {
      push(places, mesh_.vertices[base + v].position - body.centre_of_gravity.cast<float>());
      push(normals, mesh_.vertices[base + v].normal);
    }
    Json primitive = {
        {"attributes", {{"POSITION", vectors(places, true)}, {"NORMAL", vectors(normals, false)}}},
        {"indices", glb_.accessor(GlbUse::indices, "SCALAR", indices)},
        {"material", k_of_members}};
    if (skin) add_skin_weights(m, stations, primitive["attributes"]);
    const std::optional<ColourKeys> colours = colour_member(m, stations, primitive);
    Json node = {{"name", name}, {"mesh", add_mesh(name, Json::array({primitive}))}};
    if (skin) node["skin"] = *skin;
    const std::size_t number = add_node(parent, std::move(node));
    if (colours)
      add_channel(number, "weights", colours->keys,
                  glb_.accessor(GlbUse::keys, "SCALAR", colours->weights, true));
  }

  /// Appends the tube's triangles, and for each of its vertices the nearest of its stations, from `first` on.
  void add_tube(std::size_t t, int first, std::vector<int>& stations, std::vector<std::uint32_t>& indices) {
    const render::Tube& tube = reference_.tubes[t];
    const auto from = mesh_.indices.begin() + mesh_.tubes[t].first, to = from + mesh_.tubes[t].count;
    const auto station = [&](std::uint32_t s) {
      return Vector3f(reference_.stations[tube.first_station + s].position.data());
    };
    const Vector3f axis = (station(tube.station_count - 1) - station(0)).normalized();
    const auto [low, high] = std::minmax_element(from, to);
    for (std::uint32_t v = *low; v <= *high; ++v) {
      std::uint32_t nearest = 0;
      const auto distance = [&](std::uint32_t s) {
        return std::abs(axis.dot(mesh_.vertices[v].position - station(s)));
      };
      for (std::uint32_t s = 1; s < tube.station_count; ++s)
        if (distance(s) < distance(nearest)) nearest = s;
      stations.push_back(first + static_cast<int>(nearest));
    }
    indices.insert(indices.end(), from, to);
  }

  /// Between its nodes an element blends their motions by a cubic, so that it leaves both in their
  /// directions. Halves of one that breaks follow one node each.
  void add_skin_weights(int m, const std::vector<int>& stations, Json& attributes) {
    constexpr int k_steps = k_stations - 1;
    const Member& member = model_.members[m];
    SkinWeights skin;
    for (const int station : stations) {
      const int k = std::min(station / k_steps, member.element_count - 1);
      const float t = static_cast<float>(station - k * k_steps) / static_cast<float>(k_steps);
      const int e = member.first_element + k;
      const int first_node = model_.bodies[member.body].first_node;
      const auto& node = model_.elements[e].node;
      const float share = run_.breaks[e] ? std::round(t) : t * t * (3 - 2 * t);
      skin.add(node[0] - first_node, node[1] - first_node, share);
    }
    add(skin, attributes);
  }

  void add(const SkinWeights& skin, Json& attributes) {
    attributes["JOINTS_0"] = glb_.accessor(GlbUse::vertices, "VEC4", skin.joints);
    attributes["WEIGHTS_0"] = glb_.accessor(GlbUse::vertices, "VEC4", skin.weights, true);
  }

  struct ColourKeys {
    std::vector<std::size_t> keys;
    std::vector<std::int16_t> weights;  ///< of all targets at each key
  };
  /// Between which colours of its member a vertex lies: `share` of the way from `k` to the next one.
  struct ColourShare {
    std::size_t k;
    float share;
    float of(std::size_t colour) const { return colour == k ? 1 - share : colour == k + 1 ? share : 0; }
  };

  /// Gives vertices the colour of the greatest stress in the run, and, where that is ever another, targets
  /// that add to it: each a channel of the colour at a station.
  std::optional<ColourKeys> colour_member(int m, const std::vector<int>& stations, Json& primitive) {
    const std::vector<Rgb> most = most_stressed(m);
    const std::vector<ColourShare> shares = colour_shares(m, stations);
    const auto attribute = [&](auto channel) {
      std::vector<std::uint8_t> values;
      for (const ColourShare& at : shares)
        for (std::size_t c = 0; c < 4; ++c) values.push_back(share_as_byte(channel(at, c)));
      return glb_.accessor(GlbUse::vertices, "VEC4", values, true);
    };
    primitive["attributes"]["COLOR_0"] = attribute([&](const ColourShare& at, std::size_t c) {
      return c == 3 ? 1 : at.of(at.k) * most[at.k][c] + at.of(at.k + 1) * most[at.k + 1][c];
    });
    std::optional<ColourKeys> keys = colour_keys(run_.colours[m], most);
    if (keys)
      for (std::size_t k = 0; k < most.size(); ++k)
        for (std::size_t channel = 0; channel < 3; ++channel)
          primitive["targets"].push_back(
              {{"POSITION", glb_.zero_vectors(stations.size())},  // three.js morphs no colours without
               {"COLOR_0", attribute([&](const ColourShare& at, std::size_t c) {
                  return c == channel ? at.of(k) : 0;
                })}});
    return keys;
  }

  std::vector<Rgb> most_stressed(int m) const {
    const Track& positions = run_.colours[m];
    const render::Float4& own = reference_.tubes[tubes_[m].front()].colour;
    std::vector<Rgb> out;
    for (std::size_t k = 0; k < positions.columns; ++k) {
      float most = k_own_colour;
      for (std::size_t i = 0; i < positions.size(); ++i) most = std::max(most, positions.at(i)[k]);
      out.push_back(most == k_own_colour ? linear_of(own) : on_map(most));
    }
    return out;
  }

  std::vector<ColourShare> colour_shares(int m, const std::vector<int>& stations) const {
    std::vector<ColourShare> out;
    for (const int station : stations) {
      const auto place = [&](std::size_t k) { return colour_place(model_.members[m], k); };
      std::size_t k = 0;
      while (k + 2 < run_.colours[m].columns && place(k + 1) <= station) ++k;
      const int span = place(k + 1) - place(k);
      out.push_back({k, span > 0 ? static_cast<float>(station - place(k)) / static_cast<float>(span) : 0});
    }
    return out;
  }

  /// Of the weights; none where they stay 0.
  std::optional<ColourKeys> colour_keys(const Track& positions, const std::vector<Rgb>& most) const {
    Track track{3 * most.size()};
    for (std::size_t i = 0; i < positions.size(); ++i)
      for (std::size_t k = 0; k < most.size(); ++k) {
        const float position = positions.at(i)[k];
        const Rgb now = position == k_own_colour ? linear_of(k_rigid_colour) : on_map(position);
        for (std::size_t c = 0; c < 3; ++c) track.values.push_back(now[c] - most[k][c]);
      }
    ColourKeys out{kept_keys(run_.times, track, k_channel_error), {}};
    if (out.keys.size() == 1) return std::nullopt;
    for (const std::size_t key : out.keys)
      for (std::size_t i = 0; i < track.columns; ++i)
        out.weights.push_back(static_cast<std::int16_t>(std::lround(32767 * track.at(key)[i])));
    return out;
  }

  void add_panels(const Body& body, std::size_t parent, std::optional<std::size_t> skin) {
    std::vector<float> corners, normals;
    SkinWeights weights;
    for (int p = body.first_panel; p < body.first_panel + body.panel_count; ++p) {
      const auto corner = [&](int k) -> Vector3f {
        return (model_.node_position[model_.panels[p].node[k]] - body.centre_of_gravity).cast<float>();
      };
      const Vector3f normal = (corner(1) - corner(0)).cross(corner(3) - corner(0)).normalized();
      for (int k = 0; k < 4; ++k) {
        push(corners, corner(k));
        push(normals, normal);
        weights.add(model_.panels[p].node[k] - body.first_node, 0, 0);
      }
    }
    Json primitive = {
        {"attributes", {{"POSITION", vectors(corners, true)}, {"NORMAL", vectors(normals, false)}}},
        {"indices", quads(static_cast<std::uint32_t>(body.panel_count))},
        {"material", k_of_sheets}};
    if (skin) add(weights, primitive["attributes"]);
    const std::string name = body.name + "/panels";
    Json node = {{"name", name}, {"mesh", add_mesh(name, Json::array({primitive}))}};
    if (skin) node["skin"] = *skin;
    add_node(parent, std::move(node));
  }

  const io::Scene& scene_;
  const Model& model_;
  const RunMotion& run_;
  render::SceneFrame reference_ = run_.reference;
  std::vector<std::vector<std::size_t>> tubes_;  // of each member, that can be drawn
  render::Mesh mesh_;
  Glb glb_;
};

}  // namespace

bool export_gltf(const io::Recording& recording, const host::Target& target, const io::Proceed& proceed) {
  const io::Scene scene = io::recorded_scene(recording);
  host::StagedFile file(target, host::FileKind::gltf);
  const std::optional<RunMotion> run = run_motion(scene, Replay(recording), proceed);
  if (!run) return false;
  file.write(GltfModel(scene, *run).file());
  file.commit();
  return true;
}

}  // namespace topple::app
