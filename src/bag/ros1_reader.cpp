// SPDX-License-Identifier: Apache-2.0
#include "bag/ros1_reader.hpp"

#include <fmt/format.h>

#include <map>
#include <utility>
#include <vector>

#include "bag/compression.hpp"
#include "bag/file_reader.hpp"
#include "bag/ros1_records.hpp"

namespace kelpie::bag {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

class Ros1Reader : public BagReader {
 public:
  Ros1Reader(std::span<const std::byte> bytes, const std::string& file, ReadMode mode);

  bool next(Message& message) override;
  Place place() const override;

 private:
  struct Connection {
    std::size_t topic = 0;
    std::string name;  // of the topic, as the file has it
    std::string type;
    std::string checksum;  // of the type's definition
  };

  void read_bag_header(const Ros1Record& record);
  bool step(Message& message);
  bool take(const Ros1Record& record, const Region& region, Message& message);
  void add_connection(const Ros1Record& record, const Region& region);
  void open_chunk(const Ros1Record& record);
  void count_unpacked(const Ros1Record& record);
  void read_message(const Ros1Record& record, const Region& region, Message& message);
  void check_counts();

  std::span<const std::byte> bytes_;
  Region file_region_;
  Ros1Cursor file_cursor_;
  Region chunk_region_;
  Ros1Cursor chunk_cursor_;
  std::vector<std::byte> chunk_;  // where it was packed
  bool is_packed_ = false;
  std::map<std::uint32_t, Connection> connections_;
  std::map<std::size_t, std::string> checksums_;  // by topic
  bool is_closed_ = false;                        // the recorder wrote its index
  std::uint32_t chunks_stated_ = 0;
  std::uint32_t chunks_indexed_ = 0;
  std::uint64_t messages_indexed_ = 0;
  std::uint64_t messages_ = 0;
  std::uint64_t unpacked_ = 0;  // of chunks
  bool at_end_ = false;
  // The message given last: for place(), which is asked only when something is wrong.
  const std::string* last_topic_ = nullptr;
  const Region* last_region_ = nullptr;
  std::uint64_t last_offset_ = 0;
};

Ros1Reader::Ros1Reader(std::span<const std::byte> bytes, const std::string& file, ReadMode mode)
    : BagReader(mode, file),
      bytes_(bytes),
      file_region_{.file = file, .part = ""},
      file_cursor_(bytes, kRos1Version.size()),
      chunk_region_{.file = file, .part = ""} {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());  // NOLINT
  if (!text.starts_with(kRos1Version)) {
    file_region_.refuse(0, text.starts_with(kRos1Magic)
                               ? "is a bag of ROS 1 of another version than 2.0; `rosbag migrate` "
                                 "writes that"
                               : "is no bag of ROS 1: it doesn't begin as one");
  }
  if (file_cursor_.done()) {
    file_region_.refuse(text.size(), "is cut off: nothing follows the version");
  }
  try {
    read_bag_header(file_cursor_.next(file_region_));
  } catch (const InputError& error) {
    lose(error);
  }
}

void Ros1Reader::read_bag_header(const Ros1Record& record) {
  const auto encryptor = record.header.find("encryptor");
  if (encryptor && !encryptor->empty() && *encryptor != "rosbag/NoEncryptor") {
    at_end_ = true;
    file_region_.refuse(
        record.offset, fmt::format("the bag is encrypted by {}, which isn't read; `rosbag decrypt` "
                                   "writes it without",
                                   *encryptor));
  }
  if (record.op != Ros1Op::bag) {
    file_region_.refuse(record.offset, "is damaged: the header of the bag is due here");
  }
  const auto index = record.header.number<std::uint64_t>("index_pos");
  chunks_stated_ = record.header.number<std::uint32_t>("chunk_count");
  if (index == 0) {
    file_region_.refuse(record.offset,
                        "the bag was never closed: recording broke off, or still goes on; "
                        "--recover reads what is there");
  }
  is_closed_ = true;
  if (index > bytes_.size()) {
    file_region_.refuse(
        bytes_.size(), fmt::format("is cut off: its index should begin at {}; --recover reads what "
                                   "is there",
                                   index));
  }
}

bool Ros1Reader::next(Message& message) {
  while (!at_end_) {
    try {
      if (step(message)) {
        ++messages_;
        return true;
      }
    } catch (const InputError& error) {
      lose(error);
    }
  }
  return false;
}

// Takes one record; true when it was a message.
bool Ros1Reader::step(Message& message) {
  if (!chunk_cursor_.done()) {
    const Ros1Record record = chunk_cursor_.next(chunk_region_);
    if (is_packed_ && record.op == Ros1Op::message) {
      count_unpacked(record);
    }
    return take(record, chunk_region_, message);
  }
  if (file_cursor_.done()) {
    at_end_ = true;
    check_counts();
    return false;
  }
  return take(file_cursor_.next(file_region_), file_region_, message);
}

// Messages stand outside of chunks where a chunk's beginning is damaged or was never completed.
bool Ros1Reader::take(const Ros1Record& record, const Region& region, Message& message) {
  switch (record.op) {
    case Ros1Op::message:
      read_message(record, region, message);
      return true;
    case Ros1Op::connection:
      add_connection(record, region);
      return false;
    case Ros1Op::chunk:
      if (&region == &file_region_) {
        open_chunk(record);
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

void Ros1Reader::add_connection(const Ros1Record& record, const Region& region) {
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
                        file_region_.file);
  if (checksums_.emplace(one.topic, one.checksum).first->second != one.checksum) {
    region.refuse(record.offset,
                  fmt::format("{} has messages by two definitions of {}", one.name, one.type));
  }
  connections_.emplace(id, std::move(one));
}

void Ros1Reader::open_chunk(const Ros1Record& record) {
  chunk_.clear();
  chunk_cursor_ = {};
  const std::string_view compression = record.header.text("compression");
  const auto size = record.header.number<std::uint32_t>("size");
  is_packed_ = compression != "none";
  chunk_region_.part = fmt::format("chunk at offset {}, ", record.offset);
  if (!is_packed_) {
    if (size != record.data.size()) {
      file_region_.refuse(record.offset,
                          fmt::format("a chunk is damaged: it states {} bytes and has {}", size,
                                      record.data.size()));
    }
    chunk_cursor_ = Ros1Cursor(record.data);
    return;
  }
  const std::string wrong = unpack(compression, record.data, size, chunk_);
  if (!wrong.empty()) {
    file_region_.refuse(record.offset, "a chunk is damaged: " + wrong);
  }
  chunk_cursor_ = Ros1Cursor(chunk_);
}

void Ros1Reader::count_unpacked(const Ros1Record& record) {
  if (const std::string wrong = check_unpacked(++unpacked_, bytes_.size()); !wrong.empty()) {
    chunk_cursor_ = {};
    at_end_ = true;
    chunk_region_.refuse(record.offset, wrong);
  }
}

void Ros1Reader::read_message(const Ros1Record& record, const Region& region, Message& message) {
  const auto id = record.header.number<std::uint32_t>("conn");
  const auto connection = connections_.find(id);
  if (connection == connections_.end()) {
    region.refuse(record.offset, fmt::format("a message belongs to the connection {}, which isn't "
                                             "defined before it",
                                             id));
  }
  // The lower half are seconds, the upper one nanoseconds: no sum is beyond kLatestNs.
  const auto time = record.header.number<std::uint64_t>("time");
  message.receive_ns = static_cast<std::int64_t>(time & UINT32_MAX) * kSecond +
                       static_cast<std::int64_t>(time >> 32U);
  message.publish_ns = message.receive_ns;
  message.sequence = 0;
  message.data = record.data;
  message.topic = connection->second.topic;
  last_topic_ = &connection->second.name;
  last_region_ = &region;
  last_offset_ = record.offset;
}

void Ros1Reader::check_counts() {
  if (loss_count() > 0 && chunks_indexed_ < chunks_stated_) {
    return;  // the index is lost, too
  }
  if (is_closed_ && (chunks_indexed_ != chunks_stated_ || messages_indexed_ != messages_)) {
    file_region_.refuse(
        bytes_.size(), fmt::format("the bag states {} chunks, its index {} chunks and {} messages; "
                                   "{} messages were found",
                                   chunks_stated_, chunks_indexed_, messages_indexed_, messages_));
  }
}

Place Ros1Reader::place() const {
  if (last_topic_ == nullptr) {
    return {.file = file_region_.file, .line = 0, .field = {}};
  }
  return {.file = file_region_.file,
          .line = 0,
          .field = fmt::format("{}, {}offset {}", *last_topic_, last_region_->part, last_offset_)};
}

}  // namespace

std::unique_ptr<BagReader> read_ros1(std::span<const std::byte> bytes, const std::string& file,
                                     ReadMode mode) {
  return std::make_unique<Ros1Reader>(bytes, file, mode);
}

std::unique_ptr<BagReader> read_ros1(const std::filesystem::path& file, ReadMode mode) {
  return std::make_unique<OfFile<Ros1Reader>>(file, mode);
}

}  // namespace kelpie::bag
