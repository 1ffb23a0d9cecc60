// Guided demos: a shake, and the instants at which it is stopped and explained.
#pragma once

#include <optional>
#include <span>

#include "app/live/player.h"
#include "app/support/language.h"

namespace topple::app {

/// What a step waits for. end: the run is over, or the body lies on the floor.
enum class Until { start, uplift, impact, critical, end };

struct DemoStep {
  Until until;
  Phrase text;
};

struct Demo {
  Phrase name;
  double frequency, amplitude;  ///< Hz, gal
  std::span<const DemoStep> steps;
};
std::span<const Demo> demos();

/// The scene that they are made for.
inline constexpr const char* k_demo_scene = "paper-a";

/// Whether the floor can shake as a sine of another frequency and amplitude now.
bool can_shake_as_sine(const Player& player);
/// Makes the first shake a sine from now on. `amplitude`: gal.
void shake_as_sine(Player& player, double frequency, double amplitude);

/// Takes a player through a demo, in a branch of its own. Its events are those of the first body that stands
/// freely.
class DemoGuide {
 public:
  DemoGuide(const Demo& demo, Player& player);

  /// Stops where the step under way is reached. True when something changed.
  bool update();
  /// Goes on to the next step, at a quarter of the speed where something is to be seen on the way.
  void next();
  void previous();
  /// Gives the speed back that next() has changed.
  void leave();

  const Demo& demo() const { return demo_; }
  /// Of the step reached last; nothing while the run is on its way to the first.
  std::optional<std::size_t> step() const { return reached_; }
  bool under_way() const { return going_; }
  /// What is to be said of it.
  const Phrase& text() const;
  bool last() const { return reached_ && *reached_ + 1 == demo_.steps.size(); }

 private:
  struct Stop {
    double time;
    bool occurred;  ///< false: the run ended first
  };
  std::optional<Stop> stop_of(Until until) const;
  void show(std::size_t step);

  const Demo& demo_;
  Player& player_;
  const std::int32_t branch_before_;
  const std::int32_t body_;
  std::optional<std::size_t> reached_;
  bool going_ = true;
  std::optional<double> speed_before_;  // next() has changed it
  std::vector<Stop> stops_;             // of the steps reached so far
};

}  // namespace topple::app
