// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include "jobs/executor.hpp"

namespace kelpie::jobs {

/// The executor of this process: ranks over MPI, one job at a time in each, if mpirun or srun has
/// started several processes together; else threads (0: one per core). At most one in a process; it
/// initialises and finalises MPI.
///
/// MPI is a plug-in, libkelpie_mpi.so, beside the program or where `cmake --install` puts it.
/// Throws InputError, so that several processes never do the whole work each: if the plug-in is
/// missing, cannot be loaded or is of another version, if the starter speaks no MPI or another MPI
/// than OpenMPI, and for several `threads` in each of several processes.
std::unique_ptr<Executor> make_executor(std::size_t threads);

/// Throws InputError, naming `option`, if mpirun or srun has started several processes together.
void require_single_process(const std::string& option);

/// Who has started this process together with others.
struct Start {
  std::string by;  ///< name for messages
  std::size_t processes = 1;
  bool has_mpi = true;  ///< false: several processes without a way to find each other
};

/// Reads the start from the environment; `variable` returns null for an unset variable.
Start start_of(const std::function<const char*(const char*)>& variable);

}  // namespace kelpie::jobs
