// SPDX-License-Identifier: Apache-2.0
#include "report/html.hpp"

#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "chart/page.hpp"
#include "chart/wording.hpp"
#include "core/text.hpp"
#include "report/diagnosis_tables.hpp"
#include "report/provenance.hpp"
#include "report/stream_figures.hpp"
#include "report/stream_tables.hpp"
#include "report/verdict.hpp"
#include "study/summary.hpp"

namespace kelpie::report {
namespace {

// One figure per axis, side by side where there is room.
template <typename Draw>
std::string panels(const study::StreamResult& result, Draw draw) {
  std::vector<std::string> figures;
  for (const study::AxisResult& axis : result.axes) {
    figures.push_back(chart::heading(3, axis.name) + draw(axis));
  }
  return chart::panels(figures);
}

// A table with a row per axis, of cells that `cells` makes.
template <typename Cells>
chart::TextTable axes_table(const study::StreamResult& result, std::vector<std::string> head,
                            const std::string& note, Cells cells) {
  chart::TextTable table{{}, std::move(head), {}, {note}};
  for (const study::AxisResult& axis : result.axes) {
    std::vector<std::string>& row = table.rows.emplace_back(cells(axis));
    row.insert(row.begin(), name_of(axis));
  }
  return table;
}

std::string as_sentence(std::string text) {
  text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  return text.ends_with(".") || text.ends_with("?") ? text : text + ".";
}

std::string opening(const study::StreamResult& result) {
  const std::string log = std::filesystem::path(result.source).filename().string();
  std::string text = chart::heading(1, "What kelpie learned from " + log);
  if (result.interrupted) {
    text += chart::paragraph(
        "interrupted",
        fmt::format("This run was interrupted after {} of {} training samples. "
                    "Everything below describes that part only.",
                    chart::grouped(result.samples_shown), chart::grouped(result.training_rows)));
  }
  text += chart::paragraph("lead", quality_sentence(result) + ".");
  for (const std::string& warning : warning_lines(result)) {
    text += chart::paragraph("interrupted", as_sentence(warning));
  }
  for (const std::string& change : vehicle_lines(result)) {
    text += chart::paragraph("", as_sentence(change));
  }
  text += chart::paragraph("note", as_sentence(join_text(input_lines(result), ". "))) +
          chart::paragraph("note", fmt::format("{} training samples shown once, in the order of "
                                               "time; {} rows held out ({}).",
                                               chart::grouped(result.samples_shown),
                                               chart::grouped(result.held_out_rows), result.split));
  return text + chart::html_table(baseline_table(result));
}

std::string course_section(const study::StreamResult& result, Clock clock) {
  std::string text = chart::paragraph(
      "note",
      "Each training sample as measured, and as predicted just before it was learned. Drag across "
      "a figure to zoom in on a time, double-click to see everything; Shift and drag pans. All "
      "figures over time follow.");
  for (const study::AxisResult& axis : result.axes) {
    text += chart::heading(3, axis.name) + course_figure(axis, clock);
  }
  return text;
}

// Empty where nothing changed and there is nothing to say of thrusters.
std::string diagnosis_section(const study::StreamResult& result) {
  std::string text;
  for (const chart::TextTable& table : {change_table(result), health_table(result)}) {
    text += table.rows.empty() ? "" : chart::html_table(table);
  }
  return text;
}

std::string accuracy_section(const study::StreamResult& result, Clock clock) {
  std::string text =
      r2_figure(result, clock) +
      chart::html_table(axes_table(
          result, {"axis", "R²\nat the end", "R²\nmean", "R² lowest\nafter 1,000", "R² one\nahead"},
          "One ahead: each sample predicted just before it was learned.",
          [](const study::AxisResult& axis) -> std::vector<std::string> {
            return {chart::decimal(axis.r2_final), chart::decimal(axis.r2_mean),
                    chart::decimal(axis.r2_min_after_1000), chart::decimal(axis.prequential_r2)};
          })) +
      chart::paragraph("note",
                       "Below, held-out rows of every configuration by the model at the end of "
                       "the stream.");
  for (const study::AxisResult& axis : result.axes) {
    text += chart::heading(3, axis.name) + held_out_figure(axis, clock);
  }
  return text + panels(result, scatter_figure);
}

// Empty where no axis has terms.
std::string coefficient_section(const study::StreamResult& result, Clock clock) {
  std::string text;
  const std::vector<chart::TextTable> tables = coefficient_tables(result);
  std::size_t next = 0;
  for (const study::AxisResult& axis : result.axes) {
    if (!axis.terms.empty()) {
      text += chart::heading(3, axis.name) + effects_figure(axis, clock) +
              chart::html_table(tables[next++]) + "<details><summary>Each coefficient of " +
              chart::escape_markup(name_of(axis)) + " in its own unit</summary>\n" +
              chart::panels(coefficient_figures(axis, clock)) + "</details>\n";
    }
  }
  return text;
}

// Empty where no axis has intervals.
std::string interval_section(const study::StreamResult& result, Clock clock) {
  const chart::TextTable table = coverage_table(result);
  return table.rows.empty() ? "" : chart::html_table(table) + coverage_figure(result, clock);
}

std::string novelty_section(const study::StreamResult& result) {
  return coverage_table(result).rows.empty()
             ? ""
             : chart::paragraph("note", std::string(kNoveltyNote)) + panels(result, novelty_figure);
}

// Totals of some kinds, a column each.
std::string tally_table(const study::StreamResult& result, const std::vector<TallyField>& fields) {
  std::vector<std::string> head{"axis"};
  std::string note;
  for (const TallyField& field : fields) {
    head.emplace_back(field.label);
    note += fmt::format("{}{}{}: {}.", note.empty() ? "" : " ",
                        static_cast<char>(std::toupper(field.label.front())), field.label.substr(1),
                        field.meaning);
  }
  return chart::html_table(axes_table(result, head, note, [&](const study::AxisResult& axis) {
    std::vector<std::string> row;
    for (const TallyField& field : fields) {
      row.push_back(chart::grouped(axis.status.tally.*field.total));
    }
    return row;
  }));
}

bool of_solver(const TallyField& field) {
  return field.kind == TallyKind::trouble || field.total == &Tally::crowded_out;
}

std::string node_section(const study::StreamResult& result, Clock clock) {
  std::vector<TallyField> fields = study::totals_by_kind();
  std::erase_if(fields, of_solver);
  return tally_table(result, fields) +
         chart::paragraph("note",
                          "First the samples in the buffer; then what became of the samples when "
                          "they came, and how many left the buffer, between validation points "
                          "(merged where they are many).") +
         panels(result, [&](const study::AxisResult& axis) {
           return buffer_figure(axis, clock) + shares_figure(axis, clock) +
                  departures_figure(axis, clock);
         });
}

std::string solver_section(const study::StreamResult& result) {
  std::vector<TallyField> fields = study::totals_by_kind();
  std::erase_if(fields, [](const TallyField& field) { return !of_solver(field); });
  return chart::html_table(axes_table(
             result, {"axis", "support\nvectors", "buffer", "KKT\ngap"},
             "Support vectors: samples in the buffer with a weight. KKT gap: the largest violation "
             "of the optimality conditions, in units of the standardised target.",
             [](const study::AxisResult& axis) -> std::vector<std::string> {
               const double gap = study::served_gap(axis.status);
               return {chart::grouped(axis.status.support_vectors),
                       chart::grouped(axis.status.buffer),
                       std::isfinite(gap) ? fmt::format("{:.1e}", gap) : "–"};
             })) +
         tally_table(result, fields);
}

std::string time_section(const study::StreamResult& result) {
  return chart::html_table(axes_table(
             result, {"axis", "median", "99 %", "longest"}, "Time of one update of one axis.",
             [](const study::AxisResult& axis) -> std::vector<std::string> {
               const study::Quantiles times = study::quantiles_of(axis.update_us);
               return {chart::duration(times.median), chart::duration(times.p99),
                       chart::duration(times.max)};
             })) +
         panels(result, timing_figure);
}

}  // namespace

std::string report_html(const study::StreamResult& result) {
  const std::string log = std::filesystem::path(result.source).filename().string();
  const Clock clock = clock_of(result);
  const chart::TextTable members = member_table(result);
  const chart::TextTable actuators = actuator_table(result.alignment);
  const chart::TextTable coverage = coverage_table(result);
  return chart::html_page("kelpie: " + log, opening(result),
                          {{"The run", course_section(result, clock)},
                           {"The vehicle", diagnosis_section(result)},
                           {"Accuracy", accuracy_section(result, clock)},
                           {"Coefficients", coefficient_section(result, clock)},
                           {actuators.title, chart::html_table(actuators)},
                           {coverage.title, interval_section(result, clock)},
                           {"Error by novelty", novelty_section(result)},
                           {"Nodes", node_section(result, clock)},
                           {members.title, chart::html_table(members)},
                           {"Solver", solver_section(result)},
                           {"Time per update", time_section(result)},
                           {"Data", data_section(result)},
                           {"Settings", settings_section(result)}});
}

}  // namespace kelpie::report
