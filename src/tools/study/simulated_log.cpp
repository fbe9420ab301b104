// SPDX-License-Identifier: Apache-2.0
#include "study/simulated_log.hpp"

namespace kelpie::study {

log::Table log_table(std::span<const vehicle::LogRow> rows, const std::string& source) {
  log::Table table;
  table.source = source;
  table.names = {"t",   "conf", "u",    "v",    "r",         "th1",       "th2",
                 "th3", "udot", "vdot", "rdot", "udot_true", "vdot_true", "rdot_true"};
  table.columns.resize(table.names.size());
  for (const vehicle::LogRow& row : rows) {
    std::size_t column = 0;
    table.columns[column++].push_back(row.t_s);
    table.columns[column++].push_back(static_cast<double>(row.configuration));
    for (const Eigen::Vector3d* const values :
         {&row.velocity, &row.rotors_rps, &row.acceleration, &row.true_acceleration}) {
      for (const double value : *values) {
        table.columns[column++].push_back(value);
      }
    }
    table.lines.push_back(table.lines.size() + 2);  // below the header
  }
  return table;
}

}  // namespace kelpie::study
