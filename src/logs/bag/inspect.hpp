// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bag/message_type.hpp"
#include "bag/reader.hpp"

namespace kelpie::bag {

/// Range of a numeric field over all messages; of an array or sequence, over all elements.
struct FieldRange {
  static constexpr std::size_t kMostElements = 32;

  /// An element of an array or sequence.
  struct Element {
    double low = 0.0;
    double high = 0.0;
    std::size_t finite = 0;
  };

  std::string path;  ///< "twist.twist.linear.x", "velocity[]"
  double low = 0.0;  ///< of the finite values
  double high = 0.0;
  std::size_t finite = 0;      ///< number of finite values
  std::size_t not_finite = 0;  ///< NaN and infinities
  std::string unit{};          ///< where the type defines a unit
  /// σ of white noise, in the field's unit (Statistics::noise); for arrays the largest of the
  /// elements
  std::optional<double> noise{};
  double rate_hz = 0.0;  ///< of finite values by their median step; 0: as the topic's messages
  std::vector<Element> elements{};  ///< the first kMostElements; empty for a single number
};

/// Receive time minus header stamp [s]: delay of the transport plus offset of the clocks.
struct ClockOffset {
  double median_s = 0.0;
  double low_s = 0.0;
  double high_s = 0.0;
};

/// Content of a topic.
struct TopicReport {
  std::string name;
  std::string type;
  std::size_t messages = 0;
  double rate_hz = 0.0;           ///< mean over the topic's own time; 0 with fewer than 2 messages
  double longest_gap_s = 0.0;     ///< between two messages as received
  double longest_gap_at_s = 0.0;  ///< start of the gap, since the first message of the bag
  std::optional<ClockOffset> clock_offset{};  ///< empty: no header, or not decoded
  std::vector<FieldRange> fields{};  ///< numeric fields, without elements of byte sequences
  std::string not_decoded{};         ///< reason for missing fields, or empty
};

/// What the autopilot of a recording says of itself (AutopilotState).
struct AutopilotReport {
  std::map<std::string, double> parameters;  ///< the last value of each
  bool was_armed = false;
  bool was_disarmed = false;
  double armed_s = 0.0;  ///< time that armed_only of read_series() keeps
};

/// Content of a recording, by topic.
struct BagReport {
  std::size_t messages = 0;
  std::int64_t start_ns = 0;  ///< receive time of the first message
  double duration_s = 0.0;
  std::vector<TopicReport> topics;  ///< sorted by name
  std::vector<std::string> losses;  ///< the first losses of a recovered bag
  std::size_t loss_count = 0;
  std::map<std::string, std::size_t> passed_over;  ///< MessageReader::passed_over()
  std::vector<std::string> left_out;               ///< MessageReader::left_out()
  AutopilotReport autopilot;
};

/// Reads a recording to the end. Topics that cannot be decoded are counted too. Throws as reading
/// and, in strict mode, decoding do. Memory: 8 bytes per message, 16 with header; 4 kB per number
/// of a topic's message.
BagReport inspect_bag(MessageReader& bag, const MessageDefinitions& definitions);

}  // namespace kelpie::bag
