#include "solver/model/building.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/math/elementary.h"
#include "solver/math/types.h"

namespace topple {
namespace {

// Intervals in the shortest period of ground and building: the cubic between them errs by
// (2 pi/48)^4/384 = 8e-7 of what has that period.
constexpr double k_per_period = 48;
constexpr double k_died_away = 1e-6;  // of the peak
constexpr double k_same = 1e-9;       // of the peak: one period after another of a steady motion

struct ModeState {
  double x = 0, v = 0;  // relative displacement and velocity, over the ground's unit
};

/// Exact over one interval h for the ground's acceleration p + s tau.
class Oscillator {
 public:
  Oscillator(const BuildingMode& mode, double h)
      : w(2 * k_pi / mode.period), zeta(mode.damping), factor_(mode.factor) {
    const double damped = w * std::sqrt(1 - zeta * zeta), decay = elementary::exp(-zeta * w * h),
                 sine = decay * elementary::sin(damped * h), cosine = decay * elementary::cos(damped * h);
    xx_ = cosine + zeta * w / damped * sine;
    xv_ = sine / damped;
    vx_ = -w * w / damped * sine;
    vv_ = cosine - zeta * w / damped * sine;
    h_ = h;
  }
  ModeState advance(const ModeState& from, double p, double s) const {
    // particular solution -(p + s tau)/w^2 + 2 zeta s/w^3
    const double rate = -s / (w * w), start = -p / (w * w) + 2 * zeta * s / (w * w * w);
    const double x = from.x - start, v = from.v - rate;
    return {xx_ * x + xv_ * v + start + rate * h_, vx_ * x + vv_ * v + rate};
  }
  /// Part of the floor's acceleration; its rate where the ground has acceleration a.
  double value(const ModeState& at) const { return -factor_ * (2 * zeta * w * at.v + w * w * at.x); }
  double slope(const ModeState& at, double a) const {
    const double relative = -a - 2 * zeta * w * at.v - w * w * at.x;
    return -factor_ * (2 * zeta * w * relative + w * w * at.v);
  }
  /// Upper bound of |value| of a free vibration from there on.
  double most(const ModeState& at) const {
    const double damped = w * std::sqrt(1 - zeta * zeta);
    return std::abs(factor_) * w * w * (1 + 2 * zeta) *
           (elementary::hypot(at.x, (at.v + zeta * w * at.x) / damped) + std::abs(at.v) / w * zeta);
  }
  /// Share of a free vibration that is left after t.
  double left_after(double t) const { return elementary::exp(-zeta * w * t); }

  const double w, zeta;

 private:
  double factor_, h_, xx_, xv_, vx_, vv_;
};

/// Follows the modes of one component.
class Response {
 public:
  Response(const std::vector<BuildingMode>& modes, const GroundSignal& ground) : ground_(ground) {
    double shortest = ground.shortest;
    for (const BuildingMode& mode : modes) shortest = std::min(shortest, mode.period);
    h_ = ground.grid / std::max(1., std::ceil(ground.grid * k_per_period / shortest * (1 - 1e-9)));
    out_.interval = h_;
    for (const BuildingMode& mode : modes) oscillators_.emplace_back(mode, h_);
    state_.assign(modes.size(), {0, -ground.jump});
  }

  bool run() {
    const bool done = ground_.goes_on ? until_steady() : until_silent();
    return done && out_.curve.size() <= k_most_floor_intervals;
  }
  double peak() const { return peak_; }
  FloorResponse::Component take() { return std::move(out_); }

 private:
  void step(bool moves) {
    constexpr double k_gauss = 0.21132486540518712;  // (1 - 1/sqrt 3)/2
    const double t = h_ * static_cast<double>(out_.curve.size());
    double p = 0, s = 0;
    if (moves) {
      const double first = ground_.acceleration(t + k_gauss * h_),
                   second = ground_.acceleration(t + (1 - k_gauss) * h_);
      s = (second - first) / (1 - 2 * k_gauss);  // over the interval
      p = first - k_gauss * s;
    }
    double y0 = 0, y1 = 0, d0 = 0, d1 = 0;
    for (std::size_t r = 0; r < state_.size(); ++r) {
      const Oscillator& of = oscillators_[r];
      ModeState& at = state_[r];
      y0 += of.value(at), d0 += h_ * of.slope(at, p);
      at = of.advance(at, p, s / h_);
      y1 += of.value(at), d1 += h_ * of.slope(at, p + s);
    }
    peak_ = std::max({peak_, std::abs(y0), std::abs(y1)});
    out_.curve.push_back({y0, d0, 3 * (y1 - y0) - 2 * d0 - d1, 2 * (y0 - y1) + d0 + d1});
  }

  bool until_silent() {
    const double moving = std::round(ground_.duration / h_);
    if (moving > static_cast<double>(k_most_floor_intervals)) return false;
    for (double i = 0; i < moving; ++i) step(true);
    const auto left = [&] {
      double most = 0;
      for (std::size_t r = 0; r < state_.size(); ++r) most += oscillators_[r].most(state_[r]);
      return most;
    };
    while (left() > k_died_away * peak_) {
      if (out_.curve.size() > k_most_floor_intervals) return false;
      step(false);
    }
    return true;
  }

  bool until_steady() {
    const double in_period = std::round(ground_.duration / h_);
    if (in_period > static_cast<double>(k_most_floor_intervals)) return false;
    const auto period = static_cast<std::size_t>(in_period);
    std::vector<ModeState> before;
    for (;;) {
      before = state_;
      for (std::size_t i = 0; i < period; ++i) step(true);
      if (out_.curve.size() > k_most_floor_intervals) return false;
      double change = 0;
      for (std::size_t r = 0; r < state_.size(); ++r) {
        const Oscillator& of = oscillators_[r];
        // the free vibration that is left changes by so much of itself in a period
        const double rest = 1 - of.left_after(ground_.duration);
        change += of.most({state_[r].x - before[r].x, state_[r].v - before[r].v}) / rest;
      }
      if (h_ * static_cast<double>(out_.curve.size()) > ground_.steady + 2 * ground_.duration &&
          change <= k_same * peak_)
        break;
    }
    out_.repeats = period;
    return true;
  }

  const GroundSignal& ground_;
  double h_ = 0, peak_ = 0;
  std::vector<Oscillator> oscillators_;
  std::vector<ModeState> state_;
  FloorResponse::Component out_{};
};

}  // namespace

std::vector<BuildingMode> shear_building(int storey, int of, double period, double damping) {
  const double parts = 2 * of + 1, first = elementary::sin(k_pi / parts / 2);
  std::vector<BuildingMode> modes;
  for (int r = 1; r <= of; ++r) {
    const double half = (2 * r - 1) * k_pi / parts / 2;
    modes.push_back({period * first / elementary::sin(half), damping,
                     2 / parts / elementary::tan(half) * elementary::sin(2 * half * storey)});
  }
  return modes;
}

std::shared_ptr<FloorResponse> floor_response(std::vector<BuildingMode> modes,
                                              const std::vector<GroundSignal>& ground) {
  auto out = std::make_shared<FloorResponse>();
  out->ground = 1;
  for (const BuildingMode& mode : modes) out->ground -= mode.factor;
  if (std::abs(out->ground) < 1e-12) out->ground = 0;
  for (const GroundSignal& signal : ground) {
    Response response(modes, signal);
    if (!response.run()) return nullptr;
    out->peak += response.peak();
    out->components.push_back(response.take());
    const FloorResponse::Component& last = out->components.back();
    out->duration =
        std::max(out->duration, last.repeats > 0 ? std::numeric_limits<double>::infinity()
                                                 : last.interval * static_cast<double>(last.curve.size()));
  }
  out->modes = std::move(modes);
  return out;
}

const FloorResponse::Cubic* floor_curve(const FloorResponse::Component& component, double tau,
                                        double& share) {
  if (!(tau >= 0)) return nullptr;
  const std::size_t count = component.curve.size();
  const double place = tau / component.interval, whole = std::floor(place);
  if (component.repeats == 0 && !(place < static_cast<double>(count))) return nullptr;
  share = place - whole;
  if (whole < static_cast<double>(count)) return &component.curve[static_cast<std::size_t>(whole)];
  const auto beyond = std::fmod(whole - static_cast<double>(count), static_cast<double>(component.repeats));
  return &component.curve[count - component.repeats + static_cast<std::size_t>(beyond)];
}

double floor_response_at(const FloorResponse::Component& component, double tau) {
  double u = 0;
  const FloorResponse::Cubic* const c = floor_curve(component, tau, u);
  return c ? (*c)[0] + u * ((*c)[1] + u * ((*c)[2] + u * (*c)[3])) : 0;
}

}  // namespace topple
