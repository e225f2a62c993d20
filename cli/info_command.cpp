// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "cli/commands.h"
#include "cli/distortion_report.h"
#include "cli/stream_summary.h"
#include "files/stream_input.h"

namespace sac {
namespace {

struct InfoOptions {
  std::string input;
  bool json = false;
};

template <class Float>
std::string ShortestText(Float value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::size_t GroupCount(const StreamSummary& summary) {
  std::size_t groups = 0;
  for (const PacketSummary& packet : summary.packets) groups += packet.type == PacketType::kGroup;
  return groups;
}

// Seconds, where the stream has a frame rate.
std::optional<double> Duration(const StreamSummary& summary) {
  if (!summary.header || summary.header->frame_rate_numerator == 0) return std::nullopt;
  return static_cast<double>(summary.frames) / summary.header->frames_per_second();
}

std::vector<std::string> Attributes(const IFrameSummary& i_frame) {
  std::vector<std::string> names;
  if (i_frame.texture_coordinates) names.push_back("texture_coordinates");
  if (i_frame.normals) names.push_back("normals");
  if (i_frame.colors) names.push_back("colors");
  return names;
}

// Calls visit(name, value) for each field, the offset's too where there is one.
template <class Visitor>
void VisitAll(const SequenceHeader& header, Visitor&& visit) {
  VisitFields(header, visit);
  if (header.has_offset()) VisitOffset(header, visit);
}

void PrintHeader(const SequenceHeader& header) {
  VisitAll(header, [](const char* name, const auto& value) {
    if constexpr (std::is_floating_point_v<std::decay_t<decltype(value)>>) {
      std::printf("%-24s %s\n", name, ShortestText(value).c_str());
    } else {
      std::printf("%-24s %u\n", name, static_cast<unsigned>(value));
    }
  });
}

// What a stream says of its clip, as far as it does.
Json Describe(const Metadata& metadata) {
  Json json = Json::object();
  if (!metadata.name.empty()) json["name"] = metadata.name;
  if (metadata.metres_per_unit) json["metres_per_unit"] = *metadata.metres_per_unit;
  if (metadata.up_axis) json["up_axis"] = std::string(1, static_cast<char>('x' + *metadata.up_axis));
  if (metadata.first_frame) json["first_frame"] = *metadata.first_frame;
  if (metadata.loops) json["loops"] = *metadata.loops;
  if (!metadata.json.empty()) {
    const Json parsed = Json::parse(metadata.json, nullptr, false);
    json["author"] = parsed.is_discarded() ? Json(metadata.json) : parsed;
  }
  if (metadata.bounds) json["bounds"] = {metadata.bounds->low, metadata.bounds->high};
  return json;
}

// Text of a stranger as one line that moves no cursor.
std::string Printable(const std::string& text) {
  std::string out = text;
  for (char& c : out) {
    if (static_cast<unsigned char>(c) < 32 || c == 127) c = ' ';
  }
  return out;
}

void PrintText(const std::string& name, const StreamSummary& summary) {
  std::printf("%s: %llu bytes\n", name.c_str(), static_cast<unsigned long long>(summary.bytes));
  if (summary.header) PrintHeader(*summary.header);
  if (summary.i_frame) {
    std::string attributes;
    for (const std::string& attribute : Attributes(*summary.i_frame)) attributes += attribute + " ";
    std::printf("%-24s %zu\n", "components", summary.i_frame->components);
    std::printf("%-24s %s\n", "attributes", attributes.empty() ? "none" : attributes.c_str());
    std::printf("%-24s %s\n", "order", summary.i_frame->order ? "the input's" : "the stream's own");
  }
  std::printf("%-24s %llu\n", "frames", static_cast<unsigned long long>(summary.frames));
  std::printf("%-24s %zu\n", "groups", GroupCount(summary));
  if (summary.segments > 1) std::printf("%-24s %u\n", "segments", summary.segments);
  std::printf("%-24s %s\n", "index", summary.has_index ? "yes" : "no");
  const Json metadata = Describe(summary.metadata);
  for (auto entry = metadata.begin(); entry != metadata.end(); ++entry) {
    const Json& value = entry.value();
    const std::string text = value.is_string() ? value.get<std::string>() : JsonLine(value);
    std::printf("%-24s %s\n", entry.key().c_str(), Printable(text).c_str());
  }
  if (const auto seconds = Duration(summary)) std::printf("%-24s %.6g seconds\n", "duration", *seconds);
  for (const PacketSummary& packet : summary.packets) {
    std::printf("packet %-8s %10llu bytes", NameOf(packet.type), static_cast<unsigned long long>(packet.bytes));
    if (packet.type == PacketType::kGroup) {
      std::printf(" %6u frames%s", packet.frames, packet.low_delay ? ", low delay" : "");
      if (packet.layers > 0) std::printf(", %u layers", packet.layers);
      if (summary.segments > 1) std::printf(", segment %u", packet.segment);
    }
    std::printf("\n");
  }
}

Json ToJson(const StreamSummary& summary, const Status& status) {
  Json json;
  json["bytes"] = summary.bytes;
  json["complete"] = status.ok();
  if (!status.ok()) json["error"] = status.message();
  if (summary.header) {
    // A float through its shortest text, so that 0.1f is 0.1.
    VisitAll(*summary.header, [&json](const char* name, const auto& value) {
      if constexpr (std::is_floating_point_v<std::decay_t<decltype(value)>>) {
        json["header"][name] = Json::parse(ShortestText(value));
      } else {
        json["header"][name] = value;
      }
    });
  }
  if (summary.i_frame) {
    json["components"] = summary.i_frame->components;
    json["attributes"] = Attributes(*summary.i_frame);
    json["keeps_order"] = summary.i_frame->order;
  }
  json["frames"] = summary.frames;
  json["groups"] = GroupCount(summary);
  json["segments"] = summary.segments;
  json["index"] = summary.has_index;
  if (!summary.metadata.empty()) json["metadata"] = Describe(summary.metadata);
  const auto seconds = Duration(summary);
  json["duration"] = seconds ? Json(*seconds) : Json();
  json["packets"] = Json::array();
  for (const PacketSummary& packet : summary.packets) {
    Json& entry = json["packets"].emplace_back();
    entry["type"] = NameOf(packet.type);
    entry["bytes"] = packet.bytes;
    if (packet.type != PacketType::kGroup) continue;
    entry["frames"] = packet.frames;
    entry["low_delay"] = packet.low_delay;
    entry["layers"] = packet.layers;
    entry["segment"] = packet.segment;
  }
  return json;
}

Status Info(const InfoOptions& options) {
  StreamInput input;
  SAC_RETURN_IF_ERROR(input.Open(options.input));
  StreamSummary summary;
  Status status = Summarize(input, summary);
  if (options.json) {
    std::fputs(JsonLine(ToJson(summary, status)).c_str(), stdout);
  } else if (status.ok() || summary.header) {
    PrintText(input.name(), summary);
  }
  return status;
}

}  // namespace

Command AddInfoCommand(CLI::App& app) {
  auto options = std::make_shared<InfoOptions>();
  CLI::App* command = app.add_subcommand("info", "Tell what a stream holds, without decoding its frames.");
  command->add_option("STREAM", options->input, "the stream to read; - is standard input")
      ->required()
      ->option_text(" ");
  command->add_flag("--json", options->json, "print one JSON object");
  command->footer(
      "Steps are in radians (motion, rotation) and in model units (displacement, translation, cell). Of a damaged or\n"
      "truncated stream all is told that comes before the damage; the exit code is 1 then.\n\n"
      "Example:\n"
      "  sac info clip.sac\n");
  return {command, [] { return Status::Ok(); }, [options] { return Info(*options); }};
}

}  // namespace sac
