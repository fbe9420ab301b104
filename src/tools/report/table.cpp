// SPDX-License-Identifier: Apache-2.0
#include "report/table.hpp"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "chart/wording.hpp"
#include "core/text.hpp"
#include "file/content.hpp"
#include "report/diagnosis_tables.hpp"
#include "report/provenance.hpp"
#include "report/stream_figures.hpp"
#include "report/stream_tables.hpp"
#include "study/alignment.hpp"
#include "study/current.hpp"
#include "study/diagnosis.hpp"
#include "study/summary.hpp"

namespace kelpie::report {
namespace {

constexpr std::size_t kColumns = 100;

std::string count(std::int64_t value) {
  constexpr std::int64_t kMillion = 1'000'000;
  return value < kMillion ? fmt::format("{}", value)
                          : fmt::format("{:.3g}M", static_cast<double>(value) / kMillion);
}

std::string microseconds(double value) {
  if (!std::isfinite(value)) {
    return chart::decimal(value);
  }
  return value < 1e6 ? fmt::format("{:.{}f}", value, value < 10.0 ? 1 : 0)
                     : fmt::format("{:.1e}", value);
}

std::string gap(double value) {
  return std::isfinite(value) ? fmt::format("{:.0e}", value) : chart::decimal(value);
}

// A model gone astray can be at −10⁸; such digits say nothing and would push the table apart.
std::string r2(double value) {
  return value < -999.0 ? "<−999" : chart::decimal(value);
}

// What only a budget or a solver in trouble brings about: rare, so a line instead of columns.
void add_trouble(std::vector<std::string>& notes, const study::AxisResult& axis) {
  const Tally& tally = axis.status.tally;
  std::vector<std::string> parts;
  for (const TallyField& field : study::totals_by_kind()) {
    const bool rare = field.kind == TallyKind::trouble || field.total == &Tally::crowded_out;
    if (const std::int64_t number = tally.*field.total; rare && number > 0) {
      parts.push_back(fmt::format("{} {}", count(number), field.label));
    }
  }
  if (!parts.empty()) {
    notes.push_back(name_of(axis) + ": " + join_text(parts, ", "));
  }
}

void add_changes(std::vector<std::string>& notes, const study::AxisResult& axis) {
  for (const study::ChangeFound& change : axis.changes) {
    notes.push_back(fmt::format(
        "{}: {}, found after {} samples at {} s (errors grew from {} s){}", name_of(axis),
        change.recalled > 0 ? fmt::format("the vehicle of past model {} is back", change.recalled)
                            : "the vehicle has changed",
        count(static_cast<std::int64_t>(change.samples)), chart::time_text(change.time_s),
        chart::time_text(change.since_s),
        change.withdrawn > 0
            ? fmt::format("; taken back after {} samples: the model before was better",
                          count(static_cast<std::int64_t>(change.withdrawn - change.samples)))
            : ""));
  }
}

std::string axes_table(const study::StreamResult& result) {
  chart::TextTable table{
      {},
      {"axis", "R²\nfinal", "R²\nmean", "min\n≥1000", "one\nahead", "SVs", "median\nµs", "p99\nµs",
       "KKT\ngap", "accepted", "turned\naway", "outliers", "forgotten"},
      {}};
  for (const study::AxisResult& axis : result.axes) {
    const study::Quantiles times = study::quantiles_of(axis.update_us);
    const Status& status = axis.status;
    table.rows.push_back({axis.name, r2(axis.r2_final), r2(axis.r2_mean),
                          r2(axis.r2_min_after_1000), r2(axis.prequential_r2),
                          count(status.support_vectors), microseconds(times.median),
                          microseconds(times.p99), gap(study::served_gap(status)),
                          count(status.tally.accepted), count(study::turned_away(status.tally)),
                          count(status.tally.outliers), count(status.tally.forgotten)});
    add_trouble(table.notes, axis);
    add_changes(table.notes, axis);
  }
  for (const std::string& line : study::finding_lines(result)) {
    table.notes.push_back(line);
  }
  if (result.memory_bytes > 0) {
    table.notes.push_back(fmt::format("memory: {} for {} ax{}s",
                                      file::megabytes(result.memory_bytes), result.axes.size(),
                                      result.axes.size() == 1 ? "i" : "e"));
  }
  return chart::table_text(table);
}

}  // namespace

std::string heading_text(const study::StreamResult& result) {
  std::string text =
      chart::shortened(result.source, kColumns) + "\n" +
      chart::shortened("split: " + result.split, kColumns) + "\n" +
      fmt::format("{} rows read, {} skipped; {} for training, {} held out; {} shown\n",
                  chart::grouped(result.rows_read), chart::grouped(result.rows_skipped),
                  chart::grouped(result.training_rows), chart::grouped(result.held_out_rows),
                  chart::grouped(result.samples_shown));
  if (!result.alignment.why.empty()) {
    text += study::alignment_text(result.alignment, result.rate_hz) + "\n";
  }
  if (!result.current.why.empty()) {
    text += "current: " + study::current_text(result.current) + "\n";
  }
  if (const std::string terms = terms_text(result); !terms.empty()) {
    text += terms + "\n";
  }
  if (!result.from.empty()) {
    text += chart::shortened("goes on from " + result.from, kColumns) + "\n";
  }
  if (result.interrupted) {
    text += fmt::format("INTERRUPTED after {} of {} training samples\n",
                        chart::grouped(result.samples_shown), chart::grouped(result.training_rows));
  }
  return text + "\n";
}

std::string result_table(const study::StreamResult& result) {
  std::string text = heading_text(result) + axes_table(result);
  std::vector<chart::TextTable> tables = coefficient_tables(result);
  tables.insert(tables.begin(), {health_table(result), baseline_table(result), member_table(result),
                                 coverage_table(result)});
  for (const chart::TextTable& table : tables) {
    text += table.rows.empty() ? "" : chart::table_text(table);
  }
  return text;
}

}  // namespace kelpie::report
