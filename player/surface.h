// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <GL/glcorearb.h>

#include <functional>
#include <vector>

#include "player/camera.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// The functions of OpenGL 3.2 that a surface calls, under their names without the prefix; the type of one is
// PFNGL...PROC.
// clang-format off
#define SAC_GL_FUNCTIONS(X) \
  X(Viewport, VIEWPORT) X(ClearColor, CLEARCOLOR) X(Clear, CLEAR) X(Enable, ENABLE) X(PolygonMode, POLYGONMODE) \
  X(DrawElements, DRAWELEMENTS) X(DrawArrays, DRAWARRAYS) X(PointSize, POINTSIZE) \
  X(GenVertexArrays, GENVERTEXARRAYS) X(BindVertexArray, BINDVERTEXARRAY) X(GenBuffers, GENBUFFERS) \
  X(BindBuffer, BINDBUFFER) X(BufferData, BUFFERDATA) X(VertexAttribPointer, VERTEXATTRIBPOINTER) \
  X(EnableVertexAttribArray, ENABLEVERTEXATTRIBARRAY) X(VertexAttrib4f, VERTEXATTRIB4F) \
  X(CreateShader, CREATESHADER) X(ShaderSource, SHADERSOURCE) X(CompileShader, COMPILESHADER) \
  X(GetShaderiv, GETSHADERIV) X(CreateProgram, CREATEPROGRAM) X(AttachShader, ATTACHSHADER) \
  X(BindAttribLocation, BINDATTRIBLOCATION) X(LinkProgram, LINKPROGRAM) X(GetProgramiv, GETPROGRAMIV) \
  X(UseProgram, USEPROGRAM) X(GetUniformLocation, GETUNIFORMLOCATION) X(UniformMatrix4fv, UNIFORMMATRIX4FV)
// clang-format on

// A mesh in the memory of the graphics card. It belongs to the context that was current when it was made, and goes with
// it.
class SurfaceRenderer {
 public:
  // `address` gives the address of a function of OpenGL, null where there is none.
  Status Create(const Mesh& mesh, const std::function<void*(const char*)>& address);
  // Positions and normals of a frame, each of as many as the mesh has vertices.
  void SetFrame(const std::vector<Vec3f>& positions, const std::vector<Vec3f>& normals);
  void Draw(const Camera& camera, int width, int height, bool wireframe) const;

 private:
#define SAC_DECLARE(name, upper) PFNGL##upper##PROC name##_ = nullptr;
  SAC_GL_FUNCTIONS(SAC_DECLARE)
#undef SAC_DECLARE
  Status Load(const std::function<void*(const char*)>& address);
  Status MakeProgram();
  GLuint MakeBuffer(GLenum target, const void* data, std::size_t bytes) const;

  GLuint positions_ = 0, normals_ = 0;
  GLint view_ = 0, projection_ = 0;
  GLsizei indices_ = 0, vertices_ = 0;
};

}  // namespace sac
