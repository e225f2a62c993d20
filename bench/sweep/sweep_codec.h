// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "sac/status.h"

namespace sac {

// A codec of a sweep: a program that is called
//   PROGRAM encode MESH.obj CLIP.pc2 -o STREAM --order-map MAP OPTION...
//   PROGRAM decode STREAM -o DECODED.pc2 --order-map MAP
// as sac itself is. All that the decoder needs is in STREAM; MAP only says which decoded vertex is which, to measure.
struct SweepCodec {
  std::string name;     // without blanks, as in --peers
  std::string title;    // for people
  std::string version;  // of the codec
  std::string missing;  // why it cannot be run; empty when it can
  std::string program;
  std::string program_key;  // of its bytes
  // A point of its curve: what it is called, and its options.
  struct Setting {
    std::string name;
    std::vector<std::string> options;
  };
  std::vector<Setting> settings;
};

// What `sac sweep --peers` knows, in the order of a report: names of programs sac-peer-NAME.
const std::vector<std::string>& PeerNames();

// sac itself, the command `program`: a curve of qualities, one of bounds on the error (in diagonals) where there are
// any, and for each of `variants`, words of options for `sac encode`, one more curve of the qualities.
Status SacCodecs(const std::string& program, const std::vector<std::string>& qualities,
                 const std::vector<std::string>& max_errors, const std::vector<std::string>& variants,
                 std::vector<SweepCodec>& codecs);

// The peer of a name, asked what it is and which settings it has (`PROGRAM describe`). A program that is neither in
// `directory`, where that is given, nor beside this program nor where a build has it makes a codec that is missing.
SweepCodec FindPeer(const std::string& name, const std::string& directory);

}  // namespace sac
