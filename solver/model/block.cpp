#include "solver/model/block.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "solver/model/body_builder.h"

namespace topple {
namespace {

// Stiffness that nothing uses: a block is rigid.
constexpr double k_young = 1e10, k_poisson = 0.2;  // Pa, -
constexpr double k_density = 1e3;                  // kg/m^3

void check(const BlockSpec& spec) {
  static constexpr const char* k_axes[] = {"x", "y", "z"};
  for (int k = 0; k < 3; ++k) {
    const double from = k == 2 ? 0 : -spec.size[k] / 2, to = from + spec.size[k];
    if (!(spec.cg[k] > from) || !(spec.cg[k] < to))
      throw BuildError("cg", std::string(k_axes[k]) + " = " + millimetres(spec.cg[k]) +
                                 " is not inside the block, which reaches from " + millimetres(from) +
                                 " to " + millimetres(to));
  }
  const Vec3 inertia = inertia_of(spec);
  if (!(inertia.minCoeff() > 0) || 2 * inertia.maxCoeff() > inertia.sum())
    throw BuildError(
        "inertia",
        "no mass distribution has this inertia: each value must be less than the other two together");
  if (const double least = spec.size.minCoeff(); spec.width > least)
    throw BuildError("width",
                     millimetres(spec.width) + " is more than the smallest side, " + millimetres(least));
}

class BlockBuilder {
 public:
  BlockBuilder(Model& model, const BlockSpec& spec, double width)
      : model_(model),
        spec_(spec),
        width_(width),
        builder_(model, spec.name),
        place_(place(spec, spec.size, width)) {}

  void build() {
    centre_ = builder_.node(place_(spec_.cg));
    add_edges();
    add_faces();
    for (const int node : points_) builder_.add_contact_point(node, width_);
    const Vec3 inertia = inertia_of(spec_);
    model_.node_mass[centre_] = spec_.mass;
    model_.node_inertia[centre_] = place_.rotation * inertia.asDiagonal() * place_.rotation.transpose();
    builder_.close();
    // to the last digit: the other nodes, without mass, must not seem to say how the body is turned
    builder_.body().centre_of_gravity = model_.node_position[centre_];
    builder_.body().solid = true;
  }

 private:
  // Counter-clockwise from above, at a share of the height.
  Vec3 corner(int i, double up) const {
    const int k = i % 4;
    return {(k == 0 || k == 3 ? -0.5 : 0.5) * spec_.size.x(), (k < 2 ? -0.5 : 0.5) * spec_.size.y(),
            up * spec_.size.z()};
  }

  void add_edges() {
    Material material;
    material.name = spec_.name + ".block";
    material.young = k_young;
    material.poisson = k_poisson;
    material.density = k_density;
    model_.materials.push_back(material);
    Section section;
    section.name = spec_.name + ".edge";
    section.shape = Section::Shape::solid;
    section.size_y = section.size_z = width_;
    complete_section(section, k_poisson);
    model_.sections.push_back(section);
    const auto line = [&](const std::string& name, const Vec3& from, const Vec3& to) {
      const std::vector<int> nodes =
          builder_.line(name, place_(from), place_(to), 1, 2, static_cast<int>(model_.sections.size()) - 1,
                        static_cast<int>(model_.materials.size()) - 1, Vec3::Zero());
      middles_.push_back(nodes[1]);
      return nodes;
    };
    for (int i = 0; i < 4; ++i) {
      const std::vector<int> nodes = line("post-" + std::to_string(i + 1), corner(i, 0), corner(i, 1));
      bottom_[i] = nodes.front();
      top_[i] = nodes.back();
      points_.insert(points_.end(), {nodes.front(), nodes.back()});
    }
    static constexpr const char* k_side[4] = {"right", "front", "left", "back"};
    for (const double up : {0., 1.})
      for (int i = 0; i < 4; ++i)
        line(std::string(up == 0 ? "bottom-" : "top-") + k_side[i], corner(i, up), corner(i + 1, up));
  }

  void add_faces() {
    builder_.add_panel(bottom_);
    builder_.add_panel(top_);
    for (int i = 0; i < 4; ++i)
      builder_.add_panel({bottom_[i], bottom_[(i + 1) % 4], top_[(i + 1) % 4], top_[i]});
    if (spec_.base == BlockSpec::Base::corners) return;
    points_.insert(points_.end(), middles_.begin(), middles_.end());
    for (const double up : {0., 1.}) points_.push_back(builder_.node(place_({0, 0, up * spec_.size.z()})));
    for (int i = 0; i < 4; ++i)
      points_.push_back(builder_.node(place_((corner(i, 0.5) + corner(i + 1, 0.5)) / 2)));
  }

  Model& model_;
  const BlockSpec& spec_;
  const double width_;
  BodyBuilder builder_;
  Placing place_;
  int centre_ = -1;
  std::array<int, 4> bottom_{}, top_{};
  std::vector<int> points_, middles_;
};

}  // namespace

Vec3 inertia_of(const BlockSpec& spec) {
  if (spec.inertia) return *spec.inertia;
  const Vec3 square = spec.size.cwiseProduct(spec.size);
  return spec.mass / 12 * (Vec3::Constant(square.sum()) - square);
}

double contact_width_of(const Vec3& size) {
  return std::min(size.minCoeff() / 20, 0.02);
}

BodyStart add_block(Model& model, const BlockSpec& spec) {
  check(spec);
  BlockBuilder(model, spec, spec.width > 0 ? spec.width : contact_width_of(spec.size)).build();
  return start_of(spec, model, model.bodies.back());
}

}  // namespace topple
