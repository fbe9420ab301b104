// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "kelpie/core/scaling.hpp"
#include "kelpie/core/setting.hpp"
#include "svr/svr_function.hpp"

namespace kelpie::lab {

/// The training rows of a log, and a target. Further rows are never read.
struct TrainingRows {
  std::span<const double> x;  ///< row-major, all rows × inputs, raw units
  std::size_t inputs = 0;
  std::span<const double> y;  ///< row-major, all rows × targets, raw units
  std::size_t targets = 1;
  std::size_t target = 0;             ///< which of the targets
  std::span<const std::size_t> rows;  ///< numbers of the rows to learn from

  /// Inputs of a row.
  std::span<const double> input(std::size_t row) const { return x.subspan(row * inputs, inputs); }
  /// The target of a row.
  double target_of(std::size_t row) const { return y[row * targets + target]; }
};

/// ε, C and the tolerance are in standard deviations of the training target.
struct OfflineSvrSettings {
  ScalingKind scaling = ScalingKind::diagonal;
  double gamma = 0.1;       ///< κ = exp(−γ d²), d the Mahalanobis distance
  double c = 10.0;          ///< C: bound of a weight
  double epsilon = 0.1;     ///< ε: half width of the tube
  double tolerance = 5e-4;  ///< KKT gap at which LIBSVM stops
  double cache_mb = 100.0;  ///< memory for kernel rows [MB]

  /// Throws InputError with the field out of range.
  void validate() const;
};

/// Trains by LIBSVM on scaled inputs and targets; settings.scaling is ignored. Cost between O(n²)
/// and O(n³). Switches LIBSVM's printing off for the whole process. Requires a target per sample,
/// at least two, and valid settings.
SvrFunction train_by_libsvm(const SampleStore& samples, std::span<const double> targets,
                            const OfflineSvrSettings& settings);

/// ε-SVR for an axis, trained off line on the training rows by LIBSVM (Chang & Lin): the ceiling
/// for on-line learners. Inputs and target are standardised with the moments of the training rows.
class OfflineSvr {
 public:
  /// Throws InputError on settings out of range, fewer than two rows, values that are not finite,
  /// or singular (co)variances.
  OfflineSvr(const TrainingRows& data, const OfflineSvrSettings& settings);

  /// Raw units in and out. Requires x of the training rows' number of inputs. Does not allocate;
  /// safe from many threads.
  double predict(std::span<const double> x) const;

  const AxisScaling& scaling() const { return scaling_; }
  const SvrFunction& function() const { return function_; }

 private:
  AxisScaling scaling_;
  SvrFunction function_;
};

}  // namespace kelpie::lab
