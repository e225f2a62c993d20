// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

namespace sac {

enum class StatusCode {
  kOk,
  kNeedMoreData,     // not an error: send more bytes and ask again
  kInvalidArgument,  // the caller's data or settings cannot be used
  kUnsupported,      // well-formed, but of a newer version or with an unknown feature
  kCorrupt,          // the bytes break a rule of spec.md
  kLimit,            // a limit of the settings would be exceeded
  kIoError,          // a file could not be read or written
  kCancelled,        // the caller's progress callback asked to stop
};

// The outcome of an operation; the message is one line for a person, empty when ok.
class [[nodiscard]] Status {
 public:
  Status() = default;
  Status(StatusCode code, std::string message) : code_(code), message_(std::move(message)) {}

  bool ok() const { return code_ == StatusCode::kOk; }
  StatusCode code() const { return code_; }
  const std::string& message() const { return message_; }

  static Status Ok() { return {}; }
  static Status NeedMoreData() { return {StatusCode::kNeedMoreData, "needs more data"}; }
  static Status InvalidArgument(std::string m) { return {StatusCode::kInvalidArgument, std::move(m)}; }
  static Status Unsupported(std::string m) { return {StatusCode::kUnsupported, std::move(m)}; }
  static Status Corrupt(std::string m) { return {StatusCode::kCorrupt, std::move(m)}; }
  static Status Limit(std::string m) { return {StatusCode::kLimit, std::move(m)}; }
  static Status Cancelled() { return {StatusCode::kCancelled, "cancelled"}; }
  static Status IoError(std::string m) { return {StatusCode::kIoError, std::move(m)}; }

 private:
  StatusCode code_ = StatusCode::kOk;
  std::string message_;
};

}  // namespace sac

// Returns the status of `expr` to the caller unless it is ok.
#define SAC_RETURN_IF_ERROR(expr)                                      \
  do {                                                                 \
    if (::sac::Status status_ = (expr); !status_.ok()) return status_; \
  } while (false)
