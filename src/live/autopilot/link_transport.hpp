// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "autopilot/byte_line.hpp"
#include "autopilot/link_settings.hpp"
#include "autopilot/parameter_keeper.hpp"
#include "autopilot/rate_keeper.hpp"
#include "autopilot/reporter.hpp"
#include "autopilot/senders.hpp"
#include "autopilot/signing.hpp"
#include "bag/mavlink_messages.hpp"
#include "live/configuration.hpp"
#include "live/transport.hpp"
#include "mavlink/frame_parser.hpp"
#include "mavlink/frame_writer.hpp"

namespace kelpie::autopilot {

/// Messages of an autopilot over UDP or a serial line, named as in .tlog files. After an
/// autopilot's first HEARTBEAT, requests the messages that [log] names at their rates, until the
/// rates are met, and the parameters of the outputs that [log] names (ParameterKeeper); sends an
/// own HEARTBEAT once a second and the Reporter's frames. Senders chooses the vehicle; with a key,
/// Signing checks every frame.
class LinkTransport final : public live::Transport {
 public:
  /// Throws InputError (file, topic or column) where [log] names an unknown message or field.
  /// Requires that the configuration outlives this.
  LinkTransport(const live::Configuration& configuration, const LinkSettings& settings,
                std::unique_ptr<ByteLine> line);

  const std::vector<bag::Topic>& topics() const override { return topics_; }
  Got next(bag::Message& message, std::chrono::milliseconds timeout) override;
  live::TransportHealth health() const override;
  live::Output* open_output(live::Requests& requests) override;

  /// Waits for the vehicle, at most Tuning::longest_check.
  std::vector<std::string> check() override;

 private:
  using Clock = std::chrono::steady_clock;

  void send_due(Clock::time_point now);
  void send_heartbeat();
  void ask(const Senders::Sender& autopilot);
  void request_rate(const RateKeeper::MessageRate& wanted);
  void request_parameter(const std::string& name);
  bool is_signed_well(const mavlink::Frame& frame);
  bool accept(const mavlink::Frame& frame, bag::Message& message);
  void hear_vehicle(const mavlink::Frame& frame);
  std::optional<std::size_t> topic_of(const mavlink::Frame& frame);
  mavlink::FrameWriter writer_of(std::uint8_t system);
  std::vector<std::string> vehicle_faults() const;

  const LinkSettings settings_;
  const std::vector<RateKeeper::MessageRate> wanted_;  // of the vehicle
  std::unique_ptr<ByteLine> line_;
  std::optional<Signing> signing_;
  Senders senders_;
  std::optional<Senders::Id> asked_;
  const std::vector<std::size_t> outputs_;  // of the vehicle, in [log]
  RateKeeper rates_;
  ParameterKeeper parameters_;
  const bool mirrors_;
  Reporter reporter_;
  bool reports_ = false;
  mavlink::FrameParser parser_;
  mavlink::FrameWriter writer_;
  std::vector<bag::Topic> topics_;
  std::map<std::pair<std::uint32_t, bag::MavlinkSender>, std::size_t> by_frame_;
  Address source_;         // of the frames in the parser
  std::size_t bytes_ = 0;  // received
  std::int64_t received_ns_ = 0;
  Clock::time_point began_ = Clock::now();
  Clock::time_point heartbeat_;  // the last own one
  Clock::time_point vehicle_heartbeat_;
  std::size_t unsigned_ = 0;                              // frames without a right signature
  Signing::Verdict signature_ = Signing::Verdict::right;  // the last other one
  Clock::time_point signature_at_;
};

/// Opens the link of a table [live.mavlink]. Throws as open_line() and LinkTransport do, with file,
/// line and key.
std::unique_ptr<live::Transport> open_link(const live::Configuration& configuration,
                                           const file::TomlNode& table);

}  // namespace kelpie::autopilot
