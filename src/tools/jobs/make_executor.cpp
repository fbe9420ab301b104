// SPDX-License-Identifier: Apache-2.0
#include "jobs/make_executor.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <string_view>

#include "file/plugin.hpp"
#include "jobs/rank_executor.hpp"
#include "jobs/rank_group.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::jobs {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPlugin = "libkelpie_mpi.so";

std::size_t count_of(const char* text) {
  std::size_t count = 0;
  if (text != nullptr) {
    const std::string_view digits = text;
    std::from_chars(digits.data(), digits.data() + digits.size(), count);
  }
  return count;
}

fs::path find_plugin(const Start& start) {
  try {
    return file::find_plugin(kPlugin);
  } catch (const Failure& missing) {
    throw InputError(start.by,
                     fmt::format("{} processes were started, but {} that they would work "
                                 "together by (Debian package kelpie-mpi, or a build with "
                                 "-DKELPIE_WITH_MPI=ON)",
                                 start.processes, missing.what()));
  }
}

std::unique_ptr<RankGroup> open_group(const fs::path& plugin) {
  // OpenMPI's own plug-ins look for its symbols among all that were loaded. It stays loaded: what
  // it leaves to the program's end is in there.
  void* const library = ::dlopen(plugin.c_str(), RTLD_NOW | RTLD_GLOBAL);
  void* const symbol = library == nullptr ? nullptr : ::dlsym(library, kOpenRankGroup);
  if (symbol == nullptr) {
    const char* const why = ::dlerror();  // NOLINT(concurrency-mt-unsafe): glibc's is
    throw InputError({.file = plugin.string(), .line = 0, .field = {}},
                     fmt::format("can't be loaded: {}", why == nullptr ? "unknown" : why));
  }
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): as dlsym wants it
  const auto open = reinterpret_cast<OpenRankGroup>(symbol);
  const char* version = "";
  std::unique_ptr<RankGroup> group(open(KELPIE_VERSION, &version));
  if (!group) {
    throw InputError({.file = plugin.string(), .line = 0, .field = {}},
                     fmt::format("is of kelpie {}, but this is kelpie {}; install the same of both",
                                 version, KELPIE_VERSION));
  }
  return group;
}

Start start_here() {
  // NOLINTNEXTLINE(concurrency-mt-unsafe): no thread changes the environment
  return start_of([](const char* name) { return std::getenv(name); });
}

}  // namespace

Start start_of(const std::function<const char*(const char*)>& variable) {
  if (const std::size_t count = count_of(variable("OMPI_COMM_WORLD_SIZE")); count > 0) {
    return {"mpirun", count};
  }
  const std::size_t tasks = count_of(variable("SLURM_STEP_NUM_TASKS"));
  const bool by_srun = variable("SLURM_PROCID") != nullptr && tasks > 0;
  if (const std::size_t count = count_of(variable("PMI_SIZE")); count > 0) {
    return {by_srun ? "srun" : "mpirun", count};
  }
  if (by_srun) {
    return {"srun", tasks, tasks == 1 || variable("PMIX_RANK") != nullptr};
  }
  return {"", 1};
}

std::unique_ptr<Executor> make_executor(std::size_t threads) {
  const Start start = start_here();
  if (start.processes <= 1) {
    return make_thread_executor(threads);
  }
  if (!start.has_mpi) {
    throw InputError(start.by,
                     fmt::format("has started {} processes that don't know each other; with "
                                 "--mpi=pmix they do (srun --mpi=list tells what there is)",
                                 start.processes));
  }
  if (threads > 1) {
    throw InputError("--threads", fmt::format("{} has started {} processes with a thread each; "
                                              "start more of them instead",
                                              start.by, start.processes));
  }
  std::unique_ptr<RankGroup> group = open_group(find_plugin(start));
  if (group->size() != start.processes) {
    throw InputError(start.by, fmt::format("has started {} processes, but OpenMPI sees {}; it has "
                                           "to be OpenMPI's mpirun, or srun --mpi=pmix",
                                           start.processes, group->size()));
  }
  return make_rank_executor(std::move(group), KELPIE_VERSION);
}

void require_single_process(const std::string& option) {
  if (const Start start = start_here(); start.processes > 1) {
    throw InputError(option, fmt::format("is for one process, but {} has started {} together; they "
                                         "share the jobs without it",
                                         start.by, start.processes));
  }
}

}  // namespace kelpie::jobs
