// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

#include "sac/sac.h"

namespace sac {

// A JobRunner that calls the caller's C function.
struct CJobRunner {
  sac_run_jobs run;
  void* user;

  void operator()(std::size_t jobs, const std::function<void(std::size_t)>& job) const {
    const auto call = [](void* context, std::size_t i) {
      (*static_cast<const std::function<void(std::size_t)>*>(context))(i);
    };
    run(user, jobs, call, const_cast<std::function<void(std::size_t)>*>(&job));
  }
};

}  // namespace sac
