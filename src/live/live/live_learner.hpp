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

#include "file/mapped_file.hpp"
#include "kelpie/alignment/live_alignment.hpp"
#include "kelpie/model/shared_model.hpp"
#include "live/authority_reporter.hpp"
#include "live/change_reporter.hpp"
#include "live/checkpoint.hpp"
#include "live/configuration.hpp"
#include "live/health.hpp"
#include "live/live_reckoning.hpp"
#include "live/output.hpp"
#include "live/parameter_countdown.hpp"
#include "live/prediction_score.hpp"
#include "live/row_check.hpp"
#include "live/row_queue.hpp"

namespace kelpie::live {

/// Learns rows in their order and writes checkpoints. The same rows with the same alignment give,
/// to the bit, the model of `kelpie learn`; a run resumed from a checkpoint and shown the rows from
/// the first on does so too.
class LiveLearner {
 public:
  /// Writes checkpoints and the model to `folder`, and renews the block of the configuration.
  /// Resumes from `saved`, of the same configuration;
  /// rows of the same `recording` that the checkpoint has learned are skipped. Throws InputError
  /// (file) where the saved model cannot be resumed, or the block cannot be renewed.
  LiveLearner(const Configuration& configuration, std::filesystem::path folder,
              const std::optional<log::Reach>& recording, std::optional<SavedRun> saved,
              Output& output);

  // For the learning thread alone.

  /// Learns a row or obeys a request. Writes a checkpoint where due.
  void process(const Row& row);
  /// Learns the rows that wait for commands or for the scale of the data. After a recording, first
  /// searches the alignment once more, in all rows, as in a log.
  void finish();
  /// Writes a checkpoint. A failure is reported and counted; learning goes on.
  void save();
  /// Writes model.json where a model is ready; returns whether. Throws Failure.
  bool write_model() const;
  void refresh_health();  ///< Updates health().

  // For any thread.

  LearnerHealth health() const;
  /// The learning model, to predict with. A reset or another alignment replaces the model.
  std::shared_ptr<const SharedModel> model() const;
  /// The model that the last row with `wants_model` asked for; null: none was ready.
  std::shared_ptr<const ReckoningModel> reckoning_model() const;
  /// Number of such rows so far.
  std::size_t models_given() const { return models_given_; }
  /// The alignment in use; another one is another object.
  std::shared_ptr<const Alignment> alignment() const;
  void set_checkpoint_s(double seconds) { checkpoint_s_ = seconds; }
  std::size_t rows_taken() const { return rows_taken_; }

 private:
  bool is_known() const { return progress_.rows <= known_rows_; }
  void begin_alignment(bool finds_it_anew, const std::optional<SavedRun>& saved);
  void update_alignment(bool afresh);
  void execute(Request request);
  void save_all();
  void reset();
  void begin_anew();
  void align(const Row& row);
  bool has_changed() const;
  void doubt(const std::vector<log::Mistake>& mistakes);
  void learn_aligned(std::span<const double> x, std::span<const double> y, double t);
  auto to_learning() {
    return [this](auto x, auto y, double t) { learn_aligned(x, y, t); };
  }
  std::span<const Decision> predict(const SharedModel& model, std::span<const double> x);
  void update(std::span<const double> x, std::span<const double> y, double t);
  void publish_alignment();
  void serve_block();
  void give_model();

  const Configuration& configuration_;
  std::filesystem::path folder_;
  Output& output_;
  std::unique_ptr<file::SharedFile> block_;  // null: no block
  const study::Nominal nominal_;             // of every model that begins
  std::shared_ptr<SharedModel> model_;       // replaced under mutex_, in the learning thread
  LiveAlignment alignment_;
  bool finds_alignment_ = false;
  Progress progress_;
  std::size_t known_rows_ = 0;  // rows in the checkpoint
  std::size_t rows_stuck_ = 0;
  std::size_t rows_paused_ = 0;
  bool is_stuck_ = false;
  RowCheck check_;
  ChangeReporter changes_;
  AuthorityReporter authority_;
  std::optional<ParameterCountdown> parameters_;  // where parameters are to be told
  double saved_t_s_ = 0.0;
  bool has_saved_ = false;
  bool is_save_due_ = false;  // with the first row that no checkpoint has
  double last_t_s_ = 0.0;
  PredictionScore score_;
  std::vector<Prediction> predictions_;  // while learning is frozen
  std::vector<Decision> decisions_;      // the same, as decisions
  std::atomic<double> checkpoint_s_;
  std::atomic<std::size_t> rows_taken_{0};
  std::atomic<std::size_t> models_given_{0};
  std::chrono::steady_clock::time_point refreshed_;
  mutable std::mutex mutex_;  // guards the members below
  LearnerHealth health_;
  std::shared_ptr<const Alignment> published_;
  std::shared_ptr<const ReckoningModel> reckoning_model_;
};

}  // namespace kelpie::live
