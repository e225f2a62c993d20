// SPDX-License-Identifier: Apache-2.0
#include "cli/spliced_input.h"

#include <cstdint>
#include <span>

#include "cli/number_option.h"
#include "files/stream_input.h"

namespace sac {

Status SpliceInput(const std::string& path, const FrameSpan& wanted, StreamSplicer& splicer, CheckedStream& output) {
  StreamInput input;
  SAC_RETURN_IF_ERROR(input.Open(path));
  const auto at = [&input](const Status& s) { return Status(s.code(), input.name() + ": " + s.message()); };
  splicer.Begin(wanted);
  for (std::span<const std::uint8_t> chunk;;) {
    SAC_RETURN_IF_ERROR(input.Read(chunk));
    if (chunk.empty()) break;
    if (const Status s = splicer.Take(chunk); !s.ok()) return at(s);
    SAC_RETURN_IF_ERROR(output.Write(splicer.TakeBytes()));
  }
  const Status ended = splicer.End();
  return ended.ok() ? ended : at(ended);
}

void AddSplicing(CLI::App& app, SpliceSettings& settings, bool& check) {
  app.add_flag("!--no-index", settings.index,
               "leave out the index of groups, with which a stream of several groups ends; players seek by it");
  AddNumber(app, "--repeat-start", settings.repeat_start, 0u, 0xffffffffu,
            "write header and first frame again before every N groups, for those who join in the middle [never]");
  app.add_flag("!--unchecked", check, "do not decode what is written to see that it is sound");
}

}  // namespace sac
