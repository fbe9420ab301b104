// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kelpie/alignment/alignment.hpp"
#include "kelpie/model/settings.hpp"
#include "kelpie/motion/term_set.hpp"
#include "kelpie/svr/regressor.hpp"

namespace kelpie {

struct Snapshot;

/// A model that no longer learns: saved, loaded and handed to others. Predictions are those of the
/// DynamicsModel it was taken from, to the last bit; spans of another size throw InputError, and
/// inputs that aren't finite give NaN, as there.
struct TrainedModel {
  using Axis = Snapshot;  ///< model/snapshot.hpp, private to kelpie

  TrainedModel();
  /// Of snapshots, one per target.
  TrainedModel(std::vector<std::string> inputs, ModelSettings model_settings, TermSet model_terms,
               std::vector<Snapshot> snapshots);
  TrainedModel(const TrainedModel& other);
  TrainedModel(TrainedModel&& other) noexcept;
  TrainedModel& operator=(const TrainedModel& other);
  TrainedModel& operator=(TrainedModel&& other) noexcept;
  ~TrainedModel();

  std::vector<std::string> input_names;
  ModelSettings settings;
  TermSet terms;  ///< the physics terms of every axis
  std::vector<Snapshot> axes;
  /// How commands were aligned before the model saw them. predict() takes aligned inputs: pass rows
  /// of a log through AlignedRows first.
  Alignment alignment{};

  std::vector<std::string> target_names() const;  ///< Of all axes, in order. Allocates.

  /// One prediction of every axis in raw units: x of input_names.size() values, y of axes.size().
  /// Allocates nothing; safe from many threads.
  void predict(std::span<const double> x, std::span<double> y) const;

  /// The same with interval and novelty, as of the DynamicsModel at its end. The interval was
  /// learned from errors one step ahead and adapts no more. No disturbance. Cost: three kernel rows
  /// per axis. Allocates nothing; safe from many threads.
  void predict(std::span<const double> x, std::span<Prediction> y) const;

  /// The same, to rounding, with the Jacobian in raw units, row-major: ∂y_i/∂x_j at
  /// jacobian[i · inputs + j], of axes.size() · inputs values. At a kink of a physics term the
  /// slope is the slope to the right; a term without a finite value or slope counts 0. Cost once to
  /// twice that of predict(). Allocates nothing; safe from many threads.
  void predict_with_jacobian(std::span<const double> x, std::span<double> y,
                             std::span<double> jacobian) const;
};

/// Reads the text of a model.json (reference/files.md), as `kelpie learn`, `kelpie live` and Python
/// write it; predictions are those of the program that wrote it, to the last bit. The library reads
/// no files; `source` names the text in messages. Throws InputError (`source`, key) on invalid
/// JSON, another format, a newer version, a missing key, inconsistent sizes, or impossible values.
/// Allocates.
TrainedModel read_trained_model(std::string_view text, const std::string& source = "model.json");

}  // namespace kelpie
