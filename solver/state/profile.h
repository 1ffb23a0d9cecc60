// Computing time of steps by phases.
#pragma once

#include <array>

namespace topple {

/// search: candidate pairs; models: model levels; reduced: rigid and elastic bodies; forces..energy: frames.
enum class Phase { other, search, models, reduced, forces, tangent, factor, solve, energy, observe, record };

/// Sums of the time spent in each phase, for one thread. Without a clock nothing is measured.
struct Profile {
  double (*clock)() = nullptr;  ///< s, from any start
  std::array<double, static_cast<int>(Phase::record) + 1> seconds{};
  Phase phase = Phase::other;
  double since = 0;  ///< s, by the clock, when `phase` began

  void enter(Phase next) {
    if (!clock) return;
    const double now = clock();
    if (since > 0) seconds[static_cast<int>(phase)] += now - since;
    since = now;
    phase = next;
  }
};

/// Counts the time of a scope for a phase, and not for the phase around it. `profile` may be null.
class InPhase {
 public:
  InPhase(Profile* profile, Phase phase) : profile_(profile && profile->clock ? profile : nullptr) {
    if (!profile_) return;
    before_ = profile_->phase;
    profile_->enter(phase);
  }
  ~InPhase() {
    if (profile_) profile_->enter(before_);
  }
  InPhase(const InPhase&) = delete;
  InPhase& operator=(const InPhase&) = delete;

 private:
  Profile* profile_;
  Phase before_ = Phase::other;
};

}  // namespace topple
