// SPDX-License-Identifier: Apache-2.0
#include "conformance/invalid_collection.h"

namespace sac {

void AddGroups(Collection& c) {
  const auto nothing = [](std::uint32_t, FrameSyntax&) {};
  c.ChangeGroup("R48", "frames", 4097, 1, nothing, 0, "limit");
  c.Change(
      "R63", "coefficients",
      [](StreamParts& p) {  // 4,096 frames of 2,731 vertices, each a component with its harmonic
        p.header.vertices = p.header.harmonics = 2731;
        p.header.triangles = 0;
        p.header.detail_step = p.header.correction_step = 0;
        p.i_frame.loose_vertices.assign(2731, p.i_frame.loose_vertices[0]);
        p.i_frame.loose_triangles.clear();
        p.i_frame.harmonics.assign(2731, 1);
        Derive(p);
        p.groups = {CodeGroup(p, 4096, 1, [](std::uint32_t, FrameSyntax&) {})};
        p.frames = 4096;
      },
      "limit");
  c.ChangeGroup("R50", "pyramid", 3, 2, nothing, 1);
  c.ChangeGroup("R51", "distance", 3, 1, [](std::uint32_t i, FrameSyntax& f) {
    if (i == 2) f.slot.references = {0xffffffffu};  // a distance of 2
  });
  c.ChangeGroup("R51", "far", 3, 1, [](std::uint32_t i, FrameSyntax& f) {
    if (i == 2) f.slot.references = {1, 0u - 1000u};
  });
  c.ChangeGroup("R52", "motion", 1, 1, [](std::uint32_t, FrameSyntax& f) { f.planes[kMotion][5] = (1 << 20) + 1; });
  c.ChangeGroup("R52", "displacement", 1, 1,
                [](std::uint32_t, FrameSyntax& f) { f.planes[kDisplacement][8] = -(1 << 20) - 1; });
  c.ChangeGroup("R52", "detail", 1, 1, [](std::uint32_t, FrameSyntax& f) { f.planes[kDetail][0] = 1 << 21; });
  c.ChangeGroup("R52", "correction", 1, 1,
                [](std::uint32_t, FrameSyntax& f) { f.planes[kCorrection][0] = -(1 << 21); });
  c.ChangeGroup("R53", "rotation", 1, 1, [](std::uint32_t, FrameSyntax& f) { f.rigid[1] = (1 << 28) + 1; });
  c.ChangeGroup("R53", "translation", 1, 1, [](std::uint32_t, FrameSyntax& f) { f.rigid[5] = -(1 << 30); });
  c.ChangeGroup(
      "R54", "two", 3, 1,
      [](std::uint32_t i, FrameSyntax& f) {
        if (i == 2) f.slot.references = {1, 1};
      },
      1);
  c.ChangeGroup(
      "R54", "earlier", 3, 1,
      [](std::uint32_t i, FrameSyntax& f) {
        if (i == 2) f.slot.references = {0};
      },
      1);
  c.ChangeGroup("R55", "motion", 17, 1, [](std::uint32_t, FrameSyntax& f) { f.planes[kMotion][0] = 1 << 20; });
  c.Change("R57", "position", [](StreamParts& p) {
    p.header.translation_step = 1e38f;
    p.groups = {CodeGroup(p, 1, 1, [](std::uint32_t, FrameSyntax& f) { f.rigid[3] = 4; })};
    p.frames = 1;
  });
  c.ChangeGroup("R55", "rigid", 2, 1, [](std::uint32_t, FrameSyntax& f) { f.rigid[0] = -(1 << 27) - 1; });
}

std::vector<InvalidVector> InvalidVectors() {
  Collection c;
  AddPackets(c);
  AddRecords(c);
  AddHeader(c);
  AddIFrame(c);
  AddDraco(c);
  AddGroups(c);
  return std::move(c.vectors);
}

}  // namespace sac
