// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "files/cache_file.h"
#include "files/clip_input.h"
#include "tests/files/mesh_files.h"
#include "tests/test_directory.h"

namespace sac {

class ClipFileTest : public testing::Test {
 protected:
  // An OBJ of points (x, 0, 0), (x, 1, 0), ... and one triangle.
  std::string WriteObj(const std::string& name, float x, const std::string& faces = "f 1 2 3\n", int vertices = 3) {
    std::string obj;
    for (int i = 0; i < vertices; ++i) obj += "v " + std::to_string(x) + " " + std::to_string(i) + " 0\n";
    return directory_.Write(name, obj + faces);
  }

  std::string WriteCache(const std::string& name, const std::vector<Positions>& frames) {
    std::unique_ptr<CacheWriter> writer;
    EXPECT_TRUE(CacheWriter::Open(directory_.Path(name), frames[0].size(), 25, std::nullopt, writer).ok());
    for (const Positions& frame : frames) EXPECT_TRUE(writer->Write(frame).ok());
    EXPECT_TRUE(writer->Commit().ok());
    return directory_.Path(name);
  }

  // A binary STL of triangles, three positions each.
  static std::string Stl(const std::vector<Positions>& triangles) {
    std::string stl = std::string(80, ' ') + Little32(static_cast<std::uint32_t>(triangles.size()));
    for (const Positions& triangle : triangles) {
      stl += std::string(12, '\0');
      for (const Vec3f& corner : triangle) {
        for (const float x : corner) stl += LittleFloat(x);
      }
      stl += std::string(2, '\0');
    }
    return stl;
  }

  // A text without the directory.
  std::string Short(std::string text) {
    const std::string prefix = directory_.Path("");
    for (auto at = text.find(prefix); at != std::string::npos; at = text.find(prefix)) text.erase(at, prefix.size());
    return text;
  }

  std::unique_ptr<ClipInput> Open(const std::vector<std::string>& arguments, const ClipInputSettings& settings = {}) {
    std::unique_ptr<ClipInput> input;
    const Status status = ClipInput::Open(arguments, input, settings);
    EXPECT_TRUE(status.ok()) << status.message();
    return input;
  }

  std::string OpenError(const std::vector<std::string>& arguments, const ClipInputSettings& settings = {}) {
    std::unique_ptr<ClipInput> input;
    return Short(ClipInput::Open(arguments, input, settings).message());
  }

  Warnings Told(const ClipInput& clip) {
    Warnings warnings = clip.warnings();
    for (std::string& warning : warnings) warning = Short(warning);
    return warnings;
  }

  // The frames up to the end, or to an error.
  static std::vector<Positions> Frames(ClipInput& clip) {
    std::vector<Positions> frames;
    Positions frame;
    for (bool end = false; true;) {
      const Status status = clip.Next(frame, end);
      EXPECT_TRUE(status.ok()) << status.message();
      if (end || !status.ok()) return frames;
      frames.push_back(frame);
    }
  }

  TestDirectory directory_;
};

}  // namespace sac
