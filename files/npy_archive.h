// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "sac/status.h"

namespace sac {

// An array as numpy has it: little endian, the last index fastest.
struct NpyArray {
  std::string type;  // numpy's: <f4, <f8, <u4, |u1
  std::vector<std::uint64_t> shape;
  std::string bytes;

  std::uint64_t size() const {
    std::uint64_t product = 1;
    for (const std::uint64_t n : shape) product *= n;
    return product;
  }
};

// An .npz file: a zip of .npy arrays (NumPy enhancement proposal 1), by their names without the suffix.
using NpyArchive = std::map<std::string, NpyArray>;

// The bytes of the archive. Equal archives have equal bytes.
Status FormatNpz(const NpyArchive& archive, std::string& bytes);

// Reads an archive whose arrays hold at most `most_bytes` in all. kIoError where it cannot be read, kCorrupt where it
// is no archive of arrays, kUnsupported for arrays of other types or in Fortran's order; the message starts with the
// path.
Status ReadNpz(const std::string& path, std::uint64_t most_bytes, NpyArchive& archive);

}  // namespace sac
