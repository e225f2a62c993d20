// Runs every worked example of spec.md, with the numbers as they stand there, and compares the code with a decoder
// written from the text.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <numeric>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "codec/components.h"
#include "codec/decode/decoder.h"
#include "codec/deformation.h"
#include "codec/encode/position_search.h"
#include "codec/harmonics.h"
#include "codec/laplacian.h"
#include "codec/patches.h"
#include "codec/position_coder.h"
#include "codec/radial_functions.h"
#include "conformance/spec_examples.h"
#include "conformance/text_decoder.h"
#include "conformance/text_positions.h"
#include "format/bytes.h"
#include "format/crc32.h"
#include "format/frame_coder.h"
#include "format/group_structure.h"
#include "format/harmonic_order.h"
#include "format/integer_coder.h"
#include "format/logistic.h"
#include "format/packet.h"
#include "format/plane_layout.h"
#include "format/plane_models.h"
#include "format/prediction.h"
#include "format/range_coder.h"
#include "format/stream_index.h"

namespace sac {
namespace {

// The examples that a test below runs.
const std::set<std::string> kRun = {"classes",
                                    "coefficients",
                                    "crc32",
                                    "deformation-gradient",
                                    "generic",
                                    "group-structure",
                                    "group-structure-cut",
                                    "harmonic-order",
                                    "inhomogeneity",
                                    "index",
                                    "integers",
                                    "level-steps",
                                    "level-steps-capped",
                                    "logistic",
                                    "packet",
                                    "patches",
                                    "range-coder",
                                    "records",
                                    "reduced",
                                    "state",
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
  EndSyntax end{number(1), StreamIndex{number(3), {}}};
  for (std::size_t i = 5; i + 1 < words.size(); i += 2) end.index->groups.push_back({number(i), number(i + 1)});
  const Bytes packet = WritePacket(PacketType::kEnd, WriteEnd(end));
  EXPECT_EQ(Hex(packet), Equation(lines.at(1)).second);
  StreamIndex read;
  std::size_t needed = 0;
  ASSERT_TRUE(ReadIndex(packet, read, needed).ok());
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

TEST(Spec, GroupStructure) {
  for (const char* id : {"group-structure", "group-structure-cut"}) {
    const Lines& lines = Example(id);
    ASSERT_FALSE(lines.empty());
    unsigned frames = 0, pyramid = 0;
    ASSERT_EQ(std::sscanf(lines[0].c_str(), "frames %u pyramid %u", &frames, &pyramid), 2);
    const std::vector<FrameSlot> slots = GroupStructure(frames, pyramid);
    ASSERT_EQ(slots.size(), lines.size() - 1);
    for (std::size_t i = 0; i < slots.size(); ++i) {
      std::ostringstream line;
      line << "display " << slots[i].display << " level " << slots[i].level << " references";
      for (const std::uint32_t r : slots[i].references) line << " " << r;
      EXPECT_EQ(line.str(), lines[i + 1]);
    }
  }
}

TEST(Spec, HarmonicOrder) {
  const Lines& lines = Example("harmonic-order");
  ASSERT_EQ(lines.size(), 2u);
  std::ostringstream order;
  order << "order";
  const auto counts = Row<std::uint32_t>("harmonic-order", "counts");
  for (const HarmonicIndex& i : HarmonicOrder(counts)) order << " (" << i.component << "," << i.k << ")";
  EXPECT_EQ(order.str(), lines[1]);
}

TEST(Spec, LevelSteps) {
  for (const char* id : {"level-steps", "level-steps-capped"}) {
    SequenceHeader header;
    header.level_growth = Row<std::uint8_t>(id, "growth").at(0);
    const auto steps = Row<std::int32_t>(id, "steps");
    for (std::size_t level = 0; level < steps.size(); ++level) {
      const auto l = static_cast<std::uint32_t>(level);
      for (const Plane plane : {kMotion, kDisplacement, kDetail}) {
        EXPECT_EQ(LevelStep(header, plane, l), steps[level]) << id << " " << level;
      }
      EXPECT_EQ(LevelStep(header, kCorrection, l), 16);
    }
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

TEST(Spec, TextReadsIntegers) {
  for (const std::string& line : Example("integers")) {
    const auto [left, hex] = Equation(line);
    const auto words = Words(left);
    const Bytes bytes = Unhex(hex);
    TextDecoder in(bytes);
    TextUe ue;
    TextSe se;
    EXPECT_EQ(words.at(0) == "ue" ? static_cast<std::int64_t>(ReadUe(in, ue)) : ReadSe(in, se), std::stol(words.at(1)));
    EXPECT_TRUE(in.AtEnd()) << line;
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
  for (std::int32_t x = -kMaxLogit; x <= kMaxLogit; ++x) EXPECT_EQ(Probability(x), TextSquash(x));
  for (std::uint32_t p = 0; p < 65536; ++p) ASSERT_EQ(Logit(p), TextStretch(p));
}

TEST(Spec, State) {
  const auto bins = Row<int>("state", "bins");
  const auto probabilities = Row<std::int64_t>("state", "probabilities"), inputs = Row<std::int64_t>("state", "inputs");
  AdaptiveBit state;
  TextState text;
  for (std::size_t i = 0; i < bins.size(); ++i) {
    EXPECT_EQ(text.p, probabilities.at(i));
    EXPECT_EQ(text.Input(), inputs.at(i));
    EXPECT_EQ(state.logit(), inputs.at(i));
    state.Update(bins[i] != 0);
    text.Update(bins[i]);
  }
}

TEST(Spec, Classes) {
  const auto x = Row<std::uint32_t>("classes", "x"), q = Row<std::uint32_t>("classes", "Q");
  ASSERT_EQ(x.size(), q.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_EQ(HalfOctave(x[i]), q[i]);
    EXPECT_EQ(Q(x[i]), q[i]);
  }
  EXPECT_EQ(HarmonicClass(0), 1);
  EXPECT_EQ(HarmonicClass(6), 5);
  EXPECT_EQ(HarmonicClass(8000), 23);
}

TEST(Spec, TextReadsFrames) {
  std::mt19937 random(1);
  const auto geometric = [&](unsigned one_in) {  // small magnitudes often, great ones now and then
    std::int32_t value = 0;
    for (unsigned bit = 0; bit < 20 && random() % one_in == 0; ++bit) {
      value = 2 * value + 1 + static_cast<std::int32_t>(random() % 2);
    }
    return random() % 2 ? value : -value;
  };
  const auto counts = [&](unsigned most) {
    std::vector<std::uint32_t> list(1 + random() % 3);
    for (std::uint32_t& c : list) c = 1 + random() % most;
    return list;
  };
  for (int trial = 0; trial < 30; ++trial) {
    const std::vector<std::uint32_t> harmonics = counts(trial == 0 ? 300 : 20);
    std::vector<std::uint32_t> patches = counts(30);
    SequenceHeader header;
    header.vertices = std::accumulate(patches.begin(), patches.end(), 0u);
    header.detail_step = trial % 2 ? 1 : 0;
    header.correction_step = trial % 3 ? 1 : 0;
    header.level_growth = static_cast<std::uint8_t>(64 + random() % 65);
    const PlaneLayouts layouts = LayOutPlanes(header, harmonics, patches);
    const std::vector<FrameSlot> structure = GroupStructure(1 + random() % 20, 1 + random() % 9);
    RangeEncoder coder;
    FrameCoder<RangeEncoder> writer(header, layouts);
    std::vector<FrameSyntax> frames;
    for (std::uint32_t i = 0; i < structure.size(); ++i) {
      FrameSyntax& frame = frames.emplace_back();
      frame.slot = structure[i];
      frame.planes = EmptyPlanes(layouts);
      if (i > 0 && random() % 3 == 0) {
        frame.slot.references.resize(random() % 3);
        for (std::uint32_t& r : frame.slot.references) r = random() % i;
      }
      if (random() % 3 > 0) {
        for (auto& v : frame.rigid) v = geometric(2);
      }
      for (PlaneValues& plane : frame.planes) {
        if (random() % 3 == 0) continue;
        const unsigned one_in = 2 + random() % 3;
        for (auto& v : plane) v = geometric(one_in);
      }
      ASSERT_TRUE(writer.Code(coder, structure[i], frame));
    }
    const Bytes bytes = coder.Finish();
    TextDecoder in(bytes);
    if (header.detail_step == 0) patches.clear();
    TextFrameReader reader(harmonics, patches, header.correction_step > 0 ? header.vertices : 0, header.level_growth,
                           true);
    for (std::size_t f = 0; f < structure.size(); ++f) {
      const TextFrame& frame = reader.Read(in, structure[f]);
      EXPECT_EQ(frame.references, frames[f].slot.references);
      EXPECT_TRUE(std::equal(frame.rigid.begin(), frame.rigid.end(), frames[f].rigid.begin()));
      for (std::size_t p = 0; p < 4; ++p) {
        std::vector<std::int32_t> values;
        for (const auto& row : frame.planes[p]) values.insert(values.end(), row.begin(), row.end());
        ASSERT_EQ(values, frames[f].planes[p]) << "frame " << f << ", plane " << p;
      }
    }
    EXPECT_TRUE(in.AtEnd());
  }
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

TEST(Spec, Generic) {
  for (const std::string& line : Example("generic")) {
    const auto [i, value] = Equation(line);
    EXPECT_NEAR(G(std::stoul(i)), std::stod(value), 1e-15);
  }
}

// A wavy sheet of w x w vertices with a degenerate and a duplicate triangle, and apart from it a lone triangle.
TextMesh Sheet(std::uint32_t w) {
  TextMesh mesh;
  for (std::uint32_t y = 0; y < w; ++y) {
    for (std::uint32_t x = 0; x < w; ++x) mesh.grid.push_back({10 * x + y, 13 * y, (7 * x * y + 3 * x) % 11});
  }
  for (std::uint32_t y = 0; y + 1 < w; ++y) {
    for (std::uint32_t x = 0; x + 1 < w; ++x) {
      const std::uint32_t v = y * w + x;
      mesh.triangles.push_back({v, v + 1, v + w});
      mesh.triangles.push_back({v + 1, v + w + 1, v + w});
    }
  }
  mesh.triangles.push_back({0, 0, 2});
  mesh.triangles.push_back(mesh.triangles[3]);
  const auto v = static_cast<std::uint32_t>(mesh.grid.size());
  for (const std::array<std::uint32_t, 3>& g : {std::array{100u, 5u, 0u}, {104u, 9u, 1u}, {97u, 15u, 3u}}) {
    mesh.grid.push_back(g);
  }
  mesh.triangles.push_back({v, v + 1, v + 2});
  return mesh;
}

TEST(Spec, ReducedFunctions) {
  std::vector<std::array<std::uint32_t, 3>> grid;
  for (std::uint32_t v = 0; v < 10; ++v) grid.push_back({v * v, 0, 0});
  const auto wanted = Row<std::size_t>("reduced", "samples");
  std::vector<std::size_t> samples;
  std::int64_t covering = 0;
  const Eigen::MatrixXd text = TextFunctions(grid, wanted.size(), samples, covering);
  EXPECT_EQ(samples, wanted);
  EXPECT_EQ(covering, Row<std::int64_t>("reduced", "covering").at(0));
  const Eigen::MatrixXd code = RadialFunctions(grid, static_cast<std::uint32_t>(wanted.size()));
  EXPECT_LT((code - text).cwiseAbs().maxCoeff(), 1e-14);
  const auto row = Row<double>("reduced", "functions");
  for (std::size_t i = 0; i < row.size(); ++i) EXPECT_NEAR(text(7, static_cast<Eigen::Index>(i)), row[i], 5.1e-7);
}

TEST(Spec, HarmonicBasis) {
  for (const std::uint32_t w : {5u, 12u}) {  // solved densely, and by Lanczos' method
    for (const std::uint32_t samples_per_harmonic : {0u, 2u}) {
      const TextMesh mesh = Sheet(w);
      PositionMatrix positions(static_cast<Eigen::Index>(mesh.grid.size()), 3);
      for (std::size_t v = 0; v < mesh.grid.size(); ++v) {
        positions.row(static_cast<Eigen::Index>(v)) = Point(mesh.grid[v]);
      }
      const EdgeList edges = BuildEdges(mesh.triangles);
      const std::vector<double> weights = CotangentWeights(positions, mesh.triangles, edges);
      std::size_t e = 0;
      for (const auto& [edge, weight] : TextWeights(mesh)) {
        EXPECT_EQ(edges.ends.at(e), edge);
        EXPECT_NEAR(weights.at(e++), weight, 1e-12);
      }
      EXPECT_EQ(weights.size(), e);
      const Eigen::VectorXd masses = VertexMasses(positions, mesh.triangles);
      EXPECT_LT((masses - TextMasses(mesh)).cwiseAbs().maxCoeff(), 1e-15);

      const std::array<Component, 2> components = {Component{0, w * w}, Component{w * w, 3}};
      const std::array<std::uint32_t, 2> counts = {10, 3};
      HarmonicBasis basis;
      ASSERT_TRUE(
          ComputeHarmonics(edges, weights, masses, mesh.grid, components, counts, samples_per_harmonic, basis).ok());
      double f0 = 0, f1 = 0;
      for (std::size_t c = 0; c < 2; ++c) {
        Eigen::VectorXd values;
        Eigen::MatrixXd h;
        TextBasis(mesh, masses, components[c].first, components[c].count, counts[c], samples_per_harmonic, values, h);
        EXPECT_LT((basis.components[c].eigenvalues - values).cwiseAbs().maxCoeff(), 1e-7 * values.maxCoeff());
        EXPECT_LT((basis.components[c].vectors - h).cwiseAbs().maxCoeff(), 1e-7);
        f0 += values.sum();
        for (Eigen::Index k = 0; k < h.cols(); ++k) {
          for (Eigen::Index v = 0; v < h.rows(); ++v) {
            f1 += G(3 * static_cast<std::uint64_t>(k)) * G(7 * static_cast<std::uint64_t>(v)) * h(v, k) /
                  static_cast<double>(h.rows());
          }
        }
      }
      const auto fingerprint = basis.Fingerprint();
      EXPECT_NEAR(fingerprint[0], f0, 1e-6 * f0);
      EXPECT_NEAR(fingerprint[1], f1, 1e-6);
    }
  }
}

TEST(Spec, PatchHarmonics) {
  const TextMesh mesh = Sheet(5);
  PositionMatrix positions(static_cast<Eigen::Index>(mesh.grid.size()), 3);
  for (std::size_t v = 0; v < mesh.grid.size(); ++v) positions.row(static_cast<Eigen::Index>(v)) = Point(mesh.grid[v]);
  const EdgeList edges = BuildEdges(mesh.triangles);
  const std::vector<double> weights = CotangentWeights(positions, mesh.triangles, edges);
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(positions.rows());
  const std::array<Component, 3> patches = {Component{0, 10}, Component{10, 15},
                                            Component{25, 3}};  // rows of the sheet
  const std::array<std::uint32_t, 3> counts = {10, 15, 3};
  HarmonicBasis basis;
  ASSERT_TRUE(ComputeHarmonics(edges, weights, ones, mesh.grid, patches, counts, 0, basis).ok());
  for (std::size_t p = 0; p < 3; ++p) {
    Eigen::VectorXd values;
    Eigen::MatrixXd h;
    TextBasis(mesh, ones, patches[p].first, patches[p].count, counts[p], 0, values, h);
    EXPECT_LT((basis.components[p].vectors - h).cwiseAbs().maxCoeff(), 1e-9);
    const Eigen::MatrixXd gram = h.transpose() * h / counts[p];
    EXPECT_LT((gram - Eigen::MatrixXd::Identity(h.cols(), h.cols())).cwiseAbs().maxCoeff(), 1e-9);
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

TEST(Spec, TextReadsTheWholeStream) {
  const Bytes bytes = WholeStream();
  TextStream stream(bytes);
  const std::vector<Eigen::MatrixXd> frames = stream.Decode();
  EXPECT_EQ(stream.triangles(), (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
  for (const auto& row : Rows<double>("stream-positions", "frame")) {
    ASSERT_EQ(row.size(), 5u);
    for (std::size_t a = 0; a < 3; ++a) {
      EXPECT_NEAR(frames.at(static_cast<std::size_t>(row[0]))(static_cast<int>(row[1]), static_cast<int>(a)),
                  row[2 + a], 1e-6);
    }
  }
}

void ExpectTextReads(const std::string& name, std::size_t count_of_frames) {
  std::ifstream file(SAC_CONFORMANCE "/valid/" + name, std::ios::binary);
  const Bytes bytes{std::istreambuf_iterator<char>(file), {}};
  TextStream stream(bytes);
  const std::vector<Eigen::MatrixXd> frames = stream.Decode();
  Decoder decoder;
  std::size_t count = 0;
  for (std::span<const std::uint8_t> rest(bytes); !rest.empty();) {
    const Status status = decoder.Send(rest);
    ASSERT_TRUE(status.ok()) << status.message();
    for (DecodedFrame frame; decoder.Receive(frame).ok(); ++count) {
      for (std::size_t v = 0; v < frame.positions.size(); ++v) {
        for (std::size_t a = 0; a < 3; ++a) {
          EXPECT_NEAR(frame.positions[v][a], frames.at(count)(static_cast<int>(v), static_cast<int>(a)), 1e-5) << count;
        }
      }
    }
  }
  EXPECT_TRUE(decoder.Finish().ok());
  EXPECT_EQ(count, count_of_frames);
  EXPECT_EQ(frames.size(), count_of_frames);
}

TEST(Spec, TextReadsOpenGroups) { ExpectTextReads("open_groups.sac", 18); }
TEST(Spec, TextReadsARepeatedStart) { ExpectTextReads("repeated_start.sac", 205); }

// Section 5.5: a rough sheet with holes, a hub, repeated, degenerate and stray triangles, and loose ends.
TEST(Spec, TextReadsPositions) {
  const std::uint32_t side = 13;
  std::mt19937 random(4);
  std::vector<Triangle> triangles;
  std::vector<std::array<double, 3>> cells;
  for (std::uint32_t v = 0; v < side * side; ++v) {
    const double x = v % side, y = v / side;
    const auto noise = [&] { return static_cast<double>(random() % 1000) / 40; };
    cells.push_back(
        {100 + 90 * x + noise(), 100 + 60 * y * (1 + x / 20) + noise(), 400 + 200 * std::sin(x / 3) + noise()});
    if (v % side + 1 == side || v / side + 1 == side || random() % 12 == 0) continue;
    triangles.push_back({v, v + 1, v + side});
    triangles.push_back({v + 1, v + side + 1, v + side});
  }
  const auto hub = static_cast<std::uint32_t>(cells.size());
  cells.push_back({600, 600, 1000});
  for (std::uint32_t v = 0; v < 40; ++v) triangles.push_back({hub, v, v + 1});
  for (int i = 0; i < 8; ++i) cells.push_back({30.0 * i, 10.0 * i, 7.0});
  triangles.insert(triangles.end(),
                   {{hub + 1, hub + 2, hub + 3}, {hub + 4, hub + 4, hub + 5}, {0, 80, 160}, {1, 2, 20}});
  triangles.insert(triangles.end(), triangles.begin(), triangles.begin() + 20);
  const auto vertices = static_cast<std::uint32_t>(cells.size());
  for (const PositionSteps steps : {PositionSteps{16, 0}, {200, 0}, {20, 900}}) {
    const PositionGraph graph(vertices, triangles);
    const Bytes bytes = EncodePositions(cells, graph, steps, 11);
    std::vector<GridPosition> wanted;
    ASSERT_TRUE(DecodePositions(bytes, graph, steps, 11, wanted).ok());
    TextDecoder in(bytes);
    const auto read = TextPositions(vertices, triangles, steps.base, steps.slope, 11).Read(in);
    EXPECT_TRUE(in.AtEnd());
    ASSERT_EQ(read.size(), wanted.size());
    for (std::uint32_t v = 0; v < vertices; ++v) {
      for (std::size_t a = 0; a < 3; ++a) ASSERT_EQ(read[v][a], wanted[v][a]) << v << " " << a;
    }
  }
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
