// SPDX-License-Identifier: Apache-2.0
#include "report/inspect_report.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "chart/text_table.hpp"
#include "chart/wording.hpp"
#include "file/json.hpp"

namespace kelpie::report {
namespace {

constexpr std::int64_t kNanoseconds = 1'000'000'000;

std::string date_text(std::int64_t time_ns) {
  return fmt::format("{:%Y-%m-%d %H:%M:%S} UTC", fmt::gmtime(time_ns / kNanoseconds));
}

chart::TextTable topics_table(const bag::BagReport& report) {
  chart::TextTable table{
      .title = {},
      .head = {"topic", "messages", "rate/Hz", "gap/s", "at/s", "offset/s", "spread/s", "type"},
      .rows = {},
      .left = {0, 7},
      .whole = true};
  for (const bag::TopicReport& topic : report.topics) {
    const auto& offset = topic.clock_offset;
    table.rows.push_back(
        {topic.name, fmt::format("{}", topic.messages), fmt::format("{:.2f}", topic.rate_hz),
         fmt::format("{:.3f}", topic.longest_gap_s), fmt::format("{:.3f}", topic.longest_gap_at_s),
         offset ? fmt::format("{:.4f}", offset->median_s) : "–",
         offset ? fmt::format("{:.4f}", offset->high_s - offset->low_s) : "–", topic.type});
  }
  return table;
}

chart::TextTable fields_table(const bag::TopicReport& topic) {
  chart::TextTable table{
      .title = topic.name, .head = {}, .rows = {}, .left = {0, 3}, .whole = true};
  for (const bag::FieldRange& field : topic.fields) {
    const bool some = field.finite > 0;
    table.head = {"field", "lowest", "highest"};
    table.rows.push_back(
        {field.path, some ? fmt::format("{:.6g}", field.low) : "–",
         some ? fmt::format("{:.6g}", field.high) : "–",
         field.unit + (field.unit.empty() || field.not_finite == 0 ? "" : ", ") +
             (field.not_finite > 0 ? fmt::format("{} not finite", field.not_finite) : "")});
  }
  if (!topic.not_decoded.empty()) {
    table.notes = {"not decoded: " + topic.not_decoded};
  }
  return table;
}

file::Json field_json(const bag::FieldRange& field) {
  const bool some = field.finite > 0;
  return {{"path", field.path},
          {"unit", field.unit},
          {"low", some ? file::Json(field.low) : nullptr},
          {"high", some ? file::Json(field.high) : nullptr},
          {"finite", field.finite},
          {"not_finite", field.not_finite}};
}

file::Json topic_json(const bag::TopicReport& topic) {
  const auto& offset = topic.clock_offset;
  file::Json json{{"name", topic.name},
                  {"type", topic.type},
                  {"messages", topic.messages},
                  {"rate_hz", topic.rate_hz},
                  {"longest_gap_s", topic.longest_gap_s},
                  {"longest_gap_at_s", topic.longest_gap_at_s},
                  {"clock_offset_s", offset ? file::Json{{"median", offset->median_s},
                                                         {"low", offset->low_s},
                                                         {"high", offset->high_s}}
                                            : file::Json(nullptr)},
                  {"fields", file::list(topic.fields, field_json)}};
  if (!topic.not_decoded.empty()) {
    json["not_decoded"] = topic.not_decoded;
  }
  return json;
}

}  // namespace

std::string inspect_table(const bag::BagReport& report, const std::string& source) {
  std::string text =
      fmt::format("{}: {} messages, {} topics\n", source, report.messages, report.topics.size());
  if (report.messages > 0) {
    text += fmt::format("from {}, {:.3f} s\n", date_text(report.start_ns), report.duration_s);
  }
  text += "\n" + chart::table_text(topics_table(report));
  for (const bag::TopicReport& topic : report.topics) {
    text += chart::table_text(fields_table(topic));
  }
  return text;
}

std::string inspect_json(const bag::BagReport& report, const std::string& source) {
  return file::json_text({{"bag", source},
                          {"messages", report.messages},
                          {"start_ns", report.start_ns},
                          {"duration_s", report.duration_s},
                          {"topics", file::list(report.topics, topic_json)},
                          {"losses", report.losses},
                          {"loss_count", report.loss_count}});
}

}  // namespace kelpie::report
