// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "kelpie/model/dynamics_model.hpp"
#include "live/health.hpp"

namespace kelpie::live {

/// A sample that has just been learned, and what had been said of it before. Or, while an operator
/// has learning frozen, one that was passed over, and what is said of it.
struct LearnedSample {
  std::int64_t stamp_ns = 0;  ///< of the row, by the configuration's clock
  double t = 0.0;             ///< the same [s] since the origin
  std::span<const double> x;
  std::span<const double> y;
  std::span<const Decision> decisions;  ///< one per axis, with prediction, interval, disturbance
  bool is_learned = true;
};

/// What is predicted for now, from the newest messages.
struct PredictedSample {
  std::int64_t stamp_ns = 0;  ///< when the newest message was received
  std::int64_t data_ns = 0;   ///< its stamp, by the configuration's clock
  std::span<const double> x;
  std::span<const Prediction> predictions;  ///< one per axis
};

/// Somebody who is told what happens. None of these functions may throw or wait for the network.
class Output {
 public:
  Output() = default;
  virtual ~Output() = default;
  Output(const Output&) = delete;
  Output(Output&&) = delete;
  Output& operator=(const Output&) = delete;
  Output& operator=(Output&&) = delete;

  virtual bool wants_predictions() const { return false; }      ///< Whether predicted() is for it.
  virtual void learned(const LearnedSample& /*sample*/) {}      ///< In the learning thread.
  virtual void predicted(const PredictedSample& /*sample*/) {}  ///< In the receiving thread.
  virtual void health(const Health& /*health*/) {}              ///< Once a second, there too.
  virtual void event(const std::string& /*line*/) {}  ///< What happened, in words. Of either.
};

}  // namespace kelpie::live
