// SPDX-License-Identifier: Apache-2.0
// What mpi_test.cpp starts several of by mpirun. The leader tells what became of run after run;
// with a word as argument it then fails, and names it.
#include <fmt/core.h>

#include <cstdlib>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "jobs/make_engine.hpp"
#include "kelpie/core/error.hpp"

namespace {

using kelpie::InputError;
using kelpie::jobs::Advance;
using kelpie::jobs::Engine;
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

// Two of them are of 5 MB, so that somebody sends one.
std::string answer(const Job& job, const Advance& /*advance*/) {
  return job.key + std::string(job.task == "7" || job.task == "8" ? 5'000'000 : 100, '!');
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

std::string how_it_ended(Engine& engine, const Run& run) {
  try {
    return engine.run(run) ? "complete" : "stopped";
  } catch (const InputError& error) {
    return fmt::format("bad input: {}", error.what());
  }
}

void tell(const Engine& engine, const std::string& what) {
  if (engine.leads()) {
    fmt::print("{}\n", what);
  }
}

void run_all_kinds(Engine& engine, bool odd_one_out) {
  const std::vector<Job> list = list_of(60);
  const auto into = [](Results& results) {
    return [&results](std::size_t i, std::string result) { results.emplace(i, std::move(result)); };
  };
  Results by_threads;
  Results by_ranks;
  kelpie::jobs::make_thread_engine(2)->run(
      {.jobs = list, .work = answer, .done = into(by_threads)});
  tell(engine, how_it_ended(engine, {.jobs = list, .work = answer, .done = into(by_ranks)}));
  tell(engine, by_ranks == by_threads && by_ranks.size() == list.size() ? "same" : "different");

  Results some;
  tell(engine, how_it_ended(engine, {.jobs = list, .work = refuse_the_first, .done = into(some)}));
  tell(engine, how_it_ended(engine, {.jobs = list,
                                     .work = answer,
                                     .done = into(some),
                                     .identity = odd_one_out ? "study b" : "study a"}));
  some.clear();
  const auto keep_going = [&](double) { return !engine.leads() || some.size() < 5; };
  tell(engine,
       how_it_ended(engine,
                    {.jobs = list, .work = answer, .done = into(some), .keep_going = keep_going}));
  tell(engine, fmt::format("{} results", some.size()));
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const auto engine = kelpie::jobs::make_engine(0);
    tell(*engine, fmt::format("{} at work", engine->workers()));
    // NOLINTNEXTLINE(concurrency-mt-unsafe): nobody writes it
    const char* const rank = std::getenv("OMPI_COMM_WORLD_RANK");
    run_all_kinds(*engine, rank != nullptr && std::string(rank) == "2");
    if (argc > 1 && engine->leads()) {
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
