// SPDX-License-Identifier: Apache-2.0
#include "files/mesh_file.h"

#include <OpenMesh/Core/IO/writer/OFFWriter.hh>
#include <OpenMesh/Core/IO/writer/PLYWriter.hh>
#include <limits>
#include <locale>
#include <sstream>

#include "files/moved_positions.h"
#include "files/obj_file.h"
#include "files/openmesh_exporter.h"
#include "files/output_file.h"
#include "files/path.h"

namespace sac {
namespace {

namespace io = OpenMesh::IO;

Status ExportBytes(const io::BaseWriter& writer, const Mesh& mesh, io::Options options, std::string& bytes,
                   Warnings& warnings) {
  if (mesh.positions.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    return Status::Limit("more than 2^31 - 1 vertices");
  }
  MeshExporter exporter(mesh);
  if (!mesh.normals.empty() && !exporter.has_vertex_normals()) {
    warnings.push_back(
        "corners of a vertex have normals of their own, which the format cannot hold; written without. OBJ holds them");
  }
  if (!mesh.uvs.empty() && !exporter.has_vertex_texcoords()) {
    warnings.push_back("texture coordinates have seams, which the format cannot hold; written without. OBJ holds them");
  }
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

Status FormatUnnamed(const std::string& path, const Mesh& mesh, const std::array<double, 3>& offset, std::string& bytes,
                     Warnings& warnings) {
  const std::string extension = Extension(path);
  const bool moves = offset != std::array<double, 3>{};
  if (extension == ".obj") {
    bytes = FormatObj(mesh, offset);
    return Status::Ok();
  }
  if (extension == ".ply") {
    SAC_RETURN_IF_ERROR(ExportBytes(io::PLYWriter(), mesh, io::Options::Binary, bytes, warnings));
    if (moves) bytes = MovePly(bytes, mesh.positions, offset);
    return Status::Ok();
  }
  if (extension == ".off") {
    SAC_RETURN_IF_ERROR(ExportBytes(io::OFFWriter(), mesh, io::Options::Default, bytes, warnings));
    if (moves) bytes = MoveOff(bytes, mesh.positions, offset);
    return Status::Ok();
  }
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

Status FormatMesh(const std::string& path, const Mesh& mesh, const std::array<double, 3>& offset, std::string& bytes,
                  Warnings& warnings) {
  Warnings unnamed;
  SAC_RETURN_IF_ERROR(Named(path, [&] { return FormatUnnamed(path, mesh, offset, bytes, unnamed); }));
  for (const std::string& warning : unnamed) warnings.push_back(path + ": " + warning);
  return Status::Ok();
}

Status WriteMesh(const std::string& path, const Mesh& mesh) {
  std::string bytes;
  Warnings warnings;
  SAC_RETURN_IF_ERROR(FormatMesh(path, mesh, {}, bytes, warnings));
  OutputFile file;
  SAC_RETURN_IF_ERROR(file.Open(path));
  SAC_RETURN_IF_ERROR(file.Write(bytes));
  return file.Commit();
}

}  // namespace sac
