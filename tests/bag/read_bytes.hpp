// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bag/inspect.hpp"
#include "bag/packed_bytes.hpp"
#include "bag/series.hpp"
#include "support.hpp"

namespace kelpie::testing {

/// A reader of one kind of file, for bytes.
class BytesReader {
 public:
  using Read = std::unique_ptr<bag::MessageReader> (*)(std::span<const std::byte>,
                                                       const std::string&, bag::ReadMode);

  /// `name` is what messages call the file.
  BytesReader(Read read, std::string name) : read_(read), name_(std::move(name)) {}

  std::vector<bag::Series> series_of(const PackedBytes& log,
                                     const std::vector<std::string>& columns,
                                     bag::Clock clock = bag::Clock::receive,
                                     bag::ReadMode mode = bag::ReadMode::strict) const {
    const auto bag = read_(log.bytes(), name_, mode);
    return bag::read_series(*bag, bag::MessageDefinitions(), columns, clock);
  }

  bag::BagReport report_of(const std::vector<std::byte>& bytes,
                           bag::ReadMode mode = bag::ReadMode::recover) const {
    const auto bag = read_(bytes, name_, mode);
    return bag::inspect_bag(*bag, bag::MessageDefinitions());
  }

  /// Why bytes are refused.
  std::string refusal(const std::vector<std::byte>& bytes) const {
    return message_of<InputError>([&] { report_of(bytes, bag::ReadMode::strict); });
  }

 private:
  Read read_;
  std::string name_;
};

}  // namespace kelpie::testing
