// SPDX-License-Identifier: Apache-2.0
#include "files/alembic/alembic_transform.h"

#include <cmath>
#include <numbers>
#include <string>

namespace sac {
namespace {

double Radians(double degrees) { return degrees * std::numbers::pi / 180; }

double Mix(double low, double high, double weight) { return low + weight * (high - low); }

// M = R S with a rotation R and a symmetric S; a reflection is in S.
void Polar(const Eigen::Matrix3d& matrix, Eigen::Quaterniond& rotation, Eigen::Matrix3d& stretch) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d r = svd.matrixU() * svd.matrixV().transpose();
  if (r.determinant() < 0) r = -r;
  rotation = Eigen::Quaterniond(r);
  stretch = r.transpose() * matrix;
}

}  // namespace

std::size_t AlembicTransform::Numbers(Operation operation) {
  switch (operation) {
    case Operation::kScale:
    case Operation::kTranslate:
      return 3;
    case Operation::kRotate:
      return 4;
    case Operation::kMatrix:
      return 16;
    default:
      return 1;
  }
}

Eigen::Affine3d AlembicTransform::Matrix(Operation operation, const double* n) {
  Eigen::Affine3d m = Eigen::Affine3d::Identity();
  switch (operation) {
    case Operation::kScale:
      return m.scale(Eigen::Vector3d(n[0], n[1], n[2]));
    case Operation::kTranslate:
      return m.translate(Eigen::Vector3d(n[0], n[1], n[2]));
    case Operation::kRotate: {
      const Eigen::Vector3d axis(n[0], n[1], n[2]);
      if (axis.norm() > 0) m.rotate(Eigen::AngleAxisd(Radians(n[3]), axis.normalized()));
      return m;
    }
    case Operation::kMatrix:
      // Alembic has points as rows.
      for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) m(row, column) = n[4 * column + row];
      }
      return m;
    case Operation::kRotateX:
      return m.rotate(Eigen::AngleAxisd(Radians(n[0]), Eigen::Vector3d::UnitX())), m;
    case Operation::kRotateY:
      return m.rotate(Eigen::AngleAxisd(Radians(n[0]), Eigen::Vector3d::UnitY())), m;
    default:
      return m.rotate(Eigen::AngleAxisd(Radians(n[0]), Eigen::Vector3d::UnitZ())), m;
  }
}

Eigen::Affine3d AlembicTransform::Between(Operation operation, const double* low, const double* high, double weight) {
  if (operation == Operation::kMatrix || operation == Operation::kRotate) {
    const Eigen::Affine3d a = Matrix(operation, low), b = Matrix(operation, high);
    Eigen::Quaterniond rotation_a, rotation_b;
    Eigen::Matrix3d stretch_a, stretch_b;
    Polar(a.linear(), rotation_a, stretch_a);
    Polar(b.linear(), rotation_b, stretch_b);
    Eigen::Affine3d mixed = Eigen::Affine3d::Identity();
    mixed.linear() =
        rotation_a.slerp(weight, rotation_b).toRotationMatrix() * (stretch_a + weight * (stretch_b - stretch_a));
    mixed.translation() = a.translation() + weight * (b.translation() - a.translation());
    const bool same_axis = low[0] == high[0] && low[1] == high[1] && low[2] == high[2];
    if (operation == Operation::kMatrix || !same_axis) return mixed;
  }
  double numbers[4] = {};
  for (std::size_t i = 0; i < Numbers(operation); ++i) numbers[i] = Mix(low[i], high[i], weight);
  return Matrix(operation, numbers);
}

Status AlembicTransform::OpenOperations(AlembicArchive& archive, const AlembicProperty& property) {
  AlembicSamples operations;
  SAC_RETURN_IF_ERROR(AlembicSamples::Open(archive, property, operations));
  if (operations.size() == 0) return Status::Ok();
  if (!operations.constant()) return Status::Unsupported("operations of a transform that change");
  std::vector<std::int64_t> codes;
  SAC_RETURN_IF_ERROR(operations.Read(0, codes));
  for (const std::int64_t code : codes) {
    const std::int64_t type = code >> 4;  // the low bits are a hint for editors
    if (type < 0 || type > 6) return Status::Unsupported("an unknown operation of a transform");
    operations_.push_back(static_cast<Operation>(type));
  }
  return Status::Ok();
}

Status AlembicTransform::Open(AlembicArchive& archive, const AlembicObject& object, AlembicTransform& transform) {
  transform = {};
  const AlembicProperty* xform = object.properties.Find(".xform");
  if (xform == nullptr) return Status::Ok();
  if (const AlembicProperty* inherits = xform->Find(".inherits")) {
    AlembicSamples samples;
    SAC_RETURN_IF_ERROR(AlembicSamples::Open(archive, *inherits, samples));
    std::vector<std::int64_t> value;
    if (samples.size() > 0) SAC_RETURN_IF_ERROR(samples.Read(0, value));
    if (!samples.constant()) return Status::Unsupported("a transform that takes up its parent's only at times");
    transform.inherits_ = value.empty() || value[0] != 0;
  }
  if (const AlembicProperty* operations = xform->Find(".ops")) {
    SAC_RETURN_IF_ERROR(transform.OpenOperations(archive, *operations));
  }
  if (transform.operations_.empty()) return Status::Ok();
  const AlembicProperty* numbers = xform->Find(".vals");
  if (numbers == nullptr) return Status::Corrupt("a transform without numbers");
  SAC_RETURN_IF_ERROR(AlembicSamples::Open(archive, *numbers, transform.numbers_));
  if (transform.numbers_.size() == 0) transform.operations_.clear();
  if (transform.numbers_.constant()) return transform.Read(0, transform.fixed_.emplace());
  return Status::Ok();
}

Status AlembicTransform::At(double time, Eigen::Affine3d& matrix) const {
  if (!fixed_) return Read(time, matrix);
  matrix = *fixed_;
  return Status::Ok();
}

Status AlembicTransform::Read(double time, Eigen::Affine3d& matrix) const {
  matrix = Eigen::Affine3d::Identity();
  if (operations_.empty()) return Status::Ok();
  std::size_t wanted = 0;
  for (const Operation operation : operations_) wanted += Numbers(operation);
  const AlembicMoment moment = numbers_.At(time);
  std::vector<double> low, high;
  SAC_RETURN_IF_ERROR(numbers_.Read(moment.low, low));
  if (moment.weight > 0 && !numbers_.Same(moment.low, moment.high)) {
    SAC_RETURN_IF_ERROR(numbers_.Read(moment.high, high));
  }
  if (low.size() != wanted || (!high.empty() && high.size() != wanted)) {
    return Status::Corrupt("a transform of " + std::to_string(low.size()) + " numbers, not " + std::to_string(wanted));
  }
  for (const std::vector<double>* numbers : {&low, &high}) {
    for (const double x : *numbers) {
      if (!std::isfinite(x)) return Status::Corrupt("a transform that is not finite");
    }
  }
  std::size_t at = 0;
  for (const Operation operation : operations_) {
    matrix =
        matrix * (high.empty() ? Matrix(operation, &low[at]) : Between(operation, &low[at], &high[at], moment.weight));
    at += Numbers(operation);
  }
  return Status::Ok();
}

}  // namespace sac
