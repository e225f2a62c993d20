// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "sac/status.h"

namespace sac {

// A codec of a sweep: a program that is called
//   PROGRAM encode MESH.obj CLIP.pc2 -o STREAM --order-map MAP OPTION...
//   PROGRAM decode STREAM -o DECODED.pc2 --order-map MAP
// like sac itself. The decoder gets only STREAM; MAP says which vertex each decoded one is, for measuring.
struct SweepCodec {
  std::string name;     // without blanks, as in --peers
  std::string title;    // the name to show
  std::string version;  // version of the codec
  std::string missing;  // why the codec cannot be run; empty when it can
  std::string program;
  std::string program_key;  // key of the program's bytes
  // A point of the codec's curve: its name and its options.
  struct Setting {
    std::string name;
    std::vector<std::string> options;
  };
  std::vector<Setting> settings;
};

// The names that `sac sweep --peers` takes, in the order of a report. Each stands for a program sac-peer-NAME.
const std::vector<std::string>& PeerNames();

// Lists the curves of sac itself, which is the command `program`: one of qualities, one of bounds on the error (as
// fractions of the diagonal) where `max_errors` has any, and one of the qualities for each of `variants`, which are
// further options for `sac encode`.
Status SacCodecs(const std::string& program, const std::vector<std::string>& qualities,
                 const std::vector<std::string>& max_errors, const std::vector<std::string>& variants,
                 std::vector<SweepCodec>& codecs);

// Finds the program of a peer and asks it for its title and settings (`PROGRAM describe`). The program is looked for in
// `directory` if that is given, otherwise beside this program and where a build has it. When it is not found, the
// result says so in `missing`.
SweepCodec FindPeer(const std::string& name, const std::string& directory);

}  // namespace sac
