// SPDX-License-Identifier: Apache-2.0
#include "files/author_mesh.h"

#include <cmath>
#include <cstdio>
#include <utility>

#include "files/clip_offset.h"
#include "files/mesh_match.h"
#include "files/path.h"
#include "files/text_scan.h"
#include "geometry/bounding_box.h"

namespace sac {
namespace {

// A mean distance, of the diagonal, above which the mesh is not in the pose of the first frame: several times what the
// lowest quality leaves.
constexpr double kFar = 0.05;

Status ReadTemplate(const std::string& path, ObjTemplate& obj) {
  std::string text;
  SAC_RETURN_IF_ERROR(ReadFileBytes(path, text));
  SAC_RETURN_IF_ERROR(NormalizeText(text));
  return ObjTemplate::Parse(std::move(text), obj);
}

}  // namespace

Status OpenAuthorMesh(const std::string& path, const Mesh& decoded, const std::array<double, 3>& offset,
                      AuthorMesh& author) {
  author = {};
  SAC_RETURN_IF_ERROR(ReadMeshFile(path, {}, author.file));
  Mesh& mesh = author.file.mesh;
  if (!author.file.not_finite.empty()) {
    return Status::InvalidArgument(path + ": " + author.file.not_finite + ": not a finite number");
  }
  mesh.positions = Relative(author.file, offset);
  MatchDistance distance;
  SAC_RETURN_IF_ERROR(Named(path, [&] { return MatchVertices(decoded, mesh, author.order, distance); }));
  const double diagonal = BoundingBox(decoded.positions).diagonal();
  if (distance.mean > kFar * diagonal) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", distance.mean);
    author.warnings.push_back(path + ": its vertices are " + text +
                              " model units from those of the first frame on the average; where its faces look alike, "
                              "as in symmetric or equal parts, they may be taken for each other");
  }
  if (Extension(path) == ".obj") {
    SAC_RETURN_IF_ERROR(Named(path, [&] { return ReadTemplate(path, author.obj.emplace()); }));
    if (author.obj->vertices() != mesh.positions.size()) {
      return Status::IoError(path + ": changed while it was read");
    }
  }
  return Status::Ok();
}

}  // namespace sac
