// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sac/mesh.h"

namespace sac {

// The error of Karni and Gotsman, "Compression of soft-body animation sequences", Computers & Graphics 28(1), 2004,
// section 5:
//
//   KG = 100 ||A - B||_F / ||A - E(A)||_F,
//
// where A are the original and B the decoded positions of all frames, and E(A) is the mean over the vertices of each
// frame and axis. KG is a percentage of the original's own spread, so that it depends neither on the unit nor on where
// the model stands.
class KgError {
 public:
  // Takes the next frame. Both have the same number of vertices, which may be another one than before.
  void Add(const Positions& original, const Positions& decoded);

  // In percent. An original without spread (every frame a single point) makes the quotient 0 / 0 or x / 0: the error is
  // then 0 if the decoded positions are exact, and infinite otherwise.
  double Value() const;

 private:
  double error_ = 0;   // ||A - B||_F^2
  double spread_ = 0;  // ||A - E(A)||_F^2
};

}  // namespace sac
