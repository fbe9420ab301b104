// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "bag/bag.hpp"
#include "bag/mat_topics.hpp"

namespace kelpie::log {

/// Where recorded data is: a CSV file, or what bag::open_bag opens, told apart by content; and
/// how it is read where it is a bag.
struct LogSource {
  std::string path;
  std::string definitions{};  ///< folder of .msg files for types that the bag doesn't define
  bool recover = false;       ///< read what can be read of a damaged bag

  /// `times` are of use for a file of MATLAB, whose rows may be without. Throws as bag::open_bag
  /// and bag::read_mat do.
  std::unique_ptr<bag::BagReader> open_bag(const bag::RowTimes& times = {}) const;
};

}  // namespace kelpie::log
