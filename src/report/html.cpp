// SPDX-License-Identifier: Apache-2.0
#include "report/html.hpp"

#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <utility>
#include <vector>

#include "chart/page.hpp"
#include "chart/wording.hpp"
#include "kelpie/core/text.hpp"
#include "report/coefficient_tables.hpp"
#include "report/coverage_table.hpp"
#include "report/interval_figures.hpp"
#include "report/stream_figures.hpp"
#include "report/yardstick_table.hpp"
#include "study/alignment.hpp"
#include "study/summary.hpp"

namespace kelpie::report {
namespace {

constexpr chart::PlotSize kPanel{400, 250};
constexpr chart::PlotSize kSquare{400, 380};
constexpr chart::PlotSize kWide{980, 330};
constexpr chart::PlotSize kWideInPair{760, 330};
constexpr std::size_t kLongestTitle = 80;

std::string rows_text(std::size_t n) {
  return chart::grouped(static_cast<std::int64_t>(n));
}

std::string heading(const study::AxisResult& axis) {
  return "<h3>" + chart::escape_markup(chart::shortened(axis.name, kLongestTitle)) + "</h3>\n";
}

// One panel per axis, side by side where there is room.
template <typename Draw>
std::string panels(const study::StreamResult& result, Draw draw) {
  std::string text = "<div class=\"grid-panels\">\n";
  for (const study::AxisResult& axis : result.axes) {
    text += "<div>\n" + heading(axis) + draw(axis) + "</div>\n";
  }
  return text + "</div>\n";
}

std::string list_text(const std::vector<std::string>& parts) {
  if (parts.size() < 2) {
    return parts.empty() ? "" : parts.front();
  }
  const std::span<const std::string> all(parts);
  return join_text(all.first(all.size() - 1), ", ") + " and " + parts.back();
}

// What the numbers mean, in sentences: axes by whether the model is of use.
std::string verdict(const study::StreamResult& result) {
  std::vector<std::string> useful;
  std::vector<std::string> useless;
  std::vector<std::string> unknown;
  for (const study::AxisResult& axis : result.axes) {
    const std::string name = chart::shortened(axis.name, kLongestTitle);
    if (!std::isfinite(axis.r2_final)) {
      unknown.push_back(name);
    } else if (axis.r2_final < 0.0) {
      useless.push_back(fmt::format("{} (R² {})", name, chart::decimal(axis.r2_final)));
    } else {
      useful.push_back(fmt::format("{:.1f} % of the variance of {}", 100.0 * axis.r2_final, name));
    }
  }
  std::string text;
  if (!useful.empty()) {
    text += "On rows it was never shown, the model at the end of the stream explains " +
            list_text(useful) + ". ";
  }
  if (!useless.empty()) {
    text +=
        "It predicts worse than the mean of the held-out rows would: " + list_text(useless) + ". ";
  }
  if (!unknown.empty()) {
    text += "No R² was measured for " + list_text(unknown) + ". ";
  }
  return text;
}

std::string opening(const study::StreamResult& result) {
  const std::string log = std::filesystem::path(result.source).filename().string();
  const std::string title = chart::shortened("What kelpie learned from " + log, kLongestTitle);
  std::string text = "<h1>" + chart::escape_markup(title) + "</h1>\n";
  if (result.interrupted) {
    text += chart::paragraph(
        "interrupted",
        fmt::format("This run was interrupted after {} of {} training samples. "
                    "Everything below describes that part only.",
                    rows_text(result.samples_shown), rows_text(result.training_rows)));
  }
  text += chart::paragraph("lead", verdict(result));
  text +=
      chart::paragraph("note", fmt::format("{} training samples shown once, in the order of time; "
                                           "{} rows held out ({}).",
                                           rows_text(result.samples_shown),
                                           rows_text(result.held_out_rows), result.split));
  return text;
}

std::string r2_cell(double value) {
  return fmt::format("<td{}>{}</td>", value < 0.0 ? " class=\"bad\"" : "", chart::decimal(value));
}

std::string summary_table(const study::StreamResult& result) {
  std::string rows;
  for (const study::AxisResult& axis : result.axes) {
    const study::Quantiles times = study::quantiles_of(axis.update_us);
    rows += "<tr><td>" + chart::escape_markup(chart::shortened(axis.name, kLongestTitle)) +
            "</td>" + r2_cell(axis.r2_final) + r2_cell(axis.r2_mean) +
            r2_cell(axis.r2_min_after_1000) + r2_cell(axis.prequential_r2);
    const double gap = study::served_gap(axis.status);
    for (const std::string& cell :
         {chart::grouped(axis.status.support_vectors), chart::grouped(axis.status.buffer),
          chart::duration(times.median), chart::duration(times.p99),
          std::isfinite(gap) ? fmt::format("{:.1e}", gap) : "–"}) {
      rows += "<td>" + cell + "</td>";
    }
    rows += "</tr>\n";
  }
  return "<h2>Summary</h2>\n<div class=\"scroll\">\n<table>\n<thead><tr><th>axis</th>"
         "<th>R²<br/>final</th><th>R²<br/>mean</th><th>R² min<br/>after 1,000</th>"
         "<th>R² one<br/>ahead</th><th>support<br/>vectors</th><th>buffer</th>"
         "<th>update<br/>median</th><th>update<br/>p99</th><th>KKT<br/>gap</th>"
         "</tr></thead>\n<tbody>\n" +
         rows + "</tbody>\n</table>\n</div>\n" +
         chart::paragraph(
             "note",
             "R² one ahead: each sample predicted just before it was learned. KKT gap: the "
             "largest violation of the optimality conditions, in units of the standardised "
             "target.");
}

std::string yardstick_section(const study::StreamResult& result) {
  const chart::TextTable table = yardstick_table(result);
  return "<h2>" + table.title + "</h2>\n" + chart::html_table(table.head, table.rows) +
         chart::paragraph("note", table.notes.front());
}

// Totals of every node; samples turned away in one column.
std::string tally_table(const study::StreamResult& result) {
  std::vector<std::string> head{"axis", "accepted", "turned away"};
  std::vector<std::vector<std::string>> rows;
  for (const study::AxisResult& axis : result.axes) {
    const Tally& tally = axis.status.tally;
    rows.push_back({chart::shortened(axis.name, kLongestTitle), chart::grouped(tally.accepted),
                    chart::grouped(study::turned_away(tally))});
  }
  std::string note;
  for (const TallyField& field : study::totals_by_kind()) {
    if (field.total == &Tally::accepted || study::turned_away(field)) {
      continue;
    }
    head.emplace_back(field.label);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      rows[i].push_back(chart::grouped(result.axes[i].status.tally.*field.total));
    }
    if (field.kind != TallyKind::departure) {  // the label says it all
      note += fmt::format("{}{}{}: {}.", note.empty() ? "" : " ",
                          static_cast<char>(std::toupper(field.label.front())),
                          field.label.substr(1), field.meaning);
    }
  }
  return chart::html_table(head, rows) + chart::paragraph("note", note);
}

std::string prediction_section(const study::StreamResult& result) {
  std::string text =
      "<h2>Prediction against truth</h2>\n" +
      chart::paragraph("note",
                       "By the model at the end of the stream, for the held-out rows of every "
                       "configuration. The stretch is picked by its place in the log, not by how "
                       "well it is predicted.");
  for (const study::AxisResult& axis : result.axes) {
    text += heading(axis) + "<div class=\"pair\">\n" +
            chart::figure_of(stretch_panel(result, axis, kWideInPair),
                             stretch_panel(result, axis, kPanel)) +
            chart::figure_of(scatter_panel(axis, kSquare)) + "</div>\n";
  }
  return text;
}

// Nothing where no axis has intervals.
std::string interval_section(const study::StreamResult& result) {
  const chart::TextTable table = coverage_table(result);
  if (table.rows.empty()) {
    return "";
  }
  std::string text =
      "<h2>" + chart::escape_markup(table.title) + "</h2>\n" +
      chart::html_table(table.head, table.rows) + chart::paragraph("note", table.notes.front()) +
      chart::figure_of(coverage_panel(result, kWide), coverage_panel(result, kPanel));
  for (const study::AxisResult& axis : result.axes) {
    text +=
        heading(axis) + chart::figure_of(interval_panel(axis, kWide), interval_panel(axis, kPanel));
  }
  return text + "<h2>Error by novelty</h2>\n" +
         chart::paragraph("note", std::string(kNoveltyNote)) +
         panels(result, [](const study::AxisResult& axis) {
           return chart::figure_of(novelty_panel(axis, kPanel));
         });
}

// Nothing where no axis has terms.
std::string coefficient_section(const study::StreamResult& result) {
  std::string text;
  const std::vector<chart::TextTable> tables = coefficient_tables(result);
  std::size_t next = 0;
  for (const study::AxisResult& axis : result.axes) {
    if (!axis.terms.empty()) {
      const chart::TextTable& table = tables[next++];
      text += heading(axis) +
              chart::figure_of(coefficients_panel(axis, kWide), coefficients_panel(axis, kPanel)) +
              chart::html_table(table.head, table.rows);
    }
  }
  return text.empty()
             ? ""
             : "<h2>What the model believes about the vehicle</h2>\n" +
                   chart::paragraph("note",
                                    "Coefficients of the physics terms, in the target's unit per "
                                    "unit of the term. " +
                                        tables.back().notes.front()) +
                   text;
}

std::string figures(const study::StreamResult& result) {
  std::string text = "<h2>Validation over the stream</h2>\n" +
                     chart::figure_of(r2_panel(result, kWide), r2_panel(result, kPanel)) +
                     prediction_section(result) + interval_section(result) +
                     coefficient_section(result);
  text +=
      "<h2>Buffer and support vectors</h2>\n" + panels(result, [](const study::AxisResult& axis) {
        return chart::figure_of(buffer_panel(axis, kPanel));
      });
  text += "<h2>What each node did</h2>\n" +
          chart::paragraph(
              "note",
              "Above: what the including node decided, per interval between validation "
              "points (merged where they are many). Below: samples that left the buffer in "
              "the same intervals, as outliers, because it was full (forgotten) or because "
              "they had lost their weight (released).") +
          panels(result, [](const study::AxisResult& axis) {
            return chart::figure_of(shares_panel(axis, kPanel)) +
                   chart::figure_of(departures_panel(axis, {kPanel.width, 180}));
          });
  text += "<h2>Time per update</h2>\n" + panels(result, [](const study::AxisResult& axis) {
            return chart::figure_of(timing_panel(axis, kPanel));
          });
  return text;
}

std::string provenance(const study::StreamResult& result) {
  const chart::Facts data = {
      {"log", result.source},
      {"rows", fmt::format("{} read, {} skipped (a NaN or infinity in a column in use)",
                           rows_text(result.rows_read), rows_text(result.rows_skipped))},
      {"rate", result.rate_hz > 0.0 ? fmt::format("{:.4g} Hz", result.rate_hz) : "unknown"},
      {"inputs", join_text(result.input_names, ", ")},
      {"split", result.split},
      {"rows for training", rows_text(result.training_rows)},
      {"rows held out", rows_text(result.held_out_rows)},
      {"alignment", result.alignment.why.empty()
                        ? "–"
                        : study::alignment_text(result.alignment, result.rate_hz)},
      {"scales from", result.scales},
      {"seed", fmt::format("{}", result.seed)},
      {"ran to the end", result.interrupted ? fmt::format("no, interrupted after {} samples",
                                                          rows_text(result.samples_shown))
                                            : "yes"}};
  const std::string settings =
      result.settings.empty()
          ? ""
          : "<h2>Settings</h2>\n" +
                chart::facts_table({result.settings.begin(), result.settings.end()});
  return "<h2>Data and how it was used</h2>\n" + chart::facts_table(data) +
         chart::paragraph(
             "note",
             "R² depends on how rows are held out. With rows picked at random, their "
             "neighbours in time are in the training data, which flatters every model; "
             "whole blocks of rows are the harder and more honest test.") +
         settings;
}

}  // namespace

std::string report_html(const study::StreamResult& result) {
  const std::string log = std::filesystem::path(result.source).filename().string();
  return chart::html_page("kelpie: " + chart::shortened(log, kLongestTitle),
                          opening(result) + summary_table(result) + tally_table(result) +
                              yardstick_section(result) + figures(result) + provenance(result));
}

}  // namespace kelpie::report
