// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <netinet/in.h>

#include <cstddef>
#include <string>
#include <vector>

#include "live/configuration.hpp"
#include "live/output.hpp"

namespace kelpie::live {

/// Sends each learned sample, prediction and health as a JSON datagram to PlotJuggler's UDP server;
/// "timestamp" is in s. Never waits: a datagram that the network refuses is lost.
class PlotJuggler final : public Output {
 public:
  /// `inputs` and `targets` name the values. Throws InputError on an unknown host, Failure without
  /// a socket.
  PlotJuggler(const Endpoint& endpoint, std::vector<std::string> inputs,
              std::vector<std::string> targets);
  ~PlotJuggler() override;
  PlotJuggler(const PlotJuggler&) = delete;
  PlotJuggler& operator=(const PlotJuggler&) = delete;

  bool wants_predictions() const override { return true; }
  void learned(const LearnedSample& sample) override;
  void predicted(const PredictedSample& sample) override;
  void reckoned(const ReckonedSample& sample) override;
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
