// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "bag/byte_reader.hpp"
#include "bag/reader.hpp"

namespace kelpie::bag {

/// Base of the readers of a file in memory. Implement step(), which reads the record at at_ and
/// moves at_ behind the record, and pass_damage().
class FileReader : public MessageReader {
 public:
  /// `bytes` is the content and has to outlive the reader; messages call the file `file`.
  FileReader(std::span<const std::byte> bytes, const std::string& file, ReadMode mode)
      : MessageReader(mode, file), bytes_(bytes), region_{.file = file} {}

  Place place() const override;

 protected:
  bool at_end() const override { return at_ >= bytes_.size(); }

  /// Notes the place of the message being returned, for place().
  void note(std::size_t topic, std::size_t offset) { note(topic, offset, region_); }
  void note(std::size_t topic, std::size_t offset, const Region& region);
  bool has_noted() const { return last_region_ != nullptr; }

  std::span<const std::byte> bytes_;
  Region region_;
  std::size_t at_ = 0;

 private:
  std::size_t last_topic_ = 0;
  std::size_t last_offset_ = 0;
  const Region* last_region_ = nullptr;
};

}  // namespace kelpie::bag
