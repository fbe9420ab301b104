// SPDX-License-Identifier: Apache-2.0
#include "study/baselines.hpp"

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "kelpie/core/error.hpp"
#include "kelpie/learner/recursive_least_squares.hpp"
#include "kelpie/motion/term_set.hpp"
#include "model/axis_list.hpp"
#include "motion/states.hpp"
#include "study/stream.hpp"
#include "study/tuning.hpp"

namespace kelpie::study {
namespace {

// Predicts the same everywhere: what it makes of the targets so far.
class Constant : public OnlineRegressor {
 public:
  Decision update(std::span<const double> /*x*/, double y, double /*t*/) final {
    const Decision decision{.prediction = {.value = value_}, .had_model = status_.ready};
    value_ = next(value_, y);
    status_.ready = true;
    return decision;
  }
  double predict(std::span<const double> /*x*/) const final { return value_; }
  Status status() const final { return status_; }

 private:
  virtual double next(double value, double y) = 0;

  double value_ = 0.0;
  Status status_;
};

class Mean final : public Constant {
  double next(double value, double y) override {
    return value + (y - value) / static_cast<double>(++count_);
  }

  std::size_t count_ = 0;
};

class LastValue final : public Constant {
  double next(double /*value*/, double y) override { return y; }
};

TermSet physics_terms(const log::Dataset& data) {
  const std::size_t named = named_velocities(data.input_names);
  const std::size_t velocities =
      std::min(named > 0 ? named : data.target_names.size(),
               std::min(kTuning.baselines.most_velocities, data.input_names.size()));
  return TermSet::baseline(data.input_names, velocities);
}

std::unique_ptr<OnlineModel> one_per_target(const log::Dataset& data, const LearnerFactory& make) {
  std::vector<std::unique_ptr<OnlineRegressor>> axes;
  for (std::size_t i = 0; i < data.target_names.size(); ++i) {
    axes.push_back(make());
  }
  return std::make_unique<AxisList>(std::move(axes));
}

}  // namespace

LearnerFactory least_squares_of_one_axis(const log::Dataset& data) {
  RecursiveLeastSquaresSettings settings;
  settings.huber = kTuning.baselines.huber;
  try {
    return [terms = physics_terms(data), inputs = data.input_names.size(), settings] {
      return std::make_unique<RecursiveLeastSquares>(inputs, terms, settings);
    };
  } catch (const InputError&) {
    return {};
  }
}

LearnerFactory mean_of_one_axis() {
  return [] { return std::make_unique<Mean>(); };
}

std::unique_ptr<OnlineModel> make_least_squares(const log::Dataset& data) {
  const LearnerFactory make = least_squares_of_one_axis(data);
  return make ? one_per_target(data, make) : nullptr;
}

std::unique_ptr<OnlineModel> make_mean(const log::Dataset& data) {
  return one_per_target(data, mean_of_one_axis());
}

std::unique_ptr<OnlineModel> make_last_value(const log::Dataset& data) {
  return one_per_target(data, [] { return std::make_unique<LastValue>(); });
}

log::Dataset without_inputs(log::Dataset data, const std::vector<std::string>& left_out) {
  const std::vector<std::string> names = std::exchange(data.input_names, {});
  const std::vector<double> inputs = std::exchange(data.inputs, {});
  data.poses.clear();
  data.pose_inputs.clear();
  const auto is_kept = [&](std::size_t i) {
    return std::ranges::find(left_out, names[i]) == left_out.end();
  };
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    if (is_kept(i % names.size())) {
      data.inputs.push_back(inputs[i]);
    }
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (is_kept(i)) {
      data.input_names.push_back(names[i]);
    }
  }
  return data;
}

void add_baselines(const log::Dataset& data, const Split& split,
                   const std::vector<std::string>& commands, StreamResult& result) {
  StreamOptions stream;
  stream.validate_every = split.training.size();  // at the end alone
  stream.keep_going = [&](std::size_t shown) { return shown < result.samples_shown; };
  const auto measure_on = [&](const log::Dataset& rows, Baseline Baselines::*baseline,
                              const std::unique_ptr<OnlineModel>& model) {
    if (!model) {
      return;
    }
    const StreamResult measured = run_stream(rows, split, *model, stream);
    for (std::size_t i = 0; i < result.axes.size(); ++i) {
      const OneStep& steps = measured.axes[i].one_step;
      // A model that goes on predicts its first sample, of which a baseline knows nothing yet.
      std::vector<std::size_t> samples;
      std::ranges::set_intersection(result.axes[i].one_step.samples, steps.samples,
                                    std::back_inserter(samples));
      result.axes[i].baselines.*baseline = {measured.axes[i].r2_final, one_step_r2(steps, samples)};
    }
  };
  measure_on(data, &Baselines::least_squares, make_least_squares(data));
  measure_on(data, &Baselines::mean, make_mean(data));
  measure_on(data, &Baselines::last_value, make_last_value(data));
  if (!commands.empty() && commands.size() < data.input_names.size()) {
    const log::Dataset rest = without_inputs(data, commands);
    measure_on(rest, &Baselines::without_commands, make_least_squares(rest));
  }
  for (AxisResult& axis : result.axes) {
    axis.baselines.last_value.r2_final = Baseline{}.r2_final;
  }
}

}  // namespace kelpie::study
