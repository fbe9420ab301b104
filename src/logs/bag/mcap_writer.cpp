// SPDX-License-Identifier: Apache-2.0
#include "bag/mcap_writer.hpp"

#include <algorithm>
#include <array>
#include <concepts>
#include <limits>
#include <utility>

#include "bag/compression.hpp"
#include "bag/decoding.hpp"
#include "bag/mcap_records.hpp"
#include "file/crc32.hpp"

namespace kelpie::bag {
namespace {

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text));
}

// The content of a record, put together field by field.
class Content {
 public:
  template <std::unsigned_integral T>
  Content& number(T value) {
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      text_.push_back(static_cast<char>((value >> (8 * i)) & 0xFFU));
    }
    return *this;
  }
  Content& time(std::int64_t value) { return number(static_cast<std::uint64_t>(value)); }
  Content& text(std::string_view value) {
    number(static_cast<std::uint32_t>(value.size()));
    return raw(value);
  }
  Content& raw(std::string_view value) {
    text_ += value;
    return *this;
  }

  const std::string& str() const { return text_; }

  /// The content as a record, with its head.
  std::string record(Opcode opcode) const {
    return Content()
        .number(static_cast<std::uint8_t>(opcode))
        .number(static_cast<std::uint64_t>(text_.size()))
        .raw(text_)
        .str();
  }

 private:
  std::string text_;
};

}  // namespace

void McapWriter::Span::add(std::int64_t time_ns) {
  first_ns = messages == 0 ? time_ns : std::min(first_ns, time_ns);
  last_ns = messages == 0 ? time_ns : std::max(last_ns, time_ns);
  ++messages;
}

McapWriter::McapWriter(Settings settings) : settings_(std::move(settings)) {
  file_ = kMcapMagic;
}

void McapWriter::write_header(std::string_view profile) {
  file_ += Content().text(profile).text("kelpie").record(Opcode::header);
}

void McapWriter::add_topic(const Topic& topic) {
  if (topics_ == std::numeric_limits<std::uint16_t>::max()) {
    throw InputError(topic.name, "is one topic too many: MCAP holds up to 65535");
  }
  const bool is_ros1 = topic.encoding == "ros1";
  if (topics_ == 0) {
    write_header(is_ros1 ? "ros1" : "ros2");
  }
  ++topics_;  // channels and schemas count from 1: a schema 0 means none
  // Definitions that aren't of ROS go by the name of what they define.
  const std::string_view encoding = topic.definition.empty()  ? ""
                                    : is_ros1                 ? "ros1msg"
                                    : topic.encoding == "cdr" ? "ros2msg"
                                                              : std::string_view(topic.encoding);
  const std::string schema = Content()
                                 .number(topics_)
                                 .text(topic.type)
                                 .text(encoding)
                                 .text(topic.definition)
                                 .record(Opcode::schema);
  Content metadata;
  if (!topic.qos_profiles.empty()) {
    metadata.text("offered_qos_profiles").text(topic.qos_profiles);
  }
  if (topic.is_latched) {
    metadata.text("latching").text("1");
  }
  const std::string channel = Content()
                                  .number(topics_)
                                  .number(topics_)
                                  .text(topic.name)
                                  .text(topic.encoding)
                                  .text(metadata.str())
                                  .record(Opcode::channel);
  chunk_ += schema + channel;
  schemas_ += schema;
  channels_ += channel;
}

void McapWriter::write(const Message& message) {
  const auto channel = static_cast<std::uint16_t>(message.topic + 1);
  chunk_index_[channel].emplace_back(message.receive_ns, chunk_.size());
  chunk_span_.add(message.receive_ns);
  file_span_.add(message.receive_ns);
  ++messages_[channel];
  const std::string_view data(reinterpret_cast<const char*>(message.data.data()),  // NOLINT: bytes
                              message.data.size());
  chunk_ += Content()
                .number(channel)
                .number(message.sequence)
                .time(message.receive_ns)
                .time(message.publish_ns)
                .raw(data)
                .record(Opcode::message);
  if (chunk_.size() >= settings_.chunk_bytes) {
    close_chunk();
  }
}

void McapWriter::close_chunk() {
  const std::uint64_t offset = size();
  const std::string packed = pack(settings_.compression, chunk_);
  file_ += Content()
               .time(chunk_span_.first_ns)
               .time(chunk_span_.last_ns)
               .number(static_cast<std::uint64_t>(chunk_.size()))
               .number(file::crc32_of(bytes_of(chunk_)))
               .text(settings_.compression)
               .number(static_cast<std::uint64_t>(packed.size()))
               .raw(packed)
               .record(Opcode::chunk);
  write_indexes(offset, size() - offset, packed.size());
  ++chunks_;
  chunk_.clear();
  chunk_span_ = {};
  chunk_index_.clear();
}

void McapWriter::write_indexes(std::uint64_t chunk_offset, std::uint64_t chunk_length,
                               std::size_t packed_bytes) {
  const std::uint64_t begin = size();
  Content offsets;
  for (auto& [channel, index] : chunk_index_) {
    std::ranges::stable_sort(index, {}, &Index::value_type::first);  // as the format asks for
    Content entries;
    for (const auto& [time, offset] : index) {
      entries.time(time).number(offset);
    }
    offsets.number(channel).number(size());
    file_ += Content().number(channel).text(entries.str()).record(Opcode::message_index);
  }
  chunk_indexes_ += Content()
                        .time(chunk_span_.first_ns)
                        .time(chunk_span_.last_ns)
                        .number(chunk_offset)
                        .number(chunk_length)
                        .text(offsets.str())
                        .number(size() - begin)
                        .text(settings_.compression)
                        .number(static_cast<std::uint64_t>(packed_bytes))
                        .number(static_cast<std::uint64_t>(chunk_.size()))
                        .record(Opcode::chunk_index);
}

std::string McapWriter::statistics() const {
  Content counts;
  for (const auto& [channel, count] : messages_) {
    counts.number(channel).number(count);
  }
  return Content()
      .number(file_span_.messages)
      .number(topics_)                              // schemas
      .number(static_cast<std::uint32_t>(topics_))  // channels
      .number(std::uint32_t{0})                     // attachments
      .number(std::uint32_t{0})                     // metadata
      .number(chunks_)
      .time(file_span_.first_ns)
      .time(file_span_.last_ns)
      .text(counts.str())
      .record(Opcode::statistics);
}

void McapWriter::write_summary() {
  const std::size_t begin_here = file_.size();
  const std::uint64_t begin = size();
  const std::array<std::pair<Opcode, std::string>, 4> groups{{
      {Opcode::schema, schemas_},
      {Opcode::channel, channels_},
      {Opcode::statistics, statistics()},
      {Opcode::chunk_index, chunk_indexes_},
  }};
  std::string offsets;
  for (const auto& [opcode, records] : groups) {
    if (!records.empty()) {
      offsets += Content()
                     .number(static_cast<std::uint8_t>(opcode))
                     .number(size())
                     .number(static_cast<std::uint64_t>(records.size()))
                     .record(Opcode::summary_offset);
      file_ += records;
    }
  }
  Content footer;
  footer.number(begin).number(size());
  file_ += offsets;
  // The CRC covers the footer up to itself.
  const std::string unchecked = Content(footer).number(std::uint32_t{0}).record(Opcode::footer);
  const std::string checked =
      file_.substr(begin_here) + unchecked.substr(0, unchecked.size() - sizeof(std::uint32_t));
  file_ += footer.number(file::crc32_of(bytes_of(checked))).record(Opcode::footer);
}

std::string McapWriter::take(bool flush) {
  if (flush && !chunk_.empty()) {
    close_chunk();
  }
  checksum_ = file::crc32_of(bytes_of(file_), checksum_);
  taken_ += file_.size();
  return std::exchange(file_, {});
}

std::string McapWriter::finish() {
  if (topics_ == 0) {
    write_header("ros2");
  }
  if (!chunk_.empty()) {
    close_chunk();
  }
  file_ += Content().number(file::crc32_of(bytes_of(file_), checksum_)).record(Opcode::data_end);
  write_summary();
  file_ += kMcapMagic;
  return std::move(file_);
}

McapCopy copy_to_mcap(MessageReader& bag, const MessageDefinitions& definitions,
                      const McapWriter::Settings& settings) {
  McapCopy copy;
  McapWriter writer(settings);
  std::size_t added = 0;
  const auto add_new_topics = [&] {
    for (; added < bag.topics().size(); ++added) {
      Topic topic = bag.topics()[added];
      try {
        topic.definition = definition_of(topic, definitions);
      } catch (const InputError&) {  // of use all the same to who has the definition
        copy.undefined.push_back(topic.name);
      }
      writer.add_topic(topic);
    }
  };
  for (Message message; bag.next(message);) {
    add_new_topics();
    writer.write(message);
    ++copy.messages;
  }
  add_new_topics();
  copy.content = writer.finish();
  return copy;
}

}  // namespace kelpie::bag
