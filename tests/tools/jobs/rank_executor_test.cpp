// SPDX-License-Identifier: Apache-2.0
#include "jobs/rank_executor.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <iterator>
#include <map>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "jobs/journal.hpp"
#include "jobs/ranks.hpp"
#include "kelpie/core/error.hpp"
#include "support.hpp"

// NOLINTBEGIN(misc-const-correctness): not seen are changes by functions of a designated
// initialiser
namespace kelpie::rank_executor_test {
namespace {

using testing::message_of;
using testing::with_ranks;

std::vector<jobs::Job> list_of(std::size_t count) {
  std::vector<jobs::Job> list;
  for (std::size_t i = 0; i < count; ++i) {
    list.push_back(
        {"job " + std::to_string(i), std::to_string(i), 1.0 + static_cast<double>(i % 5)});
  }
  return list;
}

std::string answer(const jobs::Job& job, const jobs::Advance& advance) {
  advance(0.5);
  return '"' + job.key + std::string(job.task == "3" ? 3'000'000 : 1, '!') + '"';
}

void ignore(std::size_t /*place*/, const std::string& /*result*/) {}

// A job that nobody ends but whoever stops it.
std::string forever(const jobs::Job& /*job*/, const jobs::Advance& advance) {
  while (advance(0.1)) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return "ended";
}

class RankExecutor : public ::testing::Test {
 protected:
  // The other ranks have no list, and call the same.
  bool runs(jobs::Executor& executor, jobs::Run run) const {
    run.journal = journal_;
    if (!executor.leads()) {
      run.jobs = {};
      run.done = nullptr;
    }
    return executor.run(run);
  }

  std::ptrdiff_t files() const {
    return std::distance(std::filesystem::directory_iterator(folder_.path()), {});
  }

  template <typename Error>
  std::string refusal(const std::string& version, const std::string& identity) const;
  template <typename Error, typename Thrown>
  std::string thrown_by(const std::string& task, Thrown thrown) const;

  testing::TemporaryFolder folder_;
  jobs::JournalPlace journal_{folder_ / "journal.jsonl", "kelpie-test-journal", {{"of", "ranks"}}};
};

TEST_F(RankExecutor, GivesEveryResultOnceWhateverTheRanksRunAfterRun) {
  for (const std::size_t ranks : {1U, 2U, 5U}) {
    with_ranks(ranks, [&](jobs::Executor& executor, std::size_t rank) {
      EXPECT_EQ(executor.leads(), rank == 0);
      EXPECT_EQ(executor.workers(), ranks);
      for (const std::size_t count : {30U, 0U, 1U}) {
        const std::vector<jobs::Job> list = list_of(count);
        std::map<std::size_t, std::string> results;
        double last = 0.0;
        EXPECT_TRUE(runs(executor, {.jobs = list,
                                    .work = answer,
                                    .done =
                                        [&](std::size_t i, std::string result) {
                                          EXPECT_TRUE(results.emplace(i, result).second);
                                        },
                                    .keep_going =
                                        [&](double share) {
                                          EXPECT_TRUE(share >= last || !executor.leads());
                                          last = share;
                                          return true;
                                        },
                                    .identity = "run of " + std::to_string(count)}));
        EXPECT_EQ(results.size(), executor.leads() ? count : 0U);
        for (const auto& [i, result] : results) {
          EXPECT_EQ(result, answer(list[i], [](double) { return true; }));
        }
      }
    });
  }
}

TEST_F(RankExecutor, KeepsOneJournalInTheEndAndLeavesThoseOfARunThatFailed) {
  const auto run_jobs = [&](bool disk_full) {
    std::atomic<bool> journal_has_result = false;
    with_ranks(3, [&](jobs::Executor& executor, std::size_t) {
      const std::vector<jobs::Job> list = list_of(30);
      std::size_t count = 0;
      const auto done = [&](std::size_t, const std::string&) {
        if (disk_full && ++count == 5) {
          journal_has_result.wait(false);
          throw std::length_error("no room");
        }
      };
      std::size_t begun = 0;
      const auto work = [&](const jobs::Job& job, const jobs::Advance& advance) {
        if (!executor.leads() && ++begun == 2) {
          journal_has_result = true;
          journal_has_result.notify_all();
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        return answer(job, advance);
      };
      const jobs::Run run{.jobs = list, .work = work, .done = done};
      if (executor.leads() && disk_full) {
        EXPECT_THROW(runs(executor, run), std::length_error);
      } else {
        runs(executor, run);
      }
    });
  };
  run_jobs(false);
  EXPECT_EQ(files(), 0);
  run_jobs(true);
  EXPECT_GT(files(), 0);
  EXPECT_GT(jobs::Journal(journal_).size(), 0U);
  EXPECT_EQ(files(), 1);
}

// What the leader of three ranks is told when rank 2 is of another kind.
template <typename Error>
std::string RankExecutor::refusal(const std::string& version, const std::string& identity) const {
  std::string message;
  with_ranks(
      3,
      [&](jobs::Executor& executor, std::size_t rank) {
        const std::vector<jobs::Job> list = list_of(4);
        const jobs::Run run{.jobs = list,
                            .work = answer,
                            .done = ignore,
                            .identity = rank == 2 ? identity : "study a"};
        if (executor.leads()) {
          message = message_of<Error>([&] { runs(executor, run); });
        } else {
          EXPECT_FALSE(runs(executor, run));
        }
      },
      [&](std::size_t rank) { return rank == 2 ? version : "1.0"; });
  return message;
}

TEST_F(RankExecutor, RefusesRanksOfAnotherVersionOrStudyByNameAndMachine) {
  EXPECT_EQ(refusal<InputError>("0.9", "study a"),
            "rank 2 on host2: is kelpie 0.9, but rank 0 on host0, which leads, is kelpie 1.0");
  EXPECT_EQ(refusal<InputError>("1.0", "study\nb"),
            "rank 2 on host2: has other work, \"study\nb\", than rank 0 on host0, which leads: "
            "\"study a\"");
}

// Whichever rank does the job that throws; the leader is told once the others have left theirs.
template <typename Error, typename Thrown>
std::string RankExecutor::thrown_by(const std::string& task, Thrown thrown) const {
  std::string message;
  with_ranks(3, [&](jobs::Executor& executor, std::size_t) {
    const std::vector<jobs::Job> list = list_of(9);
    const jobs::Run run{.jobs = list,
                        .work =
                            [&](const jobs::Job& job, const jobs::Advance& advance) {
                              // NOLINTNEXTLINE(cert-err60-cpp): a thrown text
                              return job.task == task ? throw thrown : forever(job, advance);
                            },
                        .done = ignore};
    if (executor.leads()) {
      message = message_of<Error>([&] { runs(executor, run); });
    } else {
      EXPECT_FALSE(runs(executor, run));
    }
    EXPECT_TRUE(runs(executor, {.work = answer, .done = ignore}));  // it is of use afterwards
  });
  return message;
}

TEST_F(RankExecutor, CarriesHomeWhatAJobThrowsWithItsKind) {
  const InputError error({.file = "a.csv", .line = 7, .field = "u"}, "is no number");
  EXPECT_EQ(thrown_by<InputError>("4", error), "a.csv:7: u: is no number");
  EXPECT_EQ(thrown_by<Failure>("4", Failure("disk full")), "disk full");
  EXPECT_EQ(thrown_by<Failure>("4", std::out_of_range("at")), "at");
  EXPECT_EQ(thrown_by<Failure>("4", 7), "job 4: failed for no reason that it names");
}

TEST_F(RankExecutor, ThrowsWhatDoneThrows) {
  with_ranks(2, [&](jobs::Executor& executor, std::size_t) {
    const std::vector<jobs::Job> list = list_of(9);
    const jobs::Run run{.jobs = list, .work = answer, .done = [](std::size_t, const std::string&) {
                          throw std::length_error("no room");
                        }};
    if (executor.leads()) {
      EXPECT_THROW(runs(executor, run), std::length_error);
    } else {
      EXPECT_FALSE(runs(executor, run));
    }
  });
}

// A signal may come to any of the processes.
TEST_F(RankExecutor, StoppedInAnyRankAllStopInTheMiddleOfTheirJobs) {
  for (const std::size_t unwilling : {0U, 2U}) {
    std::atomic<int> results = 0;
    with_ranks(3, [&](jobs::Executor& executor, std::size_t rank) {
      const std::vector<jobs::Job> list = list_of(9);
      int asked = 0;
      EXPECT_FALSE(
          runs(executor, {.jobs = list,
                          .work = forever,
                          .done = [&](std::size_t, const std::string&) { ++results; },
                          .keep_going = [&](double) { return rank != unwilling || ++asked < 5; }}));
      EXPECT_TRUE(runs(executor, {.work = answer, .done = ignore}));
    });
    EXPECT_EQ(results, 0);
  }
}

// Jobs that ask all the time whether to go on are asking when they are told to stop.
TEST_F(RankExecutor, NoStopIsLost) {
  const jobs::Work busy = [](const jobs::Job&, const jobs::Advance& advance) {
    while (advance(0.1)) {
    }
    return "ended";
  };
  with_ranks(3, [&](jobs::Executor& executor, std::size_t rank) {
    const std::vector<jobs::Job> list = list_of(9);
    for (int round = 0; round < 300; ++round) {
      int asked = 0;
      const auto keep_going = [&](double) { return rank != 0 || ++asked < 50; };
      EXPECT_FALSE(
          runs(executor, {.jobs = list, .work = busy, .done = ignore, .keep_going = keep_going}));
    }
  });
}

TEST_F(RankExecutor, LetsTheOthersGoWhenOneLeaves) {
  with_ranks(3, [&](jobs::Executor& executor, std::size_t rank) {
    if (rank != 0) {  // the leader's study can't be read, so it never comes to a run
      EXPECT_FALSE(runs(executor, {.work = forever, .done = ignore}));
      EXPECT_FALSE(runs(executor, {.work = forever, .done = ignore}));
    }
  });
  with_ranks(3, [&](jobs::Executor& executor, std::size_t rank) {
    const std::vector<jobs::Job> list = list_of(9);
    const jobs::Run run{.jobs = list, .work = forever, .done = ignore};
    if (rank == 0) {
      EXPECT_EQ(message_of<Failure>([&] { runs(executor, run); }),
                "rank 1 has left before the work was done; see what it has said");
    } else if (rank == 2) {
      EXPECT_FALSE(runs(executor, run));
    }
  });
}

}  // namespace
}  // namespace kelpie::rank_executor_test
// NOLINTEND(misc-const-correctness)
