// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "chart/text_table.hpp"
#include "chart/wording.hpp"
#include "file/json.hpp"

namespace kelpie::lab {

/// The text of a number: chart::decimal, chart::duration, …
using NumberText = std::function<std::string(double)>;

NumberText fixed(const char* format);  ///< By a format of fmt; "–" for NaN and infinities.
std::string count_text(double value);  ///< "1,234"

/// A column of a table: the head, and the text of a cell for a row in JSON.
struct JsonColumn {
  std::string head;
  std::function<std::string(const file::Json& row)> cell;
};

/// The column of the value at a JSON pointer: a text, a number, or the median of a list of numbers.
/// The cell of a row without the value is empty.
JsonColumn column(std::string head, const std::string& pointer,
                  const NumberText& text = chart::decimal);

/// A table with a line per row.
chart::TextTable json_table(std::string title, const std::vector<JsonColumn>& columns,
                            const file::Json& rows);

}  // namespace kelpie::lab
