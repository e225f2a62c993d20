// SPDX-License-Identifier: Apache-2.0
#include "files/texture_file.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <csetjmp>
#include <cstdint>
#include <cstring>
#include <memory>

namespace sac {
namespace {

struct PngWriter {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  ~PngWriter() { png_destroy_write_struct(&png, &info); }
};

// An OpenEXR stream into a string.
class StringStream : public Imf::OStream {
 public:
  explicit StringStream(std::string& bytes) : OStream("memory"), bytes_(bytes) {}
  void write(const char c[], int n) override {
    const auto size = static_cast<std::size_t>(n);
    if (at_ + size > bytes_.size()) bytes_.resize(at_ + size);
    std::memcpy(bytes_.data() + at_, c, size);
    at_ += size;
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t position) override { at_ = static_cast<std::size_t>(position); }

 private:
  std::string& bytes_;
  std::size_t at_ = 0;
};

// Nothing with a destructor may begin between setjmp and longjmp, so rows are made by the caller.
bool WritePng(const PngWriter& writer, png_bytepp rows, png_uint_32 width, png_uint_32 height, std::string* bytes) {
  if (setjmp(png_jmpbuf(writer.png)) != 0) return false;
  png_set_write_fn(
      writer.png, bytes,
      [](png_structp png, png_bytep data, png_size_t size) {
        static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(data), size);
      },
      [](png_structp /*png*/) {});
  png_set_user_limits(writer.png, width, height);
  png_set_IHDR(writer.png, writer.info, width, height, 16, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(writer.png, writer.info);
  png_write_image(writer.png, rows);
  png_write_end(writer.png, nullptr);
  return true;
}

}  // namespace

Status FormatPng16(const std::vector<Vec3f>& texels, std::size_t width, std::size_t height, std::string& bytes) {
  std::vector<std::uint8_t> levels;
  levels.reserve(6 * texels.size());
  for (const Vec3f& texel : texels) {
    for (const float x : texel) {
      const auto level = static_cast<unsigned>(std::lround(std::clamp(static_cast<double>(x), 0.0, 1.0) * 65535));
      levels.push_back(static_cast<std::uint8_t>(level >> 8));
      levels.push_back(static_cast<std::uint8_t>(level));
    }
  }
  std::vector<png_bytep> rows;
  for (std::size_t y = 0; y < height; ++y) rows.push_back(levels.data() + 6 * width * y);
  const PngWriter writer;
  if (writer.info == nullptr) return Status::Limit("not enough memory");
  if (!WritePng(writer, rows.data(), static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), &bytes)) {
    return Status::IoError("libpng cannot write it");
  }
  return Status::Ok();
}

Status FormatExr(const std::vector<Vec3f>& texels, std::size_t width, std::size_t height, std::string& bytes) {
  Imf::Header header(static_cast<int>(width), static_cast<int>(height));
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::FrameBuffer buffer;
  // OpenEXR takes a pointer to what it only reads.
  char* first = reinterpret_cast<char*>(const_cast<Vec3f*>(texels.data()));
  for (int k = 0; k < 3; ++k) {
    const char name[] = {"RGB"[k], '\0'};
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    buffer.insert(name, Imf::Slice(Imf::FLOAT, first + 4 * k, sizeof(Vec3f), sizeof(Vec3f) * width));
  }
  StringStream stream(bytes);
  Imf::OutputFile file(stream, header);
  file.setFrameBuffer(buffer);
  file.writePixels(static_cast<int>(height));
  return Status::Ok();
}

}  // namespace sac
