// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "sac/clip.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// Sparse localized components of an animated mesh: a clip is taken apart into a few dozen local deformations, each with
// a weight a frame. Of displacements (Neumann et al., "Sparse localized deformation components", ACM TOG 32(6), 2013)
// or of deformation gradients (Huang et al., "Sparse localized decomposition of deformation gradients", Computer
// Graphics Forum 33(7), 2014).
enum class ComponentDomain {
  kDisplacement,  // three channels a vertex: its displacement from the rest shape, model units
  kGradient,      // nine a triangle: rotation vector (radians), then xx, yy, zz, xy, xz, yz of the stretch less one
};

// What displacements and gradients are measured from.
enum class RestShape {
  kFirstFrame,
  kMean,   // of all frames, each brought onto the first by a rigid motion
  kGiven,  // DecompositionSettings::rest
};

// A component that the user asks for: its support grows from these vertices and does not move away.
struct Stroke {
  std::string name;                     // empty: "stroke 0" and so on
  std::vector<std::uint32_t> vertices;  // at least one
  // Empty, or one a vertex, model units: then the component itself is given. It moves the vertices by these at weight 1
  // and fades out around them, and only its weights are found. Displacement domain only.
  std::vector<Vec3f> displacements;
};

struct DecompositionProgress {
  std::uint32_t components = 0;  // how many are being found
  std::uint32_t iteration = 0;   // of those, from 1; 0: before the first
  double objective = 0;          // after it
};

struct DecompositionSettings {
  ComponentDomain domain = ComponentDomain::kDisplacement;
  std::uint32_t count = 40;  // strokes included; 1 to 4096
  double sparsity = 0.03;    // lambda is this times the number of frames; larger: more local, less exact. At least 0
  // Where a component's support begins to cost, and where it costs full price, as fractions of the square root of the
  // rest shape's area; beyond, the price grows up to `steep` times. 0 <= near < far, steep >= 1.
  double near = 0.1, far = 0.5, steep = 3;
  bool positive = false;  // weights from 0 to 1, not from -1 to 1
  RestShape rest_shape = RestShape::kFirstFrame;
  Positions rest;                    // with RestShape::kGiven, as many as the clip has vertices
  std::vector<Stroke> strokes;       // at most `count`
  std::vector<std::uint32_t> still;  // vertices that no component moves
  std::uint32_t iterations = 60;     // at most; at least 1
  std::uint32_t moving = 20;         // iterations in which centres move
  // In the gradient domain: find the weights anew, by the positions that they lead to. A fit of gradients does not care
  // where a limb ends up.
  bool fit_positions = true;
  double tolerance = 1e-4;    // relative fall of the objective below which it ends, once centres rest
  std::uint32_t threads = 0;  // 0: as many as the machine has. The result does not depend on it
  std::size_t field_memory = std::size_t{1}
                             << 31;  // bytes for all frames' values; more are reduced by a randomized SVD
  // Is called on the caller's thread after each iteration; false ends in kCancelled.
  std::function<bool(const DecompositionProgress&)> progress;
};

// A rigid motion: x becomes rotation x + translation.
struct RigidPose {
  std::array<double, 9> rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1};  // row by row
  std::array<double, 3> translation = {};                        // model units
};

// One component. At weight w it adds w times its values to the nodes it has, and nothing elsewhere.
struct SparseComponent {
  std::string name;
  std::uint32_t centre = 0;          // vertex or triangle
  std::vector<std::uint32_t> nodes;  // vertices or triangles, ascending
  std::vector<float> values;         // nodes x channels
};

// A clip taken apart. Frame f is the rest shape, deformed by sum_k weight(f, k) component_k, then moved by track[f].
struct SparseComponents {
  ComponentDomain domain = ComponentDomain::kDisplacement;
  bool positive = false;  // weights from 0 to 1, otherwise from -1 to 1
  Positions rest;
  std::vector<Triangle> triangles;
  std::vector<SparseComponent> components;
  std::vector<float> weights;    // frames x components
  std::vector<RigidPose> track;  // one a frame
  FrameRate rate = {};
  std::vector<std::uint32_t> still;  // vertices that no component moves

  std::size_t frames() const { return track.size(); }
  std::size_t channels() const { return domain == ComponentDomain::kDisplacement ? 3 : 9; }
  std::size_t nodes() const { return domain == ComponentDomain::kDisplacement ? rest.size() : triangles.size(); }
  float weight(std::size_t frame, std::size_t component) const {
    return weights[frame * components.size() + component];
  }
};

// What a decomposition came to.
struct DecompositionReport {
  std::vector<double> objective;     // after each iteration; for values scaled to a mean square of 1
  bool converged = false;            // the objective fell by less than the tolerance
  double residual_share = 0;         // |X - W C|^2 / |X|^2, weighted by area
  double nonzero_share = 0;          // of all pairs of a node and a component, those where the component is not 0
  double dropped_energy = 0;         // share of |X|^2 that the randomized SVD left out, exact; 0 if there was none
  std::uint32_t columns = 0;         // frames, or what they were reduced to
  std::uint32_t loose_vertices = 0;  // in no triangle with area; in the gradient domain they only move rigidly
};

// Takes a clip apart. The objective is that of the papers, weighted by area and minimized by exact block coordinate
// descent; docs/decomposition.md says how it differs from what was published, and why. Reads the clip two to four
// times; memory is linear in the vertices.
//
// kInvalidArgument for settings out of range, strokes or still vertices that the mesh does not have, no vertices, no
// frames, a frame of another size or that is not finite, and in the gradient domain a mesh without area; kLimit where
// memory does not suffice; kCancelled; the errors of `clip`.
Status DecomposeClip(ClipReader& clip, const DecompositionSettings& settings, SparseComponents& result,
                     DecompositionReport& report);

// The error of a reconstruction.
struct ReconstructionError {
  double erms = 0;  // 1000 sqrt(mean square error of a coordinate), the longest side of the box of all frames being 1
  double max = 0;   // largest distance of a vertex, model units
};

// Measures `components` against the clip that they were made from, or were fitted to. Errors as of DecomposeClip().
Status MeasureComponents(ClipReader& clip, const SparseComponents& components, ReconstructionError& error);

}  // namespace sac
