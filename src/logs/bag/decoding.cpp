// SPDX-License-Identifier: Apache-2.0
#include "bag/decoding.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "bag/dataflash_messages.hpp"
#include "bag/mavlink_messages.hpp"
#include "bag/tuning.hpp"
#include "bag/ulog_messages.hpp"
#include "core/seconds.hpp"
#include "core/text.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::bag {
namespace {

constexpr std::int64_t kMicrosecondNs = 1'000;

template <MessageDialect dialect>
MessageType text_type_of(const Topic& topic, const MessageDefinitions& definitions) {
  return definitions.type(topic.type, topic.definition, dialect);
}

template <MessageDialect dialect>
std::string text_definition_of(const Topic& topic, const MessageDefinitions& definitions) {
  return definitions.full_text(topic.type, topic.definition, dialect);
}

std::string mavlink_definition_of(const Topic& topic, const MessageDefinitions& definitions) {
  mavlink_type_of(topic, definitions);  // has the checks
  return {};
}

// Theirs came with the file.
std::string no_definition_of(const Topic& /*topic*/, const MessageDefinitions& /*definitions*/) {
  return {};
}

std::vector<StampPart> header_stamp_of(const MessageType& type) {
  const std::size_t sec = type.find("header.stamp.sec");
  const std::size_t nanosec = type.find("header.stamp.nanosec");
  const auto is = [&](std::size_t leaf, FieldKind kind) {
    return leaf < type.leaves.size() && type.leaves[leaf].kind == kind;
  };
  return (is(sec, FieldKind::int32) || is(sec, FieldKind::uint32)) && is(nanosec, FieldKind::uint32)
             ? std::vector<StampPart>{{sec, kSecondNs}, {nanosec, 1}}
             : std::vector<StampPart>{};
}

constexpr std::array<Encoding, 5> kEncodings{{
    {"cdr", text_type_of<MessageDialect::ros2>, text_definition_of<MessageDialect::ros2>,
     visit_numbers, header_stamp_of},
    {"ros1", text_type_of<MessageDialect::ros1>, text_definition_of<MessageDialect::ros1>,
     visit_packed_numbers, header_stamp_of},
    {"mavlink", mavlink_type_of, mavlink_definition_of, visit_mavlink_numbers, mavlink_stamp_of},
    {"dataflash", dataflash_type_of, no_definition_of, visit_packed_numbers, dataflash_stamp_of},
    {"ulog", ulog_type_of, no_definition_of, visit_ulog_numbers, ulog_stamp_of},
}};

}  // namespace

const Encoding& encoding_called(std::string_view name) {
  const auto* const found = std::ranges::find(kEncodings, name, &Encoding::name);
  if (found == kEncodings.end()) {
    std::vector<std::string> names;
    std::ranges::transform(kEncodings, std::back_inserter(names),
                           [](const Encoding& one) { return std::string(one.name); });
    throw InputError("its messages are encoded as '" + std::string(name) + "'; only " +
                     join_text(names, ", ") + " are decoded");
  }
  return *found;
}

std::string definition_of(const Topic& topic, const MessageDefinitions& definitions) {
  return topic.definition.empty()
             ? encoding_called(topic.encoding).definition_of(topic, definitions)
             : topic.definition;
}

bool decode(MessageReader& bag, const Message& message, const Decoder& decoder,
            NumberVisitor& visitor) {
  try {
    decoder.visit(message.data, visitor);
    return true;
  } catch (const InputError& error) {
    bag.lose(InputError(bag.place(), error.what()));
    return false;
  }
}

StampReader::StampReader(const Decoder& decoder) {
  for (const StampPart& part : decoder.stamp()) {
    const MessageType::Leaf& leaf = decoder.type().leaves[part.leaf];
    // A part among several, as nanoseconds within a second, goes back all the time.
    const bool wraps = leaf.kind == FieldKind::uint32 && decoder.stamp().size() == 1;
    parts_.push_back({.part = part,
                      .path = leaf.path,
                      .wraps_at = wraps ? std::int64_t{1} << 32 : std::int64_t{0}});
  }
}

bool StampReader::wants(std::size_t leaf) const {
  return std::ranges::any_of(parts_, [&](const Part& one) { return one.part.leaf == leaf; });
}

void StampReader::number(std::size_t leaf, double value) {
  for (Part& one : parts_) {
    if (one.part.leaf != leaf) {
      continue;
    }
    if (!(std::abs(value) * static_cast<double>(one.part.unit_ns) <=
          static_cast<double>(Message::kLatestNs))) {
      throw InputError(one.path, "is not a time before the year 2116");
    }
    one.value = static_cast<std::int64_t>(value);
  }
}

std::int64_t StampReader::time_ns() const {
  std::int64_t time_ns = 0;
  for (const Part& one : parts_) {
    time_ns += (one.value + one.wrapped) * one.part.unit_ns;
  }
  return time_ns;
}

bool StampReader::wraps() const {
  return parts_.size() == 1 && parts_[0].wraps_at > 0;
}

bool StampReader::wraps_soon() const {
  return wraps() && parts_[0].part.unit_ns <= kMicrosecondNs;
}

void StampReader::place(std::int64_t near_ns) {
  Part& one = parts_.front();
  const std::int64_t count = near_ns / one.part.unit_ns;
  const auto left = static_cast<double>(count - one.value);
  const double overflows = std::round(left / static_cast<double>(one.wraps_at));
  one.wrapped = one.wraps_at * static_cast<std::int64_t>(std::fmax(overflows, 0.0));
}

}  // namespace kelpie::bag
