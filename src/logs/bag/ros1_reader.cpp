// SPDX-License-Identifier: Apache-2.0
#include "bag/ros1_reader.hpp"

#include <fmt/format.h>

#include <map>
#include <utility>

#include "bag/chunked_reader.hpp"
#include "bag/ros1_records.hpp"
#include "core/seconds.hpp"

namespace kelpie::bag {
namespace {

class Ros1Reader final : public ChunkedReader<Ros1Cursor> {
 public:
  Ros1Reader(std::span<const std::byte> bytes, const std::string& file, ReadMode mode)
      : ChunkedReader(bytes, file, mode, Ros1Cursor(bytes, kRos1Version.size())) {
    const std::string_view text = text_of(bytes);
    if (!text.starts_with(kRos1Version)) {
      region_.refuse(0, begins_as_ros1(text)
                            ? "is a bag of ROS 1 of another version than 2.0; `rosbag migrate` "
                              "writes that"
                            : "is not a bag of ROS 1: wrong first bytes");
    }
    if (file_cursor_.done()) {
      region_.refuse(text.size(), "is cut off: nothing follows the version");
    }
    try {
      read_bag_header(file_cursor_.next(region_));
    } catch (const InputError& error) {
      lose(error);
    }
  }

 private:
  bool step(Message& message) override {
    if (!chunk_cursor_.done()) {
      const Ros1Record record = chunk_cursor_.next(chunk_region_);
      if (is_packed_ && record.op == Ros1Op::message) {
        count_unpacked(record.offset);
      }
      return take(record, chunk_region_, message);
    }
    if (file_cursor_.done()) {
      is_done_ = true;
      check_counts();
      return false;
    }
    return take(file_cursor_.next(region_), region_, message);
  }

  struct Connection {
    std::size_t topic = 0;
    std::string name;  // of the topic, as the file has it
    std::string type;
    std::string checksum;  // of the type's definition
  };

  void read_bag_header(const Ros1Record& record) {
    const auto encryptor = record.header.find("encryptor");
    if (encryptor && !encryptor->empty() && *encryptor != "rosbag/NoEncryptor") {
      is_done_ = true;
      region_.refuse(record.offset,
                     fmt::format("the bag is encrypted by {}, which isn't read; `rosbag decrypt` "
                                 "writes it without",
                                 *encryptor));
    }
    if (record.op != Ros1Op::bag) {
      region_.refuse(record.offset, "is damaged: the header of the bag is due here");
    }
    const auto index = record.header.number<std::uint64_t>("index_pos");
    chunks_stated_ = record.header.number<std::uint32_t>("chunk_count");
    if (index == 0) {
      region_.refuse(record.offset,
                     "the bag was never closed: recording broke off, or still goes on; "
                     "--recover reads what is there");
    }
    is_closed_ = true;
    if (index > bytes_.size()) {
      region_.refuse(bytes_.size(),
                     fmt::format("is cut off: its index should begin at {}; --recover reads what "
                                 "is there",
                                 index));
    }
  }

  // Messages stand outside of chunks where a chunk's beginning is damaged or was never completed.
  bool take(const Ros1Record& record, const Region& region, Message& message) {
    switch (record.op) {
      case Ros1Op::message:
        read_message(record, region, message);
        return true;
      case Ros1Op::connection:
        add_connection(record, region);
        return false;
      case Ros1Op::chunk:
        if (&region == &region_) {
          open_chunk_of(record);
          return false;
        }
        break;
      case Ros1Op::chunk_info:
        ++chunks_indexed_;
        for (ByteReader reader(record.data, region, record.data_offset); reader.left() > 0;) {
          reader.number<std::uint32_t>();  // connection
          messages_indexed_ += reader.number<std::uint32_t>();
        }
        return false;
      case Ros1Op::bag:
      case Ros1Op::index:
        return false;
    }
    region.refuse(record.offset, fmt::format("is damaged: {} is no kind of record here",
                                             static_cast<int>(record.op)));
  }

  void add_connection(const Ros1Record& record, const Region& region) {
    const auto id = record.header.number<std::uint32_t>("conn");
    const Ros1Fields fields(record.data, region, record.data_offset);
    Connection one{.name = std::string(record.header.text("topic")),
                   .type = std::string(fields.text("type")),
                   .checksum = std::string(fields.text("md5sum"))};
    if (const auto found = connections_.find(id); found != connections_.end()) {
      const Connection& there = found->second;
      if (there.name != one.name || there.type != one.type || there.checksum != one.checksum) {
        region.refuse(record.offset,
                      fmt::format("the connection {} is defined twice, differently", id));
      }
      return;
    }
    one.topic = add_topic({.name = one.name,
                           .type = one.type,
                           .encoding = "ros1",
                           .definition = std::string(fields.text("message_definition")),
                           .is_latched = fields.find("latching") == "1"},
                          region_.file);
    if (checksums_.emplace(one.topic, one.checksum).first->second != one.checksum) {
      region.refuse(record.offset,
                    fmt::format("{} has messages by two definitions of {}", one.name, one.type));
    }
    connections_.emplace(id, std::move(one));
  }

  void open_chunk_of(const Ros1Record& record) {
    close_chunk();
    const std::string_view compression = record.header.text("compression");
    const auto size = record.header.number<std::uint32_t>("size");
    is_packed_ = compression != "none";
    if (!is_packed_) {
      if (size != record.data.size()) {
        region_.refuse(record.offset,
                       fmt::format("a chunk is damaged: it states {} bytes and has {}", size,
                                   record.data.size()));
      }
      open_chunk(record.offset, record.data);
      return;
    }
    unpack_chunk(record.offset, compression, record.data, size);
    open_chunk(record.offset, chunk_);
  }

  void read_message(const Ros1Record& record, const Region& region, Message& message) {
    const auto id = record.header.number<std::uint32_t>("conn");
    const auto connection = connections_.find(id);
    if (connection == connections_.end()) {
      region.refuse(record.offset,
                    fmt::format("a message belongs to the connection {}, which isn't "
                                "defined before it",
                                id));
    }
    // The lower half are seconds, the upper one nanoseconds: no sum is beyond kLatestNs.
    const auto time = record.header.number<std::uint64_t>("time");
    const std::int64_t time_ns = static_cast<std::int64_t>(time & UINT32_MAX) * kSecondNs +
                                 static_cast<std::int64_t>(time >> 32U);
    message = {.topic = connection->second.topic,
               .receive_ns = time_ns,
               .publish_ns = time_ns,
               .data = record.data};
    note(message.topic, record.offset, region);
    ++messages_;
  }

  void check_counts() {
    if (loss_count() > 0 && chunks_indexed_ < chunks_stated_) {
      return;  // the index is lost, too
    }
    if (is_closed_ && (chunks_indexed_ != chunks_stated_ || messages_indexed_ != messages_)) {
      region_.refuse(bytes_.size(),
                     fmt::format("the bag states {} chunks, its index {} chunks and {} messages; "
                                 "{} messages were found",
                                 chunks_stated_, chunks_indexed_, messages_indexed_, messages_));
    }
  }

  bool is_packed_ = false;  // the open chunk
  std::map<std::uint32_t, Connection> connections_;
  std::map<std::size_t, std::string> checksums_;  // by topic
  bool is_closed_ = false;                        // the recorder wrote its index
  std::uint32_t chunks_stated_ = 0;
  std::uint32_t chunks_indexed_ = 0;
  std::uint64_t messages_indexed_ = 0;
};

}  // namespace

bool begins_as_ros1(std::string_view beginning) {
  return beginning.starts_with(kRos1Magic);
}

std::unique_ptr<MessageReader> read_ros1(std::span<const std::byte> bytes, const std::string& file,
                                         ReadMode mode) {
  return std::make_unique<Ros1Reader>(bytes, file, mode);
}

}  // namespace kelpie::bag
