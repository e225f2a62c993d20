// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// What the viewer asked for by keys since the last time.
struct Wishes {
  bool close = false;
  bool pause = false;  // toggle
  bool loop = false;   // toggle
  int step = 0;        // frames
  bool rewind = false;
};

// A window that shows a mesh. The mouse turns, moves and zooms it.
class PlayerWindow {
 public:
  PlayerWindow();
  ~PlayerWindow();

  // Opens the window. kUnsupported, saying what to do, where there is no display, no GLFW or no OpenGL.
  Status Open(const Mesh& mesh, const std::string& title, int width, int height, bool z_up);
  // The frame to show from now on, with its box, model units.
  void SetFrame(const std::vector<Vec3f>& positions, const std::vector<Vec3f>& normals, const Box& box);
  void SetTitle(const std::string& title);
  // Draws, then waits for events, at most so many seconds.
  void Draw(double wait);
  // The wishes since the last call.
  Wishes TakeWishes();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace sac
