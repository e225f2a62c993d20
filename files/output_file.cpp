// SPDX-License-Identifier: Apache-2.0
#include "files/output_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include "files/temporary_files.h"

namespace sac {
namespace {

constexpr std::size_t kBufferBytes = 1 << 16;

// A short name of its own, because the final name plus a suffix could be longer than the file system allows.
std::string TemporaryName(const std::string& path) {
  static std::atomic<unsigned> counter{0};
  const std::string name = ".sac-" + std::to_string(getpid()) + "-" + std::to_string(counter++) + ".tmp";
  return (std::filesystem::path(path).parent_path() / name).string();
}

}  // namespace

OutputFile::~OutputFile() { Remove(); }

OutputFile::OutputFile(OutputFile&& other) noexcept { *this = std::move(other); }

OutputFile& OutputFile::operator=(OutputFile&& other) noexcept {
  if (this == &other) return *this;
  Remove();
  path_ = std::move(other.path_);
  final_ = std::move(other.final_);
  temporary_ = std::exchange(other.temporary_, {});
  buffer_ = std::exchange(other.buffer_, {});
  fd_ = std::exchange(other.fd_, -1);
  return *this;
}

void OutputFile::Remove() {
  if (fd_ >= 0 && fd_ != STDOUT_FILENO) close(fd_);
  if (!temporary_.empty()) RemoveTemporaryFile(temporary_);
  fd_ = -1;
  temporary_.clear();
}

Status OutputFile::Error(int error) const {
  const std::string name = path_ == "-" ? "standard output" : path_;
  return Status::IoError(name + ": " + std::strerror(error));
}

Status OutputFile::Open(const std::string& path) {
  path_ = path;
  final_ = path;
  if (path == "-") {
    fd_ = STDOUT_FILENO;
    return Status::Ok();
  }
  struct stat existing {};
  mode_t mode = 0;
  if (stat(path.c_str(), &existing) == 0) {
    if (S_ISDIR(existing.st_mode)) return Error(EISDIR);
    if (!S_ISREG(existing.st_mode)) {
      fd_ = open(path.c_str(), O_WRONLY | O_CLOEXEC);
      return fd_ < 0 ? Error(errno) : Status::Ok();
    }
    // A rename would replace a file that its owner has made read-only.
    if (access(path.c_str(), W_OK) != 0) return Error(errno);
    mode = existing.st_mode & 07777;
    std::error_code error;
    if (const auto resolved = std::filesystem::canonical(path, error); !error) final_ = resolved.string();
  }
  do {
    temporary_ = TemporaryName(final_);
    fd_ = CreateTemporaryFile(temporary_, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  } while (fd_ < 0 && errno == EEXIST);
  if (fd_ < 0) {
    const int error = errno;
    temporary_.clear();
    return Error(error);
  }
  if (mode != 0 && fchmod(fd_, mode) != 0) return Error(errno);
  return Status::Ok();
}

Status OutputFile::Write(const void* data, std::size_t size) {
  if (fd_ < 0) return Error(EBADF);
  if (seekable() && buffer_.size() + size < kBufferBytes) {
    buffer_.append(static_cast<const char*>(data), size);
    return Status::Ok();
  }
  SAC_RETURN_IF_ERROR(Flush());
  return WriteThrough(static_cast<const char*>(data), size);
}

Status OutputFile::Flush() {
  SAC_RETURN_IF_ERROR(WriteThrough(buffer_.data(), buffer_.size()));
  buffer_.clear();
  return Status::Ok();
}

Status OutputFile::WriteThrough(const char* bytes, std::size_t size) {
  while (size > 0) {
    const ssize_t written = write(fd_, bytes, size);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return Error(errno);
    bytes += written;
    size -= static_cast<std::size_t>(written);
  }
  return Status::Ok();
}

Status OutputFile::WriteAt(std::uint64_t offset, const void* data, std::size_t size) {
  if (fd_ < 0 || !seekable()) return Error(ESPIPE);
  SAC_RETURN_IF_ERROR(Flush());
  const char* bytes = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = pwrite(fd_, bytes, size, static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return Error(errno);
    bytes += written;
    offset += static_cast<std::uint64_t>(written);
    size -= static_cast<std::size_t>(written);
  }
  return Status::Ok();
}

Status OutputFile::ReadAt(std::uint64_t offset, void* data, std::size_t size) {
  if (fd_ < 0 || !seekable()) return Error(ESPIPE);
  SAC_RETURN_IF_ERROR(Flush());
  char* bytes = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t got = pread(fd_, bytes, size, static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return Error(got < 0 ? errno : EIO);
    bytes += got;
    offset += static_cast<std::uint64_t>(got);
    size -= static_cast<std::size_t>(got);
  }
  return Status::Ok();
}

Status OutputFile::Close() {
  if (fd_ < 0) return Status::Ok();
  SAC_RETURN_IF_ERROR(Flush());
  buffer_ = {};  // a sequence keeps many closed files
  if (fd_ == STDOUT_FILENO) {
    fd_ = -1;  // ours to write to, not to close
    return Status::Ok();
  }
  if (seekable() && fsync(fd_) != 0) return Error(errno);
  return close(std::exchange(fd_, -1)) != 0 ? Error(errno) : Status::Ok();
}

Status OutputFile::Commit() {
  SAC_RETURN_IF_ERROR(Close());
  if (temporary_.empty()) return Status::Ok();
  if (RenameTemporaryFile(temporary_, final_) != 0) return Error(errno);
  temporary_.clear();
  return Status::Ok();
}

}  // namespace sac
