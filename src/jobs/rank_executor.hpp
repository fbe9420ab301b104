// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "jobs/executor.hpp"
#include "jobs/messenger.hpp"

namespace kelpie::jobs {

/// One of several processes that were started together, on one machine or many. Rank 0 leads, and
/// works as well; every rank does one job at a time, and gets the next when it has sent the result
/// of the last. The thread that calls run() sends and receives; the job is done by another. Who
/// waits sleeps, a tenth of the time that it has waited, 0.5 ms at most.
///
/// run() throws InputError, naming rank, machine and both, when a rank is of another version or
/// has another Run::identity; a job's InputError as InputError, and what else it throws as Failure.
/// keep_going is asked in every rank; false stops the run of all of them. A rank learns of a stop
/// when its job calls Advance. A rank that leaves before a run (its executor's end) makes that run
/// a Failure; one that dies is the business of whoever started them (mpirun, srun).
///
/// The end of an executor waits for that of the others. `version` is this program's.
std::unique_ptr<Executor> make_rank_executor(std::unique_ptr<Messenger> messenger,
                                             std::string version);

}  // namespace kelpie::jobs
