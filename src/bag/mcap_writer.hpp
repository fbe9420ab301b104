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

/// Writes a bag as MCAP (https://mcap.dev/spec, profile ros2, or ros1 where the first topic is):
/// chunks, message indexes, summary, CRCs of chunks, data and summary. The same topics and messages
/// give the same bytes. Memory: what of the file hasn't been taken, and one chunk.
class McapWriter {
 public:
  /// How the file is packed.
  struct Settings {
    std::string compression = "zstd";     ///< or "lz4", or "" for none
    std::size_t chunk_bytes = 1'000'000;  ///< a chunk is closed when it has reached this
  };

  McapWriter() : McapWriter(Settings{}) {}
  explicit McapWriter(Settings settings);  ///< An empty bag.

  /// Adds a topic; Message::topic counts them in the order of these calls.
  /// Throws InputError beyond 65,535 topics.
  void add_topic(const Topic& topic);

  /// Requires a topic added before. A chunk's messages needn't be in the order of time.
  void write(const Message& message);

  /// What of the file is complete now and hasn't been taken before: whole chunks, to be written one
  /// after the other. `flush` closes the chunk at hand first. Where the rest never follows,
  /// ReadMode::recover reads these chunks.
  std::string take(bool flush = false);

  /// The file's content, or what of it hasn't been taken. Nothing may be called after it.
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
  void write_header(std::string_view profile);  // once it is known of which ROS the topics are
  void close_chunk();
  void write_indexes(std::uint64_t chunk_offset, std::uint64_t chunk_length,
                     std::size_t packed_bytes);
  std::string statistics() const;
  void write_summary();

  Settings settings_;
  std::string file_;            // from taken_ on
  std::uint64_t taken_ = 0;     // bytes
  std::uint32_t checksum_ = 0;  // of these
  std::string chunk_;
  Span chunk_span_;
  Span file_span_;
  std::map<std::uint16_t, Index> chunk_index_;
  std::map<std::uint16_t, std::uint64_t> messages_;  // by channel
  std::string schemas_;                              // records, as the summary repeats them
  std::string channels_;                             // records
  std::string chunk_indexes_;                        // records
  std::uint16_t topics_ = 0;
  std::uint32_t chunks_ = 0;
};

/// What copying a bag has come to.
struct McapCopy {
  std::string content;  ///< of the MCAP file
  std::size_t messages = 0;
  std::vector<std::string> undefined;  ///< topics whose type nobody defines: they stay raw
};

/// All messages of a bag as MCAP, in the order they are stored in, each topic with its definition.
/// Throws what reading throws.
McapCopy copy_to_mcap(MessageReader& bag, const MessageDefinitions& definitions,
                      const McapWriter::Settings& settings = {});

}  // namespace kelpie::bag
