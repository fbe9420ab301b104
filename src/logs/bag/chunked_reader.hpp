// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "bag/compression.hpp"
#include "bag/file_reader.hpp"

namespace kelpie::bag {

/// Base of the readers of files with packed chunks of records (MCAP, ROS 1). `Cursor` walks over
/// the records of the file, and over the records of the open chunk.
template <typename Cursor>
class ChunkedReader : public FileReader {
 protected:
  /// `records` stands at the first record of the file.
  ChunkedReader(std::span<const std::byte> bytes, const std::string& file, ReadMode mode,
                const Cursor& records)
      : FileReader(bytes, file, mode), file_cursor_(records), chunk_region_{.file = file} {}

  bool at_end() const final { return is_done_; }

  void close_chunk() {
    chunk_.clear();
    chunk_cursor_ = {};
  }

  /// Opens the chunk whose record is at `offset`. Requires close_chunk() before.
  void open_chunk(std::uint64_t offset, std::span<const std::byte> content) {
    chunk_region_.part = fmt::format("chunk at offset {}, ", offset);
    chunk_cursor_ = Cursor(content);
  }

  /// Unpacks a chunk to chunk_. Throws InputError (offset) on damage, and ends reading where all
  /// chunks together are to hold more than can come of the file.
  void unpack_chunk(std::uint64_t offset, std::string_view compression,
                    std::span<const std::byte> packed, std::uint64_t size) {
    const std::uint64_t all = unpacked_bytes_ + std::min(size, UINT64_MAX - unpacked_bytes_);
    if (!compression.empty() && !is_believable(all, bytes_.size())) {
      is_done_ = true;
      region_.refuse(offset, fmt::format("the chunks up to here are to hold {} bytes, which cannot "
                                         "come of the file's {}",
                                         all, bytes_.size()));
    }
    unpacked_bytes_ = all;
    if (const std::string wrong = unpack(compression, packed, size, chunk_); !wrong.empty()) {
      region_.refuse(offset, "a chunk is damaged: " + wrong);
    }
  }

  /// Counts a message of a packed chunk. Throws InputError, and ends reading, on more messages than
  /// the file's size allows.
  void count_unpacked(std::uint64_t offset) {
    if (const std::string wrong = check_unpacked(++unpacked_, bytes_.size()); !wrong.empty()) {
      chunk_cursor_ = {};
      is_done_ = true;
      chunk_region_.refuse(offset, wrong);
    }
  }

  Cursor file_cursor_;
  Region chunk_region_;
  Cursor chunk_cursor_;
  std::vector<std::byte> chunk_;  // the unpacked content
  std::uint64_t messages_ = 0;    // read so far
  bool is_done_ = false;

 private:
  std::uint64_t unpacked_ = 0;        // messages of packed chunks
  std::uint64_t unpacked_bytes_ = 0;  // that the packed chunks so far are to hold
};

}  // namespace kelpie::bag
