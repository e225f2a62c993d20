// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "sac/job_runner.h"
#include "sac/limits.h"
#include "sac/mesh.h"
#include "sac/metadata.h"
#include "sac/status.h"
#include "sac/stream_info.h"

namespace sac {

// A packet that decoders may pass over (spec.md 3).
struct ExtraPacket {
  std::uint32_t type = 9;  // 8 to 15
  std::vector<std::uint8_t> payload;
};

// Everything an encoder chooses. Steps, bits and harmonics that are left out come from `quality`.
struct EncoderSettings {
  double quality = 50;                     // 0 (smallest) to 100 (nearest to the input)
  std::optional<std::uint32_t> harmonics;  // over all components; at least one each, at most the vertices
  std::uint32_t handles_per_harmonic = 2;  // fewer where they would be many; 0: every vertex is a handle
  std::uint32_t group = 128;               // frames between points of random access
  std::uint32_t pyramid = 16;              // frames of a hierarchy of B-frames; 1: P-frames only
  double level_growth = 1.2;               // of the planes' steps from level to level of a pyramid, 1..2
  // P-frames only, each coded as it is sent; `pyramid` says nothing then. At most 3 bytes of framing a frame.
  bool low_delay = false;
  ReferenceShape reference_shape = ReferenceShape::kKey;  // `previous` has P-frames only
  std::optional<double> motion_step;                      // radians and strain
  std::optional<double> displacement_step;                // fraction of the mesh's RMS radius
  std::optional<double> detail_step;                      // fraction of the mesh's RMS radius; 0: no detail plane
  std::optional<double> max_error;                        // of any vertex in any frame, model units
  std::optional<double> position_bits;                    // of the I-frame: log2 of its extent in steps, 1..24
  std::uint32_t frame_rate_numerator = 0;                 // frames per second; 0: unknown
  std::uint32_t frame_rate_denominator = 1;
  // What was taken from the author's coordinates to have positions near the origin, where floats are exact, model
  // units. It is only carried: decoders give it out beside the positions (StreamInfo::offset). Finite.
  std::array<double, 3> offset = {};
  bool keep_order = false;  // put the input's vertex order in the stream
  // Whether vertices that coincide are coded as one, so that no seam opens between them; decoders give out as many as
  // the input has. True: an Encoder joins those of the mesh that it is created with, and frames in which they part are
  // refused. EncodeClip() joins those that coincide in all frames, unless this is false.
  std::optional<bool> join;
  // How far a vertex moves at most from its place in the mesh, the rigid motion of the whole taken away; model units.
  // Where it is known, components much smaller than the mesh are coded finer, so that their error is in proportion to
  // their own size; frames that go twice as far may be refused. EncodeClip() measures it where there are such. Not with
  // a bound on the error.
  std::optional<double> reach;
  bool index = true;  // end streams of several groups with where they begin
  // Header and I-frame come again before every so many groups, for those who join in the middle; 0: never.
  std::uint32_t repeat_start = 0;
  // Groups are coded in layers that can be dropped from the end, a coarser stream each time: in the group's own packet
  // this many levels of the pyramid, then the other levels one by one, then detail and correction (spec.md 6.1). 0: no
  // layers. Not with low_delay or the reference shape `previous`, which have none.
  std::uint32_t base_levels = 0;
  Metadata metadata;    // what the stream says of the clip; its bounds are left alone
  bool bounds = false;  // puts the bounds of the clip and of its groups at the end of the stream
  // Packets that decoders pass over, after the first mesh.
  std::vector<ExtraPacket> extra_packets;
  // How many groups are coded at the same time, at most 1024; the frames of as many are held then, as far as they fit
  // into 2 GiB. 0: as many as the machine has processors. 1: all work is done by the caller's thread. The bytes are the
  // same with any number. Frames that come one by one (low_delay) are coded by the caller's thread.
  unsigned threads = 0;
  // The job system that codes groups, called with at most `threads` jobs from within Send(), BeginSegment(), Flush()
  // and Finish(). Empty: threads that live as long as the call, or the caller's where the platform has none. A call
  // fails with kInvalidArgument when a runner throws or runs no job, with kLimit when it throws std::bad_alloc.
  JobRunner run_jobs;
  // Is called on the caller's thread between the steps of Create(), with 0, and with the number of frames coded after
  // each frame; where other threads code frames, at least when a number of groups is done. Returns whether to go on;
  // after false the encoder answers kCancelled and cannot go on.
  std::function<bool(std::uint32_t frames)> progress;
  // What the decoders it is for are ready to spend. A quality gets fewer harmonics when these would be too many;
  // what exceeds them otherwise is refused, kLimit.
  Limits limits;
};

// What a failure is about: a frame by its index in the stream and, where one is at fault, a vertex in the order of the
// input.
struct FrameFault {
  std::uint32_t frame = 0;
  std::optional<std::uint32_t> vertex;
};

// Turns frames into a stream, one at a time. Holds one group a thread, not the clip. With low_delay a frame's bytes can
// be taken as soon as it is sent; otherwise those of groups when there is one for each thread, or after Flush().
//
//   std::unique_ptr<sac::Encoder> encoder;
//   status = sac::Encoder::Create(mesh, settings, encoder);   // mesh: the first frame with its triangles
//   for (each frame, the first one too) {
//     status = encoder->Send(positions);
//     write(encoder->TakeBytes());
//   }
//   status = encoder->Finish();
//   write(encoder->TakeBytes());
class Encoder {
 public:
  // Codes the I-frame, computes the harmonics. The positions of `mesh` are the shape that all frames are measured from:
  // those of the first frame, or any near them, such as EncodeClip() finds. Normals should be the first frame's.
  // kInvalidArgument for settings out of range, a mesh without vertices, a
  // triangle of a missing vertex, attributes that do not fit the mesh or coordinates that are not finite.
  // `lowest` says which vertices are joined (EncoderSettings::join), whatever the settings do: for each the lowest that
  // it coincides with in all frames, which may be itself. Those without triangles are not. `reach` is that of the
  // settings for each vertex by itself.
  static Status Create(const Mesh& mesh, const EncoderSettings& settings, std::unique_ptr<Encoder>& encoder,
                       std::span<const std::uint32_t> lowest = {}, std::span<const float> reach = {});
  // An encoder that goes on from a start, which start() of another gave: it codes any run of frames of that clip as a
  // stream of its own. What the start holds is not taken from `settings`: all that concerns the shape, steps, the
  // structure of groups, frame rate and offset. Where the run begins with a multiple of group_frames(), its groups have
  // the bytes that one encoder of the whole clip gives them (on a machine with the same floating-point results), and
  // `sac join` puts the runs together to its stream. kInvalidArgument for settings out of range and low_delay,
  // kCorrupt for bytes that are no start, kUnsupported for one of another version or with harmonics that are not those
  // that are computed here, kLimit as Create().
  static Status CreateFrom(std::span<const std::uint8_t> start, const EncoderSettings& settings,
                           std::unique_ptr<Encoder>& encoder);
  ~Encoder();
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;

  // The next frame, in the vertex order of the mesh, model units. kInvalidArgument when the number of vertices
  // differs, a coordinate is not finite or vertices part that are joined; the encoder can go on with another frame
  // then. kInvalidArgument, too, when the motion cannot be coded or the bound cannot be held, here or in a frame
  // before: no more frames can be sent, but Finish() still ends the stream after the last group, or with low_delay the
  // last frame, that was coded. The message says which frame and vertex it is.
  Status Send(std::span<const Vec3f> positions);
  // Goes on with frames of another mesh, such as one of other triangles: a new segment of the stream, in which the
  // frames that are sent next are coded as in a stream of their own. Decoders tell that the mesh has changed. Status as
  // of Create(), and as of Send() for the frames before; after a failure of Create()'s kind the encoder goes on with
  // the mesh before.
  Status BeginSegment(const Mesh& mesh, std::span<const std::uint32_t> lowest = {}, std::span<const float> reach = {});
  // Codes the groups that are full but wait for others to be coded at the same time. Status as of Send() for the frames
  // before.
  Status Flush();
  // Ends the stream. It fails with Send()'s failure when nothing was coded before.
  Status Finish();

  // The start of the segment for CreateFrom(): header, I-frame, and the settings that groups are coded with.
  std::vector<std::uint8_t> start() const;
  // How many frames a full group has.
  std::uint32_t group_frames() const;

  // The frame and the vertex that the last failure of Send() or Finish() was about.
  std::optional<FrameFault> fault() const;

  // How many frames have been coded.
  std::uint32_t frames() const;
  // What has been coded since the last call.
  std::vector<std::uint8_t> TakeBytes();

  // The index in the input of each vertex that decoders give out, of the last segment.
  const std::vector<std::uint32_t>& order() const;
  const StreamInfo& info() const;
  const StreamBytes& stream_bytes() const;

 private:
  class Impl;
  explicit Encoder(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace sac
