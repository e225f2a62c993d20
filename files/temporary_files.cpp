// SPDX-License-Identifier: Apache-2.0
#include "files/temporary_files.h"

#include <fcntl.h>
#include <pthread.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <mutex>
#include <set>
#include <thread>

namespace sac {
namespace {

struct Registry {
  std::mutex mutex;  // held while a name and its file are out of step
  std::set<std::string> paths;
};

// Never destroyed: the thread below may outlive main.
Registry& TheRegistry() {
  static Registry* registry = new Registry;
  return *registry;
}

// An ordinary thread and not a signal handler, which could neither lock nor allocate.
void WaitForSignal(sigset_t signals) {
  int number = 0;
  if (sigwait(&signals, &number) != 0) return;
  Registry& registry = TheRegistry();
  const std::lock_guard lock(registry.mutex);
  for (const std::string& path : registry.paths) unlink(path.c_str());
  std::signal(number, SIG_DFL);
  pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
  raise(number);
}

}  // namespace

void RemoveTemporaryFilesOnSignals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction action {};
    if (sigaction(number, nullptr, &action) == 0 && action.sa_handler != SIG_IGN) sigaddset(&signals, number);
  }
  TheRegistry();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::thread(WaitForSignal, signals).detach();
}

int CreateTemporaryFile(const std::string& path, int flags, mode_t mode) {
  Registry& registry = TheRegistry();
  const std::lock_guard lock(registry.mutex);
  const auto [entry, added] = registry.paths.insert(path);
  const int fd = open(path.c_str(), flags, mode);
  if (fd < 0 && added) registry.paths.erase(entry);
  return fd;
}

int RenameTemporaryFile(const std::string& path, const std::string& name) {
  Registry& registry = TheRegistry();
  const std::lock_guard lock(registry.mutex);
  const int result = std::rename(path.c_str(), name.c_str());
  if (result == 0) registry.paths.erase(path);
  return result;
}

int RemoveTemporaryFile(const std::string& path) {
  Registry& registry = TheRegistry();
  const std::lock_guard lock(registry.mutex);
  registry.paths.erase(path);
  return unlink(path.c_str());
}

}  // namespace sac
