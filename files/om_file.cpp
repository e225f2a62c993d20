// SPDX-License-Identifier: Apache-2.0
#include "files/om_file.h"

#include <OpenMesh/Core/IO/reader/OMReader.hh>
#include <locale>
#include <mutex>
#include <sstream>
#include <string>
#include <utility>

#include "files/clean_om.h"
#include "files/openmesh_importer.h"

namespace sac {

namespace io = OpenMesh::IO;

Status ParseOm(std::string_view bytes, PolygonMesh& parsed) {
  parsed = {};
  std::string cleaned;
  SAC_RETURN_IF_ERROR(CleanOm(bytes, cleaned, parsed.losses));
  MeshImporter importer;
  std::istringstream stream(std::move(cleaned), std::ios::in | std::ios::binary);
  stream.imbue(std::locale::classic());
  io::Options options(io::Options::VertexNormal | io::Options::VertexColor | io::Options::VertexTexCoord |
                      io::Options::FaceTexCoord);
  // There is one reader in the process, which keeps what it is reading.
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  io::BaseReader& reader = io::OMReader();
  bool ok = false;
  try {
    // The reader goes on after the end of the stream, as long as the counts in the file tell it.
    stream.exceptions(std::ios::failbit | std::ios::badbit);
    ok = reader.read(stream, importer, options);
  } catch (const std::ios::failure&) {
    return Status::Corrupt("truncated, after " + std::to_string(importer.n_vertices()) + " vertices and " +
                           std::to_string(importer.n_faces()) + " faces");
  }
  return ok ? importer.Finish(parsed) : Status::Corrupt("OpenMesh cannot read it");
}

}  // namespace sac
