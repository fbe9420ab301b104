// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "kelpie/core/archive.hpp"
#include "kelpie/svr/past_model_info.hpp"
#include "posterior/evidence.hpp"
#include "posterior/posterior.hpp"

namespace kelpie {

/// What is known of a vehicle that the live posterior has left: the weights of all features, while
/// the kernel is the same, and the posterior of the terms alone, of sums over independent samples.
struct PastVehicle {
  /// `terms`: the number of the first features, with the constant; `features`: the most of all.
  PastVehicle(std::size_t terms, std::size_t features) : posterior(terms, terms) {
    weights.reserve(features);
  }

  /// Learns sums of so many rows per independent sample. Cost O(n³) for n terms.
  void learn(const SampleSums& sums, double tau, std::span<const std::uint8_t> group);

  void visit(Archive& archive);  ///< core/archive.hpp

  PastModelInfo info;
  Posterior posterior;
  RoomyVector<double> weights;  ///< that of the constant with the mean of the targets; or empty
  double rows_per_sample = 1.0;
  Evidence evidence;     ///< that the vehicle is back
  double since_s = 0.0;  ///< when the evidence was 0 last [s]
};

/// The vehicles that an axis has left, each the hypothesis "the vehicle is back" against the live
/// posterior (Evidence). Of a vehicle without weights of the kernel the hypothesis is the live
/// posterior, but for the weights of the terms alone, which are as they were then. A row that
/// surprises the past vehicle as well (16 variances of the noise) is no evidence, for garbage
/// resembles no vehicle. A vehicle is kept once: where a vehicle left differs from a kept one by
/// less than 0.2 variances of the noise at the inputs of the samples (Cook's distance), the new
/// sums take the place of the old. A full store loses the vehicle with the fewest returns, then the
/// one longest out of service.
///
/// Cost of a row O(n) per vehicle of n terms; of leave() O(n³). Allocates in the constructor only.
class PastVehicles {
 public:
  /// `most`: vehicles kept; otherwise as PastVehicle.
  PastVehicles(std::size_t terms, std::size_t features, std::size_t most);

  std::size_t most() const { return places_.size() - 1; }  ///< Vehicles kept.
  std::span<const PastVehicle> vehicles() const { return {places_.data(), size_}; }

  /// Scores what a row of the time t [s] tells; the vehicle that is back, if any. `phi`: features
  /// of the row, those of the terms first; `trust`: weight by the inputs.
  const PastVehicle* update(std::span<const double> phi, double y, double t, double trust,
                            const Posterior& live);

  /// The vehicle in service is this one from now on.
  void recall(const PastVehicle& vehicle);

  /// On another axis a vehicle is back: here a fifth of the evidence is enough for 36 s.
  void alert() { alerted_s_ = last_s_; }

  /// The vehicle in service since `since_s` [s] is another than the live posterior's, which is kept
  /// where it served for ten independent samples per term or more. `group`: of each feature.
  void leave(const Posterior& live, double since_s, std::span<const std::uint8_t> group);
  void come_back();  ///< The vehicle of the last leave() was never left.
  void begin();      ///< Nothing is known of the vehicle in service.

  /// Adds a vehicle of an earlier run, known by sums over independent samples. Requires room.
  /// False, and nothing added, where the sums are of no samples.
  bool add(const PastModelInfo& info, const SampleSums& sums, double rows_per_sample,
           std::span<const std::uint8_t> group);

  /// The features of the kernel become others (Posterior::change_features()). Allocates.
  void change_features(const Matrix& t);
  void forget_kernel();  ///< The kernel begins anew.

  void visit(Archive& archive);  ///< core/archive.hpp

  /// Memory in bytes.
  static std::size_t bytes(std::size_t terms, std::size_t features, std::size_t most) {
    return (most + 1) *
           (sizeof(PastVehicle) + Posterior::bytes(terms, terms) + features * sizeof(double));
  }

 private:
  std::size_t keep(PastVehicle& left);

  std::vector<PastVehicle> places_;  ///< one more than vehicles are kept, as scratch
  std::size_t size_ = 0;
  std::int64_t next_number_ = 1;
  std::optional<std::size_t> in_service_, left_;  ///< places
  std::int64_t rows_ = 0;                         ///< of the vehicle in service
  double begun_s_ = 0.0, last_s_ = 0.0;           ///< its first row, and the last [s]
  double alerted_s_ = -std::numeric_limits<double>::infinity();
};

}  // namespace kelpie
