// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
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

struct DecoderSettings {
  Limits limits;
  // Goes on after damage, at the next group that is sound; a stream may then also be entered anywhere. What is lost,
  // lost_frames() tells. Without it any error is final.
  bool skip_damage = false;
  // Receive() gives the frames whose number is a multiple of this, at a fraction of the work.
  std::uint32_t frame_step = 1;  // not 0
  // How many frames of a group are reconstructed at the same time, as far as the memory limit allows. 1: all work is
  // done by the caller's thread.
  unsigned threads = 1;
  // How many layers of each group are decoded, at least one; what the others add is left out (spec.md 6.1). A stream
  // of groups without layers has one.
  std::uint32_t layers = 0xffffffff;
  // Gets the type and the payload of each packet that a decoder may pass over, within Send() or Receive(). It throws
  // nothing.
  std::function<void(std::uint32_t type, std::span<const std::uint8_t> payload)> skippable;
  // The job system that reconstructs them, called with at most `threads` jobs from within Receive(). Empty: threads
  // that live as long as the call, or the caller's where the platform has none. A call fails with kInvalidArgument when
  // a runner throws or leaves a job out, with kLimit when it throws std::bad_alloc.
  JobRunner run_jobs;
};

struct FrameInfo {
  std::uint32_t index = 0;    // in the clip, from 0
  bool intra = false;         // needed no other frame
  std::uint32_t segment = 0;  // whose mesh it moves, from 0
  double time = 0;            // seconds from the clip's begin; 0 when the stream has no frame rate
  Box box;                    // of the positions, model units
};

struct DecodedFrame : FrameInfo {
  // In the vertex order of the decoder's mesh, model units. StreamInfo::offset is what to add for the author's
  // coordinates, in double precision; boxes are without it, too.
  Positions positions;
};

enum class VertexFormat {
  kFloat32,  // three floats
  // Three integers of 16 bits. Positions: unsigned, low + (high - low) * x / 65535 of the frame's box. Normals: signed,
  // x / 32767.
  kInt16,
};

// The caller's memory for three components of each vertex: of vertex v at byte v * stride.
struct VertexBuffer {
  void* data = nullptr;    // null: not wanted
  std::size_t size = 0;    // bytes
  std::size_t stride = 0;  // bytes, at least those of a vertex
  VertexFormat format = VertexFormat::kFloat32;
};

struct FrameBuffers {
  VertexBuffer positions;  // without StreamInfo::offset
  VertexBuffer normals;    // of the vertices, area-weighted means of their triangles', of length 1
};

// How a mesh follows its handles (spec.md 6.4.5): vertex v is at the sum, over the entries i from first[v] to before
// first[v + 1], of weights[i] * (matrix of handles[i] * (x, y, z, 1)), where x, y, z are the mesh's positions. What a
// skin is to joints, so that a GPU can do it.
struct BlendWeights {
  std::uint32_t handle_count = 0;
  std::vector<std::uint32_t> first;    // of each vertex, and one more
  std::vector<std::uint32_t> handles;  // of each entry, the nearest handle of a vertex first
  std::vector<float> weights;          // of each entry; those of a vertex are positive and add up to 1
};

// A run of frames.
struct FrameRange {
  std::uint32_t first = 0, count = 0;
};

// Turns a stream into frames. The bytes may come in any chunking:
//
//   sac::Decoder decoder(settings);
//   while (more input) {
//     std::span<const std::uint8_t> bytes = next chunk;
//     while (!bytes.empty()) {
//       status = decoder.Send(bytes);         // takes from the front of `bytes`, at most a packet
//       if (!status.ok()) return status;
//       while ((status = decoder.Receive(frame)).ok()) Show(decoder.mesh(), frame);
//       if (status.code() != sac::StatusCode::kNeedMoreData) return status;
//     }
//   }
//   status = decoder.Finish();
//
// With skip_damage more may come of the end:
//
//   while (decoder.Receive(frame).ok()) Show(decoder.mesh(), frame);
//   status = decoder.Finish();
//
// Memory holds the mesh, its basis, one packet and a group's coefficients, whatever the length of the clip; only the
// places of its groups add 16 bytes each. A decoder is used by one thread at a time; decoders share nothing.
class Decoder {
 public:
  explicit Decoder(const DecoderSettings& settings = {});
  ~Decoder();
  Decoder(Decoder&&) noexcept;
  Decoder& operator=(Decoder&&) noexcept;

  // Takes bytes from the front of `bytes`, until a packet is complete or all are taken. Takes nothing while frames wait
  // to be received. kCorrupt, kUnsupported and kLimit as the stream gives cause.
  Status Send(std::span<const std::uint8_t>& bytes);

  // Decodes the next frame. kNeedMoreData when none is ready.
  Status Receive(DecodedFrame& frame);
  // Decodes the next frame into the caller's memory, such as a mapped buffer of a GPU. After the first frames
  // of a stream nothing is allocated within a group, but for threads that are made there. kNeedMoreData when no frame
  // is ready; kInvalidArgument, and the frame still waits, when a buffer is too small.
  Status Receive(const FrameBuffers& buffers, FrameInfo& info);

  // The weights of the mesh that is there now, which Prepare() computes if need be. kUnsupported when frames are
  // measured against the frame before. Otherwise as Prepare().
  Status Blend(BlendWeights& weights);
  // Decodes the next frame as matrices of the handles, three rows of four columns each, instead of positions. Then
  // `exact` says whether the frame is no more than the blend; otherwise its detail and correction planes, which only
  // Receive() adds, are left out. The box in `info` holds the blended mesh, but may be larger. kInvalidArgument, and
  // the frame still waits, when `matrices` has another size than 12 floats a handle. Otherwise as Receive().
  Status ReceiveHandles(std::span<float> matrices, FrameInfo& info, bool& exact);
  // The same at a time between frames: see Interpolate().
  Status InterpolateHandles(double time, std::span<float> matrices, FrameInfo& info, bool& exact);

  // Declares the end of the bytes: kCorrupt when the stream is not complete. With skip_damage, more frames may be ready
  // to be received afterwards: those of a packet whose size was damaged, or of a group that is cut off: the latter
  // without a check, which is cut off, too. Called again after the last of them, it tells whether the stream was
  // complete.
  Status Finish();

  // Goes to `frame`, which the next Receive() gives: it sets `byte`, and the next bytes sent must be those of the
  // stream from there on. Without an index this is the last group that is known to begin before, and groups are passed
  // over from there, without decoding them. A clip is played again by Seek(0). With a frame_step, Receive() gives the
  // next of its multiples. `byte` counts from the first byte that was sent, or that an index counts from.
  // kNeedMoreData before the I-frame has been sent; kInvalidArgument when the clip is known to end before. An error of
  // the stream's damage ends here.
  Status Seek(std::uint32_t frame, std::uint64_t& byte);
  // Goes to the frame that is shown `seconds` after the clip's begin. kInvalidArgument when the stream has no frame
  // rate, otherwise as Seek().
  Status SeekTime(double seconds, std::uint64_t& byte);

  // Makes Seek() know where all groups begin, from the last bytes of the stream. kNeedMoreData when there are too few:
  // `needed` says how many it takes, 8 at first. kInvalidArgument when the stream has no index; so it is,
  // too, when `needed` comes to be more than the stream has.
  Status AddIndex(std::span<const std::uint8_t> tail, std::size_t& needed);

  // The shape at a time between frames, in frames from the clip's begin: coefficients are averaged, not positions, so
  // that what turns keeps its size. The last frame is held for its time. A cut is passed through like any motion.
  // Frames before `time` count as received; go on with later times, or Seek(). kNeedMoreData when the frame after
  // `time` has not been sent; kInvalidArgument when the one before is gone, or the clip is known to end before `time`;
  // kCorrupt, and decoding may go on, when one of them is lost; kUnsupported when frames are measured against the frame
  // before.
  Status Interpolate(double time, DecodedFrame& frame);
  Status Interpolate(double time, const FrameBuffers& buffers, FrameInfo& info);

  // Computes what frames need beside the mesh, once mesh() is there: the next call that needs it does so otherwise. It
  // may take a second for a large mesh, and may be called on another thread than the calls before and after it.
  // kNeedMoreData before the mesh has been sent.
  Status Prepare();
  // Makes the frames of a group ready whose layers are still coming, without those that have not come: what has come
  // is shown in time, coarser.
  Status Flush();

  // Forgets everything but the settings: another stream may begin. Needs no memory.
  void Reset() noexcept;

  // What the stream says of itself, and the clip's mesh with its static attributes; null before they have been decoded.
  // Its positions are the shape that frames are measured from, which is near the first frame and need not be one. Its
  // normals are those of the first frame: FrameNormals gives those of others.
  // The mesh of a stream of several segments is that of the frames that Receive() gives next: another one, with other
  // triangles and attributes, from some call of Send() on. segment() is then another number.
  const StreamInfo* info() const;
  const Mesh* mesh() const;
  // The number of the segment that mesh() is of, from 0; nothing before it is known.
  std::optional<std::uint32_t> segment() const;
  // What the stream says of its clip so far; null before it says anything. All of it may come at the end.
  const Metadata* metadata() const;
  // Per vertex its index in the input; empty when the stream does not keep the order.
  const std::vector<std::uint32_t>& order() const;
  // The most layers that a group so far may have (spec.md 6.1), those counted that were dropped: 1 where groups have no
  // layers, 0 before the first group.
  std::uint32_t layers() const;
  // How many frames the clip has; nothing before the end or AddIndex() has told.
  std::optional<std::uint32_t> frames() const;
  // The frames that damage has cost so far, ascending, with skip_damage.
  const std::vector<FrameRange>& lost_frames() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sac
