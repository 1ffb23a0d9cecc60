#include "app/python/signals.h"

#include <pybind11/pybind11.h>

namespace topple::python {

bool Signals::raised() {
  constexpr std::chrono::milliseconds interval{50};
  const auto now = std::chrono::steady_clock::now();
  if (raised_ || now - asked_ < interval) return raised_;
  asked_ = now;
  const pybind11::gil_scoped_acquire gil;
  raised_ = PyErr_CheckSignals() != 0;
  return raised_;
}

void Signals::rethrow() const {
  if (raised_) throw pybind11::error_already_set();
}

}  // namespace topple::python
