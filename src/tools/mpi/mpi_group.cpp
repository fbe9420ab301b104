// SPDX-License-Identifier: Apache-2.0
#include "mpi/mpi_group.hpp"

#include <algorithm>
#include <array>

#include "jobs/tuning.hpp"

namespace kelpie::mpi {
namespace {

constexpr auto kCounters = static_cast<std::size_t>(jobs::RankGroup::Counter::count);

}  // namespace

MpiGroup::MpiGroup() {
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided);
  MPI_Comm_dup(MPI_COMM_WORLD, &all_);
  int rank = 0;
  int size = 1;
  MPI_Comm_rank(all_, &rank);
  MPI_Comm_size(all_, &size);
  rank_ = static_cast<std::size_t>(rank);
  size_ = static_cast<std::size_t>(size);
  std::uint64_t* counters = nullptr;
  MPI_Win_allocate(rank == 0 ? kCounters * sizeof(std::uint64_t) : 0, sizeof(std::uint64_t),
                   MPI_INFO_NULL, all_, &counters, &window_);
  MPI_Win_lock_all(0, window_);
  if (rank == 0) {
    std::fill_n(counters, kCounters, 0);
    MPI_Win_sync(window_);
  }
  MPI_Barrier(all_);
  if (rank == 0 && provided >= MPI_THREAD_SERIALIZED) {
    progress_ = std::jthread([this](const std::stop_token& stop) {
      while (!stop.stop_requested()) {
        {
          const std::scoped_lock lock(mutex_);
          int there = 0;
          MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, all_, &there, MPI_STATUS_IGNORE);
        }
        std::this_thread::sleep_for(jobs::kTuning.progress_period);
      }
    });
  }
}

MpiGroup::~MpiGroup() {
  if (progress_.joinable()) {
    progress_.request_stop();
    progress_.join();
  }
  MPI_Win_unlock_all(window_);
  MPI_Win_free(&window_);
  MPI_Comm_free(&all_);
  MPI_Finalize();
}

std::string MpiGroup::host() const {
  std::array<char, MPI_MAX_PROCESSOR_NAME> name{};
  int size = 0;
  MPI_Get_processor_name(name.data(), &size);
  return {name.data(), static_cast<std::size_t>(size)};
}

std::uint64_t MpiGroup::fetch_add(Counter counter, std::uint64_t amount) {
  return fetch(counter, amount, amount == 0 ? MPI_NO_OP : MPI_SUM);
}

void MpiGroup::reset(Counter counter) {
  fetch(counter, 0, MPI_REPLACE);
}

std::uint64_t MpiGroup::fetch(Counter counter, std::uint64_t operand, MPI_Op operation) {
  const std::scoped_lock lock(mutex_);
  std::uint64_t before = 0;
  MPI_Fetch_and_op(&operand, &before, MPI_UINT64_T, 0, static_cast<MPI_Aint>(counter), operation,
                   window_);
  MPI_Win_flush(0, window_);
  return before;
}

std::vector<std::string> MpiGroup::exchange(const std::string& text,
                                            const std::function<void()>& waiting) {
  const int own = static_cast<int>(text.size());
  std::vector<int> sizes(size_);
  MPI_Request request = MPI_REQUEST_NULL;
  {
    const std::scoped_lock lock(mutex_);
    MPI_Iallgather(&own, 1, MPI_INT, sizes.data(), 1, MPI_INT, all_, &request);
  }
  wait(request, waiting);
  std::vector<int> begins(size_);
  for (std::size_t i = 1; i < size_; ++i) {
    begins[i] = begins[i - 1] + sizes[i - 1];
  }
  std::string joined(static_cast<std::size_t>(begins.back() + sizes.back()), '\0');
  {
    const std::scoped_lock lock(mutex_);
    MPI_Iallgatherv(text.data(), own, MPI_CHAR, joined.data(), sizes.data(), begins.data(),
                    MPI_CHAR, all_, &request);
  }
  wait(request, waiting);
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < size_; ++i) {
    texts.push_back(
        joined.substr(static_cast<std::size_t>(begins[i]), static_cast<std::size_t>(sizes[i])));
  }
  return texts;
}

std::string MpiGroup::broadcast(std::string text) {
  int size = static_cast<int>(text.size());
  MPI_Request request = MPI_REQUEST_NULL;
  {
    const std::scoped_lock lock(mutex_);
    MPI_Ibcast(&size, 1, MPI_INT, 0, all_, &request);
  }
  wait(request, [] {});
  text.resize(static_cast<std::size_t>(size));
  {
    const std::scoped_lock lock(mutex_);
    MPI_Ibcast(text.data(), size, MPI_CHAR, 0, all_, &request);
  }
  wait(request, [] {});
  return text;
}

// MPI_Wait would take a whole core.
void MpiGroup::wait(MPI_Request request, const std::function<void()>& waiting) {
  auto sleep = jobs::kTuning.shortest_sleep;
  while (true) {
    int done = 0;
    {
      const std::scoped_lock lock(mutex_);
      MPI_Test(&request, &done, MPI_STATUS_IGNORE);
    }
    if (done != 0) {
      return;
    }
    waiting();
    std::this_thread::sleep_for(sleep);
    sleep = std::min(2 * sleep, jobs::kTuning.longest_sleep);
  }
}

}  // namespace kelpie::mpi
