// SPDX-License-Identifier: Apache-2.0
#include "jobs/make_executor.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cstdlib>
#include <string_view>

#include "kelpie/core/error.hpp"

namespace kelpie::jobs {
namespace {

std::size_t count_of(const char* text) {
  std::size_t count = 0;
  if (text != nullptr) {
    const std::string_view digits = text;
    std::from_chars(digits.data(), digits.data() + digits.size(), count);
  }
  return count;
}

}  // namespace

Start start_of(const std::function<const char*(const char*)>& variable) {
  const std::size_t tasks = count_of(variable("SLURM_STEP_NUM_TASKS"));
  const bool by_srun = variable("SLURM_PROCID") != nullptr && tasks > 0;
  for (const char* const name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"}) {
    if (const std::size_t count = count_of(variable(name)); count > 0) {
      return {by_srun && count == tasks ? "srun" : "mpirun", count};
    }
  }
  return by_srun ? Start{"srun", tasks} : Start{};
}

std::unique_ptr<Executor> make_executor(std::size_t threads) {
  // NOLINTNEXTLINE(concurrency-mt-unsafe): no thread changes the environment
  const Start start = start_of([](const char* name) { return std::getenv(name); });
  if (start.processes > 1) {
    throw InputError(start.by,
                     fmt::format("has started {} processes, and each would do the whole work; a "
                                 "study runs on many machines in parts: kelpie study --part k/n",
                                 start.processes));
  }
  return make_thread_executor(threads);
}

}  // namespace kelpie::jobs
