// SPDX-License-Identifier: Apache-2.0
#include "codec/encode/projection.h"

#include <gtest/gtest.h>

#include "format/plane_layout.h"
#include "geometry/triangle_fields.h"
#include "tests/test_meshes.h"

namespace sac {
namespace {

struct Setting {
  SequenceHeader header;
  Shape shape;
  Eigen::VectorXd areas;
};

void Make(const Mesh& mesh, const std::vector<std::uint32_t>& counts, Setting& s) {
  MakeShape(mesh, counts, 0, 16, s.header, s.shape);
  TriangleFields fields(s.shape.triangles);
  fields.Measure(s.shape.positions, s.shape.positions);
  s.areas = fields.areas();
}

Eigen::MatrixXd Random(Eigen::Index rows, Eigen::Index cols, std::uint32_t seed) {
  std::mt19937 random(seed);
  return Eigen::MatrixXd::NullaryExpr(rows, cols, [&] { return Signed(random); });
}

// The order of a plane's coefficients.
std::vector<HarmonicIndex> Order(const Shape& shape) {
  std::vector<std::uint32_t> counts;
  for (const ComponentHarmonics& c : shape.basis.components) {
    counts.push_back(static_cast<std::uint32_t>(c.vectors.cols()));
  }
  return HarmonicOrder(counts);
}

// Harmonics times coefficients.
Eigen::MatrixXd AtVertices(const Shape& shape, const Eigen::MatrixXd& coefficients) {
  Eigen::MatrixXd field = Eigen::MatrixXd::Zero(shape.positions.rows(), coefficients.cols());
  Eigen::Index row = 0;
  for (const HarmonicIndex& index : Order(shape)) {
    const ComponentHarmonics& c = shape.basis.components[index.component];
    field.middleRows(c.component.first, c.component.count) += c.vectors.col(index.k) * coefficients.row(row++);
  }
  return field;
}

Eigen::MatrixXd AtTriangles(const Shape& shape, const Eigen::MatrixXd& at_vertices) {
  Eigen::MatrixXd field(static_cast<Eigen::Index>(shape.triangles.size()), at_vertices.cols());
  for (std::size_t j = 0; j < shape.triangles.size(); ++j) {
    const Triangle& t = shape.triangles[j];
    field.row(static_cast<Eigen::Index>(j)) =
        (at_vertices.row(t[0]) + at_vertices.row(t[1]) + at_vertices.row(t[2])) / 3;
  }
  return field;
}

TEST(Projection, OfFieldsInTheSpanGivesTheirCoefficients) {
  Setting s;
  Make(PartsMesh(), {25, 12, 2, 1}, s);
  const Projection projection(s.shape, s.areas);
  const Eigen::MatrixXd c = Random(40, 3, 1);
  const Eigen::MatrixXd vertices = AtVertices(s.shape, c);
  EXPECT_LT((projection.ProjectVertices(vertices) - c).cwiseAbs().maxCoeff(), 1e-6);
  const Eigen::MatrixXd triangles = projection.ProjectTriangles(AtTriangles(s.shape, vertices));
  Eigen::Index row = 0;
  for (const HarmonicIndex& index : Order(s.shape)) {
    const double difference = (triangles.row(row) - c.row(row)).cwiseAbs().maxCoeff();
    ++row;
    if (index.component == 3) continue;  // no triangle sees it
    EXPECT_LT(difference, 1e-5) << index.component << ' ' << index.k;
  }
}

TEST(Projection, LeavesWhatIsOrthogonal) {
  Setting s;
  Make(SphereMesh(4), {20}, s);
  const Projection projection(s.shape, s.areas);
  const Eigen::MatrixXd& h = s.shape.basis.components[0].vectors;
  const Eigen::MatrixXd field = Random(s.shape.positions.rows(), 2, 2);
  const Eigen::MatrixXd left = field - AtVertices(s.shape, projection.ProjectVertices(field));
  EXPECT_LT((h.transpose() * left).cwiseAbs().maxCoeff(), 1e-5);

  const Eigen::MatrixXd at_triangles = Random(s.areas.size(), 2, 3), means = AtTriangles(s.shape, h);
  const Eigen::MatrixXd rest = at_triangles - means * projection.ProjectTriangles(at_triangles);
  EXPECT_LT((means.transpose() * s.areas.asDiagonal() * rest).cwiseAbs().maxCoeff(), 1e-5);
}

TEST(Projection, IgnoresDegenerateTriangles) {
  Mesh mesh = SphereMesh(3);
  mesh.triangles.push_back({0, 0, 5});
  Setting s;
  Make(mesh, {10}, s);
  const Projection projection(s.shape, s.areas);
  Eigen::MatrixXd field = Eigen::MatrixXd::Ones(s.areas.size(), 1);
  const Eigen::MatrixXd before = projection.ProjectTriangles(field);
  field(field.rows() - 1, 0) = 1e9;
  EXPECT_EQ(projection.ProjectTriangles(field), before);
}

TEST(Projection, OfAMeshWithoutTrianglesIsFinite) {
  Mesh points;
  for (int i = 0; i < 4; ++i) points.positions.push_back({1.0f * i, 0, 0});
  Setting s;
  Make(points, {1, 1, 1, 1}, s);
  const Projection projection(s.shape, s.areas);
  const Eigen::MatrixXd field = Random(4, 3, 4);
  EXPECT_LT((projection.ProjectVertices(field) - field).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_TRUE(projection.ProjectTriangles(Eigen::MatrixXd(0, 9)).allFinite());
}

}  // namespace
}  // namespace sac
