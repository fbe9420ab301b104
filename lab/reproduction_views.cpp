// SPDX-License-Identifier: Apache-2.0
#include "lab/reproduction_views.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/quantile.hpp"
#include "study/summary.hpp"

namespace kelpie::lab {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kSettling = 1000;

// Mean of the finite values, NaN without any.
double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const double value : values) {
    if (std::isfinite(value)) {
      sum += value;
      ++count;
    }
  }
  return count > 0 ? sum / static_cast<double>(count) : kNan;
}

template <typename Value>
double mean_over(std::size_t count, Value value) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) {
    values.push_back(value(i));
  }
  return mean_of(values);
}

std::size_t looks_of(const ContenderRuns& runs, std::size_t axis) {
  std::size_t looks = std::numeric_limits<std::size_t>::max();
  for (const std::vector<study::AxisResult>& seed : runs.seeds) {
    looks = std::min(looks, seed[axis].validation.size());
  }
  return runs.seeds.empty() ? 0 : looks;
}

// Whether a look lies in the settled part of its stage.
bool settled(const study::AxisResult& axis, std::size_t samples) {
  std::size_t begin = 0;
  for (const study::StageEnd& stage : axis.stages) {
    if (samples <= stage.samples) {
      break;
    }
    begin = stage.samples;
  }
  return samples >= begin + kSettling;
}

// Adds one run's looks from `reference`'s first forgotten sample on.
void add_run(const study::AxisResult& run, const study::AxisResult& reference, Steadiness& sum,
             std::size_t& runs) {
  std::vector<double> values;
  double squares = 0.0;
  std::size_t steps = 0;
  std::size_t previous = std::numeric_limits<std::size_t>::max() - 1;
  const std::size_t looks = std::min(run.validation.size(), reference.validation.size());
  for (std::size_t look = 0; look < looks; ++look) {
    const study::ValidationPoint& point = run.validation[look];
    if (reference.validation[look].status.tally.forgotten == 0 || !settled(run, point.samples) ||
        !std::isfinite(point.r2)) {
      continue;
    }
    if (previous + 1 == look) {
      squares += std::pow(point.r2 - run.validation[previous].r2, 2);
      ++steps;
    }
    previous = look;
    values.push_back(point.r2);
  }
  if (steps > 0) {
    sum.looks += values.size();
    sum.jitter += std::sqrt(squares / static_cast<double>(steps));
    const double lowest = *std::ranges::min_element(values);
    sum.deepest += quantile(values, 0.5) - lowest;
    ++runs;
  }
}

}  // namespace

MeanCurve mean_curve(const ContenderRuns& runs, std::size_t axis) {
  MeanCurve curve;
  for (std::size_t look = 0; look < looks_of(runs, axis); ++look) {
    double low = HUGE_VAL;
    double high = -HUGE_VAL;
    double sum = 0.0;
    for (const std::vector<study::AxisResult>& seed : runs.seeds) {
      const double r2 = study::served_r2(seed[axis].validation[look]);
      low = std::min(low, r2);
      high = std::max(high, r2);
      sum += r2;
    }
    const auto x = static_cast<double>(runs.seeds.front()[axis].validation[look].samples);
    const double mean = sum / static_cast<double>(runs.seeds.size());
    curve.mean.push_back({x, mean});
    curve.low.push_back({x, std::isfinite(mean) ? low : kNan});
    curve.high.push_back({x, std::isfinite(mean) ? high : kNan});
  }
  return curve;
}

const ContenderRuns* find_contender(const StreamStudy& study, std::string_view key) {
  const auto found = std::ranges::find(study.contenders, key, &ContenderRuns::key);
  return found == study.contenders.end() ? nullptr : &*found;
}

double stage_r2(const ContenderRuns& runs, std::size_t axis, std::size_t stage) {
  return mean_over(runs.seeds.size(),
                   [&](std::size_t seed) { return runs.seeds[seed][axis].stages[stage].r2; });
}

std::size_t stages_of(const StreamStudy& study) {
  const bool ran = !study.contenders.empty() && !study.contenders.front().seeds.empty() &&
                   !study.contenders.front().seeds.front().empty();
  return ran ? study.contenders.front().seeds.front().front().stages.size() : 0;
}

double baseline_r2(const StreamStudy& study, std::size_t axis, std::size_t stage) {
  if (study.offline.empty() || stage >= stages_of(study)) {
    return kNan;
  }
  const int configuration =
      study.contenders.front().seeds.front().front().stages[stage].configuration;
  const auto place = std::ranges::find(study.configurations, configuration);
  const auto index = static_cast<std::size_t>(place - study.configurations.begin());
  return study.offline[axis].models.at(index).r2.at(index);
}

double mean_stage_r2(const ContenderRuns& runs, std::size_t stage) {
  const std::size_t axes = runs.seeds.empty() ? 0 : runs.seeds.front().size();
  return mean_over(axes, [&](std::size_t axis) { return stage_r2(runs, axis, stage); });
}

double mean_baseline_r2(const StreamStudy& study, std::size_t stage) {
  return mean_over(study.offline.size(),
                   [&](std::size_t axis) { return baseline_r2(study, axis, stage); });
}

Steadiness steadiness(const ContenderRuns& runs, const ContenderRuns& reference) {
  Steadiness sum;
  std::size_t count = 0;
  for (std::size_t seed = 0; seed < std::min(runs.seeds.size(), reference.seeds.size()); ++seed) {
    for (std::size_t axis = 0; axis < runs.seeds[seed].size(); ++axis) {
      add_run(runs.seeds[seed][axis], reference.seeds[seed][axis], sum, count);
    }
  }
  if (count > 0) {
    sum.jitter /= static_cast<double>(count);
    sum.deepest /= static_cast<double>(count);
  }
  return sum;
}

std::vector<SwitchEffect> switch_effects(const StreamStudy& study, const ContenderRuns& runs) {
  std::vector<SwitchEffect> effects;
  for (std::size_t stage = 1; stage < stages_of(study); ++stage) {
    SwitchEffect effect{mean_stage_r2(runs, stage - 1), 0.0, mean_stage_r2(runs, stage)};
    const std::size_t from = runs.seeds.front().front().stages[stage - 1].samples;
    std::vector<double> lowest;
    for (const std::vector<study::AxisResult>& seed : runs.seeds) {
      for (const study::AxisResult& axis : seed) {
        double least = HUGE_VAL;
        for (const study::ValidationPoint& point : axis.validation) {
          if (point.samples > from && point.samples <= from + kSettling) {
            least = std::fmin(least, point.r2);
          }
        }
        lowest.push_back(least);
      }
    }
    effect.lowest = mean_of(lowest);
    effects.push_back(effect);
  }
  return effects;
}

}  // namespace kelpie::lab
