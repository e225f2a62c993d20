// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstdint>
#include <deque>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "files/alembic/alembic_scene.h"
#include "files/alembic/alembic_tree.h"
#include "files/byte_order.h"
#include "tests/test_directory.h"

namespace sac {

// Makes archives of any contents.
class AlembicFiles {
 public:
  using Kind = AlembicProperty::Kind;
  using Trees = std::vector<AlembicPropertyTree>;
  static constexpr double kAcyclic = std::numeric_limits<double>::max() / 32;

  AlembicFiles() { EXPECT_TRUE(file_.Open(path()).ok()); }
  std::string path() const { return directory_.Path("scene.abc"); }

  // Adds a time sampling; returns its index.
  std::uint32_t AddTimes(double period, const std::vector<double>& times) {
    times_ += std::string(4, '\1') + Double(period) + Word(static_cast<std::uint32_t>(times.size()));
    for (const double time : times) times_ += Double(time);
    return next_times_++;
  }

  AlembicPropertyTree Floats(const std::string& name, std::uint32_t extent,
                             const std::vector<std::vector<float>>& samples, std::uint32_t times = 0,
                             const std::string& metadata = "") {
    return Add({name, metadata, Kind::kArray, AlembicPod::kFloat32, extent, times}, samples,
               [](float x) { return Word(std::bit_cast<std::uint32_t>(x)); });
  }
  AlembicPropertyTree Doubles(const std::string& name, const std::vector<std::vector<double>>& samples,
                              std::uint32_t times = 0) {
    return Add({name, "", Kind::kScalar, AlembicPod::kFloat64, static_cast<std::uint32_t>(samples[0].size()), times},
               samples, Double);
  }
  AlembicPropertyTree Ints(const std::string& name, const std::vector<std::vector<std::uint32_t>>& samples,
                           std::uint32_t times = 0) {
    return Add({name, "", Kind::kArray, AlembicPod::kInt32, 1, times}, samples, Word);
  }
  AlembicPropertyTree Bytes(const std::string& name, const std::vector<std::vector<char>>& samples,
                            std::uint32_t times = 0) {
    return Add({name, "", Kind::kScalar, AlembicPod::kInt8, static_cast<std::uint32_t>(samples[0].size()), times},
               samples, [](char c) { return std::string(1, c); });
  }
  AlembicPropertyTree Text(const std::string& name, const std::string& text) {
    return Add({name, "", Kind::kScalar, AlembicPod::kString, 1, 0},
               std::vector<std::vector<char>>{{text.begin(), text.end()}}, [](char c) { return std::string(1, c); });
  }
  static AlembicPropertyTree Compound(const std::string& name, Trees properties, const std::string& metadata = "") {
    AlembicPropertyTree compound;
    compound.name = name;
    compound.metadata = metadata;
    compound.properties = std::move(properties);
    return compound;
  }
  static AlembicObjectTree Object(const std::string& name, const std::string& schema, Trees properties,
                                  std::vector<AlembicObjectTree> children = {}) {
    return {name, schema.empty() ? "" : "schema=" + schema, Compound("", std::move(properties)), std::move(children)};
  }

  // A triangle (0, 0, z), (1, 0, z), (0, 1, z), for each z a sample; its front faces +z.
  AlembicObjectTree Triangle(const std::string& name, const std::vector<float>& zs, std::uint32_t times = 0,
                             Trees more = {}, Trees beside = {}) {
    std::vector<std::vector<float>> points;
    for (const float z : zs) points.push_back({0, 0, z, 1, 0, z, 0, 1, z});
    Trees geometry = {Floats("P", 3, points, times), Ints(".faceIndices", {{2, 1, 0}}), Ints(".faceCounts", {{3}})};
    for (AlembicPropertyTree& property : more) geometry.push_back(std::move(property));
    beside.push_back(Compound(".geom", std::move(geometry)));
    return Object(name, "AbcGeom_PolyMesh_v1", std::move(beside));
  }

  // A transform of operations, each its type times 16, with samples of their numbers.
  AlembicObjectTree Xform(const std::string& name, const std::vector<char>& operations,
                          const std::vector<std::vector<double>>& numbers, std::vector<AlembicObjectTree> children,
                          std::uint32_t times = 0, bool inherits = true) {
    return Object(name, "AbcGeom_Xform_v3",
                  {Compound(".xform", {Bytes(".inherits", {{inherits ? '\1' : '\0'}}), Bytes(".ops", {operations}),
                                       Doubles(".vals", numbers, times)})},
                  std::move(children));
  }

  // The bytes of an archive of these objects. Nothing can be added afterwards.
  std::string Write(std::vector<AlembicObjectTree> objects) {
    AlembicObjectTree top;
    top.children = std::move(objects);
    EXPECT_TRUE(WriteAlembicTree(file_, top, "", times_).ok());
    EXPECT_TRUE(file_.Commit().ok());
    return directory_.Read("scene.abc");
  }

 private:
  static std::string Word(std::uint32_t value) {
    std::string bytes(4, '\0');
    StoreLittle32(value, bytes.data());
    return bytes;
  }
  static std::string Double(double value) {
    std::string bytes(8, '\0');
    StoreLittle64(std::bit_cast<std::uint64_t>(value), bytes.data());
    return bytes;
  }

  template <typename Number, typename ToBytes>
  AlembicPropertyTree Add(AlembicPropertyTree property, const std::vector<std::vector<Number>>& samples,
                          ToBytes to_bytes) {
    AlembicSampleList& list = lists_.emplace_back();
    for (const std::vector<Number>& sample : samples) {
      std::string bytes;
      for (const Number number : sample) bytes += to_bytes(number);
      EXPECT_TRUE(list.Write(file_, bytes).ok());
    }
    property.samples = &list;
    return property;
  }

  TestDirectory directory_;
  OgawaWriter file_;
  std::deque<AlembicSampleList> lists_;  // which trees point to
  std::string times_ = std::string(4, '\1') + Double(1) + Word(1) + Double(0);
  std::uint32_t next_times_ = 1;
};

// Opens a scene from bytes; returns the message, "" where there is none.
inline std::string OpenScene(const std::string& bytes, std::unique_ptr<AlembicScene>& scene, const FrameRate& rate = {},
                             const AlembicLimits& limits = {}) {
  return AlembicScene::Open(RandomAccess(bytes), rate, limits, scene).message();
}

// Positions of a frame; fails the test where they cannot be read.
inline std::vector<Vec3d> FramePositions(const AlembicScene& scene, std::uint32_t frame) {
  PolygonMesh mesh;
  const Status status = scene.ReadPositions(frame, mesh);
  EXPECT_TRUE(status.ok()) << status.message();
  return mesh.positions;
}

}  // namespace sac
