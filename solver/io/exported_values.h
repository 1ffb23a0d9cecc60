// What exports compute from the rows of a recording.
#pragma once

#include <cstddef>

#include "solver/io/observer.h"
#include "solver/model.h"

namespace topple::io {

/// Throws InputError when the rows are not those of the model.
void expect_same_model(const Model& model, const FrameRow& row);

struct ElementLoading {
  double stress;      ///< Pa, equivalent_stress() at the stress point
  float yield_ratio;  ///< sqrt(f + 1) (plasticity.h), greatest of the element's ends; 0 where it cannot yield
};
ElementLoading element_loading(const Model& model, const FrameRow& row, std::size_t element);

}  // namespace topple::io
