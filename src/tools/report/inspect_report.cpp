// SPDX-License-Identifier: Apache-2.0
#include "report/inspect_report.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "chart/text_table.hpp"
#include "chart/wording.hpp"
#include "core/seconds.hpp"
#include "core/text.hpp"
#include "file/json.hpp"
#include "format/model_parts.hpp"
#include "report/tuning.hpp"
#include "study/alignment.hpp"

namespace kelpie::report {
namespace {

std::string date_text(std::int64_t time_ns) {
  return fmt::format("{:%Y-%m-%d %H:%M:%S} UTC", fmt::gmtime(time_ns / kSecondNs));
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
      .title = topic.name, .head = {}, .rows = {}, .left = {0, 4}, .whole = true};
  for (const bag::FieldRange& field : topic.fields) {
    const bool some = field.finite > 0;
    table.head = {topic.name.empty() ? "column" : "field", "lowest", "highest", "noise"};
    table.rows.push_back(
        {field.path, some ? fmt::format("{:.6g}", field.low) : "–",
         some ? fmt::format("{:.6g}", field.high) : "–",
         field.noise ? fmt::format("{:.3g}", *field.noise) : "–",
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
          {"not_finite", field.not_finite},
          {"noise", field.noise ? file::Json(*field.noise) : nullptr}};
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

std::string table_of_columns(const bag::BagReport& report, const std::string& source) {
  const bag::TopicReport& topic = report.topics.front();
  std::string text = fmt::format("{}: {} rows, {} columns of numbers\n", source, topic.messages,
                                 topic.fields.size());
  text += topic.rate_hz > 0.0
              ? fmt::format(
                    "{:.3f} s, {:.4g} rows per second, the longest gap {:.4g} s at {:.3f} s\n",
                    report.duration_s, topic.rate_hz, topic.longest_gap_s, topic.longest_gap_at_s)
              : "no column of time\n";
  return text + "\n" + chart::table_text(fields_table(topic));
}

std::string first_look_text(const study::FirstLook& look) {
  chart::TextTable table{.title = fmt::format("A first look: least squares on {} rows, {} of them "
                                              "held out",
                                              look.rows, look.held_out),
                         .head = {"target", "R²", "without commands"},
                         .rows = {},
                         .left = {0},
                         .whole = true};
  std::vector<std::string> helped;
  for (const study::FirstLook::Axis& axis : look.axes) {
    table.rows.push_back({axis.target, fmt::format("{:.2f}", axis.r2),
                          fmt::format("{:.2f}", axis.r2_without_commands)});
    if (axis.r2 > std::max(axis.r2_without_commands, 0.0) + kTuning.clear_gain) {
      helped.push_back(axis.target);
    }
  }
  table.notes = {
      "alignment: " + study::alignment_text(look.alignment, look.rate_hz),
      helped.empty()
          ? "nothing shows that these commands move these velocities: they are wrong, too "
            "slow, or hardly change"
          : "commands and velocities belong together: commands explain " + join_text(helped, ", ")};
  return "\n" + chart::table_text(table);
}

file::Json mistake_json(const log::Mistake& mistake) {
  return {{"what", mistake.what}, {"remedy", mistake.remedy}, {"refused", mistake.is_refused}};
}

file::Json look_json(const study::FirstLook& look) {
  file::Json axes = file::Json::array();
  for (const study::FirstLook::Axis& axis : look.axes) {
    axes.push_back({{"target", axis.target},
                    {"r2", file::number(axis.r2)},
                    {"r2_without_commands", file::number(axis.r2_without_commands)}});
  }
  return {{"rows", look.rows},
          {"held_out", look.held_out},
          {"shift_s", look.alignment.alignment.lag_s},
          {"actuators", format::actuators_json(look.alignment.alignment)},
          {"shift_why", look.alignment.why},
          {"axes", axes}};
}

}  // namespace

std::string inspect_table(const bag::BagReport& report, const std::string& source) {
  if (report.topics.size() == 1 && report.topics.front().name.empty()) {
    return table_of_columns(report, source);
  }
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

std::string draft_table(const log::Draft& draft, const std::optional<study::FirstLook>& look) {
  std::string text = draft.is_complete() ? "To be learned, by types, names and units:\n"
                                         : "To be learned, but for what is open:\n";
  const auto add = [&](const char* mark, const std::vector<std::string>& lines) {
    for (const std::string& line : lines) {
      text += mark + line + "\n";
    }
  };
  add("  ", draft.taken);
  add("  open: ", draft.open);
  add("  ! ", draft.remarks);
  if (look) {
    text += first_look_text(*look);
  }
  return text;
}

std::string mistakes_text(const std::vector<log::Mistake>& mistakes) {
  std::string text;
  for (const log::Mistake& mistake : mistakes) {
    text += chart::wrapped(chart::safe_text((mistake.is_refused ? "MISTAKE: " : "WARNING: ") +
                                            log::mistake_text(mistake))) +
            "\n";
  }
  return text;
}

std::string inspect_json(const bag::BagReport& report, const log::Draft& draft,
                         const std::optional<study::FirstLook>& look,
                         const std::vector<log::Mistake>& mistakes, const std::string& source) {
  return file::json_text({{"bag", source},
                          {"messages", report.messages},
                          {"start_ns", report.start_ns},
                          {"duration_s", report.duration_s},
                          {"topics", file::list(report.topics, topic_json)},
                          {"losses", report.losses},
                          {"loss_count", report.loss_count},
                          {"passed_over", report.passed_over},
                          {"left_out", report.left_out},
                          {"draft",
                           {{"complete", draft.is_complete()},
                            {"taken", draft.taken},
                            {"open", draft.open},
                            {"remarks", draft.remarks}}},
                          {"mistakes", file::list(mistakes, mistake_json)},
                          {"first_look", look ? look_json(*look) : file::Json(nullptr)}});
}

}  // namespace kelpie::report
