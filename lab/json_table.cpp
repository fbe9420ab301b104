// SPDX-License-Identifier: Apache-2.0
#include "lab/json_table.hpp"

#include <fmt/format.h>

#include <limits>

#include "study/summary.hpp"

namespace kelpie::lab {
namespace {

double number_of(const file::Json& value) {
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

}  // namespace

NumberText fixed(const char* format) {
  return [format](double value) {
    return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : "–";
  };
}

std::string count_text(double value) {
  return chart::grouped(static_cast<std::int64_t>(value));
}

JsonColumn column(std::string head, const std::string& pointer, const NumberText& text) {
  return {std::move(head), [at = file::Json::json_pointer(pointer), text](const file::Json& row) {
            if (!row.contains(at)) {
              return std::string();
            }
            const file::Json& value = row.at(at);
            if (value.is_string()) {
              return value.get<std::string>();
            }
            if (!value.is_array()) {
              return text(number_of(value));
            }
            std::vector<double> numbers;
            for (const file::Json& one : value) {
              numbers.push_back(number_of(one));
            }
            return text(study::quantiles_of(numbers).median);
          }};
}

chart::TextTable json_table(std::string title, const std::vector<JsonColumn>& columns,
                            const file::Json& rows) {
  chart::TextTable table{std::move(title), {}, {}};
  for (const JsonColumn& one : columns) {
    table.head.push_back(one.head);
  }
  for (const file::Json& row : rows) {
    std::vector<std::string>& cells = table.rows.emplace_back();
    for (const JsonColumn& one : columns) {
      cells.push_back(one.cell(row));
    }
  }
  return table;
}

}  // namespace kelpie::lab
