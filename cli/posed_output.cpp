// SPDX-License-Identifier: Apache-2.0
#include "cli/posed_output.h"

#include <cstdint>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "cli/encoding_report.h"
#include "cli/encoding_warnings.h"
#include "cli/progress.h"
#include "cli/warning_report.h"
#include "files/clip_output.h"
#include "files/mesh_file.h"
#include "files/output_file.h"
#include "files/overwriting.h"
#include "files/path.h"
#include "geometry/bounding_box.h"
#include "sac/clip_encoder.h"

namespace sac {
namespace {

constexpr double kFpsOfUnknown = 24;

bool IsStream(const std::string& path) { return Extension(path) == ".sac"; }

Status EncodePosed(ClipReader& clip, const PosedOutput& output) {
  OutputFile stream;
  SAC_RETURN_IF_ERROR(stream.Open(output.path));
  Progress progress(clip.frame_count());
  progress.Begin("harmonics");
  ClipEncoding encoding;
  encoding.encoder.quality = output.quality;
  encoding.encoder.offset = output.offset;
  encoding.encoder.keep_order = true;
  encoding.progress = [&progress](const EncodingProgress& p) {
    progress.SetPass(p.trial > 0 ? "trial " + std::to_string(p.trial) + ", " : "");
    if (p.frames > 0) progress.FramesDone(p.frames);
    return true;
  };
  EncodedClip encoded;
  const auto sink = [&stream](std::span<const std::uint8_t> bytes) { return stream.Write(bytes.data(), bytes.size()); };
  SAC_RETURN_IF_ERROR(EncodeClip(clip, encoding, sink, encoded));
  const double diagonal = BoundingBox(clip.mesh().positions).diagonal();
  SAC_RETURN_IF_ERROR(TellWarnings(EncodingWarnings(clip.name(), encoding, encoded, diagonal), output.strict));
  return stream.Commit();
}

}  // namespace

Status CheckPosedOutput(const std::string& path, bool single) {
  if (IsStream(path) || ClipOutput::IsClipName(path) || (single && IsWritableMeshName(path))) return Status::Ok();
  return Status::InvalidArgument(path +
                                 ": not a clip by its name (.sac, .pc2, .mdd, or a pattern of .obj, .ply or .off)");
}

std::vector<std::string> FilesOfPosed(const std::string& path) {
  return IsStream(path) ? std::vector<std::string>{path} : FilesOfOutput(path);
}

Status WritePosed(ClipReader& clip, const PosedOutput& output) {
  if (IsStream(output.path)) return EncodePosed(clip, output);
  Progress progress(clip.frame_count());
  ClipOutput::Settings settings;
  settings.fps = clip.rate().per_second() > 0 ? clip.rate().per_second() : kFpsOfUnknown;
  settings.frame_count = clip.frame_count();
  settings.force = output.force;
  settings.offset = output.offset;
  std::unique_ptr<ClipOutput> files;
  SAC_RETURN_IF_ERROR(ClipOutput::Open(output.path, clip.mesh(), settings, files));
  Positions frame;
  bool end = false;
  SAC_RETURN_IF_ERROR(clip.Rewind());
  for (std::uint32_t f = 0;; ++f) {
    SAC_RETURN_IF_ERROR(clip.Next(frame, end));
    if (end) break;
    SAC_RETURN_IF_ERROR(files->Write(f, frame));
    progress.FramesDone(f + 1);
  }
  Warnings warnings = files->warnings();
  for (std::string& line : files->StaleFrames()) warnings.push_back(std::move(line));
  SAC_RETURN_IF_ERROR(TellWarnings(warnings, output.strict));
  return files->Commit();
}

}  // namespace sac
