// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

namespace kelpie::jobs {

/// Runs job(0) … job(count − 1) on at most `threads` threads, this one among them (0: one per
/// core). Jobs are begun in their order. When one throws, no further is begun, and what it threw is
/// thrown here after all threads have come to an end.
void run_all(std::size_t count, std::size_t threads, const std::function<void(std::size_t)>& job);

}  // namespace kelpie::jobs
