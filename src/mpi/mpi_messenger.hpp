// SPDX-License-Identifier: Apache-2.0
#pragma once

#ifndef OMPI_SKIP_MPICXX
#define OMPI_SKIP_MPICXX  // the C++ interface that MPI has given up
#endif
#include <mpi.h>

#include "jobs/messenger.hpp"

namespace kelpie::mpi {

/// Messages by MPI. One at a time, and one in the life of a process: it begins and ends MPI
/// (MPI_THREAD_FUNNELED: its thread alone calls MPI). An error of MPI ends all processes. At its
/// end nobody may have sent what wasn't received.
class MpiMessenger final : public jobs::Messenger {
 public:
  MpiMessenger();
  ~MpiMessenger() override;
  MpiMessenger(const MpiMessenger&) = delete;
  MpiMessenger(MpiMessenger&&) = delete;
  MpiMessenger& operator=(const MpiMessenger&) = delete;
  MpiMessenger& operator=(MpiMessenger&&) = delete;

  std::size_t rank() const override;
  std::size_t size() const override;
  std::string host() const override;
  void send(std::size_t to, int kind, std::string_view text) override;
  std::optional<jobs::Message> receive() override;

 private:
  MPI_Comm all_ = MPI_COMM_NULL;
};

}  // namespace kelpie::mpi
