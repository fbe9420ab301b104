// SPDX-License-Identifier: Apache-2.0
#include "learner/model_trial.hpp"

#include <algorithm>
#include <cmath>

#include "learner/error_alarm.hpp"
#include "learner/tuning.hpp"

namespace kelpie {

ModelTrial::ModelTrial(std::size_t dimension, std::size_t models)
    : scores_(models), last_(dimension, 1) {}

std::size_t ModelTrial::bytes(std::size_t dimension, std::size_t models) {
  return models * sizeof(Score) + SampleStore::bytes(dimension, 1);
}

void ModelTrial::add(std::span<const double> z, double y, double error,
                     std::span<const PastModel> models) {
  if (models.empty() || same_place(z, models.front().function.kernel())) {
    return;
  }
  ++samples_;
  for (std::size_t k = 0; k < models.size(); ++k) {
    const double unit = models[k].info.usual_error;
    const double own = std::abs(y - models[k].function.without_short_range(z)) / unit;
    scores_[k].lead += std::min(error / unit, kOnline.alarm.clip) -
                       std::min(own, kOnline.alarm.clip) - kOnline.trial.margin;
    scores_[k].error += std::min(own, kOnline.alarm.clip);
  }
}

bool ModelTrial::same_place(std::span<const double> z, const MixedKernel& kernel) {
  double similarity = 0.0;
  if (last_.size() > 0) {
    kernel.similarity(z, last_, {&similarity, 1});
  }
  if (similarity < kOnline.memory.same_place) {
    last_.clear();
    last_.push_back(z);
  }
  return similarity >= kOnline.memory.same_place;
}

std::optional<std::size_t> ModelTrial::fitting(std::optional<std::size_t> but) const {
  std::optional<std::size_t> best;
  for (std::size_t k = 0; k < scores_.size(); ++k) {
    const bool fits =
        scores_[k].lead > kOnline.trial.lead && scores_[k].error <= kOnline.trial.fits * samples_;
    if (fits && but != k && (!best || scores_[k].lead > scores_[*best].lead)) {
      best = k;
    }
  }
  return best;
}

void ModelTrial::clear() {
  std::ranges::fill(scores_, Score{});
  last_.clear();
  samples_ = 0;
}

void ModelTrial::visit(Archive& archive, std::size_t models) {
  for (Score& score : std::span(scores_).first(models)) {
    archive.number(score.lead);
    archive.number(score.error);
  }
  archive.part("last", last_);
  archive.whole(samples_);
}

}  // namespace kelpie
