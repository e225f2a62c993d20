// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <string>

#include "files/mesh_file.h"
#include "tests/test_directory.h"

namespace sac {

inline std::string Little32(std::uint32_t value) {
  std::string bytes;
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xFF);
  return bytes;
}

inline std::string LittleFloat(float value) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, 4);
  return Little32(bits);
}

class MeshFileTest : public testing::Test {
 protected:
  // The mesh in a file of that name and content.
  Mesh Read(const std::string& name, const std::string& bytes) {
    Mesh mesh;
    const Status status = ReadMesh(directory_.Write(name, bytes), mesh);
    EXPECT_TRUE(status.ok()) << status.message();
    return mesh;
  }

  // What ReadMeshFile gives, with warnings without the directory.
  MeshFile ReadFile(const std::string& name, const std::string& bytes, const ReadSettings& settings = {}) {
    MeshFile file;
    const Status status = ReadMeshFile(directory_.Write(name, bytes), settings, file);
    EXPECT_TRUE(status.ok()) << status.message();
    for (std::string& warning : file.warnings) {
      EXPECT_EQ(warning.rfind(directory_.Path(name) + ": ", 0), 0U) << warning;
      EXPECT_EQ(warning.find('\n'), std::string::npos);
      warning.erase(0, directory_.Path("").size());
    }
    return file;
  }

  // The error message without the directory.
  std::string Error(const std::string& name, const std::string& bytes) {
    Mesh mesh;
    const Status status = ReadMesh(directory_.Write(name, bytes), mesh);
    EXPECT_FALSE(status.ok());
    EXPECT_EQ(status.message().find('\n'), std::string::npos);
    EXPECT_EQ(status.message().rfind(directory_.Path(name) + ": ", 0), 0U) << status.message();
    return status.ok() ? "" : status.message().substr(directory_.Path("").size());
  }

  TestDirectory directory_;
};

}  // namespace sac
