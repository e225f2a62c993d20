// SPDX-License-Identifier: Apache-2.0
#include "files/triangulation.h"

#include <GL/glu.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace sac {
namespace {

// Flatter triangles, against the area of their face, count as flat, not as flipped.
constexpr double kFlat = 1e-9;

Vec3d Minus(const Vec3d& a, const Vec3d& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vec3d Cross(const Vec3d& a, const Vec3d& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double Dot(const Vec3d& a, const Vec3d& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// A face of four corners or more at hand.
struct Polygon {
  std::uint32_t begin = 0;
  std::vector<Vec3d> points;
  Vec3d normal = {};  // NewellNormal()
  double length = 0;  // of the normal

  void Take(const Faces& faces, std::size_t face, const std::vector<Vec3d>& positions) {
    begin = faces.begin(face);
    points.clear();
    for (std::uint32_t k = begin; k < faces.ends[face]; ++k) {
      // Relative to the first, so that the digits are those of the face and not of its place.
      points.push_back(Minus(positions[faces.vertices[k]], positions[faces.vertices[begin]]));
    }
    normal = NewellNormal(faces, face, positions);
    length = std::sqrt(Dot(normal, normal));
  }

  // The area of a triangle in the plane of the normal over that of the face; negative if the triangle is flipped.
  double RelativeArea(std::size_t a, std::size_t b, std::size_t c) const {
    return Dot(Cross(Minus(points[b], points[a]), Minus(points[c], points[a])), normal) / (length * length);
  }

  bool HasFlatNormal() const { return !(length > 0) || !std::isfinite(length) || !std::isfinite(length * length); }
};

bool FanIsFlipped(const Polygon& polygon) {
  if (polygon.HasFlatNormal()) return false;
  for (std::size_t k = 1; k + 1 < polygon.points.size(); ++k) {
    if (polygon.RelativeArea(0, k, k + 1) < -kFlat) return true;
  }
  return false;
}

// GLU's tessellator, kept for all faces of a mesh.
class Tessellator {
 public:
  Tessellator() : glu_(gluNewTess(), gluDeleteTess) {
    // An edge flag makes it give triangles alone, no strips.
    gluTessCallback(glu_.get(), GLU_TESS_EDGE_FLAG, reinterpret_cast<_GLUfuncptr>(+[](GLboolean) {}));
    gluTessCallback(glu_.get(), GLU_TESS_VERTEX_DATA, reinterpret_cast<_GLUfuncptr>(AddCorner));
    gluTessCallback(glu_.get(), GLU_TESS_COMBINE_DATA, reinterpret_cast<_GLUfuncptr>(Combine));
    gluTessCallback(glu_.get(), GLU_TESS_ERROR_DATA, reinterpret_cast<_GLUfuncptr>(Fail));
  }

  // The corners of the triangles, numbered from 0 within the face. False if there is no sound result.
  bool Cut(const Polygon& polygon, std::vector<std::size_t>& corners) {
    corners_.clear();
    failed_ = false;
    // It asks for the coordinates by pointer, also at the end.
    coordinates_ = polygon.points;
    gluTessNormal(glu_.get(), polygon.normal[0], polygon.normal[1], polygon.normal[2]);
    gluTessBeginPolygon(glu_.get(), this);
    gluTessBeginContour(glu_.get());
    for (Vec3d& point : coordinates_) gluTessVertex(glu_.get(), point.data(), &point);
    gluTessEndContour(glu_.get());
    gluTessEndPolygon(glu_.get());
    if (failed_ || corners_.size() != 3 * (coordinates_.size() - 2)) return false;
    corners.swap(corners_);
    return Covers(polygon, corners);
  }

 private:
  // The triangles fill the face: none is flipped, and together they have its area.
  static bool Covers(const Polygon& polygon, const std::vector<std::size_t>& corners) {
    double sum = 0;
    for (std::size_t k = 0; k < corners.size(); k += 3) {
      const double area = polygon.RelativeArea(corners[k], corners[k + 1], corners[k + 2]);
      if (area < -kFlat) return false;
      sum += area;
    }
    return std::abs(sum - 1) < 1e-6;
  }

  static void AddCorner(void* vertex, void* self) {
    auto* tessellator = static_cast<Tessellator*>(self);
    tessellator->corners_.push_back(
        static_cast<std::size_t>(static_cast<Vec3d*>(vertex) - tessellator->coordinates_.data()));
  }

  // Two corners at one place, or a crossing of edges, which would need a new vertex.
  static void Combine(const GLdouble at[3], void* const vertices[4], const GLfloat[4], void** out, void* self) {
    *out = vertices[0];
    const Vec3d& first = *static_cast<Vec3d*>(vertices[0]);
    if (!std::equal(first.begin(), first.end(), at)) static_cast<Tessellator*>(self)->failed_ = true;
  }

  static void Fail(GLenum, void* self) { static_cast<Tessellator*>(self)->failed_ = true; }

  std::unique_ptr<GLUtesselator, decltype(&gluDeleteTess)> glu_;
  std::vector<Vec3d> coordinates_;
  std::vector<std::size_t> corners_;
  bool failed_ = false;
};

}  // namespace

Vec3d NewellNormal(const Faces& faces, std::size_t face, const std::vector<Vec3d>& positions) {
  const std::uint32_t begin = faces.begin(face);
  const Vec3d& first = positions[faces.vertices[begin]];
  Vec3d normal = {};
  for (std::uint32_t k = begin + 1; k + 1 < faces.ends[face]; ++k) {
    const Vec3d twice =
        Cross(Minus(positions[faces.vertices[k]], first), Minus(positions[faces.vertices[k + 1]], first));
    for (int i = 0; i < 3; ++i) normal[i] += twice[i];
  }
  return normal;
}

Triangulation Triangulate(const Faces& faces, const std::vector<Vec3d>& positions) {
  Triangulation result;
  std::unique_ptr<Tessellator> tessellator;  // few meshes need it
  Polygon polygon;
  std::vector<std::size_t> cut;
  for (std::size_t face = 0; face < faces.size(); ++face) {
    const std::uint32_t begin = faces.begin(face), count = faces.ends[face] - begin;
    result.fragments += count < 3 ? 1 : 0;
    result.quads += count == 4 ? 1 : 0;
    result.polygons += count > 4 ? 1 : 0;
    if (count > 3) {
      polygon.Take(faces, face, positions);
      if (FanIsFlipped(polygon)) {
        if (!tessellator) tessellator = std::make_unique<Tessellator>();
        if (tessellator->Cut(polygon, cut)) {
          const auto corner = [&](std::size_t k) { return begin + static_cast<std::uint32_t>(cut[k]); };
          for (std::size_t k = 0; k < cut.size(); k += 3) {
            result.corners.push_back({corner(k), corner(k + 1), corner(k + 2)});
          }
          continue;
        }
        ++result.overlapping;
      }
    }
    for (std::uint32_t k = 1; k + 1 < count; ++k) result.corners.push_back({begin, begin + k, begin + k + 1});
  }
  return result;
}

}  // namespace sac
