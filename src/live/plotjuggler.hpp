// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <netinet/in.h>

#include <cstddef>
#include <string>
#include <vector>

#include "live/configuration.hpp"
#include "live/output.hpp"

namespace kelpie::live {

/// Sends a datagram of JSON for every sample that is learned, or passed over while learning is
/// frozen, and for every prediction, as PlotJuggler's UDP server reads it (stamps in s under
/// "timestamp"). Never waits: what the network
/// doesn't take is lost.
class PlotJuggler final : public Output {
 public:
  /// `inputs` and `targets` are the names of the values. Throws InputError where there is no such
  /// host, Failure where there is no socket.
  PlotJuggler(const Endpoint& endpoint, std::vector<std::string> inputs,
              std::vector<std::string> targets);
  ~PlotJuggler() override;
  PlotJuggler(const PlotJuggler&) = delete;
  PlotJuggler(PlotJuggler&&) = delete;
  PlotJuggler& operator=(const PlotJuggler&) = delete;
  PlotJuggler& operator=(PlotJuggler&&) = delete;

  bool wants_predictions() const override { return true; }
  void learned(const LearnedSample& sample) override;
  void predicted(const PredictedSample& sample) override;
  void health(const Health& health) override;

 private:
  void send(const std::string& text) const;

  std::vector<std::string> inputs_;
  std::vector<std::string> targets_;
  int socket_ = -1;
  sockaddr_storage to_{};
  socklen_t to_bytes_ = 0;
};

}  // namespace kelpie::live
