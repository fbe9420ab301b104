// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include "jobs/executor.hpp"

namespace kelpie::jobs {

/// The executor of this process. Where mpirun or srun has started several processes together it is
/// a rank executor over MPI, one job at a time in each process; else threads of this process (0:
/// one per core). To be made once; it begins and ends MPI.
///
/// MPI is a plug-in, libkelpie_mpi.so, looked for beside the program, then where `cmake --install`
/// puts it. Throws InputError, so that never several processes do one's work each for itself:
/// where that file is missing, can't be loaded or is of another version, where the starter speaks
/// no MPI or another one than OpenMPI, and for several `threads` in each of several processes.
std::unique_ptr<Executor> make_executor(std::size_t threads);

/// Who has started this process, and how many of them.
struct Start {
  std::string by;  ///< what to call it in messages
  std::size_t processes = 1;
  bool has_mpi = true;  ///< false: several, but nothing that they could find each other by
};

/// As the variables of the environment tell it; `variable` gives null where there is none.
Start start_of(const std::function<const char*(const char*)>& variable);

}  // namespace kelpie::jobs
