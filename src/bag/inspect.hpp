// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bag/message_type.hpp"
#include "bag/reader.hpp"

namespace kelpie::bag {

/// What values a numeric field took over all messages; of an array or sequence, all its elements.
struct FieldRange {
  static constexpr std::size_t kMostElements = 32;

  /// One of an array or sequence.
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
  std::string unit{};          ///< where the type's definition has one
  /// σ of white noise, in its unit (Statistics::noise); of several elements the largest
  std::optional<double> noise{};
  std::vector<Element> elements{};  ///< the first kMostElements; none where it is a single number
};

/// Receive time minus header stamp [s]: delay of the transport plus offset of the clocks.
struct ClockOffset {
  double median_s = 0.0;
  double low_s = 0.0;
  double high_s = 0.0;
};

/// What one topic of a bag holds.
struct TopicReport {
  std::string name;
  std::string type;
  std::size_t messages = 0;
  double rate_hz = 0.0;           ///< mean over the topic's own time; 0 with fewer than 2 messages
  double longest_gap_s = 0.0;     ///< between two messages as received
  double longest_gap_at_s = 0.0;  ///< when it began, since the bag's first message
  std::optional<ClockOffset> clock_offset{};  ///< none: no header or nothing decoded
  std::vector<FieldRange> fields{};           ///< numeric ones; not the elements of byte sequences
  std::string not_decoded{};                  ///< why there are no fields, or empty
};

/// What a bag holds, topic by topic.
struct BagReport {
  std::size_t messages = 0;
  std::int64_t start_ns = 0;  ///< receive time of the first message
  double duration_s = 0.0;
  std::vector<TopicReport> topics;  ///< in the order of their names
  std::vector<std::string> losses;  ///< of a recovered bag, the first ones
  std::size_t loss_count = 0;
};

/// Reads a bag to its end. Topics that can't be decoded are counted all the same.
/// Throws what reading and, in strict mode, decoding throws.
/// Memory: 8 bytes per message, 16 where there is a header; 4 kB per number of a topic's message.
BagReport inspect_bag(MessageReader& bag, const MessageDefinitions& definitions);

}  // namespace kelpie::bag
