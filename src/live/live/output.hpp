// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kelpie/model/dynamics_model.hpp"
#include "kelpie/navigation/dead_reckoning.hpp"
#include "live/health.hpp"

namespace kelpie::live {

/// A sample that was learned just now, with the model's answer from before. While learning is
/// frozen: a sample that was predicted only.
struct LearnedSample {
  std::int64_t stamp_ns = 0;  ///< of the row, by the configuration's clock
  double t = 0.0;             ///< the same [s] since the origin
  std::span<const double> x;
  std::span<const double> y;
  std::span<const Decision> decisions;  ///< per axis, with prediction, interval, disturbance
  bool is_learned = true;
};

/// The prediction for now, from the newest messages.
struct PredictedSample {
  std::int64_t stamp_ns = 0;  ///< when the newest message was received
  std::int64_t data_ns = 0;   ///< its stamp, by the configuration's clock
  std::span<const double> x;
  std::span<const Prediction> predictions;  ///< per axis
};

/// Velocities at the newest message, measured or reckoned (kelpie/navigation/dead_reckoning.hpp).
struct ReckonedSample {
  std::int64_t stamp_ns = 0;              ///< when the newest message was received
  std::int64_t data_ns = 0;               ///< its stamp, by the configuration's clock
  const std::vector<std::string>& names;  ///< of the velocities, in their order
  const DeadReckoning& reckoning;
};

/// Stands in an event that asks for a pilot's attention.
inline constexpr std::string_view kWarning = "WARNING: ";

/// Receiver of a live run's results. No function may throw or wait for the network.
class Output {
 public:
  Output() = default;
  virtual ~Output() = default;
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  virtual bool wants_predictions() const { return false; }      ///< Whether to call predicted().
  virtual void learned(const LearnedSample& /*sample*/) {}      ///< In the learning thread.
  virtual void predicted(const PredictedSample& /*sample*/) {}  ///< In the receiving thread.
  virtual void reckoned(const ReckonedSample& /*sample*/) {}    ///< The same.
  virtual void health(const Health& /*health*/) {}    ///< Once a second, in the same thread.
  virtual void event(const std::string& /*line*/) {}  ///< A line of text. In either thread.
  virtual void ended() {}                             ///< The recording has ended; nothing follows.
};

}  // namespace kelpie::live
