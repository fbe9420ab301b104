// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace kelpie::lab {

/// Processor time of the calling thread.
double thread_time_us();

/// Memory of this process that is in use, as Linux tells it; 0 where it can't be read.
std::size_t resident_bytes();

}  // namespace kelpie::lab
