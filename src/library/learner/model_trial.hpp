// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "svr/past_model.hpp"

namespace kelpie {

/// Compares past models with the model in service, sample by sample. A past model fits if its mean
/// error is at most twice its usual error, and its summed errors are smaller than those of the
/// model in service by 15 usual errors plus a margin of half a usual error per sample. Allocates in
/// the constructor only.
class ModelTrial {
 public:
  /// For at most `models` past models.
  ModelTrial(std::size_t dimension, std::size_t models);

  /// Adds a sample and the error |y − f(x)| of the model in service before learning; ignores a
  /// sample at the place of the last. Cost: a prediction per past model.
  void add(std::span<const double> z, double y, double error, std::span<const PastModel> models);

  /// The past model with the best fit, without the model `but`.
  std::optional<std::size_t> fitting(std::optional<std::size_t> but) const;

  void clear();  ///< Resets every score.

  void visit(Archive& archive, std::size_t models);  ///< core/archive.hpp

  /// Memory in bytes, beside the object itself.
  static std::size_t bytes(std::size_t dimension, std::size_t models);

 private:
  /// Sums, in the past model's usual errors.
  struct Score {
    double lead = 0.0;   ///< advantage over the model in service
    double error = 0.0;  ///< own errors
  };

  bool same_place(std::span<const double> z, const MixedKernel& kernel);

  std::vector<Score> scores_;
  SampleStore last_;  ///< the latest counted sample
  int samples_ = 0;   ///< counted samples
};

}  // namespace kelpie
