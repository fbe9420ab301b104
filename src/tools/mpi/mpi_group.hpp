// SPDX-License-Identifier: Apache-2.0
#pragma once

#ifndef OMPI_SKIP_MPICXX
#define OMPI_SKIP_MPICXX  // the C++ interface that MPI has given up
#endif
#include <mpi.h>

#include <mutex>
#include <thread>

#include "jobs/rank_group.hpp"

namespace kelpie::mpi {

/// Ranks of MPI_COMM_WORLD. Initialises and finalises MPI (MPI_THREAD_SERIALIZED), so a process
/// makes at most one. An error of MPI ends all ranks. The counters are a window of rank 0, accessed
/// by MPI_Fetch_and_op in one passive epoch; a thread of rank 0 serves accesses over networks
/// without atomics in hardware.
class MpiGroup final : public jobs::RankGroup {
 public:
  MpiGroup();
  ~MpiGroup() override;
  MpiGroup(const MpiGroup&) = delete;
  MpiGroup& operator=(const MpiGroup&) = delete;

  std::size_t rank() const override { return rank_; }
  std::size_t size() const override { return size_; }
  std::string host() const override;
  std::uint64_t fetch_add(Counter counter, std::uint64_t amount) override;
  void reset(Counter counter) override;
  std::vector<std::string> exchange(const std::string& text,
                                    const std::function<void()>& waiting) override;
  std::string broadcast(std::string text) override;

 private:
  std::uint64_t fetch(Counter counter, std::uint64_t operand, MPI_Op operation);
  void wait(MPI_Request request, const std::function<void()>& waiting);

  MPI_Comm all_ = MPI_COMM_NULL;
  MPI_Win window_ = MPI_WIN_NULL;
  std::size_t rank_ = 0;
  std::size_t size_ = 1;
  std::mutex mutex_;  // of all calls of MPI
  std::jthread progress_;
};

}  // namespace kelpie::mpi
