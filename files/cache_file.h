// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "files/output_file.h"
#include "files/warnings.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// Point caches: the vertex positions of all frames in one file, float32 x, y, z, frame after frame.
//   PC2, little endian: "POINTCACHE2\0", int32 version = 1, int32 points, float32 start frame, float32 sample rate,
//   int32 frames. MDD, big endian: int32 frames, int32 points, float32 time of each frame in seconds.
// Every message starts with the path.

// True for the names of caches, .pc2 and .mdd in any case.
bool IsCacheName(const std::string& path);

// Reads any frame of a cache; memory is one frame, whatever their number.
class CacheReader {
 public:
  // Checks the header against the size of the file before anything is allocated: kCorrupt if they disagree, if a count
  // is negative, or if there are no frames or no points; kIoError if the file cannot be read or is no regular file.
  // With `skip_damage`, frames that are whole are read from a file that is too short or too long for its header, or
  // whose header has no frames yet; a warning tells which. It needs one whole frame, and an MDD all its times.
  static Status Open(const std::string& path, std::unique_ptr<CacheReader>& reader, bool skip_damage = false);
  ~CacheReader();
  CacheReader(const CacheReader&) = delete;
  CacheReader& operator=(const CacheReader&) = delete;

  const std::string& path() const { return path_; }
  std::uint32_t frame_count() const { return frame_count_; }
  std::uint32_t point_count() const { return point_count_; }

  // Frames a second, from the first and last time of an MDD; PC2 does not say. Within 1e-4 of an integer it is that.
  std::optional<double> fps() const { return fps_; }

  // What of the header is not kept, as a start frame other than 0, and what was skipped as damaged.
  const Warnings& warnings() const { return warnings_; }

  // Positions of `frame`, in 0..frame_count() - 1. They may be NaN or infinite.
  Status Read(std::uint32_t frame, Positions& positions);

 private:
  CacheReader() = default;
  Status ParseHeader(std::uint64_t file_size, bool skip_damage);
  Status CountFrames(std::uint64_t file_size, bool skip_damage);
  Status ReadTimes();
  Status ReadAt(std::uint64_t offset, char* bytes, std::size_t size) const;
  Status Error(const std::string& what) const { return Status::Corrupt(path_ + ": " + what); }

  std::string path_;
  int fd_ = -1;
  bool big_endian_ = false;
  std::uint32_t frame_count_ = 0, point_count_ = 0;
  std::uint64_t data_offset_ = 0;
  std::optional<double> fps_;
  Warnings warnings_;
  std::vector<char> bytes_;
};

// Writes a cache frame by frame; it appears under its name with Commit, not before.
class CacheWriter {
 public:
  // `frame_count`, where known, is a promise and allows an output that cannot seek; MDD without it is moved within the
  // file at the end, to make room for the times. `fps`, frames a second, makes the times of an MDD.
  static Status Open(const std::string& path, std::size_t point_count, double fps,
                     std::optional<std::uint32_t> frame_count, std::unique_ptr<CacheWriter>& writer);

  // Appends a frame; kInvalidArgument if it has not `point_count` positions.
  Status Write(const Positions& positions);

  // Completes the header and gives the file its name. kInvalidArgument if no frames, or not the promised number, were
  // written. Nothing can be written afterwards.
  Status Commit();

 private:
  Status WriteHeader(std::uint32_t frame_count);
  Status WriteTimes(std::uint32_t frame_count);
  Status MakeRoomForTimes();

  OutputFile file_;
  bool big_endian_ = false;
  std::size_t point_count_ = 0;
  double fps_ = 0;
  std::optional<std::uint32_t> promised_;
  std::uint32_t frame_count_ = 0;
  std::string bytes_;
};

}  // namespace sac
