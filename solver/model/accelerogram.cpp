#include "solver/model/accelerogram.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace topple {
namespace {

double end(const AccelerogramComponent& component) {
  return static_cast<double>(component.samples.size() - 1) * component.interval;
}

double largest(const AccelerogramComponent& component) {
  double size = 0;
  for (const double a : component.samples) size = std::max(size, std::abs(a));
  return size;
}

}  // namespace

std::shared_ptr<const Accelerogram> make_accelerogram(std::vector<AccelerogramComponent> components) {
  auto record = std::make_shared<Accelerogram>();
  record->components = std::move(components);
  record->interval = record->components.front().interval;
  double greatest = -1;
  for (const AccelerogramComponent& component : record->components) {
    record->duration = std::max(record->duration, end(component));
    record->interval = std::min(record->interval, component.interval);
    if (const double size = largest(component); size > greatest) {
      greatest = size;
      record->strongest = component.direction;
    }
  }
  for (const AccelerogramComponent& component : record->components)
    for (std::size_t i = 0; i < component.samples.size(); ++i)
      record->peak =
          std::max(record->peak, acceleration(*record, static_cast<double>(i) * component.interval).norm());
  return record;
}

double acceleration(const AccelerogramComponent& component, double tau) {
  const double place = tau / component.interval;
  const std::size_t last = component.samples.size() - 1;
  if (!(place >= 0) || place > static_cast<double>(last)) return 0;
  const auto i = std::min(static_cast<std::size_t>(place), last - 1);
  const double share = place - static_cast<double>(i);
  return (1 - share) * component.samples[i] + share * component.samples[i + 1];
}

Vec3 acceleration(const Accelerogram& record, double tau) {
  Vec3 sum = Vec3::Zero();
  for (const AccelerogramComponent& component : record.components)
    sum += acceleration(component, tau) * component.direction;
  return sum;
}

void remove_mean(std::vector<double>& samples) {
  const double mean =
      std::accumulate(samples.begin(), samples.end(), 0.) / static_cast<double>(samples.size());
  for (double& a : samples) a -= mean;
}

void subtract_parabola(std::vector<double>& samples) {
  const double last = static_cast<double>(samples.size() - 1);
  const auto powers = [last](std::size_t i) {
    const double x = static_cast<double>(i) / last;
    return Vec3(1, x, x * x);
  };
  // The velocities of the three powers are integrated as that of the record is, so that a record which is a
  // parabola vanishes to rounding.
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Vec3 right = Vec3::Zero(), of_powers = Vec3::Zero();
  double velocity = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    of_powers += (powers(i - 1) + powers(i)) / 2;
    velocity += (samples[i - 1] + samples[i]) / 2;
    normal += of_powers * of_powers.transpose();
    right += velocity * of_powers;
  }
  const Vec3 c = normal.ldlt().solve(right);
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i] -= c.dot(powers(i));
}

}  // namespace topple
