// SPDX-License-Identifier: Apache-2.0
#include "files/cache_file.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/test_directory.h"

namespace sac {
namespace {

// Two frames of two points, byte by byte: 1, 2, -0.5, 0, 0, 0 and 0, 0, 0, 3, 0, NaN.
const Positions kFirst = {{1, 2, -0.5F}, {0, 0, 0}};
const std::string kPc2 = std::string("POINTCACHE2\0\1\0\0\0\2\0\0\0\0\0\0\0\0\0\x80\x3F\2\0\0\0", 32) +
                         std::string("\0\0\x80\x3F\0\0\0\x40\0\0\0\xBF\0\0\0\0\0\0\0\0\0\0\0\0", 24) +
                         std::string("\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x40\x40\0\0\0\0\0\0\xC0\x7F", 24);
const std::string kMdd = std::string("\0\0\0\2\0\0\0\2", 8) + std::string("\0\0\0\0\x3D\0\0\0", 8) +
                         std::string("\x3F\x80\0\0\x40\0\0\0\xBF\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0", 24) +
                         std::string("\0\0\0\0\0\0\0\0\0\0\0\0\x40\x40\0\0\0\0\0\0\x7F\xC0\0\0", 24);

class CacheFileTest : public testing::Test {
 protected:
  // The error message without the directory; empty if the file opens.
  std::string Error(const std::string& name, const std::string& bytes) {
    std::unique_ptr<CacheReader> reader;
    const Status status = CacheReader::Open(directory_.Write(name, bytes), reader);
    EXPECT_EQ(status.ok(), reader != nullptr);
    return status.ok() ? "" : status.message().substr(directory_.Path("").size());
  }

  TestDirectory directory_;
};

TEST_F(CacheFileTest, ReadsBothFormatsInAnyOrder) {
  for (const bool mdd : {false, true}) {
    std::unique_ptr<CacheReader> reader;
    const Status status =
        CacheReader::Open(mdd ? directory_.Write("a.MDD", kMdd) : directory_.Write("a.pc2", kPc2), reader);
    ASSERT_TRUE(status.ok()) << status.message();
    EXPECT_EQ(reader->frame_count(), 2U);
    EXPECT_EQ(reader->point_count(), 2U);
    EXPECT_EQ(reader->fps(), mdd ? std::optional<double>(32) : std::nullopt);
    Positions frame;
    ASSERT_TRUE(reader->Read(1, frame).ok());
    EXPECT_EQ(frame[1][0], 3);
    EXPECT_TRUE(std::isnan(frame[1][2]));
    ASSERT_TRUE(reader->Read(0, frame).ok());
    EXPECT_EQ(frame, kFirst);
    EXPECT_EQ(reader->Read(2, frame).code(), StatusCode::kInvalidArgument);
  }
}

TEST_F(CacheFileTest, EveryOtherLengthFails) {
  for (const std::string* cache : {&kPc2, &kMdd}) {
    const std::string name = cache == &kPc2 ? "a.pc2" : "a.mdd";
    for (std::size_t size = 0; size < cache->size(); ++size) {
      EXPECT_EQ(Error(name, cache->substr(0, size)).find(name + ": "), 0U) << size;
    }
    EXPECT_EQ(Error(name, *cache), "");
    EXPECT_EQ(Error(name, *cache + "x"),
              name + ": header says 2 frames of 2 points, but the file has 2 whole frames and 1 bytes");
  }
}

TEST_F(CacheFileTest, HeaderErrors) {
  const auto with = [](std::string cache, std::size_t offset, const std::string& bytes) {
    return cache.replace(offset, bytes.size(), bytes);
  };
  const std::string minus_one(4, '\xFF'), zero(4, '\0'), huge("\xFF\xFF\xFF\x7F", 4), huge_big("\x7F\xFF\xFF\xFF", 4);
  EXPECT_EQ(Error("a.pc2", with(kPc2, 0, "X")), "a.pc2: not a PC2 file");
  EXPECT_EQ(Error("a.pc2", with(kPc2, 12, "\2")), "a.pc2: PC2 version 2");
  EXPECT_EQ(Error("a.pc2", with(kPc2, 16, minus_one)), "a.pc2: header says 2 frames of -1 points");
  EXPECT_EQ(Error("a.pc2", with(kPc2, 28, minus_one)), "a.pc2: header says -1 frames of 2 points");
  EXPECT_EQ(Error("a.pc2", with(kPc2, 16, zero)), "a.pc2: no points");
  EXPECT_EQ(Error("a.pc2", with(kPc2, 28, zero)), "a.pc2: no frames");
  // The product of these overflows 64 bits.
  EXPECT_EQ(Error("a.pc2", with(with(kPc2, 16, huge), 28, huge)),
            "a.pc2: header says 2147483647 frames of 2147483647 points, but the file has 0 whole frames and 48 bytes");
  EXPECT_EQ(Error("a.mdd", with(kMdd, 0, huge_big + huge_big)),
            "a.mdd: header says 2147483647 frames of 2147483647 points, but the file has 0 whole frames and 0 bytes");
  EXPECT_EQ(Error("a.mdd", with(kMdd, 0, minus_one)), "a.mdd: header says -1 frames of 2 points");
  EXPECT_EQ(Error("a.mdd", with(kMdd, 0, zero)), "a.mdd: no frames");
  EXPECT_EQ(Error("a.abc", kPc2), "a.abc: not a cache by its name (.pc2, .mdd)");
  std::unique_ptr<CacheReader> reader;
  EXPECT_EQ(CacheReader::Open(directory_.Path("none.pc2"), reader).message(),
            directory_.Path("none.pc2") + ": No such file or directory");
  std::filesystem::create_directory(directory_.Path("d.pc2"));
  EXPECT_EQ(CacheReader::Open(directory_.Path("d.pc2"), reader).message(),
            directory_.Path("d.pc2") + ": is a directory");
}

TEST_F(CacheFileTest, FramesASecond) {
  const auto fps = [&](const std::string& times) {
    std::string mdd = kMdd;
    std::unique_ptr<CacheReader> reader;
    EXPECT_TRUE(CacheReader::Open(directory_.Write("a.mdd", mdd.replace(8, 8, times)), reader).ok());
    return reader->fps();
  };
  EXPECT_EQ(fps(std::string("\0\0\0\0\x3D\x2A\xAA\xAB", 8)), 24);                      // 1 / 24
  EXPECT_NEAR(fps(std::string("\0\0\0\0\x3D\x08\xAC\x3A", 8)).value(), 29.97, 0.001);  // 1001 / 30000
  EXPECT_EQ(fps(std::string(8, '\0')), std::nullopt);
  EXPECT_EQ(fps(std::string("\x3D\0\0\0\0\0\0\0", 8)), std::nullopt);    // backwards
  EXPECT_EQ(fps(std::string("\0\0\0\0\x7F\xC0\0\0", 8)), std::nullopt);  // NaN
}

TEST_F(CacheFileTest, WritesTheSameBytes) {
  for (const std::string name : {"a.pc2", "a.mdd"}) {
    for (const bool known : {false, true}) {
      std::unique_ptr<CacheWriter> writer;
      const std::string path = directory_.Path(name);
      ASSERT_TRUE(CacheWriter::Open(path, 2, 32, known ? std::optional<std::uint32_t>(2) : std::nullopt, writer).ok());
      EXPECT_TRUE(writer->Write(kFirst).ok());
      EXPECT_TRUE(writer->Write({{0, 0, 0}, {3, 0, std::nanf("")}}).ok());
      EXPECT_FALSE(std::filesystem::exists(path));
      EXPECT_TRUE(writer->Commit().ok());
      EXPECT_EQ(directory_.Read(name), name == "a.pc2" ? kPc2 : kMdd) << name << known;
      std::filesystem::remove(path);
      EXPECT_EQ(directory_.FileCount(), 0U);
    }
  }
}

// More than the block in which the frames are moved, and more frames than fit one block's worth of shift.
TEST_F(CacheFileTest, LongMddIsMovedWhole) {
  constexpr std::uint32_t kFrames = 70000;
  std::unique_ptr<CacheWriter> writer;
  ASSERT_TRUE(CacheWriter::Open(directory_.Path("a.mdd"), 2, 24, std::nullopt, writer).ok());
  for (std::uint32_t f = 0; f < kFrames; ++f) {
    const auto x = static_cast<float>(f);
    ASSERT_TRUE(writer->Write({{x, 1, 2}, {3, 4, -x}}).ok());
  }
  ASSERT_TRUE(writer->Commit().ok());
  std::unique_ptr<CacheReader> reader;
  ASSERT_TRUE(CacheReader::Open(directory_.Path("a.mdd"), reader).ok());
  ASSERT_EQ(reader->frame_count(), kFrames);
  EXPECT_EQ(reader->fps(), 24);
  Positions frame;
  for (std::uint32_t f = 0; f < kFrames; ++f) {
    const auto x = static_cast<float>(f);
    ASSERT_TRUE(reader->Read(f, frame).ok());
    ASSERT_EQ(frame, (Positions{{x, 1, 2}, {3, 4, -x}}));
  }
}

TEST_F(CacheFileTest, WriterErrorsLeaveNothing) {
  const std::string path = directory_.Path("a.mdd");
  std::unique_ptr<CacheWriter> writer;
  EXPECT_EQ(CacheWriter::Open(path, 0, 24, {}, writer).code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(CacheWriter::Open(path, 1, 0, {}, writer).code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(CacheWriter::Open(directory_.Path("none/a.mdd"), 1, 24, {}, writer).message(),
            directory_.Path("none/a.mdd") + ": No such file or directory");
  ASSERT_TRUE(CacheWriter::Open(path, 1, 24, {}, writer).ok());
  EXPECT_EQ(writer->Write(Positions(2)).message(), path + ": frame 0 has 2 points and not 1");
  EXPECT_EQ(writer->Commit().message(), path + ": no frames");
  ASSERT_TRUE(CacheWriter::Open(path, 1, 24, 2, writer).ok());
  EXPECT_TRUE(writer->Write(Positions(1)).ok());
  EXPECT_EQ(writer->Commit().message(), path + ": 1 frames and not 2");
  ASSERT_TRUE(CacheWriter::Open(path, 1, 24, 1, writer).ok());
  EXPECT_TRUE(writer->Write(Positions(1)).ok());
  EXPECT_EQ(writer->Write(Positions(1)).message(), path + ": more than 1 frames");
  writer.reset();
  EXPECT_EQ(directory_.FileCount(), 0U);
}

}  // namespace
}  // namespace sac
