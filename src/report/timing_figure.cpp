// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "chart/wording.hpp"
#include "report/stream_figures.hpp"
#include "report/views.hpp"
#include "study/summary.hpp"

namespace kelpie::report {

chart::Panel timing_panel(const study::AxisResult& axis, chart::PlotSize size) {
  const TimeHistogram histogram = histogram_of(axis);
  std::vector<chart::Box> boxes;
  double most = 4.0;  // whole numbers as ticks
  for (std::size_t bin = 0; bin < histogram.counts.size(); ++bin) {
    const chart::Extent edges = bin_edges(histogram, bin);
    boxes.push_back({edges.low, edges.high, 0.0, histogram.counts[bin]});
    most = std::max(most, histogram.counts[bin]);
  }
  chart::Figure figure(size,
                       {"update time in µs", histogram.range_us, chart::ScaleKind::logarithmic},
                       {"updates", {0.0, 1.05 * most}}, axis.name + ": histogram of update times");
  figure.boxes(boxes, 0, "");
  const study::Quantiles times = study::quantiles_of(axis.update_us);
  figure.mark(times.median, "median " + chart::duration(times.median));
  figure.mark(times.p99, "p99 " + chart::duration(times.p99));
  std::string caption;
  if (histogram.zeros > 0) {
    caption =
        fmt::format("{} update{} of 0 µs (below the clock's resolution) counted in the first bin.",
                    chart::grouped(static_cast<std::int64_t>(histogram.zeros)),
                    histogram.zeros == 1 ? "" : "s");
  }
  return {figure.svg(), caption};
}

}  // namespace kelpie::report
