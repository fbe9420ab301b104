// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "jobs/executor.hpp"
#include "jobs/rank_group.hpp"
#include "jobs/tuning.hpp"

namespace kelpie::jobs {

/// Jobs in several processes, one job at a time in each. Rank 0 leads and works as well. It tells
/// every rank the jobs; then each rank takes its next job from a shared counter, the costly first.
/// Rank 0 gives results to Run::done at once. The other ranks keep results in journals
/// (rank_journal) until all ranks have ended their work; then rank 0 takes them. Run::journal is
/// required with more than one rank. The journals of ranks are removed by the destructor, so that
/// Run::journal has to be on the disk before; a killed run leaves them to the next Journal.
///
/// run() throws InputError, naming rank, machine and the difference, when a rank is of another
/// version or has another Run::identity; a job's InputError as InputError, and what else a job
/// throws as Failure. keep_going is called in every rank; false stops all ranks, others at their
/// next Advance that is `stop_poll_period` after the last. A rank that leaves before a run (the end
/// of its executor) makes this run a Failure. mpirun and srun deal with ranks that die.
///
/// The destructor waits for those of the other ranks. `version` is this program's.
std::unique_ptr<Executor> make_rank_executor(
    std::unique_ptr<RankGroup> group, std::string version,
    std::chrono::milliseconds stop_poll_period = kTuning.stop_poll_period);

}  // namespace kelpie::jobs
