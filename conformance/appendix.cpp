// SPDX-License-Identifier: Apache-2.0
#include "conformance/appendix.h"

#include <cstdio>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

#include "conformance/stream_parts.h"
#include "format/bytes.h"
#include "format/stream_index.h"
#include "sac/decoder.h"

namespace sac {
namespace {

// A listing: lines of bytes in hexadecimal with their meaning.
class Listing {
 public:
  void Add(std::span<const std::uint8_t> bytes, const std::string& meaning) {
    constexpr std::size_t kPerLine = 16;
    for (std::size_t i = 0; i < bytes.size(); i += kPerLine) {
      std::string line;
      for (std::size_t j = i; j < std::min(i + kPerLine, bytes.size()); ++j) {
        char digits[4];
        std::snprintf(digits, sizeof digits, "%02X ", static_cast<unsigned>(bytes[j]));
        line += digits;
      }
      line.resize(3 * kPerLine, ' ');
      text_ += line + "| " + (i == 0 ? meaning : "") + "\n";
    }
  }
  void AddPacket(PacketType type, const Bytes& payload, const std::string& name) {
    const Bytes packet = WritePacket(type, payload);
    const std::span<const std::uint8_t> all(packet);
    Add(all.first(all.size() - payload.size() - 4),
        "tag: " + name + " of " + std::to_string(payload.size()) + " bytes");
    AddPayload(type, all.subspan(all.size() - payload.size() - 4, payload.size()));
    Add(all.last(4), "CRC-32");
  }

  std::string text() const {
    std::string trimmed;  // no blanks at line ends
    std::istringstream in(text_);
    for (std::string line; std::getline(in, line);) trimmed += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
    return trimmed;
  }

 private:
  void AddPayload(PacketType type, std::span<const std::uint8_t> payload) {
    ByteReader reader(payload);
    std::size_t mark = 0;
    const auto element = [&](const std::string& meaning) {
      Add(payload.subspan(mark, reader.position() - mark), meaning);
      mark = reader.position();
    };
    const auto number = [](const std::string& name, double value) {
      std::ostringstream out;
      out << name << " = " << value;
      return out.str();
    };
    switch (type) {
      case PacketType::kHeader: {
        SequenceHeader header;
        VisitFields(header, [&]<class Value>(const char* name, Value&) {
          double value = 0;
          if constexpr (sizeof(Value) == 1) {
            value = reader.U8();
          } else if constexpr (std::is_same_v<Value, float>) {
            value = static_cast<double>(reader.F32());
          } else {
            value = reader.Varint();
          }
          element(number(name, value));
        });
        break;
      }
      case PacketType::kIFrame:
        element(number("mesh_size", reader.Varint()));
        reader.Bytes(reader.remaining());
        element("side information, a range code");
        break;
      case PacketType::kGroup:
        for (const char* name : {"frames", "first_frame", "structure"}) element(number(name, reader.Varint()));
        reader.Bytes(reader.remaining());
        element("frames, a range code");
        break;
      case PacketType::kEnd:
        element(number("frames", reader.Varint()));
        break;
      default:
        break;
    }
  }

  std::string text_;
};

std::string StreamListing() {
  const StreamParts parts = SmallStream();
  Listing listing;
  listing.Add(Magic(), "the four bytes of every stream");
  listing.AddPacket(PacketType::kHeader, WriteSequenceHeader(parts.header), "sequence header");
  listing.AddPacket(PacketType::kIFrame, WriteIFrame(parts.i_frame, parts.header), "I-frame");
  listing.AddPacket(PacketType::kGroup, parts.groups.at(0), "group");
  listing.AddPacket(PacketType::kEnd, WriteEnd({parts.frames, std::nullopt}), "end");
  return listing.text();
}

std::string PositionListing() {
  const Bytes stream = SmallStream().Join();
  Decoder decoder;
  std::string text;
  for (std::span<const std::uint8_t> rest(stream); !rest.empty();) {
    if (!decoder.Send(rest).ok()) return "";
    for (DecodedFrame frame; decoder.Receive(frame).ok();) {
      for (std::size_t v = 0; v < frame.positions.size(); ++v) {
        char line[120];
        const Vec3f& p = frame.positions[v];
        std::snprintf(line, sizeof line, "frame %u %zu  %.6f %.6f %.6f\n", frame.index, v, static_cast<double>(p[0]),
                      static_cast<double>(p[1]), static_cast<double>(p[2]));
        text += line;
      }
    }
  }
  return text;
}

// Replaces the text between the fences of the example `id` by `content`. Returns false when the example is missing.
bool Replace(std::string& text, const std::string& id, const std::string& content) {
  const std::string open = "```example " + id + "\n";
  const std::size_t at = text.find(open);
  const std::size_t end = at == std::string::npos ? at : text.find("```\n", at + open.size());
  if (end == std::string::npos) return false;
  text.replace(at + open.size(), end - at - open.size(), content);
  return true;
}

}  // namespace

bool UpdateAppendix(const std::filesystem::path& spec) {
  std::ifstream in(spec);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  if (!Replace(text, "stream", StreamListing()) || !Replace(text, "stream-positions", PositionListing())) return false;
  std::ofstream out(spec);
  out << text;
  return static_cast<bool>(out.flush());
}

}  // namespace sac
