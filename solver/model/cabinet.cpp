#include "solver/model/cabinet.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>

#include "solver/math/elementary.h"
#include "solver/model/body_builder.h"
#include "solver/model/mass_fit.h"

namespace topple {
namespace {

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", x);
  return text;
}

// Mass over the height as a density 1 + gradient (z - h/2)/(h/2), and second moments about the middle of the
// box.
struct Distribution {
  double gradient_per_metre;  ///< gradient over (cg_height - h/2)
  Vec3 second;                ///< m^2 per kg: mean of x^2, y^2, (z - h/2)^2
};

Distribution panels(const Vec3& size) {
  const double d = size.x(), w = size.y(), h = size.z();
  const double total = 2 * (d * w + d * h + w * h);
  const auto mean_square = [&](double along, double face_across, double other) {
    // the two faces normal to `along`, then the four that run along it
    return (2 * face_across * other * along * along / 4 +
            2 * along * (face_across + other) * along * along / 12) /
           total;
  };
  return {total / ((d + w) * h * h / 3 + d * w * h),
          {mean_square(d, w, h), mean_square(w, d, h), mean_square(h, d, w)}};
}

Distribution solid(const Vec3& size) {
  return {6 / size.z(), size.cwiseProduct(size) / 12};
}

// Farthest that positive densities move the centre of gravity off the middle of the box, m.
double density_reach(const CabinetSpec& spec) {
  if (spec.inertia == CabinetSpec::Inertia::given) return std::numeric_limits<double>::infinity();
  const bool thin = spec.inertia == CabinetSpec::Inertia::panels;
  return 1 / (thin ? panels(spec.size) : solid(spec.size)).gradient_per_metre;
}

// Inertia about the centre of gravity at `cg_height` of what inertia = panels | solid | given asks for.
Vec3 target_inertia(const CabinetSpec& spec, double cg_height) {
  if (spec.inertia == CabinetSpec::Inertia::given) return spec.inertia_given;
  const bool thin = spec.inertia == CabinetSpec::Inertia::panels;
  const Distribution shape = thin ? panels(spec.size) : solid(spec.size);
  const double offset = cg_height - spec.size.z() / 2;
  const double z2 = shape.second.z() - offset * offset;
  return spec.mass * Vec3(shape.second.y() + z2, shape.second.x() + z2, shape.second.x() + shape.second.y());
}

/// Rotational stiffness at the ends of a node's elements over the square of the highest translational
/// frequency: the rotary inertia with which turning does not lower the explicit limit.
std::vector<double> rotary_inertia(const Model& model, const Body& body, const std::vector<double>& nominal) {
  std::vector<double> translation(body.node_count, 0.), rotation(body.node_count, 0.);
  for (int e = body.first_element; e < body.first_element + body.element_count; ++e) {
    const Element& element = model.elements[e];
    for (int end : element.node) {
      translation[end - body.first_node] += element.normal_stiffness.maxCoeff() / element.length;
      rotation[end - body.first_node] += element.normal_stiffness.tail<2>().maxCoeff() * element.length / 4 +
                                         element.bending_stiffness.maxCoeff() / element.length;
    }
  }
  double highest = 0;
  for (int i = 0; i < body.node_count; ++i) highest = std::max(highest, translation[i] / nominal[i]);
  for (double& j : rotation) j /= highest;
  return rotation;
}

class CabinetBuilder {
 public:
  CabinetBuilder(Model& model, const CabinetSpec& spec)
      : model_(model),
        spec_(spec),
        builder_(model, spec.name),
        place_(place(spec, spec.size, model.sections[spec.section].width)) {}

  void build() {
    add_edges();
    if (spec_.bracing == CabinetSpec::Bracing::panels) add_bracing();
    for (const std::array<int, 4>& sheet : sheets_) builder_.add_panel(sheet);
    add_contact_points();
    distribute_mass();
    builder_.close();
  }

 private:
  Vec3 corner(int i, double z) const {
    const double sx = (i == 0 || i == 3) ? -1 : 1, sy = i < 2 ? -1 : 1;
    return {sx * spec_.size.x() / 2, sy * spec_.size.y() / 2, z};
  }

  std::vector<int> add_line(const std::string& name, const Vec3& from, const Vec3& to, int members,
                            int section, const Vec3& up) {
    return builder_.line(name, place_(from), place_(to), members, 2, section, spec_.material,
                         place_.rotation * up);
  }

  void add_edges() {
    const int n = spec_.divisions, levels = spec_.shelves + 2;
    static const char* const k_side[4] = {"right", "front", "left", "back"};
    for (int i = 0; i < 4; ++i) {
      const std::vector<int> nodes =
          add_line("post-" + std::to_string(i + 1), corner(i, 0), corner(i, spec_.size.z()), n * (levels - 1),
                   spec_.section, Vec3::UnitX());
      edge_middles_.push_back(nodes[nodes.size() / 2]);
      corners_.push_back(nodes.front());
      corners_.push_back(nodes.back());
    }
    for (int level = 0; level < levels; ++level) {
      const bool shelf = level > 0 && level < levels - 1;
      const double z = spec_.size.z() * level / (levels - 1);
      const std::string prefix = shelf ? "shelf-" + std::to_string(level) : level == 0 ? "bottom" : "top";
      for (int i = 0; i < 4; ++i) {
        const std::vector<int> nodes = add_line(prefix + "-" + k_side[i], corner(i, z),
                                                corner((i + 1) % 4, z), n, spec_.section, Vec3::UnitZ());
        if (!shelf) edge_middles_.push_back(nodes[nodes.size() / 2]);
      }
      if (shelf && spec_.bracing == CabinetSpec::Bracing::panels)
        add_cross(prefix + "-brace", {corner(0, z), corner(1, z), corner(2, z), corner(3, z)}, Vec3::UnitZ());
    }
  }

  // Bracing::panels.
  int brace_section(const std::string& name, double a, double b) {
    const Section& post = model_.sections[spec_.section];
    const Material& material = model_.materials[spec_.material];
    const double diagonal = elementary::hypot(a, b);
    Section brace = post;
    brace.name = spec_.name + "." + name;
    brace.shape = Section::Shape::custom;
    brace.area =
        spec_.panel_thickness * diagonal * diagonal * diagonal / (4 * (1 + material.poisson) * a * b);
    const double narrower = std::sqrt(post.area / brace.area);
    brace.size_y *= narrower;
    brace.size_z *= narrower;
    brace.zy /= narrower;
    brace.zz /= narrower;
    brace.zt /= narrower;
    brace.ky = post.ky * post.area / brace.area;
    brace.kz = post.kz * post.area / brace.area;
    model_.sections.push_back(brace);
    return static_cast<int>(model_.sections.size()) - 1;
  }

  void add_cross(const std::string& name, const std::array<Vec3, 4>& c, const Vec3& normal) {
    const int section = brace_section(name, (c[1] - c[0]).norm(), (c[3] - c[0]).norm());
    const std::vector<int> nodes = add_line(name + "-a", c[0], c[2], spec_.divisions, section, normal);
    add_line(name + "-b", c[1], c[3], spec_.divisions, section, normal);
    face_middle_ = nodes[nodes.size() / 2];
    sheets_.push_back({builder_.node(place_(c[0])), builder_.node(place_(c[1])), builder_.node(place_(c[2])),
                       builder_.node(place_(c[3]))});
  }

  void add_bracing() {
    const double h = spec_.size.z();
    static const char* const k_face[4] = {"right", "front", "left", "back"};
    constexpr int k_front = 1;
    for (int i = 0; i < 4; ++i) {
      const int j = (i + 1) % 4;
      if (i == k_front && spec_.front == CabinetSpec::Front::open) continue;
      const Vec3 normal = i % 2 == 0 ? Vec3::UnitY() : Vec3::UnitX();
      add_cross(std::string("brace-") + k_face[i], {corner(i, 0), corner(j, 0), corner(j, h), corner(i, h)},
                normal);
      face_middles_.push_back(face_middle_);
    }
    for (double z : {0., h}) {
      add_cross(z == 0 ? "brace-bottom" : "brace-top",
                {corner(0, z), corner(1, z), corner(2, z), corner(3, z)}, Vec3::UnitZ());
      face_middles_.push_back(face_middle_);
    }
  }

  void add_contact_points() {
    const double width = model_.sections[spec_.section].width;
    const auto add = [&](const std::vector<int>& nodes) {
      for (const int node : nodes) builder_.add_contact_point(node, width);
    };
    add(corners_);
    if (spec_.base == CabinetSpec::Base::corners) return;
    add(edge_middles_);
    add(face_middles_);
  }

  // Masses by symmetry class: nodes with the same |x|, |y| and z in the cabinet's own axes weigh the same.
  void distribute_mass() {
    const Body body = builder_.body();
    const bool within = std::abs(spec_.cg_height - spec_.size.z() / 2) < density_reach(spec_);
    const Vec3 inertia = target_inertia(spec_, spec_.cg_height);
    if (within && (!(inertia.minCoeff() > 0) || 2 * inertia.maxCoeff() > inertia.sum()))
      throw BuildError(
          "inertia",
          "no mass distribution has this inertia: each value must be less than the other two together");
    std::vector<double> nominal = nominal_masses(body);
    std::vector<double> rotary = rotary_inertia(model_, body, nominal);
    double rotary_sum = 0;
    for (double j : rotary) rotary_sum += j;

    std::map<std::array<long long, 3>, int> group_of;
    std::vector<int> group(body.node_count);
    std::vector<Vec3> local(body.node_count);
    for (int i = 0; i < body.node_count; ++i) {
      local[i] = place_.rotation.transpose() * (model_.node_position[body.first_node + i] - place_.offset);
      const auto cell = [](double x) { return std::llround(x / (2 * BodyBuilder::k_same_place)); };
      group[i] =
          group_of
              .try_emplace({cell(std::abs(local[i].x())), cell(std::abs(local[i].y())), cell(local[i].z())},
                           static_cast<int>(group_of.size()))
              .first->second;
    }
    const int groups = static_cast<int>(group_of.size());
    const auto problem_at = [&](double cg_height, double least_share) {
      MomentProblem problem;
      problem.moments = Eigen::MatrixXd::Zero(5, groups);
      problem.nominal = problem.count = Eigen::VectorXd::Zero(groups);
      for (int i = 0; i < body.node_count; ++i) {
        const Vec3 r = local[i] - Vec3(0, 0, cg_height), r2 = r.cwiseProduct(r);
        Eigen::Matrix<double, 5, 1> moments;
        moments << 1, r.z(), r2.y() + r2.z(), r2.x() + r2.z(), r2.x() + r2.y();
        problem.moments.col(group[i]) += moments;
        problem.nominal[group[i]] += nominal[i];
        problem.count[group[i]] += 1;
      }
      problem.nominal = problem.nominal.cwiseQuotient(problem.count);
      problem.least = Eigen::VectorXd::Constant(groups, least_share * spec_.mass / body.node_count);
      problem.target.resize(5);
      problem.target << spec_.mass, 0, target_inertia(spec_, cg_height) - Vec3::Constant(rotary_sum);
      return problem;
    };
    const auto fit = [&](double least_share) {
      return within ? fit_masses(problem_at(spec_.cg_height, least_share)) : std::nullopt;
    };
    std::optional<Eigen::VectorXd> masses = fit(k_least_share);
    const double least = k_least_share * spec_.mass / body.node_count;
    if (masses && masses->minCoeff() <= least)
      for (const double share : k_greater_shares)
        if (const auto heavier = fit(share)) {
          masses = heavier;
          break;
        }
    if (!masses) {
      refuse_height(problem_at);
      refuse_inertia(problem_at(spec_.cg_height, k_least_share), rotary_sum);
    }
    std::vector<double> mass(body.node_count);
    for (int i = 0; i < body.node_count; ++i) mass[i] = (*masses)[group[i]];
    if (spec_.cg_offset) shift(local, mass);
    for (int i = 0; i < body.node_count; ++i) {
      model_.node_mass[body.first_node + i] = mass[i];
      model_.node_inertia[body.first_node + i] = rotary[i] * Mat3::Identity();
    }
  }

  // CabinetSpec::cg_offset: factors 1 + a . (r - centre) keep the mass, and `a` keeps the height.
  void shift(const std::vector<Vec3>& at, std::vector<double>& mass) const {
    Vec3 centre = Vec3::Zero();
    for (std::size_t i = 0; i < at.size(); ++i) centre += mass[i] / spec_.mass * at[i];
    Mat3 second = Mat3::Zero();
    for (std::size_t i = 0; i < at.size(); ++i)
      second += mass[i] / spec_.mass * (at[i] - centre) * (at[i] - centre).transpose();
    const Vec3 wanted(spec_.cg_offset->x(), spec_.cg_offset->y(), centre.z());
    const Vec3 slope = second.ldlt().solve(wanted - centre);
    double lightest = 0;
    for (const Vec3& x : at) lightest = std::min(lightest, slope.dot(x - centre));
    if (1 + lightest < k_least_share)
      throw BuildError("cg_offset", millimetres(wanted.x()) + ", " + millimetres(wanted.y()) +
                                        " cannot be reached with positive densities, only " +
                                        number((k_least_share - 1) / lightest) + " of the way");
    for (std::size_t i = 0; i < at.size(); ++i) mass[i] *= 1 + slope.dot(at[i] - centre);
  }

  // Sheets on the diagonals where there are any, the rest on the edges.
  std::vector<double> nominal_masses(const Body& body) const {
    std::vector<double> mass(body.node_count, 0.);
    double sum = 0;
    for (int e = body.first_element; e < body.first_element + body.element_count; ++e) {
      const Element& element = model_.elements[e];
      const bool brace = model_.members[element.member].section != spec_.section;
      const double first = (e - model_.members[element.member].first_element) % 2 == 0 ? 1. / 3 : 2. / 3;
      const double line = (brace ? 2. : 1.) * element.length;
      mass[element.node[0] - body.first_node] += first * line;
      mass[element.node[1] - body.first_node] += (1 - first) * line;
      sum += line;
    }
    for (double& m : mass) m *= spec_.mass / sum;
    return mass;
  }

  // Says how far the members' densities can move the centre of gravity. Returns when nowhere will do.
  template <class ProblemAt>
  void refuse_height(const ProblemAt& problem_at) const {
    if (spec_.inertia == CabinetSpec::Inertia::given) return;
    constexpr int k_tries = 200;
    const double middle = spec_.size.z() / 2, reach = density_reach(spec_);
    double least = 1e300, most = -1e300;
    for (int k = 1 - k_tries; k < k_tries; ++k) {
      const double height = middle + reach * k / k_tries;
      if (!fit_masses(problem_at(height, k_least_share))) continue;
      least = std::min(least, height);
      most = std::max(most, height);
    }
    if (least > most) return;
    throw BuildError("cg_height", number(spec_.cg_height) +
                                      " m cannot be reached with positive densities; inertia = \"" +
                                      (spec_.inertia == CabinetSpec::Inertia::panels ? "panels" : "solid") +
                                      "\" allows " + number(least) + ".." + number(most) + " m" + advice());
  }

  // Says how far the inertia can be scaled, else gives up on the centre of gravity.
  [[noreturn]] void refuse_inertia(MomentProblem problem, double rotary_sum) const {
    const Vec3 inertia = target_inertia(spec_, spec_.cg_height);
    const auto fits = [&](double factor) {
      problem.target.tail<3>() = factor * inertia - Vec3::Constant(rotary_sum);
      return fit_masses(problem).has_value();
    };
    double least = 0, most = 0, factor = 1e-3;
    for (int i = 0; i < 698; ++i, factor *= 1.02)  // to 1e3
      if (fits(factor)) {
        if (least == 0) least = factor;
        most = factor;
      }
    const std::string asked =
        number(inertia.x()) + ", " + number(inertia.y()) + ", " + number(inertia.z()) + " kg m^2";
    if (least == 0)
      throw BuildError("cg_height", "no positive densities on the members give " + number(spec_.cg_height) +
                                        " m with the inertia " + asked + advice());
    throw BuildError("inertia", "the members cannot hold " + asked + " with positive densities; they reach " +
                                    number(least) + ".." + number(most) + " times that" +
                                    (advice().empty() ? " (shelves carry mass inside)" : advice()));
  }

  // A solid box has its mass inside, where members are few.
  std::string advice() const {
    return spec_.inertia == CabinetSpec::Inertia::solid ? "; add shelves, or use [[block]]" : "";
  }

  /// Least mass of a node over the mean. Nodes that would be lighter may as well be heavier than that: the
  /// lightest one sets the explicit step.
  static constexpr double k_least_share = 0.03;
  static constexpr double k_greater_shares[] = {0.2, 0.16, 0.12, 0.09, 0.06, 0.04};

  Model& model_;
  const CabinetSpec& spec_;
  BodyBuilder builder_;
  Placing place_;
  std::vector<int> corners_, edge_middles_, face_middles_;
  std::vector<std::array<int, 4>> sheets_;
  int face_middle_ = -1;
};

}  // namespace

Vec3 inertia_of(const CabinetSpec& spec) {
  return target_inertia(spec, spec.cg_height);
}

BodyStart add_cabinet(Model& model, const CabinetSpec& spec) {
  CabinetBuilder(model, spec).build();
  return start_of(spec, model, model.bodies.back());
}

}  // namespace topple
