// SPDX-License-Identifier: Apache-2.0
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "bag/inspect.hpp"

namespace kelpie::bag {
namespace {

constexpr std::int64_t kNanoseconds = 1'000'000'000;

// Names come from the file: nothing that would steer a terminal.
std::string shown(std::string text) {
  std::ranges::replace_if(
      text, [](char letter) { return (letter >= 0 && letter < ' ') || letter == '\x7F'; }, '?');
  return text;
}

std::string date_text(std::int64_t time_ns) {
  return fmt::format("{:%Y-%m-%d %H:%M:%S} UTC", fmt::gmtime(time_ns / kNanoseconds));
}

void add_topic_line(std::string& text, const TopicReport& topic, std::size_t width) {
  const std::string name = shown(topic.name);
  text += fmt::format("{:<{}} {:>8} {:>8.2f} {:>8.3f} {:>9.3f}", name, width, topic.messages,
                      topic.rate_hz, topic.longest_gap_s, topic.longest_gap_at_s);
  text += topic.clock_offset ? fmt::format(" {:>10.4f} {:>8.4f}", topic.clock_offset->median_s,
                                           topic.clock_offset->high_s - topic.clock_offset->low_s)
                             : fmt::format(" {:>10} {:>8}", "–", "–");
  text += fmt::format("  {}\n", shown(topic.type));
}

void add_fields(std::string& text, const TopicReport& topic) {
  text += fmt::format("\n{}\n", shown(topic.name));
  if (!topic.not_decoded.empty()) {
    text += fmt::format("  not decoded: {}\n", shown(topic.not_decoded));
  }
  for (const FieldRange& field : topic.fields) {
    text += fmt::format("  {:<44} {:>14} {:>14}", shown(field.path),
                        field.finite > 0 ? fmt::format("{:.6g}", field.low) : "–",
                        field.finite > 0 ? fmt::format("{:.6g}", field.high) : "–");
    text += field.not_finite > 0 ? fmt::format("  {} not finite\n", field.not_finite) : "\n";
  }
}

nlohmann::ordered_json field_json(const FieldRange& field) {
  nlohmann::ordered_json json{{"path", field.path}};
  json["low"] = field.finite > 0 ? nlohmann::ordered_json(field.low) : nullptr;
  json["high"] = field.finite > 0 ? nlohmann::ordered_json(field.high) : nullptr;
  json["finite"] = field.finite;
  json["not_finite"] = field.not_finite;
  return json;
}

nlohmann::ordered_json topic_json(const TopicReport& topic) {
  nlohmann::ordered_json json{
      {"name", topic.name},
      {"type", topic.type},
      {"messages", topic.messages},
      {"rate_hz", topic.rate_hz},
      {"longest_gap_s", topic.longest_gap_s},
      {"longest_gap_at_s", topic.longest_gap_at_s},
  };
  json["clock_offset_s"] = topic.clock_offset
                               ? nlohmann::ordered_json{{"median", topic.clock_offset->median_s},
                                                        {"low", topic.clock_offset->low_s},
                                                        {"high", topic.clock_offset->high_s}}
                               : nlohmann::ordered_json(nullptr);
  json["fields"] = nlohmann::ordered_json::array();
  std::ranges::transform(topic.fields, std::back_inserter(json["fields"]), field_json);
  if (!topic.not_decoded.empty()) {
    json["not_decoded"] = topic.not_decoded;
  }
  return json;
}

}  // namespace

std::string bag_report_table(const BagReport& report, const std::string& source) {
  std::string text =
      fmt::format("{}: {} messages, {} topics\n", source, report.messages, report.topics.size());
  if (report.messages > 0) {
    text += fmt::format("from {}, {:.3f} s\n", date_text(report.start_ns), report.duration_s);
  }
  std::size_t width = 5;
  for (const TopicReport& topic : report.topics) {
    width = std::max(width, topic.name.size());
  }
  text += fmt::format("\n{:<{}} {:>8} {:>8} {:>8} {:>9} {:>10} {:>8}  type\n", "topic", width,
                      "messages", "rate/Hz", "gap/s", "at/s", "offset/s", "spread/s");
  for (const TopicReport& topic : report.topics) {
    add_topic_line(text, topic, width);
  }
  for (const TopicReport& topic : report.topics) {
    add_fields(text, topic);
  }
  return text;
}

std::string bag_report_json(const BagReport& report, const std::string& source) {
  nlohmann::ordered_json json{
      {"bag", source},
      {"messages", report.messages},
      {"start_ns", report.start_ns},
      {"duration_s", report.duration_s},
      {"topics", nlohmann::ordered_json::array()},
      {"losses", report.losses},
      {"loss_count", report.loss_count},
  };
  std::ranges::transform(report.topics, std::back_inserter(json["topics"]), topic_json);
  // A damaged name needn't be UTF-8.
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace kelpie::bag
