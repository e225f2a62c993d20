// SPDX-License-Identifier: Apache-2.0
#include "decomposition/poisson.h"

#include <gtest/gtest.h>

#include <cmath>

#include "decomposition/gradient_pose.h"
#include "geometry/deformation.h"
#include "geometry/triangle_fields.h"
#include "tests/decomposition/test_fields.h"
#include "tests/test_meshes.h"

namespace sac {
namespace {

double Extent(const PositionMatrix& p) { return (p.colwise().maxCoeff() - p.colwise().minCoeff()).maxCoeff(); }

TEST(Poisson, ExactGradientsGiveTheShapeBack) {
  const Mesh tube = TubeMesh(30, 10);
  const PositionMatrix rest = ToMatrix(tube.positions);
  PoissonReconstruction poisson;
  ASSERT_TRUE(poisson.Prepare(rest, tube.triangles, {}).ok());
  for (const double angle : {0.0, 0.5, 2.0}) {
    const PositionMatrix bent = ToMatrix(BentTube(tube, angle));
    TriangleFields fields(tube.triangles);
    PositionMatrix found = poisson.Reconstruct(fields.Measure(rest, bent));
    found.rowwise() += (bent - found).colwise().mean();
    EXPECT_LT((found - bent).cwiseAbs().maxCoeff(), 1e-6 * Extent(bent)) << angle;
  }
}

TEST(Poisson, ComponentsKeepTheirCentroidsAndLooseVerticesStay) {
  const Mesh mesh = PartsMesh();
  const PositionMatrix rest = ToMatrix(mesh.positions);
  PoissonReconstruction poisson;
  ASSERT_TRUE(poisson.Prepare(rest, mesh.triangles, {}).ok());
  EXPECT_EQ(poisson.loose_vertices(), 1u);
  Eigen::MatrixXd q = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(mesh.triangles.size()), 9);
  q.col(2).setConstant(1.0);  // all turn about z
  const PositionMatrix turned = poisson.Reconstruct(q);
  const Eigen::Matrix3d r = RotationOf({0, 0, 1});
  // The sphere comes first, its centroid the origin.
  const Eigen::Index sphere = static_cast<Eigen::Index>(SphereMesh(3).positions.size());
  EXPECT_LT((turned.topRows(sphere) - rest.topRows(sphere) * r.transpose()).cwiseAbs().maxCoeff(), 1e-5);
  EXPECT_EQ(turned.row(turned.rows() - 1), rest.row(rest.rows() - 1));
}

TEST(Poisson, LogarithmsNearNothingAndNearHalfATurn) {
  const Mesh mesh = SphereMesh(4);
  const PositionMatrix rest = ToMatrix(mesh.positions);
  for (const double angle : {0.0, 1e-9, 1e-6, 1.0, 3.14159, 3.1415926}) {
    const Eigen::Matrix3d r = AxisAngle({1, -2, 3}, angle);
    TriangleFields fields(mesh.triangles);
    const Eigen::MatrixXd& q = fields.Measure(rest, rest * r.transpose());
    for (Eigen::Index j = 0; j < q.rows(); ++j) {
      const double channels[9] = {q(j, 0), q(j, 1), q(j, 2), q(j, 3), q(j, 4), q(j, 5), q(j, 6), q(j, 7), q(j, 8)};
      EXPECT_LT((DeformationGradient(channels) - r).cwiseAbs().maxCoeff(), 1e-7) << angle;
    }
  }
}

TEST(GradientPose, DerivativesAreThoseOfTheShape) {
  Clip clip{TubeMesh(20, 8), {}};
  for (int f = 0; f < 10; ++f) clip.frames.push_back(BentTube(clip.mesh, 0.15 * f));
  DecompositionSettings settings;
  settings.count = 4;
  settings.domain = ComponentDomain::kGradient;
  const SparseComponents components = Decomposed(clip, settings);
  GradientPose pose;
  ASSERT_TRUE(pose.Prepare(components, ToMatrix(components.rest)).ok());
  Eigen::VectorXd w(4);
  w << 0.7, -0.4, 0.2, 0.1;
  const RowMatrix all = pose.Derivatives(w);
  const std::vector<std::uint32_t> vertices{3, 77, 159};
  const PosedVertices some_vertices(pose, vertices, w);
  Eigen::MatrixXd some;
  const Eigen::VectorXd offsets = some_vertices.Offsets(w, &some);
  const PositionMatrix shape = pose.Shape(w);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Eigen::RowVector3d moved = shape.row(vertices[i]) - ToMatrix(components.rest).row(vertices[i]);
    EXPECT_LT((offsets.segment<3>(3 * static_cast<Eigen::Index>(i)) - moved.transpose()).norm(), 1e-9);
  }
  const RowMatrix y = RowMatrix::Random(shape.rows(), 3);
  const Eigen::VectorXd of_sum = pose.DerivativesOfSum(w, y);
  for (Eigen::Index k = 0; k < 4; ++k) {
    EXPECT_NEAR(of_sum[k], all.middleCols(3 * k, 3).cwiseProduct(y).sum(), 1e-9 * (1 + std::abs(of_sum[k])));
  }
  for (Eigen::Index k = 0; k < 4; ++k) {
    Eigen::VectorXd step = Eigen::VectorXd::Zero(4);
    step[k] = 1e-5;
    const PositionMatrix numeric = (pose.Shape(w + step) - pose.Shape(w - step)) / 2e-5;
    EXPECT_LT((all.middleCols(3 * k, 3) - numeric).cwiseAbs().maxCoeff(), 1e-5 * (1 + numeric.cwiseAbs().maxCoeff()));
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const Eigen::Vector3d there = some.block<3, 1>(3 * static_cast<Eigen::Index>(i), k);
      // Of groups of triangles that are nearly alike.
      EXPECT_LT((there - numeric.row(vertices[i]).transpose()).norm(), 0.1 * numeric.cwiseAbs().maxCoeff());
    }
  }
}

}  // namespace
}  // namespace sac
