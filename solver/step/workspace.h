// What a step keeps for the next one.
#pragma once

#include <memory>

#include "solver/model/model.h"
#include "solver/state/profile.h"
#include "solver/step/parallel_for.h"

namespace topple {

/// Scratch of the integrators; may be thrown away at any time. Sized for one model.
class Workspace {
 public:
  explicit Workspace(const Model& model);
  ~Workspace();
  Workspace(Workspace&&) noexcept;
  Workspace& operator=(Workspace&&) noexcept;
  /// Islands are stepped by the workers of `parallel`; results are the same bit for bit.
  void share(ParallelFor parallel);
  /// Off until it gets a clock; then steps take one thread.
  Profile& profile();
  struct Impl;
  Impl& impl() { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace topple
