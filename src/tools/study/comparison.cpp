// SPDX-License-Identifier: Apache-2.0
#include "study/comparison.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <optional>

#include "jobs/executor.hpp"
#include "kelpie/model/dynamics_model.hpp"
#include "study/baselines.hpp"
#include "study/stream.hpp"
#include "study/training_scales.hpp"

namespace kelpie::study {
namespace {

// Baselines learn in next to no time.
double cost_of(const Contender& contender) {
  const bool learns =
      contender.kind == ContenderKind::kelpie || contender.kind == ContenderKind::variant;
  return learns ? 1.0 : 0.01;
}

Contest hold(const log::Dataset& data, const Split& split, const Contender& contender,
             const jobs::Advance& advance) {
  const std::unique_ptr<OnlineModel> model = contender.make();
  const auto samples = static_cast<double>(split.training.size());
  StreamOptions options;
  options.keep_going = [&](std::size_t shown) {
    return advance(static_cast<double>(shown) / samples);
  };
  Contest contest{contender.kind, contender.name, run_stream(data, split, *model, options)};
  for (AxisResult& axis : contest.stream.axes) {
    axis.update_us = {};
    for (StageEnd& stage : axis.stages) {
      stage.truth = stage.predicted = {};
    }
    axis.held_out_time_s = axis.held_out_true = axis.held_out_predicted = {};
    axis.corrected = {};
    axis.one_step.lower = axis.one_step.upper = {};
    if (contender.kind == ContenderKind::last_value) {
      axis.validation = {};
      axis.r2_final = axis.r2_mean = axis.r2_min_after_1000 =
          std::numeric_limits<double>::quiet_NaN();
    }
  }
  return contest;
}

std::vector<std::size_t> common_samples(const std::vector<Contest>& contests, std::size_t axis) {
  std::optional<std::vector<std::size_t>> common;
  for (const Contest& contest : contests) {
    const std::vector<std::size_t>& samples = contest.stream.axes[axis].one_step.samples;
    if (!common && !samples.empty()) {
      common = samples;
    } else if (!samples.empty()) {
      std::vector<std::size_t> both;
      std::ranges::set_intersection(*common, samples, std::back_inserter(both));
      common = std::move(both);
    }
  }
  return common.value_or(std::vector<std::size_t>{});
}

void judge_one_step(Comparison& comparison, std::size_t axis) {
  const std::vector<std::size_t> samples = common_samples(comparison.contests, axis);
  comparison.one_step_samples.push_back(samples.size());
  for (Contest& contest : comparison.contests) {
    AxisResult& result = contest.stream.axes[axis];
    result.prequential_r2 = one_step_r2(result.one_step, samples);
    result.one_step = {};
  }
}

}  // namespace

Contender make_contender(ContenderKind kind, std::string name, const log::Dataset& data,
                         const Split& split, const ModelSettings& settings) {
  training_scales(data, split.training, settings.shared);
  return {kind, std::move(name), [&data, settings] {
            return std::make_unique<DynamicsModel>(data.input_names, data.target_names, settings);
          }};
}

std::vector<Contender> baseline_contenders(const log::Dataset& data) {
  std::vector<Contender> contenders;
  if (make_least_squares(data)) {
    contenders.push_back({ContenderKind::least_squares, "least squares",
                          [&data] { return make_least_squares(data); }});
  }
  contenders.push_back({ContenderKind::mean, "mean", [&data] { return make_mean(data); }});
  contenders.push_back(
      {ContenderKind::last_value, "last value", [&data] { return make_last_value(data); }});
  return contenders;
}

Comparison compare(const log::Dataset& data, const Split& split,
                   const std::vector<Contender>& contenders, const CompareOptions& options) {
  Comparison comparison;
  comparison.contests.resize(contenders.size());
  std::vector<jobs::Job> list;
  for (std::size_t i = 0; i < contenders.size(); ++i) {
    const std::string place = std::to_string(i);
    list.push_back({place, place, cost_of(contenders[i])});
  }
  const bool finished = jobs::make_thread_executor(options.threads)
                            ->run({
                                .jobs = list,
                                .work =
                                    [&](const jobs::Job& job, const jobs::Advance& advance) {
                                      const std::size_t i = std::stoul(job.task);
                                      comparison.contests[i] =
                                          hold(data, split, contenders[i], advance);
                                      return std::string();
                                    },
                                .done = [](std::size_t, const std::string&) {},
                                .keep_going = options.keep_going,
                            });
  for (std::size_t axis = 0; axis < data.target_names.size() && finished; ++axis) {
    judge_one_step(comparison, axis);
  }
  return comparison;
}

}  // namespace kelpie::study
