#include "app/panels/demo.h"

#include <algorithm>

#include "app/panels/teaching_words.h"
#include "solver/io/common/units.h"
#include "solver/model/accelerogram.h"
#include "solver/model/excitation.h"
#include "solver/study/common/alone.h"

namespace topple::app {
namespace {

using namespace window_words;

constexpr double k_lying = 60 * k_pi / 180;
constexpr double k_demo_speed = 0.25;  // up to what is pointed out; a second is too short to look at it

constexpr DemoStep k_gentle[] = {{Until::start, k_gentle_start},
                                 {Until::uplift, k_gentle_uplift},
                                 {Until::critical, k_gentle_critical},
                                 {Until::end, k_gentle_end}};
constexpr DemoStep k_violent[] = {{Until::start, k_violent_start},
                                  {Until::uplift, k_violent_uplift},
                                  {Until::impact, k_violent_impact},
                                  {Until::end, k_violent_end}};
constexpr Demo k_demo_table[] = {{k_demo_gentle, 0.5, 190, k_gentle}, {k_demo_violent, 2, 700, k_violent}};

std::int32_t first_standing(const Model& model) {
  for (int b = 0; b < model.furniture_total(); ++b)
    if (study::why_not_standing(model, b).empty()) return b;
  return 0;
}

bool is_over(const LiveStatus& status) {
  return status.kind == LiveStatus::Kind::over || status.kind == LiveStatus::Kind::failed;
}

}  // namespace

std::span<const Demo> demos() {
  return k_demo_table;
}

bool can_shake_as_sine(const Player& player) {
  const auto& shakes = player.parameters().shakes;
  return player.can_edit() && !shakes.empty() && !shakes.front().building &&
         traits(shakes.front().kind).has_amplitude;
}

void shake_as_sine(Player& player, double frequency, double amplitude) {
  player.begin_edit();
  const auto post = [&](Edit::Key key, const Vec3& value) {
    if (edited_value(player.parameters(), key, 0) != value) player.edit({key, 0, value});
  };
  post(Edit::Key::type, Vec3(static_cast<int>(Shake::Kind::sine), 0, 0));
  post(Edit::Key::on, Vec3(1, 0, 0));
  Vec3 number = edited_value(player.parameters(), Edit::Key::frequency, 0);
  number.x() = frequency;
  post(Edit::Key::frequency, number);
  post(Edit::Key::amplitude, Vec3(io::in_si(amplitude, k_gal), 0, 0));
}

DemoGuide::DemoGuide(const Demo& demo, Player& player)
    : demo_(demo),
      player_(player),
      branch_before_(player.status().branch),
      body_(first_standing(player.scene().setup.model)) {
  shake_as_sine(player_, demo_.frequency, demo_.amplitude);
  player_.pause();
  player_.restart();
}

const Phrase& DemoGuide::text() const {
  const std::size_t step = reached_.value_or(0);
  return step < stops_.size() && !stops_[step].occurred ? k_did_not_come : demo_.steps[step].text;
}

std::optional<DemoGuide::Stop> DemoGuide::stop_of(Until until) const {
  if (until == Until::start) return Stop{0, true};
  const double since = stops_.empty() ? 0 : stops_.back().time;
  if (until == Until::end) {
    const auto b = static_cast<std::size_t>(body_);
    for (const RowPtr& row : player_.way())
      if (row->time >= since && row->body[b].tilt > k_lying) return Stop{row->time, true};
    return is_over(player_.status()) ? std::optional(Stop{player_.end(), true}) : std::nullopt;
  }
  const Event::Kind kind = until == Until::uplift   ? Event::Kind::uplift
                           : until == Until::impact ? Event::Kind::impact
                                                    : Event::Kind::overturn;
  for (const io::RecordedEvent& event : player_.events())
    if (event.event.kind == kind && event.event.body == body_ && event.time >= since)
      return Stop{event.time, true};
  return is_over(player_.status()) ? std::optional(Stop{player_.end(), false}) : std::nullopt;
}

void DemoGuide::show(std::size_t step) {
  reached_ = step;
  leave();
  going_ = false;
  player_.scrub(stops_[step].time);
}

bool DemoGuide::update() {
  if (!going_) return false;
  const bool ready =
      player_.status().branch != branch_before_ && player_.shown_branch() == player_.status().branch;
  if (!ready || player_.way().empty()) return false;
  const auto at = stop_of(demo_.steps[stops_.size()].until);
  if (!at) return false;
  stops_.push_back(*at);
  show(stops_.size() - 1);
  return true;
}

void DemoGuide::next() {
  if (going_ || !reached_ || last()) return;
  if (*reached_ + 1 < stops_.size()) {
    show(*reached_ + 1);
    return;
  }
  if (demo_.steps[*reached_ + 1].until != Until::end && player_.speed() > k_demo_speed) {
    speed_before_ = player_.speed();
    player_.set_speed(k_demo_speed);
  }
  going_ = true;
  player_.to_end();
  player_.play();
}

void DemoGuide::leave() {
  if (speed_before_ && player_.speed() == k_demo_speed) player_.set_speed(*speed_before_);
  speed_before_.reset();
}

void DemoGuide::previous() {
  if (going_ || !reached_ || *reached_ == 0) return;
  show(*reached_ - 1);
}

}  // namespace topple::app
