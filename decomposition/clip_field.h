// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "decomposition/node_field.h"
#include "decomposition/rest_alignment.h"
#include "sac/clip.h"
#include "sac/sparse_components.h"
#include "sac/status.h"

namespace sac {

// The frames of a clip as what is decomposed.
struct ClipField {
  std::unique_ptr<RestAlignment> alignment;
  std::vector<RigidPose> track;  // one a frame
  NodeField field;               // scaled to a mean square of 1
  double scale = 1;              // by which the field's values are to be multiplied
};

// Reads `clip`, takes the rigid motion out of each frame and measures displacements or gradients. Where they exceed
// settings.field_memory the frames are reduced by a randomized SVD (Halko et al. 2011); field.dropped_energy says
// exactly what that leaves out. Errors as of DecomposeClip().
Status ReadClipField(ClipReader& clip, const DecompositionSettings& settings, ClipField& result);

}  // namespace sac
