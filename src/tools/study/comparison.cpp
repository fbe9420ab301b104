// SPDX-License-Identifier: Apache-2.0
#include "study/comparison.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <optional>

#include "core/quantile.hpp"
#include "jobs/executor.hpp"
#include "kelpie/model/dynamics_model.hpp"
#include "study/baselines.hpp"
#include "study/stream.hpp"
#include "study/training_scales.hpp"
#include "study/tuning.hpp"

namespace kelpie::study {
namespace {

constexpr double kClearGain = kTuning.comparison.clear_gain;

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
    contest.update_us += axis.update_us.empty() ? 0.0 : quantile(axis.update_us, 0.5);
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

double use_of(double r2) {
  return r2 < 0.0 ? 0.0 : r2;
}

double mean_gain(const StreamResult& contest, const StreamResult& kelpie) {
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t axis = 0; axis < kelpie.axes.size(); ++axis) {
    const double gain = use_of(contest.axes[axis].r2_final) - use_of(kelpie.axes[axis].r2_final);
    if (std::isfinite(gain)) {
      sum += gain;
      ++count;
    }
  }
  return count > 0 ? sum / static_cast<double>(count) : kUnknown;
}

std::vector<Split> inner_splits(const Split& split) {
  const std::vector<std::size_t>& rows = split.training;
  const SplitSettings fives{.kind = SplitKind::pieces};
  if (rows.size() < kTuning.comparison.least_inner_rows) {
    return {};
  }
  Split pieces{.label = "pieces of the training rows", .training = {}, .held_out = {}};
  Split tail{.label = "tail of the training rows", .training = {}, .held_out = {}};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::size_t piece = i * kTuning.split.pieces / rows.size();
    const bool is_held = piece % fives.every == fives.every - 1;
    const bool is_last = i >= rows.size() - rows.size() / fives.every;
    (is_held ? pieces.held_out : pieces.training).push_back(rows[i]);
    (is_last ? tail.held_out : tail.training).push_back(rows[i]);
  }
  return {pieces, tail};
}

namespace {

// Contenders on rows: every pair a job. False: stopped.
struct Heat {
  const Contender* contender;
  const Split* split;
  Contest* contest;
};

bool hold_all(const log::Dataset& data, std::vector<Heat> heats, const CompareOptions& options,
              const std::function<bool(double)>& keep_going) {
  std::vector<jobs::Job> list;
  for (const Heat& heat : heats) {
    list.push_back({.cost = cost_of(*heat.contender)});
  }
  return jobs::make_thread_executor(options.threads)
      ->run({
          .jobs = list,
          .work =
              [&](std::size_t i, const jobs::Advance& advance) {
                const Heat& heat = heats[i];
                *heat.contest = hold(data, *heat.split, *heat.contender, advance);
                return std::string();
              },
          .done = [](std::size_t, const std::string&) {},
          .keep_going = keep_going,
      });
}

// The second part of compare(): nothing to do where no variant gains.
bool hold_inner(const log::Dataset& data, const Split& split,
                const std::vector<Contender>& contenders, const CompareOptions& options,
                Comparison& comparison) {
  std::vector<std::size_t> gainers{0};
  for (std::size_t i = 1; i < contenders.size(); ++i) {
    const Contest& contest = comparison.contests[i];
    if (contest.kind == ContenderKind::variant &&
        mean_gain(contest.stream, comparison.contests.front().stream) > kClearGain) {
      gainers.push_back(i);
    }
  }
  const std::vector<Split> inner = gainers.size() > 1 ? inner_splits(split) : std::vector<Split>{};
  std::vector<Contest> contests(inner.size() * gainers.size());
  std::vector<Heat> heats;
  for (std::size_t k = 0; k < contests.size(); ++k) {
    heats.push_back(
        {&contenders[gainers[k % gainers.size()]], &inner[k / gainers.size()], &contests[k]});
  }
  if (!hold_all(data, heats, options,
                [&](double share) { return options.keep_going(0.5 * (1.0 + share)); })) {
    return false;
  }
  for (std::size_t k = 0; k < contests.size(); ++k) {
    const std::size_t kelpie = k - k % gainers.size();
    if (k != kelpie) {
      comparison.contests[gainers[k % gainers.size()]].inner_gains.push_back(
          mean_gain(contests[k].stream, contests[kelpie].stream));
    }
  }
  return true;
}

}  // namespace

const Contest* Comparison::better_variant() const {
  const Contest* best = nullptr;
  double best_gain = kClearGain;
  for (const Contest& contest : contests) {
    if (contest.inner_gains.empty()) {
      continue;
    }
    const double gain = std::min(std::ranges::min(contest.inner_gains),
                                 mean_gain(contest.stream, contests.front().stream));
    if (gain > best_gain) {
      best = &contest;
      best_gain = gain;
    }
  }
  return best;
}

Comparison compare(const log::Dataset& data, const Split& split,
                   const std::vector<Contender>& contenders, const CompareOptions& options) {
  Comparison comparison;
  comparison.contests.resize(contenders.size());
  std::vector<Heat> heats;
  for (std::size_t i = 0; i < contenders.size(); ++i) {
    heats.push_back({&contenders[i], &split, &comparison.contests[i]});
  }
  const bool finished =
      hold_all(data, heats, options, [&](double share) { return options.keep_going(0.5 * share); });
  if (!finished || !hold_inner(data, split, contenders, options, comparison)) {
    return comparison;
  }
  for (std::size_t axis = 0; axis < data.target_names.size(); ++axis) {
    judge_one_step(comparison, axis);
  }
  return comparison;
}

}  // namespace kelpie::study
