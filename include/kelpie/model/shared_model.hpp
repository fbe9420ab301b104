// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "kelpie/model/dynamics_model.hpp"

namespace kelpie {

/// A DynamicsModel that one thread teaches while any others predict, such as a controller at 50 Hz
/// beside a learner at 10 Hz.
///
///     SharedModel shared(DynamicsModel({"u", "n"}, {"udot"}, settings));
///     shared.update(x, y, t);      // one thread, the writer
///     shared.predict(x, y);        // any thread
///
/// After every update a picture of the models in service is published, and readers predict with the
/// latest one: complete, never half an update. Nobody waits: neither readers for the writer, nor
/// the writer for readers. A reader may have to look twice when a picture is published at that very
/// moment. There are a few pictures; where readers that were put to sleep in the middle of a
/// prediction hold all of them, the writer passes over a publication, and the next one makes up for
/// it. Nothing allocates or locks after construction, beyond what DynamicsModel::update() may.
///
/// Memory: about as much per picture as the support vectors take, 0.1 MB per axis with a buffer of
/// 900 and six inputs.
class SharedModel {
 public:
  /// The model may have learned already. Requires pictures >= 2. Allocates them.
  explicit SharedModel(DynamicsModel model, std::size_t pictures = 4);
  ~SharedModel();
  SharedModel(const SharedModel&) = delete;
  SharedModel(SharedModel&&) = delete;
  SharedModel& operator=(const SharedModel&) = delete;
  SharedModel& operator=(SharedModel&&) = delete;

  // For the writer: one thread at a time.

  /// DynamicsModel::update(), then a new picture where every axis has a model.
  void update(std::span<const double> x, std::span<const double> y, double t);
  /// DynamicsModel::learn_held_back(), likewise.
  void learn_held_back();
  const DynamicsModel& model() const { return model_; }
  /// Publications that were passed over, since readers held all pictures.
  std::int64_t passed_over() const { return passed_over_; }

  // For any thread. All return the number of the picture that they predicted with: 1, 2, 3 … as
  // they were published; 0 where there is none yet, and then nothing is written. Costs and errors
  // as of the functions of DynamicsModel. Safe from many threads.

  /// The values.
  std::int64_t predict(std::span<const double> x, std::span<double> y) const;
  /// Values with interval, novelty and disturbance.
  std::int64_t predict(std::span<const double> x, std::span<Prediction> y,
                       double ahead_s = 0.0) const;
  /// Values and Jacobian.
  std::int64_t predict_with_jacobian(std::span<const double> x, std::span<double> y,
                                     std::span<double> jacobian) const;

 private:
  struct Picture;

  /// Calls use(picture) with the latest one held; returns its number.
  template <typename Use>
  std::int64_t with_latest(Use use) const;
  void publish();

  DynamicsModel model_;
  std::int64_t published_ = 0;
  std::int64_t passed_over_ = 0;
  std::size_t count_;
  std::unique_ptr<Picture[]> pictures_;  // NOLINT(*-avoid-c-arrays): they can't be moved
  std::atomic<std::ptrdiff_t> latest_{-1};
};

}  // namespace kelpie
