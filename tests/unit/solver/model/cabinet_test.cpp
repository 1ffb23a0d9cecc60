#include "solver/model/cabinet.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <regex>
#include <tuple>

#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

struct Cabinet {
  Model model;
  BodyStart start;
  const Body& body() const { return model.bodies[0]; }
};

Cabinet built(const CabinetSpec& spec) {
  Cabinet c;
  c.model = steel_model();
  c.start = add_cabinet(c.model, spec);
  return c;
}

Mat3 inertia_of_nodes(const Model& model, const Vec3& about) {
  Mat3 sum = Mat3::Zero();
  for (int i = 0; i < model.node_total(); ++i) {
    const Vec3 r = model.node_position[i] - about;
    sum +=
        model.node_inertia[i] + model.node_mass[i] * (r.squaredNorm() * Mat3::Identity() - r * r.transpose());
  }
  return sum;
}

// Mass properties of a box of thin sheets or of a solid one, density 1 + c (z - h/2), by summing points.
struct Box {
  double mass = 0, height = 0;
  Vec3 inertia = Vec3::Zero();  // about the centre of gravity
};

template <class Visit>
void each_point(const CabinetSpec& spec, bool solid, Visit visit) {
  // two Gauss points per cell integrate the cubic moments exactly
  const int n = 4;
  const auto places = [&](double from, double length) {
    std::vector<double> x;
    for (int i = 0; i < n; ++i)
      for (double side : {-1., 1.}) x.push_back(from + length / n * (i + 0.5 + side / std::sqrt(12.)));
    return x;
  };
  const Vec3& s = spec.size;
  const auto xs = places(-s.x() / 2, s.x()), ys = places(-s.y() / 2, s.y()), zs = places(0, s.z());
  const double m = 2 * n;
  if (solid) {
    for (double x : xs)
      for (double y : ys)
        for (double z : zs) visit(Vec3(x, y, z), s.prod() / (m * m * m));
    return;
  }
  for (double side : {-0.5, 0.5}) {
    for (double y : ys)
      for (double z : zs) visit(Vec3(side * s.x(), y, z), s.y() * s.z() / (m * m));
    for (double x : xs)
      for (double z : zs) visit(Vec3(x, side * s.y(), z), s.x() * s.z() / (m * m));
    for (double x : xs)
      for (double y : ys) visit(Vec3(x, y, (side + 0.5) * s.z()), s.x() * s.y() / (m * m));
  }
}

Box integrate(const CabinetSpec& spec, bool solid) {
  // the gradient that moves the centre of gravity to cg_height
  double weight = 0, second = 0;
  const double middle = spec.size.z() / 2;
  each_point(spec, solid, [&](const Vec3& x, double w) {
    weight += w;
    second += w * (x.z() - middle) * (x.z() - middle);
  });
  const double gradient = (spec.cg_height - middle) * weight / second;
  Box box;
  const double scale = spec.mass / weight;
  each_point(spec, solid, [&](const Vec3& x, double w) {
    const double m = scale * w * (1 + gradient * (x.z() - middle));
    box.mass += m;
    box.height += m * x.z() / spec.mass;
    const Vec3 r = x - Vec3(0, 0, spec.cg_height);
    box.inertia +=
        m * Vec3(r.y() * r.y() + r.z() * r.z(), r.x() * r.x() + r.z() * r.z(), r.x() * r.x() + r.y() * r.y());
  });
  return box;
}

// Masses are fitted to 1e-10 of the moments' own size.
void expect_mass_properties(const Cabinet& c, double mass, double cg_height, const Vec3& inertia) {
  const Vec3 centre(0, 0, cg_height + 0.015);  // the bottom's centre lines lie half a post above the floor
  double sum = 0;
  Vec3 moment = Vec3::Zero();
  for (int i = 0; i < c.model.node_total(); ++i) {
    EXPECT_GT(c.model.node_mass[i], 0);
    sum += c.model.node_mass[i];
    moment += c.model.node_mass[i] * c.model.node_position[i];
  }
  EXPECT_NEAR(sum, mass, 1e-9 * mass);
  EXPECT_NEAR(c.body().mass, mass, 1e-9 * mass);
  EXPECT_LT((moment / sum - centre).norm(), 1e-9);
  EXPECT_LT((c.body().centre_of_gravity - centre).norm(), 1e-9);
  const Mat3 exact = inertia.asDiagonal();
  EXPECT_LT((inertia_of_nodes(c.model, centre) - exact).norm(), 1e-9 * exact.norm());
  EXPECT_LT((c.body().inertia - exact).norm(), 1e-9 * exact.norm());
}

TEST(Cabinet, panels_have_mass_centre_and_inertia_of_six_thin_sheets) {
  for (double cg : {0.8, 0.895, 1.05})
    for (int shelves : {0, 2})
      for (int divisions : {1, 2})
        for (auto bracing : {CabinetSpec::Bracing::panels, CabinetSpec::Bracing::none}) {
          SCOPED_TRACE(testing::Message() << "cg " << cg << ", shelves " << shelves << ", divisions "
                                          << divisions << ", bracing " << static_cast<int>(bracing));
          // bare edges alone lie too far out for sheets
          if (shelves == 0 && bracing == CabinetSpec::Bracing::none) continue;
          CabinetSpec spec;
          spec.cg_height = cg;
          spec.shelves = shelves;
          spec.divisions = divisions;
          spec.bracing = bracing;
          const Box box = integrate(spec, false);
          ASSERT_NEAR(box.mass, 40, 1e-10);
          ASSERT_NEAR(box.height, cg, 1e-12);
          expect_mass_properties(built(spec), 40, cg, box.inertia);
        }
}

// What is inside a full box weighs on the few nodes there; the others still weigh something.
TEST(Cabinet, nodes_of_a_solid_one_weigh_a_fifth_of_the_mean_where_that_is_possible) {
  CabinetSpec spec;
  spec.inertia = CabinetSpec::Inertia::solid;
  spec.shelves = 3;
  const Cabinet c = built(spec);
  const double mean = spec.mass / c.model.node_total();
  EXPECT_NEAR(std::ranges::min(c.model.node_mass), 0.2 * mean, 1e-6 * mean);
}

TEST(Cabinet, solid_with_shelves_has_the_inertia_of_a_full_box) {
  CabinetSpec spec;
  spec.inertia = CabinetSpec::Inertia::solid;
  spec.shelves = 3;
  for (double cg : {0.85, 0.895, 0.95}) {
    SCOPED_TRACE(cg);
    spec.cg_height = cg;
    expect_mass_properties(built(spec), 40, cg, integrate(spec, true).inertia);
  }
}

TEST(Cabinet, given_inertia_is_met) {
  CabinetSpec spec;
  spec.inertia = CabinetSpec::Inertia::given;
  spec.inertia_given = {13, 11, 4};
  expect_mass_properties(built(spec), 40, spec.cg_height, spec.inertia_given);
}

TEST(Cabinet, rotary_inertia_of_nodes_counts_in_the_tensor) {
  const Cabinet c = built(tall_cabinet());
  Mat3 own = Mat3::Zero();
  for (const Mat3& j : c.model.node_inertia) {
    EXPECT_GT(j.diagonal().minCoeff(), 0);
    own += j;
  }
  // so much that a tensor without it would be wrong
  EXPECT_GT(own.trace(), 1e-4 * c.body().inertia.trace());
}

// The range in a BuildError: "... allows LOW..HIGH m" or "... reach LOW..HIGH times that".
std::pair<double, double> range_in(const std::string& text) {
  std::smatch match;
  if (!std::regex_search(text, match, std::regex("([-0-9.e]+?)\\.\\.([-0-9.e]+)"))) return {0, 0};
  return {std::stod(match[1]), std::stod(match[2])};
}

testing::AssertionResult refuses(const CabinetSpec& spec, const std::string& key,
                                 std::string* what = nullptr) {
  try {
    built(spec);
  } catch (const BuildError& e) {
    if (what) *what = e.what();
    if (e.key == key) return testing::AssertionSuccess() << e.what();
    return testing::AssertionFailure() << "key " << e.key << ": " << e.what();
  }
  return testing::AssertionFailure() << "was built";
}

TEST(Cabinet, refuses_a_centre_of_gravity_outside_the_range_it_names) {
  for (auto inertia : {CabinetSpec::Inertia::panels, CabinetSpec::Inertia::solid}) {
    SCOPED_TRACE(static_cast<int>(inertia));
    CabinetSpec spec;
    spec.inertia = inertia;
    spec.shelves = inertia == CabinetSpec::Inertia::solid ? 3 : 0;
    spec.cg_height = 1.75;
    std::string what;
    ASSERT_TRUE(refuses(spec, "cg_height", &what));
    const auto [low, high] = range_in(what);
    // symmetric about the middle, and within what a density gradient reaches, zero at one end
    EXPECT_NEAR(low + high, spec.size.z(), 2e-3) << what;
    double weight = 0, second = 0;
    each_point(spec, inertia == CabinetSpec::Inertia::solid, [&](const Vec3& x, double w) {
      weight += w;
      second += w * std::pow(x.z() - spec.size.z() / 2, 2);
    });
    EXPECT_LT(high - spec.size.z() / 2, second / weight / (spec.size.z() / 2)) << what;
    EXPECT_GT(high, 1.05) << what;
    // it is found in steps of 1/200 of the half range, 2 mm, and printed with four digits
    spec.cg_height = high + 3e-3;
    EXPECT_TRUE(refuses(spec, "cg_height"));
    spec.cg_height = low - 3e-3;
    EXPECT_TRUE(refuses(spec, "cg_height"));
    for (double inside : {low + 1e-3, high - 1e-3}) {
      spec.cg_height = inside;
      EXPECT_NO_THROW(built(spec)) << inside << ": " << what;
    }
  }
}

TEST(Cabinet, refuses_an_inertia_outside_the_range_it_names) {
  CabinetSpec spec;
  spec.inertia = CabinetSpec::Inertia::given;
  const Vec3 middling = integrate(spec, false).inertia;
  for (double factor : {0.1, 5.}) {
    SCOPED_TRACE(factor);
    spec.inertia_given = factor * middling;
    std::string what;
    ASSERT_TRUE(refuses(spec, "inertia", &what));
    const auto [low, high] = range_in(what);
    ASSERT_LT(low, high) << what;
    const Vec3 asked = spec.inertia_given;
    // it is found in steps of 2 % and printed with four digits
    for (double inside : {low * 1.001, high * 0.999}) {
      spec.inertia_given = inside * asked;
      EXPECT_NO_THROW(built(spec)) << inside << ": " << what;
    }
    for (double outside : {low * 0.975, high * 1.025}) {
      spec.inertia_given = outside * asked;
      EXPECT_TRUE(refuses(spec, "inertia")) << outside << ": " << what;
    }
  }
}

TEST(Cabinet, refuses_an_inertia_that_no_body_has) {
  CabinetSpec spec;
  spec.inertia = CabinetSpec::Inertia::given;
  spec.inertia_given = {10, 3, 5};
  EXPECT_TRUE(refuses(spec, "inertia"));
  spec.inertia_given = {10, 0, 10};
  EXPECT_TRUE(refuses(spec, "inertia"));
}

struct Extent {
  Vec3 low, high;
};
Extent extent(const Model& model) {
  Extent e{Vec3::Constant(1e9), Vec3::Constant(-1e9)};
  for (const Vec3& x : model.node_position) {
    e.low = e.low.cwiseMin(x);
    e.high = e.high.cwiseMax(x);
  }
  return e;
}

TEST(Cabinet, poses_lie_on_the_face_they_name_with_the_footprint_at_its_place) {
  struct Case {
    CabinetSpec::Pose pose;
    Vec3 size;     // extent along world axes
    Vec3 top;      // where the cabinet's own z points
    Vec3 forward;  // where its front, +x, points
  };
  const Case cases[] = {{CabinetSpec::Pose::upright, {0.38, 0.88, 1.79}, {0, 0, 1}, {1, 0, 0}},
                        {CabinetSpec::Pose::on_back, {1.79, 0.88, 0.38}, {-1, 0, 0}, {0, 0, 1}},
                        {CabinetSpec::Pose::on_front, {1.79, 0.88, 0.38}, {1, 0, 0}, {0, 0, -1}},
                        {CabinetSpec::Pose::on_side, {0.38, 1.79, 0.88}, {0, -1, 0}, {1, 0, 0}}};
  for (const Case& c : cases)
    for (double yaw : {0., 0.7}) {
      SCOPED_TRACE(testing::Message() << "pose " << static_cast<int>(c.pose) << ", yaw " << yaw);
      CabinetSpec spec = tall_cabinet();
      spec.pose = c.pose;
      spec.at.x() = 2;
      spec.at.y() = -3;
      const Cabinet straight = built(spec);
      spec.yaw = yaw;
      const Cabinet turned = built(spec);
      const Extent e = extent(straight.model);
      EXPECT_LT((e.high - e.low - c.size).norm(), 1e-12);
      EXPECT_LT(((e.high + e.low) / 2 - Vec3(2, -3, c.size.z() / 2 + 0.015)).norm(), 1e-12);
      const Mat3 r = Eigen::AngleAxisd(yaw, Vec3::UnitZ()).toRotationMatrix();
      const Vec3 place(2, -3, 0);
      for (int i = 0; i < straight.model.node_total(); ++i)
        EXPECT_LT(
            (place + r * (straight.model.node_position[i] - place) - turned.model.node_position[i]).norm(),
            1e-12);
      const Vec3 middle(2, -3, c.size.z() / 2 + 0.015);
      const Vec3 offset = (1.05 - 0.895) * c.top;
      EXPECT_LT((straight.body().centre_of_gravity - middle - offset).norm(), 1e-9);
      // about the cabinet's own axes the inertia is that of the upright one
      const Vec3 own = integrate(spec, false).inertia;
      Mat3 axes;
      axes << c.forward, c.top.cross(c.forward), c.top;
      const Mat3 world = r * axes * own.asDiagonal() * axes.transpose() * r.transpose();
      EXPECT_LT((turned.body().inertia - world).norm(), 1e-9 * world.norm());
      // the front face carries the members named so
      for (const Member& m : straight.model.members)
        if (m.name == "top-front") {
          const Vec3 x = straight.model.node_position[straight.model.elements[m.first_element].node[1]];
          EXPECT_NEAR((x - middle).dot(c.forward), 0.19, 1e-12);
          EXPECT_NEAR((x - middle).dot(c.top), 0.895, 1e-12);
        }
    }
}

TEST(Cabinet, touches_at_8_corners_or_26_points_on_a_rectangular_base_whatever_its_shelves) {
  using Base = CabinetSpec::Base;
  for (const auto& [base, points, below] : {std::tuple(Base::corners, 8, 4u), {Base::edges, 26, 9u}})
    for (const int shelves : {0, 1, 4}) {
      CabinetSpec spec;
      spec.base = base;
      spec.shelves = shelves;
      const Cabinet c = built(spec);
      EXPECT_EQ(c.body().contact_point_count, points);
      EXPECT_EQ(c.body().base_points.size(), below);
      ASSERT_EQ(c.body().support_polygon.size(), 4u);
      EXPECT_LT((c.body().base_centre - Vec3(0, 0, 0.015)).norm(), 1e-12);
      for (const ContactPoint& p : c.model.contact_points) {
        // on the box's surface: corner, edge middle or face middle
        const Vec3 x = (c.model.node_position[p.node] - Vec3(0, 0, 0.91)).cwiseQuotient(spec.size / 2);
        for (int k = 0; k < 3; ++k) EXPECT_LT(std::abs(x[k] - std::round(x[k])), 0.26) << x.transpose();
        EXPECT_NEAR(x.cwiseAbs().maxCoeff(), 1, 1e-12);
        EXPECT_TRUE(base == Base::edges || x.cwiseAbs().minCoeff() > 1 - 1e-12) << x.transpose();
      }
    }
}

TEST(Cabinet, tilt_turns_about_the_bottom_edge_it_leans_on) {
  for (double tilt : {0.1, -0.1})
    for (double yaw : {0., 0.5})
      for (auto pose : {CabinetSpec::Pose::upright, CabinetSpec::Pose::on_back}) {
        SCOPED_TRACE(testing::Message()
                     << "tilt " << tilt << ", yaw " << yaw << ", pose " << static_cast<int>(pose));
        CabinetSpec spec = tall_cabinet();
        spec.tilt = tilt;
        spec.yaw = yaw;
        spec.pose = pose;
        spec.at.x() = 1;
        const Cabinet c = built(spec);
        const State state = start_state(c.model, {c.start});
        const Vec3 forward = Eigen::AngleAxisd(yaw, Vec3::UnitZ()) * Vec3::UnitX();
        double lowest = 1e9;
        int kept = 0;
        for (int i = 0; i < c.model.node_total(); ++i) {
          lowest = std::min(lowest, state.position[i].z());
          if ((state.position[i] - c.model.node_position[i]).norm() < 1e-12) {
            ++kept;
            EXPECT_NEAR(c.model.node_position[i].z(), 0.015, 1e-12);
            EXPECT_GT((c.model.node_position[i] - Vec3(1, 0, 0)).dot(forward) * tilt, 0);
          }
        }
        EXPECT_NEAR(lowest, 0.015, 1e-12);
        EXPECT_EQ(kept, 3);  // two corners and the middle of the edge
        const Vec3 up = state.rotation[0] * Vec3::UnitZ();
        EXPECT_NEAR(up.dot(forward), std::sin(tilt), 1e-14);
        EXPECT_NEAR(up.z(), std::cos(tilt), 1e-14);
      }
}

TEST(Cabinet, diagonals_have_the_shear_stiffness_of_the_sheets) {
  // a face's two diagonals of area A: 2 E A (a/d)^2/d per shear displacement of its upper edge = G t a/b
  const Cabinet c = built(tall_cabinet());
  int found = 0;
  for (const Member& m : c.model.members) {
    if (m.name != "brace-front-a") continue;
    ++found;
    const double a = 0.88, b = 1.79, d = std::hypot(a, b), area = c.model.sections[m.section].area;
    const double diagonals = 2 * 205e9 * area * a * a / (d * d * d);
    const double sheet = 205e9 / 2.6 * 0.6e-3 * a / b;
    EXPECT_NEAR(diagonals, sheet, 1e-12 * sheet);
  }
  EXPECT_EQ(found, 1);
}

TEST(Cabinet, diagonals_yield_as_a_section_of_their_area_with_the_posts_second_moments) {
  CabinetSpec spec = tall_cabinet();
  Model model = steel_model();
  model.materials[0].yield = 235e6;
  add_cabinet(model, spec);
  const Section& post = model.sections[spec.section];
  int found = 0;
  for (const Element& element : model.elements) {
    const Member& member = model.members[element.member];
    if (!member.name.starts_with("brace-")) continue;
    ++found;
    const Section& s = model.sections[member.section];
    EXPECT_NE(s.area, post.area);
    EXPECT_EQ(s.iy, post.iy);
    const auto shape = [](double modulus, double area, double second) {
      return modulus / std::sqrt(area * second);
    };
    const auto slenderness = [](double fibre, double area, double second) {
      return fibre / std::sqrt(second / area);
    };
    EXPECT_NEAR(shape(s.zy, s.area, s.iy), shape(post.zy, post.area, post.iy), 1e-14);
    EXPECT_NEAR(shape(s.zz, s.area, s.iz), shape(post.zz, post.area, post.iz), 1e-14);
    EXPECT_NEAR(shape(s.zt, s.area, s.j), shape(post.zt, post.area, post.j), 1e-14);
    EXPECT_NEAR(slenderness(s.fibre_z(), s.area, s.iy), slenderness(post.fibre_z(), post.area, post.iy),
                1e-14);
    // no fibre nearer than the radius of gyration, and a full section bears more than its first fibre
    EXPECT_GT(s.fibre_y(), std::sqrt(s.iz / s.area));
    EXPECT_GT(s.zz, s.iz / s.fibre_y());
    const double yield = 235e6;
    EXPECT_DOUBLE_EQ(element.capacity[0], yield * s.area);
    EXPECT_DOUBLE_EQ(element.capacity[1], yield * s.zt / std::sqrt(3.));
    EXPECT_DOUBLE_EQ(element.capacity[2], yield * s.zy);
    EXPECT_DOUBLE_EQ(element.capacity[3], yield * s.zz);
  }
  EXPECT_EQ(found, 24);  // two elements of two diagonals of six faces
}

TEST(Cabinet, yielding_diagonals_carry_a_known_multiple_of_the_yielding_sheets_shear) {
  CabinetSpec spec = tall_cabinet();
  Model model = steel_model();
  const double yield = model.materials[0].yield = 235e6, nu = model.materials[0].poisson;
  add_cabinet(model, spec);
  const double a = 0.88, b = 1.79, d = std::hypot(a, b);
  for (const Member& m : model.members) {
    if (m.name != "brace-front-a") continue;
    const double diagonals = 2 * model.elements[m.first_element].capacity[0] * a / d;
    const double sheet = yield / std::sqrt(3.) * spec.panel_thickness * a;
    EXPECT_NEAR(diagonals / sheet, std::sqrt(3.) / (2 * (1 + nu)) * (a / b + b / a), 1e-12);
  }
}

// A cabinet that leans to -x moves as the mirror image of one that leans to +x.
TEST(Cabinet, mirrored_starts_give_mirrored_motions) {
  for (auto kind : {ContactLawKind::coulomb, ContactLawKind::paper}) {
    SCOPED_TRACE(static_cast<int>(kind));
    const auto started = [&](double tilt) {
      CabinetSpec spec = tall_cabinet();
      spec.tilt = tilt;
      Cabinet c = built(spec);
      c.model.planes.push_back(ground());
      Parameters p;
      p.contact.kind = kind;
      return Simulation(c.model, {c.start}, p);
    };
    Simulation right = started(0.09), left = started(-0.09);
    std::vector<int> partner(right.model.node_total(), -1);
    for (int i = 0; i < right.model.node_total(); ++i)
      for (int j = 0; j < right.model.node_total(); ++j) {
        Vec3 x = right.model.node_position[i];
        x.x() = -x.x();
        if ((x - right.model.node_position[j]).norm() < 1e-9) partner[i] = j;
      }
    ASSERT_TRUE(right.advance(800));
    ASSERT_TRUE(left.advance(800));
    double furthest = 0;
    for (int i = 0; i < right.model.node_total(); ++i) {
      ASSERT_GE(partner[i], 0);
      Vec3 x = left.state.position[partner[i]];
      x.x() = -x.x();
      furthest = std::max(furthest, (x - right.state.position[i]).norm());
    }
    // 0.8 s hold one impact; rounding grows from 1e-15 with the contacts' stiffness and Newton's 1e-11
    EXPECT_LT(furthest, 1e-8);
    EXPECT_LT(right.state.position[0].x(), right.model.node_position[0].x() + 1);
  }
}

}  // namespace
}  // namespace topple::test
