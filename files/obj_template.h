// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// An OBJ file as a template for others: the text as it is, with polygons, texture coordinates, groups, materials, names
// and comments, and other coordinates in the places of its vertices.
class ObjTemplate {
 public:
  // Takes the text of a file that ParseObj() accepts, normalized (NormalizeText).
  static Status Parse(std::string text, ObjTemplate& obj);

  std::size_t vertices() const { return vertices_; }
  // The normals in the order of the text, faces or none using them.
  const std::vector<Vec3f>& normals() const { return normals_; }
  // Others in their places, as many.
  void ReplaceNormals(std::vector<Vec3f> normals);

  // The text with these positions, `offset` added, in the order of its vertices, as FormatObj() writes numbers.
  std::string Format(const Positions& positions, const std::array<double, 3>& offset) const;

 private:
  // Where three numbers stand in the text.
  struct Place {
    std::size_t begin = 0, end = 0;
    bool normal = false;
  };

  std::string text_;
  std::vector<Place> places_;
  std::size_t vertices_ = 0;
  std::vector<Vec3f> normals_;
  bool replaced_ = false;  // else normals stay as they are written
};

}  // namespace sac
