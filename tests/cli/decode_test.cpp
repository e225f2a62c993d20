// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <set>
#include <sstream>

#include "files/cache_file.h"
#include "files/mesh_file.h"
#include "sac/encoder.h"
#include "tests/cli/sac_command.h"
#include "tests/hard_cube.h"

namespace sac {
namespace {

class DecodeTest : public SacCommandOnClip {
 protected:
  Mesh Load(const std::string& name) const {
    Mesh mesh;
    const Status status = ReadMesh(Path(name), mesh);
    EXPECT_TRUE(status.ok()) << status.message();
    return mesh;
  }

  std::vector<Positions> LoadCache(const std::string& name) const {
    std::unique_ptr<CacheReader> reader;
    const Status status = CacheReader::Open(Path(name), reader);
    EXPECT_TRUE(status.ok()) << status.message();
    std::vector<Positions> frames(reader ? reader->frame_count() : 0);
    for (std::uint32_t f = 0; f < frames.size(); ++f) EXPECT_TRUE(reader->Read(f, frames[f]).ok());
    return frames;
  }
};

TEST_F(DecodeTest, EveryOutputHoldsTheSameFrames) {
  Encode("clip.sac", {"--keep-order"});
  for (const char* name : {"a.pc2", "b.mdd", "c_%d.obj", "d_%04d.ply", "e_%02d.off"}) {
    EXPECT_EQ(Good({"decode", "clip.sac", "-o", name}), "");
  }
  const std::vector<Positions> frames = LoadCache("a.pc2");
  ASSERT_EQ(frames.size(), 12u);
  EXPECT_EQ(LoadCache("b.mdd"), frames);
  EXPECT_EQ(Load("c_0.obj").positions, frames[0]);
  EXPECT_EQ(Load("c_11.obj").positions, frames[11]);
  EXPECT_EQ(Load("d_0007.ply").positions, frames[7]);
  EXPECT_EQ(Load("e_07.off").positions, frames[7]);
  EXPECT_FALSE(std::filesystem::exists(Path("c_12.obj")));
  EXPECT_EQ(Load("a.obj").triangles, Load("d_0003.ply").triangles);
  EXPECT_EQ(GoodJson({"compare", "c_%d.obj", "--with", "a.obj", "a.pc2", "--json"})["max_error"], 0);
  Good({"decode", "-", "-o", "f.pc2"}, Path("clip.sac"));
  EXPECT_EQ(Read("f.pc2"), Read("a.pc2"));
}

TEST_F(DecodeTest, UnknownFrameRateIs24) {
  Encode("clip.sac");
  Good({"decode", "clip.sac", "-o", "out.mdd"});
  std::unique_ptr<CacheReader> reader;
  ASSERT_TRUE(CacheReader::Open(Path("out.mdd"), reader).ok());
  EXPECT_EQ(reader->fps(), 24.0);
}

TEST_F(DecodeTest, MapGivesWhatTheKeptOrderGives) {
  Encode("kept.sac", {"--keep-order"});
  Encode("loose.sac", {"--order-map", "map.txt"});
  Good({"decode", "kept.sac", "-o", "kept.pc2"});
  Good({"decode", "loose.sac", "-o", "loose.pc2"});
  Good({"decode", "loose.sac", "-o", "mapped.pc2", "--order-map", "map.txt"});
  EXPECT_EQ(Read("mapped.pc2"), Read("kept.pc2"));
  EXPECT_EQ(Read("mapped.obj"), Read("kept.obj"));
  EXPECT_NE(Read("loose.pc2"), Read("kept.pc2"));
  EXPECT_NE(Read("loose.obj"), Read("kept.obj"));
}

TEST_F(DecodeTest, OntoGivesWhatTheKeptOrderGives) {
  Encode("kept.sac", {"--keep-order"});
  Encode("loose.sac");
  Good({"decode", "kept.sac", "-o", "kept.pc2"});
  Good({"decode", "loose.sac", "-o", "onto.pc2", "--onto", "in.obj"});
  EXPECT_EQ(Read("onto.pc2"), Read("kept.pc2"));
  EXPECT_EQ(Load("onto.obj").triangles, Load("in.obj").triangles);
  Good({"decode", "loose.sac", "-o", "up.pc2", "--onto", "in.obj", "--up", "y:z"});
  Good({"decode", "kept.sac", "-o", "kept_up.pc2", "--up", "y:z"});
  EXPECT_EQ(Read("up.pc2"), Read("kept_up.pc2"));
  Good({"decode", "loose.sac", "-o", "later.ply", "--onto", "in.obj", "--frames", "7"});
  Good({"decode", "kept.sac", "-o", "kept_7.ply", "--frames", "7"});
  EXPECT_EQ(Load("later.ply").positions, Load("kept_7.ply").positions);
  Good({"synth", "flag", "-o", "other.pc2", "--vertices", "300", "--frames", "1"});
  const Outcome outcome = Sac({"decode", "loose.sac", "-o", "x.pc2", "--onto", "other.obj"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_NE(outcome.err.find("other.obj: it has "), std::string::npos) << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(Path("x.pc2")));
}

TEST_F(DecodeTest, TrianglesAndCornersFollowTheVertices) {
  Encode("clip.sac", {"--keep-order"});
  Good({"decode", "clip.sac", "-o", "out.pc2"});
  const Mesh in = Load("in.obj"), out = Load("out.obj");
  const auto triangles = [](const Mesh& mesh) {
    std::multiset<Triangle> set;
    for (Triangle t : mesh.triangles) {
      std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
      set.insert(t);
    }
    return set;
  };
  EXPECT_EQ(triangles(in), triangles(out));
  // The flag has no seams: a vertex has one texture coordinate.
  const auto uv_of_vertices = [](const Mesh& mesh) {
    std::vector<std::array<float, 2>> uvs(mesh.positions.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) uvs[mesh.triangles[t][k]] = mesh.uvs.at(mesh.uv_triangles.at(t)[k]);
    }
    return uvs;
  };
  const auto before = uv_of_vertices(in), after = uv_of_vertices(out);
  for (std::size_t v = 0; v < before.size(); ++v) {
    for (std::size_t a = 0; a < 2; ++a) EXPECT_NEAR(before[v][a], after[v][a], 0.005) << v;
  }
}

TEST_F(DecodeTest, NormalsFollowTheVertices) {
  Good({"synth", "sphere", "-o", "sphere_%d.ply", "--vertices", "160", "--frames", "1"});
  Good({"encode", "sphere_%d.ply", "-o", "s.sac", "--harmonics", "20", "--order-map", "map.txt"});
  Good({"decode", "s.sac", "-o", "out.ply", "--order-map", "map.txt"});
  const Mesh in = Load("sphere_0.ply"), out = Load("out.ply");
  ASSERT_FALSE(in.normals.empty());
  ASSERT_EQ(in.normals.size(), out.normals.size());
  for (std::size_t v = 0; v < in.normals.size(); ++v) {
    for (std::size_t a = 0; a < 3; ++a) EXPECT_NEAR(in.normals[v][a], out.normals[v][a], 0.05) << v;
  }
}

// A cube with hard edges that turns by 90 degrees, in a stream.
class DecodeCubeTest : public DecodeTest {
 protected:
  // `at`: the stream's offset.
  void EncodeCube(const std::array<double, 3>& at) const {
    const Mesh cube = HardCubeMesh();
    EncoderSettings settings;
    settings.quality = 90;
    settings.keep_order = true;
    settings.offset = at;
    std::unique_ptr<Encoder> encoder;
    ASSERT_TRUE(Encoder::Create(cube, settings, encoder).ok());
    Positions turned = cube.positions;
    ASSERT_TRUE(encoder->Send(turned).ok());
    for (Vec3f& p : turned) p = {-p[1], p[0], p[2]};
    ASSERT_TRUE(encoder->Send(turned).ok());
    ASSERT_TRUE(encoder->Finish().ok());
    const std::vector<std::uint8_t> bytes = encoder->TakeBytes();
    directory_.Write("cube.sac", std::string(bytes.begin(), bytes.end()));
  }

  // The normals of the triangles' corners in an OBJ file, and of how many different indices.
  std::vector<std::array<Vec3f, 3>> CornerNormals(const std::string& name, std::size_t& different) const {
    std::vector<Vec3f> normals;
    std::vector<std::array<Vec3f, 3>> corners;
    std::set<std::size_t> indices;
    std::istringstream text(Read(name));
    for (std::string line; std::getline(text, line);) {
      std::istringstream words(line);
      std::string word;
      words >> word;
      if (word == "vn") words >> normals.emplace_back()[0] >> normals.back()[1] >> normals.back()[2];
      if (word != "f") continue;
      for (Vec3f& n : corners.emplace_back()) {
        words >> word;
        const std::size_t index = std::stoul(word.substr(word.find("//") + 2));
        indices.insert(index);
        n = normals.at(index - 1);
      }
    }
    different = indices.size();
    return corners;
  }
};

TEST_F(DecodeCubeTest, HardEdgesTurnWithTheFrame) {
  EncodeCube({});
  EXPECT_EQ(Good({"decode", "cube.sac", "-o", "o_%d.obj"}), "");
  std::size_t different = 0;
  const auto first = CornerNormals("o_0.obj", different);
  EXPECT_EQ(different, 24u);
  const auto second = CornerNormals("o_1.obj", different);
  EXPECT_EQ(different, 24u);
  ASSERT_EQ(first.size(), 12u);
  ASSERT_EQ(second.size(), 12u);
  for (std::size_t j = 0; j < 12; ++j) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(first[j][k], first[j][0]);  // each face is flat
      const Vec3f& n = first[j][k];
      EXPECT_NEAR(std::max({std::abs(n[0]), std::abs(n[1]), std::abs(n[2])}), 1, 0.005);
      const Vec3f turned = {-n[1], n[0], n[2]};
      for (std::size_t a = 0; a < 3; ++a) EXPECT_NEAR(second[j][k][a], turned[a], 0.05);
    }
  }
  // One frame of the middle is the same whether those before it are written or not.
  Good({"decode", "cube.sac", "-o", "one.obj", "--frames", "1"});
  EXPECT_EQ(Read("one.obj"), Read("o_1.obj"));
}

TEST_F(DecodeCubeTest, OneNormalAVertexIsNotInventedForHardEdges) {
  EncodeCube({});
  for (const std::string name : {"o_%d.ply", "o_%d.off"}) {
    const Outcome outcome = Sac({"decode", "cube.sac", "-o", name});
    EXPECT_EQ(outcome.code, 0);
    EXPECT_EQ(outcome.err, "sac: warning: o_0" + name.substr(4) +
                               ": corners of a vertex have normals of their own, which the format cannot hold; written "
                               "without. OBJ holds them\n");
    EXPECT_TRUE(Load("o_1" + name.substr(4)).normals.empty());
  }
}

TEST_F(DecodeCubeTest, AnOffsetComesBack) {
  EncodeCube({});
  Good({"decode", "cube.sac", "-o", "near.obj", "--frames", "0"});
  EncodeCube({500000.5, 5600000.25, 301});
  EXPECT_EQ(GoodJson({"info", "cube.sac", "--json"})["header"]["offset_y"], 5600000.25);
  Good({"decode", "cube.sac", "-o", "far.obj", "--frames", "0"});
  std::istringstream near(Read("near.obj")), far(Read("far.obj"));
  for (int v = 0; v < 8; ++v) {
    std::string keyword;
    float a[3];
    double b[3];
    near >> keyword >> a[0] >> a[1] >> a[2];
    far >> keyword >> b[0] >> b[1] >> b[2];
    EXPECT_EQ(a[0] + 500000.5, b[0]);
    EXPECT_EQ(a[1] + 5600000.25, b[1]);
    EXPECT_EQ(a[2] + 301.0, b[2]);
  }
  const Outcome outcome = Sac({"decode", "cube.sac", "-o", "far.pc2"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(
      outcome.err.rfind("sac: warning: far.pc2: the format's 32-bit floats round the coordinates by up to 0.2", 0), 0u)
      << outcome.err;
}

TEST_F(DecodeTest, ColorsFollowTheVertices) {
  Good({"synth", "parts", "-o", "parts_%d.ply", "--vertices", "100", "--frames", "1"});
  Good({"encode", "parts_%d.ply", "-o", "p.sac", "--harmonics", "1", "--keep-order"});
  Good({"decode", "p.sac", "-o", "out.ply"});
  const Mesh in = Load("parts_0.ply"), out = Load("out.ply");
  ASSERT_FALSE(in.colors.empty());
  EXPECT_NE(in.colors.front(), in.colors.back());
  EXPECT_EQ(in.colors, out.colors);
}

TEST_F(DecodeTest, Ranges) {
  Encode("clip.sac");
  Good({"decode", "clip.sac", "-o", "all.pc2"});
  const std::vector<Positions> all = LoadCache("all.pc2");
  const auto slice = [&](std::ptrdiff_t a, std::ptrdiff_t b) {
    return std::vector<Positions>(all.begin() + a, all.begin() + b);
  };
  for (const std::string name : {"part.pc2", "part.mdd"}) {
    const auto part = [&](const std::string& range) {
      Good({"decode", "clip.sac", "-o", name, "--frames", range, "--force"});
      return LoadCache(name);
    };
    EXPECT_EQ(part("3:9"), slice(3, 9));
    EXPECT_EQ(part("0:12"), all);
    EXPECT_EQ(part("10:"), slice(10, 12));
    EXPECT_EQ(part(":1"), slice(0, 1));
    EXPECT_EQ(part("11"), slice(11, 12));
  }
  Good({"decode", "clip.sac", "-o", "f_%02d.ply", "--frames", "4:6"});
  EXPECT_EQ(Load("f_04.ply").positions, all[4]);
  EXPECT_EQ(Load("f_05.ply").positions, all[5]);
  EXPECT_FALSE(std::filesystem::exists(Path("f_03.ply")) || std::filesystem::exists(Path("f_06.ply")));
  Good({"decode", "clip.sac", "-o", "one.off", "--frames", "6"});
  EXPECT_EQ(Load("one.off").positions, all[6]);

  ExpectFailure({"decode", "clip.sac", "-o", "x.pc2", "--frames", "12:"}, 1,
                "clip.sac: --frames asks for frame 12, the last one is 11");
  ExpectFailure({"decode", "clip.sac", "-o", "x.mdd", "--frames", "5:13"}, 1,
                "clip.sac: --frames asks for frame 12, the last one is 11");
  ExpectFailure({"decode", "clip.sac", "-o", "x.mdd", "--frames", "0:4294967295"}, 1,
                "clip.sac: --frames asks for frame 4294967294, the last one is 11");
  ExpectFailure({"decode", "clip.sac", "-o", "x.ply", "--frames", "3:5"}, 1,
                "x.ply: more than one frame needs a cache or a pattern such as x_%04d.obj");
}

TEST_F(DecodeTest, IntoAPipe) {
  Encode("clip.sac");
  Good({"decode", "clip.sac", "-o", "part.mdd", "--frames", "2:5"});
  const Outcome outcome = Shell("mkfifo pipe.mdd; timeout 60 cat pipe.mdd > got.mdd & " + Quote(SAC_EXECUTABLE) +
                                " decode clip.sac -o pipe.mdd --frames 2:5; echo $?; wait");
  EXPECT_EQ(outcome.out, "0\n");
  EXPECT_EQ(Read("got.mdd"), Read("part.mdd"));
}

TEST_F(DecodeTest, DamageCanBeSkipped) {
  Encode("clip.sac");  // in groups of 5
  Good({"decode", "clip.sac", "-o", "good.pc2"});
  const std::vector<Positions> good = LoadCache("good.pc2");
  // The last byte of each group's packet is of its CRC.
  std::size_t end = 4, group = 0;
  const nlohmann::json info = GoodJson({"info", "clip.sac", "--json"});
  for (const nlohmann::json& packet : info["packets"]) {
    end += packet["bytes"].get<std::size_t>();
    if (packet["type"] != "group") continue;
    std::string damaged = Read("clip.sac");
    damaged[end - 1] = static_cast<char>(damaged[end - 1] ^ 1);
    directory_.Write("damaged.sac", damaged);
    const std::size_t first = 5 * group++, last = std::min<std::size_t>(first + 4, 11);
    const Outcome outcome = Sac({"decode", "damaged.sac", "-o", "out.pc2", "--skip-damage", "--force"});
    EXPECT_EQ(outcome.code, 0);
    EXPECT_NE(
        outcome.err.find("damaged.sac: frames " + std::to_string(first) + " to " + std::to_string(last) + " are lost"),
        std::string::npos)
        << outcome.err;
    const std::string kept = Read("out.pc2");
    EXPECT_EQ(Sac({"decode", "damaged.sac", "-o", "out.pc2", "--skip-damage", "--force", "--strict"}).code, 1);
    EXPECT_EQ(Read("out.pc2"), kept);
    std::vector<Positions> expected = good;
    for (std::size_t f = first; f <= last; ++f) expected[f] = good[first == 0 ? 5 : first - 1];
    EXPECT_EQ(LoadCache("out.pc2"), expected) << first;
    EXPECT_EQ(Sac({"decode", "damaged.sac", "-o", "out.pc2", "--force"}).code, 1);
  }
  EXPECT_EQ(group, 3u);
  const std::string stream = Read("clip.sac");
  directory_.Write("cut.sac", stream.substr(0, stream.size() * 9 / 10));
  EXPECT_EQ(Sac({"decode", "cut.sac", "-o", "cut.pc2", "--skip-damage"}).code, 0);
  EXPECT_GE(LoadCache("cut.pc2").size(), 5u);
}

TEST_F(DecodeTest, BadStreams) {
  Encode("clip.sac");
  const std::string stream = Read("clip.sac");
  directory_.Write("empty.sac", "");
  directory_.Write("foreign.sac", "solid foreign\n");
  directory_.Write("longer.sac", stream + "x");
  std::string damaged = stream;
  damaged[stream.size() / 2] = static_cast<char>(damaged[stream.size() / 2] ^ 0x10);
  directory_.Write("damaged.sac", damaged);
  const auto decode = [](const std::string& name, const std::string& output) {
    return std::vector<std::string>{"decode", name, "-o", output};
  };
  for (const char* output : {"x.pc2", "x.mdd", "x_%d.obj"}) {
    ExpectFailure(decode("empty.sac", output), 1, "empty.sac: the stream is empty");
    ExpectFailure(decode("-", output), 1, "standard input: the stream is empty");
    ExpectFailure(decode("foreign.sac", output), 1, "foreign.sac: not a .sac stream");
    ExpectFailure(decode("longer.sac", output), 1, "longer.sac: bytes after the end of the stream");
    ExpectFailure(decode("absent.sac", output), 1, "absent.sac: No such file or directory");
    const Outcome outcome = Sac(decode("damaged.sac", output));
    EXPECT_EQ(outcome.code, 1);
    EXPECT_EQ(outcome.err.rfind("sac: damaged.sac: wrong checksum in the packet that ends at byte ", 0), 0u);
  }
  ExpectFailure(decode("clip.sac", "absent/x.pc2"), 1, "absent/x.pc2: no such directory");
  for (std::size_t size = 1; size < stream.size(); size += size < stream.size() - 12 ? 97 : 1) {
    directory_.Write("short.sac", stream.substr(0, size));
    const Outcome outcome = Sac(decode("short.sac", "x.mdd"));
    EXPECT_EQ(outcome.code, 1) << size;
    EXPECT_EQ(outcome.err.rfind("sac: short.sac: the stream is truncated ", 0), 0u) << outcome.err;
  }
  EXPECT_EQ(directory_.FileCount(), 8u);  // in.obj, in.pc2, clip, empty, foreign, longer, damaged, short
}

TEST_F(DecodeTest, BadOrderMaps) {
  Encode("clip.sac", {"--order-map", "map.txt"});
  const std::string map = Read("map.txt");
  const std::string vertices = GoodJson({"info", "clip.sac", "--json"})["header"]["vertices"].dump();
  const std::string body = map.substr(map.find('\n') + 1), second = body.substr(body.find('\n') + 1);
  const std::string first = body.substr(0, body.find('\n'));
  const auto expect = [&](const std::string& text, const std::string& message) {
    directory_.Write("bad.txt", text);
    ExpectFailure({"decode", "clip.sac", "-o", "x.pc2", "--order-map", "bad.txt"}, 1, "bad.txt" + message);
  };
  expect("", ": 0 indices, but the clip has " + vertices + " vertices");
  expect(second,
         ": " + std::to_string(std::stoi(vertices) - 1) + " indices, but the clip has " + vertices + " vertices");
  expect(first + "\n" + body, ":2: index " + first + " for the second time");
  expect(vertices + "\n" + second, ":1: index " + vertices + ", but the clip has " + vertices + " vertices");
  expect("-1\n" + second, ":1: index -1, but the clip has " + vertices + " vertices");
  expect("1.5\n" + second, ":1: not an index");
  expect("0 1\n" + second, ":1: not an index");
  ExpectFailure({"decode", "clip.sac", "-o", "x.pc2", "--order-map", "absent.txt"}, 1,
                "absent.txt: No such file or directory");
  // Comments and blank lines are nothing, Windows' line ends neither.
  std::string windows = "\n# made by hand\n";
  for (const char c : body) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  directory_.Write("windows.txt", windows);
  Good({"decode", "clip.sac", "-o", "a.pc2", "--order-map", "map.txt"});
  Good({"decode", "clip.sac", "-o", "b.pc2", "--order-map", "windows.txt"});
  EXPECT_EQ(Read("a.pc2"), Read("b.pc2"));
}

}  // namespace
}  // namespace sac
