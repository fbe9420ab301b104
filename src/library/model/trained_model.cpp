// SPDX-License-Identifier: Apache-2.0
#include "kelpie/model/trained_model.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "model/answer.hpp"
#include "model/snapshot.hpp"

namespace kelpie {

TrainedModel::TrainedModel() = default;
TrainedModel::TrainedModel(std::vector<std::string> inputs, ModelSettings model_settings,
                           TermSet model_terms, std::vector<Snapshot> snapshots)
    : input_names(std::move(inputs)),
      settings(std::move(model_settings)),
      terms(std::move(model_terms)),
      axes(std::move(snapshots)) {}
TrainedModel::TrainedModel(const TrainedModel& other) = default;
TrainedModel::TrainedModel(TrainedModel&& other) noexcept = default;
TrainedModel& TrainedModel::operator=(const TrainedModel& other) = default;
TrainedModel& TrainedModel::operator=(TrainedModel&& other) noexcept = default;
TrainedModel::~TrainedModel() = default;

std::vector<std::string> TrainedModel::target_names() const {
  std::vector<std::string> names;
  std::ranges::transform(axes, std::back_inserter(names), &Snapshot::name);
  return names;
}

void TrainedModel::predict(std::span<const double> x, std::span<double> y) const {
  answer(x, input_names.size(), y, axes.size(),
         [&](std::size_t i) { return axes[i].predict(terms, x); });
}

void TrainedModel::predict(std::span<const double> x, std::span<Prediction> y) const {
  answer(x, input_names.size(), y, axes.size(),
         [&](std::size_t i) { return axes[i].assess(terms, x); });
}

void TrainedModel::predict_with_jacobian(std::span<const double> x, std::span<double> y,
                                         std::span<double> jacobian) const {
  answer(x, input_names.size(), y, axes.size(), jacobian,
         [&](std::size_t i, std::span<double> gradient) {
           return axes[i].predict_with_gradient(terms, x, gradient);
         });
}

}  // namespace kelpie
