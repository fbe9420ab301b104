// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "kelpie/svr/past_model_info.hpp"
#include "svr/sample_collector.hpp"
#include "svr/sample_store.hpp"
#include "svr/svr_function.hpp"

namespace kelpie {

/// A model of one vehicle with its samples, on scaled inputs and a standardised target: sufficient
/// to recognise the vehicle and to resume learning. Allocates in the constructor only.
struct PastModel {
  /// Fills in the terms of a sample with given inputs.
  using Completion = std::function<void(std::span<double> sample)>;

  PastModel(const MixedKernel& kernel, std::size_t places);  ///< Allocates for `places` samples.

  /// Copies a buffer, its model and the information about the model. Cost O(n d).
  void keep(const SampleCollector& buffer, const SvrFunction& model, const PastModelInfo& about);

  /// Makes samples from the support vectors of a function, for a learner with these settings that
  /// reproduces the function: targets on the edge of the tube, and beyond for weights at the bound.
  /// Omits support vectors beyond the room. Allocates.
  void keep(const SvrFunction& function_of, const OnlineSvrSettings& settings,
            const Completion& complete);

  std::size_t size() const { return samples.size(); }
  double latest_s() const;  ///< The latest time of a sample [s]; 0 without samples. Cost O(n).

  void visit(Archive& archive);  ///< core/archive.hpp

  /// Memory of a past model in bytes.
  static std::size_t bytes(std::size_t inputs, std::size_t terms, std::size_t places);

  PastModelInfo info;
  SampleStore samples;
  std::vector<double> targets;  ///< a place per sample
  std::vector<double> times_s;
  SvrFunction function;
};

}  // namespace kelpie
