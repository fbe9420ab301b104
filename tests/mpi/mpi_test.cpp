// SPDX-License-Identifier: Apache-2.0
// What users start: several processes by mpirun, which find each other through the plug-in.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/command.hpp"
#include "cli/shell.hpp"
#include "support.hpp"

namespace kelpie::mpi_test {
namespace {

namespace fs = std::filesystem;

using testing::content_of;
using testing::have;
using testing::shell;
using testing::TemporaryFolder;

// OpenMPI leaves to the end of a process what a sanitizer takes for leaks.
const std::string kMpirun =
    "export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 ASAN_OPTIONS=detect_leaks=0\n"
    "mpirun --oversubscribe ";

class Mpi : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!have(folder_, "mpirun")) {
      GTEST_SKIP() << "there is no mpirun";
    }
  }
  TemporaryFolder folder_;
};

TEST_F(Mpi, ThreeProcessesWorkTogetherRunAfterRunAndEndTogether) {
  EXPECT_EQ(
      shell(folder_, kMpirun + "-n 3 " KELPIE_PEER " | sed 's/ on [^,]*/ on HOST/g'"),
      "3 at work\n"
      "complete\n"
      "same\n"
      "bad input: a.csv:7: u: is no number\n"
      "bad input: rank 2 on HOST, \"study b\", than rank 0 on HOST, which leads: \"study a\"\n"
      "stopped\n"
      "5 results\n");
}

TEST_F(Mpi, ALeaderThatFailsEndsWithItsExitCodeAndMessage) {
  const std::string said = shell(folder_, kMpirun + "-n 2 " KELPIE_PEER " no_disk; echo exit $?");
  EXPECT_NE(said.find("no_disk\n"), std::string::npos) << said;
  EXPECT_NE(said.find("exit 1\n"), std::string::npos) << said;
}

// They would each do the whole work, and fight for one journal.
TEST_F(Mpi, ProcessesThatCannotFindEachOtherSayWhyAndDoNothing) {
  const fs::path alone = folder_ / "peer";
  fs::copy_file(KELPIE_PEER, alone);
  const auto refused = [&](const std::string& environment) {
    return shell(folder_, environment + " ./peer; echo exit $?");
  };
  const std::string missing = refused("OMPI_COMM_WORLD_SIZE=4");
  EXPECT_NE(missing.find("mpirun: 4 processes were started, but there is no libkelpie_mpi.so in " +
                         fs::canonical(folder_.path()).string()),
            std::string::npos)
      << missing;
  EXPECT_NE(missing.find("exit 2"), std::string::npos) << missing;

  const std::string no_mpi = refused("SLURM_PROCID=1 SLURM_STEP_NUM_TASKS=4");
  EXPECT_NE(no_mpi.find("srun: has started 4 processes that don't know each other; with "
                        "--mpi=pmix they do"),
            std::string::npos)
      << no_mpi;
  EXPECT_NE(no_mpi.find("exit 2"), std::string::npos) << no_mpi;

  testing::write_text(folder_ / "libkelpie_mpi.so", "no library");
  EXPECT_NE(refused("OMPI_COMM_WORLD_SIZE=4").find("libkelpie_mpi.so: can't be loaded: "),
            std::string::npos);
  fs::copy_file(KELPIE_OTHER_VERSION, folder_ / "libkelpie_mpi.so",
                fs::copy_options::overwrite_existing);
  const std::string other = refused("OMPI_COMM_WORLD_SIZE=4");
  EXPECT_NE(other.find("libkelpie_mpi.so: is of kelpie 0.0.9, but this is kelpie "),
            std::string::npos)
      << other;
  EXPECT_NE(other.find("exit 2"), std::string::npos) << other;
}

#ifdef KELPIE_COMMAND
// A signal to one of them; mpirun passes on what they say then, but not when it is ended itself.
TEST_F(Mpi, InterruptedItGoesOnAndSaysTheSameAsThreads) {
  const std::string fleet = KELPIE_COMMAND " fleet --jobs 300 --job-ms 20 --idle ";
  const std::string first = shell(
      folder_, kMpirun + "-n 2 " + fleet + "--out a & running=$!\n" +
                   "until [ -e a/journal.jsonl ] && [ $(wc -l <a/journal.jsonl) -gt 5 ]; do sleep "
                   "0.05; done\nkill -TERM $(pgrep -P $running | tail -n 1); wait $running; echo "
                   "exit $?");
  EXPECT_NE(first.find("interrupted; the same command goes on"), std::string::npos) << first;
  EXPECT_NE(first.find("exit 1"), std::string::npos) << first;
  EXPECT_FALSE(fs::exists(folder_ / "a" / "fleet.json"));

  const std::string second =
      shell(folder_, kMpirun + "-n 3 " + fleet + "--out a && " + fleet + "--threads 8 --out b");
  EXPECT_EQ(second.find("failed: "), std::string::npos) << second;
  const auto a = nlohmann::json::parse(content_of(folder_ / "a" / "fleet.json"));
  const auto b = nlohmann::json::parse(content_of(folder_ / "b" / "fleet.json"));
  EXPECT_EQ(a["workers"], 3);
  EXPECT_GT(a["found"], 0);
  EXPECT_GT(a["sent"], 0);
  EXPECT_EQ(a["done"].get<int>() + a["found"].get<int>(), 300);
  EXPECT_EQ(b["done"], 300);
  EXPECT_EQ(a["value"], b["value"]);
}
#endif

}  // namespace
}  // namespace kelpie::mpi_test
