// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

namespace kelpie::jobs {

/// Runs job(0) … job(count − 1) on at most `threads` threads, the calling thread included (0: a
/// thread per core). Jobs are started in order. After an exception no further job is started; the
/// exception is rethrown when all threads have ended.
void run_all(std::size_t count, std::size_t threads, const std::function<void(std::size_t)>& job);

/// The same until keep_going(share), called by one thread at a time after each job with the
/// finished share, returns false; then no further job is started. Returns whether all jobs were
/// done.
bool run_while(const std::function<bool(double share)>& keep_going, std::size_t count,
               std::size_t threads, const std::function<void(std::size_t)>& job);

}  // namespace kelpie::jobs
