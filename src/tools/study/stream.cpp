// SPDX-License-Identifier: Apache-2.0
#include "study/stream.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "kelpie/core/archive.hpp"
#include "kelpie/core/error.hpp"
#include "study/metrics.hpp"
#include "study/result_fields.hpp"
#include "study/terms.hpp"
#include "study/tuning.hpp"

namespace kelpie::study {
namespace {

// How a field stands in the state, and how many bytes it takes at least: a damaged file can't ask
// for more items than its bytes can hold.
struct SavedField {
  Archive& archive;
  bool finite;

  static constexpr std::size_t kNumber = 8;

  void visit(double& value) const { finite ? archive.number(value) : archive.any_number(value); }
  void visit(int& value) const {
    archive.whole(value, std::numeric_limits<int>::min(), std::numeric_limits<int>::max());
  }
  void visit(std::size_t& value) const { archive.whole(value); }
  void visit(std::int64_t& value) const { archive.whole(value); }
  void visit(Status& value) const { archive.part("status", value); }
  template <typename Number>
  void visit(std::vector<Number>& values) const {
    archive.list(values, Archive::kAnyLength, [this](Number& value) { visit(value); });
  }
};

template <typename Item>
void visit_fields(Archive& archive, Item& item) {
  for_each_field<Item>([&](const auto& field) {
    if constexpr (std::is_member_object_pointer_v<decltype(field.saved)>) {
      SavedField{archive, field.finite}.visit(item.*field.saved);
    }
  });
}

template <typename Item>
constexpr std::size_t least_bytes() {
  std::size_t bytes = 0;
  for_each_field<Item>([&](const auto& field) {
    if constexpr (std::is_member_object_pointer_v<decltype(field.saved)>) {
      const bool is_status = std::is_same_v<decltype(field.saved), Status ValidationPoint::*>;
      bytes += is_status ? sizeof(Tally) : SavedField::kNumber;
    }
  });
  return bytes;
}

// What one list holds has to fit the rest of the state.
void check(const Archive& archive, const ValidationPoint& point, std::size_t terms) {
  archive.require((point.coefficients.empty() || point.coefficients.size() == terms) &&
                      point.errors.size() == point.coefficients.size(),
                  "has coefficients of other terms");
}

void check(const Archive& archive, const StageEnd& stage, std::size_t /*terms*/) {
  archive.require(
      stage.truth.size() == stage.time_s.size() && stage.predicted.size() == stage.time_s.size(),
      "has a stage of uneven columns");
}

void check(const Archive& /*archive*/, const ChangeFound& /*change*/, std::size_t /*terms*/) {}
void check(const Archive& /*archive*/, const OutliersFound& /*found*/, std::size_t /*terms*/) {}

template <typename Item>
void visit_items(Archive& archive, std::vector<Item>& items, std::size_t most, std::size_t terms) {
  archive.list(
      items, most,
      [&](Item& item) {
        visit_fields(archive, item);
        check(archive, item, terms);
      },
      least_bytes<Item>());
}

void visit_one_step(Archive& archive, OneStep& steps, std::size_t shown) {
  const auto fits = [&](std::size_t size) {
    archive.require(size <= shown && size == steps.time_s.size(), "has uneven predictions");
  };
  const SavedField any{archive, false};
  for (std::vector<double>* values :
       {&steps.time_s, &steps.truth, &steps.predicted, &steps.lower, &steps.upper}) {
    any.visit(*values);
    fits(values->size());
  }
  archive.list(steps.configuration, shown, [&](int& configuration) { any.visit(configuration); });
  fits(steps.configuration.size());
  archive.list(steps.samples, shown, [&](std::size_t& samples) { any.visit(samples); });
  fits(steps.samples.size());
}

// Saves or loads the results of one axis so far. Lists may not contradict each other, the shown
// samples, or the number of terms.
void visit_so_far(Archive& archive, AxisResult& result, std::size_t shown, std::size_t terms) {
  visit_items(archive, result.validation, shown, terms);
  visit_items(archive, result.stages, shown, terms);
  visit_items(archive, result.changes, shown, terms);
  visit_items(archive, result.outliers, shown, terms);
  visit_one_step(archive, result.one_step, shown);
  visit_one_step(archive, result.corrected, shown);
  SavedField{archive, false}.visit(result.update_us);
  archive.require(result.update_us.size() == shown, "has times of more or fewer updates");
}

using Clock = std::chrono::steady_clock;

double microseconds(Clock::duration time) {
  return std::chrono::duration<double, std::micro>(time).count();
}

// One axis on its way through the stream.
class AxisRun {
 public:
  AxisRun(const log::Dataset& data, const Split& split, std::size_t axis,
          const OnlineRegressor& learner)
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

  void took(Clock::duration time) { result_.update_us.push_back(microseconds(time)); }

  // Requires took() before.
  void learned(std::size_t row, const Decision& decision) {
    if (decision.changed) {
      result_.changes.push_back({result_.update_us.size(), data_.times_s[row],
                                 decision.changed_since, decision.recalled});
    }
    if (decision.withdrawn && !result_.changes.empty()) {
      result_.changes.back().withdrawn = result_.update_us.size();
    }
    if (decision.outliers > 0 || decision.verdict == Verdict::implausible) {
      result_.outliers.push_back({result_.update_us.size(), data_.times_s[row], target(row)});
    }
    if (decision.had_model) {
      const Prediction& said = decision.prediction;
      keep(result_.one_step, row, said);
      keep(result_.corrected, row,
           {said.value + said.disturbance, said.corrected_lower, said.corrected_upper});
    }
  }

  void look(std::size_t samples, std::size_t row) {
    const int configuration = data_.configurations[row];
    const std::vector<std::size_t>& rows = held_out_[configuration];
    const double r2 = r_squared(targets(rows), predict(rows));
    ValidationPoint& look = result_.validation.emplace_back(
        ValidationPoint{samples, data_.times_s[row], r2, configuration, learner_.status(), {}, {}});
    for (const Coefficient& coefficient : coefficients()) {
      look.coefficients.push_back(coefficient.value);
      look.errors.push_back(coefficient.error);
    }
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

  void visit(Archive& archive, std::size_t shown) {
    visit_so_far(archive, result_, shown, learner_.coefficients().size());
  }

  AxisResult finish(const Split& split) {
    result_.status = learner_.status();
    result_.members = learner_.members();
    if (const std::vector<Coefficient> last = coefficients(); !last.empty()) {
      const std::span<const std::size_t> rows(split.training);
      result_.terms =
          describe_terms(last, data_, result_.name, rows.first(result_.update_us.size()));
    }
    result_.held_out_predicted = predict(split.held_out);
    result_.novelty = novelty();
    result_.prequential_r2 = r_squared(result_.one_step.truth, result_.one_step.predicted);
    result_.coverage = coverage_of(result_.one_step);
    result_.corrected_r2 = r_squared(result_.corrected.truth, result_.corrected.predicted);
    result_.corrected_coverage = coverage_of(result_.corrected);
    summarise();
    return std::move(result_);
  }

 private:
  void keep(OneStep& steps, std::size_t row, const Prediction& said) const {
    steps.time_s.push_back(data_.times_s[row]);
    steps.configuration.push_back(data_.configurations[row]);
    steps.samples.push_back(result_.update_us.size());
    steps.truth.push_back(target(row));
    steps.predicted.push_back(said.value);
    steps.lower.push_back(said.lower);
    steps.upper.push_back(said.upper);
  }

  std::vector<NoveltyBin> novelty() const {
    if (result_.stages.empty()) {
      return {};
    }
    const std::vector<std::size_t>& rows = held_out_.at(result_.stages.back().configuration);
    std::vector<Prediction> predicted;
    predicted.reserve(rows.size());
    for (const std::size_t row : rows) {
      predicted.push_back(learner_.assess(data_.input(row)));
    }
    return errors_by_novelty(targets(rows), predicted);
  }

  // A model that isn't in service yet has weights of 0, which say nothing of the vehicle.
  std::vector<Coefficient> coefficients() const {
    return learner_.status().ready ? learner_.coefficients() : std::vector<Coefficient>{};
  }

  double target(std::size_t row) const { return data_.target(row)[axis_]; }

  std::vector<double> targets(std::span<const std::size_t> rows) const {
    std::vector<double> values(rows.size());
    std::ranges::transform(rows, values.begin(), [&](std::size_t row) { return target(row); });
    return values;
  }

  std::vector<double> predict(std::span<const std::size_t> rows) const {
    std::vector<double> values(rows.size());
    std::ranges::transform(rows, values.begin(),
                           [&](std::size_t row) { return learner_.predict(data_.input(row)); });
    return values;
  }

  void summarise() {
    result_.r2_final = result_.validation.empty() ? kUnknown : result_.validation.back().r2;
    result_.r2_min_after_1000 = kUnknown;
    double sum = 0.0;
    std::size_t count = 0;
    for (const ValidationPoint& point : result_.validation) {
      if (point.status.ready) {
        sum += point.r2;
        ++count;
      }
      if (point.samples >= kTuning.stream.settled) {
        // fmin passes over the NaN of the start.
        result_.r2_min_after_1000 = std::fmin(result_.r2_min_after_1000, point.r2);
      }
    }
    result_.r2_mean = count > 0 ? sum / static_cast<double>(count) : kUnknown;
  }

  const log::Dataset& data_;
  std::size_t axis_;
  const OnlineRegressor& learner_;
  AxisResult result_;
  std::map<int, std::vector<std::size_t>> held_out_;  // rows by configuration
};

// A model on its way through the stream.
class StreamRun {
 public:
  StreamRun(const log::Dataset& data, const Split& split, OnlineModel& model,
            const StreamOptions& options)
      : data_(data),
        split_(split),
        model_(model),
        options_(options),
        every_(options.validate_every > 0
                   ? options.validate_every
                   : std::max<std::size_t>(1, split.training.size() / kTuning.stream.looks)) {
    axes_.reserve(model.axes());
    for (std::size_t axis = 0; axis < model.axes(); ++axis) {
      axes_.emplace_back(data, split, axis, model.axis(axis));
    }
    if (!options.resume.empty()) {
      in_file(options.resume_file, [&] {
        Archive archive(options.resume);
        visit(archive);
        archive.finish();
      });
    }
  }

  // Fills in what the result says of the stream.
  void run(StreamResult& result) {
    while (shown_ < split_.training.size() && !result.interrupted) {
      const std::size_t row = split_.training[shown_];
      show(row);
      const bool looked =
          shown_ % every_ == 0 || last() || std::ranges::binary_search(options_.also_at, shown_);
      judge(row, looked, last() || next_configuration() != data_.configurations[row]);
      result.interrupted = !options_.keep_going(shown_) && !last();
      if (options_.save_every > 0 &&
          (shown_ % options_.save_every == 0 || last() || result.interrupted)) {
        save();
      }
      // After saving: a stream that is resumed has not been judged here.
      if (result.interrupted) {
        judge(row, !looked, next_configuration() == data_.configurations[row]);
      }
    }
    result.samples_shown = shown_;
    for (AxisRun& axis : axes_) {
      result.axes.push_back(axis.finish(split_));
    }
  }

 private:
  void show(std::size_t row) {
    auto start = Clock::now();
    model_.update(data_.input(row), data_.target(row), data_.times_s[row], [&](std::size_t axis) {
      axes_[axis].took(Clock::now() - start);
      start = Clock::now();
    });
    for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
      axes_[axis].learned(row, model_.decisions()[axis]);
    }
    ++shown_;
    if (last()) {
      model_.learn_held_back();
    }
  }

  bool last() const { return shown_ == split_.training.size(); }
  // Requires !last().
  int next_configuration() const { return data_.configurations[split_.training[shown_]]; }

  void judge(std::size_t row, bool look, bool stage_ends) {
    for (AxisRun& axis : axes_) {
      if (look) {
        axis.look(shown_, row);
      }
      if (stage_ends) {
        axis.end_stage(shown_, data_.configurations[row]);
      }
    }
  }

  void save() {
    Archive archive;
    visit(archive);
    options_.save(shown_, archive.bytes());
  }

  void visit(Archive& archive) {
    archive.same("stream version", kStreamVersion);
    archive.whole(shown_, 0, split_.training.size());
    for (AxisRun& axis : axes_) {
      archive.part("run", axis, shown_);
    }
  }

  const log::Dataset& data_;
  const Split& split_;
  OnlineModel& model_;
  const StreamOptions& options_;
  std::size_t every_;
  std::vector<AxisRun> axes_;
  std::size_t shown_ = 0;
};

}  // namespace

StreamResult run_stream(const log::Dataset& data, const Split& split, OnlineModel& model,
                        const StreamOptions& options) {
  StreamResult result;
  result.source = data.source;
  result.rate_hz = data.rate_hz;
  result.rows_read = data.rows_read;
  result.rows_skipped = data.rows_skipped;
  result.input_names = data.input_names;
  result.split = split.label;
  result.training_rows = split.training.size();
  result.held_out_rows = split.held_out.size();

  StreamRun(data, split, model, options).run(result);
  return result;
}

}  // namespace kelpie::study
