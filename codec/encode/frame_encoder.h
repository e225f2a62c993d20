#pragma once

#include <Eigen/Core>

#include "codec/encode/projection.h"
#include "codec/encode/triangle_fields.h"
#include "codec/prediction.h"
#include "codec/reconstruct.h"
#include "codec/shape.h"
#include "format/frame_syntax.h"
#include "format/sequence_header.h"

namespace sac {

// Chooses the syntax of one frame after another, asking the decoder's own Reconstructor what it gives.
class FrameEncoder {
 public:
  // `shape` must outlive it.
  FrameEncoder(const Shape& shape, const SequenceHeader& header);

  // The next frame is the first of a group.
  void StartGroup();
  // `positions`: in decoded vertex order, model units. False when a value leaves the range of the format or the
  // reference shape cannot be factorized.
  bool Encode(const PositionMatrix& positions, FrameSyntax& frame);

 private:
  std::array<std::int32_t, 6> ChooseRigid(const PositionMatrix& positions,
                                          const std::array<std::int32_t, 6>& prediction);
  // Whether a frame costs less as an intra frame than with the residual `predicted`.
  bool BetterFromZero(const Eigen::MatrixXd& target, std::span<const std::int32_t> predicted) const;

  const Shape& shape_;
  SequenceHeader header_;
  TriangleFields fields_;
  Projection projection_;
  Eigen::VectorXd motion_steps_;
  Eigen::VectorXd displacement_steps_;
  Predictor predictor_;
  Reconstructor reconstructor_;
  bool starts_group_ = true;
  PositionMatrix last_positions_;
  FrameCoefficients last_;
  Eigen::Vector3d last_rotation_ = Eigen::Vector3d::Zero();
};

}  // namespace sac
