// SPDX-License-Identifier: Apache-2.0
#include "files/mesh_file.h"

#include <OpenMesh/Core/IO/writer/OFFWriter.hh>
#include <OpenMesh/Core/IO/writer/PLYWriter.hh>
#include <limits>
#include <locale>
#include <sstream>

#include "files/obj_file.h"
#include "files/openmesh_exporter.h"
#include "files/output_file.h"
#include "files/path.h"

namespace sac {
namespace {

namespace io = OpenMesh::IO;

Status ExportBytes(const io::BaseWriter& writer, const Mesh& mesh, io::Options options, std::string& bytes) {
  if (mesh.positions.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    return Status::Limit("more than 2^31 - 1 vertices");
  }
  MeshExporter exporter(mesh);
  if (exporter.has_vertex_normals()) options += io::Options::VertexNormal;
  if (exporter.has_vertex_texcoords()) options += io::Options::VertexTexCoord;
  if (exporter.has_vertex_colors()) options += io::Options::VertexColor | io::Options::ColorAlpha;
  std::ostringstream stream(std::ios::out | std::ios::binary);
  stream.imbue(std::locale::classic());
  const bool ok = writer.write(stream, exporter, options, std::numeric_limits<float>::max_digits10);
  if (!ok || !stream) return Status::IoError("OpenMesh cannot write it");
  bytes = std::move(stream).str();
  return Status::Ok();
}

Status FormatUnnamed(const std::string& path, const Mesh& mesh, std::string& bytes) {
  const std::string extension = Extension(path);
  if (extension == ".obj") {
    bytes = FormatObj(mesh);
    return Status::Ok();
  }
  if (extension == ".ply") return ExportBytes(io::PLYWriter(), mesh, io::Options::Binary, bytes);
  if (extension == ".off") return ExportBytes(io::OFFWriter(), mesh, io::Options::Default, bytes);
  return Status::InvalidArgument("meshes are written as .obj, .ply or .off");
}

}  // namespace

bool IsReadableMeshName(const std::string& path) {
  const std::string extension = Extension(path);
  return IsWritableMeshName(path) || extension == ".stl" || extension == ".om";
}

bool IsWritableMeshName(const std::string& path) {
  const std::string extension = Extension(path);
  return extension == ".obj" || extension == ".ply" || extension == ".off";
}

Status FormatMesh(const std::string& path, const Mesh& mesh, std::string& bytes) {
  return Named(path, [&] { return FormatUnnamed(path, mesh, bytes); });
}

Status WriteMesh(const std::string& path, const Mesh& mesh) {
  std::string bytes;
  SAC_RETURN_IF_ERROR(FormatMesh(path, mesh, bytes));
  OutputFile file;
  SAC_RETURN_IF_ERROR(file.Open(path));
  SAC_RETURN_IF_ERROR(file.Write(bytes));
  return file.Commit();
}

}  // namespace sac
