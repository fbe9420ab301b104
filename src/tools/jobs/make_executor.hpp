// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include "jobs/executor.hpp"

namespace kelpie::jobs {

/// Makes the executor of a process: ranks over MPI, a job at a time in each, if mpirun or srun has
/// started several processes together; else threads (0: a thread per core). A process makes at most
/// one executor, for MPI starts and ends with the executor.
///
/// MPI is a plug-in, libkelpie_mpi.so, beside the program or in the folder chosen by
/// `cmake --install`. Throws InputError, so that several processes never repeat the whole work
/// each: if the plug-in is missing, cannot be loaded or has another version, if the starter has no
/// MPI or an MPI other than OpenMPI, and for several `threads` in each of several processes.
std::unique_ptr<Executor> make_executor(std::size_t threads);

/// Throws InputError, naming `option`, if mpirun or srun has started several processes together.
void require_single_process(const std::string& option);

/// Starter and number of processes started together.
struct Start {
  std::string by;  ///< name for messages
  std::size_t processes = 1;
  bool has_mpi = true;  ///< false: several processes without a way to find each other
};

/// Start according to the environment; `variable` returns null for an unset variable.
Start start_of(const std::function<const char*(const char*)>& variable);

}  // namespace kelpie::jobs
