// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "kelpie/alignment/alignment.hpp"
#include "kelpie/model/dynamics_model.hpp"

namespace kelpie {

struct Snapshot;
class TermSet;

/// A DynamicsModel that one thread teaches while any other threads predict, such as a controller at
/// 50 Hz beside a learner at 10 Hz.
///
///     SharedModel shared(DynamicsModel({"u", "n"}, {"udot"}, settings));
///     shared.update(x, y, t);      // one thread, the writer
///     shared.predict(x, y);        // any thread
///
/// Every update publishes a snapshot of the models in service, and readers predict with the latest
/// snapshot: complete, never half an update. Readers never wait for the writer, nor the writer for
/// readers; a reader looks twice when a snapshot is published at the same moment. The number of
/// snapshots is fixed. While readers suspended in the middle of a prediction hold all snapshots,
/// the writer skips a publication; the next publication catches up. Nothing allocates or locks
/// after construction, beyond DynamicsModel::update().
///
/// Memory: a snapshot takes about as much as the support vectors, 0.1 MB per axis with a buffer of
/// 900 samples and six inputs.
class SharedModel {
 public:
  /// The model may have learned already. Requires snapshots >= 2. Allocates the snapshots.
  explicit SharedModel(DynamicsModel model, std::size_t snapshots = 4);
  ~SharedModel();
  SharedModel(const SharedModel&) = delete;
  SharedModel& operator=(const SharedModel&) = delete;

  // For the writer: one thread at a time.

  /// DynamicsModel::update(), then a new snapshot once every axis has a model.
  void update(std::span<const double> x, std::span<const double> y, double t);
  void learn_held_back();  ///< DynamicsModel::learn_held_back(), likewise.
  /// From now on every publication also renews `block`: memory that a library of `kelpie export
  /// --live` reads, in this process or another (docs/howto/controller.md). `inputs` and
  /// `targets` are the names of the model's columns, `alignment` that of the commands. Another call
  /// replaces block and alignment; an empty block ends the service. The writer never waits; a
  /// renewal costs some 50 µs for three axes and allocates nothing. Requires memory that outlives
  /// this or the service. Throws InputError (`block`) where the memory is no block, belongs to
  /// other columns or terms, or has too little room for the model's settings. Allocates.
  void serve(std::span<std::byte> block, std::span<const std::string> inputs,
             std::span<const std::string> targets, const Alignment& alignment = {});
  const DynamicsModel& model() const { return model_; }
  /// Publications skipped because readers held all snapshots.
  std::int64_t passed_over() const { return passed_over_; }

  // For any thread. Each returns the number of the snapshot in use: 1, 2, 3 … in the order of
  // publication; 0 before the first, and then nothing is written. Costs and errors as of the
  // functions of DynamicsModel. Safe from many threads.

  /// The values.
  std::int64_t predict(std::span<const double> x, std::span<double> y) const;
  /// Values with interval, novelty and disturbance.
  std::int64_t predict(std::span<const double> x, std::span<Prediction> y,
                       double ahead_s = 0.0) const;
  /// Values and Jacobian.
  std::int64_t predict_with_jacobian(std::span<const double> x, std::span<double> y,
                                     std::span<double> jacobian) const;

 private:
  struct Publication;

  /// Calls use(axes) with the snapshots of the latest publication, held; returns its number.
  template <typename Use>
  std::int64_t with_latest(Use use) const;
  void publish();
  /// The snapshots of publication `place`.
  std::span<const Snapshot> snapshots(std::size_t place) const;

  DynamicsModel model_;
  std::unique_ptr<const TermSet> terms_;  ///< of all axes; those of model_ go with replaced axes
  std::int64_t published_ = 0;
  std::int64_t passed_over_ = 0;
  std::size_t count_;
  std::unique_ptr<Publication[]> publications_;  // NOLINT(*-avoid-c-arrays): not movable
  std::atomic<std::ptrdiff_t> latest_{-1};
  /// Writes snapshots into a block (src/library/files/model_block.cpp); empty: no block.
  std::function<void(std::span<const Snapshot> axes)> renew_block_;
};

}  // namespace kelpie
