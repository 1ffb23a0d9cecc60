#include "app/picture/run_extent.h"

#include <algorithm>
#include <cmath>

#include "app/picture/row.h"
#include "app/picture/thinning.h"
#include "app/picture/ways_in_words.h"
#include "solver/io/recording/recording.h"

namespace topple::app {
namespace {

constexpr double k_share = 0.95;  // of the instants lie within the scales

void expect_same_model(const Model& model, const io::FrameRow& row) {
  const std::size_t nodes = model.node_position.size(), elements = model.elements.size();
  if (row.position.size() != 3 * nodes || row.rotation.size() != 4 * nodes || row.s.size() != elements ||
      row.section_force.size() != 6 * elements || row.hinge.size() != elements ||
      row.contact_force.size() != 3 * model.contact_points.size() * model.planes.size() ||
      row.member_contact.size() != (model.bodies.size() > 1 ? 4 * elements : 0) ||
      (!row.panel_contact.empty() && row.panel_contact.size() != 5 * model.panels.size()) ||
      row.body.size() != model.bodies.size() || row.anchor.size() != model.anchors.size())
    throw io::InputError(io::k_another_model);
}

double usual_top(std::vector<double> peaks) {
  if (peaks.empty()) return 0;
  const auto place =
      peaks.begin() + static_cast<std::ptrdiff_t>(k_share * static_cast<double>(peaks.size() - 1));
  std::nth_element(peaks.begin(), place, peaks.end());
  return *place;
}

}  // namespace

BodyPoints body_points(const Model& model, const io::FrameRow& row, std::size_t b) {
  const Body& body = model.bodies[b];
  double height = 0;
  for (int i = body.first_node; i < body.first_node + body.node_count; ++i)
    height = std::max(height, model.node_position[i].z() - body.centre_of_gravity.z());
  const Vec3 centre = row.body[b].centre() + floor_shift(row);
  const Vec3 up = row.body[b].rotation() * Vec3::UnitZ();
  return {to_float(centre), to_float(centre + height * up)};
}

double greatest_contact_force(const io::FrameRow& row) {
  double greatest = 0;
  const auto add = [&](const std::vector<float>& values, std::size_t stride) {
    for (std::size_t c = 0; c + 2 < values.size(); c += stride)
      greatest = std::max<double>(greatest, std::hypot(values[c], values[c + 1], values[c + 2]));
  };
  add(row.contact_force, 3);
  add(row.member_contact, 4);
  add(row.panel_contact, 5);
  return greatest;
}

void RunExtent::add(const Setup& setup, const Parameters& parameters, const io::FrameRow& row) {
  const Model& model = setup.model;
  expect_same_model(model, row);
  add_hits(setup, row, hits);
  const Vec3 shift = floor_shift(row);
  for (int i = 0; i < model.node_total(); ++i) {
    if (model.bodies[model.node_body[i]].ground) continue;
    low = low.cwiseMin(position(row, i) + shift);
    high = high.cwiseMax(position(row, i) + shift);
  }
  for (const Anchor& anchor : model.anchors) {
    if (anchor.other.body >= 0) continue;  // within its bodies
    low = low.cwiseMin(anchor.to + shift);
    high = high.cwiseMax(anchor.to + shift);
  }
  const std::vector<double> peaks = peaks_of(model, row);
  peak_.resize(peaks.size());
  for (std::size_t q = 0; q < peaks.size(); ++q) peak_[q].push_back(peaks[q]);
  peak_contact_.push_back(greatest_contact_force(row));
  bodies_ = static_cast<std::size_t>(model.furniture_total());
  for (std::size_t b = 0; b < bodies_; ++b) points_.push_back(body_points(model, row, b));
  way.push_back(static_cast<float>(row.time));
  load_factor.push_back(static_cast<float>(row.load_factor));
  if (parameters.shakes.empty()) return;
  time_s.push_back(static_cast<float>(row.time));
  acceleration_gal.push_back(
      static_cast<float>(Vec3(row.floor_acceleration).dot(parameters.shakes.front().direction) / k_gal));
}

void RunExtent::thin() {
  for (std::vector<double>& peaks : peak_) thin_older_half(peaks);
  thin_older_half(peak_contact_);
  if (bodies_ > 0) thin_older_half(points_, bodies_);
  for (std::vector<float>* values : {&time_s, &acceleration_gal, &way, &load_factor})
    thin_older_half(*values);
}

double RunExtent::top(BeamQuantity quantity) const {
  return peak_.empty() ? 0 : usual_top(peak_[place_of(quantity)]);
}

double RunExtent::contact_force_top() const {
  return usual_top(peak_contact_);
}

}  // namespace topple::app
