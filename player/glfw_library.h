// SPDX-License-Identifier: Apache-2.0
#pragma once

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "sac/status.h"

namespace sac {

// The functions of GLFW that the player calls, under their names without the prefix.
// clang-format off
#define SAC_GLFW_FUNCTIONS(X) \
  X(Init) X(Terminate) X(GetError) X(WindowHint) X(CreateWindow) X(DestroyWindow) X(MakeContextCurrent) \
  X(SwapInterval) X(SwapBuffers) X(PollEvents) X(WaitEventsTimeout) X(WindowShouldClose) X(SetWindowShouldClose) \
  X(SetWindowTitle) X(GetFramebufferSize) X(GetWindowSize) X(GetProcAddress) X(SetWindowUserPointer) \
  X(GetWindowUserPointer) X(SetKeyCallback) X(SetCursorPosCallback) X(SetScrollCallback) X(GetMouseButton) \
  X(GetKey)
// clang-format on

struct GlfwLibrary {
#define SAC_DECLARE(name) decltype(&::glfw##name) name = nullptr;
  SAC_GLFW_FUNCTIONS(SAC_DECLARE)
#undef SAC_DECLARE
};

// Loads libglfw, which stays loaded. kUnsupported, saying what to install, where it is not there.
Status LoadGlfw(GlfwLibrary& glfw);

}  // namespace sac
