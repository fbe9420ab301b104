// SPDX-License-Identifier: Apache-2.0
#include "bag/ulog_definitions.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "bag/topic_columns.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::bag {
namespace {

constexpr std::size_t kMostTrailingPadding = 7;
constexpr std::string_view kUlogTypes = "BFIMPQARDLCSO";

bool is_ascii(std::string_view text) {
  return std::ranges::all_of(text, [](char c) { return c >= ' ' && c <= '~'; });
}

std::optional<std::size_t> place_of_time(const MessageType& type) {
  std::size_t offset = 0;
  for (const Field& field : type.root.fields) {
    if (field.name == "timestamp" && field.kind == FieldKind::uint64 &&
        field.shape == FieldShape::single) {
      return offset;
    }
    offset += field.least_bytes * (field.shape == FieldShape::array ? field.size : 1);
  }
  return std::nullopt;
}

}  // namespace

bool is_ulog_type(std::byte type) {
  return kUlogTypes.find(static_cast<char>(type)) != std::string_view::npos;
}

std::optional<UlogRecord> ulog_record_at(std::span<const std::byte> file, std::size_t at) {
  const std::span<const std::byte> left = file.subspan(at);
  if (left.size() < kUlogHead || !is_ulog_type(left[2])) {
    return std::nullopt;
  }
  const std::size_t size = wire::number_at<std::uint16_t>(left, std::endian::little);
  if (size > left.size() - kUlogHead) {
    return std::nullopt;
  }
  return UlogRecord{
      .type = static_cast<char>(left[2]), .offset = at, .content = left.subspan(kUlogHead, size)};
}

bool is_ulog_name(std::string_view text) {
  return !text.empty() && is_ascii(text) && text.find_first_of(" :") == std::string_view::npos;
}

bool UlogSubscription::can_have(std::size_t size) const {
  return !bytes || (size >= *bytes && size <= *bytes + kMostTrailingPadding);
}

std::string UlogDefinitions::add_format(std::string_view text) {
  const std::size_t colon = std::min(text.find(':'), text.size());
  const std::string name(text.substr(0, colon));
  if (colon == text.size() || !is_ulog_name(name) || !is_ascii(text)) {
    return "is no format, as in vehicle_attitude:uint64_t timestamp;float[4] q;";
  }
  const std::string_view fields = text.substr(colon + 1);
  const auto [found, is_new] = formats_.try_emplace(name, fields);
  return found->second == fields ? "" : "there are two formats " + name;
}

Topic UlogDefinitions::topic(const std::string& name, std::uint8_t instance) const {
  return {.name = instance == 0 ? name : fmt::format("{}[{}]", name, instance),
          .type = name,
          .encoding = "ulog",
          .definition = ulog_definition(name, formats_)};
}

void UlogDefinitions::subscribe(std::uint16_t number, const Topic& topic, std::size_t index) {
  UlogSubscription subscription{.is_there = true, .topic = index};
  try {
    const MessageType type = ulog_type_of(topic, MessageDefinitions());
    subscription.bytes = type.root.least_bytes;
    subscription.time_at = place_of_time(type);
  } catch (const InputError&) {  // who wants the topic will say so
  }
  subscriptions_.resize(std::max<std::size_t>(subscriptions_.size(), number + std::size_t{1}));
  subscriptions_[number] = subscription;
}

const UlogSubscription* UlogDefinitions::find(std::uint16_t number) const {
  const bool is_there = number < subscriptions_.size() && subscriptions_[number].is_there;
  return is_there ? &subscriptions_[number] : nullptr;
}

std::int64_t ulog_begin_ns(const Topic& topic, std::span<const std::byte> message) {
  if (topic.type != "vehicle_gps_position" && topic.type != "sensor_gps") {
    return 0;
  }
  TopicColumns columns(topic.name);
  try {
    columns.ask(parse_column(topic.name + ":timestamp"));
    columns.ask(parse_column(topic.name + ":time_utc_usec"));
    columns.bind(topic, MessageDefinitions(), Clock::receive);
    columns.begin({});
    columns.decoder().visit(message, columns);
  } catch (const InputError&) {  // the format has no date
    return 0;
  }
  const double boot_us = columns.values()[0];
  const double utc_us = columns.values()[1];
  constexpr double kLatestUs = static_cast<double>(Message::kLatestNs) / 1e3;
  return boot_us >= 0.0 && utc_us > boot_us && utc_us < kLatestUs
             ? (static_cast<std::int64_t>(utc_us) - static_cast<std::int64_t>(boot_us)) * 1'000
             : 0;
}

}  // namespace kelpie::bag
