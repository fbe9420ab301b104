// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "kelpie/kernel/sample_store.hpp"
#include "kelpie/online/past_model_info.hpp"
#include "kelpie/online/sample_collector.hpp"
#include "kelpie/svr/svr_function.hpp"

namespace kelpie {

/// A model that was in service while nothing changed, with the samples it was learned from, on
/// scaled inputs and a standardised target. Enough to recognise its vehicle and to go on learning
/// where it stopped. Allocates in the constructor only.
struct PastModel {
  /// Fills in the terms of a sample whose inputs are there.
  using Completion = std::function<void(std::span<double> sample)>;

  PastModel(const MixedKernel& kernel, std::size_t places);  ///< Allocates for so many samples.

  /// Takes over a buffer and its model. `about` says the rest. Cost O(n d).
  void keep(const SampleCollector& buffer, const SvrFunction& model, const PastModelInfo& about);

  /// Takes over the support vectors of a function, which a learner with these settings makes
  /// anew of them: their targets lie at the edge of its tube, or beyond where their weight is at
  /// its bound. What there is no room for is left out. Allocates.
  void keep(const SvrFunction& function_of, const OnlineSvrSettings& settings,
            const Completion& complete);

  std::size_t size() const { return samples.size(); }
  double latest_s() const;  ///< The time of the latest sample [s]; 0 without one. Cost O(n).

  /// Whether another function says the same where this model has samples: at some of them, evenly
  /// chosen, without the fine parts. `x` is scratch of a sample's size.
  bool agrees(const SvrFunction& other, std::span<double> x) const;
  /// Whether another function explains these samples about as well as this model does.
  bool explained_by(const SvrFunction& other, std::span<double> x) const;

  void visit(Archive& archive);  ///< core/archive.hpp

  /// Memory of a past model in bytes.
  static std::size_t bytes(std::size_t inputs, std::size_t terms, std::size_t places);

  PastModelInfo info;
  SampleStore samples;
  std::vector<double> targets;  ///< as many places as samples has
  std::vector<double> times_s;
  SvrFunction function;
};

}  // namespace kelpie
