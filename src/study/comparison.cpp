// SPDX-License-Identifier: Apache-2.0
#include "study/comparison.hpp"

#include <algorithm>
#include <atomic>
#include <iterator>
#include <limits>
#include <mutex>
#include <optional>

#include "jobs/run_all.hpp"
#include "kelpie/model/dynamics_model.hpp"
#include "study/stream.hpp"
#include "study/training_scales.hpp"
#include "study/yardsticks.hpp"

namespace kelpie::study {
namespace {

// Yardsticks learn in no time: they don't count.
bool takes_time(ContenderKind kind) {
  return kind == ContenderKind::kelpie || kind == ContenderKind::variant;
}

// What the threads tell the caller of their samples.
class ContenderWatch {
 public:
  ContenderWatch(const CompareOptions& options, std::size_t planned)
      : options_(options), planned_(static_cast<double>(planned)) {}

  // False once the caller has had enough.
  bool shown(ContenderKind kind) {
    const std::scoped_lock lock(mutex_);
    done_ += takes_time(kind) ? 1.0 : 0.0;
    stopped_ = stopped_ || !options_.keep_going(done_ / planned_);
    return !stopped_;
  }
  bool stopped() const { return stopped_; }
  void stop() { stopped_ = true; }

 private:
  const CompareOptions& options_;
  std::mutex mutex_;
  double planned_;
  double done_ = 0.0;
  std::atomic<bool> stopped_{false};
};

Contest hold(const log::Dataset& data, const Split& split, const Contender& contender,
             ContenderWatch& watch) {
  const std::unique_ptr<OnlineModel> model = contender.make();
  StreamOptions options;
  options.keep_going = [&](std::size_t) { return watch.shown(contender.kind); };
  Contest contest{contender.kind, contender.name, run_stream(data, split, *model, options)};
  for (AxisResult& axis : contest.stream.axes) {
    axis.update_us = {};
    axis.stages = {};
    axis.held_out_time_s = axis.held_out_true = axis.held_out_predicted = {};
    axis.corrected = {};
    axis.one_step.time_s = axis.one_step.lower = axis.one_step.upper = {};
    axis.one_step.configuration = {};
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

std::vector<Contender> yardstick_contenders(const log::Dataset& data) {
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
  const auto slow =
      static_cast<std::size_t>(std::ranges::count_if(contenders, takes_time, &Contender::kind));
  ContenderWatch watch(options, std::max<std::size_t>(1, slow) * split.training.size());
  jobs::run_all(contenders.size(), options.threads, [&](std::size_t i) {
    if (watch.stopped()) {
      return;
    }
    try {
      comparison.contests[i] = hold(data, split, contenders[i], watch);
    } catch (...) {
      watch.stop();  // or the other threads would finish their long streams for nothing
      throw;
    }
  });
  for (std::size_t axis = 0; axis < data.target_names.size() && !watch.stopped(); ++axis) {
    judge_one_step(comparison, axis);
  }
  return comparison;
}

}  // namespace kelpie::study
