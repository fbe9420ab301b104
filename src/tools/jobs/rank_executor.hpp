// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "jobs/executor.hpp"
#include "jobs/rank_group.hpp"
#include "jobs/tuning.hpp"

namespace kelpie::jobs {

/// Runs jobs in several processes, a job at a time in each. Rank 0 leads and works as well. Rank 0
/// sends the list of jobs to every rank; then each rank takes the next job from a shared counter,
/// the costly first. Rank 0 passes results to Run::done at once. Every further rank keeps results
/// in a journal (rank_journal); rank 0 reads the journals when all ranks have ended their work.
/// Requires Run::journal with more than one rank. The destructor removes the journals of ranks, so
/// Run::journal has to be closed before. A killed run leaves the journals to the next Journal.
///
/// run() throws InputError, naming rank, machine and difference, if a rank has another version or
/// Run::identity. An InputError of a job is rethrown as InputError, any other exception as Failure.
/// keep_going is called in every rank; false stops all ranks, at the first Advance after
/// `stop_poll_period`. A rank that leaves before a run (end of the executor) turns the run into a
/// Failure. mpirun and srun end the ranks after the death of a rank.
///
/// The destructor waits for the destructors of all ranks. `version` is the program's.
std::unique_ptr<Executor> make_rank_executor(
    std::unique_ptr<RankGroup> group, std::string version,
    std::chrono::milliseconds stop_poll_period = kTuning.stop_poll_period);

}  // namespace kelpie::jobs
