// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "files/output_file.h"
#include "files/scene_writer.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// True for .usda in any case.
bool IsUsdName(const std::string& path);

// Advice for a USD file that is to be read, which sac does not do; empty for other names.
std::string UsdInputError(const std::string& path);

struct UsdSettings {
  double fps = 24;                    // frames a second
  std::array<double, 3> offset = {};  // of all positions; becomes a translation
  bool z_up = false;
};

// Writes a clip as USD text: an Xform with a Mesh that is not subdivided, whose points, and normals if the mesh has
// any, have a time sample for each frame, at the frame's number. Memory is that of all frames.
class UsdWriter : public SceneWriter {
 public:
  Status Open(const std::string& path, const Mesh& mesh, const UsdSettings& settings);
  Status Write(std::int64_t number, const Positions& positions, const std::vector<Vec3f>& normals) override;
  Status Commit() override;

 private:
  std::string Header() const;
  std::string Faces() const;
  std::string Attributes() const;
  // `samples` has one list for each frame.
  Status WriteSamples(const std::string& attribute, const std::vector<std::vector<Vec3f>>& samples,
                      const std::string& metadata);

  OutputFile file_;
  std::string path_;
  Mesh mesh_;
  UsdSettings settings_;
  std::vector<std::int64_t> numbers_;
  std::vector<std::vector<Vec3f>> frames_, normals_;
};

}  // namespace sac
