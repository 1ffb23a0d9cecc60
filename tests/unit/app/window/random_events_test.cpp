// The complete window under events that nobody planned. The linker leads Dear ImGui's assertions, its items
// and the frames that are drawn through here; what the program opens for writing is listened to as well.
//   TOPPLE_SEEDS=20 tests/random_events_test   tries so many
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>

#include <cmath>
#include <cstdarg>
#include <deque>
#include <mutex>
#include <numeric>
#include <random>
#include <set>

#include "app/chart/theme.h"
#include "app/picture/window_words.h"
#include "solver/io/recording/recording.h"
#include "unit/app/shell_fixture.h"

namespace {

/// What can be clicked in the newest frame.
struct Item {
  ImGuiID id;
  ImRect box;
};
std::vector<Item> items;
int frame_of_items = -1;
std::set<std::string> twice;
std::string not_finite;
std::mutex written_mutex;
std::set<std::string> written;
bool listening = false;
const int no_cache = setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);  // the driver's own files

void note_written(const char* path) {
  if (!listening || std::string_view(path).starts_with("/dev/") ||
      std::string_view(path).starts_with("/proc/"))
    return;
  std::error_code ignored;
  const std::string full = std::filesystem::absolute(path, ignored).lexically_normal().string();
  const std::lock_guard lock(written_mutex);
  written.insert(full);
}

std::string place_of(const ImRect& box) {
  return std::to_string(static_cast<int>(box.Min.x)) + "," + std::to_string(static_cast<int>(box.Min.y));
}

template <typename... T>
bool finite(const T&... values) {
  return (std::isfinite(values) && ...);
}
bool finite_all(const topple::render::Float3& p) {
  return finite(p[0], p[1], p[2]);
}
bool finite_all(const topple::render::Station& s) {
  return finite_all(s.position) &&
         finite(s.rotation[0], s.rotation[1], s.rotation[2], s.rotation[3], s.value);
}
template <typename Values>
void expect_finite(const char* what, const Values& values) {
  for (const auto& value : values)
    if (!finite_all(value)) not_finite = what;
}

}  // namespace

extern "C" {
void __wrap___assert_fail(const char* what, const char* file, unsigned line, const char*) {
  throw std::logic_error(std::string(file) + ":" + std::to_string(line) + ": " + what);
}

// bool ImGui::ItemAdd(const ImRect&, ImGuiID, const ImRect*, ImGuiItemFlags)
bool __real__ZN5ImGui7ItemAddERK6ImRectjPS1_i(const ImRect&, ImGuiID, const ImRect*, int);
bool __wrap__ZN5ImGui7ItemAddERK6ImRectjPS1_i(const ImRect& box, ImGuiID id, const ImRect* nav, int flags) {
  if (std::exchange(frame_of_items, ImGui::GetFrameCount()) != ImGui::GetFrameCount()) items.clear();
  if (id != 0) {
    for (const Item& item : items)
      if (item.id == id)
        twice.insert(std::string(ImGui::GetCurrentWindow()->Name) + " at " + place_of(item.box) + " and " +
                     place_of(box));
    items.push_back({id, box});
  }
  return __real__ZN5ImGui7ItemAddERK6ImRectjPS1_i(box, id, nav, flags);
}

// void topple::render::Stage::draw_scene(const SceneFrame&, const Camera&, ColourMap, int, int, Quality)
using topple::render::Camera;
using topple::render::ColourMap;
using topple::render::Quality;
using topple::render::SceneFrame;
using topple::render::Stage;
void __real__ZN6topple6render5Stage10draw_sceneERKNS0_10SceneFrameERKNS0_6CameraENS0_9ColourMapEiiNS0_7QualityE(
    Stage*, const SceneFrame&, const Camera&, ColourMap, int, int, Quality);
void __wrap__ZN6topple6render5Stage10draw_sceneERKNS0_10SceneFrameERKNS0_6CameraENS0_9ColourMapEiiNS0_7QualityE(
    Stage* stage, const SceneFrame& frame, const Camera& camera, ColourMap map, int width, int height,
    Quality quality) {
  expect_finite("stations", frame.stations);
  expect_finite("ghost", frame.ghost_stations);
  for (const auto& panel : frame.panels) expect_finite("panels", panel.corners);
  for (const auto& trail : frame.trails) expect_finite("trails", trail.points);
  for (const auto& band : frame.bands) expect_finite("diagram", band.edge);
  for (const auto& arrow : frame.arrows) expect_finite("arrows", std::array{arrow.from, arrow.to});
  for (const auto& ring : frame.rings) expect_finite("rings", std::array{ring.centre, ring.axis});
  if (!finite(frame.legend.minimum, frame.legend.maximum, frame.legend.mark)) not_finite = "legend";
  if (!camera.view.allFinite() || !camera.projection.allFinite()) not_finite = "camera";
  __real__ZN6topple6render5Stage10draw_sceneERKNS0_10SceneFrameERKNS0_6CameraENS0_9ColourMapEiiNS0_7QualityE(
      stage, frame, camera, map, width, height, quality);
}

// What the C++ and HDF5 libraries open their files with; these come first.
int watched_open(const char* path, int flags, ...) __asm__("open");
int watched_open64(const char* path, int flags, ...) __asm__("open64");
FILE* watched_fopen(const char* path, const char* mode) __asm__("fopen");
FILE* watched_fopen64(const char* path, const char* mode) __asm__("fopen64");
int watched_mkdir(const char* path, mode_t mode) __asm__("mkdir");

static int pass_open(const char* name, const char* path, int flags, mode_t mode) {
  if ((flags & O_ACCMODE) != O_RDONLY || (flags & O_CREAT)) note_written(path);
  return reinterpret_cast<int (*)(const char*, int, ...)>(dlsym(RTLD_NEXT, name))(path, flags, mode);
}
static mode_t mode_of(int flags, va_list rest) {
  return flags & (O_CREAT | O_TMPFILE) ? va_arg(rest, mode_t) : 0;
}
int watched_open(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = mode_of(flags, rest);
  va_end(rest);
  return pass_open("open", path, flags, mode);
}
int watched_open64(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = mode_of(flags, rest);
  va_end(rest);
  return pass_open("open64", path, flags, mode);
}
static FILE* pass_fopen(const char* name, const char* path, const char* mode) {
  if (std::string_view(mode).find_first_of("wa+") != std::string_view::npos) note_written(path);
  return reinterpret_cast<FILE* (*)(const char*, const char*)>(dlsym(RTLD_NEXT, name))(path, mode);
}
FILE* watched_fopen(const char* path, const char* mode) {
  return pass_fopen("fopen", path, mode);
}
FILE* watched_fopen64(const char* path, const char* mode) {
  return pass_fopen("fopen64", path, mode);
}
int watched_mkdir(const char* path, mode_t mode) {
  note_written(path);
  return reinterpret_cast<int (*)(const char*, mode_t)>(dlsym(RTLD_NEXT, "mkdir"))(path, mode);
}
}

namespace topple::app {
namespace {

constexpr int k_events = 1200;

class RandomEvents : public ShellTest, public ::testing::WithParamInterface<unsigned> {
 protected:
  RandomEvents() : rng_(GetParam()), before_(fs::current_path()) {
    for (const char* name : {"work", "home", "config"}) fs::create_directory(scratch_ / name);
    fs::current_path(scratch_ / "work");
    setenv("HOME", (scratch_ / "home").c_str(), 1);
    setenv("XDG_CONFIG_HOME", (scratch_ / "config").c_str(), 1);
    connect_keyboard();
    std::string broken = k_rocking;
    broken.replace(broken.find("300 gal"), 7, "300 kg");
    drops_ = {write("good.toml", k_rocking),
              write("straps.toml", k_rocking + k_straps),
              write("diverges.toml", k_rocking + "model = \"frame\"\n"),
              write("broken.toml", broken),
              write("cut.toml", k_rocking.substr(0, 300)),
              write("empty.toml", ""),
              write("damaged.h5", "\x89HDF\r\n\x1a\nand nothing more"),
              write("quake.AT2",
                    "PEER NGA STRONG MOTION DATABASE RECORD\nSomewhere\nACCELERATION TIME SERIES IN UNITS OF "
                    "G\nNPTS= 6, DT= .02000 SEC\n 0.0 0.1 0.2 0.1 0.0 -0.1\n"),
              write("short.AT2", "PEER\n"),
              (scratch_ / "work").string(),
              (scratch_ / "not-there.toml").string(),
              "paper-a"};
    written.clear();
    not_finite.clear();
    items.clear();
    twice.clear();
    listening = true;
  }
  ~RandomEvents() override {
    listening = false;
    fs::current_path(before_);
    window_language() = Language::english;
    window_is_dark() = false;
  }

  std::size_t below(std::size_t n) { return n == 0 ? 0 : rng_() % n; }
  bool one_in(std::size_t n) { return below(n) == 0; }
  template <typename T>
  const T& any(const std::vector<T>& all) {
    return all[below(all.size())];
  }
  void note(const std::string& words) {
    said_.push_back(words);
    if (said_.size() > 12) said_.pop_front();
  }

  void frame() override {
    ShellTest::frame();
    const ImDrawData& data = *ImGui::GetDrawData();
    for (int i = 0; i < data.CmdListsCount; ++i)
      for (const ImDrawVert& v : data.CmdLists[i]->VtxBuffer)
        if (!finite(v.pos.x, v.pos.y, v.uv.x, v.uv.y)) not_finite = "interface";
    if (const ImGuiID id = ImGui::GetActiveID()) used_.insert(id);
  }

  /// A place in the window: often on something.
  ImVec2 place() {
    if (!items.empty() && !one_in(4)) {
      const ImRect& box = any(items).box;
      return {box.Min.x + box.GetWidth() * static_cast<float>(below(11)) / 10,
              box.Min.y + box.GetHeight() * static_cast<float>(below(11)) / 10};
    }
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    return {static_cast<float>(below(static_cast<std::size_t>(size.x) + 20)) - 10,
            static_cast<float>(below(static_cast<std::size_t>(size.y) + 20)) - 10};
  }
  std::size_t button() { return one_in(5) ? 1 + below(2) : 0; }

  // A person may write any file; these events keep to their folder.
  void stay_in_folder() {
    for (char* const path : {shell_->save_dialog().path, shell_->export_dialog().path}) {
      const bool here = std::string_view(path).starts_with(scratch_.path().string() + "/");
      if (path[0] == '/' && !here) {
        tap(GLFW_KEY_ESCAPE, false, false);
        std::snprintf(path, 4096, "somewhere");
      }
    }
  }
  void press_mouse() {
    stay_in_folder();
    ImGuiIO& io = ImGui::GetIO();
    const std::size_t which = button();
    io.KeyCtrl = one_in(12);
    io.KeyShift = one_in(12);
    io.MouseDown[which] = true;
    frame();
    if (one_in(3))
      for (std::size_t i = 1 + below(4); i > 0; --i) {
        const ImVec2 to = one_in(4) ? place() : io.MousePos;
        io.MousePos = {to.x + static_cast<float>(below(101)) - 50, to.y + static_cast<float>(below(61)) - 30};
        frame();
      }
    io.MouseDown[which] = false;
    io.KeyCtrl = io.KeyShift = false;
    frame();
  }

  void some_key() {
    static const std::vector<int> k_keys = {' ',
                                            ',',
                                            '.',
                                            '[',
                                            ']',
                                            'R',
                                            'L',
                                            'C',
                                            'Z',
                                            '1',
                                            '2',
                                            '3',
                                            '4',
                                            'F',
                                            'Q',
                                            'A',
                                            'P',
                                            'O',
                                            'S',
                                            'E',
                                            'D',
                                            '0',
                                            '+',
                                            '-',
                                            '=',
                                            'V',
                                            'X',
                                            'Y',
                                            GLFW_KEY_HOME,
                                            GLFW_KEY_END,
                                            GLFW_KEY_ESCAPE,
                                            GLFW_KEY_ESCAPE,
                                            GLFW_KEY_F1,
                                            GLFW_KEY_F6,
                                            GLFW_KEY_TAB,
                                            GLFW_KEY_ENTER,
                                            GLFW_KEY_KP_ENTER,
                                            GLFW_KEY_LEFT,
                                            GLFW_KEY_RIGHT,
                                            GLFW_KEY_UP,
                                            GLFW_KEY_DOWN,
                                            GLFW_KEY_BACKSPACE,
                                            GLFW_KEY_DELETE,
                                            GLFW_KEY_PAGE_DOWN,
                                            GLFW_KEY_KP_ADD,
                                            GLFW_KEY_KP_SUBTRACT,
                                            'Q'};
    const int key = any(k_keys);
    const bool control = one_in(3), shift = one_in(5);
    note("key " + std::to_string(key) + (control ? " control" : "") + (shift ? " shift" : ""));
    stay_in_folder();
    tap(key, control, shift);
  }
  void some_text() {
    static const std::vector<unsigned> k_letters = {'0', '1',  '2',  '5',    '9',    '.',    '-',
                                                    'e', '+',  ' ',  'a',    'p',    'n',    '%',
                                                    '"', '\\', 0xe9, 0x5730, 0x9707, 0x1f600};
    note("text");
    for (std::size_t i = below(6) + 1; i > 0; --i) ImGui::GetIO().AddInputCharacter(any(k_letters));
    frame();
  }
  void some_size() {
    static const std::vector<ImVec2> k_sizes = {{1280, 720}, {960, 540}, {640, 360},
                                                {400, 700},  {200, 120}, {640, 361}};
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = any(k_sizes);
    io.DisplayFramebufferScale = one_in(6) ? ImVec2(2, 2) : ImVec2(1, 1);
    note("size " + std::to_string(io.DisplaySize.x) + " x " + std::to_string(io.DisplaySize.y));
    frame();
  }
  void some_drop() {
    std::vector<std::string> dropped{any(drops_)};
    if (shell_->session() && one_in(4)) dropped = {shell_->session()->recording()};
    if (one_in(8)) dropped.push_back(any(drops_));
    note("drop " + dropped[0]);
    shell_->drop(dropped);
    frame();
    if (one_in(2))
      for (int i = 0; i < 2000 && shell_->opening(); ++i) {
        frame();
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
  }
  void some_view() {
    if (!shell_->session()) return;
    Viewer& viewer = shell_->session()->viewer();
    const Model& model = shell_->session()->scene().setup.model;
    const std::size_t tab = below(6);
    note("tab " + std::to_string(tab));
    if (tab < 4)
      viewer.show(static_cast<Viewer::Tab>(tab));
    else if (tab == 4)
      viewer.inspect(Subject{Subject::Kind::member, below(model.members.size())});
    else
      viewer.inspect(Subject{Subject::Kind::body, below(static_cast<std::size_t>(model.furniture_total()))});
    frame();
  }
  void some_time() {
    note("time");
    if (shell_->session() && one_in(2)) player().play();
    for (std::size_t i = below(12); i > 0; --i) frame();
  }
  void one_event() {
    const std::size_t kind = below(100);
    if (shell_->message() && one_in(5)) {
      note("escape");
      tap(GLFW_KEY_ESCAPE, false, false);
    } else if (kind < 28) {
      some_key();
    } else if (kind < 72) {
      ImGui::GetIO().MousePos = place();
      note("mouse at " + std::to_string(ImGui::GetIO().MousePos.x) + ", " +
           std::to_string(ImGui::GetIO().MousePos.y));
      frame();
      if (kind >= 34) press_mouse();
    } else if (kind < 76) {
      note("wheel");
      ImGui::GetIO().MouseWheel = static_cast<float>(below(11)) - 5;
      frame();
    } else if (kind < 82) {
      some_text();
    } else if (kind < 84) {
      some_size();
    } else if (kind < 86) {
      some_drop();
    } else if (kind < 94) {
      some_view();
    } else {
      some_time();
    }
  }
  std::string story() const {
    std::string all = "the last events:";
    for (const std::string& one : said_) all += "\n  " + one;
    return all;
  }

  std::mt19937 rng_;
  const fs::path before_;
  std::vector<std::string> drops_;
  std::deque<std::string> said_;
  std::set<ImGuiID> used_;
};

TEST_P(RandomEvents, leave_a_window_that_works_and_no_file_elsewhere) {
  shell_->choose_scene();
  frame();
  shell_->open(drops_[0]);
  ASSERT_TRUE(until([&] { return ready(); }));
  player().play();
  for (int event = 0; event < k_events; ++event) {
    ASSERT_NO_THROW(one_event()) << "event " << event << ", " << story();
    ASSERT_TRUE(twice.empty()) << "two items are one in " << *twice.begin() << ", event " << event << ", "
                               << story();
    ASSERT_EQ(not_finite, "") << "event " << event << ", " << story();
    if (event % 50 != 0) continue;
    const render::Surface surface = shell_->surface();
    const render::Image image = stage_.shot(surface, *ImGui::GetDrawData());
    ASSERT_EQ(image.width, surface.width);
  }
  EXPECT_GT(used_.size(), 40u);  // it got about
  for (int i = 0;
       i < 10 && (shell_->message() || shell_->save_dialog().is_open() || shell_->chooser().is_open() ||
                  shell_->export_dialog().is_open() || shell_->opening());
       ++i) {
    ASSERT_TRUE(until([&] { return !shell_->opening(); }));
    tap(GLFW_KEY_ESCAPE, false, false);
  }
  shell_->open(drops_[0]);
  ASSERT_TRUE(until([&] { return !shell_->opening() && ready(); }));
  run_to(0.1);
  shell_->close("stopped");
  for (const auto& file : fs::directory_iterator(scratch_ / "state/topple"))
    if (file.path().extension() == ".h5") {
      EXPECT_NO_THROW(io::Recording(file.path().string()));
    }
  const std::string folder = scratch_.path().string();
  for (const std::string& path : written) EXPECT_TRUE(path.starts_with(folder)) << path;
}

std::vector<unsigned> seeds() {
  const char* const count = std::getenv("TOPPLE_SEEDS");
  std::vector<unsigned> all(count ? std::strtoul(count, nullptr, 10) : 1);
  std::iota(all.begin(), all.end(), 1u);
  return all;
}
INSTANTIATE_TEST_SUITE_P(Seeds, RandomEvents, ::testing::ValuesIn(seeds()));

}  // namespace
}  // namespace topple::app
