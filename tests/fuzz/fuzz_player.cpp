// SPDX-License-Identifier: Apache-2.0
// A player that calls in any order: seeks, feeds, receives into its own memory, interpolates, starts again. What it is
// given of a sound stream is what decoding from begin to end gives.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <random>
#include <vector>

#include "format/crc32.h"
#include "format/stream_index.h"
#include "sac/decoder.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/fuzz/stream_mutation.h"

namespace {

using namespace sac;

constexpr int kCalls = 40;

// Every frame of a sound stream; nothing of another.
std::vector<Positions> DecodeWhole(std::span<const std::uint8_t> stream) {
  DecoderSettings settings;
  settings.limits = FuzzLimits();
  Decoder decoder(settings);
  std::vector<Positions> frames;
  while (!stream.empty()) {
    if (!decoder.Send(stream).ok()) return {};
    DecodedFrame frame;
    Status status;
    while ((status = decoder.Receive(frame)).ok()) frames.push_back(frame.positions);
    if (status.code() != StatusCode::kNeedMoreData) return {};
  }
  return decoder.Finish().ok() ? frames : std::vector<Positions>();
}

class Player {
 public:
  Player(std::span<const std::uint8_t> stream, std::mt19937& random)
      : stream_(stream), random_(random), whole_(DecodeWhole(stream)), settings_(Settings()), decoder_(settings_) {}

  void Call() {
    switch (random_() % 10) {
      case 8:
        if (random_() % 2) {
          (void)decoder_.Prepare();
        } else {
          (void)decoder_.Flush();
          coarse_ = true;
        }
        return Receive();
      case 9:
        return ReceiveHandles();
      case 0:
        return Seek();
      case 1:
        return Interpolate();
      case 2:
        return AddIndex();
      case 3:
        if (random_() % 4 == 0) return Reset();
        (void)decoder_.Finish();
        coarse_ = coarse_ || at_ < stream_.size();  // a group may go without layers that were still to come
        return Receive();
      default:
        Feed();
        return Receive();
    }
  }

 private:
  bool coarse_ = false;  // layers may be missing

  DecoderSettings Settings() {
    DecoderSettings settings;
    settings.limits = FuzzLimits();
    settings.skip_damage = random_() % 2 == 0;
    settings.frame_step = 1 + random_() % 3;
    settings.threads = random_() % 4 == 0 ? 2 : 1;
    if (random_() % 4 == 0) {
      settings.layers = random_() % 4;
      coarse_ = true;
    }
    return settings;
  }

  void Feed() {
    const std::size_t left = stream_.size() - at_, size = std::min<std::size_t>(left, random_() >> random_() % 32);
    const Bytes chunk(stream_.begin() + static_cast<std::ptrdiff_t>(at_),
                      stream_.begin() + static_cast<std::ptrdiff_t>(at_ + size));
    std::span<const std::uint8_t> rest(chunk);
    while (!rest.empty()) {
      const std::size_t before = rest.size();
      if (!decoder_.Send(rest).ok() || rest.size() == before) break;
    }
    at_ += size - rest.size();
  }

  void Receive() {
    FrameInfo info;
    for (std::uint32_t most = random_() % 16; most > 0; --most) {
      const std::unique_ptr<unsigned char[]> memory = MakeBuffers();
      const Status status = decoder_.Receive(buffers_, info);
      if (!status.ok()) return;
      FUZZ_REQUIRE(info.index % settings_.frame_step == 0 && info.index >= next_);
      next_ = std::uint64_t{info.index} + 1;
      Compare(info.index);
    }
  }

  void ReceiveHandles() {
    BlendWeights weights;
    if (!decoder_.Blend(weights).ok()) return;
    std::vector<float> matrices(12 * std::size_t{weights.handle_count});
    FrameInfo info;
    bool exact = false;
    const Status status = random_() % 2 ? decoder_.ReceiveHandles(matrices, info, exact)
                                        : decoder_.InterpolateHandles(0.25 * (random_() % 128), matrices, info, exact);
    if (!status.ok()) return;
    FUZZ_REQUIRE(weights.first.size() == decoder_.mesh()->positions.size() + 1);
    next_ = std::max<std::uint64_t>(next_, info.index);
  }

  void Seek() {
    std::uint64_t byte = 0;
    const std::uint32_t frame = random_() >> random_() % 32;
    const double rate = decoder_.info() ? decoder_.info()->frames_per_second() : 0;
    const Status status = random_() % 2 ? decoder_.Seek(frame, byte) : decoder_.SeekTime((frame + 0.5) / rate, byte);
    if (!status.ok()) return;
    FUZZ_REQUIRE(byte <= stream_.size() || whole_.empty());
    at_ = static_cast<std::size_t>(std::min<std::uint64_t>(byte, stream_.size()));
    next_ = frame;
  }

  void Interpolate() {
    const double times[] = {std::nan(""), -1, 1e10, 0.25 * (random_() % 128), static_cast<double>(next_)};
    const double time = times[random_() % 5];
    const std::unique_ptr<unsigned char[]> memory = MakeBuffers();
    FrameInfo info;
    if (!decoder_.Interpolate(time, buffers_, info).ok()) return;
    next_ = std::max<std::uint64_t>(next_, info.index);
    if (time == info.index) Compare(info.index);
  }

  void AddIndex() {
    std::size_t needed = kStreamTail;
    Status status = Status::NeedMoreData();
    while (status.code() == StatusCode::kNeedMoreData && needed <= stream_.size()) {
      const std::span<const std::uint8_t> tail = stream_.last(needed);
      status = decoder_.AddIndex(Bytes(tail.begin(), tail.end()), needed);
    }
  }

  void Reset() {
    decoder_.Reset();
    at_ = 0;
    next_ = 0;
  }

  // Memory that fits, when it is known what does; else any.
  std::unique_ptr<unsigned char[]> MakeBuffers() {
    const std::size_t vertices = decoder_.mesh() && random_() % 8 ? decoder_.mesh()->positions.size() : random_() % 8;
    const std::size_t stride = 12 + random_() % 5, size = vertices == 0 ? 0 : stride * (vertices - 1) + 12;
    auto memory = std::make_unique<unsigned char[]>(2 * size);
    buffers_.positions = {memory.get(), size, stride, VertexFormat::kFloat32};
    buffers_.normals = {memory.get() + size, size, stride,
                        random_() % 2 ? VertexFormat::kFloat32 : VertexFormat::kInt16};
    return memory;
  }

  // Fields are summed up in the order of decoding, so the last digits may differ: of turns by more than any step is
  // good for, all digits.
  void Compare(std::uint32_t index) const {
    if (coarse_ || whole_.empty() || !(std::max(decoder_.info()->motion_step, decoder_.info()->rotation_step) <= 1))
      return;
    FUZZ_REQUIRE(index < whole_.size());
    const Positions& expected = whole_[index];
    float largest = 0;
    for (const Vec3f& p : expected) largest = std::max({largest, std::abs(p[0]), std::abs(p[1]), std::abs(p[2])});
    for (std::size_t v = 0; v < expected.size(); ++v) {
      const Vec3f out = FloatsAt(buffers_.positions, v);
      for (std::size_t a = 0; a < 3; ++a) FUZZ_REQUIRE(std::abs(out[a] - expected[v][a]) <= 1e-5f * largest);
    }
  }
  static Vec3f FloatsAt(const VertexBuffer& buffer, std::size_t vertex) {
    Vec3f floats;
    std::memcpy(floats.data(), static_cast<const unsigned char*>(buffer.data) + vertex * buffer.stride, sizeof floats);
    return floats;
  }

  const std::span<const std::uint8_t> stream_;
  std::mt19937& random_;
  const std::vector<Positions> whole_;
  const DecoderSettings settings_;
  Decoder decoder_;
  FrameBuffers buffers_;
  std::size_t at_ = 0;      // of the stream, that is sent next
  std::uint64_t next_ = 0;  // frames before are not given out
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::uint8_t> input(data, size);
  std::mt19937 random(Crc32(input));
  const Bytes stream = random() % 2 ? Bytes(input.begin(), input.end()) : Repaired(input);
  Player player(stream, random);
  for (int i = 0; i < kCalls; ++i) player.Call();
  return 0;
}
