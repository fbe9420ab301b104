// SPDX-License-Identifier: Apache-2.0
#include "bench_views.hpp"
#include "json_parts.hpp"
#include "kelpie/report/bench_report.hpp"

namespace kelpie {
namespace {

Json spread_json(const std::vector<double>& times_us) {
  const TimeSpread spread = spread_of(times_us);
  return {{"median", number(spread.median)},
          {"p99", number(spread.p99)},
          {"p999", number(spread.p999)},
          {"max", number(spread.max)}};
}

Json run_json(const SolverRun& run) {
  return {{"name", run.name},
          {"updates", run.update_us.size()},
          {"fallbacks", run.fallbacks},
          {"kkt_gap", number(run.gap)},
          {"us", spread_json(run.update_us)},
          {"update_us", numbers(run.update_us)},
          {"steps", numbers(run.steps)},
          {"free_samples", numbers(run.free_samples)}};
}

Json bench_axis_json(const BenchAxis& axis) {
  const Speedup speedup = speedup_of(axis);
  return {{"stream", axis.stream},
          {"simulated", axis.simulated},
          {"axis", axis.axis},
          {"epsilon", axis.epsilon},
          {"smo_over_path", number(speedup.smo)},
          {"libsvm_over_path", number(speedup.libsvm)},
          {"solvers", list(axis.runs, run_json)},
          {"libsvm_us", numbers(axis.libsvm_us)},
          {"path_whole", run_json(axis.whole)},
          {"learner",
           {{"buffer", axis.learner_buffer},
            {"update", spread_json(axis.learner_update_us)},
            {"predict", spread_json(axis.learner_predict_us)},
            {"update_us", numbers(axis.learner_update_us)},
            {"predict_us", numbers(axis.learner_predict_us)}}}};
}

Json growth_json(const BenchGrowth& growth) {
  const auto [path, smo] = exponents_of(growth, 0.0);
  return {{"stream", growth.stream},          {"axis", growth.axis},
          {"sizes", numbers(growth.sizes)},   {"path_us", numbers(growth.path_us)},
          {"smo_us", numbers(growth.smo_us)}, {"path_exponent", number(path)},
          {"smo_exponent", number(smo)}};
}

}  // namespace

std::string bench_json(const BenchResult& result) {
  const OnlineSvrSettings& settings = result.settings;
  const BenchKernel& kernel = result.kernel;
  const BenchMemory& memory = result.memory;
  const Json document = {{"format", "kelpie-bench"},
                         {"version", 1},
                         {"window", settings.buffer},
                         {"gamma", settings.gamma},
                         {"c", settings.c},
                         {"tolerance", settings.tolerance},
                         {"compared", result.compared},
                         {"block", result.block},
                         {"axes", list(result.axes, bench_axis_json)},
                         {"over_window", list(result.over_window, growth_json)},
                         {"over_inputs", list(result.over_inputs, growth_json)},
                         {"kernel",
                          {{"samples", kernel.samples},
                           {"inputs", kernel.inputs},
                           {"row_us", number(kernel.row_us)},
                           {"scalar_row_us", number(kernel.scalar_row_us)},
                           {"prediction_us", number(kernel.prediction_us)}}},
                         {"memory_bytes",
                          {{"window", memory.window},
                           {"inputs", memory.inputs},
                           {"path", memory.path_double},
                           {"path_float", memory.path_float},
                           {"smo", memory.smo_double}}}};
  return json_text(document);
}

}  // namespace kelpie
