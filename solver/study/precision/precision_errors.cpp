// What runs of the precision study are compared with, and how far off they are.
#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "solver/body/body_pose.h"
#include "solver/math/rotation.h"
#include "solver/run/overturn.h"
#include "solver/study/precision/convergence.h"
#include "solver/study/precision/precision.h"

namespace topple::study {
namespace {

using nlohmann::ordered_json;

/// A case that was run.
struct Course {
  bool completed = false;
  std::vector<std::optional<double>> fell;  // s, per body
  std::vector<std::vector<double>> tilt;    // rad, per body
  std::vector<std::vector<double>> stress;  // Pa, per body; empty: always rigid
  std::vector<double> balance;
  double end = 0;

  std::size_t samples() const { return balance.size(); }
};

Course course_of(const std::string& row) {
  Course course;
  if (row.empty()) return course;
  const ordered_json json = ordered_json::parse(row);
  course.completed = json["status"] == "completed";
  for (const auto& time : json["fell"])
    course.fell.push_back(time.is_null() ? std::nullopt : std::optional(time.get<double>()));
  for (const auto& body : json["tilt"]) {
    course.tilt.emplace_back();
    for (const auto& value : body) course.tilt.back().push_back(1e-9 * value.get<double>());
  }
  for (const auto& body : json["stress"])
    course.stress.push_back(body.is_null() ? std::vector<double>() : body.get<std::vector<double>>());
  course.balance = json["balance"].get<std::vector<double>>();
  course.end = json["end_s"].get<double>();
  return course;
}

/// Least critical angle of a body, with what it bears at the start, over the edges of its base, rad; none: it
/// has none.
std::optional<double> least_critical(const Model& model, int b, const Stack& all) {
  constexpr double k_little = 1e-3;  // rad
  double least = std::numeric_limits<double>::infinity();
  const std::vector<Vec3>& polygon = model.bodies[static_cast<std::size_t>(b)].support_polygon;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 edge = (polygon[(i + 1) % polygon.size()] - polygon[i]).normalized();
    const BodyPose lean{model.bodies[static_cast<std::size_t>(b)].centre_of_gravity,
                        exp_quaternion(k_little * edge)};
    least = std::min(least, critical_angle(model, b, lean, all));
  }
  return std::isfinite(least) ? std::optional(least) : std::nullopt;
}

/// Compares runs of one law with each other.
class Comparison {
 public:
  Comparison(const PrecisionPlan& plan, const std::vector<Course>& courses, int law)
      : plan_(plan), courses_(courses), law_(law) {
    choose();
    if (reference_.run < 0) return;
    const Model& model = plan.scene.setup.model;
    const Course& run = course(reference_.run);
    std::vector<BodyPose> poses;
    for (const Body& body : model.bodies) poses.push_back({body.centre_of_gravity, Quat::Identity()});
    std::vector<Stack> at_start;
    find_stacks(model, bearers_of(model, plan.scene.setup.starts), poses, at_start);
    for (int b = 0; b < model.furniture_total(); ++b) {
      const std::vector<double>& tilt = run.tilt[static_cast<std::size_t>(b)];
      const double peak = tilt.empty() ? 0 : *std::ranges::max_element(tilt);
      scale_.push_back(least_critical(model, b, at_start[b]).value_or(peak > 0 ? peak : 1));
    }
    find_window();
    if (reference_.run < 0) return;
    reference_.fell = run.fell;
    reference_.end = run.end;
    reference_.uncertainty = errors(course(reference_.check));
    reference_.uncertainty[index(Measure::energy)].reset();
    reference_.order = order();
    for (const std::vector<double>& tilt : run.tilt)
      reference_.peak_tilt.push_back(
          *std::max_element(tilt.begin(), tilt.begin() + static_cast<std::ptrdiff_t>(samples_)));
  }

  const Reference& reference() const { return reference_; }

  bool same_verdict(const Course& other) const {
    const Course& run = course(reference_.run);
    for (std::size_t b = 0; b < run.fell.size(); ++b)
      if (within(run.fell[b]) != within(other.fell[b])) return false;
    return true;
  }

  Errors errors(const Course& other) const {
    const Course& run = course(reference_.run);
    Errors out;
    if (!other.completed || other.samples() == 0) return out;
    const std::size_t last = std::min(samples_, other.samples()) - 1;
    const bool same = same_verdict(other);
    out[index(Measure::tilt)] = tilt_error(run, other, samples_);
    std::optional<double> time, stress = 0;
    for (std::size_t b = 0; b < run.fell.size(); ++b) {
      if (same && within(run.fell[b]))
        time = std::max(time.value_or(0), std::abs(*other.fell[b] / *run.fell[b] - 1));
      if (other.stress[b].empty() || run.stress[b].empty())
        stress.reset();
      else if (const double peak = run.stress[b][samples_ - 1]; stress && peak > 0)
        stress = std::max(*stress, std::abs(other.stress[b][last] / peak - 1));
    }
    out[index(Measure::overturn_time)] = time;
    out[index(Measure::peak_stress)] = stress;
    out[index(Measure::energy)] = other.balance[last];
    return out;
  }

 private:
  const Course& course(int k) const { return courses_[static_cast<std::size_t>(k)]; }

  bool within(const std::optional<double>& time) const { return time && *time <= reference_.window; }

  /// Cases of a method that completed, the finest first.
  std::vector<int> completed(Method method) const {
    std::vector<int> found;
    for (int k = 0; k < plan_.cases(); ++k)
      if (plan_.law_of(k) == law_ && plan_.setting_of(k).method == method && course(k).completed)
        found.push_back(k);
    std::ranges::sort(found, {}, [&](int k) { return plan_.setting_of(k).step; });
    return found;
  }

  void choose() {
    const std::vector<int> exact = completed(Method::central_difference),
                           check = completed(Method::generalized_alpha);
    if (exact.empty() ? check.size() < 2 : check.empty()) {
      reference_.why_not = "no two runs as a frame have completed that could confirm each other";
      return;
    }
    reference_.run = exact.empty() ? check[0] : exact[0];
    reference_.check = exact.empty() ? check[1] : check[0];
  }

  void find_window() {
    const Course &run = course(reference_.run), &check = course(reference_.check);
    samples_ = std::min(run.samples(), check.samples());
    for (std::size_t b = 0; b < scale_.size(); ++b)
      for (std::size_t n = 0; n < samples_; ++n)
        if (std::abs(run.tilt[b][n] - check.tilt[b][n]) > k_parted * scale_[b]) samples_ = n;
    reference_.window = static_cast<double>(samples_ - 1) * plan_.interval;
    if (samples_ > 1) return;
    reference_.why_not = "the two references part at once";
    reference_.run = -1;
  }

  /// Over `most` samples.
  double tilt_error(const Course& run, const Course& other, std::size_t most) const {
    const std::size_t count = std::min({most, run.samples(), other.samples()});
    double greatest = 0;
    for (std::size_t b = 0; b < scale_.size(); ++b)
      greatest = std::max(
          greatest, rms_difference({run.tilt[b].data(), count}, {other.tilt[b].data(), count}) / scale_[b]);
    return greatest;
  }

  /// From the three finest steps of the reference's method, until a body overturns: from there on errors
  /// grow.
  std::optional<double> order() const {
    const std::vector<int> runs = completed(plan_.setting_of(reference_.run).method);
    if (runs.size() < 3) return std::nullopt;
    std::size_t most = samples_;
    for (const std::optional<double>& time : course(runs[0]).fell)
      if (time) most = std::min(most, static_cast<std::size_t>(*time / plan_.interval) + 1);
    return observed_order(tilt_error(course(runs[1]), course(runs[2]), most),
                          tilt_error(course(runs[0]), course(runs[1]), most), 2);
  }

  const PrecisionPlan& plan_;
  const std::vector<Course>& courses_;
  int law_;
  std::vector<double> scale_;  // rad, per body
  std::size_t samples_ = 0;    // of the window
  Reference reference_;
};

double floored(const Reference& reference, Measure measure, double error) {
  return std::max(error, reference.uncertainty[index(measure)].value_or(0));
}

}  // namespace

const char* name(Measure measure) {
  struct Name {
    Measure kind;
    const char* name;
  };
  constexpr Name k_names[] = {{Measure::tilt, "tilt"},
                              {Measure::overturn_time, "overturn time"},
                              {Measure::peak_stress, "peak stress"},
                              {Measure::energy, "energy"}};
  return row_of(k_names, measure).name;
}

PrecisionStudy gather(const PrecisionPlan& plan, const std::vector<std::string>& rows) {
  PrecisionStudy study;
  study.of = plan.cases();
  std::vector<Course> courses;
  for (const std::string& row : rows) {
    courses.push_back(course_of(row));
    PrecisionRow& out = study.rows.emplace_back();
    if (row.empty()) continue;
    ++study.run;
    const ordered_json json = ordered_json::parse(row);
    out.status = json["status"].get<std::string>();
    out.end = json["end_s"].get<double>();
    out.steps = json["steps"].get<long>();
    if (courses.back().completed && *out.end > 0) out.cost = json["cpu_s"].get<double>() / *out.end;
  }
  for (int law = 0; law < static_cast<int>(plan.laws.size()); ++law) {
    const Comparison comparison(plan, courses, law);
    study.references.push_back(comparison.reference());
    if (comparison.reference().run < 0) continue;
    for (int k = 0; k < plan.cases(); ++k) {
      const auto n = static_cast<std::size_t>(k);
      if (plan.law_of(k) != law || !courses[n].completed) continue;
      study.rows[n].errors = comparison.errors(courses[n]);
      study.rows[n].same_verdict = comparison.same_verdict(courses[n]);
    }
  }
  return study;
}

std::vector<int> front(const PrecisionPlan& plan, const PrecisionStudy& study, int law, Measure measure) {
  std::vector<int> cases;
  std::vector<CostPoint> points;
  for (int k = 0; k < plan.cases(); ++k) {
    const PrecisionRow& row = study.rows[static_cast<std::size_t>(k)];
    const std::optional<double>& error = row.errors[index(measure)];
    if (plan.law_of(k) != law || !row.cost || !error) continue;
    cases.push_back(k);
    points.push_back({*row.cost, floored(study.references[static_cast<std::size_t>(law)], measure, *error)});
  }
  std::vector<int> found;
  for (const int n : pareto_front(points)) found.push_back(cases[static_cast<std::size_t>(n)]);
  return found;
}

std::optional<int> cheapest(const PrecisionPlan& plan, const PrecisionStudy& study, int law, Measure measure,
                            double error) {
  for (const int k : front(plan, study, law, measure))
    if (floored(study.references[static_cast<std::size_t>(law)], measure,
                *study.rows[static_cast<std::size_t>(k)].errors[index(measure)]) <= error)
      return k;
  return std::nullopt;
}

std::optional<DefaultPlace> place_of_default(const PrecisionPlan& plan, const PrecisionStudy& study,
                                             Measure measure) {
  const PrecisionRow& own = study.rows.front();
  const std::optional<double>& error = own.errors[index(measure)];
  if (!own.cost || !error) return std::nullopt;
  const double exact = floored(study.references.front(), measure, *error);
  const bool with_stress = own.errors[index(Measure::peak_stress)].has_value();
  DefaultPlace place;
  for (int k = 0; k < plan.cases() && plan.law_of(k) == 0; ++k) {
    const PrecisionRow& row = study.rows[static_cast<std::size_t>(k)];
    if (!row.cost || !row.errors[index(measure)]) continue;
    if (with_stress && !row.errors[index(Measure::peak_stress)]) continue;
    const double e = floored(study.references.front(), measure, *row.errors[index(measure)]);
    if (e <= exact) place.cost_ratio = std::max(place.cost_ratio, *own.cost / *row.cost);
    if (*row.cost <= *own.cost && e > 0) place.error_ratio = std::max(place.error_ratio, exact / e);
  }
  return place;
}

}  // namespace topple::study
