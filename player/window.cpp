// SPDX-License-Identifier: Apache-2.0
#include "player/window.h"

#include <cmath>
#include <cstdlib>
#include <utility>

#include "player/camera.h"
#include "player/glfw_library.h"
#include "player/surface.h"

namespace sac {

struct PlayerWindow::State {
  GlfwLibrary glfw;
  GLFWwindow* window = nullptr;
  SurfaceRenderer surface;
  Camera camera;
  Box box;
  Wishes wishes;
  double x = 0, y = 0;  // of the cursor
  bool initialized = false, framed = false, follow = true, wireframe = false;

  ~State() {
    if (window != nullptr) glfw.DestroyWindow(window);
    if (initialized) glfw.Terminate();
  }

  // What GLFW complained of last.
  std::string Complaint() const {
    const char* text = nullptr;
    glfw.GetError(&text);
    return text != nullptr ? text : "no reason is told";
  }

  void Key(int key);
  void Move(double to_x, double to_y);
  void Listen();
};

namespace {

constexpr const char* kNoDisplay =
    "play: there is no display (DISPLAY is not set). Over ssh, connect with ssh -X; or decode the frames into files: "
    "sac "
    "decode clip.sac -o frame_%04d.obj";

}  // namespace

void PlayerWindow::State::Key(int key) {
  switch (key) {
    case GLFW_KEY_Q:
    case GLFW_KEY_ESCAPE:
      wishes.close = true;
      break;
    case GLFW_KEY_SPACE:
      wishes.pause = !wishes.pause;
      break;
    case GLFW_KEY_L:
      wishes.loop = !wishes.loop;
      break;
    case GLFW_KEY_LEFT:
      --wishes.step;
      break;
    case GLFW_KEY_RIGHT:
      ++wishes.step;
      break;
    case GLFW_KEY_HOME:
      wishes.rewind = true;
      break;
    case GLFW_KEY_F:
      camera.Fit(box);
      break;
    case GLFW_KEY_C:
      follow = !follow;
      break;
    case GLFW_KEY_W:
      wireframe = !wireframe;
      break;
  }
}

void PlayerWindow::State::Move(double to_x, double to_y) {
  const double dx = to_x - std::exchange(x, to_x), dy = to_y - std::exchange(y, to_y);
  int width = 1, height = 1;
  glfw.GetWindowSize(window, &width, &height);
  const bool shift = glfw.GetKey(window, GLFW_KEY_LEFT_SHIFT) == GLFW_PRESS;
  const bool left = glfw.GetMouseButton(window, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS;
  const bool other = glfw.GetMouseButton(window, GLFW_MOUSE_BUTTON_RIGHT) == GLFW_PRESS ||
                     glfw.GetMouseButton(window, GLFW_MOUSE_BUTTON_MIDDLE) == GLFW_PRESS;
  if (other || (left && shift)) {
    camera.Pan(-dx / height, dy / height);
    follow = false;
  } else if (left) {
    camera.Orbit(-3 * dx / height, 3 * dy / height);
  }
}

void PlayerWindow::State::Listen() {
  glfw.SetWindowUserPointer(window, this);
  // GLFW calls plain functions, which find the state by the window and GLFW by the state.
  static const GlfwLibrary* library = nullptr;
  library = &glfw;
  static const auto of = [](GLFWwindow* w) { return static_cast<State*>(library->GetWindowUserPointer(w)); };
  glfw.SetKeyCallback(window, [](GLFWwindow* w, int key, int, int action, int) {
    if (action != GLFW_RELEASE) of(w)->Key(key);
  });
  glfw.SetCursorPosCallback(window, [](GLFWwindow* w, double to_x, double to_y) { of(w)->Move(to_x, to_y); });
  glfw.SetScrollCallback(window,
                         [](GLFWwindow* w, double, double rolled) { of(w)->camera.Zoom(std::pow(0.9, rolled)); });
}

PlayerWindow::PlayerWindow() : state_(std::make_unique<State>()) {}
PlayerWindow::~PlayerWindow() = default;

Status PlayerWindow::Open(const Mesh& mesh, const std::string& title, int width, int height, bool z_up) {
  State& s = *state_;
  const char* displays[] = {std::getenv("DISPLAY"), std::getenv("WAYLAND_DISPLAY")};
  if ((displays[0] == nullptr || *displays[0] == 0) && (displays[1] == nullptr || *displays[1] == 0)) {
    return Status::Unsupported(kNoDisplay);
  }
  SAC_RETURN_IF_ERROR(LoadGlfw(s.glfw));
  s.initialized = s.glfw.Init() == GLFW_TRUE;
  if (!s.initialized) return Status::Unsupported("play: the display cannot be opened: " + s.Complaint());
  s.glfw.WindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  s.glfw.WindowHint(GLFW_CONTEXT_VERSION_MINOR, 2);
  s.glfw.WindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  s.glfw.WindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  s.glfw.WindowHint(GLFW_SAMPLES, 4);
  s.window = s.glfw.CreateWindow(width, height, title.c_str(), nullptr, nullptr);
  if (s.window == nullptr) return Status::Unsupported("play: no window with OpenGL 3.2: " + s.Complaint());
  s.glfw.MakeContextCurrent(s.window);
  s.glfw.SwapInterval(1);
  s.camera.z_up = z_up;
  s.Listen();
  return s.surface.Create(mesh,
                          [&s](const char* name) { return reinterpret_cast<void*>(s.glfw.GetProcAddress(name)); });
}

void PlayerWindow::SetFrame(const std::vector<Vec3f>& positions, const std::vector<Vec3f>& normals, const Box& box) {
  State& s = *state_;
  s.surface.SetFrame(positions, normals);
  s.box = box;
  if (!s.framed) s.camera.Fit(box);
  s.framed = true;
  if (s.follow) {
    for (int k = 0; k < 3; ++k) s.camera.point[k] = (box.low[k] + box.high[k]) / 2;
  }
}

void PlayerWindow::SetTitle(const std::string& title) { state_->glfw.SetWindowTitle(state_->window, title.c_str()); }

void PlayerWindow::Draw(double wait) {
  State& s = *state_;
  int width = 0, height = 0;
  s.glfw.GetFramebufferSize(s.window, &width, &height);
  if (width > 0 && height > 0) {
    s.surface.Draw(s.camera, width, height, s.wireframe);
    s.glfw.SwapBuffers(s.window);
  }
  if (wait > 0) {
    s.glfw.WaitEventsTimeout(wait);
  } else {
    s.glfw.PollEvents();
  }
}

Wishes PlayerWindow::TakeWishes() {
  State& s = *state_;
  if (s.glfw.WindowShouldClose(s.window) == GLFW_TRUE) s.wishes.close = true;
  return std::exchange(s.wishes, {});
}

}  // namespace sac
