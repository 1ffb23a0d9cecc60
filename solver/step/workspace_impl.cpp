#include "solver/step/workspace_impl.h"

#include <utility>

namespace topple {

Workspace::Workspace(const Model& model) : impl_(std::make_unique<Impl>(model)) {}
Workspace::~Workspace() = default;
Workspace::Workspace(Workspace&&) noexcept = default;
Workspace& Workspace::operator=(Workspace&&) noexcept = default;

void Workspace::share(ParallelFor parallel) {
  impl_->scratches.resize(parallel.workers);
  impl_->parallel = std::move(parallel);
}

Profile& Workspace::profile() {
  return impl_->profile;
}

}  // namespace topple
