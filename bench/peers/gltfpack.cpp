// SPDX-License-Identifier: Apache-2.0
// glTF with a morph target for each frame, by gltfpack with its strongest compression (EXT_meshopt_compression).
// gltfpack is a program of the npm package of that name; `npm ci` in this directory installs the version that
// package.json names. gltfpack reorders vertices without saying how. The order is found by a second run on the first
// frame, whose texture coordinates are the numbers of the vertices.
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "bench/peers/gltf_file.h"
#include "bench/peers/peer.h"
#include "bench/sweep/child_process.h"
#include "files/temporary_directory.h"

namespace sac::bench {
namespace {

namespace fs = std::filesystem;

// Looks for gltfpack in the directory where npm installs it, then in PATH.
std::string FindGltfpack() {
  std::istringstream path(std::string(SAC_GLTFPACK_DIRECTORY ":") + (std::getenv("PATH") ? std::getenv("PATH") : ""));
  for (std::string directory; std::getline(path, directory, ':');) {
    std::error_code error;
    const fs::path program = fs::path(directory) / "gltfpack";
    if (fs::is_regular_file(program, error)) return fs::absolute(program).string();
  }
  return "";
}

Status Run(const Clip& clip, bool ids, const std::vector<std::string>& options, std::vector<std::uint8_t>& bytes) {
  const TemporaryDirectory directory("sac-gltfpack-");
  if (directory.path().empty()) return Status::IoError("no temporary directory");
  const std::string path = directory.Path("clip"), packed = directory.Path("packed.glb");
  SAC_RETURN_IF_ERROR(WriteGltf(clip, ids, path));
  // With -af 0 gltfpack does not resample the animation, so that frames come back at their times.
  std::vector<std::string> command{FindGltfpack(), "-i", path + ".gltf", "-o", packed, "-cc", "-af", "0"};
  command.insert(command.end(), options.begin(), options.end());
  ProcessUsage usage;
  std::string output;
  SAC_RETURN_IF_ERROR(RunProcess(command, usage, output));
  std::ifstream file(packed, std::ios::binary);
  bytes.assign(std::istreambuf_iterator<char>(file), {});
  return bytes.empty() ? Status::IoError("gltfpack wrote nothing") : Status::Ok();
}

// Finds the input's vertices in the order of gltfpack.
Status FindOrder(const Clip& clip, std::vector<std::uint32_t>& order) {
  std::vector<std::uint8_t> bytes;
  SAC_RETURN_IF_ERROR(Run(clip, true, {"-noq", "-kv"}, bytes));
  GlbFile file;
  SAC_RETURN_IF_ERROR(file.Open(bytes));
  std::vector<double> ids;
  SAC_RETURN_IF_ERROR(file.TextureCoordinates(ids));
  for (std::size_t i = 0; i + 1 < ids.size(); i += 2) {
    const double id = ids[i] + 4096 * ids[i + 1];
    if (!(id >= 0 && id < static_cast<double>(clip.vertices()) && id == std::floor(id))) {
      return Status::Unsupported("gltfpack has changed the vertices' numbers");
    }
    order.push_back(static_cast<std::uint32_t>(id));
  }
  return Status::Ok();
}

Status Decode(std::span<const std::uint8_t> bytes, Clip& clip) {
  GlbFile file;
  SAC_RETURN_IF_ERROR(file.Open(bytes));
  SAC_RETURN_IF_ERROR(file.Triangles(clip.mesh.triangles));
  return file.Frames(clip.frames);
}

Status Encode(const Clip& clip, const std::string& setting, PeerStream& stream) {
  SAC_RETURN_IF_ERROR(Run(clip, false, {"-vp", setting}, stream.bytes));
  SAC_RETURN_IF_ERROR(FindOrder(clip, stream.order));
  Clip decoded;
  SAC_RETURN_IF_ERROR(Decode(stream.bytes, decoded));
  // gltfpack merges vertices that are equal in all frames. In the second run they differ by their numbers and stay
  // apart, so that the order cannot be found.
  if (decoded.vertices() != stream.order.size()) return Status::Unsupported("gltfpack has merged vertices");
  return Status::Ok();
}

Peer MakePeer() {
  Peer peer{"glTF morph targets, gltfpack -cc",
            "",
            "bits",
            {"8", "9", "10", "11", "12", "13", "14", "15", "16"},
            Encode,
            Decode,
            ""};
  const std::string program = FindGltfpack();
  if (program.empty()) {
    peer.missing = "gltfpack is not installed (npm ci in bench/peers)";
    return peer;
  }
  ProcessUsage usage;
  if (const Status status = RunProcess({program, "-v"}, usage, peer.version); !status.ok()) {
    peer.missing = status.message();
  }
  while (!peer.version.empty() && peer.version.back() == '\n') peer.version.pop_back();
  return peer;
}

}  // namespace
}  // namespace sac::bench

int main(int argc, char** argv) { return sac::bench::RunPeer(argc, argv, sac::bench::MakePeer()); }
