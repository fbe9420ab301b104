// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "chart/text_table.hpp"
#include "chart/wording.hpp"
#include "kelpie/model/stored_past_model.hpp"
#include "report/memory_table.hpp"

namespace kelpie::report {
namespace {

std::string unit_of(const format::PastModelsFile& memory, const std::string& column) {
  const auto unit = memory.units.find(column);
  return unit == memory.units.end() ? "" : unit->second;
}

std::string with_unit(double value, const std::string& unit) {
  return fmt::format("{:.3g}{}{}", value, unit.empty() ? "" : " ", unit);
}

// Mean and root mean square of each term.
std::vector<std::vector<std::string>> term_rows(const format::PastModelsFile& memory,
                                                const StoredPastModel& model) {
  std::vector<std::vector<std::string>> rows;
  std::size_t row = 4 + memory.terms.size();
  const double weight = model.sums[row];
  for (std::size_t k = 0; k < memory.terms.size(); row += ++k) {
    rows.push_back({memory.terms[k], fmt::format("{:.4g}", model.sums[row] / weight),
                    fmt::format("{:.4g}", std::sqrt(model.sums[row + k] / weight))});
  }
  return rows;
}

std::size_t samples_of(const StoredPastModel& model) {
  return static_cast<std::size_t>(model.sums[1]);
}

}  // namespace

std::string memory_table(const format::PastModelsFile& memory) {
  chart::TextTable table{
      .title = fmt::format("Past models ({})", memory.size()),
      .head = {"model", "from s", "until s", "in service", "recalls", "usual error", "samples"},
      .rows = {}};
  for (const format::AxisMemory& axis : memory.axes) {
    for (const StoredPastModel& model : axis.models) {
      const PastModelInfo& info = model.info;
      table.rows.push_back({axis.name_of(model), chart::time_text(info.from_s),
                            chart::time_text(info.until_s), chart::grouped(info.samples),
                            chart::grouped(info.recalls),
                            with_unit(info.usual_error, unit_of(memory, axis.target)),
                            chart::grouped(samples_of(model))});
    }
  }
  return chart::table_text(table);
}

std::string past_model_table(const format::PastModelsFile& memory, std::string_view name,
                             const StoredPastModel& model) {
  const std::string target(name.substr(0, name.rfind(':')));
  chart::TextTable table{
      .title = fmt::format("{}: {} samples", name, chart::grouped(samples_of(model))),
      .head = {"term", "mean", "root mean square"},
      .rows = term_rows(memory, model)};
  const PastModelInfo& info = model.info;
  table.notes = {fmt::format("Its vehicle was first met at {} s and last seen at {} s.",
                             chart::time_text(info.from_s), chart::time_text(info.until_s)),
                 fmt::format("Samples in service: {}. Recalls: {}. Usual error one step ahead: {}.",
                             chart::grouped(info.samples), info.recalls,
                             with_unit(info.usual_error, unit_of(memory, target)))};
  return chart::table_text(table);
}

}  // namespace kelpie::report
