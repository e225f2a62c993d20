// SPDX-License-Identifier: Apache-2.0
#include "files/mesh_file.h"

#include <OpenMesh/Core/IO/reader/OFFReader.hh>
#include <OpenMesh/Core/IO/reader/OMReader.hh>
#include <OpenMesh/Core/IO/reader/PLYReader.hh>
#include <OpenMesh/Core/IO/writer/OFFWriter.hh>
#include <OpenMesh/Core/IO/writer/PLYWriter.hh>
#include <OpenMesh/Core/System/omstream.hh>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <iostream>
#include <limits>
#include <locale>
#include <sstream>

#include "files/moved_positions.h"
#include "files/obj_file.h"
#include "files/openmesh_exporter.h"
#include "files/openmesh_importer.h"
#include "files/openmesh_input.h"
#include "files/output_file.h"
#include "files/stl_file.h"

namespace sac {
namespace {

namespace io = OpenMesh::IO;

std::string Extension(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return extension;
}

// While it lives OpenMesh prints nothing: neither through its own streams nor to std::cerr, which it uses too. We tell
// what is wrong through Status.
class Silence {
 public:
  Silence() : cerr_buffer_(std::cerr.rdbuf(nullptr)) {
    omlog().disable();
    omout().disable();
    omerr().disable();
  }
  ~Silence() {
    std::cerr.rdbuf(cerr_buffer_);
    std::cerr.clear();
  }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  std::streambuf* cerr_buffer_;
};

Status ReadBytes(const std::string& path, std::string& bytes) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) return Status::IoError("is a directory");
  std::FILE* file = std::fopen(path.c_str(), "rb");
  if (file == nullptr) return Status::IoError(std::strerror(errno));
  char block[1 << 16];
  for (std::size_t got = 0; (got = std::fread(block, 1, sizeof block, file)) > 0;) bytes.append(block, got);
  const int read_error = std::ferror(file) != 0 ? errno : 0;
  std::fclose(file);
  if (read_error != 0) return Status::IoError(std::strerror(read_error));
  return bytes.empty() ? Status::InvalidArgument("the file is empty") : Status::Ok();
}

// Feeds `bytes` to a reader. The readers go on after the end of the stream, as long as the counts in the file tell
// them, so the stream throws.
Status ImportBytes(io::BaseReader& reader, std::string bytes, io::Options options, Mesh& mesh) {
  MeshImporter importer;
  std::istringstream stream(std::move(bytes), std::ios::in | std::ios::binary);
  stream.imbue(std::locale::classic());
  bool ok = false;
  try {
    const Silence silence;
    stream.exceptions(std::ios::failbit | std::ios::badbit);
    ok = reader.read(stream, importer, options);
  } catch (const std::ios::failure&) {
    return Status::Corrupt("truncated or not a number, after " + std::to_string(importer.n_vertices()) +
                           " vertices and " + std::to_string(importer.n_faces()) + " faces");
  }
  return ok ? importer.Finish(mesh) : Status::Corrupt("OpenMesh cannot read it");
}

io::Options AllAttributes() {
  return io::Options(io::Options::VertexNormal | io::Options::VertexColor | io::Options::VertexTexCoord |
                     io::Options::FaceTexCoord);
}

Status ReadPly(std::string_view bytes, Mesh& mesh) {
  std::string cleaned;
  bool has_lists = false;
  SAC_RETURN_IF_ERROR(CleanPly(bytes, cleaned, has_lists));
  io::Options options = AllAttributes();
  if (has_lists) options += io::Options::Custom;
  return ImportBytes(io::PLYReader(), std::move(cleaned), options, mesh);
}

Status ReadOff(const std::string& path, std::string_view bytes, Mesh& mesh) {
  std::string cleaned;
  SAC_RETURN_IF_ERROR(CleanOff(bytes, cleaned));
  // What the first line announces is only noticed here.
  const Silence silence;
  if (!io::OFFReader().can_u_read(path)) return Status::Unsupported("not an OFF file of three dimensions");
  return ImportBytes(io::OFFReader(), std::move(cleaned), AllAttributes(), mesh);
}

Status ReadOm(std::string_view bytes, Mesh& mesh) {
  std::string cleaned;
  SAC_RETURN_IF_ERROR(CleanOm(bytes, cleaned));
  return ImportBytes(io::OMReader(), std::move(cleaned), AllAttributes(), mesh);
}

Status ReadUnnamed(const std::string& path, Mesh& mesh) {
  const std::string extension = Extension(path);
  if (!IsReadableMeshName(path)) {
    return Status::InvalidArgument("not a mesh file by its name (.obj, .ply, .off, .stl, .om)");
  }
  std::string bytes;
  SAC_RETURN_IF_ERROR(ReadBytes(path, bytes));
  mesh = {};
  Status status;
  if (extension == ".obj") status = ParseObj(bytes, mesh);
  if (extension == ".stl") status = ParseStl(bytes, mesh);
  if (extension == ".ply") status = ReadPly(bytes, mesh);
  if (extension == ".off") status = ReadOff(path, bytes, mesh);
  if (extension == ".om") status = ReadOm(bytes, mesh);
  if (status.ok() && mesh.positions.empty()) return Status::InvalidArgument("no vertices");
  return status;
}

Status ExportBytes(const io::BaseWriter& writer, const Mesh& mesh, io::Options options, std::string& bytes,
                   Warnings& warnings) {
  if (mesh.positions.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    return Status::Limit("more than 2^31 - 1 vertices");
  }
  MeshExporter exporter(mesh);
  if (!mesh.normals.empty() && !exporter.has_vertex_normals()) {
    warnings.push_back("corners of a vertex have normals of their own, which the format cannot hold; written without");
  }
  if (exporter.has_vertex_normals()) options += io::Options::VertexNormal;
  if (exporter.has_vertex_texcoords()) options += io::Options::VertexTexCoord;
  if (exporter.has_vertex_colors()) options += io::Options::VertexColor | io::Options::ColorAlpha;
  std::ostringstream stream(std::ios::out | std::ios::binary);
  stream.imbue(std::locale::classic());
  const Silence silence;
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

// Runs `step`, whose messages do not name the file, and lets no exception out.
template <typename Step>
Status Named(const std::string& path, Step step) {
  Status status;
  try {
    status = step();
  } catch (const std::bad_alloc&) {
    status = Status::Limit("not enough memory");
  } catch (const std::exception& e) {
    status = Status::Corrupt(e.what());
  }
  return status.ok() ? status : Status(status.code(), path + ": " + status.message());
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

Status ReadMesh(const std::string& path, Mesh& mesh) {
  return Named(path, [&] { return ReadUnnamed(path, mesh); });
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
