#include "render/gl/window.h"

#include <imgui.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui/backends/imgui_impl_glfw.h>

#include <cstdlib>
#include <stdexcept>
#include <utility>

namespace topple::render {
namespace {

constexpr int k_least_width = 960;
constexpr int k_least_height = 540;

std::string glfw_error() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text != nullptr ? text : "unknown error";
}

[[noreturn]] void refuse(const char* what) {
  throw std::runtime_error(std::string(what) + ": " + glfw_error() + "; topple render draws without one");
}

/// GLFW from the first to the last use of it.
struct Library {
  Library() {
#ifdef GLFW_PLATFORM  // from 3.4 on; without this folder there is no Wayland, and its library says so on
                      // stderr
    if (std::getenv("XDG_RUNTIME_DIR") == nullptr) glfwInitHint(GLFW_PLATFORM, GLFW_PLATFORM_X11);
#endif
    if (!glfwInit()) refuse("no display");
  }
  ~Library() {
    glfwTerminate();
  }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;
};

}  // namespace

struct Window::Parts {
  Parts(const std::string& title, int width, int height) {
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    glfwWindowHint(GLFW_DEPTH_BITS, 0);  // the scene is drawn off screen
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    glfwWindowHintString(GLFW_X11_CLASS_NAME, "topple");
    glfwWindowHintString(GLFW_X11_INSTANCE_NAME, "topple");
    window = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
    if (window == nullptr) refuse("no window");
    glfwSetWindowSizeLimits(window, k_least_width, k_least_height, GLFW_DONT_CARE, GLFW_DONT_CARE);
    glfwSetWindowUserPointer(window, this);
    note_whatever_happens();
  }
  ~Parts() {
    if (imgui != nullptr) {
      ImGuiContext* other = ImGui::GetCurrentContext();
      ImGui::SetCurrentContext(imgui);
      ImGui_ImplGlfw_Shutdown();
      ImGui::SetCurrentContext(other);
    }
    glfwDestroyWindow(window);
  }
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;

  // Dear ImGui's callbacks, installed later, call these.
  void note_whatever_happens() {
    static constexpr auto note = [](GLFWwindow* w, auto...) {
      static_cast<Parts*>(glfwGetWindowUserPointer(w))->input = true;
    };
    glfwSetCursorPosCallback(window, note);
    glfwSetCursorEnterCallback(window, note);
    glfwSetMouseButtonCallback(window, note);
    glfwSetScrollCallback(window, note);
    glfwSetKeyCallback(window, note_key);
    glfwSetCharCallback(window, note);
    glfwSetWindowFocusCallback(window, note);
    glfwSetWindowIconifyCallback(window, note);
    glfwSetWindowContentScaleCallback(window, note);
    glfwSetFramebufferSizeCallback(window, note);
    glfwSetWindowRefreshCallback(window, note);
    glfwSetWindowCloseCallback(window, note);
    glfwSetDropCallback(window, [](GLFWwindow* w, int count, const char** paths) {
      Parts& parts = *static_cast<Parts*>(glfwGetWindowUserPointer(w));
      parts.input = true;
      parts.drops.insert(parts.drops.end(), paths, paths + count);
    });
  }

  static void note_key(GLFWwindow* w, int code, int scancode, int action, int modifiers) {
    Parts& parts = *static_cast<Parts*>(glfwGetWindowUserPointer(w));
    parts.input = true;
    const bool repeats = action == GLFW_REPEAT && code >= GLFW_KEY_RIGHT && code <= GLFW_KEY_UP;
    if ((action != GLFW_PRESS && !repeats) || code == GLFW_KEY_UNKNOWN) return;
    // GLFW names keys after the American keyboard; what counts is what stands on them.
    const char* const name = code < 256 ? glfwGetKeyName(code, scancode) : nullptr;
    const bool one = name != nullptr && name[0] != '\0' && name[1] == '\0';
    const bool letter = one && name[0] >= 'a' && name[0] <= 'z';
    const bool sign = one && (name[0] == '+' || name[0] == '-');
    parts.keys.push_back({letter ? name[0] - 'a' + 'A'
                          : sign ? name[0]
                                 : code,
                          (modifiers & GLFW_MOD_CONTROL) != 0, (modifiers & GLFW_MOD_SHIFT) != 0});
  }

  Library library;
  GLFWwindow* window = nullptr;
  ImGuiContext* imgui = nullptr;
  bool input = true;
  Size windowed = {};  // when it fills no screen
  int left = 0, top = 0;
  std::vector<KeyPress> keys;
  std::vector<std::string> drops;
};

Window::Window(const std::string& title, int width, int height)
    : parts_(std::make_unique<Parts>(title, width, height)) {
  Window::make_current();
  glfwSwapInterval(1);
}

Window::~Window() = default;

void Window::make_current() {
  glfwMakeContextCurrent(parts_->window);
  if (glfwGetCurrentContext() != parts_->window) refuse("no OpenGL");
}

GetProc Window::get_proc() const {
  return glfwGetProcAddress;
}

Size Window::framebuffer_size() const {
  Size size;
  glfwGetFramebufferSize(parts_->window, &size.width, &size.height);
  return size;
}

Size Window::size() const {
  Size size;
  glfwGetWindowSize(parts_->window, &size.width, &size.height);
  return size;
}

float Window::content_scale() const {
  float scale = 1;
  glfwGetWindowContentScale(parts_->window, &scale, nullptr);
  return scale;
}

bool Window::iconified() const {
  return glfwGetWindowAttrib(parts_->window, GLFW_ICONIFIED) == GLFW_TRUE;
}

void Window::set_title(const std::string& title) {
  glfwSetWindowTitle(parts_->window, title.c_str());
}

void Window::toggle_full_screen() {
  Parts& parts = *parts_;
  GLFWmonitor* const screen = glfwGetPrimaryMonitor();
  if (glfwGetWindowMonitor(parts.window)) {
    glfwSetWindowMonitor(parts.window, nullptr, parts.left, parts.top, parts.windowed.width,
                         parts.windowed.height, GLFW_DONT_CARE);
  } else if (const GLFWvidmode* const mode = screen ? glfwGetVideoMode(screen) : nullptr) {
    glfwGetWindowPos(parts.window, &parts.left, &parts.top);
    parts.windowed = size();
    glfwSetWindowMonitor(parts.window, screen, 0, 0, mode->width, mode->height, mode->refreshRate);
  }
}

bool Window::should_close() const {
  return glfwWindowShouldClose(parts_->window) == GLFW_TRUE;
}

std::vector<KeyPress> Window::take_keys() {
  return std::exchange(parts_->keys, {});
}

std::vector<std::string> Window::take_drops() {
  return std::exchange(parts_->drops, {});
}

void Window::close() {
  glfwSetWindowShouldClose(parts_->window, GLFW_TRUE);
}

void Window::poll_events() {
  glfwPollEvents();
}

void Window::wait_events(double seconds) {
  glfwWaitEventsTimeout(seconds);
}

void Window::wake() {
  glfwPostEmptyEvent();
}

bool Window::take_input() {
  return std::exchange(parts_->input, false);
}

void Window::swap() {
  glfwSwapBuffers(parts_->window);
}

void Window::connect_imgui() {
  ImGui_ImplGlfw_InitForOpenGL(parts_->window, true);
  parts_->imgui = ImGui::GetCurrentContext();
}

void Window::new_imgui_frame() {
  ImGui_ImplGlfw_NewFrame();
}

}  // namespace topple::render
