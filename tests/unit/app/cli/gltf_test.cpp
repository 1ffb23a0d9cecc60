// An animated model of a recording: read back by the rules of glTF 2.0.
#include <Eigen/Geometry>
#include <cstring>
#include <map>
#include <optional>

#include "app/gltf/export_gltf.h"
#include "app/picture/replay.h"
#include "app/picture/row.h"
#include "render/scene/colour_map.h"
#include "solver/io/recording/recording.h"
#include "unit/app/program.h"
#include "unit/app/scenes.h"

namespace topple::app {
namespace {

using Json = nlohmann::json;
using Table = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr double k_rounding = 2e-6;  // of single precision, at a few metres
constexpr double k_between = 4e-4;   // m: what keys may leave out of a body and of a node in it, on its lever

/// A file, its numbers, and where its nodes are at a time.
class Gltf {
 public:
  explicit Gltf(const std::string& file) : bytes_(bytes_of(file)) {
    EXPECT_EQ(bytes_.substr(0, 4), "glTF");
    EXPECT_EQ(word(4), 2u);
    EXPECT_EQ(word(8), bytes_.size());
    const std::size_t text = word(12);
    EXPECT_EQ(text % 4, 0u);
    EXPECT_EQ(bytes_.substr(16, 4), "JSON");
    json = Json::parse(bytes_.substr(20, text));
    EXPECT_EQ(bytes_.substr(24 + text, 4), std::string("BIN\0", 4));
    data_ = bytes_.substr(28 + text);
    EXPECT_EQ(word(20 + text), data_.size());
    EXPECT_EQ(json["buffers"][0]["byteLength"], data_.size());
    for (std::size_t n = 0; n < json["nodes"].size(); ++n) {
      for (const std::size_t child : json["nodes"][n].value("children", Json::array())) parent_[child] = n;
      named_[json["nodes"][n]["name"]] = n;
    }
    for (const Json& channel : json["animations"][0]["channels"]) {
      const Json& sampler = json["animations"][0]["samplers"][channel["sampler"].get<std::size_t>()];
      channels_[{channel["target"]["node"], channel["target"]["path"]}] = {values(sampler["input"]),
                                                                           values(sampler["output"])};
    }
  }

  struct Channel {
    Table times, values;
  };

  /// Of an accessor, a row each; integers that are normalized as what they stand for.
  Table values(std::size_t accessor) const {
    const Json& a = json["accessors"][accessor];
    const std::map<std::string, int> columns = {{"SCALAR", 1}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};
    Table out = Table::Zero(a["count"].get<int>(), columns.at(a["type"]));
    if (!a.contains("bufferView")) return out;
    const Json& view = json["bufferViews"][a["bufferView"].get<std::size_t>()];
    const std::size_t offset = view["byteOffset"].get<std::size_t>() + a["byteOffset"].get<std::size_t>();
    const int type = a["componentType"];
    const std::size_t size = type == 5121 ? 1 : type == 5122 || type == 5123 ? 2 : 4;
    const std::size_t stride = view.value("byteStride", size * static_cast<std::size_t>(out.cols()));
    EXPECT_EQ(offset % 4, 0u);
    EXPECT_EQ(stride % size, 0u);
    const auto rows = static_cast<std::size_t>(out.rows()), last = (rows - 1) * stride;
    EXPECT_LE(a["byteOffset"].get<std::size_t>() + last + size * static_cast<std::size_t>(out.cols()),
              view["byteLength"].get<std::size_t>());
    EXPECT_LE(view["byteOffset"].get<std::size_t>() + view["byteLength"].get<std::size_t>(), data_.size());
    for (std::size_t r = 0; r < rows; ++r)
      for (int c = 0; c < out.cols(); ++c)
        out(static_cast<int>(r), c) = number(offset + r * stride + static_cast<std::size_t>(c) * size, type,
                                             a.value("normalized", false));
    return out;
  }

  std::size_t named(const std::string& name) const { return named_.at(name); }
  const std::map<std::pair<std::size_t, std::string>, Channel>& channels() const { return channels_; }
  const Channel* channel(std::size_t node, const std::string& path) const {
    const auto at = channels_.find({node, path});
    return at == channels_.end() ? nullptr : &at->second;
  }

  /// In the scene's axes, z up: what the root turns is turned back.
  Eigen::Isometry3d world(std::size_t node, double time) const {
    Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
    for (; node != 0; node = parent_.at(node)) out = local(node, time) * out;
    return out;
  }
  /// Weights of morph targets.
  Eigen::VectorXd weights(std::size_t node, double time) const {
    const Channel* const keys = channel(node, "weights");
    if (!keys) return {};
    const auto targets = keys->values.rows() / keys->times.rows();
    Eigen::VectorXd out(targets);
    const auto [k, u] = between(keys->times, time);
    for (int i = 0; i < targets; ++i)
      out[i] = (1 - u) * keys->values(k * targets + i, 0) + u * keys->values((k + 1) * targets + i, 0);
    return out;
  }
  const Json& primitive(std::size_t node) const {
    return json["meshes"][json["nodes"][node]["mesh"].get<std::size_t>()]["primitives"][0];
  }
  /// Where the vertices of a skinned or rigid mesh are.
  Table vertices(std::size_t node, double time) const {
    const Json& attributes = primitive(node)["attributes"];
    const Table rest = values(attributes["POSITION"]);
    Table out(rest.rows(), 3);
    if (!json["nodes"][node].contains("skin")) {
      for (int v = 0; v < rest.rows(); ++v) out.row(v) = world(node, time) * Eigen::Vector3d(rest.row(v));
      return out;
    }
    const Json& skin = json["skins"][json["nodes"][node]["skin"].get<std::size_t>()];
    const Table inverse = values(skin["inverseBindMatrices"]), joints = values(attributes["JOINTS_0"]),
                weights = values(attributes["WEIGHTS_0"]);
    std::vector<Eigen::Affine3d> matrices;
    for (std::size_t j = 0; j < skin["joints"].size(); ++j) {
      const Eigen::Matrix4d bind = inverse.row(static_cast<int>(j)).reshaped(4, 4);
      matrices.emplace_back(world(skin["joints"][j], time).matrix() * bind);
    }
    for (int v = 0; v < rest.rows(); ++v) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (int i = 0; i < 4; ++i)
        sum +=
            weights(v, i) * (matrices[static_cast<std::size_t>(joints(v, i))] * Eigen::Vector3d(rest.row(v)));
      out.row(v) = sum;
      EXPECT_NEAR(weights.row(v).sum(), 1, 1e-12);
    }
    return out;
  }

  Json json;

 private:
  std::size_t word(std::size_t at) const {
    std::uint32_t out = 0;
    std::memcpy(&out, bytes_.data() + at, sizeof out);
    return out;
  }
  template <typename Number>
  double as(std::size_t at) const {
    Number out;
    std::memcpy(&out, data_.data() + at, sizeof out);
    return static_cast<double>(out);
  }
  double number(std::size_t at, int type, bool normalized) const {
    if (type == 5121) return as<std::uint8_t>(at) / (normalized ? 255. : 1.);
    if (type == 5122) return as<std::int16_t>(at) / (normalized ? 32767. : 1.);
    if (type == 5123) return as<std::uint16_t>(at);
    return type == 5125 ? as<std::uint32_t>(at) : as<float>(at);
  }
  /// The key before `time`, and how far it lies on the way to the next.
  static std::pair<int, double> between(const Table& times, double time) {
    int k = 0;
    while (k + 2 < times.rows() && times(k + 1, 0) <= time) ++k;
    return {k, std::clamp((time - times(k, 0)) / (times(k + 1, 0) - times(k, 0)), 0., 1.)};
  }
  std::vector<double> property(std::size_t node, const char* path, double time) const {
    const Channel* const keys = channel(node, path);
    if (!keys) return json["nodes"][node].value(path, std::vector<double>());
    const auto [k, u] = between(keys->times, time);
    const Eigen::VectorXd a = keys->values.row(k), b = keys->values.row(k + 1);
    Eigen::VectorXd out = (1 - u) * a + u * b;
    if (a.size() == 4) out = Eigen::Quaterniond(a.data()).slerp(u, Eigen::Quaterniond(b.data())).coeffs();
    return {out.begin(), out.end()};
  }
  Eigen::Isometry3d local(std::size_t node, double time) const {
    Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
    if (const auto x = property(node, "translation", time); !x.empty())
      out.translate(Eigen::Vector3d(x.data()));
    if (const auto q = property(node, "rotation", time); !q.empty())
      out.rotate(Eigen::Quaterniond(q.data()).normalized());
    return out;
  }

  std::string bytes_, data_;
  std::map<std::size_t, std::size_t> parent_;
  std::map<std::string, std::size_t> named_;
  std::map<std::pair<std::size_t, std::string>, Channel> channels_;
};

const std::string k_falling_block = R"(topple = 1
[run]
duration = 0.5
want = ["motion"]
settle = false
[[shake]]
frequency = "2 Hz"
amplitude = "300 gal"
[floor]
[[block]]
name = "falls"
size = [0.3, 0.3, 0.6]
mass = 20
tilt = "25 deg"
[[block]]
name = "lies"
size = [0.6, 0.6, 0.1]
mass = 50
at = [2, 0, 0]
)";

class GltfTest : public ProgramTest {
 protected:
  /// Of a scene's file or name.
  static Gltf exported(const std::string& scene) {
    const Ended run = topple({"run", scene, "-o", "a.h5", "--force"});
    EXPECT_EQ(run.code, 0) << run.err;
    const Ended ended = topple({"export", "a.h5", "--gltf", "a.glb"});
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_EQ(ended.out + ended.err, "");
    return Gltf("a.glb");
  }
};

TEST_F(GltfTest, every_accessor_lies_in_the_file_with_finite_numbers_within_its_bounds) {
  write_bytes("s.toml", k_shaken);
  const Gltf gltf = exported("s.toml");
  EXPECT_EQ(gltf.json["asset"]["version"], "2.0");
  for (std::size_t a = 0; a < gltf.json["accessors"].size(); ++a) {
    const Table values = gltf.values(a);
    ASSERT_GT(values.rows(), 0);
    EXPECT_TRUE(values.allFinite()) << a;
    if (!gltf.json["accessors"][a].contains("min")) continue;
    for (int c = 0; c < values.cols(); ++c) {
      EXPECT_EQ(values.col(c).minCoeff(), gltf.json["accessors"][a]["min"][static_cast<std::size_t>(c)]);
      EXPECT_EQ(values.col(c).maxCoeff(), gltf.json["accessors"][a]["max"][static_cast<std::size_t>(c)]);
    }
  }
  for (const Json& mesh : gltf.json["meshes"])
    for (const Json& primitive : mesh["primitives"]) {
      const auto count = gltf.values(primitive["attributes"]["POSITION"]).rows();
      for (const Json& accessor : primitive["attributes"])
        EXPECT_EQ(gltf.values(accessor.get<std::size_t>()).rows(), count);
      for (const Json& target : primitive.value("targets", Json::array()))
        for (const Json& accessor : target) EXPECT_EQ(gltf.values(accessor.get<std::size_t>()).rows(), count);
      if (!primitive.contains("indices")) continue;
      EXPECT_LT(gltf.values(primitive["indices"]).maxCoeff(), static_cast<double>(count));
    }
}

TEST_F(GltfTest, keys_rise_from_the_first_to_the_last_instant) {
  write_bytes("s.toml", k_shaken);
  const Gltf gltf = exported("s.toml");
  ASSERT_FALSE(gltf.channels().empty());
  for (const auto& [target, keys] : gltf.channels()) {
    SCOPED_TRACE(gltf.json["nodes"][target.first]["name"].get<std::string>() + " " + target.second);
    EXPECT_EQ(keys.times(0, 0), 0);
    EXPECT_EQ(keys.times(keys.times.rows() - 1, 0), static_cast<double>(0.3f));
    for (int k = 1; k < keys.times.rows(); ++k) EXPECT_GT(keys.times(k, 0), keys.times(k - 1, 0));
  }
}

TEST_F(GltfTest, a_rigid_body_has_the_pose_of_the_row_at_each_key_and_little_else_between) {
  write_bytes("s.toml", k_falling_block);
  const Gltf gltf = exported("s.toml");
  const io::Recording recording("a.h5");
  std::map<float, io::FrameRow> rows;
  for (std::int64_t i = 0; i < recording.frame_count(); ++i) {
    const io::FrameRow row = recording.frame(i);
    rows[static_cast<float>(row.time)] = row;
  }
  const std::size_t falls = gltf.named("falls");
  for (const char* path : {"translation", "rotation"}) {
    const Gltf::Channel* const keys = gltf.channel(falls, path);
    ASSERT_NE(keys, nullptr);
    EXPECT_GT(keys->times.rows(), 5);
    for (int k = 0; k < keys->times.rows(); ++k) {
      const io::FrameRow& row = rows.at(static_cast<float>(keys->times(k, 0)));
      const Eigen::Isometry3d pose = gltf.world(falls, row.time);
      const Vec3 place = row.body[0].centre() + floor_shift(row);
      const double off = *path == 't' ? (pose.translation() - place).norm()
                                      : Quat(pose.rotation()).angularDistance(row.body[0].rotation());
      EXPECT_LT(off, k_rounding) << path << " at " << row.time;
    }
  }
  double shift = 0, turn = 0;
  for (const auto& [time, row] : rows) {
    const Eigen::Isometry3d pose = gltf.world(falls, time), floor = gltf.world(gltf.named("floor"), time);
    EXPECT_LT((pose.translation() - row.body[0].centre() - floor_shift(row)).norm(), k_between) << time;
    EXPECT_LT((floor.translation() - floor_shift(row)).norm(), k_between) << time;
    shift = std::max(shift, floor.translation().norm());
    turn = std::max(turn, Quat(pose.rotation()).angularDistance(Quat::Identity()));
  }
  EXPECT_GT(shift, 0.005);
  EXPECT_GT(turn, 0.4);
  EXPECT_FALSE(gltf.json.contains("skins"));
}

TEST_F(GltfTest, a_pose_that_is_held_takes_no_room) {
  write_bytes("s.toml", k_falling_block);
  ASSERT_EQ(topple({"run", "s.toml", "--set", "shake.1.amplitude=0", "-o", "a.h5"}).code, 0);
  ASSERT_EQ(topple({"export", "a.h5", "--gltf", "a.glb"}).code, 0);
  const Gltf gltf("a.glb");
  for (const auto& [name, path] :
       {std::pair{"floor", "translation"}, {"lies", "translation"}, {"lies", "rotation"}}) {
    const Gltf::Channel* const keys = gltf.channel(gltf.named(name), path);
    ASSERT_NE(keys, nullptr) << name;
    EXPECT_EQ(keys->times.rows(), 2) << name << " " << path;
  }
}

// The free end of a cantilever that swings by 25 mm: the vertices of its end's cap are about its last node.
TEST_F(GltfTest, the_end_of_a_bent_member_is_where_its_node_is) {
  const Gltf gltf = exported("cantilever");
  const io::Recording recording("a.h5");
  const Model model = io::recorded_scene(recording).setup.model;
  const std::size_t member = gltf.named("beam/" + model.members[0].name);
  const int tip = model.elements.back().node[1];
  const Table rest = gltf.values(gltf.primitive(member)["attributes"]["POSITION"]);
  const double end = rest.col(0).maxCoeff();
  double lowest = 0;
  for (std::int64_t i = 0; i < recording.frame_count(); i += 7) {
    const io::FrameRow row = recording.frame(i);
    const Table now = gltf.vertices(member, row.time);
    Eigen::RowVector3d low = Eigen::RowVector3d::Constant(1e9), high = -low;
    for (int v = 0; v < now.rows(); ++v)
      if (rest(v, 0) > end - 1e-6) low = low.cwiseMin(now.row(v)), high = high.cwiseMax(now.row(v));
    const Vec3 node = position(row, tip) + floor_shift(row);
    EXPECT_LT(((low + high) / 2 - node.transpose()).norm(), k_between) << row.time;
    EXPECT_NEAR((high - low).y(), 0.03, k_between);  // its section
    lowest = std::min(lowest, node.z());
  }
  EXPECT_LT(lowest, -0.015);
}

TEST_F(GltfTest, the_most_stressed_place_has_its_colour_on_the_scale_of_pictures) {
  write_bytes("s.toml", k_shaken);
  const Gltf gltf = exported("s.toml");
  const io::Recording recording("a.h5");
  const io::Scene scene = io::recorded_scene(recording);
  const Model& model = scene.setup.model;
  const double top = extent_of(Replay(recording), scene).top(BeamQuantity::stress);
  EXPECT_EQ(gltf.json["extras"]["unit"], "MPa");
  EXPECT_EQ(gltf.json["extras"]["minimum"], 0);
  EXPECT_NEAR(gltf.json["extras"]["maximum"].get<double>(), top / 1e6, 1e-6 * top / 1e6);
  for (std::int64_t i = 3; i < recording.frame_count(); i += 9) {
    const io::FrameRow row = recording.frame(i);
    std::size_t most = 0;
    double stress = 0;
    for (std::size_t e = 0; e < model.elements.size(); ++e) {
      if (static_cast<int>(e) !=
          model.members[static_cast<std::size_t>(model.elements[e].member)].first_element)
        continue;
      const double there = traits(BeamQuantity::stress).value(model, e, forces_at(model, row, e, -1));
      if (there > stress) most = e, stress = there;
    }
    const Member& member = model.members[static_cast<std::size_t>(model.elements[most].member)];
    const std::size_t node = gltf.named("free/" + member.name);
    const Table rest = gltf.values(gltf.primitive(node)["attributes"]["POSITION"]);
    const Vec3 first = model.node_position[static_cast<std::size_t>(model.elements[most].node[0])] -
                       model.bodies[0].centre_of_gravity;
    int nearest = 0;
    const Vec3 along = model.elements[most].triad.col(0);
    for (int v = 1; v < rest.rows(); ++v)
      if (along.dot(rest.row(v).transpose() - first) < along.dot(rest.row(nearest).transpose() - first))
        nearest = v;
    Eigen::Vector4d colour = gltf.values(gltf.primitive(node)["attributes"]["COLOR_0"]).row(nearest);
    const Eigen::VectorXd weights = gltf.weights(node, row.time);
    for (int k = 0; k < weights.size(); ++k)
      colour +=
          weights[k] *
          gltf.values(gltf.primitive(node)["targets"][static_cast<std::size_t>(k)]["COLOR_0"]).row(nearest);
    const double at = std::sqrt(std::min(stress / top, 1.));
    const auto& coded =
        render::colour_table(render::ColourMap::viridis)[static_cast<std::size_t>(std::lround(255 * at))];
    for (int c = 0; c < 3; ++c) {
      const double x = coded[static_cast<std::size_t>(c)] / 255.;
      const double linear = x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
      // 1/500 between keys, half of 1/255 of the stored colour, and a neighbour on the map of 256 colours
      EXPECT_NEAR(colour[c], linear, 0.002 + 0.002 + 0.012) << row.time << " s, " << member.name << ", " << c;
    }
  }
}

// Each half of an element that breaks follows one node, so that no face is drawn out between the pieces.
TEST_F(GltfTest, what_broke_is_in_pieces) {
  const Gltf gltf = exported("breaking");
  const double end = 2.5;
  double apart = 0;
  for (std::size_t n = 0; n < gltf.json["nodes"].size(); ++n) {
    const Json& node = gltf.json["nodes"][n];
    const std::string name = node["name"];
    if (!node.contains("mesh") || !node.contains("skin") || name.ends_with("/panels")) continue;
    const Table rest = gltf.values(gltf.primitive(n)["attributes"]["POSITION"]), now = gltf.vertices(n, end);
    const Table corners = gltf.values(gltf.primitive(n)["indices"]);
    double length = 0;
    for (int i = 0; i < corners.rows(); ++i) {
      const int a = static_cast<int>(corners(i, 0)),
                b = static_cast<int>(corners(i - i % 3 + (i + 1) % 3, 0));
      EXPECT_LT((now.row(a) - now.row(b)).norm(), 1.2 * (rest.row(a) - rest.row(b)).norm() + 5e-3) << name;
    }
    length = (rest.colwise().maxCoeff() - rest.colwise().minCoeff()).norm();
    apart = std::max(apart, (now.colwise().maxCoeff() - now.colwise().minCoeff()).norm() - length);
  }
  EXPECT_GT(apart, 0.1);
}

TEST_F(GltfTest, anchors_are_left_out) {
  ASSERT_EQ(topple({"run", "anchored", "--set", "run.duration=0.05", "-o", "a.h5"}).code, 0);
  ASSERT_EQ(topple({"export", "a.h5", "--gltf", "a.glb"}).code, 0);
  const Gltf gltf("a.glb");
  const Model model = io::recorded_scene(io::Recording("a.h5")).setup.model;
  ASSERT_FALSE(model.anchors.empty());
  std::size_t meshes = model.planes.size() + 1;  // and the panels
  for (const Member& member : model.members) meshes += !member.name.empty();
  EXPECT_EQ(gltf.json["meshes"].size(), meshes);
}

TEST_F(GltfTest, files_are_the_same_every_time_and_replace_only_their_kind) {
  write_bytes("s.toml", k_falling_block);
  exported("s.toml");
  const std::string before = bytes_of("a.glb");
  ASSERT_EQ(topple({"export", "a.h5", "--gltf", "a.glb"}).code, 0);
  EXPECT_EQ(bytes_of("a.glb"), before);
  write_bytes("b.glb", "notes of mine\n");
  expect_one_line({"export", "a.h5", "--gltf", "b.glb"}, 2,
                  "b.glb: holds text and is not replaced by a glTF file");
  EXPECT_EQ(bytes_of("b.glb"), "notes of mine\n");
  ASSERT_EQ(topple({"export", "a.h5", "--gltf", "b.glb", "--force"}).code, 0);
  EXPECT_EQ(bytes_of("b.glb"), before);
}

TEST_F(GltfTest, what_cannot_be_is_refused_and_nothing_is_begun) {
  write_bytes("s.toml", k_falling_block);
  exported("s.toml");
  const std::vector<std::string> before = files();
  expect_one_line({"export", "s.toml", "--gltf", "b.glb"}, 2, "s.toml");
  expect_one_line({"export", "a.h5", "--gltf", "a.h5"}, 2, "a.h5 is what is being read");
  expect_one_line({"export", "a.h5", "--gltf", "none/a.glb"}, 2, "there is no folder");
  expect_one_line({"export", "a.h5", "--gltf", "b.png"}, 2, ".glb");
  expect_one_line({"export", "a.h5", "--gltf", "b.glb"}, 1, "b.glb: cannot be written: File too large",
                  {.most_bytes = 1000});
  EXPECT_EQ(files(), before);
}

TEST_F(GltfTest, an_export_that_is_given_up_leaves_nothing) {
  write_bytes("s.toml", k_falling_block);
  exported("s.toml");
  const std::vector<std::string> before = files();
  const io::Recording recording("a.h5");
  for (int most : {0, 10, 60}) {  // 51 rows, each read twice
    int asked = 0;
    EXPECT_FALSE(export_gltf(recording, "b.glb", [&] { return asked++ < most; }));
    EXPECT_EQ(asked, most + 1);
    EXPECT_EQ(files(), before);
  }
}

}  // namespace
}  // namespace topple::app
