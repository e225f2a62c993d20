// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <string>

namespace sac {

// Files that are removed when the process is told to end. The functions are those of the system with the same results
// and errno; they may be called from several threads.

// From now on SIGINT, SIGTERM and SIGHUP, unless ignored so far, remove all temporary files before they end the
// process. To be called once, before there are other threads.
void RemoveTemporaryFilesOnSignals();

int CreateTemporaryFile(const std::string& path, int flags, mode_t mode);
int RenameTemporaryFile(const std::string& path, const std::string& name);
int RemoveTemporaryFile(const std::string& path);

}  // namespace sac
