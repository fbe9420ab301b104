// SPDX-License-Identifier: Apache-2.0
#include "kelpie/study/stream.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "kelpie/study/metrics.hpp"
#include "term_info.hpp"

namespace kelpie {
namespace {

constexpr std::size_t kLooks = 200;
constexpr std::size_t kSettled = 1000;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

double microseconds(std::chrono::steady_clock::duration time) {
  return std::chrono::duration<double, std::micro>(time).count();
}

// One learner on its way through the stream.
class AxisRun {
 public:
  AxisRun(const Dataset& data, const Split& split, std::size_t axis, OnlineRegressor& learner)
      : data_(data), axis_(axis), learner_(learner) {
    result_.name = data.target_names[axis];
    result_.unit = unit_text(data, result_.name);
    result_.update_us.reserve(split.training.size());
    for (const std::size_t row : split.held_out) {
      held_out_[data.configurations[row]].push_back(row);
      result_.held_out_time_s.push_back(data.times_s[row]);
      result_.held_out_true.push_back(target(row));
    }
  }

  void show(std::size_t row) {
    const auto start = std::chrono::steady_clock::now();
    const Decision decision = learner_.update(data_.input(row), target(row), data_.times_s[row]);
    result_.update_us.push_back(microseconds(std::chrono::steady_clock::now() - start));
    if (decision.changed) {
      result_.changes.push_back(
          {result_.update_us.size(), data_.times_s[row], decision.changed_since});
    }
    if (decision.had_model) {
      one_step_true_.push_back(target(row));
      one_step_predicted_.push_back(decision.predicted);
    }
  }

  void look(std::size_t samples, std::size_t row) {
    const int configuration = data_.configurations[row];
    const std::vector<std::size_t>& rows = held_out_[configuration];
    result_.validation.push_back({samples, data_.times_s[row],
                                  r_squared(targets(rows), predict(rows)), configuration,
                                  learner_.status(), coefficient_values()});
  }

  void end_stage(std::size_t samples, int configuration) {
    const std::vector<std::size_t>& rows = held_out_[configuration];
    StageEnd stage{configuration, samples, 0.0, {}, targets(rows), predict(rows)};
    for (const std::size_t row : rows) {
      stage.time_s.push_back(data_.times_s[row]);
    }
    stage.r2 = r_squared(stage.truth, stage.predicted);
    result_.stages.push_back(std::move(stage));
  }

  AxisResult finish(const Split& split) {
    result_.status = learner_.status();
    if (const std::vector<Coefficient> last = coefficients(); !last.empty()) {
      const std::span<const std::size_t> rows(split.training);
      result_.terms =
          describe_terms(last, data_, result_.name, rows.first(result_.update_us.size()));
    }
    result_.held_out_predicted = predict(split.held_out);
    result_.prequential_r2 = r_squared(one_step_true_, one_step_predicted_);
    summarise();
    return std::move(result_);
  }

 private:
  // A model that isn't in service yet has weights of 0, which say nothing of the vehicle.
  std::vector<Coefficient> coefficients() const {
    return learner_.status().ready ? learner_.coefficients() : std::vector<Coefficient>{};
  }

  std::vector<double> coefficient_values() const {
    std::vector<double> values;
    for (const Coefficient& coefficient : coefficients()) {
      values.push_back(coefficient.value);
    }
    return values;
  }

  double target(std::size_t row) const { return data_.target(row)[axis_]; }

  std::vector<double> targets(const std::vector<std::size_t>& rows) const {
    std::vector<double> values;
    values.reserve(rows.size());
    for (const std::size_t row : rows) {
      values.push_back(target(row));
    }
    return values;
  }

  std::vector<double> predict(const std::vector<std::size_t>& rows) const {
    std::vector<double> predicted;
    predicted.reserve(rows.size());
    for (const std::size_t row : rows) {
      predicted.push_back(learner_.predict(data_.input(row)));
    }
    return predicted;
  }

  void summarise() {
    result_.r2_final = result_.validation.empty() ? kNan : result_.validation.back().r2;
    result_.r2_min_after_1000 = kNan;
    double sum = 0.0;
    std::size_t count = 0;
    for (const ValidationPoint& point : result_.validation) {
      if (point.status.ready) {
        sum += point.r2;
        ++count;
      }
      if (point.samples >= kSettled) {
        // fmin passes over the NaN of the start.
        result_.r2_min_after_1000 = std::fmin(result_.r2_min_after_1000, point.r2);
      }
    }
    result_.r2_mean = count > 0 ? sum / static_cast<double>(count) : kNan;
  }

  const Dataset& data_;
  std::size_t axis_;
  OnlineRegressor& learner_;
  AxisResult result_;
  std::map<int, std::vector<std::size_t>> held_out_;  // rows by configuration
  std::vector<double> one_step_true_;
  std::vector<double> one_step_predicted_;
};

}  // namespace

StreamResult run_stream(const Dataset& data, const Split& split,
                        std::span<OnlineRegressor* const> learners, const StreamOptions& options) {
  StreamResult result;
  result.source = data.source;
  result.rate_hz = data.rate_hz;
  result.rows_read = data.rows_read;
  result.rows_skipped = data.rows_skipped;
  result.input_names = data.input_names;
  result.split = split.label;
  result.training_rows = split.training.size();
  result.held_out_rows = split.held_out.size();

  std::vector<AxisRun> runs;
  runs.reserve(learners.size());
  for (std::size_t axis = 0; axis < learners.size(); ++axis) {
    runs.emplace_back(data, split, axis, *learners[axis]);
  }
  const std::size_t every = options.validate_every > 0
                                ? options.validate_every
                                : std::max<std::size_t>(1, split.training.size() / kLooks);
  for (const std::size_t row : split.training) {
    for (AxisRun& run : runs) {
      run.show(row);
    }
    ++result.samples_shown;
    const bool last = result.samples_shown == result.training_rows;
    result.interrupted = !options.keep_going(result.samples_shown) && !last;
    const bool asked_for =
        std::ranges::binary_search(options.also_at, result.samples_shown) || result.interrupted;
    const bool stage_ends =
        last || result.interrupted ||
        data.configurations[split.training[result.samples_shown]] != data.configurations[row];
    for (AxisRun& run : runs) {
      if (result.samples_shown % every == 0 || last || asked_for) {
        run.look(result.samples_shown, row);
      }
      if (stage_ends) {
        run.end_stage(result.samples_shown, data.configurations[row]);
      }
    }
    if (result.interrupted) {
      break;
    }
  }
  for (AxisRun& run : runs) {
    result.axes.push_back(run.finish(split));
  }
  return result;
}

}  // namespace kelpie
