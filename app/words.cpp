#include "app/words.h"

#include <fmt/format.h>

#include <cmath>

#include "solver/accelerogram.h"

namespace topple::app {
namespace {

constexpr double k_degrees = 180 / k_pi;
constexpr double k_upright = 0.1;  // degrees: less is standing
constexpr double k_lying = 60;     // degrees
constexpr double k_slid = 1e-3;    // m
constexpr std::size_t k_few_anchors = 4;

}  // namespace

std::string body_in_words(const Model& model, const io::FrameRow& row, std::size_t body) {
  const double* const values = &row.body[11 * body];
  const double tilt = values[7] * k_degrees, slide = values[8], critical = values[10] * k_degrees;
  std::string line = model.bodies[body].name + ": ";
  if (critical == 0) return line + fmt::format("tilt {:.1f}°", tilt);
  if (tilt > k_lying)
    line += fmt::format("fallen, tilt {:.0f}°", tilt);
  else if (tilt > critical)
    line += fmt::format("toppling, {:.1f}° beyond {:.1f}°", tilt, critical);
  else if (tilt > k_upright)
    line += fmt::format("rocking, {:.1f}° of {:.1f}°", tilt, critical);
  else
    line += "standing";
  if (slide > k_slid) line += fmt::format(", slid {:.0f} mm", 1e3 * slide);
  return line;
}

const char* anchor_type(const Anchor& anchor) {
  static const char* const k_types[] = {"strap", "bracket", "pole"};
  return k_types[static_cast<std::size_t>(anchor.type)];
}

std::string anchor_in_words(const Model& model, const io::FrameRow& row, std::size_t k) {
  const Anchor& anchor = model.anchors[k];
  const float* const values = &row.anchor[4 * k];
  const std::string line = fmt::format("{} {}: ", anchor_type(anchor), anchor.name);
  if (values[3] != io::k_anchor_holds)
    return line + (values[3] == io::k_anchor_away ? "taken away" : io::anchor_word(values[3]));
  const double force = std::abs(values[0]);
  const std::string held = fmt::format("{} {:.0f} N", values[0] > 0 ? "pulls" : "pushes", force);
  return line + held +
         (std::isfinite(anchor.strength)
              ? fmt::format(", {:.0f} % of its strength", 100 * force / anchor.strength)
              : "");
}

std::vector<std::string> anchors_in_words(const Model& model, const io::FrameRow& row) {
  std::vector<std::string> lines;
  if (model.anchors.size() <= k_few_anchors) {
    for (std::size_t k = 0; k < model.anchors.size(); ++k) lines.push_back(anchor_in_words(model, row, k));
    return lines;
  }
  std::string counts;
  for (const float state : {io::k_anchor_holds, io::k_anchor_slack, io::k_anchor_broken, io::k_anchor_away}) {
    int count = 0;
    for (std::size_t k = 0; k < model.anchors.size(); ++k) count += row.anchor[4 * k + 3] == state;
    if (count > 0)
      counts += fmt::format("{} {} {}", counts.empty() ? "" : ",", count, io::anchor_word(state));
  }
  lines.push_back("anchors:" + counts);
  return lines;
}

bool is_static(const Setup& setup) {
  return setup.run.analysis == Analysis::statics;
}

std::string instant_in_words(const Setup& setup, const io::FrameRow& row) {
  return is_static(setup) ? fmt::format("load step {} of {}, load factor {:.4g}", row.step,
                                        setup.run.statics.load_steps, row.load_factor)
                          : fmt::format("t = {:.2f} s", row.time);
}

std::string shake_in_words(const Parameters& parameters) {
  if (parameters.shakes.empty()) return "";
  const Shake& shake = parameters.shakes.front();
  const double gal = shake.amplitude / k_gal;
  switch (shake.kind) {
    case Shake::Kind::sine:
      return fmt::format("floor: {:.4g} Hz, {:.4g} gal", shake.frequency, gal);
    case Shake::Kind::sweep:
      return fmt::format("floor: sweep {:.4g} to {:.4g} Hz, {:.4g} gal", shake.frequency,
                         shake.last_frequency, gal);
    case Shake::Kind::pulse:
      return fmt::format("floor: pulse {:g} s, {:.4g} gal", shake.duration, gal);
    case Shake::Kind::record:
      return fmt::format("floor: record {:.3g} s, peak {:.4g} gal", shake.record->duration,
                         std::abs(shake.scale) * shake.record->peak / k_gal);
  }
  return "";
}

std::string status_in_words(const Player& player) {
  const LiveStatus& status = player.status();
  const bool loads = is_static(player.scene().setup);
  switch (status.kind) {
    case LiveStatus::Kind::starting:
      return "Bringing the bodies to rest under gravity …";
    case LiveStatus::Kind::reading:
      return "Reading the recording …";
    case LiveStatus::Kind::ended:
      return "This session has ended: " + status.message + ". What was recorded is kept.";
    case LiveStatus::Kind::returning:
      return "Going back to the state at this instant …";
    case LiveStatus::Kind::failed:
      if (player.at_head()) return "Stopped: " + status.message;
      break;
    case LiveStatus::Kind::over:
      if (player.at_head())
        return (loads ? "All load steps are done."
                      : fmt::format("The run ended at {:.2f} s.", player.time())) +
               " R runs it again, dragging on the timeline looks back.";
      break;
    default:
      break;
  }
  if (player.way().empty())
    return status.message.empty() ? "The recording holds no instants." : status.message;
  if (player.at_head())
    return player.playing() ? loads ? "Running through the load steps."
                                    : fmt::format("Running: {:.2f} times real time asked, {:.2f} reached.",
                                                  player.speed(), status.achieved)
                            : "Paused. Space goes on; parameters can be changed now and while it runs.";
  std::string words = player.replay() ? "Recording" : "Looking back";
  if (player.playing())
    words += loads ? ", played" : fmt::format(", played at {:g} times real time", player.speed());
  if (!status.message.empty()) return words + "; " + status.message;
  return words + ". C continues from here as a new branch" +
         (player.replay() ? "." : ", End returns to the newest instant.");
}

}  // namespace topple::app
