// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "bench/sweep/child_process.h"
#include "bench/sweep/sweep_clip.h"
#include "bench/sweep/sweep_codec.h"
#include "bench/sweep/sweep_report.h"
#include "bench/sweep/sweep_run.h"
#include "cli/commands.h"
#include "cli/number_option.h"
#include "cli/program.h"
#include "sac/version.h"

namespace sac {
namespace {

namespace fs = std::filesystem;

struct SweepOptions {
  std::vector<std::string> inputs;
  std::string output, sac;
  std::string peers = "none", peer_directory;
  std::string qualities = "0,10,25,40,50,60,70,80,90,100", max_errors;
  std::vector<std::string> also;
  bool keep = false, force = false;
  unsigned jobs = std::max(1u, std::thread::hardware_concurrency());
};

std::vector<std::string> Items(const std::string& list) {
  std::vector<std::string> items;
  std::istringstream in(list);
  for (std::string item; std::getline(in, item, ',');) {
    if (!item.empty()) items.push_back(item);
  }
  return items;
}

Status CheckNumbers(const std::string& option, const std::string& list, double low, double high) {
  for (const std::string& item : Items(list)) {
    double value = 0;
    const char* end = item.data() + item.size();
    const auto result = std::from_chars(item.data(), end, value);
    if (result.ec == std::errc() && result.ptr == end && value >= low && value <= high) continue;
    std::ostringstream reason;
    reason << option << ": '" << item << "' is not a number from " << low << " to " << high;
    return Status::InvalidArgument(reason.str());
  }
  return Status::Ok();
}

Status CheckOptions(SweepOptions& options) {
  SAC_RETURN_IF_ERROR(CheckNumbers("--qualities", options.qualities, 0, 100));
  SAC_RETURN_IF_ERROR(CheckNumbers("--max-errors", options.max_errors, 1e-30, 1e30));
  if (Items(options.qualities).empty()) return Status::InvalidArgument("--qualities: none");
  if (options.peers == "all" || options.peers == "none") return Status::Ok();
  const std::vector<std::string>& known = PeerNames();
  for (const std::string& name : Items(options.peers)) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    std::string names;
    for (const std::string& other : known) names += " " + other;
    return Status::InvalidArgument("--peers: '" + name + "' is not one of all, none," + names);
  }
  return Status::Ok();
}

// The directory of a report, locked so that only one sweep writes there at a time.
class ReportDirectory {
 public:
  ~ReportDirectory() {
    std::error_code ignored;
    if (fd_ < 0) return;
    fs::remove_all(work(), ignored);
    fs::remove(results(), ignored);  // when nothing was measured
    if (created_) fs::remove(path_, ignored);
    close(fd_);
  }

  // Reports of which there are no results are somebody else's: they are replaced with `force` alone.
  Status Open(const std::string& path, bool force) {
    std::error_code error;
    for (const char* name : {"sweep.html", "sweep.csv", "sweep.json"}) {
      if (force || fs::exists(path + "/results", error) || !fs::exists(path + "/" + name, error)) continue;
      return Status::InvalidArgument(path + "/" + name +
                                     ": is there already, without results of a sweep beside it; give another directory "
                                     "for the output, or --force");
    }
    created_ = fs::create_directories(path, error);
    if (error) return Status::IoError(path + ": " + error.message());
    path_ = fs::absolute(path).lexically_normal().string();
    const int fd = open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (fd < 0) return Status::IoError(path + ": Not a directory");
    if (flock(fd, LOCK_EX | LOCK_NB) != 0) {
      close(fd);
      return Status::IoError(path + ": another sweep is writing there");
    }
    fd_ = fd;
    fs::remove_all(work(), error);  // left by a sweep that was interrupted
    for (const std::string& directory : {results(), work()}) {
      fs::create_directories(directory, error);
      if (error) return Status::IoError(directory + ": " + error.message());
    }
    return Status::Ok();
  }

  const std::string& path() const { return path_; }
  std::string results() const { return path_ + "/results"; }
  std::string work() const { return path_ + "/.sac-sweep-work"; }

 private:
  std::string path_;
  int fd_ = -1;
  bool created_ = false;
};

Status RunAndReport(const SweepOptions& options) {
  ReportDirectory directory;
  SAC_RETURN_IF_ERROR(directory.Open(options.output, options.force));
  Sweep sweep;
  sweep.jobs = options.jobs;
  for (const std::vector<std::string>& inputs : ClipsOf(options.inputs)) {
    SAC_RETURN_IF_ERROR(PrepareClip(inputs, directory.work(), sweep.clips.emplace_back()));
  }
  SAC_RETURN_IF_ERROR(
      SacCodecs(options.sac, Items(options.qualities), Items(options.max_errors), options.also, sweep.codecs));
  if (options.peers != "none") {
    for (const std::string& name : options.peers == "all" ? PeerNames() : Items(options.peers)) {
      sweep.codecs.push_back(FindPeer(name, options.peer_directory));
      const SweepCodec& peer = sweep.codecs.back();
      if (!peer.missing.empty()) std::printf("%s is missing: %s\n", name.c_str(), peer.missing.c_str());
    }
  }
  ForgetPeakMemory();
  SAC_RETURN_IF_ERROR(RunSweep(sweep.clips, sweep.codecs, {directory.results(), directory.work(), options.keep},
                               options.jobs, sweep.results));
  SAC_RETURN_IF_ERROR(WriteReport(sweep, directory.path()));
  const auto failed = std::count_if(sweep.results.begin(), sweep.results.end(),
                                    [](const SweepResult& result) { return !result.error.empty(); });
  std::printf("%zu results, %zd failed: %s/sweep.html, sweep.csv, sweep.json\n", sweep.results.size(),
              static_cast<std::ptrdiff_t>(failed), options.output.c_str());
  return Status::Ok();
}

// The path of the `sac` command of the same build or installation as this program, or "sac" if there is none.
std::string FindSac() {
  const fs::path here = fs::path(ThisProgram()).parent_path();
  for (const char* place : {"../../bin/sac", "../../cli/sac", "sac"}) {
    std::error_code error;
    if (fs::is_regular_file(here / place, error)) return fs::weakly_canonical(here / place).string();
  }
  return "sac";
}

std::vector<Command> AddSweep(CLI::App& app) {
  auto options = std::make_shared<SweepOptions>();
  app.name("sac sweep");
  app.description("Measure rate and distortion over a range of settings, beside peers.");
  app.set_version_flag("--version", "sac-sweep " SAC_VERSION_STRING);
  CLI::App* command = &app;
  options->sac = FindSac();
  command->add_option("--sac", options->sac, "the sac that is measured [the one that was called]")
      ->option_text("PROGRAM");
  command->add_option("INPUT", options->inputs, "clips as for encode, one after the other; geometry alone is coded")
      ->required()
      ->option_text("...");
  command
      ->add_option("-o,--output", options->output,
                   "a directory for sweep.html, sweep.csv, sweep.json and the results; a sweep into the same directory "
                   "measures only what is not there yet")
      ->required()
      ->option_text("DIRECTORY");
  command->add_flag("--force", options->force, "replace reports in the directory that no sweep has left there");
  command
      ->add_option("--peers", options->peers,
                   "other codecs, with commas between: all, none or names of the footer [none]")
      ->option_text("LIST");
  command
      ->add_option("--peer-directory", options->peer_directory,
                   "where their programs are [beside sac-sweep, or in its build]")
      ->option_text("DIRECTORY");
  command->add_option("--qualities", options->qualities, "of sac [" + options->qualities + "]")->option_text("LIST");
  command
      ->add_option("--max-errors", options->max_errors,
                   "also bounds on the error, in diagonals of the first frame's box [none]")
      ->option_text("LIST");
  command
      ->add_option("--also", options->also,
                   "options of encode, in one word, for one more curve of the qualities: \"--reference previous\"; may "
                   "be given several times")
      ->option_text("OPTIONS")
      ->take_all()
      ->expected(1);
  command->add_flag("--keep", options->keep,
                    "keep streams and decoded clips in results/, as KEY.stream and KEY.decoded.pc2");
  AddNumber(*command, "--jobs", options->jobs, 1u, 256u, "settings measured at a time [one a processor]");
  std::string peers;
  for (const std::string& name : PeerNames()) peers += " " + name;
  command->footer(
      "Every setting of every codec is encoded by one process and decoded by another, which get nothing but files; "
      "all\n"
      "bytes count. Times are of those processes, with reading and writing.\n"
      "Peers:" +
      peers +
      "\n\n"
      "Examples:\n"
      "  sac sweep body.obj walk.pc2 -o report\n"
      "  sac sweep body.obj walk.pc2 scan_%04d.ply -o report --peers all\n"
      "  sac sweep body.obj walk.pc2 -o report --qualities 30,50,70 --also \"--reference previous\"\n");
  return {{command, [options] { return CheckOptions(*options); }, [options] { return RunAndReport(*options); }}};
}

}  // namespace
}  // namespace sac

int main(int argc, char** argv) { return sac::RunProgram(argc, argv, sac::AddSweep); }
