// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "kelpie/core/error.hpp"

namespace kelpie::bag {

/// A recorded topic.
struct Topic {
  std::string name;               ///< "/odom"
  std::string type;               ///< "nav_msgs/msg/Odometry"
  std::string encoding = "cdr";   ///< of the messages (decoding.hpp)
  std::string definition = {};    ///< .msg text with "MSG:" sections; empty: not in the recording
  std::string qos_profiles = {};  ///< YAML of the publishers' quality of service; may be empty
  bool is_latched = false;        ///< ROS 1: new subscribers get the last message at once
};

/// A recorded message. Times in ns since the recorder's epoch, from 0 to kLatestNs.
struct Message {
  static constexpr std::int64_t kLatestNs = std::int64_t{1} << 62;  ///< year 2116: no overflow

  std::size_t topic = 0;              ///< index in MessageReader::topics()
  std::int64_t receive_ns = 0;        ///< arrival at the recorder
  std::int64_t publish_ns = 0;        ///< time of sending; receive_ns where not recorded
  std::uint32_t sequence = 0;         ///< count of the publisher or recorder
  std::span<const std::byte> data{};  ///< valid until the next call of next()
};

/// Treatment of damage in a recording.
enum class ReadMode {
  strict,   ///< the first damage is an InputError
  usual,    ///< as strict; but messages with a wrong checksum are passed over and counted
  recover,  ///< damage is noted, and reading continues behind the damage
};

/// Times of rows for files without a time, or with an unknown name of the time (MATLAB).
struct RowTimes {
  std::string time{};    ///< array of times: "clock", "log.clock"; empty: found by name
  double rate_hz = 0.0;  ///< of rows without time; 0: rows are 1 s apart
};

/// Reads the messages of a recording in the order of storage, which is nearly the order of time.
/// A format derives from this class and implements step(), at_end() and place(); see
/// src/logs/bag/README.md.
class MessageReader {
 public:
  /// `source` names the recording in messages.
  MessageReader(ReadMode mode, std::string source) : mode_(mode), source_(std::move(source)) {}
  virtual ~MessageReader() = default;
  MessageReader(const MessageReader&) = delete;
  MessageReader& operator=(const MessageReader&) = delete;

  /// Fills in the next message; false at the end. Throws InputError (file, offset) on damage in
  /// strict mode, Failure on errors of the device.
  bool next(Message& message);

  /// The folder or file being read.
  const std::string& source() const { return source_; }

  /// File, topic and offset of the last message, for error messages.
  virtual Place place() const = 0;

  /// The topics found so far. next() may append topics; indices stay valid. The list is complete
  /// when next() has returned false.
  const std::vector<Topic>& topics() const { return topics_; }

  /// Reports damage, also damage found while decoding a message. Recover mode notes the loss; other
  /// modes throw `damage`.
  void lose(const InputError& damage);

  /// Descriptions of the first kShownLosses losses, and the total count.
  const std::vector<std::string>& losses() const { return losses_; }
  std::size_t loss_count() const { return loss_count_; }
  static constexpr std::size_t kShownLosses = 20;
  /// Numbers of messages with a wrong checksum that were passed over, by topic.
  const std::map<std::string, std::size_t>& passed_over() const { return passed_over_; }
  /// The first kShownLosses parts of the recording that are not read, with the reason: "vehicle is
  /// an object of class string; …".
  const std::vector<std::string>& left_out() const { return left_out_; }
  /// For a terminal: a line for the messages passed over, and a line per loss and per part left
  /// out; "" without these.
  std::string losses_text() const;

  /// Keeps `content` in memory as long as the reader.
  void keep(std::shared_ptr<const void> content) { content_ = std::move(content); }

 protected:
  /// Reads one record, row or line, and moves behind it. Returns true, with `message` filled in,
  /// for a message. Throws InputError on damage.
  virtual bool step(Message& message) = 0;
  /// Whether the recording is read.
  virtual bool at_end() const = 0;
  /// Moves to the next sound place, or to the end, after step() has thrown.
  virtual void pass_damage() {}

  /// Index of the topic of this name; appends a new topic. Throws InputError (file) on a known
  /// topic with another type, and ends reading where definitions are too many.
  std::size_t add_topic(const Topic& topic, const std::string& file);
  /// Counts bytes and fields of a topic's definition. Throws InputError (file), and ends reading,
  /// beyond Tuning::most_definitions: a few bytes can name a long definition again and again.
  void count_definition(std::size_t cost, const std::string& file);
  /// Counts a message with a wrong checksum, of the topic called `topic`.
  void pass_over(const std::string& topic) { ++passed_over_[topic]; }
  /// Notes a sound part of the recording that is not read.
  void leave_out(const std::string& what);
  /// Takes over the losses of `other`.
  void take_losses(MessageReader& other);
  ReadMode mode() const { return mode_; }

 private:
  ReadMode mode_;
  std::string source_;
  std::vector<Topic> topics_;
  std::map<std::string, std::size_t> index_by_name_;
  std::vector<std::string> losses_;
  std::size_t loss_count_ = 0;
  std::map<std::string, std::size_t> passed_over_;
  std::vector<std::string> left_out_;
  std::size_t definitions_ = 0;  // bytes and fields
  std::shared_ptr<const void> content_;
};

}  // namespace kelpie::bag
