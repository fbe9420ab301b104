// SPDX-License-Identifier: Apache-2.0
#include "fleet/summary.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "core/quantile.hpp"
#include "core/seconds.hpp"
#include "fleet/tuning.hpp"

namespace kelpie::fleet {
namespace {

// What a vehicle's runs leave until all of them are there.
struct AxisRuns {
  struct OfLearner {
    std::array<std::vector<double>, kMeasures> values;
    std::vector<double> shortfall;
    LearnerSummary counts;  // those that are counted run by run
  };
  std::string name;
  std::string unit;
  std::vector<OfLearner> learners;
  std::vector<double> least_squares{};
  std::vector<double> mean{};
  std::vector<double> least_squares_one_step{};
  std::vector<double> last_value_one_step{};
  Trend trend{};
};

// Of a learner, run by run.
struct TimesTaken {
  std::vector<double> update_us;
  std::vector<double> p99_us;
  std::vector<double> share;
  std::vector<double> memory_bytes;

  void take(const Outcome& outcome) {
    update_us.push_back(outcome.times.update_us);
    p99_us.push_back(outcome.times.p99_us);
    share.push_back(outcome.times.share);
    memory_bytes.push_back(static_cast<double>(outcome.memory_bytes));
  }

  LearnerTimes spreads() const {
    return {spread_of(update_us), spread_of(p99_us), spread_of(share), spread_of(memory_bytes)};
  }
};

struct VehicleRuns {
  VehicleSummary summary;
  std::vector<AxisRuns> axes;
  std::vector<TimesTaken> learners;
};

// Of a learner over all vehicles.
struct AllRuns {
  LearnerOverall counts;
  std::vector<double> shortfall;
  TimesTaken times;
};

// The outcomes of one run, learner by learner.
using Run = std::vector<std::optional<Outcome>>;

const AxisOutcome* find_axis(const std::optional<Outcome>& outcome, const std::string& name) {
  if (!outcome) {
    return nullptr;
  }
  const auto found = std::ranges::find(outcome->axes, name, &AxisOutcome::name);
  return found == outcome->axes.end() ? nullptr : &*found;
}

// Who never had a model in service is worse than anybody who had.
void count(Duel& duel, double own, double other) {
  duel.better += own > other + kTuning.clear_difference ? 1 : 0;
  duel.worse +=
      own < other - kTuning.clear_difference || (std::isnan(own) && std::isfinite(other)) ? 1 : 0;
}

class Summariser {
 public:
  explicit Summariser(const Results& results)
      : results_(results), all_(results.plan().learners.size()) {}

  StudySummary take() {
    const std::size_t splits = results_.plan().splits.size();
    for (std::size_t mission = 0; mission < results_.missions().size(); ++mission) {
      const std::string& name = results_.missions()[mission].vehicle;
      if (!vehicle_ || vehicle_->summary.name != name) {
        finish();
        begin(name);
      }
      ++vehicle_->summary.missions;
      for (std::size_t split = 0; split < splits; ++split) {
        take_run((mission * splits + split) * learners(), mission, split == 0);
      }
    }
    finish();
    keep_worst();
    for (AllRuns& learner : all_) {
      learner.counts.shortfall = spread_of(learner.shortfall);
      learner.counts.times = learner.times.spreads();
      study_.learners.push_back(learner.counts);
    }
    return std::move(study_);
  }

 private:
  std::size_t learners() const { return results_.plan().learners.size(); }

  void begin(const std::string& name) {
    vehicle_.emplace();
    vehicle_->summary.name = name;
    vehicle_->learners.resize(learners());
  }

  // `first`: the combination of the run's first learner.
  void take_run(std::size_t first, std::size_t mission, bool is_first_split) {
    Run run;
    for (std::size_t learner = 0; learner < learners(); ++learner) {
      run.push_back(results_.outcome(first + learner));
      if (!run.back()) {
        ++vehicle_->summary.failed;
        continue;
      }
      study_.seconds += run.back()->times.seconds;
      vehicle_->learners[learner].take(*run.back());
      all_[learner].times.take(*run.back());
      for (const AxisOutcome& axis : run.back()->axes) {
        enter_axis(axis);
      }
    }
    for (AxisRuns& axis : vehicle_->axes) {
      take_axis(axis, run, first);
      const AxisOutcome* const own = find_axis(run.front(), axis.name);
      if (is_first_split && own != nullptr && std::isfinite((*own)[Measure::r2_final])) {
        axis.trend.missions.push_back(mission);
        axis.trend.r2.push_back((*own)[Measure::r2_final]);
      }
    }
    if (is_first_split && run.front()) {
      vehicle_->summary.hours += run.front()->duration_s / kSecondsPerHour;
      if (!run.front()->findings.empty()) {
        vehicle_->summary.findings.push_back({mission, run.front()->findings, run.front()->left});
      }
    }
  }

  void enter_axis(const AxisOutcome& axis) {
    if (std::ranges::count(vehicle_->axes, axis.name, &AxisRuns::name) == 0) {
      vehicle_->axes.push_back({.name = axis.name,
                                .unit = axis.unit,
                                .learners = std::vector<AxisRuns::OfLearner>(learners())});
    }
  }

  void take_axis(AxisRuns& axis, const Run& run, std::size_t first) {
    double best = -HUGE_VAL;
    const AxisOutcome* any = nullptr;
    for (const std::optional<Outcome>& outcome : run) {
      if (const AxisOutcome* const own = find_axis(outcome, axis.name); own != nullptr) {
        any = own;
        best = std::fmax(best, (*own)[Measure::r2_final]);
      }
    }
    if (any == nullptr) {
      return;
    }
    // Held-out rows are the same for all learners.
    const double least_squares = (*any)[Measure::least_squares_final];
    const double mean = (*any)[Measure::mean_final];
    best = std::fmax(best, std::fmax(least_squares, mean));
    axis.least_squares.push_back(least_squares);
    axis.mean.push_back(mean);
    for (std::size_t i = 0; i < run.size(); ++i) {
      const AxisOutcome* const own = find_axis(run[i], axis.name);
      if (own == nullptr) {
        continue;
      }
      const double r2 = (*own)[Measure::r2_final];
      AxisRuns::OfLearner& learner = axis.learners[i];
      for (std::size_t measure = 0; measure < kMeasures; ++measure) {
        learner.values[measure].push_back(own->values[measure]);
      }
      learner.shortfall.push_back(best - r2);
      all_[i].shortfall.push_back(best - r2);
      ++all_[i].counts.judged;
      const auto judge_run = [&](auto& counts) {
        count(counts.least_squares, r2, least_squares);
        count(counts.mean, r2, mean);
        counts.best += r2 >= best - kTuning.clear_difference ? 1 : 0;
      };
      judge_run(learner.counts);
      judge_run(all_[i].counts);
      if (i == 0) {
        axis.least_squares_one_step.push_back((*own)[Measure::least_squares_one_step]);
        axis.last_value_one_step.push_back((*own)[Measure::last_value_one_step]);
        study_.worst.push_back({first, axis.name, r2, least_squares, mean});
      }
    }
    if (study_.worst.size() > 4 * kTuning.worst_runs) {
      keep_worst();
    }
  }

  void keep_worst() {
    std::ranges::stable_sort(study_.worst, {}, [](const RunScore& run) {
      return std::isfinite(run.r2) ? run.r2 : -HUGE_VAL;
    });
    study_.worst.resize(std::min(study_.worst.size(), kTuning.worst_runs));
  }

  void finish() {
    if (!vehicle_) {
      return;
    }
    VehicleSummary& summary = vehicle_->summary;
    for (AxisRuns& axis : vehicle_->axes) {
      summary.axes.push_back(finished(axis));
      study_.trends += std::isfinite(summary.axes.back().trend.chance) ? 1 : 0;
    }
    for (const TimesTaken& learner : vehicle_->learners) {
      summary.learners.push_back(learner.spreads());
    }
    study_.vehicles.push_back(std::move(summary));
    vehicle_.reset();
  }

  static AxisSummary finished(AxisRuns& axis) {
    judge(axis.trend);
    AxisSummary summary{.name = axis.name,
                        .unit = axis.unit,
                        .learners = {},
                        .least_squares = spread_of(axis.least_squares),
                        .mean = spread_of(axis.mean),
                        .least_squares_one_step = spread_of(axis.least_squares_one_step),
                        .last_value_one_step = spread_of(axis.last_value_one_step),
                        .trend = std::move(axis.trend)};
    for (AxisRuns::OfLearner& learner : axis.learners) {
      const auto spread = [&](Measure measure) {
        return spread_of(learner.values[static_cast<std::size_t>(measure)]);
      };
      LearnerSummary one = learner.counts;
      one.r2_final = spread(Measure::r2_final);
      one.r2_mean = spread(Measure::r2_mean);
      one.one_step = spread(Measure::one_step);
      one.coverage = spread(Measure::coverage);
      one.shortfall = spread_of(learner.shortfall);
      summary.learners.push_back(one);
    }
    return summary;
  }

  const Results& results_;
  std::vector<AllRuns> all_;
  StudySummary study_;
  std::optional<VehicleRuns> vehicle_;
};

}  // namespace

Spread spread_of(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (values.empty()) {
    return {};
  }
  return {values.size(), std::ranges::min(values), quantile(values, 0.1), quantile(values, 0.5),
          quantile(values, 0.9)};
}

StudySummary summarise(const Results& results) {
  return Summariser(results).take();
}

}  // namespace kelpie::fleet
