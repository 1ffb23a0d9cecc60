// The subcommands of topple. Each returns an exit code: 0 done, 1 the run failed, 130 interrupted; bad usage
// and bad input leave as BadInput (exit 2).
#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "app/language.h"
#include "app/picture_settings.h"
#include "render/camera.h"
#include "render/off_screen.h"
#include "render/orbit.h"

namespace topple::app {

inline constexpr int k_done = 0;
inline constexpr int k_failed = 1;
inline constexpr int k_bad_input = 2;
inline constexpr int k_interrupted = 130;

/// Bad usage or bad input found by the program itself. what() is one line.
struct BadInput : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct RunOptions {
  std::string scene;
  std::vector<std::string> overrides;  ///< KEY=VALUE
  std::string recording;               ///< empty: none
  std::string json;                    ///< file, "-" or empty
  bool quiet = false;
  bool profile = false;     ///< tells where the time of steps went
  std::optional<int> jobs;  ///< threads; absent: as many as pay
  bool estimate = false;    ///< runs it again at finer steps for the error
};
int run_command(const RunOptions& options);

struct RenderOptions {
  std::string source;                  ///< scene or recording
  std::vector<std::string> overrides;  ///< of a scene
  std::string png, mp4, still;         ///< one of them
  std::optional<double> at;            ///< s, of the still
  int width = 1280, height = 720;
  int fps = 30;
  render::NamedView view = render::NamedView::iso;
  std::optional<render::Orbit> orbit;  ///< instead of `view`; only target, distance and sight are set
  std::optional<std::string> follow;   ///< body the camera goes along with; empty: of `inspect`, or first
  std::optional<double> from, to;      ///< s
  bool ui = false;                     ///< with the panels of the window
  Language language = Language::english;
  PictureSettings picture;  ///< all but `diagram`
  std::string inspect;      ///< BODY or BODY/MEMBER, looked at closely; empty: none
  render::Renderer renderer = render::Renderer::any;
  bool quiet = false;
};
int render_command(const RenderOptions& options);

struct ViewOptions {
  std::string source;                  ///< scene or recording; empty: a person chooses
  std::vector<std::string> overrides;  ///< of a scene
  std::string recording;               ///< where a live run is recorded; empty: in the user's state folder
  std::optional<Language> language;    ///< absent: as kept, or that of the locale
};
int view_command(const ViewOptions& options);

struct ExportOptions {
  std::string recording;
  std::string csv;   ///< folder; or
  std::string xdmf;  ///< file; or
  std::string vtk;   ///< folder
};
int export_command(const ExportOptions& options);

struct RecoverOptions {
  std::string recording;
  std::string output;  ///< empty: NAME.recovered.h5 beside it
};
int recover_command(const RecoverOptions& options);

struct ModesOptions {
  std::string scene;
  std::vector<std::string> overrides;  ///< KEY=VALUE
  int count = 10;                      ///< of each body, rigid ones among them
  std::string json;                    ///< file, "-" or empty
};
int modes_command(const ModesOptions& options);

struct VerifyOptions {
  std::vector<std::string> scenes;  ///< paths or names; empty: all verification scenes
  std::string filter;               ///< empty: every row
  std::string json;                 ///< file, "-" or empty
  bool quiet = false;
};
int verify_command(const VerifyOptions& options);

struct StudyOptions {
  std::string scene;                   ///< empty for studies that have scenes of their own
  std::vector<std::string> overrides;  ///< KEY=VALUE
  std::string folder;                  ///< created when missing
  std::optional<int> jobs;             ///< runs at a time; absent: 1 where CPU times count, else one per core
  bool quick = false;                  ///< within a time budget
  bool quiet = false;
  std::string x, y;     ///< KEY=FROM..TO:N, of sweeps; empty: the usual ones
  int ensemble = 1;     ///< runs a point
  double spread = 0;    ///< of the ensemble's input
  bool resume = false;  ///< go on with the rows of a sweep that was interrupted
};
/// `topple study elements`: the element comparison.
int elements_command(const StudyOptions& options);
/// `topple study penalty`: penalty contact of a scene.
int penalty_command(const StudyOptions& options);
/// `topple study overturn`: who overturns over two keys.
int overturn_command(const StudyOptions& options);
/// `topple study precision`: error against cost of integrators, steps and models.
int precision_command(const StudyOptions& options);
/// `topple study stability`: where time integration fails over two keys.
int stability_command(const StudyOptions& options);

struct CompareOptions {
  std::string a, b;  ///< scenes or recordings
  std::string json;  ///< file, "-" or empty
  std::string mp4;   ///< ghost video; empty: none
  bool quiet = false;
};
int compare_command(const CompareOptions& options);

struct ReportOptions {
  std::string scene;
  std::vector<std::string> overrides;  ///< KEY=VALUE
  std::string file;                    ///< HTML; empty: NAME-report.html in the working folder
  std::string language = "en";         ///< en or ja
  std::optional<int> jobs;             ///< runs at a time; absent: one per core
  bool quiet = false;
};
int report_command(const ReportOptions& options);

int check_command(const std::vector<std::string>& scenes, const std::vector<std::string>& overrides);

struct InfoOptions {
  std::string file;     ///< scene or recording
  std::string json;     ///< file, "-" or empty
  bool verify = false;  ///< run a recording again
};
int info_command(const InfoOptions& options);
int scenes_command();

}  // namespace topple::app
