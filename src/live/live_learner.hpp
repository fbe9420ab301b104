// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kelpie/model/live_alignment.hpp"
#include "kelpie/model/shared_model.hpp"
#include "live/change_reporter.hpp"
#include "live/checkpoint.hpp"
#include "live/configuration.hpp"
#include "live/health.hpp"
#include "live/output.hpp"
#include "live/prediction_buffer.hpp"
#include "live/prediction_score.hpp"
#include "live/row_queue.hpp"

namespace kelpie::live {

/// Learns rows, one after the other, and keeps what it learned on the disk. With the same rows in
/// the same order its model is, to the bit, that of `kelpie learn` with the same alignment; also
/// where it went on from a checkpoint and was shown the rows from the first on.
class LiveLearner {
 public:
  /// `folder` is where checkpoints and the model are written. `saved`: what to go on from, of the
  /// same configuration. Where `recording` is the one that it is of, the rows that it has learned
  /// are passed over. Throws InputError (file) where the saved model can't be gone on with.
  LiveLearner(const Configuration& configuration, std::filesystem::path folder,
              const std::optional<log::Reach>& recording, std::optional<SavedRun> saved,
              Output& output);

  // For one thread, the one that learns.

  /// Learns a row, or obeys a request; now and then writes a checkpoint.
  void process(const Row& row);
  /// No row follows: learns those that waited for commands, or for the scale of the data. After a
  /// recording the shift is looked for once more, in all of its rows, as in a log.
  void finish();
  /// Writes a checkpoint of now. A disk that is full is said and counted, and does nothing else.
  void save();
  /// Writes model.json, where there is a model. Throws Failure as file::write_file_whole does.
  bool write_model() const;
  void refresh_health();  ///< So that health() tells of now.

  // For any thread.

  LearnerHealth health() const;
  /// The model that learns, to predict with. It may be replaced by another.
  std::shared_ptr<const SharedModel> model() const;
  /// How far the commands of every input are shifted [s], in the order of the inputs.
  void shifts(std::span<double> shift_s) const;
  void set_checkpoint_s(double seconds) { checkpoint_s_ = seconds; }
  std::size_t rows_taken() const { return rows_taken_; }

 private:
  static constexpr std::chrono::seconds kBetweenHealths{1};

  bool is_known() const { return progress_.rows <= known_rows_; }
  void begin_alignment(bool finds_it_anew, const std::optional<SavedRun>& saved);
  void update_alignment(bool afresh);
  void execute(Request request);
  void save_all();
  void begin_anew();
  void align(const Row& row);
  void learn_aligned(std::span<const double> x, std::span<const double> y, double t);
  auto to_learning() {
    return [this](auto x, auto y, double t) { learn_aligned(x, y, t); };
  }
  void update(std::span<const double> x, std::span<const double> y, double t);
  void publish_alignment();

  const Configuration& configuration_;
  std::filesystem::path folder_;
  Output& output_;
  std::shared_ptr<SharedModel> model_;  // replaced under mutex_; read without by who replaces it
  LiveAlignment alignment_;
  bool finds_alignment_ = false;  // for an alignment
  Progress progress_;
  std::size_t known_rows_ = 0;  // that the checkpoint has learned
  std::size_t rows_stuck_ = 0;
  std::size_t rows_paused_ = 0;
  bool is_stuck_ = false;
  ChangeReporter changes_;
  double saved_t_s_ = 0.0;
  bool has_saved_ = false;
  double last_t_s_ = 0.0;
  PredictionScore score_;
  PredictionBuffer predictions_{configuration_.plan.targets.size()};
  std::atomic<double> checkpoint_s_;
  std::atomic<std::size_t> rows_taken_{0};
  std::chrono::steady_clock::time_point refreshed_;
  mutable std::mutex mutex_;  // of what follows
  LearnerHealth health_;
  std::vector<double> shifts_s_;
};

}  // namespace kelpie::live
