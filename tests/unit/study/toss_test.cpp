// Tossed cubes: readers, errors by hand, and what is computed given back.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "solver/io/common/errors.h"
#include "solver/study/validate/toss_study.h"

namespace topple::study {
namespace {

namespace fs = std::filesystem;

const std::string k_head =
    "toss,time_s,x_m,y_m,z_m,qw,qx,qy,qz,vx_m_s,vy_m_s,vz_m_s,wx_rad_s,wy_rad_s,wz_rad_s\n";

class TossFolder : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "topple-toss-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }
  void write(const std::string& text) const {
    std::ofstream(folder_ / "tosses.csv", std::ios::binary) << text;
  }
  void expect_refused(const std::string& part) const {
    try {
      read_tosses(folder_);
      ADD_FAILURE() << "read: " << part;
    } catch (const io::InputError& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  }
  /// Rows of a cube that goes on, unturned, as the first row of toss 1 has it (DAIRLab/contact-nets,
  /// BSD-3-Clause).
  static std::string toss(int number, int rows) {
    std::string text;
    for (int n = 0; n < rows; ++n) {
      const double t = n * 0.00676;
      text += std::to_string(number) + "," + std::to_string(t) + "," + std::to_string(0.19211 - 0.81867 * t) +
              "," + std::to_string(0.21764 - 0.73155 * t) + "," + std::to_string(0.14638 - 0.14183 * t) +
              ",0.90946,-0.14460,-0.31963,-0.22317,-0.81867,-0.73155,-0.14183,2.10431,0.40191,-2.37613\n";
    }
    return text;
  }
  fs::path folder_;
};

TEST_F(TossFolder, is_read_with_spins_turned_into_world_axes) {
  write(k_head + toss(1, 12) + toss(3, 11));
  const std::vector<Toss> tosses = read_tosses(folder_);
  ASSERT_EQ(tosses.size(), 2u);
  EXPECT_EQ(tosses[1].number, 3);
  EXPECT_EQ(tosses[0].rows.size(), 12u);
  EXPECT_EQ(tosses[0].velocity, Vec3(-0.81867, -0.73155, -0.14183));
  const Vec3 body(2.10431, 0.40191, -2.37613);
  EXPECT_NEAR(tosses[0].angular_velocity.norm(), body.norm(), 1e-12);
  EXPECT_NEAR((tosses[0].rows[0].rotation.conjugate() * tosses[0].angular_velocity - body).norm(), 0, 1e-12);
}

TEST_F(TossFolder, what_is_not_of_the_form_is_named_with_its_line) {
  write(k_head + toss(1, 12) + toss(3, 12) + toss(1, 12));
  expect_refused("tosses.csv:26: toss: 1 began in line 2 already");
  std::string text = k_head + toss(1, 12);
  text.replace(text.find("0.027040"), 8, "0.013520");
  write(text);
  expect_refused("tosses.csv:6: time_s: ");
  text = k_head + toss(1, 12);
  text.replace(text.find("0.90946"), 7, "0.50000");
  write(text);
  expect_refused("tosses.csv:2: qw: the quaternion has the length ");
  text = k_head + toss(1, 12);
  text.replace(text.find(",-0.81867"), 9, ",-81.867");
  write(text);
  expect_refused("tosses.csv:2: vx_m_s: the next rows move by 81");
  text = k_head + toss(1, 12);
  text.replace(text.find(",2.10431"), 8, ",120.568");
  write(text);
  expect_refused("tosses.csv:2: wx_rad_s: the next rows turn by 12");
  text = k_head + toss(1, 12);
  text.replace(text.find(",2.10431"), 8, ",nan");
  write(text);
  expect_refused("tosses.csv:2: wx_rad_s: \"nan\" is no finite number");
  write(k_head + toss(1, 5));
  expect_refused("has 5 rows");
  write("toss,time_ms\n1,2\n");
  expect_refused("tosses.csv:1: there is no column time_s");
  fs::remove(folder_ / "tosses.csv");
  expect_refused("is an empty folder");
}

/// A cube that stands, moved along x by `travel` and turned about z by `turn`.
Toss slid(double travel, double turn) {
  Toss toss;
  for (int n = 0; n <= 100; ++n) {
    const double part = std::min(1., n / 50.);
    toss.rows.push_back({n * 0.01, Vec3(travel * part, 0, TossedCube::half_edge),
                         Quat(Eigen::AngleAxisd(turn * part, Vec3::UnitZ()))});
  }
  return toss;
}

// 0.5 m against 0.4 m, 0.3 rad against 0.1 rad, both evenly over 0.5 s of 1 s: means over time are 3/4 of the
// last errors (to one row in a hundred); rest begins 2 mm, or 2 deg, before the end of the motion.
TEST(Toss, errors_are_those_counted_by_hand) {
  const Toss measured = slid(0.4, 0.1);
  const TossErrors e = errors_of(measured, slid(0.5, 0.3).rows);
  EXPECT_NEAR(e.place, 0.1, 1e-12);
  EXPECT_NEAR(e.place_share, 0.25, 1e-12);
  EXPECT_TRUE(e.face);
  EXPECT_NEAR(e.yaw, 0.2, 1e-12);
  EXPECT_NEAR(e.position, 0.075, 0.001);
  EXPECT_NEAR(e.angle, 0.15, 0.002);
  EXPECT_NEAR(e.rest, 0, 1e-12);
  EXPECT_NEAR(time_to_rest(measured.rows), 0.5, 0.011);
  EXPECT_NEAR(e.position_at[1], 0.04, 1e-12);  // at 0.2 s: two fifths of the way
}

TEST(Toss, the_face_that_is_up_is_told_by_the_body_axis_that_is) {
  EXPECT_EQ(face_up(Quat::Identity()), 4);
  EXPECT_EQ(face_up(Quat(Eigen::AngleAxisd(k_pi, Vec3::UnitX()))), 5);
  EXPECT_EQ(face_up(Quat(Eigen::AngleAxisd(k_pi / 2, Vec3::UnitX()))), 2);  // +y goes up
  EXPECT_EQ(face_up(Quat(Eigen::AngleAxisd(1.2, Vec3::UnitZ()))), 4);
}

// A cube that slides without turning goes v^2/(2 mu g) far: 0.5 m/s and 0.18 are 70.8 mm. It falls 0.2 mm to
// the floor first and is softly held, which is a few per cent.
TEST(Toss, a_sliding_cube_goes_as_far_as_friction_lets_it) {
  Toss toss = slid(0, 0);
  for (CubePose& row : toss.rows) row.place.z() += 2e-5;
  toss.velocity = Vec3(0.5, 0, 0);
  const std::vector<CubePose> rows = computed_toss(toss, {0.18, 0}, 0, [] { return false; });
  ASSERT_EQ(rows.size(), toss.rows.size());
  EXPECT_NEAR(rows.back().place.x(), 0.25 / (2 * 0.18 * 9.80665), 0.03 * 0.0708);
  EXPECT_EQ(face_up(rows.back().rotation), 4);
}

// The data's offset moves the board and nothing else: the same toss, shifted, ends as far along.
TEST(Toss, an_offset_shifts_the_board) {
  Toss toss = slid(0, 0);
  toss.rows.front().place.z() += 0.05;
  toss.velocity = Vec3(0.3, 0.1, 0), toss.angular_velocity = Vec3(1, 4, 2);
  const auto at_zero = computed_toss(toss, k_published, 0, [] { return false; });
  toss.rows.front().place.z() -= 0.0012;
  const auto shifted = computed_toss(toss, k_published, -0.0012, [] { return false; });
  ASSERT_EQ(at_zero.size(), shifted.size());
  EXPECT_NEAR((at_zero.back().place - shifted.back().place - Vec3(0, 0, 0.0012)).norm(), 0, 1e-9);
}

// What was computed with a setting of the grid is fitted best by it.
TEST(Toss, a_known_friction_and_restitution_come_back) {
  std::vector<Toss> tosses;
  for (int n = 0; n < 4; ++n) {
    Toss toss = slid(0, 0);
    toss.number = n;
    toss.rows.front().place.z() = 0.12;
    toss.rows.front().rotation = Quat(Eigen::AngleAxisd(0.4 + 0.3 * n, Vec3(1, n, 0.5).normalized()));
    toss.velocity = Vec3(0.6 + 0.1 * n, 0.2, -0.3), toss.angular_velocity = Vec3(n, 2, -1);
    toss.rows = computed_toss(toss, {0.16, 0.2}, 0, [] { return false; });
    ASSERT_FALSE(toss.rows.empty());
    tosses.push_back(std::move(toss));
  }
  std::vector<TossOutcomes> grid;
  for (const CubeContact& one : contact_grid())
    grid.push_back(outcomes_in(run_toss_case(tosses, one, 0, [] { return false; })));
  const TossFit fit = fit_tosses(grid, 0);
  EXPECT_EQ(fit.contact.friction, 0.16);
  EXPECT_EQ(fit.contact.restitution, 0.2);
  const TossScores scores = scored_tosses(grid[best_contact(grid, std::vector<double>(4, 1))]);
  EXPECT_EQ(scores.face_right, 4);
  EXPECT_NEAR(scores.place.ninetieth, 0, 1e-9);
}

// Changing what is held back changes neither the fit of its fold nor a score that it does not enter.
TEST(Toss, a_held_back_toss_changes_no_setting_of_its_fold) {
  std::vector<TossOutcomes> grid(contact_grid().size(), TossOutcomes(20));
  for (std::size_t k = 0; k < grid.size(); ++k)
    for (std::size_t i = 0; i < 20; ++i) {
      TossErrors e;
      e.position = 0.01 + 0.001 * static_cast<double>((7 * k + 3 * i) % 11);
      grid[k][i] = e;
    }
  const TossOutcomes before = cross_validated(grid);
  std::vector<TossOutcomes> changed = grid;
  for (TossOutcomes& one : changed) one[4]->position = 0.5 - one[4]->position;
  const TossOutcomes after = cross_validated(changed);
  EXPECT_EQ(before[14]->position, after[14]->position);  // of the same fold
  EXPECT_EQ(after[4]->position, 0.5 - before[4]->position);
}

// Of 1, 2, 3, 4: the median is 2.5, nine tenths of the way from 1 to 4 is 3.7.
TEST(Toss, quantiles_lie_between_neighbours) {
  const Quantiles q = quantiles_of({3, 1, 4, 2});
  EXPECT_EQ(q.median, 2.5);
  EXPECT_NEAR(q.ninetieth, 3.7, 1e-12);
}

}  // namespace
}  // namespace topple::study
