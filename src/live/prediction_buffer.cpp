// SPDX-License-Identifier: Apache-2.0
#include "live/prediction_buffer.hpp"

namespace kelpie::live {

std::span<const Decision> PredictionBuffer::by(const SharedModel& model,
                                               std::span<const double> x) {
  const bool had_model = model.predict(x, predictions_) > 0;
  for (std::size_t i = 0; i < decisions_.size(); ++i) {
    decisions_[i] = {.prediction = predictions_[i], .had_model = had_model};
  }
  return decisions_;
}

}  // namespace kelpie::live
