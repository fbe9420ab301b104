// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "bench_views.hpp"
#include "kelpie/core/text.hpp"
#include "kelpie/report/bench_report.hpp"
#include "kelpie/report/wording.hpp"
#include "text_table.hpp"

namespace kelpie {
std::string bench_table(const BenchResult& result) {
  std::string text = wrapped(bench_method(result)) + "\n\n";
  for (const TextTable& table : bench_tables(result)) {
    text += table_text(table);
  }
  return text;
}

std::string soak_table(const std::vector<SoakRun>& runs) {
  std::string text;
  for (const SoakRun& run : runs) {
    text += fmt::format(
        "{}: {} updates, {} fallbacks, largest gap {:.1e} (allowed {:.0e}), "
        "median {}, max {}: {}\n",
        run.storage == Storage::float64 ? "double" : "float",
        grouped(static_cast<std::int64_t>(run.updates)), run.fallbacks, run.gap, run.gap_allowed,
        duration(run.median_us), duration(run.max_us), run.good() ? "good" : "NOT GOOD");
  }
  return text;
}

}  // namespace kelpie
