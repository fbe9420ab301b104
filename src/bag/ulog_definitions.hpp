// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bag/reader.hpp"
#include "bag/ulog_messages.hpp"

namespace kelpie::bag {

/// The bytes before each message's own: its size, of two bytes, and its type.
inline constexpr std::size_t kUlogHead = 3;

/// A message of the file with what stands behind its head.
struct UlogRecord {
  char type = 0;
  std::size_t offset = 0;
  std::span<const std::byte> content{};

  std::size_t end() const { return offset + kUlogHead + content.size(); }
};

/// Whether there are messages of this type.
bool is_ulog_type(std::byte type);
/// The message at an offset, where one can begin there and is whole.
std::optional<UlogRecord> ulog_record_at(std::span<const std::byte> file, std::size_t at);

/// Whether a topic can be called so: not empty, printable ASCII without blanks and colons.
bool is_ulog_name(std::string_view text);

/// What a ULog file says of the messages of one number.
struct UlogSubscription {
  bool is_there = false;
  std::size_t topic = 0;
  std::optional<std::size_t> bytes{};    ///< of a message; none: its format isn't known
  std::optional<std::size_t> time_at{};  ///< where in it the field timestamp stands

  /// Whether a message can have that many bytes: some writers add the padding at its end.
  bool can_have(std::size_t size) const;
};

/// The formats and subscriptions of a ULog file.
class UlogDefinitions {
 public:
  /// "vehicle_attitude:uint64_t timestamp;float[4] q;". Returns "" or what is wrong with it.
  std::string add_format(std::string_view text);
  /// "sensor_accel", of further instances "sensor_accel[1]".
  Topic topic(const std::string& name, std::uint8_t instance) const;
  /// Messages of this number are of that topic, whose index is `index`.
  void subscribe(std::uint16_t number, const Topic& topic, std::size_t index);
  /// nullptr: nobody has subscribed to them.
  const UlogSubscription* find(std::uint16_t number) const;

 private:
  UlogFormats formats_;
  std::vector<UlogSubscription> subscriptions_;  // by number
};

/// When the autopilot began, in ns since 1970, from a message of a GPS with the date; 0 for any
/// other message.
std::int64_t ulog_begin_ns(const Topic& topic, std::span<const std::byte> message);

}  // namespace kelpie::bag
