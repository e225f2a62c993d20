#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cli/error_option.h"
#include "files/clip_input.h"
#include "files/output_file.h"
#include "metrics/error_meter.h"
#include "rate_control/target_search.h"
#include "sac/encoder.h"
#include "sac/status.h"

namespace sac {

// Encodes a clip and writes the stream; decodes it again as it comes, and measures it against the input, unless that is
// not wanted. Memory holds the frames of a group.
class CheckedEncoding {
 public:
  struct Settings {
    std::vector<std::string> inputs;  // as for ClipInput
    std::string output;               // `-` is standard output
    std::string order_map;            // where the order of the vertices goes; empty: nowhere
    // Without a frame rate that of the input is taken.
    EncoderSettings encoder;
    std::optional<ErrorLength> max_error;  // becomes the encoder's
    RateTargets targets;                   // where there is one, the encoder's steps and bits are searched for it
    bool unchecked = false;                // neither decode nor measure: the distortion stays zero
  };

  explicit CheckedEncoding(const Settings& settings) : settings_(settings) {}

  // The files get their names at the end. Every message names a file.
  Status Run();

  // Afterwards, what has come out.
  const EncoderSettings& encoder_settings() const { return settings_.encoder; }
  const StreamInfo& info() const { return encoder_->info(); }
  const StreamBytes& parts() const { return encoder_->stream_bytes(); }
  std::uint64_t bytes() const { return bytes_; }
  std::uint32_t frames() const { return sent_; }
  const DistortionMetrics& distortion() const { return distortion_; }
  // The input's texture coordinates could not be coded: the stream has none.
  bool lost_texture_coordinates() const { return lost_texture_coordinates_; }
  // That were made to find the settings.
  std::uint32_t trials() const { return trials_; }

 private:
  Status Open();
  Status Search();
  Status Check();
  Status EncodeAll();
  Status EncodeUntilBytes(std::span<const std::uint8_t>& chunk);
  Status AtInput(const std::string& where, const Status& status) const;

  Settings settings_;
  std::unique_ptr<ClipInput> input_;
  std::unique_ptr<Encoder> encoder_;
  OutputFile stream_, order_map_;
  std::vector<std::uint8_t> chunk_;
  std::uint64_t bytes_ = 0;
  std::uint32_t trials_ = 0;
  bool lost_texture_coordinates_ = false;
  bool finished_ = false;
  std::uint32_t sent_ = 0;
  std::deque<Positions> undecoded_;  // frames sent that have not come back yet
  DistortionMetrics distortion_;
};

}  // namespace sac
