// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "files/alembic/alembic_samples.h"
#include "files/faces.h"

namespace sac {

// An attribute of a mesh ("geom param"): values, and perhaps indices of them, for each corner, vertex or face, or one
// for all. Facts: Alembic's sources, lib/Alembic/AbcGeom/IGeomParam.h and GeometryScope.h.
class AlembicAttribute {
 public:
  enum class Scope { kCorner, kVertex, kFace, kConstant };

  // The attribute's property: an array, or a compound of `.vals` and `.indices`. kCorrupt: neither.
  static Status Open(AlembicArchive& archive, const AlembicProperty& property, AlembicAttribute& attribute);

  // False where there is no sample.
  bool any() const { return values_.size() > 0; }
  bool constant() const { return values_.constant() && indices_.constant(); }
  // Numbers of a value.
  std::size_t components() const { return components_; }

  // Reads the values at `time` and, for each corner of `faces`, the index of its value. `fits` is false where there are
  // not as many values or indices as the scope wants; nothing else is meant then. kCorrupt: an index out of range.
  Status Read(double time, const Faces& faces, std::size_t vertices, std::vector<float>& values,
              std::vector<std::uint32_t>& of_corners, bool& fits) const;

 private:
  AlembicSamples values_, indices_;  // without indices each item has its own value
  std::size_t components_ = 1;
  std::optional<Scope> scope_;  // none: that with as many items
};

}  // namespace sac
