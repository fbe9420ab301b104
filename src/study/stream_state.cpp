// SPDX-License-Identifier: Apache-2.0
#include "study/stream_state.hpp"

#include <limits>
#include <vector>

namespace kelpie::study {
namespace {

// What an item takes at least: so many of them a damaged file can't ask for.
constexpr std::size_t kPointBytes = 20 * sizeof(double);
constexpr std::size_t kStageBytes = 6 * sizeof(double);
constexpr std::size_t kChangeBytes = 4 * sizeof(double);
constexpr std::size_t kOutliersBytes = 3 * sizeof(double);

void visit_configuration(Archive& archive, int& configuration) {
  archive.whole(configuration, std::numeric_limits<int>::min(), std::numeric_limits<int>::max());
}

void visit_numbers(Archive& archive, std::vector<double>& values) {
  archive.list(values, Archive::kAnyLength, [&](double& value) { archive.any_number(value); });
}

void visit_point(Archive& archive, ValidationPoint& point, std::size_t terms) {
  archive.whole(point.samples);
  archive.number(point.time_s);
  archive.any_number(point.r2);
  visit_configuration(archive, point.configuration);
  archive.part("status", point.status);
  visit_numbers(archive, point.coefficients);
  visit_numbers(archive, point.errors);
  archive.require((point.coefficients.empty() || point.coefficients.size() == terms) &&
                      point.errors.size() == point.coefficients.size(),
                  "has coefficients of other terms");
}

void visit_stage(Archive& archive, StageEnd& stage) {
  visit_configuration(archive, stage.configuration);
  archive.whole(stage.samples);
  archive.any_number(stage.r2);
  visit_numbers(archive, stage.time_s);
  visit_numbers(archive, stage.truth);
  visit_numbers(archive, stage.predicted);
  archive.require(
      stage.truth.size() == stage.time_s.size() && stage.predicted.size() == stage.time_s.size(),
      "has a stage of uneven columns");
}

void visit_change(Archive& archive, ChangeFound& change) {
  archive.whole(change.samples);
  archive.number(change.time_s);
  archive.number(change.since_s);
  archive.whole(change.recalled);
  archive.whole(change.withdrawn);
}

void visit_outliers(Archive& archive, OutliersFound& found) {
  archive.whole(found.samples);
  archive.number(found.time_s);
  archive.any_number(found.target);
}

void visit_one_step(Archive& archive, OneStep& steps, std::size_t shown) {
  const auto fits = [&](std::size_t size) {
    archive.require(size <= shown && size == steps.time_s.size(), "has uneven predictions");
  };
  for (std::vector<double>* values :
       {&steps.time_s, &steps.truth, &steps.predicted, &steps.lower, &steps.upper}) {
    visit_numbers(archive, *values);
    fits(values->size());
  }
  archive.list(steps.configuration, shown,
               [&](int& configuration) { visit_configuration(archive, configuration); });
  fits(steps.configuration.size());
  archive.list(steps.samples, shown, [&](std::size_t& samples) { archive.whole(samples); });
  fits(steps.samples.size());
}

}  // namespace

void visit_so_far(Archive& archive, AxisResult& result, std::size_t shown, std::size_t terms) {
  archive.list(
      result.validation, shown, [&](ValidationPoint& point) { visit_point(archive, point, terms); },
      kPointBytes);
  archive.list(
      result.stages, shown, [&](StageEnd& stage) { visit_stage(archive, stage); }, kStageBytes);
  archive.list(
      result.changes, shown, [&](ChangeFound& change) { visit_change(archive, change); },
      kChangeBytes);
  archive.list(
      result.outliers, shown, [&](OutliersFound& found) { visit_outliers(archive, found); },
      kOutliersBytes);
  visit_one_step(archive, result.one_step, shown);
  visit_one_step(archive, result.corrected, shown);
  visit_numbers(archive, result.update_us);
  archive.require(result.update_us.size() == shown, "has times of more or fewer updates");
}

}  // namespace kelpie::study
