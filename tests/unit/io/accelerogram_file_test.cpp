#include "solver/io/accelerogram/accelerogram_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "scene_samples.h"
#include "solver/io/scene/scene.h"
#include "solver/math/types.h"

namespace topple::io {
namespace {

using Format = AccelerogramFile::Format;

AccelerogramFile read(const std::string& text, const AccelerogramNotes& notes = {}) {
  return read_accelerogram(text, "a", notes);
}

std::string error(const std::string& text, const AccelerogramNotes& notes = {}) {
  try {
    read(text, notes);
  } catch (const InputError& problem) {
    return problem.what();
  }
  return "no error";
}

/// Two lines of text, one with the unit, and what follows.
std::string at2(const std::string& rest, const std::string& unit = "ACCELERATION TIME SERIES IN UNITS OF G") {
  return "PEER STRONG MOTION DATABASE RECORD\nSOMEWHERE, 1/1/00, STATION, 090\n" + unit + "\n" + rest;
}

/// The example of the format's description (method: K-NET), with eight samples of a hundred a second.
std::string knet() {
  return "Origin Time       2006/01/18 23:25:00\n"
         "Lat.              37.798\n"
         "Long.             142.200\n"
         "Depth. (km)       36\n"
         "Mag.              5.7\n"
         "Station Code      MYG002\n"
         "Station Lat.      38.7262\n"
         "Station Long.     141.5109\n"
         "Station Height(m) 79\n"
         "Record Time       2006/01/18 23:25:46\n"
         "Sampling Freq(Hz) 100Hz\n"
         "Duration Time(s)  .12\n"
         "Dir.              N-S\n"
         "Scale Factor      3920(gal)/6182761\n"
         "Max. Acc. (gal)   4.707\n"
         "Last Correction   2006/01/18 23:25:31\n"
         "Memo.\n"
         "    8009     9006     7998     8001     8009     8007     8002     8005\n"
         "    8006     8003   -3     8003\n";
}

TEST(AccelerogramFile, at2_headers_are_read_in_every_spelling) {
  for (const char* header : {"NPTS=    7, DT= .01000 SEC", "NPTS=7, DT=   .0100 SEC,", "npts= 7, dt= 0.01",
                             "NPTS =   7,  DT = 1.0E-2", "7    0.01000    NPTS, DT", "    7   .0100 NPTS, DT",
                             "NPTS=     7  DT=  0.0100 SEC,"}) {
    SCOPED_TRACE(header);
    const AccelerogramFile file =
        read(at2(header + std::string("\n  .1000000E-01 -.2500000E+00  .5E0 -0.125 +1.\n  .3  -.4E-2\n\n")));
    EXPECT_EQ(file.format, Format::at2);
    EXPECT_EQ(file.interval, 0.01);
    ASSERT_EQ(file.components.size(), 1u);
    const std::vector<double> in_g{0.01, -0.25, 0.5, -0.125, 1, 0.3, -0.004};
    ASSERT_EQ(file.components[0].size(), in_g.size());
    for (std::size_t i = 0; i < in_g.size(); ++i)
      EXPECT_DOUBLE_EQ(file.components[0][i], in_g[i] * k_standard_gravity);
  }
}

TEST(AccelerogramFile, at2_lines_may_end_as_on_other_systems_and_hold_any_number_of_samples) {
  std::string text = at2("NPTS= 3, DT= .02 SEC\n1 2\n3\n");
  const std::vector<double> expected = read(text).components[0];
  std::string other;
  for (const char c : text) other += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(read(other).components[0], expected);
  EXPECT_EQ(read(text.substr(0, text.size() - 1)).components[0], expected);
  EXPECT_EQ(read("\xef\xbb\xbf" + text).components[0], expected);
}

TEST(AccelerogramFile, at2_states_its_unit) {
  const auto first = [](const std::string& unit, const AccelerogramNotes& notes = {}) {
    return read(at2("NPTS= 2, DT= .02 SEC\n.5 .25\n", unit), notes).components[0][0];
  };
  EXPECT_DOUBLE_EQ(first("ACCELERATION TIME HISTORY IN UNITS OF G. FILTER POINTS: HP=0.2 Hz LP=25 Hz"),
                   0.5 * k_standard_gravity);
  EXPECT_DOUBLE_EQ(first("ACCELERATION TIME SERIES IN UNITS OF CM/SEC/SEC"), 0.005);
  EXPECT_DOUBLE_EQ(first("acceleration in units of m/s/s"), 0.5);
  EXPECT_DOUBLE_EQ(first("nothing", {.unit = "gal", .interval = {}}), 0.005);
  EXPECT_DOUBLE_EQ(first("UNITS OF GAL", {.unit = "cm/s^2", .interval = {}}), 0.005);
  const std::string data = "NPTS= 2, DT= .02 SEC\n1 2\n";
  EXPECT_EQ(error(at2(data, "nothing")),
            "a:3: unit: the file states none; give it in the scene, unit = \"gal\"");
  EXPECT_EQ(error(at2(data, "VELOCITY TIME SERIES IN UNITS OF CM/S")),
            "a:3: unit: \"CM/S\" is not one of an acceleration; known: g, gal, m/s^2, cm/s^2");
  EXPECT_EQ(error(at2(data), {.unit = "gal", .interval = {}}),
            "a:3: unit: the file states g, the scene gal; leave it out there");
}

TEST(AccelerogramFile, at2_that_does_not_hold_what_it_says_is_refused) {
  EXPECT_EQ(error(at2("NPTS= 4, DT= .01 SEC\n1 2 3\n")), "a:4: NPTS: says 4 samples, the file holds 3");
  EXPECT_EQ(error(at2("NPTS= 4, DT= .01 SEC\n1 2 3 4\n5\n")), "a:4: NPTS: says 4 samples, the file holds 5");
  EXPECT_EQ(error(at2("NPTS= 4, DT= .01 SEC\n1 2\n3 x4\n")), "a:6: \"x4\" is not a number");
  EXPECT_EQ(error(at2("NPTS= 4, DT= .01 SEC\n1 2\n3 NaN\n")), "a:6: \"NaN\" is not a finite number");
  EXPECT_EQ(error(at2("NPTS= 4, DT= .01 SEC\n1 2\n3 -inf\n")), "a:6: \"-inf\" is not a finite number");
  EXPECT_EQ(error(at2("NPTS= 4, DT= .01 SEC\n1 2\n3 1e999\n")), "a:6: \"1e999\" is not a finite number");
  EXPECT_EQ(error(at2("NPTS= 4, DT= .01 SEC\n1 2\n3 *******\n")), "a:6: \"*******\" is not a number");
  EXPECT_EQ(
      error(at2("NPTS= 4\n1 2 3 4\n")),
      "a:4: NPTS, DT: found \"NPTS= 4\", expected such as NPTS= 4000, DT= .01000 SEC or 4000 0.01 NPTS, DT");
  EXPECT_EQ(error(at2("NPTS= , DT= .01 SEC\n1 2 3 4\n")), "a:4: NPTS: \", DT= .01 SEC\" is not a number");
  EXPECT_EQ(error(at2("NPTS= 2.5, DT= .01 SEC\n1 2 3\n")),
            "a:4: NPTS: 2.5 samples; expected a whole number, 2 or more");
  EXPECT_EQ(error(at2("NPTS= -3, DT= .01 SEC\n1 2 3\n")),
            "a:4: NPTS: -3 samples; expected a whole number, 2 or more");
  EXPECT_EQ(error(at2("NPTS= 2, DT= 0 SEC\n1 2\n")), "a:4: DT: 0 s between samples are outside 1e-05..1 s");
  EXPECT_EQ(error(at2("NPTS= 2, DT= 10 SEC\n1 2\n")), "a:4: DT: 10 s between samples are outside 1e-05..1 s");
}

TEST(AccelerogramFile, absurd_sizes_are_refused_at_the_header) {
  EXPECT_EQ(error(at2("NPTS= 100000000, DT= .01 SEC\n1 2\n")),
            "a:4: NPTS: 100000000 samples are more than the 10000000 that are allowed");
  EXPECT_EQ(error(at2("NPTS= 1e300, DT= .01 SEC\n1 2\n")),
            "a:4: NPTS: 1e+300 samples are more than the 10000000 that are allowed");
  EXPECT_EQ(error(replaced(knet(), "  .12", "  9999999")),
            "a:12: Duration Time(s): 999999900 samples are more than the 10000000 that are allowed");
}

TEST(AccelerogramFile, peaks_that_no_floor_has_are_a_matter_of_the_unit) {
  EXPECT_EQ(error(at2("NPTS= 4, DT= .01 SEC\n1 2\n-98.0665 3\n")),
            "a:6: peak: 98.0665 g is above 5 g; is the unit right?");
  EXPECT_EQ(error("time_s,ax_m/s^2\n0,1\n0.1,98.0665\n0.2,1\n"),
            "a:3: peak: 98.0665 m/s^2 = 10 g is above 5 g; is the unit right?");
  EXPECT_EQ(error(at2("NPTS= 2, DT= .01 SEC\n5 -5\n")), "no error");
  EXPECT_EQ(error(replaced(knet(), "3920(gal)/6182761", "3920(gal)/618")),
            "a:14: peak: 47087.6 gal = 48.016 g is above 5 g; is the unit right?");
}

TEST(AccelerogramFile, knet_counts_become_gal_about_their_mean) {
  const AccelerogramFile file = read(knet());
  EXPECT_EQ(file.format, Format::knet);
  EXPECT_EQ(file.interval, 0.01);
  ASSERT_EQ(file.components.size(), 1u);
  const std::vector<double> counts{8009, 9006, 7998, 8001, 8009, 8007, 8002, 8005, 8006, 8003, -3, 8003};
  const double mean = std::accumulate(counts.begin(), counts.end(), 0.) / 12;
  ASSERT_EQ(file.components[0].size(), counts.size());
  for (std::size_t i = 0; i < counts.size(); ++i)
    EXPECT_NEAR(file.components[0][i], (counts[i] - mean) * 3920 / 6182761 / 100, 1e-12);
}

TEST(AccelerogramFile, knet_labels_are_read_as_stations_and_years_spell_them) {
  std::string text = replaced(knet(), "Max. Acc. (gal)   ", "Max Acc. (gal)    ");
  text = replaced(text, "Station Long.     ", "Station Lon.      ");
  text = replaced(text, "Sampling Freq(Hz) ", "Sampling Freq(Hz)\t");
  text = replaced(text, "Memo.\n", "Memo.             words\n");
  EXPECT_EQ(read(text).components[0], read(knet()).components[0]);
}

TEST(AccelerogramFile, knet_that_does_not_hold_what_it_says_is_refused) {
  EXPECT_EQ(error(replaced(knet(), "4.707", "4.727")),
            "a:15: Max. Acc. (gal): says 4.727, the data give 4.70665 about their mean");
  EXPECT_EQ(error(replaced(knet(), "   -3", "     ")),
            "a:12: Duration Time(s): 0.12 s at 100 Hz are 12 samples, the file holds 11");
  EXPECT_EQ(error(replaced(knet(), "   -3", "  -.5")), "a:19: \"-.5\" is not a whole number of counts");
  EXPECT_EQ(error(replaced(knet(), "   -3", " 99-3")), "a:19: \"99-3\" is not a number");
  EXPECT_EQ(error(replaced(knet(), "100Hz", "0Hz")),
            "a:11: Sampling Freq(Hz): found \"0Hz\", expected a number above 0");
  EXPECT_EQ(error(replaced(knet(), "100Hz", "100 per minute")),
            "a:11: Sampling Freq(Hz): found \"100 per minute\", expected a number above 0");
  EXPECT_EQ(error(replaced(knet(), "3920(gal)/6182761", "3920(g)/6182761")),
            "a:14: Scale Factor: found \"3920(g)/6182761\", expected such as 3920(gal)/6182761");
  EXPECT_EQ(error(replaced(knet(), "3920(gal)/6182761", "3920(gal)/0")),
            "a:14: Scale Factor: found \"3920(gal)/0\", expected such as 3920(gal)/6182761");
  EXPECT_EQ(error(replaced(knet(), "Mag.              5.7\n", "")),
            "a:11: K-NET: found \"Duration Time(s)  .12\", expected \"Sampling Freq(Hz)\"");
  EXPECT_EQ(error(knet().substr(0, 200)), "a:8: K-NET: the header ends after 8 of 17 lines");
  EXPECT_EQ(error(knet(), {.unit = "g", .interval = {}}),
            "a:14: unit: the file states gal, the scene g; leave it out there");
  EXPECT_EQ(error(knet(), {.unit = "", .interval = 0.01}),
            "a:1: dt: the file states its own; leave dt out in the scene");
}

TEST(AccelerogramFile, csv_headers_name_columns_and_units) {
  for (const char* header : {"time_s,ax_gal,ay_gal", "t,ax_gal,ay_cm/s^2", "Time (s), NS (gal), EW [cm/s2]",
                             "\"time [s]\",\"ax_gal\",\"ay_GAL\""}) {
    SCOPED_TRACE(header);
    const AccelerogramFile file = read(header + std::string("\n0,1,-2\n0.02,3,4\n0.04,5,6e1\n"));
    EXPECT_EQ(file.format, Format::csv);
    EXPECT_DOUBLE_EQ(file.interval, 0.02);
    ASSERT_EQ(file.components.size(), 2u);
    EXPECT_EQ(file.components[0], (std::vector<double>{1 * 0.01, 3 * 0.01, 5 * 0.01}));
    EXPECT_EQ(file.components[1], (std::vector<double>{-2 * 0.01, 4 * 0.01, 60 * 0.01}));
  }
  const AccelerogramFile three =
      read("# of a table\nax_g;ay_m/s^2;time_ms;az_gal\n# here\n1;2;0;3\n1;2;5;3\n");
  EXPECT_DOUBLE_EQ(three.interval, 0.005);
  ASSERT_EQ(three.components.size(), 3u);
  EXPECT_DOUBLE_EQ(three.components[0][0], k_standard_gravity);
  EXPECT_DOUBLE_EQ(three.components[1][0], 2);
  EXPECT_DOUBLE_EQ(three.components[2][0], 0.03);
}

TEST(AccelerogramFile, csv_without_times_or_units_takes_those_of_the_scene) {
  const AccelerogramFile file = read("ax\tay\n1\t2\n3\t4\n", {.unit = "m/s^2", .interval = 0.25});
  EXPECT_EQ(file.interval, 0.25);
  EXPECT_EQ(file.components[1], (std::vector<double>{2, 4}));
  EXPECT_EQ(read("ax_gal\n1\n2\n", {.unit = "", .interval = 0.25}).components.size(), 1u);
  EXPECT_EQ(error("ax_gal,ay_gal\n1,2\n3,4\n"),
            "a:1: time: there is no column of times, such as time_s, and no dt in the scene");
  EXPECT_EQ(error("time_s,ax_gal\n0,2\n1,4\n", {.unit = "", .interval = 0.25}),
            "a:1: dt: the file has a column of times; leave dt out in the scene");
  EXPECT_EQ(error("time_s,ax\n0,2\n1,4\n"),
            "a:1: column 2: \"ax\" does not end in a unit of acceleration, such as ax_gal; known: g, gal, "
            "m/s^2, cm/s^2; or give unit in the scene");
  EXPECT_EQ(error("time_s,ax_gal\n0,2\n1,4\n", {.unit = "g", .interval = {}}),
            "a:1: unit: the file states gal, the scene g; leave it out there");
}

TEST(AccelerogramFile, csv_times_go_up_in_equal_steps_that_may_be_rounded) {
  std::string rounded = "time_s,ax_gal\n", gap = rounded;
  for (int i = 0; i < 300; ++i) {
    char row[40];
    std::snprintf(row, sizeof row, "%.3f,%d\n", 100 + i / 128., i % 5);  // 128 Hz to the millisecond
    rounded += row;
    if (i != 150) gap += row;
  }
  EXPECT_NEAR(read(rounded).interval, 1 / 128., 1e-5);
  EXPECT_EQ(
      error(gap),
      "a:152: time: a step of 0.016 s, from 101.164 s to 101.18 s, where the others are 0.008 s; samples are "
      "equally spaced");
  EXPECT_EQ(error("time_s,ax_gal\n0,1\n0.1,1\n0.1,1\n"), "a:4: time: 0.1 s does not come after 0.1 s");
  EXPECT_EQ(error("time_s,ax_gal\n0,1\n0.2,1\n0.1,1\n"), "a:4: time: 0.1 s does not come after 0.2 s");
  EXPECT_EQ(error("time_s,ax_gal\n0,1\n60,1\n120,1\n"),
            "a:1: time: 60 s between samples are outside 1e-05..1 s");
  // a clock that drifts within the tolerance of each step
  std::string drifting = "time_s,ax_gal\n";
  double t = 0;
  for (int i = 0; i < 200; ++i) {
    drifting += std::to_string(t) + ",1\n";
    t += i < 100 ? 0.01 : 0.011;
  }
  EXPECT_NE(error(drifting).find("samples are equally spaced"), std::string::npos);
}

TEST(AccelerogramFile, csv_gaps_and_wrong_cells_are_refused) {
  const auto of = [](const std::string& row) { return error("time_s,ax_gal\n0,1\n" + row + "\n0.2,3\n"); };
  EXPECT_EQ(of("0.1,2"), "no error");
  EXPECT_EQ(of("0.1,"), "a:3: column 2: is empty; samples follow each other without gaps");
  EXPECT_EQ(of("0.1,nan"), "a:3: column 2: \"nan\" is not a finite number");
  EXPECT_EQ(of("0.1,0x2"), "a:3: column 2: \"0x2\" is not a number");
  EXPECT_EQ(of("0.1,2,3"), "a:3: found 3 columns, expected 2 as in the header");
  EXPECT_EQ(of("0.1"), "a:3: found 1 columns, expected 2 as in the header");
  EXPECT_EQ(of(""), "a:4: an empty line before it; samples follow each other without gaps");
  EXPECT_EQ(error("time_s,ax_gal\n0,1\n0.1,2\n\n\n"), "no error");
  EXPECT_EQ(error("time_s,ax_gal\n0,1\n"), "a:1: found 1 samples below it, expected 2 or more");
  EXPECT_EQ(error("time_s,ax_gal\n"), "a:1: found 0 samples below it, expected 2 or more");
  EXPECT_EQ(error("time_s,time_ms\n0,0\n"), "a:1: column 2: a second column of times");
  EXPECT_EQ(error("time_min,ax_gal\n0,0\n"), "a:1: column 1: \"min\" is not a unit of time; known: s, ms");
  EXPECT_EQ(error("time_s,a_g,b_g,c_g,d_g\n0,0\n"), "a:1: columns: found 4 of acceleration, expected 1 to 3");
  EXPECT_EQ(error("0,1\n0.1,2\n"),
            "a:1: column 1: found the number \"0\"; the first line names the columns, such as time_s,ax_gal");
}

TEST(AccelerogramFile, anything_else_is_refused_in_one_line) {
  EXPECT_EQ(error(""), "a:1: is empty");
  EXPECT_EQ(
      error("hello\nworld\n"),
      "a:1: found \"hello\", expected PEER AT2, K-NET ASCII, or CSV with a header such as time_s,ax_gal");
  EXPECT_EQ(error(std::string("\x89HDF\r\n\x1a\n", 8)),
            "a:2: is not text; expected PEER AT2, K-NET ASCII, or CSV with a header");
  EXPECT_EQ(error(std::string("time_s,ax_gal\n0,1\n0.1,\0", 23)),
            "a:3: is not text; expected PEER AT2, K-NET ASCII, or CSV with a header");
}

TEST(AccelerogramFile, every_prefix_and_flipped_bit_is_read_or_refused_in_one_line) {
  int refused = 0, was_read = 0;
  const auto survive = [&](const std::string& text) {
    try {
      const AccelerogramFile file = read(text);
      ++was_read;
      for (const std::vector<double>& component : file.components) {
        EXPECT_GE(component.size(), 2u);
        for (const double a : component) EXPECT_TRUE(std::abs(a) <= 50);
      }
    } catch (const InputError& problem) {
      ++refused;
      const std::string line = problem.what();
      EXPECT_EQ(line.find('\n'), std::string::npos) << line;
      EXPECT_EQ(line.rfind("a:", 0), 0u) << line;
    }
  };
  for (const std::string& text : {at2("NPTS= 7, DT= .01 SEC\n .1E-01 -.25 .5 -.125 1.\n .3 -.4E-2\n"), knet(),
                                  std::string("time_s,ax_gal\n0.00,1.5\n0.01,-2.5\n0.02,3\n")}) {
    for (std::size_t size = 0; size < text.size(); ++size) survive(text.substr(0, size));
    for (std::size_t i = 0; i < text.size(); ++i)
      for (int bit = 0; bit < 8; ++bit) {
        std::string flipped = text;
        flipped[i] = static_cast<char>(flipped[i] ^ (1 << bit));
        survive(flipped);
      }
  }
  EXPECT_GT(refused, 1000);
  EXPECT_GT(was_read, 1000);
}

}  // namespace
}  // namespace topple::io
