// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <memory>
#include <string>

#include "cli/commands.h"
#include "cli/decoded_frames.h"
#include "cli/progress.h"
#include "files/stream_input.h"

namespace sac {
namespace {

Status Verify(const std::string& path) {
  StreamInput input;
  SAC_RETURN_IF_ERROR(input.Open(path));
  DecodedFrames frames(input.name(), [&input](auto& chunk) { return input.Read(chunk); });
  DecodedFrame frame;
  std::uint32_t count = 0, segments = 0;
  {
    Progress progress;
    progress.Begin("harmonics");
    for (bool end = false;;) {
      SAC_RETURN_IF_ERROR(frames.Next(frame, end));
      if (end) break;
      count = frame.index + 1;
      segments = frame.segment + 1;
      progress.FramesDone(count);
    }
  }
  const StreamInfo& info = *frames.decoder().info();
  if (segments > 1) {
    std::printf("%s: ok, %u frames of %u meshes, %llu bytes\n", input.name().c_str(), count, segments,
                static_cast<unsigned long long>(frames.bytes()));
    return Status::Ok();
  }
  std::printf("%s: ok, %u frames, %u vertices, %u triangles, %llu bytes\n", input.name().c_str(), count, info.vertices,
              info.triangles, static_cast<unsigned long long>(frames.bytes()));
  return Status::Ok();
}

}  // namespace

Command AddVerifyCommand(CLI::App& app) {
  auto path = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("verify", "Decode a whole stream and say whether it is sound.");
  command->add_option("STREAM", *path, "the stream to read; - is standard input")->required()->option_text(" ");
  command->footer(
      "The exit code is 0 for a sound stream and 1 for any other.\n\n"
      "Example:\n"
      "  sac verify clip.sac\n");
  return {command, [] { return Status::Ok(); }, [path] { return Verify(*path); }};
}

}  // namespace sac
