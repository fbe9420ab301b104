// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "kelpie/online/past_model.hpp"

namespace kelpie {

/// Compares past models with the model in service, sample by sample. One fits when its errors are
/// as usual for it (in the mean, twice its usual error at most) and smaller than those of the model
/// in service: by 15 of its usual errors in all, after half of one per sample as a margin.
/// Allocates in the constructor only.
class ModelTrial {
 public:
  /// For up to so many past models.
  ModelTrial(std::size_t dimension, std::size_t models);

  /// One more sample, and the error |y − f(x)| of the model in service before it was learned; left
  /// out where it lies at the place of the one before (kSamePlace). Cost: a prediction by each.
  void add(std::span<const double> z, double y, double error, std::span<const PastModel> models);

  /// The past model that fits, `but` for one; of several the one that is ahead.
  std::optional<std::size_t> fitting(std::optional<std::size_t> but) const;

  void clear();  ///< Begins anew.

  void visit(Archive& archive, std::size_t models);  ///< core/archive.hpp; of so many models

  /// Memory in bytes, beside the object itself.
  static std::size_t bytes(std::size_t dimension, std::size_t models);

 private:
  /// In the past model's usual errors, summed up.
  struct Score {
    double lead = 0.0;   ///< over the model in service
    double error = 0.0;  ///< its own
  };

  bool same_place(std::span<const double> z, const MixedKernel& kernel);

  std::vector<Score> scores_;
  SampleStore last_;  ///< the latest sample that counted
  int samples_ = 0;   ///< that counted
};

}  // namespace kelpie
