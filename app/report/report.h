// The page that answers for an engineer: what was shaken how, what falls, how certain that is.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/support/language.h"
#include "solver/io/scene/scene.h"
#include "solver/study/common/intensity.h"
#include "solver/study/common/spread.h"
#include "solver/study/overturn/fragility_study.h"

namespace topple::app {

/// Tilt of one body over the run.
struct TiltCurve {
  std::vector<double> time, tilt;  ///< s, degrees
  /// Degrees: the critical angle where the body passed it last, or came nearest to it; absent: it has none.
  std::optional<double> critical;
};

/// A picture of one frame.
struct KeyPicture {
  enum class Kind { start, falling, most_tilted, end };
  Kind kind = Kind::start;
  double time = 0;       ///< s
  std::size_t body = 0;  ///< that it is about; falling, most_tilted
  double tilt = 0;       ///< degrees, of that body
  std::string png = {};  ///< bytes of the file
  /// Name of a body and where it stands in the picture, percent from the left and from the top.
  struct Label {
    std::size_t body;
    double left, top;
  };
  std::vector<Label> labels = {};
};

/// All that the page shows.
struct Report {
  const io::Scene* scene = nullptr;
  std::string command;                             ///< that made it
  std::vector<std::string> overrides;              ///< KEY=VALUE
  nlohmann::ordered_json summary;                  ///< with "error_estimate"
  study::Motion motion;                            ///< of the floor, until the end of the run
  std::vector<TiltCurve> tilts;                    ///< one per body that is furniture
  std::vector<KeyPicture> pictures;                ///< in the order of time
  std::vector<Vec3> nodes_at_start, nodes_at_end;  ///< m, floor's frame
  double spread = 0;                               ///< of the input of `trials`
  std::vector<study::Trial> trials;                ///< empty: the floor does not shake
  /// null: there is no fragility, as the scene is not run as planar blocks
  std::shared_ptr<const study::FragilityPlan> fragility_plan = {};
  study::FragilityResults fragility = {};
  std::optional<nlohmann::ordered_json> without_anchors;  ///< summary of the run; absent: none is in place
  std::string page = {};                                  ///< page beside the report; empty: none
  bool page_is_live = false;                              ///< it computes, and does not only replay
};

/// The page as one HTML file that refers to nothing outside of it but the page beside it. The same report
/// gives the same text.
std::string report_page(const Report& report, Language language);

}  // namespace topple::app
