// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "kelpie/core/archive.hpp"
#include "kelpie/core/scaling.hpp"
#include "kelpie/motion/term_set.hpp"
#include "posterior/kernel_basis.hpp"
#include "svr/function_mix.hpp"

namespace kelpie {

/// The features φ(x) of an axis, by raw inputs: the constant 1, the terms of the equation of
/// motion, and a kernel's functions at centres chosen by novelty (KernelBasis), for what the terms
/// leave.
///
/// The kernel sees inputs in units: deviations from their means, of the samples so far. When an
/// input outgrows its unit by half, the kernel takes new units; centres stay where they are, and a
/// matrix T expresses the new functions by the old (KernelBasis::move()). Samples far outside of
/// the units count little in the units and in the posterior (trust()). Units: those of the log.
/// Allocates in the constructor only, but for new units.
class Features {
 public:
  /// `states`: inputs that are velocities; `centres`: the most.
  Features(std::size_t inputs, TermSet terms, std::span<const std::size_t> states,
           std::size_t centres);

  std::size_t size() const { return terms_end() + basis_.size(); }
  std::size_t terms_end() const { return 1 + terms_.size(); }  ///< Place of the first function.
  std::size_t capacity() const { return terms_end() + basis_.centres().capacity(); }
  const TermSet& terms() const { return terms_; }
  const KernelBasis& basis() const { return basis_; }
  /// The group of each feature, up to capacity(): terms of the same degrees, the kernel.
  std::span<const std::uint8_t> groups() const { return groups_; }

  /// Weight of a sample by its velocities, or by all inputs where the velocities are unknown: 1 up
  /// to 10 deviations z, then (10/z)⁴.
  double trust(std::span<const double> x) const;

  /// Takes note of a sample; T where the kernel has new units from now on.
  std::optional<Matrix> observe(std::span<const double> x, double trust);

  /// The first terms_end() features.
  void first(std::span<const double> x, std::span<double> phi) const;

  /// φ(x), of size() numbers. At no cost for the x of the last call, while nothing has changed.
  std::span<const double> evaluate(std::span<const double> x);
  /// φ(x). Where x is novel and a place is free, x becomes a centre first.
  std::span<const double> learn(std::span<const double> x);

  /// Of each input, in the samples of full trust; empty ranges before the first.
  std::span<const ValueRange> ranges() const { return ranges_; }

  void clear();  ///< Forgets all samples. Allocates.

  /// The units, as the input scaling of a model: z = (x − mean)/deviation.
  const InputScaling& units() const { return units_; }
  bool has_units() const { return weight_at_units_ > 0.0; }

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  TermSet terms_;
  std::vector<std::size_t> states_;
  std::vector<std::size_t> watched_;  ///< inputs of trust(): the velocities, else all
  KernelBasis basis_;
  std::vector<std::uint8_t> groups_;
  std::vector<double> phi_;   ///< of the last sample
  double novelty_ = 0.0;      ///< of the last sample
  std::vector<double> last_;  ///< the last sample
  bool is_current_ = false;   ///< whether phi_ holds what last_ has by now
  InputScaling units_;
  double rows_ = 0.0, weight_ = 0.0, weight_at_units_ = 0.0;
  std::vector<double> mean_, scatter_;
  std::vector<ValueRange> ranges_;
};

}  // namespace kelpie
