// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
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
#include "live/live_reckoning.hpp"
#include "live/outputs.hpp"
#include "live/present_commands.hpp"
#include "live/receiver.hpp"
#include "live/recorder.hpp"
#include "live/requests.hpp"
#include "live/transport.hpp"

namespace kelpie::live {

/// A live run: the calling thread receives messages, predicts and reports the health; a second
/// thread learns. A queue of rows connects the two. Where the queue is full, rows of a connection
/// are counted and lost; a recording waits.
class Engine {
 public:
  /// The caller's wish, asked for after every message and at least 20 times per second.
  enum class Action { proceed, stop };

  /// Requires that all references outlive this. Throws as LiveLearner and Receiver do.
  Engine(const Configuration& configuration, std::filesystem::path folder, Transport& transport,
         std::optional<SavedRun> saved, Outputs& outputs, Requests& requests);

  /// Runs until the end of a recording or Action::stop; then learns the waiting rows and writes
  /// checkpoint and model. Throws Failure where the model cannot be written, and as the transport,
  /// the learner and the outputs do.
  void run(const std::function<Action()>& next_action);

  void record(std::unique_ptr<Recorder> recorder);  ///< Null ends recording.
  LiveLearner& learner() { return learner_; }
  Health health() const;                         ///< For the thread of run().
  bool has_ended() const { return has_ended_; }  ///< At the recording's end.

  /// Whether both threads make progress, for a watchdog.
  bool is_alive();

 private:
  using Clock = std::chrono::steady_clock;

  void receive(const std::function<Action()>& next_action);
  void learn();
  double last_row_s() const;
  void forward_rows();
  void finish_rows();
  void note_incomplete();
  std::string why_incomplete() const;
  void forward_request();
  void predict();
  void reckon();
  void report();
  void measure_rates(Health& health) const;

  const Configuration& configuration_;
  Transport& transport_;
  Outputs& outputs_;
  Requests& requests_;
  std::optional<log::Reach> reach_;
  double end_s_ = std::numeric_limits<double>::infinity();  // of a connection
  Receiver receiver_;
  LiveLearner learner_;
  ParameterMessages told_;  // for the next file of a recording
  std::unique_ptr<Recorder> recorder_;
  Row row_;
  RowQueue queue_;
  std::exception_ptr failed_;     // thrown in the learning thread
  std::int64_t received_ns_ = 0;  // of the newest message
  std::size_t rows_ = 0;
  std::size_t rows_incomplete_ = 0;
  std::size_t rows_in_vain_ = 0;  // incomplete ones since the last whole row
  std::string no_rows_;           // why there was no whole row for long
  double row_late_s_ = 0.0;
  std::size_t unrecorded_ = 0;                     // messages, by earlier recorders
  Clock::time_point last_message_ = Clock::now();  // dealt with
  Clock::time_point forwarded_;                    // the last request
  Clock::time_point reported_ = Clock::now();
  Health before_;
  double before_s_ = 0.0;  // of before_, by the messages' clock
  std::size_t rows_seen_alive_ = 0;
  Clock::time_point alive_ = Clock::now();
  PresentCommands commands_;
  LiveReckoning reckoning_;
  std::size_t models_wanted_ = 0;
  std::atomic<bool> learning_ended_{false};
  std::vector<double> x_now_;
  std::vector<Prediction> predictions_;
  bool has_ended_ = false;
};

}  // namespace kelpie::live
