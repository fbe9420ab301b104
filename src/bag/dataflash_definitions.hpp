// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "bag/dataflash_messages.hpp"
#include "bag/reader.hpp"
#include "bag/topic_columns.hpp"

namespace kelpie::bag {

/// What is needed of every message of one number; offsets are within its own bytes.
struct DataflashKind {
  std::size_t bytes = 0;       ///< with its head; 0: no such message
  bool is_definition = false;  ///< FMT, FMTU, UNIT or MULT
  std::optional<std::size_t> instance_at{};
  std::optional<std::size_t> time_at{};
  bool is_in_ms = false;  ///< its time; else µs

  /// Requires time_at.
  std::uint64_t time_us(std::span<const std::byte> payload) const;
};

/// What the messages FMT, FMTU, UNIT and MULT of a file define. The first definition of a number is
/// the one that holds.
class DataflashDefinitions {
 public:
  static constexpr std::size_t kNumbers = 256;
  static constexpr std::uint8_t kFormatNumber = 128;  ///< of FMT, which defines itself as well

  DataflashDefinitions();

  /// Of one of the four messages, of this number.
  void learn(std::uint8_t number, std::span<const std::byte> payload);
  /// Once all are learned: finds times and instances.
  void finish();

  const DataflashKind& kind(std::uint8_t number) const { return kinds_[number]; }
  const DataflashFormat& format(std::uint8_t number) const { return formats_[number]; }
  /// What is wrong with an FMT: "", or that it can't be or isn't the definition that holds.
  std::string refusal(std::span<const std::byte> format_payload) const;
  /// The topic of a number's messages; of two numbers of one name the later is "ATT/77".
  Topic topic(std::uint8_t number, std::uint8_t instance) const;

 private:
  void learn_format(std::span<const std::byte> payload);
  void learn_unit(const DataflashFormat& format, std::span<const std::byte> payload);
  void find_fields(std::size_t number);

  std::array<DataflashFormat, kNumbers> formats_;
  std::array<DataflashKind, kNumbers> kinds_;
  DataflashUnits units_;
};

/// When the autopilot began, by the first fix of its GPS: weeks and ms of GPS's time, which is 18 s
/// ahead since 2017 (of older logs the date is a few seconds off).
class GpsClock {
 public:
  /// A message GPS. What has no such fields tells nothing.
  void hear(const DataflashFormat& format, std::span<const std::byte> payload);
  /// In ns since 1970; 0: not known.
  std::int64_t begin_ns() const { return begin_ns_; }

 private:
  void bind(const DataflashFormat& format);

  TopicColumns columns_{"GPS"};
  std::int64_t begin_ns_ = 0;
  bool has_failed_ = false;
};

}  // namespace kelpie::bag
