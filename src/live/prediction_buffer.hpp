// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kelpie/model/shared_model.hpp"

namespace kelpie::live {

/// What a model says of samples that it doesn't learn, told as of those that it does.
class PredictionBuffer {
 public:
  explicit PredictionBuffer(std::size_t axes) : predictions_(axes), decisions_(axes) {}

  /// One decision per axis, of which the prediction and all around it is filled in; until the next
  /// call. Asks the model and doesn't change it. Allocates nothing.
  std::span<const Decision> by(const SharedModel& model, std::span<const double> x);

 private:
  std::vector<Prediction> predictions_;
  std::vector<Decision> decisions_;
};

}  // namespace kelpie::live
