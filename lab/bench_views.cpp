// SPDX-License-Identifier: Apache-2.0
#include "lab/bench_views.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

#include "chart/wording.hpp"
#include "study/metrics.hpp"
#include "study/summary.hpp"

namespace kelpie::lab {
namespace {

constexpr std::size_t kLongestStream = 30;
constexpr double kSettledWindow = 450.0;

std::string scientific(double value) {
  return std::isfinite(value) ? fmt::format("{:.1e}", value) : chart::decimal(value);
}

std::string times_text(double ratio) {
  return std::isfinite(ratio) ? fmt::format("{:.{}f} ×", ratio, ratio < 100.0 ? 1 : 0) : "–";
}

std::string whole_text(double value) {
  return std::isfinite(value) ? fmt::format("{:.0f}", value) : "–";
}

std::vector<std::string> spread_cells(const study::Quantiles& spread) {
  return {chart::duration(spread.median), chart::duration(spread.p99), chart::duration(spread.p999),
          chart::duration(spread.max)};
}

std::vector<std::string> joined(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

chart::TextTable ratios_table(const BenchResult& result) {
  chart::TextTable table{"How much longer others take per update (medians, same samples)",
                         {"axis", "ε", "path", "SMO", "LIBSVM", "runs", "SMO/path", "LIBSVM/path"},
                         {}};
  for (const BenchAxis& axis : result.axes) {
    const Speedup speedup = speedup_of(axis);
    table.rows.push_back({stream_text(axis) + " " + axis.axis, fmt::format("{}", axis.epsilon),
                          chart::duration(study::quantiles_of(axis.runs[0].update_us).median),
                          chart::duration(study::quantiles_of(axis.runs[2].update_us).median),
                          chart::duration(study::quantiles_of(axis.libsvm_us).median),
                          chart::grouped(axis.libsvm_us.size()), times_text(speedup.smo),
                          times_text(speedup.libsvm)});
  }
  return table;
}

std::vector<std::string> run_cells(const std::string& name, const SolverRun& run) {
  return joined(joined({name, chart::grouped(run.update_us.size())},
                       spread_cells(study::quantiles_of(run.update_us))),
                {whole_text(study::quantiles_of(run.steps).median),
                 whole_text(study::quantiles_of(run.free_samples).median),
                 chart::grouped(run.fallbacks), scientific(run.gap)});
}

chart::TextTable runs_table(const BenchAxis& axis) {
  chart::TextTable table{
      stream_text(axis) + ", " + axis.axis + fmt::format(", ε = {}", axis.epsilon),
      {"", "updates", "median", "p99", "p99.9", "max", "steps", "free", "fallbacks", "gap"},
      {}};
  for (const SolverRun& run : axis.runs) {
    table.rows.push_back(run_cells(run.name, run));
  }
  table.rows.push_back(run_cells("path, whole", axis.whole));
  const std::vector<std::string> none(4, "");
  const auto times_row = [&](const std::string& name, const std::vector<double>& times) {
    table.rows.push_back(joined(
        joined({name, chart::grouped(times.size())}, spread_cells(study::quantiles_of(times))),
        none));
  };
  times_row("learner, update", axis.learner_update_us);
  times_row("learner, predict", axis.learner_predict_us);
  return table;
}

chart::TextTable growth_table(const std::vector<BenchGrowth>& growths, const std::string& over,
                              double least) {
  chart::TextTable table{"Median update over the " + over, {"axis", "solver"}, {}};
  if (growths.empty()) {
    return table;
  }
  const auto longest =
      std::ranges::max_element(growths, {}, [](const BenchGrowth& g) { return g.sizes.size(); });
  for (const double size : longest->sizes) {
    table.head.push_back(whole_text(size));
  }
  table.head.emplace_back("exponent");
  for (const BenchGrowth& growth : growths) {
    const auto [path, smo] = exponents_of(growth, least);
    for (const auto& [name, times, exponent] :
         {std::tuple{"path", &growth.path_us, path}, std::tuple{"SMO", &growth.smo_us, smo}}) {
      std::vector<std::string> row{growth.axis, name};
      std::ranges::transform(*times, std::back_inserter(row), chart::duration);
      row.resize(table.head.size() - 1, "–");
      row.push_back(chart::decimal(exponent));
      table.rows.push_back(row);
    }
  }
  return table;
}

chart::TextTable kernel_table(const BenchKernel& kernel) {
  return {fmt::format("Kernel, {} samples of {} inputs", kernel.samples, kernel.inputs),
          {"row", "plain loop with std::exp", "prediction", "plain/row", "prediction/row"},
          {{fmt::format("{:.2f} µs", kernel.row_us), fmt::format("{:.2f} µs", kernel.scalar_row_us),
            fmt::format("{:.2f} µs", kernel.prediction_us),
            times_text(kernel.scalar_row_us / kernel.row_us),
            times_text(kernel.prediction_us / kernel.row_us)}}};
}

chart::TextTable memory_table(const BenchMemory& memory) {
  return {fmt::format("Memory of a learner, computed: window {}, {} inputs", memory.window,
                      memory.inputs),
          {"path", "path, float", "SMO"},
          {{chart::megabytes(memory.path_double), chart::megabytes(memory.path_float),
            chart::megabytes(memory.smo_double)}}};
}

}  // namespace

Speedup speedup_of(const BenchAxis& axis) {
  const double path = study::quantiles_of(axis.runs[0].update_us).median;
  return {study::quantiles_of(axis.runs[2].update_us).median / path,
          study::quantiles_of(axis.libsvm_us).median / path};
}

std::pair<double, double> exponents_of(const BenchGrowth& growth, double least) {
  const auto first = std::ranges::lower_bound(growth.sizes, least) - growth.sizes.begin();
  const auto from = [&](const std::vector<double>& all) {
    return std::span(all).subspan(static_cast<std::size_t>(first));
  };
  return {study::power_exponent(from(growth.sizes), from(growth.path_us)),
          study::power_exponent(from(growth.sizes), from(growth.smo_us))};
}

std::string stream_text(const BenchAxis& axis) {
  const std::string name =
      chart::shortened(std::filesystem::path(axis.stream).filename().string(), kLongestStream);
  return axis.simulated ? name + " (simulation)" : name;
}

std::vector<chart::TextTable> bench_tables(const BenchResult& result) {
  std::vector<chart::TextTable> tables{ratios_table(result)};
  for (const BenchAxis& axis : result.axes) {
    tables.push_back(runs_table(axis));
  }
  tables.push_back(growth_table(result.over_window,
                                fmt::format("window (exponent from {} on)", kSettledWindow),
                                kSettledWindow));
  tables.push_back(
      growth_table(result.over_inputs, "number of inputs (the first three, repeated)", 0.0));
  tables.push_back(kernel_table(result.kernel));
  tables.push_back(memory_table(result.memory));
  tables.push_back(histogram_table(result.model));
  tables.push_back(slowest_table(result.model));
  return tables;
}

std::string bench_method(const BenchResult& result) {
  return fmt::format(
      "One thread. Every solver slides a window of {} over the same standardised samples "
      "(γ {}, C {}, KKT tolerance {}), in turns of {} updates, the first {} after the window is "
      "full; an update is kernel row, add, solve, release, remove, solve. LIBSVM trains from "
      "scratch on the window after each turn. The learner has the default settings, without "
      "physics terms.",
      result.settings.buffer, result.settings.gamma, result.settings.c, result.settings.tolerance,
      result.block, result.compared);
}

}  // namespace kelpie::lab
