// SPDX-License-Identifier: Apache-2.0
// Encoding and decoding speed on one thread. The argument of a benchmark is the number of vertices asked for.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <span>

#include "bench/clip.h"
#include "bench/peak_memory.h"
#include "codec/i_frame.h"
#include "codec/shape.h"
#include "format/i_frame_syntax.h"
#include "format/packet.h"
#include "format/sequence_header.h"
#include "sac/decoder.h"
#include "sac/encoder.h"
#include "sac/status.h"

namespace sac::bench {
namespace {

void Require(const Status& status) {
  if (status.ok()) return;
  std::fprintf(stderr, "speed: %s\n", status.message().c_str());
  std::exit(1);
}

std::uint32_t Vertices(const benchmark::State& state) { return static_cast<std::uint32_t>(state.range(0)); }

void CountVertices(benchmark::State& state, const CodedClip& coded) {
  state.counters["vertices"] = static_cast<double>(coded.clip.mesh.positions.size());
}

// The header and the I-frame of a clip, from which the steps of a decoder's start are measured one by one.
struct StreamStart {
  SequenceHeader header;
  IFrameSyntax syntax;
  DecodedIFrame decoded;

  explicit StreamStart(const CodedClip& coded) {
    std::span<const std::uint8_t> bytes = coded.stream;
    PacketReader packets{Limits{}};
    std::optional<Packet> packet;
    Require(packets.Read(bytes, packet));
    Require(ParseSequenceHeader(packet.value().payload, {}, header));
    Require(packets.Read(bytes, packet));
    Require(ReadIFrame(packet.value().payload, header, syntax));
    DecodeMesh();
  }

  void DecodeMesh() {
    DracoMesh draco;
    Require(DecodeDraco(syntax.mesh, header, draco));
    Require(AssembleIFrame(syntax, header, std::move(draco), decoded));
  }

  Shape MakeShape() const {
    Shape shape;
    Require(BuildShape(header, decoded.mesh, syntax.harmonics, syntax.handles_per_harmonic, {}, shape));
    return shape;
  }
};

// The time from the first byte to the first frame, which includes parsing the first group.
void StartDecoder(benchmark::State& state) {
  const CodedClip& coded = WalkerClip(Vertices(state));
  DecodedFrame frame;
  for ([[maybe_unused]] auto step : state) {
    Decoder decoder;
    std::span<const std::uint8_t> bytes = coded.stream;
    do {
      Require(decoder.Send(bytes));
    } while (!decoder.Receive(frame).ok());
  }
  CountVertices(state, coded);
}

// The steps of that time: the mesh, and what frames are reconstructed with.
void StartMesh(benchmark::State& state) {
  const CodedClip& coded = WalkerClip(Vertices(state));
  StreamStart start(coded);
  for ([[maybe_unused]] auto step : state) start.DecodeMesh();
  CountVertices(state, coded);
}

void StartShape(benchmark::State& state) {
  const CodedClip& coded = WalkerClip(Vertices(state));
  const StreamStart start(coded);
  for ([[maybe_unused]] auto step : state) benchmark::DoNotOptimize(start.MakeShape());
  CountVertices(state, coded);
}

// Decoding all frames, without the time until the mesh is there.
void DecodeFrames(benchmark::State& state) {
  const CodedClip& coded = WalkerClip(Vertices(state));
  DecodedFrame frame;
  PeakMemory memory;
  memory.Start();
  std::int64_t frames = 0;
  for ([[maybe_unused]] auto step : state) {
    state.PauseTiming();
    std::optional<Decoder> decoder(std::in_place);
    std::span<const std::uint8_t> bytes = coded.stream;
    while (decoder->mesh() == nullptr) Require(decoder->Send(bytes));
    state.ResumeTiming();
    while (!bytes.empty()) {
      Require(decoder->Send(bytes));
      while (decoder->Receive(frame).ok()) ++frames;
    }
    Require(decoder->Finish());
    state.PauseTiming();
    decoder.reset();
    state.ResumeTiming();
  }
  state.counters["frames/s"] = benchmark::Counter(static_cast<double>(frames), benchmark::Counter::kIsRate);
  state.counters["peak_MB"] = memory.Megabytes();
  CountVertices(state, coded);
}

// Seeking to frames all over the clip, from the request to the positions: the frame's group is parsed and one frame is
// reconstructed. Groups are parsed as a whole, since the models adapt from frame to frame.
void SeekAnywhere(benchmark::State& state) {
  const CodedClip& coded = WalkerClip(Vertices(state));
  Decoder decoder;
  DecodedFrame frame;
  std::span<const std::uint8_t> bytes = coded.stream;
  while (decoder.mesh() == nullptr) Require(decoder.Send(bytes));
  std::uint32_t wanted = 0;
  for ([[maybe_unused]] auto step : state) {
    wanted = (wanted + 131) % kFrames;  // groups have 128 frames, so each seek goes to another group
    std::uint64_t byte = 0;
    Require(decoder.Seek(wanted, byte));
    bytes = std::span(coded.stream).subspan(byte);
    while (!decoder.Receive(frame).ok()) Require(decoder.Send(bytes));
  }
  CountVertices(state, coded);
}

// Seeking within the group that was parsed last, as when a user scrubs.
void SeekInGroup(benchmark::State& state) {
  const CodedClip& coded = WalkerClip(Vertices(state));
  Decoder decoder;
  DecodedFrame frame;
  std::span<const std::uint8_t> bytes = coded.stream;
  std::uint64_t byte = 0;
  while (!decoder.Receive(frame).ok()) Require(decoder.Send(bytes));
  std::uint32_t wanted = 0;
  for ([[maybe_unused]] auto step : state) {
    wanted = (wanted + 37) % 128;
    Require(decoder.Seek(wanted, byte));
    bytes = std::span(coded.stream).subspan(byte);
    while (!decoder.Receive(frame).ok()) Require(decoder.Send(bytes));
  }
  CountVertices(state, coded);
}

void StartEncoder(benchmark::State& state) {
  const CodedClip& coded = WalkerClip(Vertices(state));
  for ([[maybe_unused]] auto step : state) {
    std::unique_ptr<Encoder> encoder;
    Require(Encoder::Create(coded.clip.mesh, {}, encoder));
  }
  CountVertices(state, coded);
}

// Encoding all frames, without the time to encode the start of the stream.
void EncodeFrames(benchmark::State& state) {
  const CodedClip& coded = WalkerClip(Vertices(state));
  PeakMemory memory;
  memory.Start();
  double bytes = 0;
  for ([[maybe_unused]] auto step : state) {
    state.PauseTiming();
    std::unique_ptr<Encoder> encoder;
    Require(Encoder::Create(coded.clip.mesh, {}, encoder));
    state.ResumeTiming();
    for (const Positions& frame : coded.clip.frames) Require(encoder->Send(frame));
    Require(encoder->Finish());
    bytes = static_cast<double>(encoder->TakeBytes().size());
    state.PauseTiming();
    encoder.reset();
    state.ResumeTiming();
  }
  state.counters["frames/s"] = benchmark::Counter(kFrames, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["peak_MB"] = memory.Megabytes();
  state.counters["bpvf"] = 8 * bytes / (kFrames * static_cast<double>(coded.clip.mesh.positions.size()));
  CountVertices(state, coded);
}

void Sizes(benchmark::internal::Benchmark* b) { b->Arg(2000)->Arg(10000)->Arg(40000)->Unit(benchmark::kMillisecond); }

BENCHMARK(StartDecoder)->Apply(Sizes);
BENCHMARK(StartMesh)->Apply(Sizes);
BENCHMARK(StartShape)->Apply(Sizes);
BENCHMARK(DecodeFrames)->Apply(Sizes);
BENCHMARK(SeekAnywhere)->Apply(Sizes);
BENCHMARK(SeekInGroup)->Apply(Sizes);
BENCHMARK(StartEncoder)->Apply(Sizes);
BENCHMARK(EncodeFrames)->Apply(Sizes);

}  // namespace
}  // namespace sac::bench
