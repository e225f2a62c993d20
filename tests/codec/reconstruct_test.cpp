// SPDX-License-Identifier: Apache-2.0
#include "codec/reconstruct.h"

#include <gtest/gtest.h>

#include "tests/test_meshes.h"

namespace sac {
namespace {

constexpr std::uint32_t kHarmonics = 12;

struct Fixture {
  Fixture() {
    header.motion_step = header.displacement_step = 0.01f;
    header.rotation_step = header.translation_step = 0.01f;
    MakeShape(SphereMesh(4), {kHarmonics}, 0, 16, header, shape);
    for (std::size_t p = 0; p < frame.planes.size(); ++p) frame.planes[p].resize(shape.layouts[p].size());
  }
  PositionMatrix Reconstruct() {
    Reconstructor fresh(shape, header);
    fresh.StartGroup();
    EXPECT_TRUE(fresh.StartFrame(false));
    return fresh.Reconstruct(frame);
  }

  SequenceHeader header;
  Shape shape;
  FrameCoefficients frame;  // of zeros
};

TEST(Reconstruct, OfNothingIsTheFirstShape) {
  Fixture f;
  EXPECT_LT((f.Reconstruct() - f.shape.positions).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(Reconstruct, OfTheSameRotationEverywhereTurnsTheShape) {
  Fixture f;
  f.frame.planes[kMotion][2] = 800;  // the constant harmonic, about z
  const PositionMatrix centred = f.shape.positions.rowwise() - f.shape.centre;
  const PositionMatrix turned =
      Moved(centred, AxisAngle({0, 0, 1}, 800 * static_cast<double>(f.header.motion_step) / 16), f.shape.centre);
  EXPECT_LT((f.Reconstruct() - turned).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Reconstruct, OfADisplacementMovesByIt) {
  Fixture f;
  f.frame.planes[kDisplacement][3 * 5 + 1] = -300;
  PositionMatrix moved = f.shape.positions;
  moved.col(1) -=
      300 * static_cast<double>(f.header.displacement_step) / 16 * f.shape.basis.components[0].vectors.col(5);
  EXPECT_LT((f.Reconstruct() - moved).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(Reconstruct, RemovesItsRigidMotion) {
  Fixture f;
  const Reconstructor reconstructor(f.shape, f.header);
  const RigidMotion rigid = {30, -100, 70, 500, -20, 1};
  const PositionMatrix moved = reconstructor.ApplyRigid(f.shape.positions, rigid);
  EXPECT_GT((moved - f.shape.positions).cwiseAbs().maxCoeff(), 1);
  EXPECT_LT((reconstructor.RemoveRigid(moved, rigid) - f.shape.positions).cwiseAbs().maxCoeff(), 1e-14);
}

// Fields are summed up from frame to frame; what a large one leaves behind must not show.
TEST(Reconstruct, DoesNotDependOnTheFramesBefore) {
  Fixture f;
  f.frame.planes[kMotion][9 * 3 + 1] = 40;
  f.frame.planes[kDisplacement][3 * 7 + 2] = 30;
  const PositionMatrix alone = f.Reconstruct();
  Reconstructor after(f.shape, f.header);
  after.StartGroup();
  FrameCoefficients large = f.frame;
  for (const Plane p : {kMotion, kDisplacement}) {
    for (std::size_t i = 0; i < large.planes[p].size(); ++i) large.planes[p][i] = (1 << 30) + static_cast<int>(i);
  }
  ASSERT_TRUE(after.StartFrame(false));
  after.Reconstruct(large);
  ASSERT_TRUE(after.StartFrame(false));
  EXPECT_EQ(after.Reconstruct(f.frame), alone);
}

}  // namespace
}  // namespace sac
