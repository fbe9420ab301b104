// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include "jobs/executor.hpp"

namespace kelpie::jobs {

/// Makes the executor of a command: threads (0: a thread per core). Throws InputError if mpirun or
/// srun has started several processes together, so that several processes never repeat the whole
/// work each.
std::unique_ptr<Executor> make_executor(std::size_t threads);

/// Starter and number of processes started together.
struct Start {
  std::string by;  ///< name for messages
  std::size_t processes = 1;
};

/// Start according to the environment; `variable` returns null for an unset variable.
Start start_of(const std::function<const char*(const char*)>& variable);

}  // namespace kelpie::jobs
