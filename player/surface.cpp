// SPDX-License-Identifier: Apache-2.0
#include "player/surface.h"

#include <string>

namespace sac {
namespace {

enum Attribute : GLuint { kPosition = 0, kNormal = 1, kColor = 2 };

constexpr const char* kVertexShader = R"(#version 150
uniform mat4 view, projection;
in vec3 position, normal;
in vec4 color;
out vec3 direction, place;
out vec4 tint;
void main() {
  vec4 at = view * vec4(position, 1.0);
  direction = mat3(view) * normal;
  place = at.xyz;
  tint = color;
  gl_Position = projection * at;
}
)";

// A light beside the eye. The back of a surface is lit, too, and is darker.
constexpr const char* kFragmentShader = R"(#version 150
in vec3 direction, place;
in vec4 tint;
out vec4 pixel;
void main() {
  float length2 = dot(direction, direction);
  vec3 n = length2 > 0.0 ? direction * inversesqrt(length2) : vec3(0.0, 0.0, 1.0);
  float side = dot(n, -place) < 0.0 ? -1.0 : 1.0;
  float light = max(dot(side * n, normalize(vec3(0.35, 0.5, 1.0))), 0.0);
  pixel = vec4(tint.rgb * (side < 0.0 ? 0.6 : 1.0) * (0.15 + 0.85 * light), 1.0);
}
)";

}  // namespace

Status SurfaceRenderer::Load(const std::function<void*(const char*)>& address) {
  std::string missing;
#define SAC_LOAD(name, upper)                                         \
  name##_ = reinterpret_cast<decltype(name##_)>(address("gl" #name)); \
  if (name##_ == nullptr) missing = "gl" #name;
  SAC_GL_FUNCTIONS(SAC_LOAD)
#undef SAC_LOAD
  return missing.empty() ? Status::Ok() : Status::Unsupported("play: this OpenGL has no " + missing);
}

Status SurfaceRenderer::MakeProgram() {
  const GLuint program = CreateProgram_();
  GLint good = GL_TRUE;
  for (const auto& [kind, source] :
       {std::pair{GL_VERTEX_SHADER, kVertexShader}, {GL_FRAGMENT_SHADER, kFragmentShader}}) {
    const GLuint shader = CreateShader_(static_cast<GLenum>(kind));
    ShaderSource_(shader, 1, &source, nullptr);
    CompileShader_(shader);
    GetShaderiv_(shader, GL_COMPILE_STATUS, &good);
    if (good != GL_TRUE) return Status::Unsupported("play: this OpenGL refuses the shaders");
    AttachShader_(program, shader);
  }
  BindAttribLocation_(program, kPosition, "position");
  BindAttribLocation_(program, kNormal, "normal");
  BindAttribLocation_(program, kColor, "color");
  LinkProgram_(program);
  GetProgramiv_(program, GL_LINK_STATUS, &good);
  if (good != GL_TRUE) return Status::Unsupported("play: this OpenGL refuses the shaders");
  UseProgram_(program);
  view_ = GetUniformLocation_(program, "view");
  projection_ = GetUniformLocation_(program, "projection");
  return Status::Ok();
}

GLuint SurfaceRenderer::MakeBuffer(GLenum target, const void* data, std::size_t bytes) const {
  GLuint buffer = 0;
  GenBuffers_(1, &buffer);
  BindBuffer_(target, buffer);
  BufferData_(target, static_cast<GLsizeiptr>(bytes), data, GL_STATIC_DRAW);
  return buffer;
}

Status SurfaceRenderer::Create(const Mesh& mesh, const std::function<void*(const char*)>& address) {
  SAC_RETURN_IF_ERROR(Load(address));
  SAC_RETURN_IF_ERROR(MakeProgram());
  vertices_ = static_cast<GLsizei>(mesh.positions.size());
  indices_ = static_cast<GLsizei>(3 * mesh.triangles.size());
  GLuint array = 0;
  GenVertexArrays_(1, &array);
  BindVertexArray_(array);
  const auto attribute = [&](Attribute index, GLint size, GLenum type, GLboolean normalized) {
    VertexAttribPointer_(index, size, type, normalized, 0, nullptr);
    EnableVertexAttribArray_(index);
  };
  positions_ = MakeBuffer(GL_ARRAY_BUFFER, nullptr, 0);
  attribute(kPosition, 3, GL_FLOAT, GL_FALSE);
  normals_ = MakeBuffer(GL_ARRAY_BUFFER, nullptr, 0);
  attribute(kNormal, 3, GL_FLOAT, GL_FALSE);
  if (!mesh.colors.empty()) {
    MakeBuffer(GL_ARRAY_BUFFER, mesh.colors.data(), mesh.colors.size() * sizeof mesh.colors[0]);
    attribute(kColor, 4, GL_UNSIGNED_BYTE, GL_TRUE);
  } else {
    VertexAttrib4f_(kColor, 0.82f, 0.80f, 0.76f, 1);
  }
  MakeBuffer(GL_ELEMENT_ARRAY_BUFFER, mesh.triangles.data(), mesh.triangles.size() * sizeof(Triangle));
  Enable_(GL_DEPTH_TEST);
  ClearColor_(0.16f, 0.17f, 0.19f, 1);
  PointSize_(2);
  return Status::Ok();
}

void SurfaceRenderer::SetFrame(const std::vector<Vec3f>& positions, const std::vector<Vec3f>& normals) {
  const auto bytes = static_cast<GLsizeiptr>(positions.size() * sizeof(Vec3f));
  BindBuffer_(GL_ARRAY_BUFFER, positions_);
  BufferData_(GL_ARRAY_BUFFER, bytes, positions.data(), GL_STREAM_DRAW);
  BindBuffer_(GL_ARRAY_BUFFER, normals_);
  BufferData_(GL_ARRAY_BUFFER, bytes, normals.data(), GL_STREAM_DRAW);
}

void SurfaceRenderer::Draw(const Camera& camera, int width, int height, bool wireframe) const {
  Viewport_(0, 0, width, height);
  Clear_(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  const Matrix4 view = camera.View();
  const Matrix4 projection = camera.Projection(static_cast<double>(width) / height);
  UniformMatrix4fv_(view_, 1, GL_FALSE, view.data());
  UniformMatrix4fv_(projection_, 1, GL_FALSE, projection.data());
  PolygonMode_(GL_FRONT_AND_BACK, wireframe ? GL_LINE : GL_FILL);
  if (indices_ > 0) {
    DrawElements_(GL_TRIANGLES, indices_, GL_UNSIGNED_INT, nullptr);
  } else {
    DrawArrays_(GL_POINTS, 0, vertices_);
  }
}

}  // namespace sac
