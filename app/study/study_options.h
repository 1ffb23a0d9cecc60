// What the studies of the command line take.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace topple::app {

struct StudyOptions {
  std::string scene;                   ///< empty for studies that have scenes of their own
  std::vector<std::string> overrides;  ///< KEY=VALUE
  std::string folder;                  ///< created when missing
  std::optional<int> jobs;             ///< runs at a time; absent: 1 where CPU times count, else one per core
  bool quick = false;                  ///< within a time budget
  bool quiet = false;
  std::string x, y;                    ///< KEY=FROM..TO:N, of sweeps; empty: the usual ones
  std::optional<int> ensemble = {};    ///< runs a point or level
  std::optional<double> spread = {};   ///< of the amplitudes of more than one
  std::vector<std::string> vary = {};  ///< FACTOR=DISTRIBUTION
  int seed = 1;                        ///< of what is drawn
  std::optional<double> slide = {};    ///< m, of fragility
  bool resume = false;                 ///< go on with the rows of a sweep that was interrupted
  bool force = false;                  ///< in place of files of any kind
};

}  // namespace topple::app
