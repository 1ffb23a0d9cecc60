// Writes the built-in accelerograms. All are synthetic: no earthquake, no station, no building.
//   make_records FOLDER
//
// long-period-x.AT2, long-period-y.EW: a high floor of a tall building on a deep basin, two horizontal
// components.
//   Gaussian white noise under the envelope of Jennings (P. C. Jennings, G. W. Housner, N. C. Tsai, Simulated
//   earthquake motions, Caltech 1968: a parabola up to t1, 1 up to t2, exp(-c (t - t2))), through the soil of
//   Kanai and Tajimi with the high-pass of Clough and Penzien (R. W. Clough, J. Penzien, Dynamics of
//   Structures, 1975),
//       S(w) ~ (1 + 4 zg^2 r^2)/((1 - r^2)^2 + 4 zg^2 r^2)  w^4/((wf^2 - w^2)^2 + 4 zf^2 wf^2 w^2),   r =
//       w/wg,
//   through the building, one mode of 2 % damping: the absolute acceleration of its mass. The last seconds
//   fade out, and the whole is scaled to a given peak.
// near-fault.csv: a forward-directivity pulse normal to a fault (G. P. Mavroeidis, A. S. Papageorgiou, A
// mathematical
//   representation of near-fault ground motions, Bull. Seismol. Soc. Am. 93, 2003, 1099-1131),
//       v(t) = A/2 (1 + cos(2 pi fp/g (t - t0))) cos(2 pi fp (t - t0) + nu)   for |t - t0| <= g/(2 fp), else
//       0.
//
// The bytes depend on nothing but the numbers below: the 64-bit Mersenne twister is the same in every
// standard library, unlike its distributions, and what is written has far fewer digits than what is computed.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <random>
#include <string>
#include <vector>

namespace {

constexpr double k_pi = 3.14159265358979323846;
constexpr double k_gravity = 980.665;  // gal

// Standard normal numbers by Box and Muller.
class Noise {
 public:
  explicit Noise(std::uint64_t seed) : twister_(seed) {}
  double next() {
    const double radius = std::sqrt(-2 * std::log(uniform()));
    return radius * std::cos(2 * k_pi * uniform());
  }

 private:
  // Within 0..1, never at its ends.
  double uniform() { return (static_cast<double>(twister_() >> 11) + 0.5) * 0x1p-53; }

  std::mt19937_64 twister_;
};

// x'' + 2 z w x' + w^2 x = -a by the average acceleration method; a is that of its base.
class Oscillator {
 public:
  Oscillator(double frequency, double damping, double step)
      : k_(std::pow(2 * k_pi * frequency, 2)), c_(4 * k_pi * frequency * damping), h_(step) {}
  void advance(double base) {
    const double x = x_ + h_ * v_ + h_ * h_ / 4 * a_, v = v_ + h_ / 2 * a_;
    a_ = (-base - c_ * v - k_ * x) / (1 + c_ * h_ / 2 + k_ * h_ * h_ / 4);
    x_ = x + h_ * h_ / 4 * a_;
    v_ = v + h_ / 2 * a_;
  }
  double relative_acceleration() const { return a_; }
  double absolute_acceleration() const { return -(c_ * v_ + k_ * x_); }

 private:
  double k_, c_, h_, x_ = 0, v_ = 0, a_ = 0;
};

struct Floor {
  std::uint64_t seed;
  double building;  // Hz
  double peak;      // gal
  int rate;         // Hz
};

constexpr int k_seconds = 60;
constexpr double k_rise = 8, k_fall = 25, k_decay = 0.1;        // s, s, 1/s: of the envelope
constexpr double k_soil = 0.5, k_soil_damping = 0.5;            // Hz
constexpr double k_high_pass = 0.2, k_high_pass_damping = 0.6;  // Hz
constexpr double k_building_damping = 0.02;
constexpr double k_fade = 10;  // s

double envelope(double t) {
  if (t < k_rise) return t / k_rise * (t / k_rise);
  return t < k_fall ? 1 : std::exp(-k_decay * (t - k_fall));
}

// gal
std::vector<double> long_period(const Floor& floor) {
  constexpr int k_steps_per_second = 400;
  constexpr double h = 1. / k_steps_per_second;
  Noise noise(floor.seed);
  Oscillator soil(k_soil, k_soil_damping, h), high_pass(k_high_pass, k_high_pass_damping, h),
      building(floor.building, k_building_damping, h);
  std::vector<double> samples;
  for (int i = 0; i < k_seconds * k_steps_per_second; ++i) {
    const double t = i * h;
    soil.advance(envelope(t) * noise.next());
    high_pass.advance(soil.absolute_acceleration());
    building.advance(high_pass.relative_acceleration());
    const double left = std::min((k_seconds - t) / k_fade, 1.);
    if (i % (k_steps_per_second / floor.rate) == 0)
      samples.push_back(building.absolute_acceleration() * (1 - std::cos(k_pi * left)) / 2);
  }
  double peak = 0;
  for (const double a : samples) peak = std::max(peak, std::abs(a));
  for (double& a : samples) a *= floor.peak / peak;
  return samples;
}

std::string formatted(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

// As Fortran writes it: no digit before the point.
std::string fortran_real(double value) {
  if (value == 0) return ".0000000E+00";
  const std::string text = formatted("%.6E", value);  // "-1.234567E-02"
  const std::size_t digit = text.find_first_of("0123456789"), mark = text.find('E');
  const double exponent = std::stoi(text.substr(mark + 1)) + 1;
  return text.substr(0, digit) + "." + text[digit] + text.substr(digit + 2, mark - digit - 2) + "E" +
         formatted("%+03.0f", exponent);
}

std::string right(const std::string& text, std::size_t width) {
  return std::string(width - std::min(width, text.size()), ' ') + text;
}

// Values in columns, so many to a line.
std::string columns(const std::vector<std::string>& values, std::size_t width, std::size_t per_line) {
  std::string text;
  for (std::size_t i = 0; i < values.size(); ++i) {
    text += right(values[i], width);
    if ((i + 1) % per_line == 0 || i + 1 == values.size()) text += '\n';
  }
  return text;
}

std::string at2(const Floor& floor) {
  const std::vector<double> samples = long_period(floor);
  std::vector<std::string> values;
  for (const double gal : samples) values.push_back(fortran_real(gal / k_gravity));
  return "SYNTHETIC FLOOR MOTION, NO EARTHQUAKE (assets/records/make_records.cpp)\n"
         "HIGH FLOOR OF A TALL BUILDING, MODE OF " +
         formatted("%.2f", floor.building) +
         " HZ, COMPONENT X\n"
         "ACCELERATION TIME SERIES IN UNITS OF G\n"
         "NPTS=  " +
         std::to_string(samples.size()) + ", DT=   " + formatted("%.4f", 1. / floor.rate).substr(1) +
         " SEC\n" + columns(values, 15, 5);
}

std::string knet(const Floor& floor) {
  constexpr double k_full_scale = 2000, k_full_count = 8388608, k_offset = 8005;
  constexpr double k_gal = k_full_scale / k_full_count;
  const std::vector<double> samples = long_period(floor);
  std::vector<double> counts;
  std::vector<std::string> values;
  double mean = 0, peak = 0;
  for (const double gal : samples) {
    counts.push_back(std::round(gal / k_gal) + k_offset);
    values.push_back(formatted("%.0f", counts.back()));
    mean += counts.back() / static_cast<double>(samples.size());
  }
  for (const double count : counts) peak = std::max(peak, std::abs(count - mean) * k_gal);
  return "Origin Time       2000/01/01 00:00:00\n"
         "Lat.              0.000\n"
         "Long.             0.000\n"
         "Depth. (km)       0\n"
         "Mag.              0.0\n"
         "Station Code      SYNTH1\n"
         "Station Lat.      0.0000\n"
         "Station Long.     0.0000\n"
         "Station Height(m) 0\n"
         "Record Time       2000/01/01 00:00:15\n"
         "Sampling Freq(Hz) " +
         std::to_string(floor.rate) +
         "Hz\n"
         "Duration Time(s)  " +
         std::to_string(k_seconds) +
         "\n"
         "Dir.              E-W\n"
         "Scale Factor      2000(gal)/8388608\n"
         "Max. Acc. (gal)   " +
         formatted("%.3f", peak) +
         "\n"
         "Last Correction   2000/01/01 00:00:00\n"
         "Memo.             Synthetic: no earthquake (make_records.cpp)\n" +
         columns(values, 9, 8);
}

std::string near_fault() {
  constexpr double k_speed = 90, k_frequency = 0.6, k_oscillation = 2, k_phase = k_pi / 2;  // cm/s, Hz, g, nu
  constexpr double k_middle = 4, k_length = 10, k_rate = 100;                               // s, s, Hz
  std::string text =
      "# Synthetic near-fault pulse, no earthquake (assets/records/make_records.cpp).\n"
      "# Mavroeidis and Papageorgiou 2003: A = 90 cm/s, fp = 0.6 Hz, gamma = 2, nu = 90 deg, t0 = 4 s.\n"
      "time_s,ax_gal\n";
  for (int i = 0; i <= static_cast<int>(k_length * k_rate); ++i) {
    const double t = i / k_rate, x = t - k_middle, w = 2 * k_pi * k_frequency, slow = w / k_oscillation;
    double a = 0;
    if (std::abs(x) <= k_oscillation / (2 * k_frequency))
      a = -k_speed / 2 *
          (slow * std::sin(slow * x) * std::cos(w * x + k_phase) +
           w * (1 + std::cos(slow * x)) * std::sin(w * x + k_phase));
    const std::string value = formatted("%.3f", a);
    text += formatted("%.2f", t) + "," + (value == "-0.000" ? "0.000" : value) + "\n";
  }
  return text;
}

bool write(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) std::fprintf(stderr, "make_records: %s: cannot be written\n", path.c_str());
  return static_cast<bool>(file);
}

}  // namespace

int main(int count, char** words) {
  if (count != 2) {
    std::fputs("usage: make_records FOLDER\n", stderr);
    return 2;
  }
  const std::string folder = std::string(words[1]) + "/";
  const Floor x{1, 0.28, 230, 50}, y{2, 0.36, 140, 100};
  return write(folder + "long-period-x.AT2", at2(x)) && write(folder + "long-period-y.EW", knet(y)) &&
                 write(folder + "near-fault.csv", near_fault())
             ? 0
             : 1;
}
