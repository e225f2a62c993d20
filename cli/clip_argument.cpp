// SPDX-License-Identifier: Apache-2.0
#include "cli/clip_argument.h"

#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "cli/decoded_frames.h"
#include "files/clip_input.h"
#include "files/path.h"
#include "files/stream_input.h"

namespace sac {
namespace {

// A decoded stream in memory: it is read several times.
class StreamClip : public ClipReader {
 public:
  StreamClip(std::string name, Clip clip) : name_(std::move(name)), clip_(std::move(clip)), reader_(clip_) {}
  StreamClip(const StreamClip&) = delete;
  StreamClip& operator=(const StreamClip&) = delete;

  const Mesh& mesh() const override { return reader_.mesh(); }
  FrameRate rate() const override { return reader_.rate(); }
  std::optional<std::uint32_t> frame_count() const override { return reader_.frame_count(); }
  std::string name() const override { return name_; }
  Status Next(Positions& frame, bool& end) override { return reader_.Next(frame, end); }
  Status Rewind() override { return reader_.Rewind(); }

 private:
  std::string name_;
  Clip clip_;
  MemoryClipReader reader_;
};

Status OpenStream(const std::string& path, ClipArgument& argument) {
  StreamInput input;
  SAC_RETURN_IF_ERROR(input.Open(path));
  DecodedFrames frames(input.name(), [&input](std::span<const std::uint8_t>& chunk) { return input.Read(chunk); });
  Clip clip;
  DecodedFrame frame;
  for (bool end = false;;) {
    SAC_RETURN_IF_ERROR(frames.Next(frame, end));
    if (end) break;
    if (frame.segment > 0) {
      return Status::Unsupported(path + ": its mesh changes at frame " + std::to_string(frame.index) +
                                 ", and the clip is to have one; decode it to meshes, such as frame_%04d.obj");
    }
    clip.frames.push_back(frame.positions);
  }
  if (clip.frames.empty()) return Status::InvalidArgument(path + ": has no frames");
  clip.mesh = *frames.decoder().mesh();
  clip.mesh.positions = clip.frames.front();
  const StreamInfo& info = *frames.decoder().info();
  clip.rate = {info.frame_rate_numerator, info.frame_rate_denominator};
  argument.offset = info.offset;
  argument.reader = std::make_unique<StreamClip>(path, std::move(clip));
  return Status::Ok();
}

}  // namespace

bool IsStreamName(const std::vector<std::string>& arguments) {
  return arguments.size() == 1 && Extension(arguments[0]) == ".sac";
}

Status OpenClip(const std::vector<std::string>& arguments, ClipArgument& clip) {
  if (IsStreamName(arguments)) return OpenStream(arguments[0], clip);
  std::unique_ptr<ClipInput> input;
  SAC_RETURN_IF_ERROR(ClipInput::Open(arguments, input));
  clip.offset = input->offset();
  clip.warnings = input->warnings();
  clip.reader = std::move(input);
  return Status::Ok();
}

void AddClipArgument(CLI::App& app, std::vector<std::string>& arguments, bool required) {
  app.add_option("CLIP", arguments, "a clip as for encode, or a .sac stream")->required(required)->option_text("...");
}

}  // namespace sac
