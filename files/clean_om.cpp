// SPDX-License-Identifier: Apache-2.0
#include "files/clean_om.h"

#include <OpenMesh/Core/IO/OMFormat.hh>
#include <cstdint>
#include <string>

#include "files/byte_order.h"

namespace sac {
namespace {

namespace om = OpenMesh::IO::OMFormat;
using om::Chunk;

constexpr std::size_t kHeaderBytes = 16;

struct Reader {
  std::string_view rest;
  bool failed = false;

  std::string_view Take(std::uint64_t size) {
    failed |= size > rest.size();
    if (failed) return {};
    const std::string_view taken = rest.substr(0, size);
    rest.remove_prefix(size);
    return taken;
  }
  std::uint32_t Take8() {
    const std::string_view b = Take(1);
    return failed ? 0 : static_cast<unsigned char>(b[0]);
  }
  std::uint32_t Take16() {
    const std::string_view b = Take(2);
    return failed ? 0 : static_cast<unsigned char>(b[0]) | static_cast<unsigned char>(b[1]) << 8;
  }
  std::uint32_t Take32() {
    const std::string_view b = Take(4);
    return failed ? 0 : LoadLittle32(b.data());
  }
};

struct Header {
  char mesh = 0;
  unsigned version = 0;
  std::uint64_t vertices = 0, faces = 0, edges = 0;
};

struct ChunkHeader {
  explicit ChunkHeader(std::uint32_t bits) {
    om::Chunk::Header header;
    header << static_cast<om::uint16>(bits);
    named = header.name_ != 0;
    entity = header.entity_;
    type = header.type_;
    dimensions = header.dim_ + 1;
    bits_code = header.bits_;
  }
  bool named;
  unsigned entity, type, dimensions, bits_code;
};

// Before version 2 a face was its vertices: 3, 4, or a count of 16 bits and so many.
std::uint64_t OldFaceBytes(const Header& header, Reader reader, std::uint64_t index_bytes) {
  if (header.mesh == 'T') return header.faces * 3 * index_bytes;
  if (header.mesh == 'Q') return header.faces * 4 * index_bytes;
  const std::size_t before = reader.rest.size();
  for (std::uint64_t j = 0; j < header.faces && !reader.failed; ++j) reader.Take(reader.Take16() * index_bytes);
  return before - reader.rest.size();
}

// The size in bytes of the data of a chunk that is not a custom one; false for a chunk that the format does not have.
bool DataBytes(const Header& header, const ChunkHeader& chunk, const Reader& reader, std::uint64_t& bytes) {
  std::uint64_t count = 0;
  switch (chunk.entity) {
    case Chunk::Entity_Vertex:
      count = header.vertices;
      break;
    case Chunk::Entity_Face:
      count = header.faces;
      break;
    case Chunk::Entity_Edge:
      count = header.edges;
      break;
    case Chunk::Entity_Halfedge:
      count = 2 * header.edges;
      break;
    default:
      return false;
  }
  const std::uint64_t index_bytes = std::uint64_t{1} << chunk.bits_code;
  switch (chunk.type) {
    case Chunk::Type_Pos:
    case Chunk::Type_Normal:
      bytes = count * 3 * (chunk.bits_code == Chunk::Float_64 ? 8 : 4);
      return chunk.dimensions == 3 && chunk.bits_code <= Chunk::Float_64;
    case Chunk::Type_Texcoord:
      bytes = count * 2 * 4;
      return chunk.dimensions == 2 && chunk.bits_code == Chunk::Float_32;
    case Chunk::Type_Color:
      bytes = count * 3;
      return chunk.dimensions == 3 && chunk.bits_code == Chunk::Integer_8;
    case Chunk::Type_Status:
      bytes = count * 4;
      return chunk.dimensions == 1;
    case Chunk::Type_Topology:
      if (chunk.entity == Chunk::Entity_Face && header.version < om::mk_version(2, 0)) {
        bytes = OldFaceBytes(header, reader, index_bytes);
      } else {
        bytes = count * index_bytes * (chunk.entity == Chunk::Entity_Halfedge ? 3 : 1);
      }
      return chunk.entity != Chunk::Entity_Edge;
    default:
      return false;
  }
}

bool IsWanted(const ChunkHeader& chunk) {
  const bool geometry = chunk.type == Chunk::Type_Pos || chunk.type == Chunk::Type_Normal ||
                        chunk.type == Chunk::Type_Texcoord || chunk.type == Chunk::Type_Color;
  if (chunk.entity == Chunk::Entity_Vertex) return geometry;
  if (chunk.entity == Chunk::Entity_Halfedge) {
    return chunk.type == Chunk::Type_Topology || chunk.type == Chunk::Type_Texcoord;
  }
  return chunk.entity == Chunk::Entity_Face && chunk.type == Chunk::Type_Topology;
}

// Tells what of a chunk that is not kept was worth keeping; the status of elements is not.
void TellUnwanted(const ChunkHeader& chunk, Losses& losses) {
  constexpr const char* kEntities[] = {"vertices", "the mesh", "faces", "", "edges", "", "halfedges", ""};
  const std::string of = std::string(" of ") + kEntities[chunk.entity & 7];
  if (chunk.type == Chunk::Type_Custom) {
    losses.Count("custom properties" + of);
  } else if (chunk.named) {
    losses.Count("named properties" + of);
  } else if (chunk.type == Chunk::Type_Normal || chunk.type == Chunk::Type_Color ||
             chunk.type == Chunk::Type_Texcoord) {
    losses.Count((chunk.type == Chunk::Type_Normal  ? "normals"
                  : chunk.type == Chunk::Type_Color ? "colors"
                                                    : "texture coordinates") +
                 of);
  }
}

void SkipCustom(const Header& header, Reader& reader) {
  if (header.version > om::mk_version(2, 1)) reader.Take(reader.Take8());  // the name of its type
  reader.Take(reader.Take32());
}

}  // namespace

Status CleanOm(std::string_view bytes, std::string& cleaned, Losses& losses) {
  Reader reader{bytes};
  const std::string_view start = reader.Take(4);
  Header header;
  header.vertices = reader.Take32();
  header.faces = reader.Take32();
  header.edges = reader.Take32();
  if (reader.failed || start.substr(0, 2) != "OM") return Status::Corrupt("not an OM file");
  header.mesh = start[2];
  header.version = static_cast<unsigned char>(start[3]);
  if (header.mesh != 'T' && header.mesh != 'Q' && header.mesh != 'P') return Status::Corrupt("not an OM file");
  if (header.version > om::mk_version(2, 2)) return Status::Unsupported("a newer version of OM");

  cleaned = bytes.substr(0, kHeaderBytes);
  while (!reader.rest.empty()) {
    const char* begin = reader.rest.data();
    const ChunkHeader chunk(reader.Take16());
    if (chunk.entity == Chunk::Entity_Sentinel) break;
    if (chunk.named) reader.Take(reader.Take8());
    if (chunk.type == Chunk::Type_Custom) {
      SkipCustom(header, reader);
    } else {
      std::uint64_t size = 0;
      if (!DataBytes(header, chunk, reader, size)) return Status::Corrupt("a chunk of an unknown type");
      reader.Take(size);
    }
    if (reader.failed) return Status::Corrupt("truncated");
    if (!IsWanted(chunk) || chunk.named) {
      TellUnwanted(chunk, losses);
      continue;
    }
    cleaned.append(begin, static_cast<std::size_t>(reader.rest.data() - begin));
    if (chunk.type == Chunk::Type_Pos && chunk.bits_code == Chunk::Float_64) losses.Count("digits of double positions");
  }
  // The sentinel, so that the reader does not look for an end of file.
  char sentinel[2] = {static_cast<char>(Chunk::Entity_Sentinel << Chunk::OFF_ENTITY), 0};
  cleaned.append(sentinel, sizeof sentinel);
  return Status::Ok();
}

}  // namespace sac
