// SPDX-License-Identifier: Apache-2.0
// Writes a clip as another, as encoder and decoder would with nothing lost between them.
// usage: dump_clip CLIP OUT [--with CACHE] [--fps FPS] [--animation NAME] [--scene NAME] [--compress quantized|meshopt]
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "files/clip_input.h"
#include "files/clip_output.h"
#include "files/frame_rate.h"

namespace sac {
namespace {

Status Dump(const std::vector<std::string>& in, const std::string& out, const ClipInputSettings& reading,
            ClipOutput::Settings writing) {
  std::unique_ptr<ClipInput> clip;
  SAC_RETURN_IF_ERROR(ClipInput::Open(in, clip, reading));
  const FrameRate rate = clip->rate().numerator != 0 ? clip->rate() : reading.rate;
  if (rate.numerator != 0) writing.fps = rate.per_second();
  std::unique_ptr<ClipOutput> output;
  SAC_RETURN_IF_ERROR(ClipOutput::Open(out, clip->mesh(), writing, output));
  Positions frame;
  bool end = false;
  for (std::int64_t number = 0;; ++number) {
    SAC_RETURN_IF_ERROR(clip->Next(frame, end));
    if (end) break;
    SAC_RETURN_IF_ERROR(output->Write(number, frame));
  }
  for (const std::string& warning : clip->warnings()) std::fprintf(stderr, "%s\n", warning.c_str());
  return output->Commit();
}

}  // namespace
}  // namespace sac

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  std::vector<std::string> in = {argv[1]};
  sac::ClipInputSettings reading;
  reading.offset = {0, 0, 0};
  sac::ClipOutput::Settings writing;
  writing.force = true;
  for (int i = 3; i + 1 < argc; i += 2) {
    const std::string option = argv[i], value = argv[i + 1];
    if (option == "--with") in.push_back(value);
    if (option == "--fps" && !sac::ParseFrameRate(value, reading.rate)) return 2;
    if (option == "--animation") reading.animation = value;
    if (option == "--scene") reading.scene = value;
    if (option == "--compress") {
      writing.compression =
          value == "meshopt" ? sac::ClipOutput::Compression::kMeshopt : sac::ClipOutput::Compression::kQuantized;
    }
  }
  const sac::Status status = sac::Dump(in, argv[2], reading, writing);
  if (status.ok()) return 0;
  std::fprintf(stderr, "%s\n", status.message().c_str());
  return 1;
}
