// SPDX-License-Identifier: Apache-2.0
#include "lab/offline_svr.hpp"

#include <libsvm/svm.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace kelpie::lab {
namespace {

using S = OfflineSvrSettings;

AxisScaling scaling_of(const TrainingRows& data, const S& settings) {
  settings.validate();
  require(
      data.inputs >= 1 && data.inputs <= kMostInputs, "inputs",
      std::to_string(data.inputs) + " given; there have to be 1 to " + std::to_string(kMostInputs));
  require(data.rows.size() >= 2, "rows",
          std::to_string(data.rows.size()) + " given; there have to be 2 or more");
  Moments inputs(data.inputs);
  Moments targets(1);
  for (const std::size_t row : data.rows) {
    const double y = data.target_of(row);
    const std::span<const double> x = data.input(row);
    require(std::ranges::all_of(x, [](double v) { return std::isfinite(v); }) && std::isfinite(y),
            "rows", "row " + std::to_string(row) + " holds a value that is not finite");
    inputs.add(x);
    targets.add({&y, 1});
  }
  auto input = InputScaling::from(inputs, settings.scaling);
  if (const auto dependent = first_dependent(inputs, settings.scaling); dependent || !input) {
    throw InputError(
        "inputs", "number " + std::to_string(dependent.value_or(0) + 1) +
                      " is constant over the training rows, or a combination of those before it");
  }
  const double variance = targets.covariance()(0, 0);
  require(variance > 0.0, "targets", "the target is constant over the training rows");
  return {*std::move(input), {targets.mean()[0], std::sqrt(variance)}};
}

// Samples as LIBSVM wants them: lists of (index, value) that end with index −1.
class Problem {
 public:
  Problem(const SampleStore& samples, std::span<const double> targets)
      : targets_(targets.begin(), targets.end()) {
    const std::size_t stride = samples.dimension() + 1;
    nodes_.reserve(samples.size() * stride);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      for (std::size_t k = 0; k < samples.dimension(); ++k) {
        nodes_.push_back({static_cast<int>(k) + 1, samples.coordinate(k)[i]});
      }
      nodes_.push_back({-1, 0.0});
    }
    for (std::size_t i = 0; i < targets_.size(); ++i) {
      rows_.push_back(nodes_.data() + i * stride);
    }
  }

  svm_problem view() { return {static_cast<int>(rows_.size()), targets_.data(), rows_.data()}; }

 private:
  std::vector<svm_node> nodes_;
  std::vector<svm_node*> rows_;
  std::vector<double> targets_;
};

struct FreeModel {
  void operator()(svm_model* model) const { svm_free_and_destroy_model(&model); }
};

svm_parameter parameter_of(const S& settings) {
  svm_parameter parameter{};
  parameter.svm_type = EPSILON_SVR;
  parameter.kernel_type = RBF;
  parameter.gamma = settings.gamma;
  parameter.C = settings.c;
  parameter.p = settings.epsilon;
  parameter.eps = 2.0 * settings.tolerance;  // LIBSVM stops at upper − lower, twice our gap
  parameter.cache_size = settings.cache_mb;
  parameter.shrinking = 1;
  return parameter;
}

SvrFunction train(const TrainingRows& data, const AxisScaling& scaling, const S& settings) {
  SampleStore samples(data.inputs, data.rows.size());
  std::vector<double> targets;
  targets.reserve(data.rows.size());
  for (const std::size_t row : data.rows) {
    samples.push_back(as_span(scaling.input.apply(data.input(row))));
    targets.push_back(scaling.target.apply(data.target_of(row)));
  }
  return train_by_libsvm(samples, targets, settings);
}

}  // namespace

SvrFunction train_by_libsvm(const SampleStore& samples, std::span<const double> targets,
                            const OfflineSvrSettings& settings) {
  static const bool silenced = (svm_set_print_string_function([](const char*) {}), true);
  static_cast<void>(silenced);
  Problem problem(samples, targets);
  const svm_problem view = problem.view();
  const svm_parameter parameter = parameter_of(settings);
  const std::unique_ptr<svm_model, FreeModel> model(svm_train(&view, &parameter));

  std::vector<double> beta(samples.size(), 0.0);
  const auto count = static_cast<std::size_t>(model->l);
  const std::span<const int> numbers(model->sv_indices, count);
  const std::span<const double> weights(model->sv_coef[0], count);
  for (std::size_t i = 0; i < count; ++i) {
    beta[static_cast<std::size_t>(numbers[i]) - 1] = weights[i];  // LIBSVM counts from 1
  }
  SvrFunction function({SquaredExponential(settings.gamma), samples.dimension()}, count);
  function.assign(samples, beta, -model->rho[0]);
  return function;
}

void OfflineSvrSettings::validate() const {
  require_range("gamma", gamma, {.low = 0.0, .open = true});
  require_range("c", c, {.low = 0.0, .open = true});
  require_range("epsilon", epsilon, {.low = 0.0});
  require_range("tolerance", tolerance, {.low = 0.0, .high = 1.0, .open = true});
  require_range("cache_mb", cache_mb, {.low = 1.0});
}

OfflineSvr::OfflineSvr(const TrainingRows& data, const OfflineSvrSettings& settings)
    : scaling_(scaling_of(data, settings)), function_(train(data, scaling_, settings)) {}

double OfflineSvr::predict(std::span<const double> x) const {
  return scaling_.target.invert(function_(as_span(scaling_.input.apply(x))));
}

}  // namespace kelpie::lab
