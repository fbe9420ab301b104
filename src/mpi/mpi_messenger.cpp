// SPDX-License-Identifier: Apache-2.0
#include "mpi/mpi_messenger.hpp"

#include <array>

namespace kelpie::mpi {

MpiMessenger::MpiMessenger() {
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_dup(MPI_COMM_WORLD, &all_);
}

MpiMessenger::~MpiMessenger() {
  MPI_Comm_free(&all_);
  MPI_Finalize();
}

std::size_t MpiMessenger::rank() const {
  int rank = 0;
  MPI_Comm_rank(all_, &rank);
  return static_cast<std::size_t>(rank);
}

std::size_t MpiMessenger::size() const {
  int size = 0;
  MPI_Comm_size(all_, &size);
  return static_cast<std::size_t>(size);
}

std::string MpiMessenger::host() const {
  std::array<char, MPI_MAX_PROCESSOR_NAME> name{};
  int size = 0;
  MPI_Get_processor_name(name.data(), &size);
  return {name.data(), static_cast<std::size_t>(size)};
}

void MpiMessenger::send(std::size_t to, int kind, std::string_view text) {
  MPI_Send(text.data(), static_cast<int>(text.size()), MPI_CHAR, static_cast<int>(to), kind, all_);
}

std::optional<jobs::Message> MpiMessenger::receive() {
  int there = 0;
  MPI_Status status;
  MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, all_, &there, &status);
  if (there == 0) {
    // OpenMPI looks into the network after it has looked for messages.
    MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, all_, &there, &status);
  }
  if (there == 0) {
    return std::nullopt;
  }
  int size = 0;
  MPI_Get_count(&status, MPI_CHAR, &size);
  jobs::Message message{static_cast<std::size_t>(status.MPI_SOURCE), status.MPI_TAG,
                        std::string(static_cast<std::size_t>(size), '\0')};
  MPI_Recv(message.text.data(), size, MPI_CHAR, status.MPI_SOURCE, status.MPI_TAG, all_,
           MPI_STATUS_IGNORE);
  return message;
}

}  // namespace kelpie::mpi
