// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bag/byte_reader.hpp"

namespace kelpie::bag {

// The records of MCAP (https://mcap.dev/spec) needed for messages.

constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n";
constexpr std::size_t kRecordHead = 9;  ///< opcode and length

enum class Opcode : std::uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  statistics = 0x0B,
  summary_offset = 0x0E,
  data_end = 0x0F,
};

struct Record {
  Opcode opcode{};
  std::span<const std::byte> content;
  std::uint64_t offset = 0;  ///< of the opcode, in the region

  ByteReader reader(const Region& region) const { return {content, region, offset + kRecordHead}; }
};

/// Walks over consecutive records.
class RecordCursor {
 public:
  RecordCursor() = default;
  explicit RecordCursor(std::span<const std::byte> bytes) : bytes_(bytes) {}

  bool done() const { return at_ >= bytes_.size(); }
  std::uint64_t offset() const { return at_; }
  void jump(std::uint64_t offset) { at_ = offset; }

  /// Returns the record here and moves behind the record. Requires !done(). Throws InputError on an
  /// incomplete record; the cursor is then at the end.
  Record next(const Region& region);

 private:
  std::span<const std::byte> bytes_;
  std::uint64_t at_ = 0;
};

struct McapSchema {
  std::uint16_t id = 0;
  std::string name{};
  std::string encoding{};
  std::string text{};

  bool operator==(const McapSchema&) const = default;
};

struct McapChannel {
  std::uint16_t id = 0;
  std::uint16_t schema = 0;
  std::string topic{};
  std::string encoding{};
  std::map<std::string, std::string> metadata{};

  bool operator==(const McapChannel&) const = default;
};

struct McapChunk {
  std::uint64_t first_ns = 0;
  std::uint64_t last_ns = 0;
  std::uint64_t size = 0;
  std::uint32_t crc = 0;
  std::string_view compression;
  std::span<const std::byte> packed;
};

struct McapFooter {
  std::uint64_t summary = 0;
  std::uint64_t summary_offsets = 0;
  std::uint32_t crc = 0;
};

// Parsers of record contents. Throw InputError (file, offset) on short content.
McapSchema read_schema(ByteReader reader);
McapChannel read_channel(ByteReader reader);
McapChunk read_chunk(ByteReader reader);
McapFooter read_footer(ByteReader reader);
std::uint64_t read_chunk_index_offset(ByteReader reader);
std::uint64_t read_statistics_messages(ByteReader reader);

/// Throws InputError on entries beyond the `chunk_size` bytes of the chunk.
void check_message_index(ByteReader reader, std::uint64_t chunk_size);

/// Summary at the end of an MCAP file.
struct McapSummary {
  std::vector<Record> definitions;           ///< schemas first, then channels
  std::vector<std::uint64_t> chunk_offsets;  ///< ascending
  std::optional<std::uint64_t> messages;     ///< in the whole file
};

bool has_mcap_magic(std::span<const std::byte> bytes);

/// Returns an empty summary for a file without summary section. Throws InputError (file, offset) on
/// a file without MCAP's ending, and on a damaged footer or summary.
McapSummary read_mcap_summary(std::span<const std::byte> bytes, const Region& region);

}  // namespace kelpie::bag
