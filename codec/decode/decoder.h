#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "codec/mesh.h"
#include "format/limits.h"
#include "format/sequence_header.h"
#include "format/status.h"

namespace sac {

struct DecoderSettings {
  Limits limits;
};

struct DecodedFrame {
  std::uint32_t index = 0;  // in the clip, from 0
  bool intra = false;       // needed no other frame
  Positions positions;      // in the vertex order of the decoder's mesh, model units
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
// Memory holds the mesh, its basis and one packet, whatever the length of the clip. An error is final. A decoder is
// used by one thread at a time; decoders share nothing.
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

  // Declares the end of the bytes: kCorrupt when the stream is not complete.
  Status Finish();

  // The sequence header and the first frame's mesh with its static attributes; null before they have been decoded.
  const SequenceHeader* header() const;
  const Mesh* mesh() const;
  // Per vertex its index in the input; empty when the stream does not keep the order.
  const std::vector<std::uint32_t>& order() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sac
