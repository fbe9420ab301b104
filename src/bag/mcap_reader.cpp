// SPDX-License-Identifier: Apache-2.0
#include "bag/mcap_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "bag/compression.hpp"
#include "bag/file_reader.hpp"
#include "bag/mcap_summary.hpp"
#include "file/crc32.hpp"

namespace kelpie::bag {
namespace {

// As tools write it; ROS 1 itself has 1.
bool is_true(std::string_view text) {
  return text == "1" || text == "true" || text == "True";
}

class McapReader : public BagReader {
 public:
  McapReader(std::span<const std::byte> bytes, const std::string& file, ReadMode mode);

  bool next(Message& message) override;
  Place place() const override;

 private:
  void take_summary();
  void apply_definition(const Record& record, const Region& region);
  void add_channel(const McapChannel& channel, const ByteReader& reader);
  bool step(Message& message);
  void open_chunk(const Record& record);
  void count_unpacked(const Record& record);
  void read_message(const Record& record, const Region& region, Message& message);
  void pass_damage(std::uint64_t offset);
  void check_data_end(const Record& record);
  void check_count();

  std::span<const std::byte> bytes_;
  Region file_region_;
  RecordCursor file_cursor_;
  Region chunk_region_;
  RecordCursor chunk_cursor_;
  std::vector<std::byte> chunk_;
  std::map<std::uint16_t, McapSchema> schemas_;
  struct Source {
    McapChannel channel;
    std::size_t topic = 0;
  };
  std::map<std::uint16_t, Source> channels_;
  McapSummary summary_;
  std::uint64_t messages_ = 0;
  std::uint64_t unpacked_ = 0;  // of chunks
  bool at_end_ = false;
  // The message given last: for place(), which is asked only when something is wrong.
  const std::string* last_topic_ = nullptr;
  const Region* last_region_ = nullptr;
  std::uint64_t last_offset_ = 0;
};

McapReader::McapReader(std::span<const std::byte> bytes, const std::string& file, ReadMode mode)
    : BagReader(mode, file),
      bytes_(bytes),
      file_region_{.file = file, .part = ""},
      file_cursor_(bytes),
      chunk_region_{.file = file, .part = ""} {
  if (!begins_as_mcap(bytes)) {
    file_region_.refuse(0, "is no MCAP file: it doesn't begin as one");
  }
  file_cursor_.jump(kMcapMagic.size());
  try {
    take_summary();
  } catch (const InputError& error) {
    lose(error);
  }
}

void McapReader::take_summary() {
  summary_ = read_mcap_summary(bytes_, file_region_);
  for (const Record& record : summary_.definitions) {
    apply_definition(record, file_region_);
  }
}

void McapReader::apply_definition(const Record& record, const Region& region) {
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

void McapReader::add_channel(const McapChannel& channel, const ByteReader& reader) {
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
  channels_[channel.id] = {channel, add_topic(topic, file_region_.file)};
}

bool McapReader::next(Message& message) {
  while (!at_end_) {
    const std::uint64_t offset = file_cursor_.offset();
    try {
      if (step(message)) {
        ++messages_;
        return true;
      }
    } catch (const InputError& error) {
      lose(error);
      pass_damage(offset);
    }
  }
  return false;
}

// Takes one record; true when it was a message.
bool McapReader::step(Message& message) {
  if (!chunk_cursor_.done()) {
    const Record record = chunk_cursor_.next(chunk_region_);
    if (record.opcode == Opcode::message) {
      count_unpacked(record);
      read_message(record, chunk_region_, message);
      return true;
    }
    apply_definition(record, chunk_region_);
    return false;
  }
  if (file_cursor_.done()) {
    at_end_ = true;
    file_region_.refuse(file_cursor_.offset(), "is cut off: the end of the data isn't there");
  }
  const Record record = file_cursor_.next(file_region_);
  switch (record.opcode) {
    case Opcode::message:
      read_message(record, file_region_, message);
      return true;
    case Opcode::chunk:
      open_chunk(record);
      break;
    case Opcode::message_index:
      check_message_index(record.reader(file_region_), chunk_.size());
      break;
    case Opcode::data_end:
    case Opcode::footer:
      at_end_ = true;
      check_data_end(record);
      check_count();
      break;
    default:
      apply_definition(record, file_region_);
  }
  return false;
}

void McapReader::open_chunk(const Record& record) {
  chunk_.clear();
  chunk_cursor_ = {};
  const McapChunk chunk = read_chunk(record.reader(file_region_));
  const std::string wrong = unpack(chunk.compression, chunk.packed, chunk.size, chunk_);
  if (!wrong.empty()) {
    file_region_.refuse(record.offset, "a chunk is damaged: " + wrong);
  }
  if (chunk.crc != 0 && file::crc32_of(chunk_) != chunk.crc) {
    file_region_.refuse(record.offset, "a chunk is damaged: its CRC is wrong");
  }
  chunk_region_.part = fmt::format("chunk at offset {}, ", record.offset);
  chunk_cursor_ = RecordCursor(chunk_);
}

void McapReader::count_unpacked(const Record& record) {
  if (const std::string wrong = check_unpacked(++unpacked_, bytes_.size()); !wrong.empty()) {
    chunk_cursor_ = {};
    at_end_ = true;
    chunk_region_.refuse(record.offset, wrong);
  }
}

void McapReader::read_message(const Record& record, const Region& region, Message& message) {
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
  last_topic_ = &channel->second.channel.topic;
  last_region_ = &region;
  last_offset_ = record.offset;
}

// Where a record is damaged its length may be wrong, too: only the summary tells for sure where
// something begins. Damage within a chunk leaves the file's records as they are.
void McapReader::pass_damage(std::uint64_t offset) {
  if (at_end_ || file_cursor_.offset() == offset) {
    return;
  }
  const auto chunk = std::ranges::upper_bound(summary_.chunk_offsets, offset);
  if (chunk != summary_.chunk_offsets.end() && *chunk < bytes_.size()) {
    file_cursor_.jump(*chunk);
  } else {
    at_end_ = file_cursor_.done();
  }
}

void McapReader::check_data_end(const Record& record) {
  if (record.opcode == Opcode::data_end) {
    const auto crc = record.reader(file_region_).number<std::uint32_t>();
    const auto data = bytes_.first(static_cast<std::size_t>(record.offset));
    if (crc != 0 && loss_count() == 0 && file::crc32_of(data) != crc) {
      file_region_.refuse(record.offset, "the data are damaged: the CRC of the whole is wrong");
    }
  }
}

void McapReader::check_count() {
  if (summary_.messages && *summary_.messages != messages_) {
    file_region_.refuse(file_cursor_.offset(),
                        fmt::format("the summary states {} messages; {} were found",
                                    *summary_.messages, messages_));
  }
}

Place McapReader::place() const {
  if (last_topic_ == nullptr) {
    return {.file = file_region_.file, .line = 0, .field = {}};
  }
  return {.file = file_region_.file,
          .line = 0,
          .field = fmt::format("{}, {}offset {}", *last_topic_, last_region_->part, last_offset_)};
}

}  // namespace

std::unique_ptr<BagReader> read_mcap(std::span<const std::byte> bytes, const std::string& file,
                                     ReadMode mode) {
  return std::make_unique<McapReader>(bytes, file, mode);
}

std::unique_ptr<BagReader> read_mcap(const std::filesystem::path& file, ReadMode mode) {
  return std::make_unique<OfFile<McapReader>>(file, mode);
}

}  // namespace kelpie::bag
