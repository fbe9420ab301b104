// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "autopilot/byte_line.hpp"
#include "bag/mavlink_messages.hpp"

namespace kelpie::autopilot {

/// The senders on a link, in bounded memory, and the vehicle among them. A sender is a system with
/// a component, heard from one address: frames from a second address under the same numbers are
/// refused until the first address has been silent for Tuning::longest_silence. The vehicle is the
/// stated sender, or the first autopilot with data; once found, the vehicle stays.
class Senders {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Id = bag::MavlinkSender;

  /// The vehicle's numbers, as far as stated.
  struct Stated {
    std::uint8_t system = 0;     ///< 0: any
    std::uint8_t component = 0;  ///< 0: any
  };

  struct Sender {
    Id id;
    Address from;
    Time heard{};
    bool is_autopilot = false;       ///< has sent such a HEARTBEAT
    bool has_data = false;           ///< has sent a message that [log] names of the vehicle
    std::optional<Address> rival{};  ///< the first other address under the same numbers
    Time rival_heard{};
  };

  /// `named` are senders that [log] names by numbers. These and the vehicle stay in the full table;
  /// of the others, a new sender replaces the one without data and silent for longest.
  Senders(const Stated& stated, std::vector<Id> named)
      : stated_(stated), named_(std::move(named)) {}

  /// Takes note of a frame. Whether the frame may be used.
  bool accept(const mavlink::Frame& frame, const Address& from, bool has_data, Time now);

  /// Once a while: the autopilot to ask for data, the vehicle if found; null: none. An autopilot
  /// that brings no data gives way to the next after Tuning::longest_trial.
  const Sender* asked(Time now);

  bool is_kept(const Id& id) const;  ///< Whether the full table keeps a place.
  const std::optional<Id>& vehicle() const { return vehicle_; }
  std::size_t refused() const { return refused_; }  ///< frames
  /// Conflicts of the last Tuning::fault_memory, a sentence each.
  std::vector<std::string> faults(Time now) const;

 private:
  bool may_be_vehicle(const Id& id) const;
  Sender* find(const Id& id);
  Sender* place(const Id& id);

  Stated stated_;
  std::vector<Id> named_;
  std::vector<Sender> senders_;
  std::optional<Id> vehicle_;
  std::optional<Id> asked_;
  Time asked_since_{};
  Time others_heard_{};  // other autopilots, where the vehicle is not stated
  std::size_t refused_ = 0;
};

}  // namespace kelpie::autopilot
