#include "app/window/shell.h"

#include <imgui.h>

#include <cmath>
#include <filesystem>
#include <utility>

#include "app/panels/shell_words.h"
#include "app/picture/solid_bodies.h"
#include "app/support/terms.h"
#include "solver/io/recording/recording.h"

namespace topple::app {
namespace {

namespace fs = std::filesystem;
namespace ww = window_words;

constexpr int k_frames_of_news =
    4;  // a panel knows its height after it was drawn, and its picture comes later

Box whole_window() {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  return {0, 0, size.x, size.y};
}

}  // namespace

Shell::Shell(render::Stage& stage, float scale, std::function<void()> wake, std::string program,
             const Appearance& appearance, Viewer::Keep keep)
    : stage_(stage),
      scale_(scale),
      wake_(std::move(wake)),
      program_(std::move(program)),
      appearance_(appearance),
      applied_(appearance),
      keep_(std::move(keep)),
      own_fonts_(set_up_interface(stage, scale, appearance, nullptr)),
      chooser_(stage, wake_),
      exports_(program_) {}

Shell::~Shell() {
  close("interrupted");
}

std::vector<LiveStatus> Shell::close(const std::string& status) {
  keep_room();
  std::vector<LiveStatus> all = std::move(ended_);
  if (session_) {
    std::unique_ptr<LiveRun> run = Session::leave(std::move(session_));
    const LiveStatus last = run->close(status);
    for (std::future<LiveStatus>& one : closing_) all.push_back(one.get());
    all.push_back(last);
  } else {
    for (std::future<LiveStatus>& one : closing_) all.push_back(one.get());
  }
  closing_.clear();
  return all;
}

void Shell::show(LiveSource source, const std::string& path) {
  const bool unrecorded = source.output.empty();
  PictureSettings settings;
  settings.bodies = usual_bodies(*source.scene);
  bool loop = false;
  if (session_) {
    if (source.scene && source.scene->name == session_->scene().name)
      settings = session_->viewer().settings();  // those of another scene would mislead
    settings.range = settings.range == RangePolicy::fixed ? RangePolicy::run : settings.range;
    loop = session_->player().loop();
    appearance_ = session_->viewer().appearance();
    closing_.push_back(std::async(
        std::launch::async, [run = Session::leave(std::move(session_))] { return run->close("stopped"); }));
  }
  applied_.reset();
  furnishing_ = false;
  if (!shaking_) {
    keep_room();
    room_.reset();
  }
  before_ = shaken_ = shaking_ ? source.scene.get() : nullptr;
  if (shaking_) {
    ran_ = source.scene->text;
    sliders_ = source.scene->setup.parameters;
  }
  session_ =
      std::make_unique<Session>(std::move(source), path, stage_, scale_, settings, appearance_, keep_, wake_);
  session_->player().set_loop(loop);
  shown_failure_.clear();
  shown_trouble_.clear();
  message_.reset();
  chooser_.close();
  save_.close();
  if (!path.empty()) remember_recent(path);
  if (unrecorded) message_ = {say(ww::k_not_recorded), say(ww::k_no_state_folder), ""};
}

void Shell::open_in_background(const std::string& what, const std::string& path,
                               std::function<LiveSource()> read) {
  opening_path_ = path;
  shaking_ = false;
  opening_.emplace(what, std::move(read), wake_);
}

void Shell::open(const std::string& source) {
  std::error_code ignored;
  const bool file = fs::exists(source, ignored);
  open_in_background(
      file ? fs::path(source).filename().string() : source, file ? source : "", [source, program = program_] {
        return open_source({.source = source, .overrides = {}, .recording = {}, .language = {}}, program);
      });
}

void Shell::drop(const std::vector<std::string>& paths) {
  if (paths.empty()) return;
  const std::string& first = paths.front();
  std::error_code ignored;
  const bool scene = fs::path(first).extension() == ".toml" || fs::is_directory(first, ignored);
  if (scene || io::is_recording(first)) {
    open(first);
  } else if (!session_) {
    message_ = {say(ww::k_not_opened), say(ww::k_record_needs_scene, first), ""};
  } else {
    // The copy is of the scene as it is read, so that it still holds when something else is opened meanwhile.
    const auto present = std::make_shared<const io::Scene>(session_->scene());
    open_in_background(fs::path(first).filename().string(), "",
                       [present, paths] { return open_records(*present, paths); });
  }
}

bool Shell::finish_opening() {
  if (!opening_ || !opening_->done()) return false;
  Opening done = std::move(*opening_);
  opening_.reset();
  try {
    LiveSource source = done.take();
    std::optional<EarlierRun> before;
    if (shaking_ && session_ && before_ == &session_->scene() && !room_->is_another()) {
      const bool changed = session_->scene().text != room_->room().text();
      if (changed && session_->player().way().size() > 1)
        before = EarlierRun(session_->scene_ptr(), session_->player());
      else
        before = session_->viewer().take_earlier();
    }
    show(std::move(source), opening_path_);
    if (shaking_) {
      room_->begin_run();
      session_->viewer().look(room_->orbit());
      PictureSettings settings = session_->viewer().settings();
      settings.bodies = Bodies::solid;  // as the room was seen
      session_->viewer().choose_settings(settings);
      if (before) session_->viewer().show_beside(*std::move(before));
      session_->player().play();
    }
    shaking_ = false;
  } catch (const std::exception& error) {
    shaking_ = false;
    message_ = {say(ww::k_not_opened), error.what(), session_ ? say(ww::k_kept_open) : ""};
  }
  return true;
}

bool Shell::update(double wall_s) {
  bool news = finish_opening();
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  if (const Appearance fits = fitting(appearance_, scale_, size.x, size.y); !session_ && fits != applied_) {
    own_fonts_ = set_up_interface(stage_, scale_, fits, nullptr);
    applied_ = fits;
    news = true;
  }
  if (chooser_.is_open()) news = chooser_.update() || news;
  news = files_.update() || news;
  news = exports_.update() || news;
  if (const std::string words = exports_.take_news(); !words.empty()) {
    if (session_) session_->viewer().show_message(words);
    if (furnishing_) room_->show_message(words);
  }
  if (session_) session_->viewer().show_work(exports_.in_words());
  std::erase_if(closing_, [&](std::future<LiveStatus>& one) {
    if (one.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
    ended_.push_back(one.get());
    if (const std::string& failure = ended_.back().record_failure; !failure.empty())
      message_ = {say(ww::k_record_broke_off), failure, ""};
    return true;
  });
  bool seen = session_ && session_->viewer().update(wall_s);
  if (furnishing_) seen = room_->update(wall_s) || seen;
  if (session_) watch_trouble();
  if (demo_) start_demo();
  const std::array over{message_.has_value(), files_.is_open(), save_.is_open(), export_.is_open(),
                        chooser_.is_open()};
  if (news || std::exchange(over_, over) != over) frames_due_ = k_frames_of_news;
  if (frames_due_ > 0) --frames_due_;
  return news || seen || opening_ || frames_due_ > 0;
}

// In its own scene, which is opened once unless it is there and can be shaken.
void Shell::start_demo() {
  if (opening_ || !session_) return;
  Player& player = session_->player();
  const bool there = session_->scene().name == k_demo_scene && !player.replay();
  if (there) player.to_end();
  if (there && can_shake_as_sine(player)) {
    session_->viewer().guide(demo_->which, before_demo_, scene_before_demo_);
    demo_.reset();
  } else if (!std::exchange(demo_->opened, true)) {
    // a furnished room is in no file that opens it anew, but its run was recorded
    scene_before_demo_ = session_->scene().name;
    before_demo_ = shaken_ == &session_->scene() ? session_->recording() : session_->source();
    open(k_demo_scene);
  } else if (!there) {
    demo_.reset();  // something else was opened meanwhile
  }
}

// Each is shown once.
void Shell::watch_trouble() {
  const LiveStatus& status = session_->player().status();
  if (status.record_failure != std::exchange(shown_failure_, status.record_failure) &&
      !shown_failure_.empty())
    message_ = {say(ww::k_record_broke_off), shown_failure_, say(ww::k_record_kept)};
  const bool failed = status.kind == LiveStatus::Kind::failed, ended = status.kind == LiveStatus::Kind::ended;
  const std::string trouble = failed || ended ? status.message : "";
  if (trouble == std::exchange(shown_trouble_, trouble) || trouble.empty()) return;
  const auto row = session_->player().row();
  const bool begun = (row && row->step > 0) || status.element >= 0;
  message_ = {say(!failed ? ww::k_program_failed
                  : begun ? ww::k_diverged
                          : ww::k_not_begun),
              trouble,
              !failed                                       ? ""
              : !begun                                      ? say(ww::k_not_begun_about)
              : is_static(session_->player().scene().setup) ? say(ww::k_path_failed_about)
                                                            : say(ww::k_diverged_about),
              session_->player().can_halve_step()};
}

bool Shell::covered() const {
  return message_ || files_.is_open() || save_.is_open() || export_.is_open() || chooser_.is_open() ||
         opening_;
}

void Shell::ask(ShellRequest request) {
  if (request == ShellRequest::scenes) chooser_.open();
  if (request == ShellRequest::new_room) furnish_new_room();
  if (request == ShellRequest::shake) shake_room();
  if (request == ShellRequest::furnish) furnish();
  if (furnishing_ && request == ShellRequest::save) {
    try {
      save_.open(to_save_.emplace(room_->room().loader()()));
    } catch (const io::InputError& error) {
      room_->room().refuse(error.what());
    }
  }
  if (!session_ || furnishing_) return;
  if (request == ShellRequest::save) save_.open(session_->scene());
  if (request == ShellRequest::export_view) export_.open(session_->player());
}

void Shell::press(const render::KeyPress& press) {
  if (press.control && press.key == 'Q') {
    wants_to_close_ = true;
  } else if (press.key == render::key::f11) {
    full_screen_ = true;
  } else if (message_) {
    if (press.key == render::key::escape || press.key == render::key::enter) message_.reset();
  } else if (files_.is_open()) {
    files_.press(press);
  } else if (save_.is_open()) {
    press.key == render::key::escape ? save_.close() : save_.press(press);
  } else if (export_.is_open()) {
    if (press.key == render::key::escape) export_.close();
  } else if (chooser_.is_open()) {
    if (press.key != render::key::escape)
      chooser_.press(press);
    else if (session_ || furnishing_)
      chooser_.close();
  } else if (press.control && press.key == 'O') {
    ask(ShellRequest::scenes);
  } else if (press.control && press.key == 'S') {
    ask(ShellRequest::save);
  } else if (furnishing_) {
    press_in_room(press);
  } else if (press.control && press.key == 'E') {
    ask(ShellRequest::export_view);
  } else if (press.key == render::key::f2 && !ImGui::GetIO().WantTextInput) {
    ask(ShellRequest::furnish);
  } else if (session_) {
    session_->viewer().press(press);
  }
}

const render::OverlayFonts& Shell::fonts() const {
  return session_ ? session_->viewer().fonts() : own_fonts_;
}

void Shell::build() {
  if (furnishing_) return build_room();
  if (!session_) {
    build_over();
    ImGui::Render();
    return;
  }
  if (covered() || !exports_.empty())
    session_->viewer().build([this] { build_over(); }, covered());
  else
    session_->viewer().build();
  if (covered()) return;
  ask(session_->viewer().asked());
  const TeachingState& teaching = session_->viewer().teaching();
  if (teaching.wanted) demo_ = {*teaching.wanted, false};
  if (teaching.back) open(teaching.came_from);
}

void Shell::build_over() {
  const Box window = whole_window();
  if (!covered() && (furnishing_ || session_))
    exports_.draw(furnishing_ ? room_->scene_box() : session_->viewer().scene_box(), fonts());
  if (files_.is_open()) {
    files_.draw(window, fonts());
  } else if (chooser_.is_open()) {
    chooser_.draw(window, fonts());
    if (const auto choice = chooser_.take_choice()) open(*choice);
    if (chooser_.take_new_room()) furnish_new_room();
    if (chooser_.take_browse()) browse();
  } else if (save_.is_open() && furnishing_) {
    const std::string saved = save_.draw(*to_save_, to_save_->setup.parameters, window, fonts());
    if (!saved.empty()) {
      remember_recent(save_.path);
      room_->show_message(saved);
      kept_room_ = room_->room().text();
    }
  } else if (save_.is_open()) {
    const std::string saved = save_.draw(session_->scene(), session_->player().parameters(), window, fonts());
    if (!saved.empty()) {
      remember_recent(save_.path);
      session_->viewer().saved_as(fs::path(save_.path).stem().string());
      session_->viewer().show_message(saved);
    }
  } else if (export_.is_open()) {
    export_.draw(session_->player(), session_->viewer(), session_->recording(), window, fonts());
  }
  if (message_) answer_message();
  if (opening_) draw_opening(window);
}

void Shell::browse() {
  std::error_code ignored;
  const std::vector<std::string> recent = recent_files();
  const std::string start = recent.empty() ? fs::current_path(ignored).string() + '/' : recent.front();
  files_.ask({false, say(ww::k_open_file), start, {".toml", ".h5", ".hdf5"}},
             [this](const std::string& path) { open(path); });
}

void Shell::answer_message() {
  const Answer answer = draw_message(*message_, whole_window(), fonts());
  if (answer == Answer::none) return;
  if (answer == Answer::halve_step) session_->player().halve_step_and_retry();
  message_.reset();
}

void Shell::draw_opening(const Box& window) {
  const float unit = fonts().small->FontSize / 14;
  ImGui::SetNextWindowPos({window.width / 2, window.height / 2}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {22 * unit, 14 * unit});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 1);
  ImGui::Begin("opening", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoInputs);
  ImGui::PopStyleVar(2);
  ImGui::TextUnformatted(say(ww::k_opening, opening_->what()).c_str());
  ImGui::End();
}

render::Surface Shell::surface() const {
  if (furnishing_) return room_->surface();
  if (session_) return session_->viewer().surface();
  render::Surface nothing_open = surface_with_scene({});
  nothing_open.background = render::Surface{}.background;
  return nothing_open;
}

void Shell::report_frame_time(double ms) {
  if (session_) session_->viewer().report_frame_time(ms);
}

std::string Shell::title() const {
  if (furnishing_) return "topple: " + room_->room().scene().name;
  return session_ ? "topple: " + session_->scene().name : "topple";
}

}  // namespace topple::app
