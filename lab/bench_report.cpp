// SPDX-License-Identifier: Apache-2.0
#include "lab/bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <span>
#include <utility>

#include "chart/text_table.hpp"
#include "chart/wording.hpp"
#include "file/content.hpp"
#include "lab/json_table.hpp"
#include "study/metrics.hpp"
#include "study/summary.hpp"

namespace kelpie::lab {
namespace {

using file::Json;

constexpr std::size_t kLongestStream = 30;
constexpr double kSettledWindow = 450.0;

std::string times_text(double ratio) {
  return std::isfinite(ratio) ? fmt::format("{:.{}f} ×", ratio, ratio < 100.0 ? 1 : 0) : "–";
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
std::string stream_text(const Json& axis) {
  const std::string path = axis["stream"];
  const std::string name =
      chart::shortened(std::filesystem::path(path).filename().string(), kLongestStream);
  return axis["simulated"] ? name + " (simulation)" : name;
}

chart::TextTable ratios_table(const Json& axes) {
  return json_table(
      "How much longer others take per update (medians, same samples)",
      {{"axis",
        [](const Json& row) { return stream_text(row) + " " + row["axis"].get<std::string>(); }},
       column("ε", "/epsilon", fixed("{}")),
       column("path", "/solvers/0/us/median", chart::duration),
       column("SMO", "/solvers/2/us/median", chart::duration),
       column("LIBSVM", "/libsvm_us", chart::duration),
       {"runs", [](const Json& row) { return chart::grouped(row["libsvm_us"].size()); }},
       column("SMO/path", "/smo_over_path", times_text),
       column("LIBSVM/path", "/libsvm_over_path", times_text)},
      axes);
}

chart::TextTable runs_table(const Json& axis) {
  std::vector<JsonColumn> columns{column("", "/name"), column("updates", "/updates", count_text)};
  std::ranges::move(spread_columns("/us"), std::back_inserter(columns));
  std::ranges::move(std::vector{column("steps", "/steps", fixed("{:.0f}")),
                                column("free", "/free_samples", fixed("{:.0f}")),
                                column("fallbacks", "/fallbacks", count_text),
                                column("gap", "/kkt_gap", fixed("{:.1e}"))},
                    std::back_inserter(columns));
  Json rows = axis["solvers"];
  rows.push_back(axis["path_whole"]);
  rows.back()["name"] = "path, whole";
  for (const std::string part : {"update", "predict"}) {
    const Json& learner = axis["learner"];
    rows.push_back({{"name", "learner, " + part},
                    {"updates", learner[part + "_us"].size()},
                    {"us", learner[part]}});
  }
  return json_table(fmt::format("{}, {}, ε = {}", stream_text(axis),
                                axis["axis"].get<std::string>(), axis["epsilon"].get<double>()),
                    columns, rows);
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
    table.head.push_back(fmt::format("{:.0f}", size));
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

Json spread_json(const std::vector<double>& times_us) {
  const study::Quantiles spread = study::quantiles_of(times_us);
  return {{"median", file::number(spread.median)},
          {"p99", file::number(spread.p99)},
          {"p999", file::number(spread.p999)},
          {"max", file::number(spread.max)}};
}

Json run_json(const SolverRun& run) {
  return {{"name", run.name},
          {"updates", run.update_us.size()},
          {"fallbacks", run.fallbacks},
          {"kkt_gap", file::number(run.gap)},
          {"us", spread_json(run.update_us)},
          {"update_us", file::numbers(run.update_us)},
          {"steps", file::numbers(run.steps)},
          {"free_samples", file::numbers(run.free_samples)}};
}

Json bench_axis_json(const BenchAxis& axis) {
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

Json growth_json(const BenchGrowth& growth) {
  const auto [path, smo] = exponents_of(growth, 0.0);
  return {{"stream", growth.stream},
          {"axis", growth.axis},
          {"sizes", file::numbers(growth.sizes)},
          {"path_us", file::numbers(growth.path_us)},
          {"smo_us", file::numbers(growth.smo_us)},
          {"path_exponent", file::number(path)},
          {"smo_exponent", file::number(smo)}};
}

Json model_json(const UpdateTimes& times) {
  const auto bin = [](const TimesBin& one) {
    return Json{
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

chart::TextTable kernel_table(const Json& kernel) {
  const auto over_row = [](const char* head, const char* key) {
    return JsonColumn{head, [key](const Json& row) {
                        return times_text(row[key].get<double>() / row["row_us"].get<double>());
                      }};
  };
  return json_table(
      fmt::format("Kernel, {} samples of {} inputs", kernel["samples"].get<int>(),
                  kernel["inputs"].get<int>()),
      {column("row", "/row_us", fixed("{:.2f} µs")),
       column("plain loop with std::exp", "/scalar_row_us", fixed("{:.2f} µs")),
       column("prediction", "/prediction_us", fixed("{:.2f} µs")),
       over_row("plain/row", "scalar_row_us"), over_row("prediction/row", "prediction_us")},
      Json::array({kernel}));
}

chart::TextTable memory_table(const Json& memory) {
  const auto bytes = [](double value) { return file::megabytes(static_cast<std::size_t>(value)); };
  return json_table(fmt::format("Memory of a learner, computed: window {}, {} inputs",
                                memory["window"].get<int>(), memory["inputs"].get<int>()),
                    {column("path", "/path", bytes), column("path, float", "/path_float", bytes),
                     column("SMO", "/smo", bytes)},
                    Json::array({memory}));
}

Json document_of(const BenchResult& result) {
  const OnlineSvrSettings& settings = result.settings;
  const BenchKernel& kernel = result.kernel;
  const BenchMemory& memory = result.memory;
  return {{"format", "kelpie-bench"},
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
}

}  // namespace

std::string bench_table(const BenchResult& result) {
  const Json json = document_of(result);
  std::vector<chart::TextTable> tables{ratios_table(json["axes"])};
  std::ranges::transform(json["axes"], std::back_inserter(tables), runs_table);
  std::ranges::move(
      std::vector{
          growth_table(result.over_window,
                       fmt::format("window (exponent from {} on)", kSettledWindow), kSettledWindow),
          growth_table(result.over_inputs, "number of inputs (the first three, repeated)", 0.0),
          kernel_table(json["kernel"]), memory_table(json["memory_bytes"]),
          histogram_table(result.model), slowest_table(result.model)},
      std::back_inserter(tables));
  return chart::wrapped(bench_method(result)) + "\n\n" + chart::tables_text(tables);
}

std::string bench_json(const BenchResult& result) {
  return file::json_text(document_of(result));
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
