// SPDX-License-Identifier: Apache-2.0
#include "lab/bench_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <span>
#include <utility>

#include "chart/text_table.hpp"
#include "chart/wording.hpp"
#include "file/json.hpp"
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

// How many times longer SMO and LIBSVM (from scratch) take than the path solver, by medians.
struct Speedup {
  double smo = 0.0;
  double libsvm = 0.0;
};

Speedup speedup_of(const BenchAxis& axis) {
  const double path = study::quantiles_of(axis.runs[0].update_us).median;
  return {study::quantiles_of(axis.runs[2].update_us).median / path,
          study::quantiles_of(axis.libsvm_us).median / path};
}

// Growth exponents of path and SMO over the sizes from `least` on.
std::pair<double, double> exponents_of(const BenchGrowth& growth, double least) {
  const auto first = std::ranges::lower_bound(growth.sizes, least) - growth.sizes.begin();
  const auto from = [&](const std::vector<double>& all) {
    return std::span(all).subspan(static_cast<std::size_t>(first));
  };
  return {study::power_exponent(from(growth.sizes), from(growth.path_us)),
          study::power_exponent(from(growth.sizes), from(growth.smo_us))};
}

// The last part of the name of a stream, marked where the stream is simulated.
std::string stream_text(const BenchAxis& axis) {
  const std::string name =
      chart::shortened(std::filesystem::path(axis.stream).filename().string(), kLongestStream);
  return axis.simulated ? name + " (simulation)" : name;
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

// The method of measurement, in a few sentences.
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

file::Json spread_json(const std::vector<double>& times_us) {
  const study::Quantiles spread = study::quantiles_of(times_us);
  return {{"median", file::number(spread.median)},
          {"p99", file::number(spread.p99)},
          {"p999", file::number(spread.p999)},
          {"max", file::number(spread.max)}};
}

file::Json run_json(const SolverRun& run) {
  return {{"name", run.name},
          {"updates", run.update_us.size()},
          {"fallbacks", run.fallbacks},
          {"kkt_gap", file::number(run.gap)},
          {"us", spread_json(run.update_us)},
          {"update_us", file::numbers(run.update_us)},
          {"steps", file::numbers(run.steps)},
          {"free_samples", file::numbers(run.free_samples)}};
}

file::Json bench_axis_json(const BenchAxis& axis) {
  const Speedup speedup = speedup_of(axis);
  return {{"stream", axis.stream},
          {"simulated", axis.simulated},
          {"axis", axis.axis},
          {"epsilon", axis.epsilon},
          {"smo_over_path", file::number(speedup.smo)},
          {"libsvm_over_path", file::number(speedup.libsvm)},
          {"solvers", file::list(axis.runs, run_json)},
          {"libsvm_us", file::numbers(axis.libsvm_us)},
          {"path_whole", run_json(axis.whole)},
          {"learner",
           {{"buffer", axis.learner_buffer},
            {"update", spread_json(axis.learner_update_us)},
            {"predict", spread_json(axis.learner_predict_us)},
            {"update_us", file::numbers(axis.learner_update_us)},
            {"predict_us", file::numbers(axis.learner_predict_us)}}}};
}

file::Json growth_json(const BenchGrowth& growth) {
  const auto [path, smo] = exponents_of(growth, 0.0);
  return {{"stream", growth.stream},
          {"axis", growth.axis},
          {"sizes", file::numbers(growth.sizes)},
          {"path_us", file::numbers(growth.path_us)},
          {"smo_us", file::numbers(growth.smo_us)},
          {"path_exponent", file::number(path)},
          {"smo_exponent", file::number(smo)}};
}

file::Json model_json(const UpdateTimes& times) {
  const auto bin = [](const TimesBin& one) {
    return file::Json{
        {"below_us", file::number(one.below_us)}, {"thread", one.thread}, {"wall", one.wall}};
  };
  return {{"updates", times.thread_us.size()},
          {"changes", times.changes},
          {"recalls", times.recalls},
          {"rescales", times.rescales},
          {"thread", spread_json(times.thread_us)},
          {"wall", spread_json(times.wall_us)},
          {"histogram", file::list(histogram_of(times), bin)},
          {"thread_us", file::numbers(times.thread_us)},
          {"wall_us", file::numbers(times.wall_us)}};
}

}  // namespace

std::string bench_table(const BenchResult& result) {
  return chart::wrapped(bench_method(result)) + "\n\n" + chart::tables_text(bench_tables(result));
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

std::string bench_json(const BenchResult& result) {
  const OnlineSvrSettings& settings = result.settings;
  const BenchKernel& kernel = result.kernel;
  const BenchMemory& memory = result.memory;
  const file::Json document = {{"format", "kelpie-bench"},
                               {"version", 1},
                               {"window", settings.buffer},
                               {"gamma", settings.gamma},
                               {"c", settings.c},
                               {"tolerance", settings.tolerance},
                               {"compared", result.compared},
                               {"block", result.block},
                               {"axes", file::list(result.axes, bench_axis_json)},
                               {"over_window", file::list(result.over_window, growth_json)},
                               {"over_inputs", file::list(result.over_inputs, growth_json)},
                               {"kernel",
                                {{"samples", kernel.samples},
                                 {"inputs", kernel.inputs},
                                 {"row_us", file::number(kernel.row_us)},
                                 {"scalar_row_us", file::number(kernel.scalar_row_us)},
                                 {"prediction_us", file::number(kernel.prediction_us)}}},
                               {"model", model_json(result.model)},
                               {"memory_bytes",
                                {{"window", memory.window},
                                 {"inputs", memory.inputs},
                                 {"path", memory.path_double},
                                 {"path_float", memory.path_float},
                                 {"smo", memory.smo_double}}}};
  return file::json_text(document);
}

}  // namespace kelpie::lab
