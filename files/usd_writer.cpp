// SPDX-License-Identifier: Apache-2.0
#include "files/usd_writer.h"

#include <charconv>
#include <filesystem>
#include <string_view>

#include "files/path.h"

namespace sac {
namespace {

// The shortest text that is read back as the same number.
template <typename Number>
void Append(Number value, std::string& text) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, value);
  text.append(digits, end.ptr);
}

template <typename Vector>
void AppendTuple(const Vector& values, std::string& text) {
  text += '(';
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (k > 0) text += ", ";
    Append(values[k], text);
  }
  text += ')';
}

template <typename Values, typename Step>
void AppendList(const Values& values, std::string& text, Step step) {
  text += '[';
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) text += ", ";
    step(values[i]);
  }
  text += ']';
}

void AppendIndices(const std::vector<Triangle>& triangles, std::string& text) {
  AppendList(triangles, text, [&text](const Triangle& t) {
    for (int k = 0; k < 3; ++k) {
      if (k > 0) text += ", ";
      Append(t[k], text);
    }
  });
}

// A name of a prim: letters, digits and underscores, without a digit in front.
std::string PrimName(const std::string& path) {
  std::string name = std::filesystem::path(path).stem().string();
  for (char& c : name) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    if (!plain) c = '_';
  }
  return name.empty() || (name[0] >= '0' && name[0] <= '9') ? "_" + name : name;
}

}  // namespace

bool IsUsdName(const std::string& path) { return Extension(path) == ".usda"; }

std::string UsdInputError(const std::string& path) {
  const std::string extension = Extension(path);
  if (extension != ".usd" && extension != ".usda" && extension != ".usdc" && extension != ".usdz") return {};
  return path +
         ": USD is not read; convert it to .glb or to meshes and a .pc2, as in Blender (File, Import, Universal Scene "
         "Description; File, Export, glTF 2.0)";
}

Status UsdWriter::Open(const std::string& path, const Mesh& mesh, const UsdSettings& settings) {
  path_ = path;
  mesh_ = mesh;
  settings_ = settings;
  return file_.Open(path);
}

Status UsdWriter::Write(std::int64_t number, const Positions& positions, const std::vector<Vec3f>& normals) {
  numbers_.push_back(number);
  frames_.push_back(positions);
  if (!mesh_.normals.empty()) normals_.push_back(normals);
  return Status::Ok();
}

std::string UsdWriter::Header() const {
  const std::string name = PrimName(path_);
  std::string text = "#usda 1.0\n(\n    defaultPrim = \"" + name + "\"\n    startTimeCode = ";
  Append(numbers_.front(), text);
  text += "\n    endTimeCode = ";
  Append(numbers_.back(), text);
  for (const char* key : {"timeCodesPerSecond", "framesPerSecond"}) {
    text += std::string("\n    ") + key + " = ";
    Append(settings_.fps, text);
  }
  text += std::string("\n    upAxis = \"") + (settings_.z_up ? "Z" : "Y") + "\"\n)\n\ndef Xform \"" + name + "\"\n{\n";
  if (settings_.offset != std::array<double, 3>{}) {
    text += "    double3 xformOp:translate = ";
    AppendTuple(settings_.offset, text);
    text += "\n    uniform token[] xformOpOrder = [\"xformOp:translate\"]\n\n";
  }
  return text + "    def Mesh \"mesh\"\n    {\n        uniform token subdivisionScheme = \"none\"\n";
}

std::string UsdWriter::Faces() const {
  std::string text = "        int[] faceVertexCounts = [";
  for (std::size_t j = 0; j < mesh_.triangles.size(); ++j) text += j > 0 ? ", 3" : "3";
  text += "]\n        int[] faceVertexIndices = ";
  AppendIndices(mesh_.triangles, text);
  return text + "\n";
}

std::string UsdWriter::Attributes() const {
  std::string text;
  if (!mesh_.uvs.empty()) {
    text += "        texCoord2f[] primvars:st = ";
    AppendList(mesh_.uvs, text, [&text](const auto& uv) { AppendTuple(uv, text); });
    text += " (\n            interpolation = \"faceVarying\"\n        )\n        int[] primvars:st:indices = ";
    AppendIndices(mesh_.uv_triangles, text);
    text += "\n";
  }
  if (!mesh_.colors.empty()) {
    text += "        color3f[] primvars:displayColor = ";
    AppendList(mesh_.colors, text, [&text](const auto& c) {
      AppendTuple(Vec3f{static_cast<float>(c[0]) / 255, static_cast<float>(c[1]) / 255, static_cast<float>(c[2]) / 255},
                  text);
    });
    text += " (\n            interpolation = \"vertex\"\n        )\n        float[] primvars:displayOpacity = ";
    AppendList(mesh_.colors, text, [&text](const auto& c) { Append(static_cast<float>(c[3]) / 255, text); });
    text += " (\n            interpolation = \"vertex\"\n        )\n";
  }
  return text;
}

Status UsdWriter::WriteSamples(const std::string& attribute, const std::vector<std::vector<Vec3f>>& samples,
                               const std::string& metadata) {
  if (!metadata.empty()) {
    SAC_RETURN_IF_ERROR(file_.Write("        " + attribute + " (\n" + metadata + "        )\n"));
  }
  SAC_RETURN_IF_ERROR(file_.Write("        " + attribute + ".timeSamples = {\n"));
  for (std::size_t f = 0; f < samples.size(); ++f) {
    std::string text = "            ";
    Append(numbers_[f], text);
    text += ": ";
    AppendList(samples[f], text, [&text](const Vec3f& p) { AppendTuple(p, text); });
    text += ",\n";
    SAC_RETURN_IF_ERROR(file_.Write(text));
  }
  return file_.Write("        }\n");
}

Status UsdWriter::Commit() {
  if (frames_.empty()) return Status::InvalidArgument(path_ + ": no frames");
  SAC_RETURN_IF_ERROR(file_.Write(Header()));
  SAC_RETURN_IF_ERROR(file_.Write(Faces()));
  SAC_RETURN_IF_ERROR(file_.Write(Attributes()));
  if (!normals_.empty()) {
    if (!mesh_.normal_triangles.empty()) {
      for (std::vector<Vec3f>& normals : normals_) {
        std::vector<Vec3f> corners;
        for (const Triangle& t : mesh_.normal_triangles) {
          for (const std::uint32_t index : t) corners.push_back(normals[index]);
        }
        normals = std::move(corners);
      }
    }
    const std::string interpolation = mesh_.normal_triangles.empty() ? "vertex" : "faceVarying";
    SAC_RETURN_IF_ERROR(
        WriteSamples("normal3f[] normals", normals_, "            interpolation = \"" + interpolation + "\"\n"));
  }
  // Without a time, programs show the first frame.
  std::string first = "        point3f[] points = ";
  AppendList(frames_.front(), first, [&first](const Vec3f& p) { AppendTuple(p, first); });
  SAC_RETURN_IF_ERROR(file_.Write(first + "\n"));
  SAC_RETURN_IF_ERROR(WriteSamples("point3f[] points", frames_, ""));
  SAC_RETURN_IF_ERROR(file_.Write("    }\n}\n"));
  return file_.Commit();
}

}  // namespace sac
