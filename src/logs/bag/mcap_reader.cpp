// SPDX-License-Identifier: Apache-2.0
#include "bag/mcap_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "bag/chunked_reader.hpp"
#include "bag/mcap_records.hpp"
#include "file/crc32.hpp"

namespace kelpie::bag {
namespace {

// As tools write it; ROS 1 itself has 1.
bool is_true(std::string_view text) {
  return text == "1" || text == "true" || text == "True";
}

class McapReader final : public ChunkedReader<RecordCursor> {
 public:
  McapReader(std::span<const std::byte> bytes, const std::string& file, ReadMode mode)
      : ChunkedReader(bytes, file, mode, RecordCursor(bytes)) {
    if (!has_mcap_magic(bytes)) {
      region_.refuse(0, "is not an MCAP file: wrong first bytes");
    }
    file_cursor_.jump(kMcapMagic.size());
    try {
      take_summary();
    } catch (const InputError& error) {
      lose(error);
    }
  }

 private:
  bool step(Message& message) override {
    step_offset_ = file_cursor_.offset();
    if (!chunk_cursor_.done()) {
      const Record record = chunk_cursor_.next(chunk_region_);
      if (record.opcode == Opcode::message) {
        count_unpacked(record.offset);
        read_message(record, chunk_region_, message);
        return true;
      }
      apply_definition(record, chunk_region_);
      return false;
    }
    if (file_cursor_.done()) {
      is_done_ = true;
      region_.refuse(file_cursor_.offset(), "is cut off: the end of the data is missing");
    }
    const Record record = file_cursor_.next(region_);
    switch (record.opcode) {
      case Opcode::message:
        read_message(record, region_, message);
        return true;
      case Opcode::chunk:
        open_chunk_of(record);
        break;
      case Opcode::message_index:
        check_message_index(record.reader(region_), chunk_.size());
        break;
      case Opcode::data_end:
      case Opcode::footer:
        is_done_ = true;
        check_data_end(record);
        check_count();
        break;
      default:
        apply_definition(record, region_);
    }
    return false;
  }

  // Where a record is damaged its length may be wrong, too: only the summary tells for sure where
  // something begins. Damage within a chunk leaves the file's records as they are.
  void pass_damage() override {
    if (is_done_ || file_cursor_.offset() == step_offset_) {
      return;
    }
    const auto chunk = std::ranges::upper_bound(summary_.chunk_offsets, step_offset_);
    if (chunk != summary_.chunk_offsets.end() && *chunk < bytes_.size()) {
      file_cursor_.jump(*chunk);
    } else {
      is_done_ = file_cursor_.done();
    }
  }

  void take_summary() {
    summary_ = read_mcap_summary(bytes_, region_);
    for (const Record& record : summary_.definitions) {
      apply_definition(record, region_);
    }
  }

  void apply_definition(const Record& record, const Region& region) {
    const ByteReader reader = record.reader(region);
    if (record.opcode == Opcode::schema) {
      const McapSchema schema = read_schema(reader);
      const auto [there, is_new] = schemas_.emplace(schema.id, schema);
      if (!is_new && there->second != schema) {
        reader.refuse(fmt::format("the schema {} is defined twice, differently", schema.id));
      }
    } else if (record.opcode == Opcode::channel) {
      add_channel(read_channel(reader), reader);
    }
  }

  void add_channel(const McapChannel& channel, const ByteReader& reader) {
    const auto found = channels_.find(channel.id);
    if (found != channels_.end()) {
      if (found->second.channel != channel) {
        reader.refuse(fmt::format("the channel {} is defined twice, differently", channel.id));
      }
      return;
    }
    Topic topic;
    topic.name = channel.topic;
    topic.encoding = channel.encoding;
    if (channel.schema != 0) {
      const auto schema = schemas_.find(channel.schema);
      if (schema == schemas_.end()) {
        reader.refuse(fmt::format("{} has the schema {}, which isn't defined before it",
                                  channel.topic, channel.schema));
      }
      topic.type = schema->second.name;
      const std::string& kind = schema->second.encoding;
      const bool is_known = kind == "ros2msg" || kind == "ros1msg" || kind == channel.encoding;
      topic.definition = is_known ? schema->second.text : "";
    }
    if (const auto qos = channel.metadata.find("offered_qos_profiles");
        qos != channel.metadata.end()) {
      topic.qos_profiles = qos->second;
    }
    const auto latching = channel.metadata.find("latching");
    topic.is_latched = latching != channel.metadata.end() && is_true(latching->second);
    channels_[channel.id] = {channel, add_topic(topic, region_.file)};
  }

  void open_chunk_of(const Record& record) {
    close_chunk();
    const McapChunk chunk = read_chunk(record.reader(region_));
    unpack_chunk(record.offset, chunk.compression, chunk.packed, chunk.size);
    if (chunk.crc != 0 && file::crc32_of(chunk_) != chunk.crc) {
      region_.refuse(record.offset, "a chunk is damaged: its CRC is wrong");
    }
    open_chunk(record.offset, chunk_);
  }

  void read_message(const Record& record, const Region& region, Message& message) {
    ByteReader reader = record.reader(region);
    const auto id = reader.number<std::uint16_t>();
    const auto channel = channels_.find(id);
    if (channel == channels_.end()) {
      region.refuse(record.offset, fmt::format("a message belongs to the channel {}, which isn't "
                                               "defined before it",
                                               id));
    }
    message.topic = channel->second.topic;
    message.sequence = reader.number<std::uint32_t>();
    const auto receive = reader.number<std::uint64_t>();
    const auto publish = reader.number<std::uint64_t>();
    if (std::max(receive, publish) > Message::kLatestNs) {
      region.refuse(record.offset,
                    fmt::format("{}: a message has the time {} ns, later than the "
                                "year 2116",
                                channel->second.channel.topic, std::max(receive, publish)));
    }
    message.receive_ns = static_cast<std::int64_t>(receive);
    message.publish_ns = static_cast<std::int64_t>(publish);
    message.data = reader.rest();
    note(message.topic, record.offset, region);
    ++messages_;
  }

  void check_data_end(const Record& record) {
    if (record.opcode == Opcode::data_end) {
      const auto crc = record.reader(region_).number<std::uint32_t>();
      const auto data = bytes_.first(static_cast<std::size_t>(record.offset));
      if (crc != 0 && loss_count() == 0 && file::crc32_of(data) != crc) {
        region_.refuse(record.offset, "the data are damaged: the CRC of the whole is wrong");
      }
    }
  }

  void check_count() {
    if (summary_.messages && *summary_.messages != messages_) {
      region_.refuse(file_cursor_.offset(),
                     fmt::format("the summary states {} messages; {} were found",
                                 *summary_.messages, messages_));
    }
  }

  std::map<std::uint16_t, McapSchema> schemas_;
  struct Source {
    McapChannel channel;
    std::size_t topic = 0;
  };
  std::map<std::uint16_t, Source> channels_;
  McapSummary summary_;
  std::uint64_t step_offset_ = 0;  // where the last step began
};

}  // namespace

bool begins_as_mcap(std::string_view beginning) {
  return beginning.starts_with(kMcapMagic.substr(0, 5));
}

std::unique_ptr<MessageReader> read_mcap(std::span<const std::byte> bytes, const std::string& file,
                                         ReadMode mode) {
  return std::make_unique<McapReader>(bytes, file, mode);
}

}  // namespace kelpie::bag
