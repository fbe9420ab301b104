// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <exception>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "live/checkpoint.hpp"
#include "live/configuration.hpp"
#include "live/health_table.hpp"
#include "live/live_learner.hpp"
#include "live/outputs.hpp"
#include "live/receiver.hpp"
#include "live/recorder.hpp"
#include "live/requests.hpp"
#include "live/transport.hpp"

namespace kelpie::live {

/// Messages in, a model that learns, predictions out: the calling thread receives, predicts and
/// tells outputs of health; another learns. Between them is a queue of rows: where messages come
/// when they come, rows that find it full are counted and lost; a recording waits instead.
class Engine {
 public:
  static constexpr std::size_t kQueue = 4096;  ///< rows: minutes of learning

  /// What the caller wants, asked for after every message and at least 20 times per second.
  enum class Action { proceed, stop };

  /// All references have to outlive it. Throws as LiveLearner's and Receiver's constructors do.
  Engine(const Configuration& configuration, std::filesystem::path folder, Transport& transport,
         std::optional<SavedRun> saved, Outputs& outputs, Requests& requests);

  /// Runs until a recording ends or `next_action` says so; then what has come is learned, and
  /// checkpoint and model are written. Throws Failure where these can't be written, and what a
  /// transport throws.
  void run(const std::function<Action()>& next_action);

  void record(std::unique_ptr<Recorder> recorder);  ///< From now on; null: no more.
  LiveLearner& learner() { return learner_; }
  Health health() const;                         ///< For the thread that runs it.
  bool has_ended() const { return has_ended_; }  ///< The recording came to its end.

  /// Whether both threads get on with what there is to do: what a watchdog wants to know.
  bool is_alive();

 private:
  using Clock = std::chrono::steady_clock;

  void receive(const std::function<Action()>& next_action);
  void learn();
  double last_row_s() const;
  void forward_rows();
  void finish_rows();
  void forward_requests();
  void predict();
  void report();
  void measure_rates(Health& health) const;

  const Configuration& configuration_;
  Transport& transport_;
  Outputs& outputs_;
  Requests& requests_;
  std::optional<log::Reach> reach_;
  double end_s_ = std::numeric_limits<double>::infinity();  // without a reach
  Receiver receiver_;
  LiveLearner learner_;
  std::unique_ptr<Recorder> recorder_;
  Row row_;
  RowQueue queue_;
  std::exception_ptr failed_;     // of the learning thread, once it has ended
  std::int64_t received_ns_ = 0;  // of the newest message
  std::size_t rows_ = 0;
  std::size_t rows_incomplete_ = 0;
  Clock::time_point last_message_ = Clock::now();
  Clock::time_point reported_ = Clock::now();
  Health before_;
  double before_s_ = 0.0;  // by the messages' clock
  std::size_t rows_seen_alive_ = 0;
  Clock::time_point alive_ = Clock::now();
  std::vector<double> shifts_s_;
  std::vector<double> x_now_;
  std::vector<Prediction> predictions_;
  bool has_ended_ = false;
};

}  // namespace kelpie::live
