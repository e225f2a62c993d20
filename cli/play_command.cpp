// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/commands.h"
#include "cli/number_option.h"
#include "files/frame_rate.h"
#include "files/stream_input.h"
#include "player/window.h"
#include "sac/decoder.h"

namespace sac {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kUnknownRate = 30;  // frames per second, where neither the stream nor the viewer tells
constexpr double kIdle = 0.05;       // seconds between looks for events while nothing moves

struct PlayOptions {
  std::string input;
  std::string up = "y";
  std::optional<double> fps;
  std::uint32_t width = 960, height = 720;
  bool once = false, paused = false;
};

// The frames of a stream whose bytes are kept as they come, so that it can be played again.
class Playback {
 public:
  // Reads up to the mesh.
  Status Open(const std::string& path) {
    SAC_RETURN_IF_ERROR(input_.Open(path));
    bool end = false;
    while (decoder_.mesh() == nullptr) {
      SAC_RETURN_IF_ERROR(Send(end));
      if (end && decoder_.mesh() == nullptr) return At(decoder_.Finish());
    }
    positions_.resize(decoder_.mesh()->positions.size());
    normals_.resize(positions_.size());
    return Status::Ok();
  }

  // Decodes the next frame; at the end `end` becomes true.
  Status Next(bool& end) {
    const VertexBuffer to_positions{positions_.data(), positions_.size() * sizeof(Vec3f), sizeof(Vec3f)};
    const VertexBuffer to_normals{normals_.data(), normals_.size() * sizeof(Vec3f), sizeof(Vec3f)};
    for (end = false;;) {
      const Status received = decoder_.Receive({to_positions, to_normals}, info_);
      if (received.code() != StatusCode::kNeedMoreData) return At(received);
      SAC_RETURN_IF_ERROR(Send(end));
      if (end) return At(decoder_.Finish());
    }
  }

  Status Seek(std::uint32_t frame) {
    std::uint64_t byte = 0;
    SAC_RETURN_IF_ERROR(At(decoder_.Seek(frame, byte)));
    at_ = byte;
    return Status::Ok();
  }

  const Decoder& decoder() const { return decoder_; }
  const FrameInfo& info() const { return info_; }
  const std::string& name() const { return input_.name(); }
  void ShowIn(PlayerWindow& window) const { window.SetFrame(positions_, normals_, info_.box); }

 private:
  Status At(const Status& status) const {
    return status.ok() ? status : Status(status.code(), input_.name() + ": " + status.message());
  }

  Status Send(bool& end) {
    if (at_ == bytes_.size()) {
      std::span<const std::uint8_t> chunk;
      SAC_RETURN_IF_ERROR(input_.Read(chunk));
      bytes_.insert(bytes_.end(), chunk.begin(), chunk.end());
      if (end = chunk.empty(); end) return Status::Ok();
    }
    std::span<const std::uint8_t> bytes = std::span(bytes_).subspan(at_);
    const std::size_t before = bytes.size();
    SAC_RETURN_IF_ERROR(At(decoder_.Send(bytes)));
    at_ += before - bytes.size();
    return Status::Ok();
  }

  StreamInput input_;
  std::vector<std::uint8_t> bytes_;
  std::size_t at_ = 0;  // of the next byte to be sent
  Decoder decoder_;
  FrameInfo info_;
  std::vector<Vec3f> positions_, normals_;
};

// Shows a stream until its window is closed.
class Show {
 public:
  Show(const PlayOptions& options, Playback& playback) : playback_(playback), paused_(options.paused) {
    const double rate = playback.decoder().info()->frames_per_second();
    period_ = std::chrono::duration<double>(1 / options.fps.value_or(rate > 0 ? rate : kUnknownRate));
    loops_ = !options.once;
    stays_ = !options.once;
  }

  Status Run(PlayerWindow& window) {
    SAC_RETURN_IF_ERROR(Advance(window));
    for (due_ = Clock::now();;) {
      const double left = std::chrono::duration<double>(due_ - Clock::now()).count();
      window.Draw(paused_ || over_ ? kIdle : std::min(left, kIdle));
      const Wishes wishes = window.TakeWishes();
      if (wishes.close || (over_ && !stays_)) return Status::Ok();
      SAC_RETURN_IF_ERROR(Follow(wishes, window));
      if (paused_ || over_ || Clock::now() < due_) continue;
      SAC_RETURN_IF_ERROR(Advance(window));
    }
  }

 private:
  Status Follow(const Wishes& wishes, PlayerWindow& window) {
    if (wishes.pause) paused_ = !paused_;
    if (wishes.loop) loops_ = !loops_;
    if (wishes.pause || wishes.loop) over_ = false;
    if (wishes.step == 0 && !wishes.rewind) return Status::Ok();
    const std::int64_t wanted = wishes.rewind ? 0 : std::int64_t{playback_.info().index} + wishes.step;
    paused_ = paused_ || wishes.step != 0;
    over_ = false;
    if (wanted != std::int64_t{playback_.info().index} + 1) {
      const std::uint32_t last = playback_.decoder().frames().value_or(0xffffffffu) - 1;
      SAC_RETURN_IF_ERROR(playback_.Seek(static_cast<std::uint32_t>(std::clamp<std::int64_t>(wanted, 0, last))));
    }
    return Advance(window);
  }

  // Shows the next frame, the first after the last where the clip is played again.
  Status Advance(PlayerWindow& window) {
    bool end = false;
    SAC_RETURN_IF_ERROR(playback_.Next(end));
    if (end && (over_ = !loops_)) return Status::Ok();
    if (end) {
      SAC_RETURN_IF_ERROR(playback_.Seek(0));
      SAC_RETURN_IF_ERROR(playback_.Next(end));
      if (end) return Status::Ok();  // a stream without frames
    }
    playback_.ShowIn(window);
    const auto frames = playback_.decoder().frames();
    window.SetTitle(playback_.name() + " - frame " + std::to_string(playback_.info().index) +
                    (frames ? " of " + std::to_string(*frames) : ""));
    // A frame that is late by more than one does not make those after it hurry.
    due_ = std::max(due_ + std::chrono::duration_cast<Clock::duration>(period_),
                    Clock::now() - std::chrono::duration_cast<Clock::duration>(period_));
    return Status::Ok();
  }

  Playback& playback_;
  std::chrono::duration<double> period_{};
  Clock::time_point due_;
  bool paused_ = false, loops_ = true, stays_ = true, over_ = false;
};

Status Play(const PlayOptions& options) {
  Playback playback;
  SAC_RETURN_IF_ERROR(playback.Open(options.input));
  PlayerWindow window;
  SAC_RETURN_IF_ERROR(window.Open(*playback.decoder().mesh(), playback.name(), static_cast<int>(options.width),
                                  static_cast<int>(options.height), options.up == "z"));
  return Show(options, playback).Run(window);
}

}  // namespace

Command AddPlayCommand(CLI::App& app) {
  auto options = std::make_shared<PlayOptions>();
  CLI::App* command = app.add_subcommand("play", "Show a stream in a window.");
  command->add_option("STREAM", options->input, "the stream to show; - is standard input")
      ->required()
      ->option_text(" ");
  AddNumber(*command, "--fps", options->fps, 0.01, 1000.0, "frames a second [those of the stream, or 30]");
  command->add_option("--up", options->up, "the axis that is up in the picture: y or z [y]")
      ->check(CLI::IsMember(std::vector<std::string>{"y", "z"}))
      ->option_text("AXIS");
  command->add_flag("--once", options->once, "close the window after the last frame, instead of playing again");
  command->add_flag("--paused", options->paused, "stand still at the first frame");
  AddNumber(*command, "--width", options->width, 64u, 16384u, "of the window, pixels [960]");
  AddNumber(*command, "--height", options->height, 64u, 16384u, "of the window, pixels [720]");
  command->footer(
      "Drag with the left button to turn, with another or with Shift to move, and roll the wheel to come nearer.\n"
      "Space pauses, the arrow keys go a frame on or back, Home goes to the first, L plays once or again and again,\n"
      "W shows the edges, C has the camera follow the shape or not, F shows all of it, Q closes the window.\n\n"
      "It takes libglfw3 and a display. Without one, decode the frames into files.\n\n"
      "Examples:\n"
      "  sac play walk.sac\n"
      "  ssh host cat walk.sac | sac play -\n");
  return {command, [] { return Status::Ok(); }, [options] { return Play(*options); }};
}

}  // namespace sac
