// SPDX-License-Identifier: Apache-2.0
#include "format/json_parts.hpp"
#include "lab/bench_report.hpp"
#include "lab/bench_views.hpp"
#include "study/summary.hpp"

namespace kelpie::lab {
namespace {

format::Json spread_json(const std::vector<double>& times_us) {
  const study::Quantiles spread = study::quantiles_of(times_us);
  return {{"median", format::number(spread.median)},
          {"p99", format::number(spread.p99)},
          {"p999", format::number(spread.p999)},
          {"max", format::number(spread.max)}};
}

format::Json run_json(const SolverRun& run) {
  return {{"name", run.name},
          {"updates", run.update_us.size()},
          {"fallbacks", run.fallbacks},
          {"kkt_gap", format::number(run.gap)},
          {"us", spread_json(run.update_us)},
          {"update_us", format::numbers(run.update_us)},
          {"steps", format::numbers(run.steps)},
          {"free_samples", format::numbers(run.free_samples)}};
}

format::Json bench_axis_json(const BenchAxis& axis) {
  const Speedup speedup = speedup_of(axis);
  return {{"stream", axis.stream},
          {"simulated", axis.simulated},
          {"axis", axis.axis},
          {"epsilon", axis.epsilon},
          {"smo_over_path", format::number(speedup.smo)},
          {"libsvm_over_path", format::number(speedup.libsvm)},
          {"solvers", format::list(axis.runs, run_json)},
          {"libsvm_us", format::numbers(axis.libsvm_us)},
          {"path_whole", run_json(axis.whole)},
          {"learner",
           {{"buffer", axis.learner_buffer},
            {"update", spread_json(axis.learner_update_us)},
            {"predict", spread_json(axis.learner_predict_us)},
            {"update_us", format::numbers(axis.learner_update_us)},
            {"predict_us", format::numbers(axis.learner_predict_us)}}}};
}

format::Json growth_json(const BenchGrowth& growth) {
  const auto [path, smo] = exponents_of(growth, 0.0);
  return {{"stream", growth.stream},
          {"axis", growth.axis},
          {"sizes", format::numbers(growth.sizes)},
          {"path_us", format::numbers(growth.path_us)},
          {"smo_us", format::numbers(growth.smo_us)},
          {"path_exponent", format::number(path)},
          {"smo_exponent", format::number(smo)}};
}

}  // namespace

std::string bench_json(const BenchResult& result) {
  const OnlineSvrSettings& settings = result.settings;
  const BenchKernel& kernel = result.kernel;
  const BenchMemory& memory = result.memory;
  const format::Json document = {{"format", "kelpie-bench"},
                                 {"version", 1},
                                 {"window", settings.buffer},
                                 {"gamma", settings.gamma},
                                 {"c", settings.c},
                                 {"tolerance", settings.tolerance},
                                 {"compared", result.compared},
                                 {"block", result.block},
                                 {"axes", format::list(result.axes, bench_axis_json)},
                                 {"over_window", format::list(result.over_window, growth_json)},
                                 {"over_inputs", format::list(result.over_inputs, growth_json)},
                                 {"kernel",
                                  {{"samples", kernel.samples},
                                   {"inputs", kernel.inputs},
                                   {"row_us", format::number(kernel.row_us)},
                                   {"scalar_row_us", format::number(kernel.scalar_row_us)},
                                   {"prediction_us", format::number(kernel.prediction_us)}}},
                                 {"memory_bytes",
                                  {{"window", memory.window},
                                   {"inputs", memory.inputs},
                                   {"path", memory.path_double},
                                   {"path_float", memory.path_float},
                                   {"smo", memory.smo_double}}}};
  return format::json_text(document);
}

}  // namespace kelpie::lab
