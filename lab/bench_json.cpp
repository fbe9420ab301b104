// SPDX-License-Identifier: Apache-2.0
#include "file/json.hpp"
#include "lab/bench_report.hpp"
#include "lab/bench_views.hpp"
#include "study/summary.hpp"

namespace kelpie::lab {
namespace {

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
