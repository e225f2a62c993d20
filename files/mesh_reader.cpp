// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "files/mesh_file.h"
#include "files/obj_file.h"
#include "files/off_file.h"
#include "files/om_file.h"
#include "files/path.h"
#include "files/ply_file.h"
#include "files/polygon_mesh.h"
#include "files/stl_file.h"
#include "files/text_scan.h"
#include "files/welding.h"

namespace sac {

Status ReadFileBytes(const std::string& path, std::string& bytes) {
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

namespace {

Status Parse(const std::string& extension, std::string& bytes, PolygonMesh& parsed) {
  if (extension == ".stl") return ParseStl(bytes, parsed);
  if (extension == ".ply") return ParsePly(bytes, parsed);
  if (extension == ".om") return ParseOm(bytes, parsed);
  SAC_RETURN_IF_ERROR(NormalizeText(bytes));
  return extension == ".obj" ? ParseObj(bytes, parsed) : ParseOff(bytes, parsed);
}

void Weld(PolygonMesh& parsed) {
  Welding welding;
  welding.Add(parsed.positions);
  parsed.faces.vertices = welding.vertices();
  parsed.positions = welding.Gather(parsed.positions);
}

Status ReadUnnamed(const std::string& path, const ReadSettings& settings, MeshFile& file) {
  if (!IsReadableMeshName(path)) {
    return Status::InvalidArgument("not a mesh file by its name (.obj, .ply, .off, .stl, .om)");
  }
  std::string bytes;
  SAC_RETURN_IF_ERROR(ReadFileBytes(path, bytes));
  const std::string extension = Extension(path);
  PolygonMesh parsed;
  SAC_RETURN_IF_ERROR(Parse(extension, bytes, parsed));
  bytes = {};
  if (parsed.positions.empty()) return Status::InvalidArgument("no vertices");
  if (extension == ".stl" && settings.weld) Weld(parsed);
  return FinishMesh(parsed, settings, file);
}

}  // namespace

Status ReadMeshFile(const std::string& path, const ReadSettings& settings, MeshFile& file) {
  SAC_RETURN_IF_ERROR(Named(path, [&] { return ReadUnnamed(path, settings, file); }));
  for (std::string& warning : file.warnings) warning = path + ": " + warning;
  return Status::Ok();
}

Status ReadMesh(const std::string& path, Mesh& mesh) {
  MeshFile file;
  SAC_RETURN_IF_ERROR(ReadMeshFile(path, {}, file));
  mesh = std::move(file.mesh);
  return Status::Ok();
}

}  // namespace sac
