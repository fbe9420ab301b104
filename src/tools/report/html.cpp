// SPDX-License-Identifier: Apache-2.0
#include "report/html.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <vector>

#include "chart/page.hpp"
#include "chart/wording.hpp"
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

bool has_model(const study::StreamResult& result) {
  return std::ranges::any_of(result.axes,
                             [](const study::AxisResult& axis) { return axis.status.ready; });
}

// What the model was made of: the inputs by what each is taken for, and rows.
std::string sources(const study::StreamResult& result) {
  chart::Facts facts = input_facts(result);
  facts.emplace_back("learned", fmt::format("{} rows, once each, in the order of time",
                                            chart::grouped(result.samples_shown)));
  facts.emplace_back(
      "held out", fmt::format("{} rows ({})", chart::grouped(result.held_out_rows), result.split));
  return chart::facts_table(facts);
}

std::string quality(const study::StreamResult& result) {
  const chart::TextTable table = quality_table(result);
  return chart::html_table(table.head, table.rows, "", table.left) +
         chart::paragraph("note", table.title + "; 1 is perfect, 0 is no better than the mean." +
                                      (table.notes.empty() ? "" : " " + table.notes.front()));
}

// The first screen: what matters most, how good the model is, and of what.
std::string opening(const study::StreamResult& result, const std::vector<NextStep>& next) {
  const std::string log = chart::file_names(result.source);
  const std::string news = headline(result);
  std::vector<std::string> warnings = warning_lines(result);
  std::ranges::move(caveat_lines(result), std::back_inserter(warnings));
  const bool warns = !warnings.empty();  // names of columns keep their small letters
  std::string text = chart::paragraph("over", "Learned from " + log) +
                     chart::heading(1, warns ? as_sentence(news) : news + ".");
  if (result.interrupted) {
    text += chart::paragraph(
        "interrupted",
        fmt::format("This run was interrupted after {} of {} training samples. "
                    "Everything below describes that part only.",
                    chart::grouped(result.samples_shown), chart::grouped(result.training_rows)));
  }
  for (const std::string& warning : warnings) {
    text += warning == news ? "" : chart::paragraph("interrupted", as_sentence(warning));
  }
  if (has_model(result)) {
    const std::string words = quality_sentence(result);
    text += words == news ? "" : chart::paragraph("lead", words + ".");
    for (const std::string& change : vehicle_lines(result)) {
      // Of the cause in the headline nothing is left to say.
      const bool is_said = news.starts_with(change.substr(change.find(": ") + 2));
      text += is_said ? "" : chart::paragraph("", as_sentence(change));
    }
  }
  text += chart::columns(quality(result), sources(result));
  chart::Facts commands;
  for (const NextStep& step : next) {
    commands.emplace_back(step.command, step.purpose);
  }
  return text + (commands.empty() ? "" : chart::heading(3, "What next")) +
         chart::command_lines(commands);
}

std::string course_section(const study::StreamResult& result, Clock clock) {
  std::string text = chart::paragraph(
      "note",
      fmt::format(
          "Each sample as measured, and as predicted just before it was learned; below, the "
          "error. Shown at first: {:.0f} s of {:.0f} s. ◂ and ▸ go on, “all” or a double-click "
          "shows "
          "everything, dragging zooms in.",
          clock.first.high - clock.first.low, clock.shown.high - clock.shown.low));
  for (const study::AxisResult& axis : result.axes) {
    text += chart::heading(3, axis.name) + course_figure(axis, clock);
  }
  return text;
}

// A table under its title; without rows the words instead. Empty without both.
std::string titled(const chart::TextTable& table, const std::string& words) {
  if (!table.rows.empty()) {
    return chart::html_tables({table});
  }
  return words.empty() ? "" : chart::heading(3, table.title) + chart::paragraph("", words);
}

// Empty where nothing changed and there is nothing to say of thrusters.
std::string diagnosis_section(const study::StreamResult& result) {
  const chart::TextTable changes = change_table(result);
  const chart::TextTable health = health_table(result);
  const std::string thrusters = titled(health, health.notes.empty() ? "" : health.notes.front());
  return changes.rows.empty() && thrusters.empty()
             ? ""
             : chart::columns(titled(changes, "Nothing."), thrusters);
}

std::string accuracy_section(const study::StreamResult& result, Clock clock) {
  const std::string text =
      r2_figure(result, clock) +
      chart::html_table(axes_table(
          result,
          {"axis", "R²\nat the end", "R²\nmean", "R² lowest\nafter 1,000 rows", "R² one\nahead"},
          "One ahead: each sample predicted just before it was learned.",
          [](const study::AxisResult& axis) -> std::vector<std::string> {
            return {chart::decimal(axis.r2_final), chart::decimal(axis.r2_mean),
                    chart::decimal(axis.r2_min_after_1000), chart::decimal(axis.prequential_r2)};
          })) +
      chart::html_table(baseline_table(result)) + panels(result, scatter_figure);
  std::string rows =
      chart::paragraph("note",
                       "Held-out rows of every configuration by the model at the end "
                       "of the stream.");
  for (const study::AxisResult& axis : result.axes) {
    rows += chart::heading(3, axis.name) + held_out_figure(axis, clock);
  }
  return text + chart::folded("Held-out rows over time", rows);
}

// Empty where no axis has terms.
std::string coefficient_section(const study::StreamResult& result, Clock clock) {
  std::vector<std::string> effects;
  std::string folded;
  const std::vector<chart::TextTable> tables = coefficient_tables(result);
  std::size_t next = 0;
  for (const study::AxisResult& axis : result.axes) {
    if (!axis.terms.empty()) {
      effects.push_back(chart::heading(3, axis.name) + effects_figure(axis, clock));
      folded += chart::folded(
          "Each coefficient of " + name_of(axis),
          chart::html_table(tables[next++]) + chart::panels(coefficient_figures(axis, clock)));
    }
  }
  return effects.empty() ? "" : chart::panels(effects) + folded;
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

std::string report_html(const study::StreamResult& result, const std::vector<NextStep>& next) {
  const std::string log = chart::file_names(result.source);
  const chart::Section data{"Data", data_section(result), true};
  const chart::Section settings{"Settings", settings_section(result), true};
  if (!has_model(result)) {
    return chart::html_page("kelpie: " + log, opening(result, next), {data, settings});
  }
  const Clock clock = clock_of(result);
  const chart::TextTable members = member_table(result);
  const chart::TextTable actuators = actuator_table(result.alignment);
  const chart::TextTable coverage = coverage_table(result);
  return chart::html_page("kelpie: " + log, opening(result, next),
                          {{"The vehicle", diagnosis_section(result)},
                           {"The run", course_section(result, clock)},
                           {"Accuracy", accuracy_section(result, clock)},
                           {"Coefficients", coefficient_section(result, clock)},
                           {actuators.title, chart::html_table(actuators), true},
                           {coverage.title, interval_section(result, clock), true},
                           {"Error by novelty", novelty_section(result), true},
                           {members.title, chart::html_table(members), true},
                           {"Nodes", node_section(result, clock), true},
                           {"Solver", solver_section(result), true},
                           {"Time per update", time_section(result), true},
                           data,
                           settings});
}

}  // namespace kelpie::report
