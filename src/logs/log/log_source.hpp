// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "bag/reader.hpp"

namespace kelpie::log {

/// A log to read: a CSV file or a recording (bag::open_bag), recognised by content; and how to read
/// a recording.
struct LogSource {
  std::string path;
  std::string definitions{};  ///< folder of .msg files, for types without definition in the bag
  bag::ReadMode mode = bag::ReadMode::usual;  ///< treatment of damage in a recording
  bool with_poses = false;                    ///< Dataset::poses are wanted

  /// Throws as bag::open_bag() does.
  std::unique_ptr<bag::MessageReader> open_bag(const bag::RowTimes& times = {}) const;
};

}  // namespace kelpie::log
