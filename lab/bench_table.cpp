// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "chart/text_table.hpp"
#include "chart/wording.hpp"
#include "kelpie/core/text.hpp"
#include "lab/bench_report.hpp"
#include "lab/bench_views.hpp"

namespace kelpie::lab {
std::string bench_table(const BenchResult& result) {
  std::string text = chart::wrapped(bench_method(result)) + "\n\n";
  for (const chart::TextTable& table : bench_tables(result)) {
    text += chart::table_text(table);
  }
  return text;
}

std::string times_table(const UpdateTimes& times) {
  return chart::wrapped(times_method(times)) + "\n\n" + chart::table_text(histogram_table(times)) +
         chart::table_text(slowest_table(times));
}

std::string soak_table(const std::vector<SoakRun>& runs) {
  std::string text;
  for (const SoakRun& run : runs) {
    text += fmt::format(
        "{}: {} updates, {} fallbacks, largest gap {:.1e} (allowed {:.0e}), "
        "median {}, max {}: {}\n",
        run.storage == Storage::float64 ? "double" : "float", chart::grouped(run.updates),
        run.fallbacks, run.gap, run.gap_allowed, chart::duration(run.median_us),
        chart::duration(run.max_us), run.good() ? "good" : "NOT GOOD");
  }
  return text;
}

}  // namespace kelpie::lab
