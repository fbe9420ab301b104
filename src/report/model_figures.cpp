// SPDX-License-Identifier: Apache-2.0
// Figures of what a learner believes and how long it takes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "chart/wording.hpp"
#include "report/stream_figures.hpp"
#include "study/summary.hpp"
#include "study/terms.hpp"

namespace kelpie::report {
namespace {

constexpr std::size_t kMostTermLines = 7;  // as many as there are colours

std::string formula_of(const study::TermView& view) {
  return chart::shortened(view.term.formula, chart::kLongestName);
}

// A series of the looks, and its standard error, each times a factor.
void add_term(chart::Figure& figure, const study::AxisResult& axis, const study::TermView& view,
              double factor, Clock clock, std::size_t style, const std::string& name) {
  std::vector<chart::Point> curve;
  std::vector<double> errors;
  for (std::size_t i = 0; i < axis.validation.size(); ++i) {
    curve.push_back({clock(axis.validation[i].time_s), factor * view.values[i]});
    errors.push_back(std::abs(factor) * view.errors[i]);
  }
  figure.band(curve, errors, style);
  figure.line(curve, style, name);
}

}  // namespace

std::string effects_figure(const study::AxisResult& axis, Clock clock) {
  const std::vector<study::TermView> shown =
      study::most_effective(study::term_views(axis), kMostTermLines);
  const std::string unit = axis.unit.empty() ? "the target's unit" : axis.unit;
  chart::Figure figure = figure_over_time(
      clock, {"effect in " + unit}, axis.name + ": effects of the physics terms over the stream");
  for (std::size_t i = 0; i < shown.size(); ++i) {
    add_term(figure, axis, shown[i], shown[i].term.rms, clock, i, formula_of(shown[i]));
  }
  mark_events(figure, axis, clock);
  std::string caption =
      "Effect: a term's contribution at its root mean square over the training rows, in " + unit +
      ". Shaded: ± one standard error.";
  if (shown.size() < axis.terms.size()) {
    caption += fmt::format(" The {} largest of {} terms; all are in result.json.", shown.size(),
                           axis.terms.size());
  }
  return figure.html(caption);
}

std::vector<std::string> coefficient_figures(const study::AxisResult& axis, Clock clock) {
  std::vector<std::string> figures;
  for (const study::TermView& view :
       study::most_effective(study::term_views(axis), kMostTermLines)) {
    const std::string unit = view.term.unit.empty() ? "the log's units" : view.term.unit;
    chart::Figure figure = figure_over_time(clock, {"coefficient in " + unit},
                                            axis.name + ": coefficient of " + view.term.formula);
    add_term(figure, axis, view, 1.0, clock, figures.size(), formula_of(view));
    mark_events(figure, axis, clock);
    figures.push_back(figure.html());
  }
  return figures;
}

std::string timing_figure(const study::AxisResult& axis) {
  const TimeHistogram histogram = histogram_of(axis);
  chart::Figure figure({"update time in µs", {}, chart::ScaleKind::logarithmic}, {"updates"},
                       axis.name + ": histogram of update times");
  figure.bars(histogram.bins, 0, "updates");
  const study::Quantiles times = study::quantiles_of(axis.update_us);
  figure.mark(times.median, "median " + chart::duration(times.median));
  figure.mark(times.p99, "p99 " + chart::duration(times.p99));
  return figure.html(
      histogram.zeros == 0
          ? ""
          : fmt::format("{} update{} of 0 µs (below the clock's resolution) counted in the first "
                        "bin.",
                        chart::grouped(histogram.zeros), histogram.zeros == 1 ? "" : "s"));
}

}  // namespace kelpie::report
