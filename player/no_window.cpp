// SPDX-License-Identifier: Apache-2.0
// The player of a build without the headers of GLFW and OpenGL.
#include "player/window.h"

namespace sac {

struct PlayerWindow::State {};

PlayerWindow::PlayerWindow() = default;
PlayerWindow::~PlayerWindow() = default;
Status PlayerWindow::Open(const Mesh&, const std::string&, int, int, bool) {
  return Status::Unsupported("play: this sac was built without libglfw3-dev and libgl-dev");
}
void PlayerWindow::SetFrame(const std::vector<Vec3f>&, const std::vector<Vec3f>&, const Box&) {}
void PlayerWindow::SetTitle(const std::string&) {}
void PlayerWindow::Draw(double) {}
Wishes PlayerWindow::TakeWishes() { return {.close = true}; }

}  // namespace sac
