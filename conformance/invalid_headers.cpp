// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <utility>

#include "codec/vertex_copies.h"
#include "conformance/invalid_collection.h"

namespace sac {
namespace {

// Adds SmallStream() after `change` has changed its I-frame.
void ChangeIFrame(Collection& c, const char* rule, const char* name, const std::function<void(IFrameSyntax&)>& change,
                  const char* status = "corrupt") {
  c.Change(
      rule, name, [&](StreamParts& p) { change(p.i_frame); }, status);
}

// Adds streams that break the rules of the lists of an I-frame.
void AddIFrameLists(Collection& c) {
  ChangeIFrame(c, "R25", "count", [](IFrameSyntax& s) {
    for (std::uint32_t i = 1; i <= 7; ++i) s.welds.push_back({i, 0});
  });
  ChangeIFrame(c, "R25", "point", [](IFrameSyntax& s) { s.welds = {{6, 0}}; });
  ChangeIFrame(c, "R25", "onto", [](IFrameSyntax& s) { s.welds = {{2, 0xffffffffu}}; });  // a distance of 2
  ChangeIFrame(c, "R26", "count", [](IFrameSyntax& s) { s.loose_vertices.push_back(s.loose_vertices[0]); });
  ChangeIFrame(c, "R26", "above", [](IFrameSyntax& s) { s.loose_vertices[3].position[1] = 16; });
  ChangeIFrame(c, "R26", "below", [](IFrameSyntax& s) { s.loose_vertices[0].position[2] = 0xffffffffu; });
  ChangeIFrame(c, "R27", "count", [](IFrameSyntax& s) { s.loose_triangles.push_back(s.loose_triangles[0]); });
  ChangeIFrame(c, "R27", "above", [](IFrameSyntax& s) { s.loose_triangles[1][2] = 4; });
  ChangeIFrame(c, "R27", "below", [](IFrameSyntax& s) { s.loose_triangles[0][0] = 0xffffffffu; });
  ChangeIFrame(c, "R28", "none", [](IFrameSyntax& s) { s.harmonics = {0}; });
  ChangeIFrame(c, "R28", "too_few", [](IFrameSyntax& s) { s.harmonics = {2}; });
  ChangeIFrame(c, "R28", "too_many", [](IFrameSyntax& s) { s.harmonics = {3, 1}; });
  ChangeIFrame(c, "R28", "no_component", [](IFrameSyntax& s) { s.harmonics.clear(); });
  ChangeIFrame(c, "R29", "twice", [](IFrameSyntax& s) { s.order = {3, 2, 1, 1}; });
  ChangeIFrame(c, "R29", "missing", [](IFrameSyntax& s) { s.order = {0, 1, 2, 4}; });
}

// Adds streams that break the rules of the scales of components.
void AddScales(Collection& c) {
  ChangeIFrame(c, "R76", "scale", [](IFrameSyntax& s) { s.scales = {{kMaxPartExponent + 1, {}}}; });
}

// Adds streams that break the rules of the copies of vertices.
void AddCopies(Collection& c) {
  const auto with_copies = [](StreamParts& p, std::uint32_t said, std::vector<Triangle> copies) {
    p.header.copies = said;
    IFrameSyntax& s = p.i_frame;
    const CornerKinds kinds = KindsOfCorners(s.loose_triangles, 0, {}, p.header.vertices);
    CopyCoder<RecordedBins>(p.header.vertices, s.loose_triangles, kinds).Code(s.positions, 6, copies);
  };
  c.Change("R75", "few", [&](StreamParts& p) { with_copies(p, 2, {{0, 0, 0}, {1, 0, 0}}); });
  c.Change("R75", "many", [&](StreamParts& p) { with_copies(p, 1, {{0, 0, 0}, {1, 1, 0}}); });
  c.Change("R75", "which", [&](StreamParts& p) {  // the copy before the first of four
    p.i_frame.loose_triangles = {{0, 2, 1}, {0, 0, 0}, {3, 3, 0}};
    p.header.triangles = 3;
    with_copies(p, 3, {{0, 0, 0}, {1, 2, 3}, {0, 0, 0xffffffffu}});
  });
  c.Change("R29", "copies", [&](StreamParts& p) {  // an order of the vertices, not of their copies
    with_copies(p, 1, {{0, 0, 0}, {1, 0, 0}});
    p.i_frame.order = {0, 1, 2, 3, 5};
  });
}

// Adds streams that break the rules of the shape that decoders derive from an I-frame.
void AddShape(Collection& c) {
  c.Change("R40", "vertices", [](StreamParts& p) { ++p.header.vertices; });
  c.Change("R41", "triangles", [](StreamParts& p) { ++p.header.triangles; });
  ChangeIFrame(c, "R42", "components", [](IFrameSyntax& s) { s.harmonics = {2, 1}; });
  c.Change("R43", "harmonics", [](StreamParts& p) {  // a component of one vertex and one of three
    p.i_frame.loose_triangles = {{1, 2, 3}, {1, 2, 3}};
    p.i_frame.harmonics = {2, 1};
  });
  c.Change(
      "R44", "harmonics",
      [](StreamParts& p) {  // a strip of 8,194 vertices at one position
        p.header.vertices = 8194;
        p.header.triangles = 4097;
        p.header.harmonics = 8193;
        p.i_frame.loose_vertices.assign(8194, p.i_frame.loose_vertices[0]);
        p.i_frame.loose_triangles.clear();
        for (std::uint32_t v = 0; v < 8192; v += 2) p.i_frame.loose_triangles.push_back({v, v + 1, v + 2});
        p.i_frame.loose_triangles.push_back({8191, 8192, 8193});
        p.i_frame.harmonics = {8193};
        p.groups.clear();
      },
      "limit");
  c.Change(
      "R44", "patches",
      [](StreamParts& p) {  // components of one vertex each, so many that their patches exceed a limit
        p.header.vertices = p.header.harmonics = 262145;
        p.header.triangles = 0;
        p.header.patch_size = 1024;
        p.i_frame.loose_vertices.assign(262145, p.i_frame.loose_vertices[0]);
        p.i_frame.loose_triangles.clear();
        p.i_frame.harmonics.assign(262145, 1);
        p.groups.clear();
      },
      "limit");
  c.Change("R45", "path", [](StreamParts& p) {  // a path at one position: almost equal eigenvalues
    constexpr std::uint32_t kVertices = 300;
    p.header.vertices = kVertices;
    p.header.triangles = kVertices - 1;
    p.header.harmonics = 2;
    p.header.detail_step = p.header.correction_step = 0;
    p.i_frame.loose_vertices.assign(kVertices, p.i_frame.loose_vertices[0]);
    p.i_frame.loose_triangles.clear();
    for (std::uint32_t v = 0; v + 1 < kVertices; ++v) p.i_frame.loose_triangles.push_back({v, v + 1, v + 1});
    p.i_frame.harmonics = {2};
    p.groups.clear();
  });
}

// Adds streams that break the rules of the fingerprint of the harmonics.
void AddFingerprint(Collection& c) {
  ChangeIFrame(
      c, "R46", "eigenvalues", [](IFrameSyntax& s) { s.fingerprint[0] *= 1.001f; }, "unsupported");
  ChangeIFrame(
      c, "R46", "vectors", [](IFrameSyntax& s) { s.fingerprint[1] += 0.001f; }, "unsupported");
  c.Change(
      "R46", "patches",
      [](StreamParts& p) {  // the fingerprint of the components alone
        const float detail_step = std::exchange(p.header.detail_step, 0.0f);
        Derive(p);
        p.header.detail_step = detail_step;
      },
      "unsupported");
  ChangeIFrame(
      c, "R46", "nan", [](IFrameSyntax& s) { s.fingerprint[1] = std::nanf(""); }, "unsupported");
}

}  // namespace

void AddHeader(Collection& c) {
  const auto header = [&](const char* rule, const char* name, const std::function<void(SequenceHeader&)>& change,
                          const char* status = "corrupt") {
    c.Change(
        rule, name, [&](StreamParts& p) { change(p.header); }, status);
  };
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();
  header(
      "R11", "major", [](SequenceHeader& h) { h.version_major = 200; }, "unsupported");
  header(
      "R11", "minor", [](SequenceHeader& h) { h.version_minor = 200; }, "unsupported");
  header("R13", "reference_shape", [](SequenceHeader& h) { h.reference_shape = 2; });
  header("R14", "none", [](SequenceHeader& h) { h.position_bits = 0; });
  header("R14", "many", [](SequenceHeader& h) { h.position_bits = 25; });
  header("R15", "small", [](SequenceHeader& h) { h.level_growth = 63; });
  header("R15", "large", [](SequenceHeader& h) { h.level_growth = 129; });
  header("R16", "vertices", [](SequenceHeader& h) { h.vertices = h.harmonics = 0; });
  header("R17", "harmonics", [](SequenceHeader& h) { h.harmonics = 0; });
  header("R18", "harmonics", [](SequenceHeader& h) { h.harmonics = 5; });
  header("R19", "denominator", [](SequenceHeader& h) { h.frame_rate_denominator = 0; });
  header("R20", "nan", [](SequenceHeader& h) { h.origin_x = kNan; });
  header("R20", "infinity", [](SequenceHeader& h) { h.origin_z = -kInfinity; });
  header("R21", "cell", [](SequenceHeader& h) { h.cell = 0; });
  header("R21", "motion", [](SequenceHeader& h) { h.motion_step = -1; });
  header("R21", "displacement", [](SequenceHeader& h) { h.displacement_step = kInfinity; });
  header("R21", "rotation", [](SequenceHeader& h) { h.rotation_step = kNan; });
  header("R21", "translation", [](SequenceHeader& h) { h.translation_step = 0; });
  header("R61", "none", [](SequenceHeader& h) { h.patch_size = 0; });
  header("R61", "many", [](SequenceHeader& h) { h.patch_size = 1025; });
  header("R62", "detail", [](SequenceHeader& h) { h.detail_step = -1; });
  header("R62", "correction", [](SequenceHeader& h) { h.correction_step = kNan; });
  header("R68", "nan", [](SequenceHeader& h) { h.offset_y = std::numeric_limits<double>::quiet_NaN(); });
  header("R68", "infinity", [](SequenceHeader& h) { h.offset_x = -std::numeric_limits<double>::infinity(); });
  c.ChangePackets("R68", "zero", [](auto& packets) { packets[0].second.insert(packets[0].second.end(), 24, 0); });
  c.ChangePackets("R12", "offset", [](auto& packets) { packets[0].second.insert(packets[0].second.end(), 16, 1); });
  header("R74", "copies", [](SequenceHeader& h) { h.copies = 7; });
  header(
      "R22", "copies",
      [](SequenceHeader& h) {
        h.triangles = 2'000'000;
        h.copies = 3'999'997;
      },
      "limit");
  header(
      "R22", "vertices", [](SequenceHeader& h) { h.vertices = 4'000'001; }, "limit");
  header(
      "R23", "triangles", [](SequenceHeader& h) { h.triangles = 8'000'001; }, "limit");
}

void AddIFrame(Collection& c) {
  AddIFrameLists(c);
  AddCopies(c);
  AddScales(c);
  AddShape(c);
  AddFingerprint(c);
}

}  // namespace sac
