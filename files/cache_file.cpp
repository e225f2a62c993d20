// SPDX-License-Identifier: Apache-2.0
#include "files/cache_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <new>

#include "files/byte_order.h"

namespace sac {
namespace {

constexpr char kPc2Signature[12] = "POINTCACHE2";
constexpr std::uint64_t kPc2HeaderBytes = 32, kPc2FramesOffset = 28;
constexpr std::uint64_t kMddHeaderBytes = 8;
constexpr std::uint64_t kPointBytes = 12;
constexpr std::uint32_t kCountLimit = std::numeric_limits<std::int32_t>::max();

bool HasExtension(const std::string& path, const char* wanted) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return extension == wanted;
}

std::string Text(double value) {
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, value, std::chars_format::general, 6).ptr};
}

}  // namespace

bool IsCacheName(const std::string& path) { return HasExtension(path, ".pc2") || HasExtension(path, ".mdd"); }

CacheReader::~CacheReader() {
  if (fd_ >= 0) close(fd_);
}

Status CacheReader::Open(const std::string& path, std::unique_ptr<CacheReader>& reader, bool skip_damage) {
  if (!IsCacheName(path)) return Status::InvalidArgument(path + ": not a cache by its name (.pc2, .mdd)");
  std::unique_ptr<CacheReader> opened(new CacheReader);
  opened->path_ = path;
  opened->big_endian_ = HasExtension(path, ".mdd");
  // Not to wait for a writer if it is a pipe, which is then refused.
  opened->fd_ = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (opened->fd_ < 0) return Status::IoError(path + ": " + std::strerror(errno));
  struct stat info {};
  if (fstat(opened->fd_, &info) != 0) return Status::IoError(path + ": " + std::strerror(errno));
  if (S_ISDIR(info.st_mode)) return Status::IoError(path + ": is a directory");
  if (!S_ISREG(info.st_mode)) return Status::IoError(path + ": not a regular file");
  SAC_RETURN_IF_ERROR(opened->ParseHeader(static_cast<std::uint64_t>(info.st_size), skip_damage));
  reader = std::move(opened);
  return Status::Ok();
}

Status CacheReader::ParseHeader(std::uint64_t file_size, bool skip_damage) {
  if (file_size == 0) return Error("the file is empty");
  const std::uint64_t header_bytes = big_endian_ ? kMddHeaderBytes : kPc2HeaderBytes;
  if (file_size < header_bytes) return Error("truncated in the header");
  char header[kPc2HeaderBytes];
  SAC_RETURN_IF_ERROR(ReadAt(0, header, header_bytes));
  if (!big_endian_) {
    if (std::memcmp(header, kPc2Signature, sizeof kPc2Signature) != 0) return Error("not a PC2 file");
    if (const std::uint32_t version = LoadLittle32(header + 12); version != 1) {
      return Status::Unsupported(path_ + ": PC2 version " + std::to_string(version));
    }
    const float start = LoadLittleFloat(header + 20), rate = LoadLittleFloat(header + 24);
    if (start != 0) warnings_.push_back(path_ + ": its start frame " + Text(start) + " is not kept; frames begin at 0");
    if (rate != 1) warnings_.push_back(path_ + ": its sample rate " + Text(rate) + " is not kept; it becomes 1");
  }
  frame_count_ = big_endian_ ? LoadBig32(header) : LoadLittle32(header + kPc2FramesOffset);
  point_count_ = big_endian_ ? LoadBig32(header + 4) : LoadLittle32(header + 16);
  if (frame_count_ > kCountLimit || point_count_ > kCountLimit) {
    return Error("header says " + std::to_string(static_cast<std::int32_t>(frame_count_)) + " frames of " +
                 std::to_string(static_cast<std::int32_t>(point_count_)) + " points");
  }
  if (frame_count_ == 0 && !(skip_damage && !big_endian_)) return Error("no frames");
  if (point_count_ == 0) return Error("no points");
  data_offset_ = header_bytes + (big_endian_ ? 4 * std::uint64_t{frame_count_} : 0);
  SAC_RETURN_IF_ERROR(CountFrames(file_size, skip_damage));
  return big_endian_ ? ReadTimes() : Status::Ok();
}

// Holds the number of frames in the header against the size of the file.
Status CacheReader::CountFrames(std::uint64_t file_size, bool skip_damage) {
  const std::uint64_t frame_bytes = kPointBytes * point_count_;
  const std::uint64_t data = file_size < data_offset_ ? 0 : file_size - data_offset_;
  const std::uint64_t whole = data / frame_bytes, rest = data % frame_bytes;
  if (whole == frame_count_ && rest == 0) return Status::Ok();
  const std::string what = "header says " + std::to_string(frame_count_) + " frames of " +
                           std::to_string(point_count_) + " points, but the file has " + std::to_string(whole) +
                           " whole frames and " + std::to_string(rest) + " bytes";
  if (!skip_damage || whole == 0) return Error(what);
  const std::uint64_t most = frame_count_ == 0 ? kCountLimit : frame_count_;
  const auto kept = static_cast<std::uint32_t>(std::min(whole, most));
  warnings_.push_back(path_ + ": " + what + "; the first " + std::to_string(kept) + " frames are read");
  frame_count_ = kept;
  return Status::Ok();
}

// The rate of the frames from the times of an MDD.
Status CacheReader::ReadTimes() {
  std::vector<char> bytes(std::size_t{4} * frame_count_);
  SAC_RETURN_IF_ERROR(ReadAt(kMddHeaderBytes, bytes.data(), bytes.size()));
  const auto time = [&bytes](std::size_t f) { return static_cast<double>(LoadBigFloat(bytes.data() + 4 * f)); };
  if (time(0) != 0) {
    warnings_.push_back(path_ + ": its first time " + Text(time(0)) + " s is not kept; frames begin at 0 s");
  }
  if (frame_count_ < 2) return Status::Ok();
  const double step = (time(frame_count_ - 1) - time(0)) / (frame_count_ - 1);
  const double rate = 1 / step;
  if (std::isfinite(rate) && rate > 0) fps_ = std::abs(rate - std::round(rate)) < 1e-4 ? std::round(rate) : rate;
  // Times are float32: they are even as far as their digits and a hundredth of a frame tell.
  const double tolerance = 0.01 * std::abs(step) + std::abs(time(frame_count_ - 1)) * 0x1p-22;
  for (std::uint32_t f = 1; f < frame_count_; ++f) {
    if (std::abs(time(f) - time(f - 1) - step) <= tolerance && step > 0) continue;
    warnings_.push_back(path_ + ": its times are uneven: frame " + std::to_string(f) + " comes " +
                        Text(time(f) - time(f - 1)) + " s after the one before, the mean is " + Text(step) +
                        " s; frames become even");
    break;
  }
  return Status::Ok();
}

Status CacheReader::ReadAt(std::uint64_t offset, char* bytes, std::size_t size) const {
  while (size > 0) {
    const ssize_t got = pread(fd_, bytes, size, static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return Status::IoError(path_ + ": " + std::strerror(errno));
    if (got == 0) return Status::IoError(path_ + ": became shorter while it was read");
    bytes += got;
    offset += static_cast<std::uint64_t>(got);
    size -= static_cast<std::size_t>(got);
  }
  return Status::Ok();
}

Status CacheReader::Read(std::uint32_t frame, Positions& positions) {
  if (frame >= frame_count_) return Status::InvalidArgument(path_ + ": no frame " + std::to_string(frame));
  const std::size_t frame_bytes = kPointBytes * point_count_;
  try {
    bytes_.resize(frame_bytes);
    positions.resize(point_count_);
  } catch (const std::bad_alloc&) {
    return Status::Limit(path_ + ": not enough memory for a frame");
  }
  SAC_RETURN_IF_ERROR(ReadAt(data_offset_ + std::uint64_t{frame} * frame_bytes, bytes_.data(), frame_bytes));
  const char* in = bytes_.data();
  for (Vec3f& position : positions) {
    for (float& x : position) {
      x = big_endian_ ? LoadBigFloat(in) : LoadLittleFloat(in);
      in += 4;
    }
  }
  return Status::Ok();
}

Status CacheWriter::Open(const std::string& path, std::size_t point_count, double fps,
                         std::optional<std::uint32_t> frame_count, std::unique_ptr<CacheWriter>& writer) {
  if (!IsCacheName(path)) return Status::InvalidArgument(path + ": not a cache by its name (.pc2, .mdd)");
  if (point_count == 0 || point_count > kCountLimit || frame_count.value_or(1) == 0 ||
      frame_count.value_or(1) > kCountLimit) {
    return Status::InvalidArgument(path + ": a cache has 1 to 2^31 - 1 points and frames");
  }
  if (!(std::isfinite(fps) && fps > 0)) return Status::InvalidArgument(path + ": frames a second must be positive");
  auto opened = std::make_unique<CacheWriter>();
  opened->big_endian_ = HasExtension(path, ".mdd");
  opened->point_count_ = point_count;
  opened->fps_ = fps;
  opened->promised_ = frame_count;
  SAC_RETURN_IF_ERROR(opened->file_.Open(path));
  if (!frame_count && !opened->file_.seekable()) {
    return Status::InvalidArgument(path + ": needs the number of frames beforehand, because it cannot seek");
  }
  SAC_RETURN_IF_ERROR(opened->WriteHeader(frame_count.value_or(0)));
  writer = std::move(opened);
  return Status::Ok();
}

Status CacheWriter::WriteHeader(std::uint32_t frame_count) {
  char header[kPc2HeaderBytes] = {};
  if (big_endian_) {
    StoreBig32(frame_count, header);
    StoreBig32(static_cast<std::uint32_t>(point_count_), header + 4);
    SAC_RETURN_IF_ERROR(file_.Write(header, kMddHeaderBytes));
    return WriteTimes(frame_count);
  }
  std::memcpy(header, kPc2Signature, sizeof kPc2Signature);
  StoreLittle32(1, header + 12);
  StoreLittle32(static_cast<std::uint32_t>(point_count_), header + 16);
  StoreLittleFloat(0, header + 20);
  StoreLittleFloat(1, header + 24);
  StoreLittle32(frame_count, header + kPc2FramesOffset);
  return file_.Write(header, kPc2HeaderBytes);
}

Status CacheWriter::WriteTimes(std::uint32_t frame_count) {
  char time[4];
  for (std::uint32_t f = 0; f < frame_count; ++f) {
    StoreBigFloat(static_cast<float>(f / fps_), time);
    // In place of the frames that have been moved, or at the end of a file that has none yet.
    SAC_RETURN_IF_ERROR(promised_ ? file_.Write(time, 4)
                                  : file_.WriteAt(kMddHeaderBytes + 4 * std::uint64_t{f}, time, 4));
  }
  return Status::Ok();
}

Status CacheWriter::Write(const Positions& positions) {
  if (positions.size() != point_count_) {
    return Status::InvalidArgument(file_.path() + ": frame " + std::to_string(frame_count_) + " has " +
                                   std::to_string(positions.size()) + " points and not " +
                                   std::to_string(point_count_));
  }
  if (frame_count_ == promised_.value_or(kCountLimit)) {
    return Status::InvalidArgument(file_.path() + ": more than " + std::to_string(frame_count_) + " frames");
  }
  bytes_.resize(kPointBytes * point_count_);
  char* out = bytes_.data();
  for (const Vec3f& position : positions) {
    for (const float x : position) {
      big_endian_ ? StoreBigFloat(x, out) : StoreLittleFloat(x, out);
      out += 4;
    }
  }
  ++frame_count_;
  return file_.Write(bytes_);
}

// Moves the frames, the last ones first, by the 4 bytes a frame that the times take.
Status CacheWriter::MakeRoomForTimes() {
  constexpr std::size_t kBlockBytes = 1 << 20;
  const std::uint64_t shift = 4 * std::uint64_t{frame_count_};
  std::string block;
  for (std::uint64_t left = kPointBytes * point_count_ * frame_count_; left > 0; left -= block.size()) {
    block.resize(static_cast<std::size_t>(std::min<std::uint64_t>(left, kBlockBytes)));
    const std::uint64_t offset = kMddHeaderBytes + left - block.size();
    SAC_RETURN_IF_ERROR(file_.ReadAt(offset, block.data(), block.size()));
    SAC_RETURN_IF_ERROR(file_.WriteAt(offset + shift, block.data(), block.size()));
  }
  return Status::Ok();
}

Status CacheWriter::Commit() {
  if (frame_count_ == 0) return Status::InvalidArgument(file_.path() + ": no frames");
  if (promised_ && *promised_ != frame_count_) {
    return Status::InvalidArgument(file_.path() + ": " + std::to_string(frame_count_) + " frames and not " +
                                   std::to_string(*promised_));
  }
  if (!promised_) {
    char count[4];
    big_endian_ ? StoreBig32(frame_count_, count) : StoreLittle32(frame_count_, count);
    if (big_endian_) {
      SAC_RETURN_IF_ERROR(MakeRoomForTimes());
      SAC_RETURN_IF_ERROR(WriteTimes(frame_count_));
    }
    SAC_RETURN_IF_ERROR(file_.WriteAt(big_endian_ ? 0 : kPc2FramesOffset, count, sizeof count));
  }
  return file_.Commit();
}

}  // namespace sac
