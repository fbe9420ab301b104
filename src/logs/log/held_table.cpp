// SPDX-License-Identifier: Apache-2.0
#include "log/held_table.hpp"

#include <limits>
#include <numeric>
#include <utility>

#include "core/seconds.hpp"

namespace kelpie::log {

Table held_table(std::span<const bag::Series> series, std::span<const std::string> columns,
                 const std::string& source) {
  const std::vector<std::int64_t>& rows = series.front().times_ns;
  Table table;
  table.source = source;
  table.lines.resize(rows.size());
  std::iota(table.lines.begin(), table.lines.end(), std::size_t{1});
  table.names = {"t"};
  table.columns.resize(1);
  for (const std::int64_t time : rows) {
    table.columns.front().push_back(seconds(time - rows.front()));
  }
  for (const std::string& name : columns) {
    const bag::Series& from = bag::series_with(series, name);
    const std::vector<double>& values = from.values[from.column(name)];
    std::vector<double> held;
    std::size_t passed = 0;
    for (std::size_t row = 0; row < rows.size(); ++row) {
      while (passed < values.size() && from.times_ns[passed] <= rows[row]) {
        ++passed;
      }
      // A topic's own rows may share a time.
      const bool is_own = &from == &series.front();
      held.push_back(is_own        ? values[row]
                     : passed == 0 ? std::numeric_limits<double>::quiet_NaN()
                                   : values[passed - 1]);
    }
    table.names.push_back(name);
    table.columns.push_back(std::move(held));
  }
  return table;
}

}  // namespace kelpie::log
