// SPDX-License-Identifier: Apache-2.0
#include "bench/sweep/child_process.h"

#include <fcntl.h>
#include <malloc.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>

namespace sac {
namespace {

// A file without a name for the output of a program. Unlike a pipe it is never full.
class Capture {
 public:
  Capture() : fd_(memfd_create("output", MFD_CLOEXEC)) {}
  ~Capture() {
    if (fd_ >= 0) close(fd_);
  }
  Capture(const Capture&) = delete;
  Capture& operator=(const Capture&) = delete;

  int fd() const { return fd_; }

  std::string Text() const {
    std::string text;
    char bytes[4096];
    for (ssize_t n = 0; (n = pread(fd_, bytes, sizeof bytes, static_cast<off_t>(text.size()))) > 0;) {
      text.append(bytes, static_cast<std::size_t>(n));
    }
    return text;
  }

 private:
  int fd_;
};

// Turns the forked process into the program. It must not lock or allocate, since this process has threads.
[[noreturn]] void Become(char* const* arguments, int out, int err) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  std::signal(SIGPIPE, SIG_DFL);
  const int in = open("/dev/null", O_RDONLY);
  if (in >= 0 && dup2(in, STDIN_FILENO) >= 0 && dup2(out, STDOUT_FILENO) >= 0 && dup2(err, STDERR_FILENO) >= 0) {
    execv(arguments[0], arguments);
  }
  _exit(127);
}

std::string LastLine(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  const std::size_t end = text.rfind('\n');
  return end == std::string::npos ? text : text.substr(end + 1);
}

double Seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

Status Outcome(const std::string& program, int status, const std::string& errors) {
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return Status::Ok();
  if (WIFEXITED(status) && WEXITSTATUS(status) == 127 && errors.empty()) {
    return Status::IoError(program + ": cannot be run");
  }
  std::string reason = LastLine(errors);
  if (reason.empty()) {
    reason = program + ": " +
             (WIFSIGNALED(status) ? std::string("ended by ") + strsignal(WTERMSIG(status))
                                  : "failed with code " + std::to_string(WEXITSTATUS(status)));
  }
  return Status::InvalidArgument(reason);
}

}  // namespace

Status RunProcess(const std::vector<std::string>& command, ProcessUsage& usage, std::string& output) {
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const Capture out, err;
  if (out.fd() < 0 || err.fd() < 0) return Status::IoError(command.front() + ": " + std::strerror(errno));
  const auto start = std::chrono::steady_clock::now();
  const pid_t child = fork();
  if (child == 0) Become(arguments.data(), out.fd(), err.fd());
  if (child < 0) return Status::IoError(command.front() + ": " + std::strerror(errno));
  int status = 0;
  rusage used{};
  while (wait4(child, &status, 0, &used) < 0) {
    if (errno != EINTR) return Status::IoError(command.front() + ": " + std::strerror(errno));
  }
  usage.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  usage.cpu_seconds = Seconds(used.ru_utime) + Seconds(used.ru_stime);
  usage.peak_mb = static_cast<double>(used.ru_maxrss) * 1024 / 1e6;
  output = out.Text();
  return Outcome(command.front(), status, err.Text());
}

void ForgetPeakMemory() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << 5;
}

}  // namespace sac
