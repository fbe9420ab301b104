// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bag/message_type.hpp"
#include "bag/reader.hpp"

namespace kelpie::bag {

/// Writes a recording as MCAP (https://mcap.dev/spec, profile ros2, or ros1 for a first topic of
/// ROS 1): chunks, message indexes, summary, CRCs of chunks, data and summary. Equal topics and
/// messages give equal bytes. Memory: the content not yet taken, and a chunk.
class McapWriter {
 public:
  /// How the file is packed.
  struct Settings {
    std::string compression = "zstd";     ///< or "lz4", or "" for plain
    std::size_t chunk_bytes = 1'000'000;  ///< size at which a chunk is closed
  };

  McapWriter() : McapWriter(Settings{}) {}
  explicit McapWriter(Settings settings);  ///< An empty bag.

  /// Adds a topic; Message::topic counts the topics in the order of these calls. Throws InputError
  /// beyond 65,535 topics.
  void add_topic(const Topic& topic);

  /// Requires a topic added before. A chunk's messages needn't be in the order of time.
  void write(const Message& message);

  /// Returns the complete content not yet taken: whole chunks, to be appended to the file. `flush`
  /// closes the current chunk first. ReadMode::recover reads the chunks of an unfinished file.
  std::string take(bool flush = false);

  /// Returns the rest of the file. No call may follow.
  std::string finish();

 private:
  struct Span {  // of times in a chunk or file
    std::int64_t first_ns = 0;
    std::int64_t last_ns = 0;
    std::uint64_t messages = 0;

    void add(std::int64_t time_ns);
  };
  /// Time and offset of each message of a channel in the chunk.
  using Index = std::vector<std::pair<std::int64_t, std::uint64_t>>;

  std::uint64_t size() const { return taken_ + file_.size(); }  // of the file so far
  void write_header(std::string_view profile);  // after the ROS version of the topics is known
  void close_chunk();
  void write_indexes(std::uint64_t chunk_offset, std::uint64_t chunk_length,
                     std::size_t packed_bytes);
  std::string statistics() const;
  void write_summary();

  Settings settings_;
  std::string file_;            // from taken_ on
  std::uint64_t taken_ = 0;     // bytes
  std::uint32_t checksum_ = 0;  // of the taken bytes
  std::string chunk_;
  Span chunk_span_;
  Span file_span_;
  std::map<std::uint16_t, Index> chunk_index_;
  std::map<std::uint16_t, std::uint64_t> messages_;  // by channel
  std::string schemas_;                              // records, repeated in the summary
  std::string channels_;                             // records
  std::string chunk_indexes_;                        // records
  std::uint16_t topics_ = 0;
  std::uint32_t chunks_ = 0;
};

/// Result of copy_to_mcap().
struct McapCopy {
  std::string content;  ///< of the MCAP file
  std::size_t messages = 0;
  std::vector<std::string> undefined;  ///< topics without a known type, copied raw
};

/// Copies all messages of a recording to MCAP in the order of storage, each topic with its
/// definition. Throws as reading does.
McapCopy copy_to_mcap(MessageReader& bag, const MessageDefinitions& definitions,
                      const McapWriter::Settings& settings = {});

}  // namespace kelpie::bag
