// SPDX-License-Identifier: Apache-2.0
#include "study/open_loop_study.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "core/quantile.hpp"
#include "core/seconds.hpp"
#include "kelpie/learner/recursive_least_squares.hpp"
#include "kelpie/model/trained_model.hpp"
#include "study/metrics.hpp"
#include "study/tuning.hpp"

namespace kelpie::study {
namespace {

double step_after(const log::Dataset& data, std::size_t row) {
  return data.times_s[row + 1] - data.times_s[row];
}

// What is kept of all rollouts that reached one horizon, for one state.
struct Ends {
  std::vector<double> truth;
  std::vector<double> predicted;
  std::size_t covered = 0;

  void add(double is, double said, double spread) {
    truth.push_back(is);
    predicted.push_back(said);
    covered += std::abs(is - said) <= kNormal90 * spread ? 1 : 0;
  }
};

double root_mean_square(const Ends& ends) {
  double sum = 0.0;
  for (std::size_t i = 0; i < ends.truth.size(); ++i) {
    sum += (ends.truth[i] - ends.predicted[i]) * (ends.truth[i] - ends.predicted[i]);
  }
  return std::sqrt(sum / static_cast<double>(ends.truth.size()));
}

class Horizons {
 public:
  Horizons(const OpenLoop& model, const log::Dataset& data, const OpenLoopStudy& study)
      : data_(data),
        study_(study),
        states_(model.states),
        noise_(model.noise),
        rollout_(model, study.rollout),
        ends_(study.horizons_s.size(), std::vector<Ends>(states_.size())),
        beyond_(study.horizons_s.size(), 0) {}

  void run(const Stretch& stretch, std::size_t start) {
    rollout_.start(data_.input(start));
    bool beyond = false;
    std::size_t row = start;
    for (std::size_t h = 0; h < ends_.size(); ++h) {
      const std::size_t end = row_after(data_, stretch, start, study_.horizons_s[h]);
      if (end == stretch.end) {
        return;
      }
      for (; row < end; ++row) {
        rollout_.advance(data_.input(row + 1), step_after(data_, row));
        beyond = beyond || rollout_.beyond();
      }
      beyond_[h] += beyond ? 1 : 0;
      for (std::size_t state = 0; state < states_.size(); ++state) {
        ends_[h][state].add(data_.input(row)[states_[state]], rollout_.velocity(state),
                            std::hypot(rollout_.spread(state), noise_[state]));
      }
    }
  }

  std::vector<HorizonScore> scores() const {
    std::vector<HorizonScore> scores;
    for (std::size_t h = 0; h < ends_.size(); ++h) {
      HorizonScore& score = scores.emplace_back();
      score.seconds = study_.horizons_s[h];
      score.starts = ends_[h].front().truth.size();
      const auto starts = static_cast<double>(score.starts);
      score.beyond = static_cast<double>(beyond_[h]) / starts;
      for (const Ends& ends : ends_[h]) {
        score.r2.push_back(r_squared(ends.truth, ends.predicted));
        score.rms.push_back(root_mean_square(ends));
        score.covered.push_back(static_cast<double>(ends.covered) / starts);
      }
    }
    return scores;
  }

 private:
  const log::Dataset& data_;
  const OpenLoopStudy& study_;
  std::vector<std::size_t> states_;
  std::vector<double> noise_;  // of what is compared with
  Rollout rollout_;
  std::vector<std::vector<Ends>> ends_;  // [horizon][state]
  std::vector<std::size_t> beyond_;
};

// Error over distance for one outage; NaN where the vehicle stood still.
double reckoning_error(Rollout& rollout, std::span<const std::size_t> states,
                       const log::Dataset& data, std::size_t start, std::size_t end) {
  Pose truth;
  Pose reckoned;
  double distance = 0.0;
  rollout.start(data.input(start));
  for (std::size_t row = start; row < end; ++row) {
    const std::span<const double> now = data.input(row);
    const std::span<const double> next = data.input(row + 1);
    const double dt_s = step_after(data, row);
    const double u = rollout.velocity(0);
    const double v = rollout.velocity(1);
    rollout.advance(next, dt_s);
    const auto mean = [&](std::size_t state) {
      return 0.5 * (now[states[state]] + next[states[state]]);
    };
    truth.advance(mean(0), mean(1), mean(2), dt_s);
    reckoned.advance(0.5 * (u + rollout.velocity(0)), 0.5 * (v + rollout.velocity(1)), mean(2),
                     dt_s);
    distance += std::hypot(mean(0), mean(1)) * dt_s;
  }
  return distance > kTuning.open_loop.still_m
             ? std::hypot(truth.x - reckoned.x, truth.y - reckoned.y) / distance
             : std::numeric_limits<double>::quiet_NaN();
}

std::vector<ReckoningScore> reckon(const OpenLoop& model, const log::Dataset& data,
                                   std::span<const Stretch> stretches, const OpenLoopStudy& study) {
  RolloutSettings settings = study.rollout;
  settings.measured = {2};
  Rollout rollout(model, settings);
  std::vector<ReckoningScore> scores;
  for (const double seconds : study.outages_s) {
    std::vector<double> errors;
    for (const Stretch& stretch : stretches) {
      for (const std::size_t start :
           starts_in(data.times_s, stretch, std::max(0.5 * seconds, 1.0))) {
        const std::size_t end = row_after(data, stretch, start, seconds);
        if (end < stretch.end) {
          errors.push_back(reckoning_error(rollout, model.states, data, start, end));
        }
      }
    }
    std::erase_if(errors, [](double error) { return std::isnan(error); });
    ReckoningScore& score = scores.emplace_back();
    score.seconds = seconds;
    score.outages = errors.size();
    const bool any = !errors.empty();
    score.median = any ? quantile(errors, 0.5) : std::numeric_limits<double>::quiet_NaN();
    score.most = any ? quantile(errors, 0.95) : score.median;
  }
  return scores;
}

// The recursive least squares an engineer would take, trained on the same rows in their order.
OpenLoop least_squares(const OpenLoop& like, const log::Dataset& data, const Split& split) {
  RecursiveLeastSquaresSettings settings;
  settings.velocities = static_cast<int>(like.states.size());
  auto axes = std::make_shared<std::vector<RecursiveLeastSquares>>();
  for (std::size_t axis = 0; axis < like.states.size(); ++axis) {
    RecursiveLeastSquares& one = axes->emplace_back(data.input_names, settings);
    for (const std::size_t row : split.training) {
      one.update(data.input(row), data.target(row)[axis], data.times_s[row]);
    }
  }
  OpenLoop loop = hold_velocity(like);
  loop.accelerations = [axes](std::span<const double> x, std::span<double> a) {
    for (std::size_t axis = 0; axis < axes->size(); ++axis) {
      a[axis] = (*axes)[axis].predict(x);
    }
  };
  return loop;
}

// Whether the velocities are the first inputs, as recursive least squares has them.
bool states_first(const OpenLoop& loop) {
  for (std::size_t i = 0; i < loop.states.size(); ++i) {
    if (loop.states[i] != i) {
      return false;
    }
  }
  return true;
}

// How much the states move between two rows, in widths of the ranges seen.
double liveliness(const OpenLoop& loop, const log::Dataset& data, std::size_t begin,
                  std::size_t end) {
  double sum = 0.0;
  for (const std::size_t state : loop.states) {
    double low = data.input(begin)[state];
    double high = low;
    for (std::size_t row = begin; row <= end; ++row) {
      low = std::min(low, data.input(row)[state]);
      high = std::max(high, data.input(row)[state]);
    }
    sum += (high - low) / (loop.seen[state].high - loop.seen[state].low);
  }
  return sum;
}

// How far a state's change to the next row is from what the targets say, as an acceleration.
double jump(const log::Dataset& data, std::size_t state, std::size_t axis, std::size_t row) {
  const double change = data.input(row + 1)[state] - data.input(row)[state];
  const double explained = 0.5 * (data.target(row)[axis] + data.target(row + 1)[axis]);
  return std::abs(change / step_after(data, row) - explained);
}

// Beyond what the vehicle does and beyond what the noise of velocity makes of it.
double largest_jump(const log::Dataset& data, std::size_t state, std::size_t axis) {
  std::vector<double> jumps;
  double square = 0.0;
  for (std::size_t row = 0; row < data.rows(); ++row) {
    square += data.target(row)[axis] * data.target(row)[axis];
    if (row + 1 < data.rows() && step_after(data, row) > 0.0) {
      jumps.push_back(jump(data, state, axis, row));
    }
  }
  const double usual = std::sqrt(square / static_cast<double>(data.rows()));
  const double noise = jumps.empty() ? 0.0 : quantile(jumps, 0.5);
  return std::max(kTuning.open_loop.jump * usual, kTuning.open_loop.noise * noise);
}

}  // namespace

std::vector<std::size_t> starts_in(std::span<const double> times_s, const Stretch& stretch,
                                   double every_s) {
  std::vector<std::size_t> starts;
  double next_s = -std::numeric_limits<double>::infinity();
  for (std::size_t row = stretch.begin; row + 1 < stretch.end; ++row) {
    if (times_s[row] >= next_s) {
      starts.push_back(row);
      next_s = times_s[row] + every_s * (1.0 - 1e-9);
    }
  }
  return starts;
}

std::size_t row_after(const log::Dataset& data, const Stretch& stretch, std::size_t start,
                      double seconds) {
  constexpr double kRounding = 1e-6;
  const double until = data.times_s[start] + seconds - kRounding;
  const auto begin = data.times_s.begin();
  const auto found = std::lower_bound(begin + static_cast<std::ptrdiff_t>(start),
                                      begin + static_cast<std::ptrdiff_t>(stretch.end), until);
  return static_cast<std::size_t>(found - begin);
}

std::vector<Stretch> unbroken_stretches(const log::Dataset& data, std::span<const std::size_t> rows,
                                        std::span<const std::size_t> states) {
  std::vector<double> steps;
  for (std::size_t row = 0; row + 1 < data.rows(); ++row) {
    steps.push_back(step_after(data, row));
  }
  const double longest = kLongestStep * quantile(steps, 0.5);
  std::vector<double> most(states.size());
  for (std::size_t axis = 0; axis < states.size(); ++axis) {
    most[axis] = largest_jump(data, states[axis], axis);
  }
  const auto joined = [&](std::size_t row) {
    const double dt_s = step_after(data, row);
    if (!(dt_s > 0.0) || dt_s > longest ||
        data.configurations[row] != data.configurations[row + 1]) {
      return false;
    }
    for (std::size_t axis = 0; axis < states.size(); ++axis) {
      if (jump(data, states[axis], axis, row) > most[axis]) {
        return false;
      }
    }
    return true;
  };
  std::vector<Stretch> stretches;
  for (const std::size_t row : rows) {
    if (stretches.empty() || stretches.back().end != row || !joined(row - 1)) {
      stretches.push_back({row, row});
    }
    stretches.back().end = row + 1;
  }
  return stretches;
}

OpenLoopScore score_open_loop(const std::string& name, const OpenLoop& model,
                              const log::Dataset& data, std::span<const Stretch> stretches,
                              const OpenLoopStudy& study) {
  Horizons horizons(model, data, study);
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    for (const std::size_t start : starts_in(data.times_s, stretches[i], study.start_every_s)) {
      horizons.run(stretches[i], start);
    }
    if (study.keep_going &&
        !study.keep_going(static_cast<double>(i + 1) / static_cast<double>(stretches.size()))) {
      break;
    }
  }
  OpenLoopScore score{name, horizons.scores(), {}};
  const auto named = [&](std::size_t state, const char* wanted) {
    return data.input_names[model.states[state]] == wanted;
  };
  if (model.states.size() == 3 && named(0, "u") && named(1, "v") && named(2, "r")) {
    score.reckoning = reckon(model, data, stretches, study);
  }
  return score;
}

Trajectory roll_out(const OpenLoop& model, const log::Dataset& data, std::size_t begin,
                    std::size_t end, const RolloutSettings& settings) {
  const std::size_t states = model.states.size();
  Trajectory path{model.states, {}, {}, {}, {}, {}};
  path.measured.resize(states);
  path.velocity.resize(states);
  path.spread.resize(states);
  Rollout rollout(model, settings);
  rollout.start(data.input(begin));
  for (std::size_t row = begin; row <= end; ++row) {
    if (row > begin) {
      rollout.advance(data.input(row), step_after(data, row - 1));
    }
    path.time_s.push_back(data.times_s[row] - data.times_s[begin]);
    path.beyond.push_back(rollout.beyond());
    for (std::size_t state = 0; state < states; ++state) {
      path.measured[state].push_back(data.input(row)[model.states[state]]);
      path.velocity[state].push_back(rollout.velocity(state));
      path.spread[state].push_back(rollout.spread(state));
    }
  }
  return path;
}

OpenLoop hold_velocity(const OpenLoop& like) {
  OpenLoop still = like;
  still.accelerations = [](std::span<const double>, std::span<double> a) {
    std::ranges::fill(a, 0.0);
  };
  std::ranges::fill(still.error, 0.0);
  std::ranges::fill(still.noise, 0.0);
  still.off.clear();
  still.kept.clear();
  return still;
}

std::vector<OpenLoopContender> open_loop_contenders(const TrainedModel& model, const OpenLoop& loop,
                                                    const log::Dataset& data, const Split& split) {
  std::vector<OpenLoopContender> contenders{
      {"kelpie", loop},
      {"kelpie, learned model alone", open_loop(model, OpenLoopPart::learned)},
      {"kelpie, equations alone", open_loop(model, OpenLoopPart::steady)}};
  if (states_first(loop)) {
    contenders.push_back({"recursive least squares", least_squares(loop, data, split)});
  }
  contenders.push_back({std::string(kVelocityHeld), hold_velocity(loop)});
  return contenders;
}

void add_example(OpenLoopResult& result, const OpenLoop& loop, const log::Dataset& data,
                 std::span<const Stretch> stretches, const OpenLoopStudy& study) {
  double longest_s = study.horizons_s.front();
  for (const HorizonScore& horizon : result.scores.front().horizons) {
    longest_s = horizon.starts > 0 ? horizon.seconds : longest_s;
  }
  double most = 0.0;
  for (const Stretch& stretch : stretches) {
    for (const std::size_t begin :
         starts_in(data.times_s, stretch, kTuning.open_loop.example_every_s)) {
      const std::size_t end = row_after(data, stretch, begin, longest_s);
      const double lively = end < stretch.end ? liveliness(loop, data, begin, end) : 0.0;
      if (lively > most) {
        most = lively;
        result.example = roll_out(loop, data, begin, end, study.rollout);
        result.example_start_s = data.times_s[begin];
      }
    }
  }
}

}  // namespace kelpie::study
