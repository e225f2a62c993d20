// SPDX-License-Identifier: Apache-2.0
#include "files/gltf/gltf_clip.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/files/clip_files.h"

namespace sac {
namespace {

using nlohmann::json;

std::string Base64(const std::string& bytes) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : digits[bits >> (18 - 6 * k) & 63];
  }
  return text;
}

std::string Floats(const std::vector<float>& values) {
  std::string bytes;
  for (const float x : values) bytes += LittleFloat(x);
  return bytes;
}

class GltfClipTest : public ClipFileTest {
 protected:
  // A triangle that moves along x by 1 a second for two seconds and has a target, which raises vertex 2.
  static json Triangle() {
    json j;
    j["asset"]["version"] = "2.0";
    std::string bytes;
    const auto accessor = [&](const std::string& type, std::size_t count, const std::vector<float>& values) {
      j["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", 4 * values.size()}});
      j["accessors"].push_back(
          {{"bufferView", j["bufferViews"].size() - 1}, {"componentType", 5126}, {"type", type}, {"count", count}});
      bytes += Floats(values);
      return j["accessors"].size() - 1;
    };
    const auto position = accessor("VEC3", 3, {0, 0, 0, 1, 0, 0, 0, 1, 0});
    const auto target = accessor("VEC3", 3, {0, 0, 0, 0, 0, 0, 0, 0, 1});
    const auto times = accessor("SCALAR", 2, {0, 2});
    const auto values = accessor("VEC3", 2, {0, 0, 0, 2, 0, 0});
    j["buffers"] = {{{"byteLength", bytes.size()}, {"uri", "data:application/gltf-buffer;base64," + Base64(bytes)}}};
    j["meshes"] = {
        {{"weights", {0.5}},
         {"primitives", {{{"attributes", {{"POSITION", position}}}, {"targets", {{{"POSITION", target}}}}}}}}};
    j["nodes"] = {{{"mesh", 0}, {"name", "flag"}}};
    j["scenes"] = {{{"nodes", {0}}}};
    j["animations"] = {{{"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}},
                        {"samplers", {{{"input", times}, {"output", values}}}}}};
    return j;
  }

  std::string Write(const json& j) { return directory_.Write("t.gltf", j.dump()); }
  // The message that reading ends with, be it at the first frame.
  std::string Error(const json& j, const ClipInputSettings& settings = {}) { return OpenError({Write(j)}, settings); }
};

TEST_F(GltfClipTest, SamplesAtTheRateThatIsAskedFor) {
  const auto clip = Open({Write(Triangle())}, {.rate = {5, 2}});
  const auto frames = Frames(*clip);
  ASSERT_EQ(frames.size(), 6U);
  for (std::size_t f = 0; f < 6; ++f) {
    EXPECT_FLOAT_EQ(frames[f][1][0], 1 + 0.4F * static_cast<float>(f));
    EXPECT_EQ(frames[f][2][2], 0.5F);
  }
  EXPECT_EQ(clip->rate().numerator, 5U);
}

TEST_F(GltfClipTest, TakesTheRateOfItsKeys) {
  EXPECT_EQ(Open({Write(Triangle())})->rate().per_second(), 24);
  json j = Triangle();
  j["accessors"][2]["count"] = 3;
  j["accessors"][3]["count"] = 3;
  j["buffers"][0]["uri"] = "beside.bin";
  j["bufferViews"][2] = {{"buffer", 0}, {"byteOffset", 72}, {"byteLength", 12}};
  j["bufferViews"][3] = {{"buffer", 0}, {"byteOffset", 84}, {"byteLength", 36}};
  j["buffers"][0]["byteLength"] = 120;
  directory_.Write("beside.bin", std::string(72, '\0') + Floats({0, 0.02F, 1}) + Floats({0, 0, 0, 0, 0, 0, 1, 0, 0}));
  EXPECT_EQ(Open({Write(j)})->rate().per_second(), 50);
  directory_.Write("beside.bin", std::string(72, '\0') + Floats({0, 0.123F, 1}) + std::string(36, '\0'));
  const auto clip = Open({Write(j)});
  EXPECT_EQ(clip->rate().per_second(), 30);
  EXPECT_EQ(Told(*clip).back(),
            "t.gltf: its keys fit no usual frame rate; it is sampled at 30 frames a second, --fps sets another rate");
}

TEST_F(GltfClipTest, WithoutAnimationHasOneFrame) {
  json j = Triangle();
  j.erase("animations");
  EXPECT_EQ(Frames(*Open({Write(j)})).size(), 1U);
}

TEST_F(GltfClipTest, MergesMeshesAndTellsNames) {
  json j = Triangle();
  j["nodes"].push_back({{"mesh", 0}, {"name", "wing"}, {"scale", {-1, 1, 1}}});
  j["nodes"].push_back({{"camera", 0}});
  j["scenes"][0]["nodes"] = {0, 1, 2};
  const auto clip = Open({Write(j)});
  const Mesh& mesh = clip->mesh();
  EXPECT_EQ(mesh.positions.size(), 6U);
  // A mirrored triangle goes round the other way, so that its front stays its front.
  EXPECT_EQ(mesh.triangles, (std::vector<sac::Triangle>{{0, 1, 2}, {3, 5, 4}}));
  EXPECT_EQ(Told(*clip)[0],
            "t.gltf: 2 objects become one mesh; cameras (1), names of objects (flag, wing) are not kept");
}

TEST_F(GltfClipTest, ChoosesAnimationsByNameAndNumber) {
  json j = Triangle();
  j["animations"][0]["name"] = "walk";
  j["animations"].push_back({{"name", "rest"}, {"channels", json::array()}, {"samplers", json::array()}});
  EXPECT_EQ(Frames(*Open({Write(j)}, {.animation = "walk"})).size(), 49U);
  EXPECT_EQ(Frames(*Open({Write(j)}, {.animation = "rest"})).size(), 1U);
  EXPECT_EQ(Frames(*Open({Write(j)}, {.animation = "1"})).size(), 1U);
  EXPECT_EQ(Error(j, {.animation = "run"}), "t.gltf: has no 'run' among its animations: walk, rest");
  EXPECT_EQ(Error(j, {.scene = "3"}), "t.gltf: has no '3' among its scenes: 0");
  EXPECT_EQ(Told(*Open({Write(j)})).back(),
            "t.gltf: has the animations walk, rest; the first is taken, --animation names another");
}

TEST_F(GltfClipTest, RefusesWhatIsBroken) {
  const auto error = [this](const std::string& pointer, const json& value) {
    json j = Triangle();
    j[json::json_pointer(pointer)] = value;
    return Error(j);
  };
  EXPECT_EQ(OpenError({directory_.Write("t.gltf", "")}), "t.gltf: the file is empty");
  EXPECT_EQ(OpenError({directory_.Write("t.gltf", "{")}).substr(0, 34), "t.gltf: its JSON: parse error at l");
  EXPECT_EQ(OpenError({directory_.Write("t.gltf", std::string(1000000, '['))}).substr(0, 18), "t.gltf: its JSON: ");
  EXPECT_EQ(OpenError({directory_.Write("t.gltf", "{}")}), "t.gltf: no glTF: asset.version is missing");
  EXPECT_EQ(OpenError({directory_.Path("none.glb")}), "none.glb: No such file or directory");
  EXPECT_EQ(error("/asset/version", "1.0"), "t.gltf: glTF 1.0; 2.0 is read. Convert it, as with gltf-pipeline");
  EXPECT_EQ(error("/extensionsRequired", {"FOO_bar"}), "t.gltf: requires the extension FOO_bar, which is not read");
  EXPECT_EQ(error("/buffers/0/uri", "none.bin"), "t.gltf: its buffer none.bin: No such file or directory");
  EXPECT_EQ(error("/buffers/0/uri", "http://a.b/c"),
            "t.gltf: buffers[0]: 'http://a.b/c' is not beside the file; put it there");
  EXPECT_EQ(error("/buffers/0/uri", "data:;base64,A!"), "t.gltf: buffers[0]: its base64 is broken");
  EXPECT_EQ(error("/buffers/0/byteLength", 1000), "t.gltf: buffers[0]: has 104 bytes, not 1000");
  EXPECT_EQ(error("/accessors/0/count", 4), "t.gltf: accessors[0]: ends after its buffer view of 36 bytes");
  EXPECT_EQ(error("/accessors/0/count", -1), "t.gltf: accessors[0].count: -1 is not in 0..4294967295");
  EXPECT_EQ(error("/accessors/0/count", 4000000000),
            "t.gltf: accessors[0]: 4000000000 values are more than the limit allows");
  EXPECT_EQ(error("/accessors/0/bufferView", 9), "t.gltf: accessors[0].bufferView: 9 is not in 0..3");
  EXPECT_EQ(error("/accessors/0/byteOffset", 4000000000),
            "t.gltf: accessors[0]: ends after its buffer view of 36 bytes");
  EXPECT_EQ(error("/accessors/0/type", "VEC2"), "t.gltf: accessors[0]: has 2 numbers a value, not 3");
  EXPECT_EQ(error("/accessors/3/count", 1), "t.gltf: animations[0].samplers[0]: has 2 keys, and 3 numbers for them");
  EXPECT_EQ(error("/bufferViews/0/byteLength", 1000), "t.gltf: bufferViews[0]: ends after its buffer of 104 bytes");
  EXPECT_EQ(error("/nodes/0/children", {0}), "t.gltf: nodes[0]: a root of the scene has a parent");
  EXPECT_EQ(error("/nodes/0/mesh", "x"), "t.gltf: nodes[0].mesh: not an integer");
  EXPECT_EQ(error("/nodes/0/weights", {1, 2}), "t.gltf: nodes[0].weights: not 1 numbers");
  EXPECT_EQ(error("/meshes/0/primitives/0/mode", 1), "t.gltf: no vertices of triangles in the scene");
}

TEST_F(GltfClipTest, RefusesALimitlessAnimation) {
  json j = Triangle();
  j["buffers"][0]["uri"] = "long.bin";
  directory_.Write("long.bin", std::string(72, '\0') + Floats({0, 1e30F, 0, 0, 0, 2, 0, 0}));
  EXPECT_EQ(Error(j).substr(0, 30), "t.gltf: the animation lasts 10");
}

TEST_F(GltfClipTest, EveryCutOfAGlbFailsCleanly) {
  std::string text = Triangle().dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const auto size = static_cast<std::uint32_t>(text.size());
  const std::string glb = "glTF" + Little32(2) + Little32(20 + size) + Little32(size) + "JSON" + text;
  std::unique_ptr<SceneReader> reader;
  const auto parse = [&](std::size_t length) {
    const std::vector<std::uint8_t> bytes(glb.begin(), glb.begin() + static_cast<std::ptrdiff_t>(length));
    return ParseGltfClip("t.glb", bytes, {}, reader);
  };
  for (std::size_t length = 0; length < glb.size(); ++length) EXPECT_FALSE(parse(length).ok()) << length;
  EXPECT_TRUE(parse(glb.size()).ok());
}

}  // namespace
}  // namespace sac
