// SPDX-License-Identifier: Apache-2.0
#include "jobs/make_executor.hpp"

#include <gtest/gtest.h>

#include <map>
#include <string>

namespace kelpie::make_executor_test {
namespace {

jobs::Start start_in(const std::map<std::string, std::string>& environment) {
  return jobs::start_of([&](const char* name) {
    const auto found = environment.find(name);
    return found == environment.end() ? nullptr : found->second.c_str();
  });
}

// As they were found under mpirun of OpenMPI 4.1, mpiexec of MPICH 4.0 and srun of Slurm 22.05.
TEST(MakeExecutor, KnowsFromTheEnvironmentWhoStartedHowMany) {
  EXPECT_EQ(start_in({}).processes, 1U);
  EXPECT_EQ(start_in({{"OMPI_COMM_WORLD_SIZE", "64"}, {"PMIX_RANK", "3"}}).processes, 64U);
  EXPECT_EQ(start_in({{"PMI_SIZE", "4"}, {"PMI_RANK", "0"}}).processes, 4U);

  const jobs::Start by_srun =
      start_in({{"SLURM_PROCID", "3"}, {"SLURM_STEP_NUM_TASKS", "8"}, {"PMIX_RANK", "3"}});
  EXPECT_EQ(by_srun.by, "srun");
  EXPECT_EQ(by_srun.processes, 8U);

  // The script of a job is one process, however many its steps have.
  EXPECT_EQ(start_in({{"SLURM_PROCID", "0"}, {"SLURM_NTASKS", "8"}}).processes, 1U);
  // mpirun inside a job of Slurm passes the variables of the job on.
  const jobs::Start by_mpirun = start_in(
      {{"OMPI_COMM_WORLD_SIZE", "2"}, {"SLURM_PROCID", "0"}, {"SLURM_STEP_NUM_TASKS", "1"}});
  EXPECT_EQ(by_mpirun.by, "mpirun");
  EXPECT_EQ(by_mpirun.processes, 2U);
}

}  // namespace
}  // namespace kelpie::make_executor_test
