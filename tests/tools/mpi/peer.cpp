// SPDX-License-Identifier: Apache-2.0
// What mpi_test.cpp starts several of by mpirun. The leader tells what became of run after run;
// with a word as argument it then fails, and names it.
#include <fmt/core.h>

#include <chrono>
#include <cstdlib>
#include <map>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "jobs/make_executor.hpp"
#include "kelpie/core/error.hpp"

namespace {

using kelpie::InputError;
using kelpie::jobs::Advance;
using kelpie::jobs::Executor;
using kelpie::jobs::Job;
using kelpie::jobs::Run;

using Results = std::map<std::size_t, std::string>;

std::vector<Job> list_of(std::size_t count) {
  std::vector<Job> list;
  for (std::size_t i = 0; i < count; ++i) {
    list.push_back(
        {"job " + std::to_string(i), std::to_string(i), 1.0 + static_cast<double>(i % 7)});
  }
  return list;
}

// Two of them are of 5 MB, so that a rank that does not lead writes one.
std::string answer(const Job& job, const Advance& /*advance*/) {
  return '"' + job.key + std::string(job.task == "7" || job.task == "8" ? 5'000'000 : 100, '!') +
         '"';
}

// Of the costly ones, which are begun first, the first; the others are there until they are
// stopped.
std::string refuse_the_first(const Job& job, const Advance& advance) {
  if (job.task == "6") {
    throw InputError({.file = "a.csv", .line = 7, .field = "u"}, "is no number");
  }
  while (advance(0.5)) {
  }
  return "";
}

std::string rest(const Job& job, const Advance& advance) {
  for (int i = 0; i < 50 && advance(0.02 * i); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return answer(job, advance);
}

std::string how_it_ended(Executor& executor, Run run) {
  run.journal = {"peers.jsonl", "kelpie-peer-journal", {{"of", "peers"}}};
  try {
    return executor.run(run) ? "complete" : "stopped";
  } catch (const InputError& error) {
    return fmt::format("bad input: {}", error.what());
  }
}

void tell(const Executor& executor, const std::string& what) {
  if (executor.leads()) {
    fmt::print("{}\n", what);
  }
}

void run_all_kinds(Executor& executor, bool odd_one_out) {
  const std::vector<Job> list = list_of(60);
  const auto into = [](Results& results) {
    return [&results](std::size_t i, std::string result) { results.emplace(i, std::move(result)); };
  };
  Results by_threads;
  Results by_ranks;
  kelpie::jobs::make_thread_executor(2)->run(
      {.jobs = list, .work = answer, .done = into(by_threads)});
  tell(executor, how_it_ended(executor, {.jobs = list, .work = answer, .done = into(by_ranks)}));
  tell(executor, by_ranks == by_threads && by_ranks.size() == list.size() ? "same" : "different");

  Results some;
  tell(executor,
       how_it_ended(executor, {.jobs = list, .work = refuse_the_first, .done = into(some)}));
  tell(executor, how_it_ended(executor, {.jobs = list,
                                         .work = answer,
                                         .done = into(some),
                                         .identity = odd_one_out ? "study b" : "study a"}));
  some.clear();
  const auto keep_going = [&](double) { return !executor.leads() || some.size() < 5; };
  tell(executor,
       how_it_ended(executor,
                    {.jobs = list, .work = rest, .done = into(some), .keep_going = keep_going}));
  tell(executor, some.size() >= 5 && some.size() < list.size() ? "some results" : "no or all");
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const auto executor = kelpie::jobs::make_executor(0);
    tell(*executor, fmt::format("{} at work", executor->workers()));
    // NOLINTNEXTLINE(concurrency-mt-unsafe): nobody writes it
    const char* const rank = std::getenv("OMPI_COMM_WORLD_RANK");
    run_all_kinds(*executor, rank != nullptr && std::string(rank) == "2");
    if (argc > 1 && executor->leads()) {
      throw kelpie::Failure(argv[1]);
    }
    return 0;
  } catch (const InputError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
