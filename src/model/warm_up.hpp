// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kelpie/core/archive.hpp"

namespace kelpie {

/// The samples of one axis that are held back until there is a scale to learn them in: the last
/// `most` of them. Allocates in the constructor only.
class WarmUp {
 public:
  /// One of them.
  struct Sample {
    std::span<const double> x;  ///< valid until samples come or leave
    double y = 0.0;
    double t = 0.0;
  };

  WarmUp(std::size_t inputs, std::size_t most);  ///< Room for `most` samples.

  /// Keeps a sample; where there is no room, the oldest one leaves. Requires x of `inputs` values,
  /// and most > 0.
  void hold(std::span<const double> x, double y, double t);

  std::size_t size() const { return rows_.size() / width_; }
  bool full() const { return size() == most_; }
  Sample operator[](std::size_t i) const;  ///< The oldest is 0.

  void drop_oldest(std::size_t samples);        ///< Removes that many; there have to be as many.
  void keep(const std::vector<bool>& samples);  ///< Removes those that are false; one for each.

  void clear() { rows_ = {}; }  ///< Removes all samples for good; gives the memory back.

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  std::size_t width_;  ///< numbers per sample: x, y, t
  std::size_t most_;
  std::vector<double> rows_;
};

}  // namespace kelpie
