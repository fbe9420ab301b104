// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

namespace kelpie::jobs {

/// Runs job(0) … job(count − 1) on at most `threads` threads, the calling thread included (0: a
/// thread per core). Jobs are started in order. After an exception no further job is started; the
/// exception is rethrown when all threads have ended.
void run_all(std::size_t count, std::size_t threads, const std::function<void(std::size_t)>& job);

}  // namespace kelpie::jobs
