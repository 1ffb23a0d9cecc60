// Element comparison: error of the three schemes against the number of elements and against CPU time, on
// benchmarks of its own (assets/scenes/elements).
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "solver/model/model.h"
#include "solver/study/common/measure.h"

namespace topple::study {

inline constexpr int k_elements_per_member[] = {2, 4, 8, 16, 32, 64};

/// A number that schemes are judged by, and what it should be.
struct Quantity {
  std::string name;        ///< "elastica-deflection"
  std::string title;       ///< for charts: "Elastica: tip deflection"
  std::string unit;        ///< "m", "rad", "Hz", "1"
  std::string source;      ///< of the reference; like the title without _ ^ { } @ & ~
  bool charted;            ///< has a panel of its own
  int order;               ///< of convergence of midpoint elements
  double reference = 0;    ///< in `unit`
  double uncertainty = 0;  ///< of the reference, relative; 0: exact
};

/// A built-in scene and the quantities that one solution of it gives.
struct Benchmark {
  std::string scene;   ///< "elements/elastica"
  std::string solves;  ///< what one solution is, for the CPU time: "10 load steps"
  std::vector<Quantity> quantities;
};

/// The benchmarks with their references; those without theory are solved for, which takes about a second.
std::vector<Benchmark> element_benchmarks();

/// One quantity of one solution. What the solution did not give is absent.
struct ElementsRow {
  std::string quantity;
  std::string unit;
  Scheme scheme;
  int elements_per_member;
  int elements, unknowns;  ///< of the whole model
  double reference;        ///< in `unit`
  std::optional<double> computed;
  std::optional<double> error;  ///< |computed - reference|/|reference|
  std::optional<double> cpu;    ///< s, of one solution (measure.h), without reading the scene
  std::string status;           ///< completed, diverged, or "not run" when go_on() ended the study
};

struct ElementsStudy {
  std::vector<Benchmark> benchmarks;
  std::vector<ElementsRow> rows;  ///< by quantity, scheme, elements per member
  int solved = 0, of = 0;         ///< solutions
};

struct ElementsSettings {
  int jobs = 1;            ///< solutions at a time
  double timed = k_timed;  ///< s, on each solution's CPU time (measure.h)
};

/// Solves all benchmarks, coarse ones first. go_on(done, of) as for_each_case (parallel.h).
ElementsStudy study_elements(const ElementsSettings& settings,
                             const std::function<bool(int done, int of)>& go_on);

/// The rows as a list of flat objects: the content of elements.csv.
nlohmann::ordered_json rows_as_json(const ElementsStudy& study);

/// The benchmarks with title, unit, reference and its source, by quantity.
nlohmann::ordered_json quantities_as_json(const ElementsStudy& study);

}  // namespace topple::study
