// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>

#include <cstdint>
#include <vector>

namespace sac {

// Draco's own decoder of edgebreaker meshes, stopped before the attributes and before each of them, to look at counts
// that Draco would believe whatever they are (spec.md 5.1): a few hundred bytes could otherwise keep it busy for many
// seconds and take gigabytes.
class GuardedDracoDecoder : public draco::MeshEdgebreakerDecoder {
 protected:
  bool CreateAttributesDecoder(std::int32_t index) override;
  bool DecodeAllAttributes() override;

 private:
  // Whether every attribute is one of those that an I-frame may have, once and with a decoder of its own. Finds how
  // each is coded.
  bool ReadDescriptors();
  // Whether the attribute whose data come next in the buffer is predicted in a way whose counts Draco checks.
  bool CheckPrediction(std::uint8_t coding);

  draco::DecoderBuffer descriptors_;  // from there on
  std::vector<std::uint8_t> codings_;
};

}  // namespace sac
