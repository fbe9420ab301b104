// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "kelpie/core/archive.hpp"
#include "kelpie/svr/function_mix.hpp"

namespace kelpie {

/// The range of the targets seen so far, by which predictions are bounded. Its ends are the third
/// least and the third greatest target, so that one or two absurd ones don't move them, and a tenth
/// of its width is added on either side. Of fewer than kLeast targets it is all of them and a
/// standard deviation more. Allocates nothing.
class SeenRange {
 public:
  void add(double y);  ///< Requires no NaN.

  Limits limits() const;  ///< None before there is a target.

  /// As if targets had been seen that give these limits. None: as clear().
  void resume_from(const Limits& limits);

  void clear() { *this = {}; }  ///< Forgets all targets.

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  static constexpr std::size_t kEnds = 3;
  static constexpr std::size_t kLeast = 20;

  std::array<double, kEnds> least_{};     ///< ascending
  std::array<double, kEnds> greatest_{};  ///< descending
  std::size_t count_ = 0;
};

}  // namespace kelpie
