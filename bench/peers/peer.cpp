// SPDX-License-Identifier: Apache-2.0
#include "bench/peers/peer.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <exception>
#include <memory>
#include <nlohmann/json.hpp>

#include "files/cache_file.h"
#include "files/clip_input.h"
#include "files/output_file.h"
#include "files/stream_input.h"
#include "files/vertex_order.h"

namespace sac::bench {
namespace {

// The arguments of
//   encode MESH CLIP -o STREAM --order-map MAP --setting SETTING [--report FILE]
//   decode STREAM -o CLIP --order-map MAP [--report FILE]
struct Arguments {
  std::string mesh, clip, stream, map, setting, report;
};

bool ParseArguments(std::vector<std::string> words, Arguments& a) {
  std::string report;
  if (words.size() > 2 && words[words.size() - 2] == "--report") {
    report = words.back();
    words.resize(words.size() - 2);
  }
  if (words.size() == 9 && words[0] == "encode" && words[3] == "-o" && words[5] == "--order-map" &&
      words[7] == "--setting") {
    a = {words[1], words[2], words[4], words[6], words[8], report};
    return true;
  }
  if (words.size() == 6 && words[0] == "decode" && words[2] == "-o" && words[4] == "--order-map") {
    a = {"", words[3], words[1], words[5], "", report};
    return true;
  }
  return false;
}

Status ReadClip(const Arguments& arguments, Clip& clip) {
  std::unique_ptr<ClipInput> input;
  SAC_RETURN_IF_ERROR(ClipInput::Open({arguments.mesh, arguments.clip}, input));
  clip.mesh.triangles = input->mesh().triangles;
  for (bool end = false;;) {
    Positions frame;
    SAC_RETURN_IF_ERROR(input->Next(frame, end));
    if (end) return Status::Ok();
    clip.frames.push_back(std::move(frame));
  }
}

Status WriteBytes(const std::string& path, const void* bytes, std::size_t size) {
  OutputFile file;
  SAC_RETURN_IF_ERROR(file.Open(path));
  SAC_RETURN_IF_ERROR(file.Write(bytes, size));
  return file.Commit();
}

Status Encode(const Arguments& arguments, const Peer& peer) {
  Clip clip;
  SAC_RETURN_IF_ERROR(ReadClip(arguments, clip));
  PeerStream stream;
  SAC_RETURN_IF_ERROR(peer.encode(clip, arguments.setting, stream));
  std::vector<bool> coded(clip.vertices());
  for (const std::uint32_t v : stream.order) coded.at(v) = true;
  if (const auto lost = std::count(coded.begin(), coded.end(), false); lost != 0) {
    return Status::Unsupported(std::to_string(lost) + " vertices would be lost");
  }
  SAC_RETURN_IF_ERROR(WriteBytes(arguments.stream, stream.bytes.data(), stream.bytes.size()));
  return WriteBytes(arguments.map, stream.order.data(), stream.order.size() * sizeof(std::uint32_t));
}

Status Decode(const Arguments& arguments, const Peer& peer) {
  std::vector<std::uint8_t> bytes, map;
  SAC_RETURN_IF_ERROR(ReadToEnd(arguments.stream, bytes));
  Clip clip;
  SAC_RETURN_IF_ERROR(peer.decode(bytes, clip));
  SAC_RETURN_IF_ERROR(ReadToEnd(arguments.map, map));
  std::vector<std::uint32_t> order(map.size() / sizeof(std::uint32_t));
  std::copy(map.begin(), map.end(), reinterpret_cast<std::uint8_t*>(order.data()));
  const std::size_t vertices = order.empty() ? 0 : *std::max_element(order.begin(), order.end()) + std::size_t{1};
  std::unique_ptr<CacheWriter> cache;
  SAC_RETURN_IF_ERROR(CacheWriter::Open(arguments.clip, vertices, 30, std::nullopt, cache));
  Positions positions(vertices);
  for (const Positions& frame : clip.frames) {
    if (frame.size() != order.size()) return Status::Corrupt("another number of vertices was decoded");
    for (std::size_t v = 0; v < order.size(); ++v) positions[order[v]] = frame[v];
    SAC_RETURN_IF_ERROR(cache->Write(positions));
  }
  return cache->Commit();
}

Status Run(const std::vector<std::string>& words, const Peer& peer) {
  if (words == std::vector<std::string>{"describe"}) {
    nlohmann::ordered_json json{
        {"title", peer.title}, {"version", peer.version}, {"parameter", peer.parameter}, {"settings", peer.settings}};
    if (!peer.missing.empty()) json["missing"] = peer.missing;
    std::printf("%s\n", json.dump().c_str());
    return Status::Ok();
  }
  Arguments arguments;
  if (!ParseArguments(words, arguments)) {
    return Status::InvalidArgument(
        "usage: describe | encode MESH CLIP -o STREAM --order-map MAP --setting S | decode STREAM -o CLIP "
        "--order-map MAP; --report FILE after either");
  }
  if (!arguments.report.empty() && !peer.report) return Status::InvalidArgument("--report: there is nothing to report");
  SAC_RETURN_IF_ERROR(arguments.mesh.empty() ? Decode(arguments, peer) : Encode(arguments, peer));
  if (arguments.report.empty()) return Status::Ok();
  const std::string report = peer.report() + "\n";
  return WriteBytes(arguments.report, report.data(), report.size());
}

}  // namespace

int RunPeer(int argc, char** argv, const Peer& peer) {
  Status status;
  try {
    status = Run({argv + 1, argv + argc}, peer);
  } catch (const std::exception& error) {
    status = Status::InvalidArgument(error.what());
  }
  if (status.ok()) return 0;
  std::fprintf(stderr, "%s: %s\n", argv[0], status.message().c_str());
  return 1;
}

bool ParseNumber(const std::string& text, double& value) {
  double number = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), number);
  if (result.ec != std::errc() || result.ptr != text.data() + text.size()) return false;
  value = number;
  return true;
}

}  // namespace sac::bench
