// SPDX-License-Identifier: Apache-2.0
// Runs examples/vat.glsl over what VatWriter writes, by Mesa's software, and reads the vertices back.
#include "files/vat_writer.h"

// For the functions of OpenGL after 1.3.
#define GL_GLEXT_PROTOTYPES

#include <GL/gl.h>
#include <GL/glext.h>
#include <GL/osmesa.h>
#include <ImfArray.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <gtest/gtest.h>
#include <png.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "files/clip_output.h"
#include "tests/hard_cube.h"
#include "tests/test_directory.h"

// Mesa keeps a little of what it allocates for its first context; LeakSanitizer asks for this function by its name.
extern "C" __attribute__((visibility("default"))) const char* __lsan_default_suppressions() { return "leak:libOSMesa"; }

namespace sac {
namespace {

using nlohmann::json;

struct Image {
  std::size_t width = 0, height = 0;
  std::vector<float> rgb;
};

Image ReadPng(const std::string& path) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  // Only to see its size: the simple interface would convert 16 bits by a gamma.
  EXPECT_NE(png_image_begin_read_from_file(&png, path.c_str()), 0);
  Image image{png.width, png.height, {}};
  png_image_free(&png);
  std::FILE* file = std::fopen(path.c_str(), "rb");
  png_structp reader = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(reader);
  png_init_io(reader, file);
  png_read_png(reader, info, PNG_TRANSFORM_IDENTITY, nullptr);
  EXPECT_EQ(png_get_bit_depth(reader, info), 16);
  png_bytepp rows = png_get_rows(reader, info);
  for (std::size_t y = 0; y < image.height; ++y) {
    for (std::size_t i = 0; i < 3 * image.width; ++i) {
      image.rgb.push_back(static_cast<float>(rows[y][2 * i] * 256 + rows[y][2 * i + 1]) / 65535.0F);
    }
  }
  png_destroy_read_struct(&reader, &info, nullptr);
  std::fclose(file);
  return image;
}

Image ReadExr(const std::string& path) {
  Imf::InputFile file(path.c_str());
  const auto window = file.header().dataWindow();
  Image image{static_cast<std::size_t>(window.max.x + 1), static_cast<std::size_t>(window.max.y + 1), {}};
  image.rgb.resize(3 * image.width * image.height);
  Imf::FrameBuffer buffer;
  for (int k = 0; k < 3; ++k) {
    const char name[] = {"RGB"[k], '\0'};
    buffer.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(image.rgb.data() + k), 12, 12 * image.width));
  }
  file.setFrameBuffer(buffer);
  file.readPixels(window.min.y, window.max.y);
  return image;
}

// A context of OpenGL 3.3 without a display.
class VatTest : public testing::Test {
 protected:
  void SetUp() override {
    const int attributes[] = {OSMESA_FORMAT,
                              OSMESA_RGBA,
                              OSMESA_PROFILE,
                              OSMESA_CORE_PROFILE,
                              OSMESA_CONTEXT_MAJOR_VERSION,
                              3,
                              OSMESA_CONTEXT_MINOR_VERSION,
                              3,
                              0};
    context_ = OSMesaCreateContextAttribs(attributes, nullptr);
    ASSERT_NE(context_, nullptr);
    ASSERT_TRUE(OSMesaMakeCurrent(context_, pixels_.data(), GL_UNSIGNED_BYTE, 4, 4));
  }
  void TearDown() override { OSMesaDestroyContext(context_); }

  static void Texture(GLenum unit, const Image& image) {
    GLuint texture = 0;
    glGenTextures(1, &texture);
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB32F, static_cast<GLsizei>(image.width), static_cast<GLsizei>(image.height), 0,
                 GL_RGB, GL_FLOAT, image.rgb.data());
  }

  static GLuint Program() {
    std::ifstream file(SAC_VAT_SHADER);
    const std::string shader = "#version 330\n" + std::string(std::istreambuf_iterator<char>(file), {}) +
                               "uniform float time;\nout vec3 position;\nout vec3 normal;\n"
                               "void main() { SacVertex(gl_VertexID, time, position, normal); }\n";
    const char* source = shader.c_str();
    const GLuint vertex = glCreateShader(GL_VERTEX_SHADER), program = glCreateProgram();
    glShaderSource(vertex, 1, &source, nullptr);
    glCompileShader(vertex);
    glAttachShader(program, vertex);
    const char* outputs[] = {"position", "normal"};
    glTransformFeedbackVaryings(program, 2, outputs, GL_INTERLEAVED_ATTRIBS);
    glLinkProgram(program);
    GLint linked = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    char log[1000] = "";
    glGetShaderInfoLog(vertex, sizeof log, nullptr, log);
    EXPECT_NE(linked, 0) << log;
    return program;
  }

  // Position and normal of each vertex, six floats, at `time` in frames.
  std::vector<float> Run(const json& vat, float time) {
    const GLuint program = Program();
    glUseProgram(program);
    const auto place = [program](const char* name) { return glGetUniformLocation(program, name); };
    for (const std::string part : {"position", "normal"}) {
      for (const std::string term : {"scale", "bias"}) {
        const auto value = vat[part + "s"][term].get<std::vector<float>>();
        glUniform3f(place(("sac_" + part + "_" + term).c_str()), value[0], value[1], value[2]);
      }
      const GLenum unit = part == "normal";
      const std::string file = directory_.Path(vat[part + "s"]["file"].get<std::string>());
      Texture(unit, file.ends_with(".png") ? ReadPng(file) : ReadExr(file));
      glUniform1i(place(("sac_" + part + "s").c_str()), static_cast<GLint>(unit));
    }
    glUniform1i(place("sac_width"), vat["width"].get<int>());
    glUniform1i(place("sac_rows"), vat["rows"].get<int>());
    glUniform1i(place("sac_frames"), vat["frames"].get<int>());
    glUniform1f(place("time"), time);
    const auto count = vat["vertices"].get<std::size_t>();
    std::vector<float> values(6 * count);
    GLuint array = 0, buffer = 0;
    glGenVertexArrays(1, &array);
    glBindVertexArray(array);
    glGenBuffers(1, &buffer);
    glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, buffer);
    glBufferData(GL_TRANSFORM_FEEDBACK_BUFFER, static_cast<GLsizeiptr>(4 * values.size()), nullptr, GL_STATIC_READ);
    glEnable(GL_RASTERIZER_DISCARD);
    glBeginTransformFeedback(GL_POINTS);
    glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(count));
    glEndTransformFeedback();
    glGetBufferSubData(GL_TRANSFORM_FEEDBACK_BUFFER, 0, static_cast<GLsizeiptr>(4 * values.size()), values.data());
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    return values;
  }

  // Frames of a cube with hard edges that turns about z, a radian a second of 10 frames, and moves along x.
  static Positions Frame(const Mesh& mesh, double f) {
    Positions frame;
    const double c = std::cos(f / 10), s = std::sin(f / 10);
    for (const Vec3f& p : mesh.positions) {
      const double x = static_cast<double>(p[0]), y = static_cast<double>(p[1]);
      frame.push_back({static_cast<float>(c * x - s * y + f), static_cast<float>(s * x + c * y), p[2]});
    }
    return frame;
  }

  void Check(bool exr, double precision) {
    const Mesh mesh = HardCubeMesh();
    ClipOutput::Settings settings;
    settings.exr = exr;
    std::unique_ptr<ClipOutput> output;
    ASSERT_TRUE(ClipOutput::Open(directory_.Path("c.vat"), mesh, settings, output).ok());
    for (int f = 0; f < 5; ++f) ASSERT_TRUE(output->Write(f, Frame(mesh, f)).ok());
    ASSERT_TRUE(output->Commit().ok());
    EXPECT_EQ(directory_.FileCount(), 4U);
    const json vat = json::parse(directory_.Read("c.vat"));
    const SplitVertices split = SplitAtSeams(mesh);
    ASSERT_EQ(vat["vertices"], split.size());
    ASSERT_GT(split.size(), mesh.positions.size());
    for (const float time : {0.0F, 3.0F, 4.0F, 9.0F, -1.0F, 1.5F}) {
      const double at = std::clamp<double>(time, 0, 4);
      const Positions a = Frame(mesh, std::floor(at)), b = Frame(mesh, std::ceil(at));
      const std::vector<float> values = Run(vat, time);
      for (std::size_t i = 0; i < split.size(); ++i) {
        const std::uint32_t v = split.vertices[i];
        for (int k = 0; k < 3; ++k) {
          EXPECT_NEAR(values[6 * i + k], (a[v][k] + b[v][k]) / 2, precision) << "time " << time << ", vertex " << i;
        }
        // Normals turn with the cube.
        const Vec3f& n = mesh.normals[split.normals[i]];
        const double c = std::cos(at / 10), s = std::sin(at / 10);
        EXPECT_NEAR(values[6 * i + 3], c * n[0] - s * n[1], 1e-4) << "time " << time << ", vertex " << i;
        EXPECT_NEAR(values[6 * i + 5], n[2], 1e-4);
      }
    }
  }

  TestDirectory directory_;
  OSMesaContext context_ = nullptr;
  std::vector<std::uint8_t> pixels_ = std::vector<std::uint8_t>(64);
};

TEST_F(VatTest, ShaderPlaysPng) { Check(false, 6.0 / 65535); }
TEST_F(VatTest, ShaderPlaysExr) { Check(true, 1e-6); }

TEST_F(VatTest, DoesNotReplaceWhatWasNotNamed) {
  directory_.Write("c_normals.png", "mine");
  const Mesh mesh = HardCubeMesh();
  std::unique_ptr<ClipOutput> output;
  ASSERT_TRUE(ClipOutput::Open(directory_.Path("c.vat"), mesh, {}, output).ok());
  ASSERT_TRUE(output->Write(0, mesh.positions).ok());
  const std::string message = output->Commit().message();
  EXPECT_NE(message.find("c_normals.png: is there already"), std::string::npos) << message;
  output.reset();
  EXPECT_EQ(directory_.FileCount(), 1U);
  EXPECT_EQ(directory_.Read("c_normals.png"), "mine");
}

}  // namespace
}  // namespace sac
