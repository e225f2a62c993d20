// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "files/alembic/alembic_samples.h"

namespace sac {

// The transform of an object of schema AbcGeom_Xform: a list of operations, whose numbers may move. A point goes
// through the last one first. Facts: Alembic's sources, lib/Alembic/AbcGeom/XformSample.cpp and XformOp.cpp.
class AlembicTransform {
 public:
  // An object without operations has the identity. kCorrupt, kUnsupported: an operation that is not known, numbers of
  // another count than the operations take, operations that change.
  static Status Open(AlembicArchive& archive, const AlembicObject& object, AlembicTransform& transform);

  // Whether it goes on from its parent's, as is usual, or stands by itself.
  bool inherits() const { return inherits_; }

  // The numbers of the operations; no samples where there are none.
  const AlembicSamples& numbers() const { return numbers_; }

  // The matrix at `time`, seconds. Between samples, lengths and angles are linear; of a matrix the rotation turns
  // evenly, and stretch and translation are linear.
  Status At(double time, Eigen::Affine3d& matrix) const;

 private:
  enum class Operation : std::uint8_t {
    kScale = 0,
    kTranslate,
    kRotate,  // about an axis
    kMatrix,
    kRotateX,
    kRotateY,
    kRotateZ,
  };
  // The numbers that an operation takes.
  static std::size_t Numbers(Operation operation);
  static Eigen::Affine3d Matrix(Operation operation, const double* numbers);
  static Eigen::Affine3d Between(Operation operation, const double* low, const double* high, double weight);
  Status Read(double time, Eigen::Affine3d& matrix) const;
  Status OpenOperations(AlembicArchive& archive, const AlembicProperty& property);

  bool inherits_ = true;
  std::vector<Operation> operations_;
  AlembicSamples numbers_;
  std::optional<Eigen::Affine3d> fixed_;  // where it does not move
};

}  // namespace sac
