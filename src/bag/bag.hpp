// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "kelpie/core/error.hpp"

namespace kelpie::bag {

/// A topic of a bag, as recorded.
struct Topic {
  std::string name;               ///< "/odom"
  std::string type;               ///< "nav_msgs/msg/Odometry"
  std::string encoding = "cdr";   ///< of its messages (decoding.hpp)
  std::string definition = {};    ///< .msg text with its "MSG:" sections; empty: the bag has none
  std::string qos_profiles = {};  ///< YAML of the publishers' quality of service; may be empty
  bool is_latched = false;        ///< ROS 1: new subscribers get the last message at once
};

/// One recorded message. Times in ns since the recorder's epoch, within 0 … kLatestNs.
struct Message {
  static constexpr std::int64_t kLatestNs = std::int64_t{1} << 62;  ///< differences have to fit

  std::size_t topic = 0;              ///< index in BagReader::topics()
  std::int64_t receive_ns = 0;        ///< when the recorder got it
  std::int64_t publish_ns = 0;        ///< when it was sent; receive_ns where not recorded
  std::uint32_t sequence = 0;         ///< the publisher's or recorder's count
  std::span<const std::byte> data{};  ///< valid until the next call of next()
};

/// What is done about damage.
enum class ReadMode {
  strict,   ///< the first damage is an InputError
  recover,  ///< damage is noted and what comes after it is read, as far as can be
};

/// The messages of a bag, one after the other in the order they are stored in (nearly, not always,
/// that of their times).
class BagReader {
 public:
  /// `source` is what messages call the bag.
  BagReader(ReadMode mode, std::string source) : mode_(mode), source_(std::move(source)) {}
  virtual ~BagReader() = default;
  BagReader(const BagReader&) = delete;
  BagReader(BagReader&&) = delete;
  BagReader& operator=(const BagReader&) = delete;
  BagReader& operator=(BagReader&&) = delete;

  /// Fills in the next message; false at the end. Throws InputError (file, offset) on damage in
  /// strict mode, Failure when the device fails.
  virtual bool next(Message& message) = 0;

  /// The folder or file that is read.
  const std::string& source() const { return source_; }

  /// Where the message given last stands: file, topic and offset, for error messages.
  virtual Place place() const = 0;

  /// The topics met so far; next() may append to them, those there keep their index. All are known
  /// once next() has returned false.
  const std::vector<Topic>& topics() const { return topics_; }

  /// Strict mode: throws `damage`. Recover mode: notes it as lost. Whoever decodes a message hands
  /// what is wrong with it in here.
  void lose(const InputError& damage);

  /// What was lost, at most the first kShownLosses, and how much in all.
  const std::vector<std::string>& losses() const { return losses_; }
  std::size_t loss_count() const { return loss_count_; }
  static constexpr std::size_t kShownLosses = 20;
  std::string losses_text() const;  ///< the same for a terminal, a line each; "" when nothing was

 protected:
  /// Index of the topic of this name; a new one is appended. Throws InputError (file) when it is
  /// there with another type.
  std::size_t add_topic(const Topic& topic, const std::string& file);
  /// What `other` lost counts as lost here.
  void take_losses(BagReader& other);
  ReadMode mode() const { return mode_; }

 private:
  ReadMode mode_;
  std::string source_;
  std::vector<Topic> topics_;
  std::map<std::string, std::size_t> index_by_name_;
  std::vector<std::string> losses_;
  std::size_t loss_count_ = 0;
};

/// Whether this is a folder, or a file that begins as bags do. False when it can't be read, and for
/// a pipe, of which nothing is taken.
bool is_bag(const std::filesystem::path& path);

/// Opens a bag: a rosbag2 folder with its metadata.yaml (sqlite3 or MCAP storage), or one .db3,
/// .mcap, .bag (ROS 1), .tlog, .BIN, .ulg, .alog or .mat file, told apart by content. In recover
/// mode a folder may lack metadata.yaml or files. Throws InputError naming the file: missing,
/// empty, of another kind, of an unknown storage, compressed by rosbag2, cut off.
std::unique_ptr<BagReader> open_bag(const std::filesystem::path& path,
                                    ReadMode mode = ReadMode::strict);

}  // namespace kelpie::bag
