// SPDX-License-Identifier: Apache-2.0
#include "player/glfw_library.h"

#include <dlfcn.h>

namespace sac {

Status LoadGlfw(GlfwLibrary& glfw) {
  void* library = dlopen("libglfw.so.3", RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) return Status::Unsupported("play: libglfw.so.3 is not there: install libglfw3");
  bool good = true;
#define SAC_LOAD(name)                                                             \
  glfw.name = reinterpret_cast<decltype(glfw.name)>(dlsym(library, "glfw" #name)); \
  good = good && glfw.name != nullptr;
  SAC_GLFW_FUNCTIONS(SAC_LOAD)
#undef SAC_LOAD
  return good ? Status::Ok() : Status::Unsupported("play: this libglfw.so.3 is too old: 3.3 is needed");
}

}  // namespace sac
