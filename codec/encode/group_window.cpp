// SPDX-License-Identifier: Apache-2.0
#include "codec/encode/group_window.h"

#include <algorithm>
#include <new>
#include <utility>

#include "codec/decode/run_jobs.h"
#include "codec/encode/contain.h"
#if SAC_HAS_THREADS
#include <thread>
#endif

namespace sac {
namespace {

// What the frames of groups that wait for each other may take, in bytes. One group may always wait.
constexpr std::uint64_t kWaiting = std::uint64_t{2} << 30;

// A place of each thread's own, by which it is known.
thread_local const char kHere = 0;

// The range codes of a group's frames, one for each layer. False when a value leaves the range of the format; `failed`
// is then the frame, by time.
bool CodeLayers(const EncodedStart& start, const std::vector<FrameSlot>& structure, std::vector<FrameSyntax>& coded,
                ClosedGroup& group) {
  FrameCoder<RangeEncoder> coder(start.header, start.shape.layouts);
  std::vector<GroupLayer> layers = {{0, structure.size(), kMotion}};
  const bool layered = group.syntax.layered();
  if (layered) layers = LayersOf(structure, group.syntax.base_levels, start.shape.layouts);
  for (const GroupLayer& layer : layers) {
    RangeEncoder range;
    for (std::size_t i = layer.first; i < layer.end; ++i) {
      const bool good = !layered             ? coder.Code(range, structure[i], coded[i], &group.bits)
                        : layer.has_frames() ? coder.CodeBase(range, structure[i], coded[i], &group.bits)
                                             : coder.CodeLater(range, i, layer.plane, coded[i], &group.bits);
      group.failed_frame = structure[i].display;
      if (!good) return false;
    }
    group.codes.push_back(range.Finish());
  }
  return true;
}

}  // namespace

unsigned ThreadsOf(const EncoderSettings& settings) {
#if SAC_HAS_THREADS
  if (settings.threads == 0) return std::max(1u, std::thread::hardware_concurrency());
#else
  if (!settings.run_jobs) return 1;
#endif
  return std::max(1u, settings.threads);
}

// The groups that are coded at the same time.
struct GroupWindow::Run {
  const std::function<bool(std::uint32_t)>& progress;
  const char* const caller = &kHere;
  std::atomic<std::size_t> next{0};
  std::atomic<std::size_t> first_failed{0};  // the first of the groups that are known to have failed
  std::atomic<std::uint32_t> frames{0};      // coded
  std::atomic<bool> cancelled{false};
  std::uint32_t told = 0;  // frames that `progress` knows of

  void Fail(std::size_t index) {
    std::size_t first = first_failed;
    while (index < first && !first_failed.compare_exchange_weak(first, index)) {
    }
  }
  void Tell() {
    if (const std::uint32_t coded = frames; coded > std::exchange(told, coded) && !progress(coded)) cancelled = true;
  }
};

GroupWindow::GroupWindow(const EncodedStart& start, const Projection& projection, const EncoderSettings& settings)
    : start_(start), projection_(projection), settings_(settings), encoders_(ThreadsOf(settings)) {
  const std::uint64_t group = std::uint64_t{sizeof(Vec3f)} * start.header.vertices * start.groups.group;
  capacity_ = static_cast<std::size_t>(std::clamp<std::uint64_t>(kWaiting / group, 1, encoders_.size()));
}

void GroupWindow::Add(std::vector<Positions> frames, bool goes_on) {
  ClosedGroup& group = groups_.emplace_back();
  const bool previous = start_.header.references_previous();
  group.syntax.frames = static_cast<std::uint32_t>(frames.size());
  // A pyramid larger than the group is as one of its size.
  group.syntax.pyramid = previous ? 1 : std::min(start_.groups.pyramid, group.syntax.frames);
  group.syntax.base_levels = previous ? 0 : start_.groups.base_levels;
  group.frames = std::move(frames);
  group.goes_on = goes_on;
}

Status GroupWindow::EncodeGroup(Run& run, std::size_t index, GroupEncoder& encoder) {
  ClosedGroup& group = groups_[index];
  std::vector<FrameSlot> structure = GroupStructure(group.syntax.frames, group.syntax.pyramid);
  if (group.syntax.layered()) structure = LayeredOrder(structure, group.syntax.base_levels);
  const auto frame_done = [&](std::uint32_t) {
    ++run.frames;
    if (&kHere == run.caller) run.Tell();
    return run.cancelled || run.first_failed < index ? Status::Cancelled() : Status::Ok();
  };
  std::vector<FrameSyntax> coded;
  Status status = encoder.Encode(std::exchange(group.frames, {}), structure, group.goes_on, frame_done, coded);
  if (!status.ok()) {
    group.failed_frame = encoder.failed_frame();
    group.failed_vertex = encoder.failed_vertex();
    return status;
  }
  return CodeLayers(start_, structure, coded, group) ? Status::Ok() : MotionTooFar();
}

void GroupWindow::EncodeSome(Run& run, std::size_t job) {
  for (std::size_t i = run.next++; i < groups_.size(); i = run.next++) {
    Status status = Status::Cancelled();
    if (!run.cancelled && run.first_failed > i) {
      status = Contain([&] {
        std::unique_ptr<GroupEncoder>& encoder = encoders_[job];
        if (!encoder) {
          encoder = std::make_unique<GroupEncoder>(start_.shape, start_.header, start_.max_error, projection_);
        }
        return EncodeGroup(run, i, *encoder);
      });
    }
    if (!status.ok()) run.Fail(i);
    groups_[i].status = std::move(status);
  }
}

Status GroupWindow::Encode(const std::function<bool(std::uint32_t)>& progress, std::vector<ClosedGroup>& groups) {
  Run run{progress};
  run.first_failed = groups_.size();
  const std::size_t jobs = std::min(encoders_.size(), groups_.size());
  const auto job = [&](std::size_t j) {
    if (j < jobs) EncodeSome(run, j);
  };
  Status status;
  if (!settings_.run_jobs || jobs == 1) {
    RunOnThreads(jobs, job);
  } else {
    try {
      settings_.run_jobs(jobs, job);
      // A runner that leaves jobs out has others do their groups, but one of them has to be run.
      if (run.next < groups_.size()) status = Status::InvalidArgument("run_jobs has left all jobs out");
    } catch (const std::bad_alloc&) {
      status = Status::Limit("out of memory");
    } catch (...) {  // the caller's code may throw anything
      status = Status::InvalidArgument("run_jobs threw an exception");
    }
  }
  groups = std::exchange(groups_, {});
  SAC_RETURN_IF_ERROR(status);
  if (jobs > 1 && run.first_failed == groups.size()) run.Tell();
  return run.cancelled ? Status::Cancelled() : Status::Ok();
}

}  // namespace sac
