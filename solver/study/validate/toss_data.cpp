#include "solver/study/validate/toss_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "solver/io/common/errors.h"
#include "solver/study/validate/data_table.h"

namespace topple::study {

namespace fs = std::filesystem;

namespace {

constexpr double k_unit = 1e-3;     // a quaternion's length from 1
constexpr double k_farthest = 10;   // m
constexpr double k_longest = 0.05;  // s, between rows
constexpr int k_last_number = 999999;
constexpr std::size_t k_fewest_rows = 10;
// A toss begins as its velocities say, over so many rows (the data: within 0.06 m/s and 0.9 rad/s).
constexpr std::size_t k_beginning = 3;
constexpr double k_other_velocity = 0.5, k_other_spin = 5;  // m/s, rad/s

enum Column : std::size_t {
  number,
  time,
  place,
  rotation = place + 3,
  velocity = rotation + 4,
  spin = velocity + 3
};

Vec3 vector_at(const DataTable& table, std::size_t row, std::size_t first) {
  return {table.at(row, first), table.at(row, first + 1), table.at(row, first + 2)};
}

CubePose pose_at(const DataTable& table, std::size_t row, double start) {
  CubePose pose;
  pose.time = table.at(row, time) - start;
  pose.place = vector_at(table, row, place);
  if (pose.place.cwiseAbs().maxCoeff() > k_farthest)
    table.fail(row, place, fmt::format("the place is farther than {:g} m; places are in m", k_farthest));
  pose.rotation = Quat(table.at(row, rotation), table.at(row, rotation + 1), table.at(row, rotation + 2),
                       table.at(row, rotation + 3));
  const double length = pose.rotation.norm();
  if (std::abs(length - 1) > k_unit)
    table.fail(row, rotation, fmt::format("the quaternion has the length {:.4g}, not 1", length));
  pose.rotation.normalize();
  return pose;
}

/// Fails where the first rows do not move as the velocities of the first say.
void expect_as_told(const DataTable& table, std::size_t first, const Toss& toss) {
  const CubePose &from = toss.rows.front(), &to = toss.rows[k_beginning];
  const Vec3 moved = (to.place - from.place) / to.time;
  if (const double off = (moved - toss.velocity).norm(); off > k_other_velocity)
    table.fail(first, velocity,
               fmt::format("the next rows move by {:.3g} m/s otherwise; is it in m/s?", off));
  const double turned = from.rotation.angularDistance(to.rotation) / to.time;
  if (const double off = std::abs(turned - toss.angular_velocity.norm()); off > k_other_spin)
    table.fail(first, spin,
               fmt::format("the next rows turn by {:.3g} rad/s otherwise; is it in rad/s?", off));
}

}  // namespace

std::vector<Toss> read_tosses(const fs::path& folder) {
  files_in(folder);
  const fs::path packed = folder / "tosses.csv.gz", plain = folder / "tosses.csv";
  const bool both = fs::is_regular_file(packed) && fs::is_regular_file(plain);
  if (both) throw io::InputError(folder.string() + ": has tosses.csv and tosses.csv.gz; which?");
  const fs::path file = fs::is_regular_file(packed) ? packed : plain;
  if (!fs::is_regular_file(file))
    throw io::InputError(folder.string() +
                         ": has no tosses.csv.gz; its form stands in assets/guide/validation.md");
  const DataTable table(unpacked(file), file.string(),
                        {"toss", "time_s", "x_m", "y_m", "z_m", "qw", "qx", "qy", "qz", "vx_m_s", "vy_m_s",
                         "vz_m_s", "wx_rad_s", "wy_rad_s", "wz_rad_s"});
  std::vector<Toss> tosses;
  std::map<int, int> lines;
  std::vector<std::size_t> first_rows;
  double start = 0;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const int toss = table.whole(row, number, 0, k_last_number);
    if (tosses.empty() || tosses.back().number != toss) {
      if (const auto [other, is_new] = lines.emplace(toss, table.line(row)); !is_new)
        table.fail(row, number, fmt::format("{} began in line {} already", toss, other->second));
      start = table.at(row, time);
      tosses.emplace_back();
      first_rows.push_back(row);
      tosses.back().number = toss;
      tosses.back().velocity = vector_at(table, row, velocity);
    } else if (const double step = table.at(row, time) - table.at(row - 1, time);
               !(step > 0 && step <= k_longest)) {
      table.fail(row, time,
                 fmt::format("{:g} does not come within {:g} s after {:g}", table.at(row, time), k_longest,
                             table.at(row - 1, time)));
    }
    Toss& into = tosses.back();
    into.rows.push_back(pose_at(table, row, start));
    if (into.rows.size() == 1) into.angular_velocity = into.rows[0].rotation * vector_at(table, row, spin);
  }
  for (std::size_t i = 0; i < tosses.size(); ++i) {
    const Toss& toss = tosses[i];
    if (toss.rows.size() < k_fewest_rows)
      throw io::InputError(fmt::format("{}:{}: toss {} has {} rows, {} at least", file.string(),
                                       lines[toss.number], toss.number, toss.rows.size(), k_fewest_rows));
    expect_as_told(table, first_rows[i], toss);
  }
  if (tosses.empty()) throw io::InputError(file.string() + ": has no toss");
  return tosses;
}

double offset_of(const std::vector<Toss>& tosses) {
  std::vector<double> heights;
  for (const Toss& toss : tosses) heights.push_back(toss.rows.back().place.z());
  const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
  std::ranges::nth_element(heights, middle);
  return *middle - TossedCube::half_edge;
}

}  // namespace topple::study
