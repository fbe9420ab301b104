// SPDX-License-Identifier: Apache-2.0
#include "lab/process_costs.hpp"

#include <unistd.h>

#include <ctime>
#include <fstream>

namespace kelpie::lab {

double thread_time_us() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

std::size_t resident_bytes() {
  std::ifstream stream("/proc/self/statm");
  std::size_t all = 0;
  std::size_t resident = 0;
  stream >> all >> resident;
  return resident * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

}  // namespace kelpie::lab
