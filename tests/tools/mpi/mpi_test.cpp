// SPDX-License-Identifier: Apache-2.0
// What users start: several processes by mpirun, which find each other through the plug-in.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "cli/little_study.hpp"
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
      "some results\n");
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

// What `kelpie study` does in several processes.
class MpiStudy : public Mpi {
 protected:
  void SetUp() override {
    Mpi::SetUp();
    testing::write_little_study(folder_.path());
  }
  static std::string study_by(int ranks, const std::string& options) {
    return kMpirun + "-n " + std::to_string(ranks) + " " KELPIE_COMMAND " study fleet.toml " +
           options + "; echo exit $?\n";
  }
  // Starts a study of two ranks with runs of a sixth of a second, sends a signal to one of them
  // when two of eight results are there (journals have a first line each), and waits for the end.
  std::string signalled(const std::string& signal, const std::string& which) const {
    testing::write_little_study(folder_.path(), 10'000);
    return shell(folder_,
                 "(" + study_by(2, "--out a") + ") >said 2>&1 & running=$!\n" +
                     "until [ $(cat a/journal*.jsonl 2>/dev/null | wc -l) -gt 3 ]; do sleep 0.02; "
                     "done\nkill -" +
                     signal + " $(pgrep -P $(pgrep -P $running mpirun) | sort -n | " + which +
                     " -n 1); wait $running; cat said");
  }
  void expect_as_by_one_process() const {
    if (!fs::exists(folder_ / "one")) {
      EXPECT_EQ(shell(folder_, KELPIE_COMMAND " study fleet.toml --out one >/dev/null"), "");
    }
    EXPECT_EQ(testing::without_times(folder_ / "a"), testing::without_times(folder_ / "one"));
  }
  std::vector<std::string> journals() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_ / "a")) {
      if (entry.path().extension() == ".jsonl") {
        names.push_back(entry.path().filename().string());
      }
    }
    return names;
  }
};

TEST_F(MpiStudy, TwoAndThreeRanksGiveTheResultOfOneProcess) {
  for (const int ranks : {2, 3}) {
    fs::remove_all(folder_ / "a");
    const std::string said = shell(folder_, study_by(ranks, "--out a"));
    EXPECT_NE(said.find("exit 0"), std::string::npos) << said;
    EXPECT_EQ(journals(), std::vector<std::string>{"journal.jsonl"});
    expect_as_by_one_process();
  }
}

TEST_F(MpiStudy, ARankThatIsKilledLosesNothing) {
  for (const char* const which : {"head", "tail"}) {  // rank 0, the other
    fs::remove_all(folder_ / "a");
    const std::string said = signalled("KILL", which);
    EXPECT_EQ(said.find("exit 0"), std::string::npos) << said;
    EXPECT_FALSE(fs::exists(folder_ / "a" / "study.json"));
    const std::string again = shell(folder_, study_by(3, "--out a"));
    EXPECT_NE(again.find("exit 0"), std::string::npos) << again;
    EXPECT_NE(again.find("going on with "), std::string::npos) << again;
    EXPECT_EQ(journals(), std::vector<std::string>{"journal.jsonl"});
    expect_as_by_one_process();
  }
}

TEST_F(MpiStudy, InterruptedInAnyRankTheSameCommandGoesOn) {
  const std::string said = signalled("TERM", "tail");
  EXPECT_NE(said.find("the same command goes on from here"), std::string::npos) << said;
  EXPECT_NE(said.find("exit 1"), std::string::npos) << said;
  EXPECT_FALSE(fs::exists(folder_ / "a" / "study.json"));
  // One process goes on with what ranks have done.
  const std::string again = shell(folder_, KELPIE_COMMAND " study fleet.toml --out a");
  EXPECT_NE(again.find("going on with "), std::string::npos) << again;
  expect_as_by_one_process();
}

TEST_F(MpiStudy, RefusesAPart) {
  const std::string said = shell(folder_, study_by(2, "--part 1/2"));
  EXPECT_NE(said.find("--part: is for one process, but mpirun has started 2"), std::string::npos)
      << said;
  EXPECT_NE(said.find("exit 2"), std::string::npos) << said;
}

TEST_F(Mpi, RanksTuneAsOneProcess) {
  testing::write_text(folder_ / "log.csv", testing::little_log(600));
  const std::string tune =
      KELPIE_COMMAND " tune log.csv --candidates 6 --set warmup=20 --set buffer=30 --out ";
  const std::string said = shell(folder_, tune + "one && " + kMpirun + "-n 3 " + tune + "ranks");
  EXPECT_EQ(said.find("failed: "), std::string::npos) << said;
  EXPECT_EQ(content_of(folder_ / "ranks/tuned.toml"), content_of(folder_ / "one/tuned.toml"));
  EXPECT_EQ(content_of(folder_ / "ranks/tune.json"), content_of(folder_ / "one/tune.json"));
}

}  // namespace
}  // namespace kelpie::mpi_test
