#include "solver/study/validate/granite_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>

#include "solver/io/common/errors.h"
#include "solver/math/types.h"

namespace topple::study {

namespace fs = std::filesystem;

namespace {

constexpr std::array<RockTraits, k_rocks> k_rock_table{
    {{"SP1", "sp1_overturned", 0.294, 0.0526}, {"SP2", "sp2_overturned", 0.292, 0.0524}}};

constexpr const char* k_outcomes = "outcomes.csv";
constexpr int k_last_number = 99999;
constexpr double k_longest_step = 0.1;  // s
constexpr double k_uneven = 0.01;       // of a step
constexpr double k_peak_part = 0.01;    // of the peak, plus half its last digit
constexpr double k_peak_digit = 0.06;   // gal
constexpr double k_highest = 5000;      // gal

enum Column : std::size_t { number, velocity, peak, first_rock };

/// "test-017.csv.gz" is test 17.
std::optional<int> number_of(const std::string& name) {
  constexpr std::string_view k_begin = "test-";
  const auto point = name.find('.');
  if (!name.starts_with(k_begin) || point == std::string::npos) return std::nullopt;
  if (const std::string end = name.substr(point); end != ".csv" && end != ".csv.gz") return std::nullopt;
  int value = 0;
  const auto [end, error] = std::from_chars(name.data() + k_begin.size(), name.data() + point, value);
  return error == std::errc() && end == name.data() + point ? std::optional(value) : std::nullopt;
}

std::map<int, fs::path> motions_in(const fs::path& folder) {
  std::map<int, fs::path> motions;
  for (const fs::path& file : files_in(folder)) {
    const std::optional<int> test = number_of(file.filename().string());
    if (!test) continue;
    if (const auto [other, is_new] = motions.emplace(*test, file); !is_new)
      throw io::InputError(fmt::format("{}: test {} is there twice, see {}", file.string(), *test,
                                       other->second.filename().string()));
  }
  return motions;
}

std::shared_ptr<const Accelerogram> motion_in(const fs::path& file, double peak_gal) {
  const DataTable table(unpacked(file), file.string(), {"time_s", "ax_gal"});
  if (table.rows() < 2) throw io::InputError(file.string() + ": has fewer than two samples");
  table.expect_rising(0);
  AccelerogramComponent x;
  x.interval = (table.at(table.rows() - 1, 0) - table.at(0, 0)) / static_cast<double>(table.rows() - 1);
  if (x.interval > k_longest_step)
    table.fail(1, 0,
               fmt::format("steps of {:g} s are above {:g} s; times are in s", x.interval, k_longest_step));
  double greatest = 0;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const double due = table.at(0, 0) + static_cast<double>(row) * x.interval;
    if (std::abs(table.at(row, 0) - due) > k_uneven * x.interval + 5e-5)
      table.fail(row, 0, fmt::format("{:g} is not {:.6g}, times go in equal steps", table.at(row, 0), due));
    if (std::abs(table.at(row, 1)) > k_highest)
      table.fail(row, 1, fmt::format("{:g} gal is above {:g} gal", table.at(row, 1), k_highest));
    greatest = std::max(greatest, std::abs(table.at(row, 1)));
    x.samples.push_back(table.at(row, 1) * k_gal);
  }
  if (std::abs(greatest - peak_gal) > k_peak_part * peak_gal + k_peak_digit)
    throw io::InputError(fmt::format("{}: ax_gal: has a peak of {:g}, {} says {:g} gal; is it in gal?",
                                     file.string(), greatest, k_outcomes, peak_gal));
  return make_accelerogram({std::move(x)});
}

GraniteTest test_of(const DataTable& outcomes, std::size_t row) {
  GraniteTest test;
  test.number = outcomes.whole(row, number, 0, k_last_number);
  test.peak_velocity = outcomes.at(row, velocity);
  if (!(test.peak_velocity >= 0 && test.peak_velocity <= 10))
    outcomes.fail(row, velocity, fmt::format("{:g} is outside 0..10 m/s", test.peak_velocity));
  for (std::size_t rock = 0; rock < k_rocks; ++rock)
    test.fell[rock] = outcomes.whole(row, first_rock + rock, 0, 1) == 1;
  return test;
}

}  // namespace

const std::array<RockTraits, k_rocks>& rocks() {
  return k_rock_table;
}

GraniteData read_granite(const fs::path& folder, bool keep_going) {
  std::map<int, fs::path> motions = motions_in(folder);
  const fs::path place = folder / k_outcomes;
  if (!fs::is_regular_file(place))
    throw io::InputError(folder.string() +
                         ": has no outcomes.csv; its form stands in assets/guide/validation.md");
  std::vector<std::string_view> columns{"test", "sheet_pgv_m_s", "peak_gal"};
  for (const RockTraits& rock : rocks()) columns.emplace_back(rock.outcome);
  const DataTable outcomes(unpacked(place), place.string(), columns);
  GraniteData data;
  std::map<int, int> lines;
  const auto attempt = [&](const auto& part) {
    try {
      part();
    } catch (const io::InputError& error) {
      if (!keep_going) throw;
      data.skipped.emplace_back(error.what());
    }
  };
  for (std::size_t row = 0; row < outcomes.rows(); ++row) {
    GraniteTest test = test_of(outcomes, row);
    if (const auto [other, is_new] = lines.emplace(test.number, outcomes.line(row)); !is_new)
      outcomes.fail(row, number, fmt::format("{} is in line {} already", test.number, other->second));
    attempt([&] {
      const auto motion = motions.find(test.number);
      if (motion == motions.end())
        outcomes.fail(row, number, fmt::format("there is no test-{:03}.csv.gz", test.number));
      const fs::path file = motion->second;
      motions.erase(motion);
      test.motion = motion_in(file, outcomes.at(row, peak));
      data.tests.push_back(std::move(test));
    });
  }
  for (const auto& [test, file] : motions)
    attempt([&] {
      throw io::InputError(fmt::format("{}: test {} has no outcome in {}", file.string(), test, k_outcomes));
    });
  if (data.tests.empty()) throw io::InputError(folder.string() + ": has no test of this form");
  std::ranges::sort(data.tests, {}, &GraniteTest::number);
  return data;
}

}  // namespace topple::study
