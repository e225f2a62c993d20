// SPDX-License-Identifier: Apache-2.0
// Runs the worked examples of spec.md, with the numbers as they stand there. The second decoder
// (conformance/decoder/check_examples.py) does so by itself.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cstdint>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "codec/handles.h"
#include "codec/patches.h"
#include "format/bit_mixer.h"
#include "format/bytes.h"
#include "format/crc32.h"
#include "format/integer_coder.h"
#include "format/logistic.h"
#include "format/packet.h"
#include "format/plane_layout.h"
#include "format/plane_models.h"
#include "format/prediction.h"
#include "format/range_coder.h"
#include "format/stream_index.h"
#include "geometry/components.h"
#include "geometry/deformation.h"
#include "geometry/edges.h"
#include "sac/decoder.h"
#include "tests/spec_examples.h"

namespace sac {
namespace {

// The examples that a test here or in spec_positions_test.cpp runs, and those that are for the second decoder:
// "generic", "inhomogeneity" and "weights" are constants of the code, which the vectors of conformance/ check.
const std::set<std::string> kRun = {"bit-model",
                                    "classes",
                                    "coefficients",
                                    "copies",
                                    "crc32",
                                    "deformation-gradient",
                                    "generic",
                                    "group-structure",
                                    "group-structure-cut",
                                    "handles",
                                    "harmonic-order",
                                    "inhomogeneity",
                                    "index",
                                    "integers",
                                    "layered-order",
                                    "level-steps",
                                    "level-steps-capped",
                                    "logistic",
                                    "mixed",
                                    "packet",
                                    "patches",
                                    "positions",
                                    "range-coder",
                                    "records",
                                    "stream",
                                    "stream-positions",
                                    "varint",
                                    "weights"};

TEST(Spec, HasNoOtherExamples) {
  std::set<std::string> ids;
  for (const auto& [id, lines] : Examples()) ids.insert(id);
  EXPECT_EQ(ids, kRun);
}

TEST(Spec, Varint) {
  for (const std::string& line : Example("varint")) {
    const auto [value, bytes] = Equation(line);
    const Bytes coded = Unhex(bytes);
    ByteReader reader(coded);
    if (value == "malformed") {
      reader.Varint();
      EXPECT_FALSE(reader.ok()) << line;
      continue;
    }
    const auto number = static_cast<std::uint32_t>(std::stoul(value));
    EXPECT_EQ(reader.Varint(), number);
    EXPECT_TRUE(reader.ok() && reader.remaining() == 0) << line;
    ByteWriter writer;
    writer.Varint(number);
    EXPECT_EQ(Hex(writer.bytes()), bytes);
  }
}

TEST(Spec, Crc32) {
  for (const std::string& line : Example("crc32")) {
    const auto [quoted, crc] = Equation(line);
    const Bytes bytes(quoted.begin() + 1, quoted.end() - 1);
    EXPECT_EQ(Crc32(bytes), std::stoul(crc, nullptr, 16));
  }
}

TEST(Spec, Packet) {
  for (const std::string& line : Example("packet")) {
    const auto [frames, bytes] = Equation(line);
    ByteWriter payload;
    payload.Varint(static_cast<std::uint32_t>(std::stoul(frames)));
    EXPECT_EQ(Hex(WritePacket(PacketType::kEnd, payload.bytes())), bytes);
  }
}

TEST(Spec, Index) {
  const auto lines = Example("index");
  const auto words = Words(lines.at(0));
  const auto number = [&](std::size_t i) { return static_cast<std::uint32_t>(std::stoul(words.at(i))); };
  EndSyntax end{number(1), StreamIndex{number(3), {}, {}}};
  for (std::size_t i = 5; i + 1 < words.size(); i += 2) end.index->groups.push_back({number(i), number(i + 1)});
  const Bytes packet = WritePacket(PacketType::kEnd, WriteEnd(end));
  EXPECT_EQ(Hex(packet), Equation(lines.at(1)).second);
  StreamIndex read;
  std::size_t needed = 0;
  ASSERT_TRUE(ReadIndex(packet, {}, read, needed).ok());
  EXPECT_EQ(read, *end.index);
  EXPECT_EQ(needed, packet.size());
}

TEST(Spec, Records) {
  RecordWriter records;
  records.Open(0);
  for (const std::string& line : Example("records")) {
    const auto [what, bytes] = Equation(line);
    if (what == "end") {
      EXPECT_EQ(Hex(records.End()), bytes);
      continue;
    }
    std::vector<std::uint8_t> code;
    const auto words = Words(what);
    for (std::size_t i = 1; i < words.size(); ++i) {
      code.push_back(static_cast<std::uint8_t>(std::stoul(words[i], nullptr, 16)));
    }
    EXPECT_EQ(Hex(records.Frame(code)), bytes);
  }
}

TEST(Spec, DeformationGradient) {
  const auto channels = Row<double>("deformation-gradient", "channels");
  ASSERT_EQ(channels.size(), 9u);
  const Eigen::Matrix3d j = DeformationGradient(channels.data());
  const auto rows = Rows<double>("deformation-gradient", "row");
  ASSERT_EQ(rows.size(), 3u);
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(j(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)), rows[r].at(c), 5.1e-7);
    }
  }
}

TEST(Spec, RangeCoder) {
  const auto bins = Row<int>("range-coder", "bins");
  const auto probabilities = Row<std::uint32_t>("range-coder", "probabilities");
  const auto raw = Row<std::uint32_t>("range-coder", "raw");
  RangeEncoder coder;
  BitModel model;
  for (std::size_t i = 0; i < bins.size(); ++i) {
    EXPECT_EQ(model.probability(), probabilities.at(i));
    bool bit = bins[i] != 0;
    coder.Bit(model, bit);
  }
  std::uint32_t value = raw.at(1);
  coder.Raw(value, static_cast<int>(raw.at(0)));
  std::string bytes;
  for (const std::string& line : Example("range-coder")) {
    if (line.rfind("bytes ", 0) == 0) bytes = line.substr(6);
  }
  EXPECT_EQ(Hex(coder.Finish()), bytes);
}

TEST(Spec, Integers) {
  for (const std::string& line : Example("integers")) {
    const auto [left, bytes] = Equation(line);
    const auto words = Words(left);
    RangeEncoder coder;
    if (words.at(0) == "ue") {
      UnsignedModels models;
      auto value = static_cast<std::uint32_t>(std::stoul(words.at(1)));
      CodeUnsigned(coder, models, value);
    } else {
      SignedModels models;
      std::int32_t value = std::stoi(words.at(1));
      CodeSigned(coder, models, value);
    }
    EXPECT_EQ(Hex(coder.Finish()), bytes) << line;
  }
}

// A plane of one row, the displacement plane of a stream with one harmonic.
SequenceHeader OneHarmonic() {
  SequenceHeader header;
  header.vertices = 1;
  header.harmonics = 1;
  return header;
}

TEST(Spec, Coefficients) {
  const std::array<std::uint32_t, 1> one = {1};
  const PlaneLayouts layouts = LayOutPlanes(OneHarmonic(), one, one);
  const std::vector<std::int32_t> zeros(layouts[kDisplacement].size());
  for (const std::string& line : Example("coefficients")) {
    const auto [left, hex] = Equation(line);
    PlaneModels models(kDisplacement, layouts[kDisplacement]);
    models.contexts.Start(0, 16, kDisplacement, ReferenceFrames(), zeros, zeros);
    RangeEncoder coder;
    std::int32_t value = std::stoi(left);
    EXPECT_TRUE(models.Code(coder, models.contexts.Next(), value));
    EXPECT_EQ(Hex(coder.Finish()), hex) << line;
  }
}

TEST(Spec, Logistic) {
  std::vector<std::int32_t> curve;
  for (const std::string& line : Example("logistic")) {
    for (const auto x : Numbers<std::int32_t>(Words(line), 0)) curve.push_back(x);
  }
  EXPECT_TRUE(std::equal(curve.begin(), curve.end(), kLogisticCurve.begin(), kLogisticCurve.end()));
}

TEST(Spec, BitModel) {
  const auto bins = Row<int>("bit-model", "bins");
  const auto probabilities = Row<std::uint32_t>("bit-model", "probabilities");
  const auto inputs = Row<std::int32_t>("bit-model", "inputs");
  BitModel model;
  for (std::size_t i = 0; i < bins.size(); ++i) {
    EXPECT_EQ(model.probability(), probabilities.at(i));
    EXPECT_EQ(model.logit(), inputs.at(i));
    model.Update(bins[i] != 0);
  }
}

// A coder that keeps the probabilities of the bins that it is given.
struct ProbabilityRecorder {
  static constexpr bool kDecodes = false;
  void Decide(std::uint32_t p, bool&) { probabilities.push_back(p); }
  std::vector<std::uint32_t> probabilities;
};

TEST(Spec, Mixed) {
  const auto weights = Row<std::int32_t>("mixed", "weights");
  ASSERT_EQ(weights.size(), 3u);
  std::array<BitModel, 2> models;
  Mixer<3> first({weights[0], weights[1], weights[2]}), second = first;
  ProbabilityRecorder coder;
  for (const int bin : Row<int>("mixed", "bins")) {
    Mixer<3>::Inputs inputs = {0, 0, Row<std::int32_t>("mixed", "feature").at(0)};
    bool bit = bin != 0;
    CodeMixed(coder, first, second, inputs, std::array{&models[0], &models[1]}, bit);
  }
  EXPECT_EQ(coder.probabilities, Row<std::uint32_t>("mixed", "probabilities"));
}

TEST(Spec, Classes) {
  const auto x = Row<std::uint32_t>("classes", "x"), q = Row<std::uint32_t>("classes", "Q");
  ASSERT_EQ(x.size(), q.size());
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_EQ(HalfOctave(x[i]), q[i]);
  EXPECT_EQ(HarmonicClass(0), 1);
  EXPECT_EQ(HarmonicClass(6), 5);
  EXPECT_EQ(HarmonicClass(8000), 23);
}

TEST(Spec, Patches) {
  const auto size = Row<std::uint32_t>("patches", "size").at(0);
  std::vector<GridPosition> grid;
  std::vector<Triangle> chain;
  std::vector<std::uint32_t> component;
  for (const auto x : Row<std::uint32_t>("patches", "x")) {
    const auto v = static_cast<std::uint32_t>(grid.size());
    grid.push_back({x, 1, 1});
    if (v > 0) chain.push_back({v - 1, v, v});
    component.push_back(v);
  }
  const VertexGraph graph = BuildGraph(static_cast<std::uint32_t>(grid.size()), chain);
  const PatchOrder order = CutIntoPatches(grid, graph, component, size);
  std::ostringstream line;
  line << "patches";
  std::size_t v = 0;
  for (std::size_t p = 0; p < order.sizes.size(); ++p) {
    if (p > 0) line << " |";
    for (std::uint32_t i = 0; i < order.sizes[p]; ++i) line << " " << order.vertices.at(v++);
  }
  EXPECT_EQ(line.str(), Example("patches").at(2));
}

TEST(Spec, SaysItsVersion) {
  std::ifstream file(SAC_SPEC);
  const std::string text{std::istreambuf_iterator<char>(file), {}}, major = std::to_string(kVersionMajor),
                                                                    minor = std::to_string(kVersionMinor);
  EXPECT_NE(text.find("\nVersion " + major + "." + minor + ".\n"), std::string::npos);
  EXPECT_NE(text.find("\n| `version_major` | u8 | " + major + " |"), std::string::npos);
  EXPECT_NE(text.find("\n| `version_minor` | u8 | " + minor + " |"), std::string::npos);
}

TEST(Spec, Handles) {
  std::vector<GridPosition> grid;
  EdgeList line;
  for (std::uint32_t v = 0; v < 10; ++v) {
    grid.push_back({v * v, 0, 0});
    if (v > 0) line.ends.push_back({v - 1, v});
  }
  const auto vertices = Row<std::uint32_t>("handles", "handles");
  Handles handles;
  ASSERT_TRUE(ChooseHandles(BuildEdgeGraph(10, line), EdgeLengths(line, grid), std::vector<Component>{{0, 10}},
                            std::vector<std::uint32_t>{3}, std::vector<std::uint32_t>{1}, 1e9, handles)
                  .ok());
  EXPECT_EQ(handles.vertices, vertices);
  const auto followed = Row<std::uint32_t>("handles", "followed");
  const auto weights = Row<double>("handles", "weights");
  ASSERT_EQ(handles.FollowedBy(7).size(), followed.size());
  for (std::size_t i = 0; i < followed.size(); ++i) {
    EXPECT_EQ(handles.FollowedBy(7)[i], followed[i]);
    EXPECT_NEAR(handles.WeightsOf(7)[i], weights[i], 5.1e-7);
  }
}

// --- Appendix A. ----------------------------------------------------------------------------------------------------

Bytes WholeStream() {
  Bytes bytes;
  for (const std::string& line : Example("stream")) {
    const Bytes part = Unhex(line.substr(0, line.find('|')));
    bytes.insert(bytes.end(), part.begin(), part.end());
  }
  return bytes;
}

TEST(Spec, DecoderReadsTheWholeStream) {
  const Bytes bytes = WholeStream();
  Decoder decoder;
  std::vector<DecodedFrame> frames;
  for (std::span<const std::uint8_t> rest(bytes); !rest.empty();) {
    const Status status = decoder.Send(rest);
    ASSERT_TRUE(status.ok()) << status.message();
    for (DecodedFrame frame; decoder.Receive(frame).ok();) frames.push_back(frame);
  }
  ASSERT_TRUE(decoder.Finish().ok());
  const auto wanted = Rows<double>("stream-positions", "frame");
  ASSERT_FALSE(wanted.empty());
  std::size_t count = 0;
  for (const auto& row : wanted) {  // frame, vertex, x, y, z
    ASSERT_EQ(row.size(), 5u);
    for (std::size_t a = 0; a < 3; ++a) {
      EXPECT_NEAR(frames.at(static_cast<std::size_t>(row[0])).positions.at(static_cast<std::size_t>(row[1]))[a],
                  row[2 + a], 2e-6);
    }
    ++count;
  }
  EXPECT_EQ(count, frames.size() * decoder.mesh()->positions.size());
}

}  // namespace
}  // namespace sac
