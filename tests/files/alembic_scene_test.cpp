// SPDX-License-Identifier: Apache-2.0
#include "files/alembic/alembic_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/files/alembic_files.h"

namespace sac {
namespace {

using std::numbers::sqrt2;
constexpr char kScale = 0, kTranslate = 0x10, kRotate = 0x20, kMatrix = 0x30, kRotateX = 0x40, kRotateZ = 0x60;

class AlembicSceneTest : public testing::Test {
 protected:
  void Open(std::vector<AlembicObjectTree> objects, const FrameRate& rate = {}) {
    ASSERT_EQ(OpenScene(files_.Write(std::move(objects)), scene_, rate), "");
  }
  PolygonMesh Mesh(std::uint32_t frame = 0) {
    PolygonMesh mesh;
    const Status status = scene_->ReadMesh(frame, mesh);
    EXPECT_TRUE(status.ok()) << status.message();
    return mesh;
  }
  static void ExpectNear(const Vec3d& a, const Vec3d& b) {
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], 1e-12) << "coordinate " << k;
  }
  // Where a transform takes the corner (1, 0, 0) at each frame.
  std::vector<Vec3d> Corner() {
    std::vector<Vec3d> corners;
    for (std::uint32_t f = 0; f < scene_->frame_count(); ++f) corners.push_back(FramePositions(*scene_, f)[1]);
    return corners;
  }

  AlembicFiles files_;
  std::unique_ptr<AlembicScene> scene_;
};

TEST_F(AlembicSceneTest, FacesGoRoundAsInOtherFormats) {
  Open({files_.Triangle("t", {0})});
  const PolygonMesh mesh = Mesh();
  EXPECT_EQ(mesh.faces.vertices, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(mesh.faces.ends, (std::vector<std::uint32_t>{3}));
  EXPECT_FALSE(mesh.wide);
  EXPECT_EQ(scene_->frame_count(), 1U);
  EXPECT_EQ(scene_->rate().numerator, 0U);
}

TEST_F(AlembicSceneTest, MeshesComeOneAfterTheOtherUnderTheirTransforms) {
  // A point is scaled, then turned by a quarter about z, then moved, then moved by the parent.
  Open({files_.Xform("parent", {kTranslate}, {{100, 0, 0}},
                     {files_.Xform("child", {kTranslate, kRotateZ, kScale}, {{0, 10, 0, 90, 2, 3, 4}},
                                   {files_.Triangle("t", {1})}),
                      files_.Xform("alone", {kTranslate}, {{0, 0, 5}}, {files_.Triangle("t", {0})}, 0, false)}),
        files_.Triangle("u", {7})});
  const PolygonMesh mesh = Mesh();
  ASSERT_EQ(mesh.positions.size(), 9U);
  ExpectNear(mesh.positions[0], {100, 10, 4});
  ExpectNear(mesh.positions[1], {100, 12, 4});
  ExpectNear(mesh.positions[2], {97, 10, 4});
  ExpectNear(mesh.positions[4], {1, 0, 5});
  ExpectNear(mesh.positions[7], {1, 0, 7});
  EXPECT_EQ(mesh.objects, 3U);
  EXPECT_TRUE(mesh.wide);
  EXPECT_EQ(mesh.faces.vertices, (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5, 6, 7, 8}));
}

TEST_F(AlembicSceneTest, RotationAboutAnAxisAndMatrix) {
  Open({files_.Xform("a", {kRotate}, {{0, 0, 5, 45}}, {files_.Triangle("t", {0})}),
        files_.Xform("b", {kMatrix}, {{0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 4, 5, 6, 1}}, {files_.Triangle("t", {0})}),
        files_.Xform("c", {kRotateX}, {{90}}, {files_.Triangle("t", {1})})});
  const PolygonMesh mesh = Mesh();
  ExpectNear(mesh.positions[1], {sqrt2 / 2, sqrt2 / 2, 0});
  ExpectNear(mesh.positions[4], {4, 6, 6});
  ExpectNear(mesh.positions[8], {0, -1, 1});
}

TEST_F(AlembicSceneTest, AReflectionKeepsTheSideThatFacesUs) {
  Open({files_.Xform("mirror", {kScale}, {{-1, 1, 1}}, {files_.Triangle("t", {0})})});
  const PolygonMesh mesh = Mesh();
  // (-1, 0), (0, 1), (0, 0) and not the other way: the normal points to +z as before.
  EXPECT_EQ(mesh.faces.vertices, (std::vector<std::uint32_t>{2, 1, 0}));
}

TEST_F(AlembicSceneTest, SamplesAreTakenAtTheirRateOrAtAnother) {
  const std::uint32_t times = files_.AddTimes(1.0 / 24, {1.0 / 24});
  const std::string bytes = files_.Write({files_.Triangle("t", {0, 1, 4, 9}, times)});
  const auto heights = [&](const FrameRate& rate) {
    EXPECT_EQ(OpenScene(bytes, scene_, rate), "");
    std::vector<double> z;
    for (std::uint32_t f = 0; f < scene_->frame_count(); ++f) z.push_back(FramePositions(*scene_, f)[0][2]);
    return z;
  };
  EXPECT_EQ(heights({}), (std::vector<double>{0, 1, 4, 9}));
  EXPECT_EQ(scene_->rate().per_second(), 24);
  EXPECT_EQ(heights({24, 1}), (std::vector<double>{0, 1, 4, 9}));
  EXPECT_EQ(heights({12, 1}), (std::vector<double>{0, 4}));
  const std::vector<double> twice = heights({48, 1}), expected = {0, 0.5, 1, 2.5, 4, 6.5, 9};
  ASSERT_EQ(twice.size(), expected.size());
  for (std::size_t f = 0; f < twice.size(); ++f) EXPECT_NEAR(twice[f], expected[f], 1e-9);
  EXPECT_EQ(scene_->rate().per_second(), 48);
}

TEST_F(AlembicSceneTest, TransformsMoveBetweenTheirSamples) {
  const std::uint32_t slow = files_.AddTimes(0.5, {0}), fast = files_.AddTimes(0.25, {0});
  Open({files_.Xform("x", {kTranslate, kRotateZ}, {{0, 0, 0, 0}, {2, 0, 0, 180}},
                     {files_.Triangle("t", {0, 1, 2}, fast)}, slow)});
  const std::vector<Vec3d> corners = Corner();
  ASSERT_EQ(corners.size(), 3U);
  ExpectNear(corners[0], {1, 0, 0});
  ExpectNear(corners[1], {1, 1, 1});
  ExpectNear(corners[2], {1, 0, 2});
  EXPECT_EQ(scene_->rate().per_second(), 4);
}

TEST_F(AlembicSceneTest, MatricesTurnEvenly) {
  const std::uint32_t times = files_.AddTimes(1, {0});
  // From the identity to a half turn less a little about z, and twice the size.
  const double angle = std::numbers::pi * 0.9, c = 2 * std::cos(angle), s = 2 * std::sin(angle);
  Open({files_.Xform(
           "x", {kMatrix},
           {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, {c, s, 0, 0, -s, c, 0, 0, 0, 0, 2, 0, 0, 0, 8, 1}},
           {files_.Triangle("t", {0})}, times)},
       {2, 1});
  const std::vector<Vec3d> corners = Corner();
  ASSERT_EQ(corners.size(), 3U);
  ExpectNear(corners[1], {1.5 * std::cos(angle / 2), 1.5 * std::sin(angle / 2), 4});
  ExpectNear(corners[2], {c, s, 8});
}

TEST_F(AlembicSceneTest, TimesOfTheirOwnAndMotionBlur) {
  const std::uint32_t own = files_.AddTimes(AlembicFiles::kAcyclic, {1, 1.5, 3});
  Open({files_.Triangle("t", {0, 1, 4}, own)});
  // Three samples in two seconds are one a second on the average.
  ASSERT_EQ(scene_->frame_count(), 3U);
  EXPECT_NEAR(FramePositions(*scene_, 1)[0][2], 2, 1e-9);
  const Warnings warnings = Mesh().warnings;
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_EQ(warnings[0], "its first time 1 s is not kept; frames begin at 0 s");
  EXPECT_EQ(warnings[1],
            "not all of its samples are at the times of its frames, 1 a second; frames lie between them. --fps takes "
            "another rate");
}

TEST_F(AlembicSceneTest, FramesOfMotionBlurAreTheWholeOnes) {
  const std::uint32_t blur = files_.AddTimes(0.5, {-0.125, 0, 0.125});
  Open({files_.Triangle("t", {-1, 0, 1, 9, 10, 11}, blur)});
  ASSERT_EQ(scene_->frame_count(), 2U);
  EXPECT_EQ(scene_->rate().per_second(), 2);
  EXPECT_EQ(FramePositions(*scene_, 0)[0][2], 0);
  EXPECT_EQ(FramePositions(*scene_, 1)[0][2], 10);
}

TEST_F(AlembicSceneTest, RatesThatAreRoundedDoNotDrift) {
  const std::uint32_t times = files_.AddTimes(1 / 23.976, {0});
  std::vector<float> heights(2000);
  for (std::size_t i = 0; i < heights.size(); ++i) heights[i] = static_cast<float>(i % 7);
  Open({files_.Triangle("t", heights, times)});
  EXPECT_EQ(scene_->rate().numerator, 24000U);
  EXPECT_EQ(scene_->rate().denominator, 1001U);
  ASSERT_EQ(scene_->frame_count(), 2000U);
  EXPECT_EQ(FramePositions(*scene_, 1999)[0][2], 1999 % 7);
}

TEST_F(AlembicSceneTest, AttributesOfCornersAndVertices) {
  const std::string corners = "geoScope=fvr", vertices = "geoScope=vtx";
  Open({files_.Triangle(
            "t", {0}, 0,
            {AlembicFiles::Compound(
                 "uv", {files_.Floats(".vals", 2, {{0, 0, 0.5, 0.25}}), files_.Ints(".indices", {{1, 0, 0}})}, corners),
             files_.Floats("N", 3, {{0, 0, 1, 0, 1, 0, 1, 0, 0}}, 0, corners),
             AlembicFiles::Compound(
                 ".arbGeomParams",
                 {files_.Floats("Cd", 3, {{1, 0, 0, 0, 1, 0, 0, 0, 1}}, 0, vertices + ";interpretation=rgb"),
                  files_.Floats("map2", 2, {{0, 0}}, 0, corners + ";interpretation=vector;podExtent=2"),
                  files_.Floats("mass", 1, {{1, 2, 3}}, 0, vertices)})}),
        files_.Triangle("u", {0})});
  const PolygonMesh mesh = Mesh();
  // In Alembic's order the corners are vertices 2, 1, 0; here they are 0, 1, 2.
  EXPECT_EQ(mesh.uvs, (std::vector<std::array<float, 2>>{{0, 0}, {0.5F, 0.25F}}));
  EXPECT_EQ(mesh.corner_uvs, (std::vector<std::uint32_t>{0, 0, 1, ~0U, ~0U, ~0U}));
  EXPECT_EQ(mesh.corner_normals, (std::vector<std::uint32_t>{2, 1, 0, ~0U, ~0U, ~0U}));
  EXPECT_EQ(mesh.normals[0], (Vec3f{0, 0, 1}));
  ASSERT_EQ(mesh.colors.size(), 6U);
  EXPECT_EQ(mesh.colors[1], (std::array<std::uint8_t, 4>{0, 255, 0, 255}));
  EXPECT_EQ(mesh.colors[5], (std::array<std::uint8_t, 4>{255, 255, 255, 255}));
  EXPECT_EQ(mesh.losses.Text(), "further texture coordinates (map2), attributes (mass)");
}

TEST_F(AlembicSceneTest, NormalsTurnWithTheirMesh) {
  Open({files_.Xform("x", {kRotateX, kScale}, {{90, 1, 1, 5}},
                     {files_.Triangle("t", {0}, 0, {files_.Floats("N", 3, {{0, 0, 1, 0, 0.6F, 0.8F, 1, 0, 0}})})})});
  const PolygonMesh mesh = Mesh();
  // Alembic's corners are vertices 2, 1, 0, but the scope is missing: three normals suit the corners.
  ASSERT_EQ(mesh.normals.size(), 3U);
  EXPECT_NEAR(mesh.normals[0][1], -1, 1e-6);
  EXPECT_NEAR(mesh.normals[1][2] / mesh.normals[1][1], -0.6 * 5 / 0.8, 1e-5);
  EXPECT_NEAR(mesh.normals[2][0], 1, 1e-6);
}

TEST_F(AlembicSceneTest, ColorsOfFacesAreTold) {
  const std::string rgb = ";interpretation=rgb";
  Open({AlembicFiles::Object(
      "m", "AbcGeom_PolyMesh_v1",
      {AlembicFiles::Compound(".geom",
                              {files_.Floats("P", 3, {{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}}),
                               files_.Ints(".faceIndices", {{0, 1, 2, 2, 1, 3}}), files_.Ints(".faceCounts", {{3, 3}}),
                               AlembicFiles::Compound(".arbGeomParams", {files_.Floats("Cd", 3, {{1, 0, 0, 0, 1, 0}}, 0,
                                                                                       "geoScope=uni" + rgb)})})})});
  const PolygonMesh mesh = Mesh();
  EXPECT_TRUE(mesh.colors.empty());
  EXPECT_EQ(mesh.losses.Text(), "colors of faces and corners (Cd)");
}

TEST_F(AlembicSceneTest, WhatIsNoMeshIsTold) {
  Open({AlembicFiles::Object("c", "AbcGeom_Curve_v2", {}), AlembicFiles::Object("p", "AbcGeom_Points_v1", {}),
        AlembicFiles::Object("camera1", "AbcGeom_Camera_v1", {}), AlembicFiles::Object("q", "Studio_Rig_v1", {}),
        files_.Triangle("t", {0}, 0, {files_.Floats(".velocities", 3, {{0, 0, 0, 0, 0, 0, 0, 0, 0}})}),
        files_.Triangle("none", {})});
  EXPECT_EQ(Mesh().losses.Text(),
            "curves (/c), points (/p), cameras (/camera1), objects of unknown schemas (/q), velocities (1), empty "
            "meshes (/none)");
}

TEST_F(AlembicSceneTest, HiddenMeshesAreLeftOutAndHidingIsTold) {
  const std::uint32_t times = files_.AddTimes(1, {0});
  AlembicObjectTree hidden = files_.Xform("h", {}, {{}}, {files_.Triangle("t", {0})});
  hidden.properties.properties.push_back(files_.Bytes("visible", {{0}}));
  // It shows in spite of its parent.
  hidden.children.push_back(files_.Triangle("shown", {0}, 0, {}, {files_.Bytes("visible", {{1}})}));
  Open({hidden, files_.Triangle("blinks", {0}, 0, {}, {files_.Bytes("visible", {{-1}, {0}, {-1}}, times)})});
  const PolygonMesh mesh = Mesh();
  EXPECT_EQ(mesh.positions.size(), 6U);
  EXPECT_EQ(mesh.losses.Text(), "hidden meshes (/h/t)");
  ASSERT_EQ(mesh.warnings.size(), 1U);
  EXPECT_EQ(mesh.warnings[0], "/blinks: is hidden at times, which is not kept; it shows in every frame");
}

TEST_F(AlembicSceneTest, InstancesShowTheSameMesh) {
  Open({files_.Xform("x", {kTranslate}, {{1, 0, 0}}, {files_.Triangle("t", {0})}),
        files_.Xform("y", {kTranslate}, {{0, 5, 0}},
                     {AlembicFiles::Object("i", "", {files_.Text(".instanceSource", "/x")})})});
  const PolygonMesh mesh = Mesh();
  ASSERT_EQ(mesh.positions.size(), 6U);
  ExpectNear(mesh.positions[0], {1, 0, 0});
  ExpectNear(mesh.positions[3], {1, 5, 0});
}

TEST_F(AlembicSceneTest, TopologyThatChangesIsTold) {
  const std::uint32_t times = files_.AddTimes(1, {0});
  const std::vector<float> points = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
  Open({AlembicFiles::Object(
      "m", "AbcGeom_PolyMesh_v1",
      {AlembicFiles::Compound(".geom", {files_.Floats("P", 3, {points, points, points}, times),
                                        files_.Ints(".faceIndices", {{0, 1, 2}, {0, 1, 2}, {0, 1, 3}}, times),
                                        files_.Ints(".faceCounts", {{3}})})})});
  PolygonMesh mesh;
  EXPECT_TRUE(scene_->ReadPositions(1, mesh).ok());
  const Status status = scene_->ReadPositions(2, mesh);
  EXPECT_EQ(status.code(), StatusCode::kUnsupported);
  EXPECT_EQ(status.message(), "/m: frame 2: other vertices or faces than in frame 0");
  EXPECT_TRUE(scene_->ReadPositions(2, mesh, 2).ok());
  EXPECT_EQ(Mesh(2).faces.vertices, (std::vector<std::uint32_t>{3, 1, 0}));
}

}  // namespace
}  // namespace sac
